//! The file as a container: GLB chunks, JSON, buffers inside and beside.
use std::{
    collections::BTreeMap,
    path::{Component, Path},
    rc::Rc,
};

use base64::{
    Engine,
    alphabet::STANDARD,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use serde::Deserialize;

use super::{
    EXPORT, GltfFault, ReadBeside, fault,
    json::{Buffer, Head, Root},
};

/// What a file may require; the texture ones change no more than textures.
pub const READ: [&str; 9] = [
    "KHR_lights_punctual",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_texture_basisu",
    "EXT_texture_webp",
    "EXT_texture_avif",
];
/// Some exporters leave the padding out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);
const REMEDY_BUFFER: &str = "embed the buffers, or put them beside the glTF file";

/// The JSON, and the binary chunk of a GLB.
pub fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), GltfFault> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let number = |at: usize| bytes.get(at..at + 4).and_then(|four| four.try_into().ok()).map(u32::from_le_bytes);
    let short = || fault("", "a whole GLB file", format!("one of {} bytes, cut short", bytes.len()), "copy it again");
    let (version, length) = (number(4).ok_or_else(short)?, number(8).ok_or_else(short)? as usize);
    if version != 2 {
        return Err(fault("", "GLB version 2", format!("version {version}"), "export it as glTF 2.0"));
    }
    let (mut at, mut chunks) = (12, Vec::new());
    while at < length && chunks.len() < 2 {
        let size = number(at).ok_or_else(short)? as usize;
        let kind = number(at + 4).ok_or_else(short)?.to_le_bytes();
        let end = (at + 8).checked_add(size).filter(|end| *end <= length).ok_or_else(short)?;
        chunks.push((kind, bytes.get(at + 8..end).ok_or_else(short)?));
        at = end;
    }
    let Some((_, json)) = chunks.first().filter(|(kind, _)| kind == b"JSON") else {
        return Err(fault("", "a GLB file that begins with its JSON", "another chunk, or none", EXPORT));
    };
    let binary = chunks.get(1).filter(|(kind, _)| kind == b"BIN\0").map(|(_, binary)| *binary);
    Ok((json, binary))
}

pub fn parse(json: &[u8]) -> Result<Root, GltfFault> {
    let head: Head = parsed(json)?;
    let asset = head.asset.as_ref();
    let version = asset.and_then(|asset| asset.min_version.as_deref().or(asset.version.as_deref()));
    if version.is_none_or(|version| version != "2.0") {
        let found = version.map_or("none".to_owned(), |version| format!("{version:?}"));
        return Err(fault("asset.version", "version 2.0", found, "export it as glTF 2.0"));
    }
    if let Some((at, other)) =
        head.extensions_required.iter().enumerate().find(|(_, name)| !READ.contains(&name.as_str()))
    {
        let remedy = if other.contains("compression") {
            "export the meshes without compression"
        } else {
            "export the file without it"
        };
        let expected = format!("no more than {} to be required", READ[..5].join(", "));
        return Err(fault(format!("extensionsRequired[{at}]"), expected, format!("{other:?}"), remedy));
    }
    parsed(json)
}

/// Serde's message, with its place taken apart into ours.
fn parsed<'a, T: Deserialize<'a>>(json: &'a [u8]) -> Result<T, GltfFault> {
    serde_json::from_slice(json).map_err(|error| {
        let message = error.to_string();
        let found = message.split(" at line ").next().unwrap_or_default().to_owned();
        let at = format!(":{}:{}", error.line(), error.column());
        let expected = if error.is_data() { "glTF 2.0" } else { "a glTF file: JSON, or GLB" };
        let remedy = "check that this is the right file, or export it again";
        GltfFault { at, expected: expected.to_owned(), found, remedy: remedy.to_owned() }
    })
}

/// Each buffer, of the length that the JSON says. Those that name one file share it.
pub fn buffers(buffers: &[Buffer], binary: Option<&[u8]>, beside: &mut ReadBeside) -> Result<Vec<Rc<[u8]>>, GltfFault> {
    let mut files = BTreeMap::<String, Rc<[u8]>>::new();
    let mut all = Vec::new();
    for (index, buffer) in buffers.iter().enumerate() {
        let path = format!("buffers[{index}]");
        let bytes = match buffer.uri.as_deref() {
            Some(uri) if uri.starts_with("data:") => Rc::from(data(&path, uri)?),
            Some(uri) => {
                let file = local(&path, uri)?;
                match files.get(&file) {
                    Some(bytes) => bytes.clone(),
                    None => {
                        let unreadable = |why| {
                            fault(format!("{path}.uri"), "a readable buffer", format!("{file}: {why}"), REMEDY_BUFFER)
                        };
                        let bytes: Rc<[u8]> = Rc::from(beside(&file).map_err(unreadable)?);
                        files.insert(file, bytes.clone());
                        bytes
                    }
                }
            }
            None if index == 0 && binary.is_some() => Rc::from(binary.unwrap_or_default()),
            None => return Err(fault(format!("{path}.uri"), "where the buffer is", "none", EXPORT)),
        };
        if bytes.len() < buffer.byte_length {
            let (expected, found) = (format!("{} bytes", buffer.byte_length), format!("{}", bytes.len()));
            return Err(fault(format!("{path}.byteLength"), expected, found, EXPORT));
        }
        all.push(bytes);
    }
    Ok(all)
}

/// Of `data:…;base64,…`.
pub fn data(path: &str, uri: &str) -> Result<Vec<u8>, GltfFault> {
    let wrong = |found: String| fault(format!("{path}.uri"), "a buffer as `data:…;base64,…`", found, EXPORT);
    let (kind, text) = uri.split_once(',').ok_or_else(|| wrong("no comma".to_owned()))?;
    if !kind.ends_with(";base64") {
        return Err(wrong("another encoding".to_owned()));
    }
    BASE64.decode(text).map_err(|error| wrong(error.to_string()))
}

/// The path of a file beside the glTF file or below it: what somebody made elsewhere names nothing else here.
pub fn local(path: &str, uri: &str) -> Result<String, GltfFault> {
    let refused = |found: &str| {
        fault(format!("{path}.uri"), "a file beside the glTF file or below it", format!("{found:?}"), REMEDY_BUFFER)
    };
    let decoded = unescaped(uri).ok_or_else(|| refused(uri))?;
    let mut parts = Vec::new();
    for part in Path::new(&decoded).components() {
        match part {
            Component::Normal(name) => parts.push(name.to_str().ok_or_else(|| refused(uri))?),
            Component::CurDir => {}
            _ => return Err(refused(uri)),
        }
    }
    if parts.is_empty() || decoded.contains(':') { Err(refused(uri)) } else { Ok(parts.join("/")) }
}

/// Without its %XX; `None` where it is no text.
fn unescaped(uri: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(if byte == b'%' {
            let digits = [rest.next()?, rest.next()?];
            u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
        } else {
            byte
        });
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_unescaped_and_lead_nowhere_else() {
        let name = |uri| local("", uri).ok();
        assert_eq!(name("a%20b.bin").as_deref(), Some("a b.bin"));
        assert_eq!(name("./x//y/./z.bin").as_deref(), Some("x/y/z.bin"));
        for uri in ["", ".", "../a.bin", "x/../../a.bin", "/a.bin", "http://x/a.bin", "%2Fa.bin", "%2", "%zz", "%ff"] {
            assert_eq!(name(uri), None, "{uri}");
        }
    }

    #[test]
    fn data_needs_no_padding() {
        let of = |uri| data("", uri).ok();
        assert_eq!(of("data:application/octet-stream;base64,AQID/w=="), Some(vec![1, 2, 3, 255]));
        assert_eq!(of("data:;base64,AQID/w"), Some(vec![1, 2, 3, 255]));
        for uri in ["data:;base64", "data:,abc", "data:;base64,A", "data:;base64,AQ*D"] {
            assert_eq!(of(uri), None, "{uri}");
        }
    }
}
