//! Signals that become errors, so that what was begun can be taken back.

use std::{
    io,
    sync::{Arc, atomic::AtomicBool},
};

/// A write beyond the limit of file sizes fails as a full disk does, and does not kill the program.
pub fn file_size_limit_is_an_error() -> io::Result<()> {
    #[cfg(unix)]
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    Ok(())
}

/// A flag that Ctrl-C or a request to end raises; the second one ends the program at once.
pub fn stop_flag() -> io::Result<Arc<AtomicBool>> {
    use signal_hook::{consts, flag};
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [consts::SIGINT, consts::SIGTERM] {
        flag::register_conditional_shutdown(signal, 128 + signal, stop.clone())?;
        flag::register(signal, stop.clone())?;
    }
    Ok(stop)
}
