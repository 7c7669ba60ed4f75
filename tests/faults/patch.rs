//! A planted fault: one passage of a shipped GLSL file replaced, and the check that has to notice.

use crate::checks::Check;
use nephroid::gpu::Sources;

/// A fault, and who catches it.
pub struct Fault {
    /// In a few words.
    pub name: &'static str,
    /// Path below `glsl/`.
    pub file: &'static str,
    /// The passage, which must stand there exactly once: a patch that no longer applies proves nothing.
    pub old: &'static str,
    /// What stands there instead.
    pub new: &'static str,
    /// The check named for it.
    pub check: &'static Check,
}

impl Fault {
    /// The shaders with the fault in them; an error that names it where the passage is not there once.
    pub fn plant(&self) -> Result<Sources, String> {
        let mut sources = Sources::default();
        let text = sources.text(self.file).ok_or_else(|| format!("{}: there is no glsl/{}", self.name, self.file))?;
        let times = text.matches(self.old).count();
        if times != 1 {
            return Err(format!("{}: glsl/{} holds {:?} {times} times, not once", self.name, self.file, self.old));
        }
        let faulty = text.replace(self.old, self.new);
        sources.replace(self.file, faulty);
        Ok(sources)
    }
}
