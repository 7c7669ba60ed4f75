//! The order of a header's attributes.

use crate::image::ImageError;

/// Magic number and version, before the first attribute.
const PREAMBLE: usize = 8;

/// Sorts the attributes of a single-part file by name, in place, as the OpenEXR library writes them.
///
/// The writer keeps them in a hash map and would put them in another order at every run. Sorting moves bytes within the
/// header alone, so the offsets behind it stay right.
///
/// # Errors
/// [`ImageError::Format`] if the bytes have no whole header.
pub fn sort_attributes(file: &mut [u8]) -> Result<(), ImageError> {
    let broken = || ImageError::Format { format: "EXR", problem: "the header ends early".into() };
    let mut end = PREAMBLE;
    let mut attributes = Vec::new();
    while *file.get(end).ok_or_else(broken)? != 0 {
        let size = attribute_size(&file[end..]).filter(|size| end + size < file.len()).ok_or_else(broken)?;
        attributes.push(file[end..end + size].to_vec());
        end += size;
    }
    attributes.sort_unstable();
    file[PREAMBLE..end].copy_from_slice(&attributes.concat());
    Ok(())
}

/// Bytes of the attribute at the front: name, zero, type, zero, 32-bit length, value.
fn attribute_size(bytes: &[u8]) -> Option<usize> {
    let name = bytes.iter().position(|&b| b == 0)? + 1;
    let kind = name + bytes[name..].iter().position(|&b| b == 0)? + 1;
    let value = kind + 4;
    let length = i32::from_le_bytes(bytes.get(kind..value)?.try_into().ok()?);
    Some(value + usize::try_from(length).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attribute(name: &str, value: &[u8]) -> Vec<u8> {
        let length = (value.len() as i32).to_le_bytes();
        [name.as_bytes(), b"\0string\0", &length, value].concat()
    }

    #[test]
    fn attributes_are_sorted_and_what_follows_stays() {
        let (a, b, c) = (attribute("a", b"long value"), attribute("ab", b""), attribute("b", b"\0\0x"));
        let file = |order: [&Vec<u8>; 3]| [&b"12345678"[..], &order.map(Vec::as_slice).concat(), b"\0pixels"].concat();
        let mut shuffled = file([&c, &a, &b]);
        sort_attributes(&mut shuffled).unwrap();
        assert_eq!(shuffled, file([&a, &b, &c]));
    }

    #[test]
    fn a_header_that_ends_early_is_an_error() {
        let whole = [&b"12345678"[..], &attribute("a", b"value"), b"\0"].concat();
        for length in 0..whole.len() {
            assert!(sort_attributes(&mut whole[..length].to_vec()).is_err(), "{length} bytes");
        }
        assert!(sort_attributes(&mut b"12345678a\0b\0\xff\xff\xff\xff\0".to_vec()).is_err());
    }
}
