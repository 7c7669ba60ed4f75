//! Layered OpenEXR: one part, float32, lossless (ZIP blocks of 16 lines).
//!
//! Channels are grouped by prefix, as viewers expect: layer `irradiance.direct` is written as the channels
//! `irradiance.direct.R`, `.G`, `.B`, a scalar layer as `mask.Y`. The first layer is the main picture and has plain
//! `R`, `G`, `B` (or `Y`), so that every viewer opens it; the attribute `mainLayer` keeps its name. Provenance is one
//! string attribute an entry, `nephroid.NAME`, UTF-8.

mod guard;
mod header;

#[cfg(test)]
mod tests;

use super::{ImageError, Layers, Provenance};
use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image};
use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Text};
use exr::prelude::{ReadChannels, ReadLayers, WritableImage};
use std::collections::BTreeMap;
use std::io::Cursor;

/// Channel names of a layer by their count.
const CHANNELS: [&[&str]; 4] = [&["Y"], &["R", "G"], &["R", "G", "B"], &["R", "G", "B", "A"]];
/// The attribute with the name of the layer whose channels have no prefix.
const MAIN: &str = "mainLayer";
/// The name of that layer in files that do not say it.
const MAIN_UNNAMED: &str = "radiance";
/// What our attributes begin with; no standard attribute does.
const PREFIX: &str = "nephroid.";
/// The longest name of an attribute in the format, bytes.
const MAX_ATTRIBUTE: usize = 255;
/// Values from which a pool of threads is worth its start (some milliseconds).
const PARALLEL_FROM: usize = 1 << 20;

impl Layers {
    /// The image as an EXR file; the same bytes for the same input.
    ///
    /// # Errors
    /// [`ImageError::Empty`] without pixels or layers; [`ImageError::Provenance`] for a name that the format cannot
    /// hold (empty, over 246 bytes, or with a zero byte).
    pub fn to_exr(&self, provenance: &Provenance) -> Result<Vec<u8>, ImageError> {
        let values = self.width() * self.height() * self.iter().map(|l| l.channels()).sum::<usize>();
        encode(self, provenance, values >= PARALLEL_FROM)
    }

    /// Reads the layers and the provenance of an EXR file, its first part; 16-bit and integer channels become float32.
    ///
    /// The main picture comes first, the others by name. Channels that form no layer of ours (`Z`, `N.X`) become scalar
    /// layers of their full name.
    ///
    /// # Errors
    /// [`ImageError::Format`] if the bytes are not an EXR file, or subsampled, in several resolutions, compressed with loss,
    /// or too few for the pixels that they announce; [`ImageError::Layer`] for names that [`Layers::push`] refuses.
    pub fn from_exr(bytes: &[u8]) -> Result<(Self, Provenance), ImageError> {
        let chunks = exr::block::read(Cursor::new(bytes), false).map_err(format_error)?;
        chunks.headers().iter().try_for_each(|header| guard::check(header, bytes.len()))?;
        let image = exr::image::read::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            // On a pool's thread, what a damaged block brings to a panic would end the process.
            .non_parallel()
            .from_chunks(chunks)
            .map_err(format_error)?;
        let part = &image.layer_data;
        let mut texts: BTreeMap<String, String> =
            image.attributes.other.iter().chain(&part.attributes.other).filter_map(text_attribute).collect();
        let main = texts.remove(MAIN).unwrap_or(MAIN_UNNAMED.to_owned());
        let mut layers = Self::new(part.size.width(), part.size.height());
        for (name, channels) in group(&part.channel_data.list, &main) {
            layers.push(&name, channels.len(), interleave(&channels))?;
        }
        Ok((layers, ours(texts)))
    }

    /// Pixels across and down of an EXR file's first part, by its header alone.
    ///
    /// # Errors
    /// [`ImageError::Format`] if the bytes do not begin as an EXR file.
    pub fn size_of_exr(bytes: &[u8]) -> Result<[u64; 2], ImageError> {
        let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(format_error)?;
        let size = meta.headers.first().map(|header| header.layer_size);
        Ok(size.map_or([0, 0], |size| [size.width() as u64, size.height() as u64]))
    }

    /// Reads the provenance of an EXR file, and none of its pixels.
    ///
    /// # Errors
    /// [`ImageError::Format`] if the bytes do not begin as an EXR file.
    pub fn provenance_of_exr(bytes: &[u8]) -> Result<Provenance, ImageError> {
        let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(format_error)?;
        let first = meta.headers.first().map(|h| h.shared_attributes.other.iter().chain(&h.own_attributes.other));
        Ok(ours(first.into_iter().flatten().filter_map(text_attribute)))
    }
}

fn encode(layers: &Layers, provenance: &Provenance, parallel: bool) -> Result<Vec<u8>, ImageError> {
    let (width, height) = (layers.width(), layers.height());
    let Some(main) = layers.iter().next().filter(|_| width * height > 0) else {
        return Err(ImageError::Empty { width, height, layers: layers.iter().len() });
    };
    let channels =
        AnyChannels::sort(layers.iter().flat_map(|layer| planes(layer, std::ptr::eq(layer, main))).collect());
    let mut image = Image::from_encoded_channels((width, height), Encoding::SMALL_LOSSLESS, channels);
    let attributes = &mut image.layer_data.attributes.other;
    attributes.insert(Text::from(MAIN), text_value(main.name()));
    for (name, value) in provenance {
        attributes.insert(attribute_name(name)?, text_value(value));
    }
    let mut file = Cursor::new(Vec::new());
    let writer = image.write();
    let writer = if parallel { writer } else { writer.non_parallel() };
    writer.to_buffered(&mut file).map_err(format_error)?;
    let mut bytes = file.into_inner();
    header::sort_attributes(&mut bytes)?;
    Ok(bytes)
}

/// The channels of one layer, each a plane of its own.
fn planes(layer: &super::Layer, main: bool) -> impl Iterator<Item = AnyChannel<FlatSamples>> {
    CHANNELS[layer.channels() - 1].iter().enumerate().map(move |(c, component)| {
        let name = if main { component.to_string() } else { format!("{}.{component}", layer.name()) };
        let plane = layer.data().iter().skip(c).step_by(layer.channels()).copied().collect();
        AnyChannel::new(name.as_str(), FlatSamples::F32(plane))
    })
}

fn attribute_name(name: &str) -> Result<Text, ImageError> {
    if name.is_empty() || name.contains('\0') || PREFIX.len() + name.len() > MAX_ATTRIBUTE {
        let limit = MAX_ATTRIBUTE - PREFIX.len();
        return Err(ImageError::provenance(name, format!("a name is 1 to {limit} bytes, none of them zero")));
    }
    Ok(Text::from_slice_unchecked(format!("{PREFIX}{name}").as_bytes()))
}

/// Bytes as they are: the format leaves the encoding open, and readers take it for UTF-8.
fn text_value(text: &str) -> AttributeValue {
    AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes()))
}

fn ours(texts: impl IntoIterator<Item = (String, String)>) -> Provenance {
    let named = |(name, text): (String, String)| Some((name.strip_prefix(PREFIX)?.to_owned(), text));
    texts.into_iter().filter_map(named).collect()
}

fn utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

fn text_attribute((name, value): (&Text, &AttributeValue)) -> Option<(String, String)> {
    match value {
        AttributeValue::Text(text) => Some((utf8(name), utf8(text))),
        _ => None,
    }
}

/// Joins channels to layers: (layer name, its channels in the order of [`CHANNELS`]), the main picture first.
fn group<'a>(list: &'a [AnyChannel<FlatSamples>], main: &str) -> Vec<(String, Vec<&'a FlatSamples>)> {
    let mut prefixes: BTreeMap<String, BTreeMap<String, &FlatSamples>> = BTreeMap::new();
    for channel in list {
        let name = utf8(&channel.name);
        let (prefix, component) = name.rsplit_once('.').unwrap_or(("", &name));
        prefixes.entry(prefix.to_owned()).or_default().insert(component.to_owned(), &channel.sample_data);
    }
    prefixes.into_iter().flat_map(|(prefix, parts)| split(prefix, parts, main)).collect()
}

/// The largest set of [`CHANNELS`] under one prefix is a layer of that name; what is left over, scalar layers.
fn split<'a>(
    prefix: String,
    mut parts: BTreeMap<String, &'a FlatSamples>,
    main: &str,
) -> Vec<(String, Vec<&'a FlatSamples>)> {
    let mut layers = Vec::new();
    let complete = CHANNELS.iter().rev().find(|names| names.iter().all(|n| parts.contains_key(*n)));
    if let Some(names) = complete {
        let planes = names.iter().filter_map(|n| parts.remove(*n)).collect();
        layers.push((if prefix.is_empty() { main.to_owned() } else { prefix.clone() }, planes));
    }
    let full = |part: String| if prefix.is_empty() { part } else { format!("{prefix}.{part}") };
    layers.extend(parts.into_iter().map(|(part, plane)| (full(part), vec![plane])));
    layers
}

fn interleave(planes: &[&FlatSamples]) -> Vec<f32> {
    let planes: Vec<Vec<f32>> = planes.iter().map(|plane| plane.values_as_f32().collect()).collect();
    (0..planes[0].len()).flat_map(|i| planes.iter().filter_map(move |plane| plane.get(i).copied())).collect()
}

fn format_error(error: exr::error::Error) -> ImageError {
    ImageError::Format { format: "EXR", problem: error.to_string() }
}
