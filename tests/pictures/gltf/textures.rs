//! Base colour textures: read from wherever they are, and told where they cannot be.
use nephroid::scene::{MaterialKind, Scene, Shape, Texture};
use png::{BitDepth, ColorType, Encoder};
use serde_json::{Value, json};

use super::{
    imported,
    made::{Gltf, small},
    material, object,
};

fn png(width: u32, color: ColorType, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, 1);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

/// Red and half-clear white.
fn picture() -> Vec<u8> {
    png(2, ColorType::Rgba, &[255, 0, 0, 255, 255, 255, 255, 128])
}

/// The stone in a material whose base colour is a texture, which is given as an image with its bytes in the buffer.
fn textured(info: Value, texture: Value, bytes: &[u8]) -> Gltf {
    let mut file = small();
    file.json["materials"][0] = json!({
        "name": "Paint",
        "pbrMetallicRoughness": { "baseColorTexture": info, "metallicFactor": 0, "baseColorFactor": [1, 0.5, 0.25, 1] }
    });
    let view = file.view(bytes);
    file.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
    file.push("textures", texture);
    let rows: Vec<u8> =
        [[0.0f32, 0.0], [1.0, 0.0], [0.0, 0.25], [1.0, 1.0]].iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let coordinates = file.accessor(super::made::F32, "VEC2", 4, &rows);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(coordinates);
    file
}

fn shown(scene: &Scene) -> (&Texture, [f64; 3]) {
    match material(scene, "room/Paint") {
        MaterialKind::Diffuse { albedo, texture: Some(texture) } => (texture, *albedo),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_picture_is_read_from_the_buffer_the_text_and_beside() {
    let inside = textured(json!({ "index": 0 }), json!({ "source": 0 }), &picture());
    let mut text = inside.clone();
    let base64 = base64::Engine::encode(&base64::prelude::BASE64_STANDARD, picture());
    text.json["images"][0] = json!({ "uri": format!("data:image/png;base64,{base64}") });
    for file in [&inside, &text] {
        let scene = imported("room.glb", file.glb(), "").unwrap_or_else(|error| panic!("{error}"));
        let (texture, albedo) = shown(&scene);
        assert_eq!(albedo, [1.0, 0.5, 0.25]);
        assert_eq!((texture.picture.width, texture.picture.height, texture.repeat), (2, 1, [1.0, 1.0]));
        assert_eq!(texture.picture.pixels, [[1.0, 0.0, 0.0], [1.0, 1.0, 1.0]], "alpha plays no part");
        let Shape::Mesh { mesh, .. } = &object(&scene, "room/Stone").shape else { panic!("no mesh") };
        assert!(mesh.coordinates.contains(&glam::Vec2::new(0.0, 0.75)), "theirs is counted from the upper edge");
        assert!(scene.warnings.iter().all(|warning| !warning.contains("texture")), "{:?}", scene.warnings);
    }
    let mut beside = inside.clone();
    beside.json["images"][0] = json!({ "uri": "paint%20x.png" });
    let folder = tempfile::tempdir().unwrap();
    let text = Scene::load("diffuse", &[]).unwrap().source.text + "\n[imports.room]\nfile = \"room.glb\"\n";
    std::fs::write(folder.path().join("s.toml"), text).unwrap();
    std::fs::write(folder.path().join("room.glb"), beside.glb()).unwrap();
    let load = || Scene::load(folder.path().join("s.toml").to_str().unwrap(), &[]);
    let error = load().expect_err("no picture yet").to_string();
    assert!(error.contains("images[0].uri") && error.contains("paint x.png: No such file"), "{error}");
    std::fs::write(folder.path().join("paint x.png"), picture()).unwrap();
    let first = load().unwrap();
    assert_eq!(shown(&first).0.picture.file, "paint x.png");
    std::fs::write(folder.path().join("paint x.png"), png(1, ColorType::Grayscale, &[9])).unwrap();
    assert_ne!(load().unwrap().source.hash, first.source.hash, "what lies beside is part of the scene");
}

#[test]
fn a_picture_that_cannot_be_shown_as_it_is_meant_is_told_of() {
    let transform = |value: Value| json!({ "index": 0, "extensions": { "KHR_texture_transform": value } });
    let plain = json!({ "source": 0 });
    let jpeg = vec![0xff, 0xd8, 0xff, 0xe0];
    for (info, texture, bytes, words) in [
        (json!({ "index": 0 }), plain.clone(), jpeg, "JPEG is not read: convert it to PNG"),
        (json!({ "index": 0 }), json!({}), picture(), "of a kind that is not read"),
        (json!({ "index": 0, "texCoord": 1 }), plain.clone(), picture(), "another set of texture coordinates"),
        (transform(json!({ "offset": [0.5, 0] })), plain.clone(), picture(), "its transform is not read"),
        (transform(json!({ "rotation": 1 })), plain.clone(), picture(), "its transform is not read"),
        (transform(json!({ "scale": [1, 1.5] })), plain.clone(), picture(), "its transform is not read"),
    ] {
        let scene = imported("room.glb", textured(info, texture, &bytes).glb(), "").unwrap();
        assert!(matches!(material(&scene, "room/Paint"), MaterialKind::Diffuse { texture: None, .. }), "{words}");
        assert!(scene.warnings.iter().any(|warning| warning.contains(words)), "{words}: {:?}", scene.warnings);
    }
    let repeated = textured(transform(json!({ "scale": [2.5, 3] })), plain.clone(), &picture());
    assert_eq!(shown(&imported("room.glb", repeated.glb(), "").unwrap()).0.repeat, [2.5, 3.0]);
    let mut ends = textured(json!({ "index": 0 }), json!({ "source": 0, "sampler": 0 }), &picture());
    ends.push("samplers", json!({ "wrapS": 33071 }));
    let scene = imported("room.glb", ends.glb(), "").unwrap();
    assert!(scene.warnings.iter().any(|warning| warning.contains("the end of its texture (it is repeated)")));
    let mut unplaced = textured(json!({ "index": 0 }), plain, &picture());
    unplaced.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    let scene = imported("room.glb", unplaced.glb(), "").unwrap();
    assert!(scene.warnings.iter().any(|w| w.contains("`room/Stone` has a texture and no texture coordinates")));
}

#[test]
fn a_texture_that_is_none_is_named_by_its_place() {
    let sound = || textured(json!({ "index": 0 }), json!({ "source": 0 }), &picture());
    let faulty = |change: &dyn Fn(&mut Gltf)| {
        let mut file = sound();
        change(&mut file);
        imported("room.glb", file.glb(), "").expect_err("a fault").to_string()
    };
    for (error, words) in [
        (
            faulty(&|f| f.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(7)),
            "baseColorTexture.index",
        ),
        (faulty(&|f| f.json["textures"][0]["source"] = json!(7)), "textures[0].source"),
        (faulty(&|f| f.json["images"][0] = json!({})), "images[0]"),
        (faulty(&|f| f.json["images"][0] = json!({ "bufferView": 99 })), "images[0].bufferView"),
        (faulty(&|f| f.json["images"][0] = json!({ "uri": "../x.png" })), "images[0].uri"),
        (
            faulty(&|f| f.json["images"][0] = json!({ "uri": "data:image/png;base64,AQID" })),
            "begins like neither at room.glb: images[0]",
        ),
        (faulty(&|f| f.json["bufferViews"][3]["byteLength"] = json!(1_000_000)), "bufferViews[3]"),
    ] {
        assert!(error.contains(words), "{words}: {error}");
    }
}
