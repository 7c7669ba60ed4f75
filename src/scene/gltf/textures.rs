//! Base colour textures: which picture, how often, and what of it is left out.
use std::{collections::BTreeMap, sync::Arc};

use super::{
    Document, EXPORT, GltfFault, ReadBeside, container, fault,
    json::{Root, TextureInfo},
    named,
};
use crate::scene::{MaterialKind, Picture, Texture};

/// A texture's edges that go on.
const REPEATS: u32 = 10497;

/// The pictures that base colours name, by image; none for those of a kind that is not read.
pub type Pictures = BTreeMap<usize, Option<Arc<Picture>>>;

/// Reads them, and no others: a file may hold more images than are ever shown.
pub fn pictures(document: &mut Document, beside: &mut ReadBeside) -> Result<(), GltfFault> {
    let json = &document.json;
    let mut used = Vec::new();
    for (index, material) in json.materials.iter().enumerate() {
        if let Some(info) = &material.pbr_metallic_roughness.base_color_texture {
            used.extend(source(json, info, &format!("materials[{index}].pbrMetallicRoughness.baseColorTexture"))?);
        }
    }
    for image in used {
        if !document.pictures.contains_key(&image) {
            let picture = picture(document, image, beside)?;
            document.size += picture.as_ref().map_or(0, |(_, bytes)| *bytes);
            document.pictures.insert(image, picture.map(|(picture, _)| picture));
        }
    }
    Ok(())
}

/// The image of a texture; none where an extension alone names it.
fn source(json: &Root, info: &TextureInfo, path: &str) -> Result<Option<usize>, GltfFault> {
    let texture = named(&json.textures, info.index, &format!("{path}.index"), "textures")?;
    let Some(image) = texture.source else { return Ok(None) };
    named(&json.images, image, &format!("textures[{}].source", info.index), "images")?;
    Ok(Some(image))
}

/// A picture, and the bytes of it that are not in a buffer.
fn picture(
    document: &Document,
    index: usize,
    beside: &mut ReadBeside,
) -> Result<Option<(Arc<Picture>, usize)>, GltfFault> {
    let (path, image) = (format!("images[{index}]"), &document.json.images[index]);
    let (held, label);
    let (bytes, apart): (&[u8], usize) = match (image.buffer_view, image.uri.as_deref()) {
        (Some(view), _) => {
            label = format!("image {index}");
            (document.bytes_of(view, &format!("{path}.bufferView"))?, 0)
        }
        (None, Some(uri)) if uri.starts_with("data:") => {
            held = container::data(&path, uri)?;
            label = format!("image {index}");
            (&held, 0)
        }
        (None, Some(uri)) => {
            label = container::local(&path, uri)?;
            let remedy = "embed the images, or put them beside the glTF file";
            held = beside(&label)
                .map_err(|why| fault(format!("{path}.uri"), "a readable picture", format!("{label}: {why}"), remedy))?;
            (&held, held.len())
        }
        (None, None) => return Err(fault(path, "a `uri` or a `bufferView`", "neither", EXPORT)),
    };
    // JPEG is glTF's other kind.
    if bytes.starts_with(&[0xff, 0xd8]) {
        return Ok(None);
    }
    let read = Picture::decode(&label, bytes, false);
    let picture = read.map_err(|wrong| fault(path, wrong.expected, wrong.found, wrong.remedy))?;
    Ok(Some((Arc::new(picture), apart)))
}

/// A diffuse material under its texture, with what of that is left out.
pub fn textured(
    document: &Document,
    albedo: [f64; 3],
    info: &TextureInfo,
    path: &str,
) -> Result<(MaterialKind, Vec<String>), GltfFault> {
    let without = |why: &str| vec![format!("its base colour texture ({why})")];
    let plain = |why: &str| Ok((MaterialKind::Diffuse { albedo, texture: None }, without(why)));
    let Some(image) = source(&document.json, info, path)? else { return plain("of a kind that is not read") };
    let Some(Some(picture)) = document.pictures.get(&image) else {
        return plain("JPEG is not read: convert it to PNG");
    };
    let transform = info.extensions.transform.as_ref();
    if transform.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord) != 0 {
        return plain("it is on another set of texture coordinates than the first");
    }
    let repeat = transform.and_then(|t| t.scale).unwrap_or([1.0; 2]);
    let shifted = transform.is_some_and(|t| t.offset != [0.0; 2] || t.rotation != 0.0);
    // Theirs is counted from the upper edge, ours from the lower: whole numbers of pictures are the same from both.
    if shifted || repeat[1].fract() != 0.0 || !repeat.iter().all(|times| (1e-3..=1e3).contains(times)) {
        return plain("its transform is not read");
    }
    let sampler = document.json.textures[info.index].sampler.and_then(|sampler| document.json.samplers.get(sampler));
    let ends = sampler.is_some_and(|sampler| [sampler.wrap_s, sampler.wrap_t].iter().any(|wrap| *wrap != REPEATS));
    let missing = if ends { vec!["the end of its texture (it is repeated)".to_owned()] } else { vec![] };
    let texture = Some(Texture { picture: picture.clone(), repeat });
    Ok((MaterialKind::Diffuse { albedo, texture }, missing))
}
