//! Stand-in
/// S
pub struct Store;
impl Store {
    /// o
    pub fn open() -> Self {
        Self
    }
    /// g
    pub fn get(&self, _kind: &str, _key: &str) -> Option<Vec<u8>> {
        None
    }
    /// p
    pub fn put(&self, _kind: &str, _key: &str, _bytes: &[u8]) -> std::io::Result<()> {
        Ok(())
    }
}
