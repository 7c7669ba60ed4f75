//! Arrays as NumPy's NPY, version 1.0.

use super::ImageError;

const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
/// Data begins at a multiple of this (NumPy Enhancement Proposal 1).
const ALIGNMENT: usize = 64;

/// A number that an array can hold.
pub trait NpyElement: Copy {
    /// NumPy's name of the type, little-endian.
    const DESCR: &'static str;
    /// Its bytes, little-endian.
    fn bytes(self) -> [u8; 4];
}

impl NpyElement for f32 {
    const DESCR: &'static str = "<f4";
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

impl NpyElement for u32 {
    const DESCR: &'static str = "<u4";
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

/// An array of `shape`, in C order (the last index runs fastest), as an NPY file.
///
/// # Errors
/// [`ImageError::Format`] if `data` does not fill `shape`, or has more dimensions than a header of version 1.0 takes.
///
/// # Examples
/// ```
/// let bytes = nephroid::image::to_npy(&[2, 3], &[0.0f32; 6]).unwrap();
/// assert_eq!(bytes.len(), 128 + 6 * 4);
/// ```
pub fn to_npy<T: NpyElement>(shape: &[usize], data: &[T]) -> Result<Vec<u8>, ImageError> {
    let refused = |problem: String| ImageError::Format { format: "NPY", problem };
    let expected = shape.iter().try_fold(1usize, |product, &n| product.checked_mul(n));
    if expected != Some(data.len()) {
        return Err(refused(format!("{} values do not fill the shape {shape:?}", data.len())));
    }
    let header = header(T::DESCR, shape);
    let length = u16::try_from(header.len()).map_err(|_| refused(format!("{} dimensions", shape.len())))?;
    let mut file = Vec::with_capacity(MAGIC.len() + 2 + header.len() + 4 * data.len());
    file.extend_from_slice(MAGIC);
    file.extend_from_slice(&length.to_le_bytes());
    file.extend_from_slice(header.as_bytes());
    file.extend(data.iter().flat_map(|value| value.bytes()));
    Ok(file)
}

/// The dictionary, padded with spaces to the alignment and ended by a new line.
fn header(descr: &str, shape: &[usize]) -> String {
    let shape: String = shape.iter().map(|n| format!("{n}, ")).collect();
    // A tuple of one keeps its comma, longer ones need none at the end.
    let shape = if shape.matches(',').count() > 1 { shape.trim_end_matches(", ") } else { shape.trim_end() };
    let dictionary = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({shape}), }}");
    let before = MAGIC.len() + 2;
    let padded = (before + dictionary.len() + 1).next_multiple_of(ALIGNMENT) - before - 1;
    format!("{dictionary:<padded$}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_those_numpy_writes() {
        let bytes = to_npy(&[2, 1], &[1.0f32, -2.0]).unwrap();
        let mut expected =
            b"\x93NUMPY\x01\x00\x76\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1), }".to_vec();
        expected.resize(127, b' ');
        expected.extend_from_slice(b"\n\x00\x00\x80\x3f\x00\x00\x00\xc0");
        assert_eq!(bytes, expected);
    }

    #[test]
    fn shapes_are_python_tuples() {
        for (shape, tuple) in [(&[][..], "()"), (&[3], "(3,)"), (&[0, 4], "(0, 4)"), (&[2, 3, 4], "(2, 3, 4)")] {
            let header = header("<u4", shape);
            assert!(header.contains(&format!("'shape': {tuple}, }}")), "{header}");
            assert_eq!((header.len() + 10) % ALIGNMENT, 0);
        }
    }

    #[test]
    fn integers_and_scalars() {
        assert!(to_npy(&[1], &[0x0102_0304u32]).unwrap().ends_with(b"\n\x04\x03\x02\x01"));
        assert!(to_npy(&[], &[1u32]).unwrap().ends_with(b"\n\x01\x00\x00\x00"));
        assert!(to_npy::<u32>(&[0, 7], &[]).unwrap().ends_with(b" \n"));
    }

    #[test]
    fn data_that_does_not_fill_the_shape_is_refused() {
        let message = to_npy(&[2, 2], &[1u32; 3]).unwrap_err().to_string();
        assert!(message.contains("3 values do not fill the shape [2, 2]"), "{message}");
        assert!(to_npy(&[usize::MAX, 2], &[1u32; 3]).is_err());
    }
}
