//! Who may do what on this host at one time. Locks are the system's, on files: a process that dies gives them back.

use std::{
    fs::{self, File, TryLockError},
    io,
    ops::ControlFlow,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use sysinfo::System;

use crate::lab::LabError;

/// Between two tries.
const PAUSE: Duration = Duration::from_millis(20);

/// Asked whether to go on, while something takes its time.
pub type GoOn<'w> = &'w dyn Fn() -> ControlFlow<()>;

/// A host's locks, in the store's folder, which hosts may share.
pub struct Host {
    folder: PathBuf,
    points: PathBuf,
}

/// A lock that is held until it is dropped.
pub struct Held {
    _lock: Option<File>,
}

impl Host {
    /// This host's, below `folder`.
    ///
    /// # Errors
    /// The system's, where nothing can be written there.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let folder = folder.join("locks");
        fs::create_dir_all(&folder)?;
        let name = System::host_name().unwrap_or_else(|_| "host".to_owned());
        let points = folder.join(format!("points-{}", name.replace(['/', '\0'], "-")));
        open(&points)?;
        Ok(Self { folder, points })
    }

    /// Held while a point is worked on but not timed: nobody times anything meanwhile.
    pub fn busy(&self, go_on: GoOn) -> Result<Held, LabError> {
        let file = self.open()?;
        wait(go_on, || attempt(file.try_lock_shared()))?;
        Ok(Held { _lock: Some(file) })
    }

    /// Held while a point is timed. Waits until no other point is worked on; beyond `patience` it is timed beside them.
    /// Also whether it is alone, which is not claimed where the file system has no locks.
    pub fn quiet(&self, patience: Duration, go_on: GoOn) -> Result<(Held, bool), LabError> {
        let (file, begun) = (self.open()?, Instant::now());
        let alone = wait(go_on, || match file.try_lock() {
            Ok(()) => Some(true),
            Err(TryLockError::Error(_)) => Some(false),
            // Not beside one who is timed alone.
            Err(TryLockError::WouldBlock) if begun.elapsed() >= patience => {
                attempt(file.try_lock_shared()).map(|()| false)
            }
            Err(TryLockError::WouldBlock) => None,
        })?;
        Ok((Held { _lock: Some(file) }, alone))
    }

    /// Held by the one process that makes a thing which others wait for.
    pub fn making(&self, what: &str, go_on: GoOn) -> Result<Held, LabError> {
        let Ok(file) = open(&self.folder.join(what)) else { return Ok(Held { _lock: None }) };
        wait(go_on, || attempt(file.try_lock()))?;
        Ok(Held { _lock: Some(file) })
    }

    fn open(&self) -> Result<File, LabError> {
        open(&self.points).map_err(|reason| LabError::Lock { path: self.points.clone(), reason })
    }
}

fn open(path: &Path) -> io::Result<File> {
    File::options().create(true).truncate(false).write(true).open(path)
}

/// A file system without locks holds nobody up.
fn attempt(tried: Result<(), TryLockError>) -> Option<()> {
    (!matches!(tried, Err(TryLockError::WouldBlock))).then_some(())
}

fn wait<T>(go_on: GoOn, mut ready: impl FnMut() -> Option<T>) -> Result<T, LabError> {
    loop {
        if let Some(ready) = ready() {
            return Ok(ready);
        }
        if go_on().is_break() {
            return Err(LabError::Interrupted);
        }
        std::thread::sleep(PAUSE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GO: GoOn = &|| ControlFlow::Continue(());
    const STOP: GoOn = &|| ControlFlow::Break(());

    #[test]
    fn times_wait_for_others_or_say_that_they_did_not() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = [0; 2].map(|_| Host::new(folder.path()).unwrap());
        let long = Duration::from_secs(600);
        let busy = a.busy(GO).unwrap();
        assert!(matches!(b.quiet(long, STOP), Err(LabError::Interrupted)), "it did not wait");
        let (timed, alone) = b.quiet(Duration::ZERO, GO).unwrap();
        assert!(!alone);
        drop((busy, timed));
        let (timed, alone) = b.quiet(long, GO).unwrap();
        assert!(alone);
        assert!(matches!(a.busy(STOP), Err(LabError::Interrupted)), "work beside what is timed alone");
        assert!(
            matches!(a.quiet(Duration::ZERO, STOP), Err(LabError::Interrupted)),
            "timed beside what is timed alone"
        );
        drop(timed);
        a.busy(GO).unwrap();
    }
}
