use super::*;
use crate::image::Layer;

fn sample() -> Layers {
    let mut image = Layers::new(3, 2);
    let ramp = |n: usize| (0..n).map(|i| 0.1 + i as f32).collect::<Vec<f32>>();
    image.push("radiance", 3, ramp(18)).unwrap();
    image.push("irradiance.direct", 3, ramp(18).into_iter().rev().collect()).unwrap();
    image.push("mask", 1, vec![0.0, 1.0, f32::INFINITY, f32::NAN, -0.0, f32::MIN_POSITIVE]).unwrap();
    image
}

fn provenance() -> Provenance {
    let entries =
        [("scene", "glass-sphere"), ("device", "llvmpipe"), ("seed", "1"), ("title", "Ätzend ꟻLIP"), ("e", "")];
    entries.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect()
}

fn bits(layer: &Layer) -> Vec<u32> {
    layer.data().iter().map(|v| v.to_bits()).collect()
}

#[test]
fn every_bit_comes_back() {
    let (image, about) = Layers::from_exr(&sample().to_exr(&provenance()).unwrap()).unwrap();
    assert_eq!(about, provenance());
    assert_eq!(Layers::provenance_of_exr(&sample().to_exr(&provenance()).unwrap()).unwrap(), about);
    assert_eq!(image.iter().map(Layer::name).collect::<Vec<_>>(), ["radiance", "irradiance.direct", "mask"]);
    for (ours, theirs) in image.iter().zip(sample().iter()) {
        assert_eq!((ours.channels(), bits(ours)), (theirs.channels(), bits(theirs)));
    }
}

#[test]
fn channels_are_named_as_viewers_expect() {
    let bytes = sample().to_exr(&Provenance::new()).unwrap();
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(&bytes), true).unwrap();
    let names: Vec<String> = meta.headers[0].channels.list.iter().map(|c| c.name.to_string()).collect();
    let direct = ["irradiance.direct.B", "irradiance.direct.G", "irradiance.direct.R"];
    assert_eq!(names, [&["B", "G", "R"][..], &direct, &["mask.Y"]].concat());
}

#[test]
fn any_layer_can_be_the_main_picture() {
    for channels in 1..=4 {
        let mut image = Layers::new(2, 2);
        image.push("maps/map", channels, (0..4 * channels).map(|i| i as f32).collect()).unwrap();
        image.push("a", 1, vec![9.0; 4]).unwrap();
        let (back, _) = Layers::from_exr(&image.to_exr(&Provenance::new()).unwrap()).unwrap();
        assert_eq!(back, image);
    }
}

/// The attributes pass through a hash map with a new random order each time.
#[test]
fn two_writes_are_the_same_bytes() {
    let first = sample().to_exr(&provenance()).unwrap();
    for _ in 0..20 {
        assert!(sample().to_exr(&provenance()).unwrap() == first);
    }
}

#[test]
fn threads_change_no_byte() {
    let (width, height) = (301, 407);
    let mut image = Layers::new(width, height);
    let noise = |i: usize| (i as f32 * 12.9898).sin() * 43758.547;
    image.push("radiance", 3, (0..width * height * 3).map(noise).collect()).unwrap();
    let alone = encode(&image, &provenance(), false).unwrap();
    for _ in 0..10 {
        assert!(encode(&image, &provenance(), true).unwrap() == alone);
    }
}

#[test]
fn what_cannot_be_written_says_why() {
    let error = Layers::new(4, 4).to_exr(&Provenance::new()).unwrap_err().to_string();
    assert_eq!(error, "an image of 4 × 4 pixels and 0 layers has nothing to write");
    let mut flat = Layers::new(0, 4);
    flat.push("radiance", 3, Vec::new()).unwrap();
    assert!(flat.to_exr(&Provenance::new()).unwrap_err().to_string().contains("0 × 4"));
    for bad in ["", "zero\0byte", &"x".repeat(247)] {
        let about = Provenance::from([(bad.to_owned(), String::new())]);
        assert!(matches!(sample().to_exr(&about), Err(ImageError::Provenance { .. })), "{bad:?}");
    }
    let longest = Provenance::from([("x".repeat(246), "long".to_owned())]);
    assert_eq!(Layers::from_exr(&sample().to_exr(&longest).unwrap()).unwrap().1, longest);
}

#[test]
fn broken_files_are_errors() {
    let whole = sample().to_exr(&provenance()).unwrap();
    for bytes in [&b""[..], b"not an image", &whole[..100], &whole[..whole.len() - 20]] {
        assert!(matches!(Layers::from_exr(bytes), Err(ImageError::Format { .. })), "{} bytes", bytes.len());
    }
    for bytes in [&b""[..], b"not an image", &whole[..100]] {
        assert!(Layers::provenance_of_exr(bytes).is_err(), "{} bytes", bytes.len());
    }
}

/// Memory for the pixels of a header is asked for before the first of them is read.
#[test]
fn a_header_that_announces_more_than_its_file_holds_is_an_error() {
    let mut bytes = sample().to_exr(&Provenance::new()).unwrap();
    let window = bytes.windows(10).position(|w| w == b"dataWindow").unwrap();
    // Its name, its type and its length, then smallest x and y, then the largest x: rows, and so blocks, stay as many.
    let width = window + "dataWindow\0box2i\0".len() + 4 + 8;
    for side in [0xf_ffff_u32, 0xfff_ffff] {
        bytes[width..width + 4].copy_from_slice(&side.to_le_bytes());
        let error = Layers::from_exr(&bytes).unwrap_err().to_string();
        assert!(error.contains("EXR") && error.contains("announced"), "{error}");
    }
}

/// Blocks that the decoder does not survive when they are damaged are refused whole.
#[test]
fn lossy_files_and_several_resolutions_are_refused() {
    use exr::prelude::{Blocks, Compression, LineOrder, Vec2};
    let encoded = |compression: Compression| {
        let encoding = Encoding { compression, blocks: Blocks::Tiles(Vec2(16, 16)), line_order: LineOrder::Increasing };
        let list = [AnyChannel::new("Y", FlatSamples::F32(vec![1.0]))].into_iter().collect();
        let mut file = Cursor::new(Vec::new());
        let image = Image::from_encoded_channels((1, 1), encoding, AnyChannels::sort(list));
        image.write().non_parallel().to_buffered(&mut file).unwrap();
        file.into_inner()
    };
    let error = Layers::from_exr(&encoded(Compression::B44)).unwrap_err().to_string();
    assert!(error.contains("b44") && error.contains("ZIP"), "{error}");
    let mut levels = encoded(Compression::ZIP16);
    assert_eq!(Layers::from_exr(&levels).unwrap().0.width(), 1);
    // The mode of the levels is the last byte of the value: two sides of four bytes stand before it.
    let tiles = levels.windows(8).position(|w| w == b"tiledesc").unwrap();
    levels[tiles + "tiledesc\0".len() + 4 + 8] = 1;
    let error = Layers::from_exr(&levels).unwrap_err().to_string();
    assert!(error.contains("several resolutions"), "{error}");
}

#[test]
fn foreign_channels_become_layers_too() {
    let plane = |v: f32| FlatSamples::F32(vec![v; 4]);
    // R is of 16 bits.
    let half = FlatSamples::F16(vec![exr::prelude::f16::from_f32(0.5); 4]);
    let channels = [("R", half), ("G", plane(1.0)), ("B", plane(2.0)), ("Z", plane(3.0)), ("depth.Z", plane(4.0))];
    let list = channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect();
    let image = Image::from_encoded_channels((2, 2), Encoding::SMALL_LOSSLESS, AnyChannels::sort(list));
    let mut file = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut file).unwrap();
    let (layers, about) = Layers::from_exr(file.get_ref()).unwrap();
    assert!(about.is_empty());
    assert_eq!(layers.get("radiance").unwrap().pixels().next(), Some(&[0.5, 1.0, 2.0][..]));
    assert_eq!(layers.get("Z").unwrap().data(), [3.0; 4]);
    assert_eq!(layers.get("depth.Z").unwrap().data(), [4.0; 4]);
}
