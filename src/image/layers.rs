//! Named float layers of one size.

use super::ImageError;

/// The most channels a layer has: red, green, blue, alpha.
pub const MAX_CHANNELS: usize = 4;

/// The longest layer name: EXR allows 255 bytes for a channel's, of which two are ".R".
const MAX_NAME: usize = 253;

/// One layer: `channels` float32 values a pixel, interleaved, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    name: String,
    channels: usize,
    data: Vec<f32>,
}

impl Layer {
    /// The name it is found by, such as `irradiance.direct`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Values a pixel: 1 for a scalar, 3 for RGB.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// All values, width × height × channels of them.
    pub fn data(&self) -> &[f32] {
        &self.data
    }

    /// The values of each pixel in turn.
    pub fn pixels(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.data.chunks_exact(self.channels)
    }
}

/// Layers of one size. The first is the main picture: the one that viewers open.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    width: usize,
    height: usize,
    layers: Vec<Layer>,
}

impl Layers {
    /// An image of `width` × `height` pixels, without layers yet.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, layers: Vec::new() }
    }

    /// Adds a layer: `data` interleaved, rows from the top; 1 to 4 `channels`.
    ///
    /// # Errors
    /// [`ImageError::Layer`] if the data is not width × height × channels long, or the name is taken, longer than 253
    /// bytes, not of printable ASCII, or begins or ends with a dot (dots separate a layer from its channels).
    pub fn push(&mut self, name: &str, channels: usize, data: Vec<f32>) -> Result<(), ImageError> {
        let expected = self.width.checked_mul(self.height).and_then(|n| n.checked_mul(channels));
        let problem = if !(1..=MAX_CHANNELS).contains(&channels) {
            format!("{channels} channels, where 1 to {MAX_CHANNELS} are possible")
        } else if expected != Some(data.len()) {
            format!("{} values do not fill {} × {} × {channels}", data.len(), self.width, self.height)
        } else if !is_name(name) {
            format!("a name is 1 to {MAX_NAME} printable ASCII characters, no dot first or last")
        } else if self.get(name).is_some() {
            "two layers of this name".to_owned()
        } else {
            self.layers.push(Layer { name: name.to_owned(), channels, data });
            return Ok(());
        };
        Err(ImageError::layer(name, problem))
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The layer of that name.
    pub fn get(&self, name: &str) -> Option<&Layer> {
        self.layers.iter().find(|layer| layer.name == name)
    }

    /// All layers, the main picture first.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Layer> {
        self.layers.iter()
    }
}

fn is_name(name: &str) -> bool {
    let dotted = name.starts_with('.') || name.ends_with('.');
    !dotted && (1..=MAX_NAME).contains(&name.len()) && name.bytes().all(|b| b.is_ascii_graphic())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_found_by_name_in_the_order_given() {
        let mut image = Layers::new(2, 1);
        image.push("radiance", 3, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
        image.push("mask", 1, vec![0.0, 1.0]).unwrap();
        assert_eq!(image.iter().map(Layer::name).collect::<Vec<_>>(), ["radiance", "mask"]);
        assert_eq!(image.get("radiance").unwrap().pixels().nth(1), Some(&[4.0, 5.0, 6.0][..]));
        assert!(image.get("direct").is_none());
    }

    #[test]
    fn what_does_not_fit_is_refused_by_name() {
        let mut image = Layers::new(2, 1);
        image.push("a", 1, vec![0.0; 2]).unwrap();
        let mut refused = |name, channels, len| image.push(name, channels, vec![0.0; len]).unwrap_err().to_string();
        assert_eq!(refused("b", 3, 5), "image layer \"b\": 5 values do not fill 2 × 1 × 3");
        assert!(refused("b", 0, 0).contains("0 channels"));
        assert!(refused("b", 5, 10).contains("5 channels"));
        assert!(refused("a", 1, 2).contains("two layers"));
        for bad in ["", ".a", "a.", "a b", "ä", &"x".repeat(254)] {
            assert!(refused(bad, 1, 2).contains("printable"), "{bad}");
        }
    }
}
