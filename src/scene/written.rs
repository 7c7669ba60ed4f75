//! A file that is written as scenes are, TOML by hand, without being one: its faults are said as a scene's are.
use serde::de::DeserializeOwned;
use toml::{Deserializer, Spanned, de::DeTable};

use super::{
    error::{Place, SceneError},
    load::{malformed, misfit, read},
    locate::{Key, Locator, place_in},
};

/// Its text, as it was read.
pub struct Written {
    file: String,
    text: String,
}

impl Written {
    /// Reads a file.
    ///
    /// # Errors
    /// [`SceneError`] where it cannot be read or is no UTF-8.
    pub fn read(file: &str) -> Result<Self, SceneError> {
        let fault = |place: Place, expected: &str, found: String, remedy: &str| SceneError {
            place: Box::new(place),
            key: String::new(),
            expected: expected.to_owned(),
            found,
            remedy: remedy.to_owned(),
        };
        let bytes = read(std::path::Path::new(file))
            .map_err(|why| fault(Place::Scene(file.to_owned()), "a readable file", why, "check the path"))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            let byte = format!("the byte 0x{:02x}", error.as_bytes()[at]);
            fault(place_in(file, error.as_bytes(), at), "UTF-8 text", byte, "save the file as UTF-8")
        })?;
        Ok(Self { file: file.to_owned(), text })
    }

    /// What it says.
    ///
    /// # Errors
    /// [`SceneError`] at the place of what is no TOML, or does not fit.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, SceneError> {
        let locator = self.locator()?;
        let root = Deserializer::from(Spanned::new(0..0, locator.tree.clone()));
        T::deserialize(root).map_err(|error| misfit(&locator, &error))
    }

    /// A fault of a key, named by the path to it; elements of a list by their number.
    pub fn fault(
        &self,
        path: &[&str],
        expected: impl Into<String>,
        found: impl Into<String>,
        remedy: impl Into<String>,
    ) -> SceneError {
        match self.locator() {
            Ok(locator) => {
                let root = locator.root();
                let key = path.iter().fold(root, |key: Key, name| key.key(name));
                key.fault(expected, found, remedy)
            }
            Err(fault) => fault,
        }
    }

    fn locator(&self) -> Result<Locator<'_>, SceneError> {
        let tree = DeTable::parse(&self.text).map_err(|error| malformed(&self.file, &self.text, &error))?;
        Ok(Locator { file: &self.file, text: &self.text, overrides: &[], tree: tree.into_inner() })
    }
}
