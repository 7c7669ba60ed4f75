//! Sums over chunks, pixel by pixel: the mean and its variance.

/// Bands of each pixel.
pub const BANDS: usize = 3;

/// Sum and sum of squares of the chunks' pictures. Chunks are added one at a time in their order, so the result does
/// not depend on how many threads made them.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    /// How many chunks.
    pub chunks: u64,
    sum: Vec<f64>,
    squares: Vec<f64>,
}

impl Sums {
    /// Of no chunk yet.
    pub fn new(pixels: usize) -> Self {
        Self { chunks: 0, sum: vec![0.0; pixels * BANDS], squares: vec![0.0; pixels * BANDS] }
    }

    /// Adds a chunk's picture.
    pub fn add(&mut self, picture: &[f64]) {
        self.chunks += 1;
        for ((sum, square), x) in self.sum.iter_mut().zip(&mut self.squares).zip(picture) {
            *sum += x;
            *square += x * x;
        }
    }

    /// The estimate.
    pub fn mean(&self) -> impl Iterator<Item = f64> + '_ {
        let n = self.chunks.max(1) as f64;
        self.sum.iter().map(move |s| s / n)
    }

    /// Variance of the estimate, from the spread of the chunks; infinite below two of them.
    pub fn variance(&self) -> impl Iterator<Item = f64> + '_ {
        let n = self.chunks as f64;
        let one = move |s: f64, q: f64| ((q - s * s / n) / (n * (n - 1.0))).max(0.0);
        let known = self.chunks > 1;
        self.sum.iter().zip(&self.squares).map(move |(s, q)| if known { one(*s, *q) } else { f64::INFINITY })
    }

    /// As bytes, little-endian: the count, the sums, the sums of squares.
    pub fn to_bytes(&self) -> Vec<u8> {
        let numbers = self.sum.iter().chain(&self.squares).flat_map(|x| x.to_le_bytes());
        self.chunks.to_le_bytes().into_iter().chain(numbers).collect()
    }

    /// From [`Self::to_bytes`] of as many pixels; `None` for another length.
    pub fn from_bytes(bytes: &[u8], pixels: usize) -> Option<Self> {
        let (count, numbers) = bytes.split_first_chunk::<8>()?;
        let (words, rest) = numbers.as_chunks::<8>();
        if !rest.is_empty() || words.len() != 2 * pixels * BANDS {
            return None;
        }
        let mut sum: Vec<f64> = words.iter().map(|w| f64::from_le_bytes(*w)).collect();
        let squares = sum.split_off(pixels * BANDS);
        Some(Self { chunks: u64::from_le_bytes(*count), sum, squares })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::estimate::Judged;

    #[test]
    fn mean_and_variance_by_hand() {
        let mut sums = Sums::new(1);
        [[1.0, 0.0, 2.0], [3.0, 0.0, 2.0], [5.0, 3.0, 2.0]].iter().for_each(|p| sums.add(p));
        assert_eq!(sums.mean().collect::<Vec<_>>(), [3.0, 1.0, 2.0]);
        // Sample variances 4, 3, 0, each over 3 chunks.
        let variance: Vec<_> = sums.variance().collect();
        assert!((variance[0] - 4.0 / 3.0).abs() < 1e-15 && (variance[1] - 1.0).abs() < 1e-15 && variance[2] == 0.0);
        let noise = |judged| Judged { pixels: vec![judged], epsilon: 1.0 }.noise(sums.mean(), sums.variance());
        assert!((noise(true) - (4.0 / 3.0 / 10.0 + 1.0 / 2.0) / 3.0).abs() < 1e-15);
        assert_eq!(noise(false), 0.0);
    }

    #[test]
    fn one_chunk_says_nothing_of_its_noise() {
        let mut sums = Sums::new(1);
        sums.add(&[1.0; 3]);
        assert!(sums.variance().all(|v| v == f64::INFINITY));
    }

    #[test]
    fn bytes_give_back_every_bit() {
        let mut sums = Sums::new(2);
        sums.add(&[0.1, 1e-300, 3.0, -0.0, 1e300, 7.0]);
        let bytes = sums.to_bytes();
        assert_eq!(Sums::from_bytes(&bytes, 2), Some(sums));
        assert_eq!(Sums::from_bytes(&bytes, 1), None);
        assert_eq!(Sums::from_bytes(&bytes[1..], 2), None);
    }
}
