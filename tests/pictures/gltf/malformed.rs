//! One fault each: a value of a sound file changed, a file that is none, a key of the import that does not fit.
use serde_json::{Value, json};

use super::{
    Folder, imported,
    made::{Gltf, glb, small},
};

/// A pointer into the JSON of a sound file and what is written there, then words of what is expected, where it was found
/// with what, and of the remedy. `null` takes the value away.
type Case = (&'static str, &'static str, &'static str, &'static str, &'static str);

const EXPORT: &str = "export the file again";

#[rustfmt::skip]
const CASES: &[Case] = &[
    // The head.
    ("/asset", "null", "version 2.0", "none at bad.glb: asset.version", "as glTF 2.0"),
    ("/asset/version", "\"1.0\"", "version 2.0", "\"1.0\" at bad.glb: asset.version", "as glTF 2.0"),
    ("/asset/minVersion", "\"2.1\"", "version 2.0", "\"2.1\" at bad.glb: asset.version", "as glTF 2.0"),
    ("/extensionsRequired", "[\"KHR_materials_ior\", \"KHR_draco_mesh_compression\"]",
        "no more than KHR_lights_punctual, ", "\"KHR_draco_mesh_compression\" at bad.glb: extensionsRequired[1]", "without compression"),
    ("/extensionsRequired", "[\"KHR_materials_variants\"]",
        "to be required", "\"KHR_materials_variants\" at bad.glb: extensionsRequired[0]", "without it"),
    // The layout.
    ("/nodes", "3", "glTF 2.0", "invalid type: integer `3`, expected a sequence at bad.glb:1:", "right file"),
    ("/accessors/0/count", "-4", "glTF 2.0", "integer `-4`", "right file"),
    ("/accessors/0/count", "null", "glTF 2.0", "missing field `count`", "right file"),
    ("/nodes/0/translation", "[0, 1]", "glTF 2.0", "invalid length 2", "right file"),
    ("/nodes/0/translation", "\"up\"", "glTF 2.0", "string \"up\"", "right file"),
    // Buffers.
    ("/buffers", "[{\"byteLength\": 9000}]", "9000 bytes", "at bad.glb: buffers[0].byteLength", EXPORT),
    ("/buffers", "[{\"byteLength\": 0}, {\"byteLength\": 4}]", "where the buffer is", "none at bad.glb: buffers[1].uri", EXPORT),
    ("/buffers", "[{\"byteLength\": 4, \"uri\": \"gone.bin\"}]", "a readable buffer", "gone.bin: No such file", "beside the glTF file"),
    ("/buffers", "[{\"byteLength\": 4, \"uri\": \"../bad.glb\"}]", "beside the glTF file or below", "\"../bad.glb\"", "embed"),
    ("/buffers", "[{\"byteLength\": 4, \"uri\": \"https://example.org/a.bin\"}]", "beside the glTF file", "example.org", "embed"),
    ("/buffers", "[{\"byteLength\": 4, \"uri\": \"data:;base64,AB*=\"}]", "a buffer as `data:", "Invalid symbol", EXPORT),
    ("/buffers", "[{\"byteLength\": 4, \"uri\": \"data:,four\"}]", "a buffer as `data:", "another encoding", EXPORT),
    ("/bufferViews/0/buffer", "1", "the index of one of 1 buffers", "1 at bad.glb: bufferViews[0].buffer", EXPORT),
    ("/bufferViews/0/byteOffset", "4000", "a part of the buffer's", "48 from byte 4000 on at bad.glb: bufferViews[0]", EXPORT),
    ("/bufferViews/0/byteOffset", "18446744073709551615", "a part of the buffer's", "bufferViews[0]", EXPORT),
    ("/bufferViews/0/byteStride", "8", "a stride of at least 12 bytes", "8 at bad.glb: bufferViews[0].byteStride", EXPORT),
    // Accessors.
    ("/accessors/0/bufferView", "77", "the index of one of 3 buffer views", "77 at bad.glb: accessors[0].bufferView", EXPORT),
    ("/accessors/0/bufferView", "4294967296", "the index of one of 3 buffer views", "4294967296", EXPORT),
    ("/accessors/2/count", "15", "elements within the 24 bytes of bufferViews[2]",
        "15 of 2 bytes from byte 0 on, 2 apart at bad.glb: accessors[2]", EXPORT),
    ("/accessors/0/count", "18446744073709551615", "as many normals as positions|elements within", "accessors[0]", EXPORT),
    ("/accessors/0/byteOffset", "4", "elements within the 48 bytes", "from byte 4 on", EXPORT),
    ("/accessors/0/componentType", "5124", "one of 5120, ", "5124 at bad.glb: accessors[0].componentType", EXPORT),
    ("/accessors/0/type", "\"VEC2\"", "positions as VEC3", "VEC2 of F32 in accessors[0] at bad.glb: meshes[0].primitives[0].attributes.POSITION", EXPORT),
    ("/accessors/2/componentType", "5126", "indices as SCALAR of unsigned", "SCALAR of F32", EXPORT),
    ("/accessors/1/count", "3", "as many normals as positions, 4", "3 at bad.glb: meshes[0].primitives[0].attributes.NORMAL", EXPORT),
    ("/accessors/0/count", "3", "as many normals as positions, 3", "4 at bad.glb", EXPORT),
    ("/accessors/0/sparse", "{\"count\": 2, \"indices\": {\"bufferView\": 2, \"byteOffset\": 2, \"componentType\": 5123}, \"values\": {\"bufferView\": 0}}",
        "indices that grow, below 4", "1 as number 1 at bad.glb: accessors[0].sparse.indices", EXPORT),
    ("/accessors/0/sparse", "{\"count\": 9, \"indices\": {\"bufferView\": 2, \"componentType\": 5123}, \"values\": {\"bufferView\": 0}}",
        "elements within the 48 bytes", "accessors[0].sparse.values", EXPORT),
    ("/accessors/0/sparse", "{\"count\": 1, \"indices\": {\"bufferView\": 2, \"componentType\": 5126}, \"values\": {\"bufferView\": 0}}",
        "unsigned whole numbers", "F32 at bad.glb: accessors[0].sparse.indices", EXPORT),
    // Primitives.
    ("/meshes/0/primitives/0/attributes/POSITION", "null", "positions as `POSITION`", "none at bad.glb: meshes[0].primitives[0].attributes", EXPORT),
    ("/meshes/0/primitives/0/attributes/POSITION", "2", "positions as VEC3", "SCALAR of U16", EXPORT),
    ("/meshes/0/primitives/0/attributes/NORMAL", "9", "the index of one of 3 accessors", "9 at bad.glb", EXPORT),
    ("/meshes/0/primitives/0/attributes/TEXCOORD_0", "0", "texture coordinates as VEC2", "VEC3 of F32", EXPORT),
    ("/meshes/0/primitives/0/mode", "7", "4, 5 or 6 for triangles", "7 at bad.glb: meshes[0].primitives[0].mode", EXPORT),
    ("/meshes/0/primitives/0/material", "1", "the index of one of 1 materials", "1 at bad.glb", EXPORT),
    ("/meshes/0/primitives/0/indices", "null", "whole triangles", "4 at bad.glb: meshes[0].primitives[0].indices", EXPORT),
    // Nodes.
    ("/scene", "1", "the index of one of 1 scenes", "1 at bad.glb: scene", EXPORT),
    ("/scenes/0/nodes/0", "9", "the index of one of 3 nodes", "9 at bad.glb: scenes[0].nodes[0]", EXPORT),
    ("/nodes/0/children", "[0]", "a tree of nodes", "node 0 a second time, in two places or below itself at bad.glb: nodes[0].children[0]", EXPORT),
    ("/nodes/0/children", "[1]", "a tree of nodes", "node 1 a second time", EXPORT),
    ("/nodes/0/mesh", "1", "the index of one of 1 meshes", "1 at bad.glb: nodes[0].mesh", EXPORT),
    ("/nodes/0/rotation", "[0, 0, 0, 0]", "a quaternion that is not zero", "zero at bad.glb: nodes[0].rotation", EXPORT),
    ("/nodes/0/matrix", "[1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]", "whose last row is 0, 0, 0, 1", "nodes[0].matrix", EXPORT),
    ("/nodes/0/scale", "[1e300, 1e300, 1e300]", "coordinates within ±1e9 m", "at bad.glb: nodes[0]", "scale the import down"),
    ("/nodes/0/translation", "[0, 2e9, 0]", "coordinates within ±1e9 m", "2.00000000", "move the node nearer"),
    // Materials.
    ("/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1.5, 1, 1]", "shares of light from 0",
        "1.5 at bad.glb: materials[0].pbrMetallicRoughness.baseColorFactor", "correct it"),
    ("/materials/0/pbrMetallicRoughness/roughnessFactor", "-1", "a roughness from 0", "-1 at", "correct it"),
    ("/materials/0/extensions/KHR_materials_ior/ior", "0.5", "an index of refraction from 1", "0.5 at", "correct it"),
    ("/materials/0/extensions/KHR_materials_volume/attenuationDistance", "0", "a distance from", "0 at", "correct it"),
    ("/materials/0/extensions/KHR_materials_volume/attenuationColor", "[0, 0, 2]", "shares of light", "2 at", "correct it"),
    ("/materials/0/extensions/KHR_materials_transmission/transmissionFactor", "1.01", "let through from 0", "1.01 at", "correct it"),
    // Lights and cameras.
    ("/nodes/1/extensions/KHR_lights_punctual/light", "1", "the index of one of 1 lights", "1 at bad.glb: nodes[1].extensions", EXPORT),
    ("/extensions/KHR_lights_punctual/lights/0/type", "\"area\"", "directional, point or spot", "\"area\" at", "correct it"),
    ("/extensions/KHR_lights_punctual/lights/0/intensity", "-1", "a strength in W", "lights[0].intensity", "correct it"),
    ("/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", "2", "a half angle in radians", "2 at", "correct it"),
    ("/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", "0.6", "a half angle in radians from 0 to 5e-1", "0.6 at", "correct it"),
    ("/nodes/1/scale", "[0, 0, 0]", "not scaled to nothing", "nodes[1].extensions.KHR_lights_punctual.light", "correct it"),
    ("/nodes/2/camera", "3", "the index of one of 1 cameras", "3 at bad.glb: nodes[2].camera", EXPORT),
    ("/cameras/0/perspective", "null", "one of perspective and orthographic", "cameras[0]", "correct it"),
    ("/cameras/0/perspective/yfov", "4", "a field of view, in degrees", "229.18", "correct it"),
    // Nothing in it.
    ("/scenes/0/nodes", "[]", "triangles, lights or cameras", "none at bad.glb", "not empty"),
];

/// Judges what is said of a broken file under the name `bad.glb` or `bad.gltf`; one of several words may be expected.
#[track_caller]
fn judge(file: &str, content: impl AsRef<[u8]>, [expected, found, remedy]: [&str; 3]) {
    let error = imported(file, content, "").err().unwrap_or_else(|| panic!("{expected}: it was read"));
    assert_eq!(error.key, "imports.room.file", "{error}");
    assert!(expected.split('|').any(|words| error.expected.contains(words)), "expected {expected}: {error}");
    assert!(error.found.contains(found) && error.found.contains(file), "found {found}: {error}");
    assert!(error.remedy.contains(remedy), "remedy {remedy}: {error}");
    assert!(error.to_string().contains("scene.toml:22:8: `imports.room.file`: expected "), "{error}");
}

fn changed(pointer: &str, value: &str) -> Gltf {
    let mut file = small();
    let (parent, name) = pointer.rsplit_once('/').expect("a pointer");
    let value: Value = serde_json::from_str(value).expect("JSON");
    let parent = file.json.pointer_mut(parent).unwrap_or_else(|| panic!("no {parent}"));
    match parent {
        Value::Array(items) => items[name.parse::<usize>().expect("an index")] = value,
        Value::Object(keys) if value.is_null() => drop(keys.remove(name)),
        parent => parent[name] = value,
    }
    file
}

#[test]
fn every_fault_names_scene_file_place_and_remedy() {
    imported("bad.glb", small().glb(), "").expect("the file that is broken below is sound");
    for (pointer, value, expected, found, remedy) in CASES {
        println!("{pointer} = {value}");
        judge("bad.glb", changed(pointer, value).glb(), [expected, found, remedy]);
    }
}

#[test]
fn what_is_no_gltf_is_told() {
    let json = "a glTF file: JSON, or GLB";
    judge("bad.gltf", "", [json, "EOF while parsing a value at bad.gltf:1:0", "right file"]);
    judge("bad.gltf", "v 0 0 0\n", [json, "expected value at bad.gltf:1:1", "right file"]);
    judge(
        "bad.gltf",
        "{\"asset\":\n {\"version\": \"2.0\"",
        [json, "EOF while parsing an object at bad.gltf:2:", "right file"],
    );
    judge(
        "bad.gltf",
        format!("{{\"extras\": {}", "[".repeat(100_000)),
        [json, "EOF while parsing a list", "right file"],
    );
    judge("bad.gltf", "{\"asset\": {\"version\": \"2.0\"}}", ["triangles, lights or cameras", "none at", "right file"]);
}

#[test]
fn a_broken_glb_is_told() {
    let whole = "a whole GLB file";
    for length in [4, 7, 11, 12, 19, 100] {
        let mut cut = small().glb();
        cut.truncate(length);
        // Of the header alone nothing follows.
        judge("bad.glb", &cut, [whole, &format!("one of {length} bytes, cut short at bad.glb"), "copy it again"]);
    }
    let begins = "a GLB file that begins with its JSON";
    judge("bad.glb", glb(&[]), [begins, "another chunk, or none", EXPORT]);
    judge("bad.glb", glb(&[(b"BIN\0", b"1234")]), [begins, "another chunk, or none", EXPORT]);
    let mut old = small().glb();
    old[4] = 1;
    judge("bad.glb", old, ["GLB version 2", "version 1 at bad.glb", "as glTF 2.0"]);
    // A header that says less than itself; a chunk that says more than the file.
    for (at, number) in [(8, 3_u32), (12, u32::MAX), (12, 0x7fff_fff0)] {
        let mut wrong = small().glb();
        wrong[at..at + 4].copy_from_slice(&number.to_le_bytes());
        judge("bad.glb", wrong, [&format!("{whole}|{begins}"), "", ""]);
    }
}

#[test]
fn numbers_in_the_buffer_are_checked() {
    let with = |at: usize, bytes: &[u8]| {
        let mut file = small();
        file.bytes[at..at + bytes.len()].copy_from_slice(bytes);
        file.glb()
    };
    let position = "meshes[0].primitives[0].attributes.POSITION";
    judge("bad.glb", with(16, &f32::NAN.to_le_bytes()), ["finite numbers", "[1.0, NaN, 0.0] as number 1", EXPORT]);
    judge("bad.glb", with(12, &f32::INFINITY.to_le_bytes()), ["finite numbers", position, EXPORT]);
    judge("bad.glb", with(48, &f32::NAN.to_le_bytes()), ["finite numbers", "attributes.NORMAL", EXPORT]);
    let indices =
        ["indices of the primitive's 4 vertices", "4 as number 1 at bad.glb: meshes[0].primitives[0].indices", EXPORT];
    judge("bad.glb", with(98, &4_u16.to_le_bytes()), indices);
    judge("bad.glb", with(98, &u16::MAX.to_le_bytes()), ["indices of the primitive's", "65535 as number 1", EXPORT]);
}

/// Small files that ask for much: refused before it is made.
#[test]
fn a_file_asks_for_no_more_than_its_size() {
    let mut zeros = small();
    let far = zeros.push("accessors", json!({ "componentType": 5126, "type": "VEC3", "count": 3_000_000_000_u64 }));
    zeros.json["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": far } });
    let sharing = [
        "as many triangles as the file has bytes",
        "more at bad.glb: meshes[0].primitives[0].indices",
        "let nodes share",
    ];
    judge("bad.glb", zeros.glb(), sharing);
    let mut again = small();
    let once = again.json["meshes"][0]["primitives"][0].clone();
    let bytes = vec![0_u8; 30_000];
    let many = again.accessor(super::made::U8, "SCALAR", bytes.len(), &bytes);
    again.json["meshes"][0]["primitives"] = (0..1000).map(|_| once.clone()).collect();
    for primitive in again.json["meshes"][0]["primitives"].as_array_mut().unwrap() {
        primitive["indices"] = json!(many);
    }
    judge(
        "bad.glb",
        again.glb(),
        ["as many triangles as the file has bytes", "more at bad.glb: meshes[0]", "let nodes share"],
    );
    // A hundred materials under a thousand nodes.
    let mut crowd = small();
    let once = crowd.json["meshes"][0]["primitives"][0].clone();
    let materials: Vec<usize> = (0..100).map(|_| crowd.push("materials", json!({}))).collect();
    crowd.json["meshes"][0]["primitives"] = materials
        .iter()
        .map(|material| {
            let mut primitive = once.clone();
            primitive["material"] = json!(material);
            primitive
        })
        .collect();
    for _ in 0..1000 {
        crowd.node(json!({ "mesh": 0 }));
    }
    judge("bad.glb", crowd.glb(), ["objects from a file of this size", "more at bad.glb: nodes[", "join meshes"]);
}

/// Lines after `file`, then the key, words of what was found, and of the remedy.
#[rustfmt::skip]
const KEYS: &[(&str, &str, &str, &str)] = &[
    ("scale = 0", "imports.room.scale", "0", "glTF is in metres"),
    ("scale = \"big\"", "imports.room.scale", "string \"big\"", "without quotes"),
    ("sclae = 2", "imports.room.sclae", "unknown key `sclae`", "did you mean `scale`?"),
    ("position = [0, 1]", "imports.room.position", "an array of 2", "write `[x, y, z]`"),
    ("position = [0, inf, 0]", "imports.room.position", "inf", "correct it"),
    ("rotate = [0, 400, 0]", "imports.room.rotate", "400", "a full turn is 360"),
    ("watts_per_lumen = -1", "imports.room.watts_per_lumen", "-1", "1/683"),
    ("lights = \"none\"", "imports.room.lights", "string \"none\"", "write true or false"),
    ("materials = { Glas = \"white\" }", "imports.room.materials.Glas", "`Glas`", "did you mean `Glass`?"),
    ("materials = { Glass = \"whit\" }", "imports.room.materials.Glass", "`whit`", "did you mean `white`?"),
    ("materials = { Glass = 1 }", "imports.room.materials.Glass", "integer `1`", "in quotes"),
    ("[imports.two]\nscale = 1", "imports.two.file", "none", "add it"),
    ("[imports.\"a/b\"]\nfile = \"good.glb\"", "imports", "\"a/b\"", "rename it"),
    ("[objects.ball]\nmaterial = \"room/Glas\"\nsphere = { center = [0, 0, 0], radius = 0.1 }",
        "objects.ball.material", "`room/Glas`", "did you mean `room/Glass`?"),
];

#[test]
fn keys_of_an_import_are_checked() {
    for (keys, key, found, remedy) in KEYS {
        let error = imported("good.glb", small().glb(), keys).expect_err(keys);
        assert_eq!(error.key, *key, "{error}");
        assert!(error.found.contains(found) && error.remedy.contains(remedy), "{keys}: {error}");
        assert!(error.to_string().contains("scene.toml:2"), "{error}");
    }
    let error = Folder::new().load_with("[imports.room]\nfile = \"none.glb\"\n", &[]).unwrap_err();
    assert!(error.found.contains("none.glb: No such file") && error.remedy.contains("relative"), "{error}");
    let error = Folder::new().load_with("[imports.room]\nfile = \"scene.toml\"\n", &[]).unwrap_err();
    assert!(error.found.contains("at scene.toml:1:1") && error.expected.contains("a glTF file"), "{error}");
}

#[test]
fn what_an_import_brings_is_not_set_by_override() {
    let folder = Folder::new();
    folder.write("room.glb", small().glb());
    let import = "[imports.room]\nfile = \"room.glb\"\n";
    let scene = folder.load_with(import, &[("imports.room.scale", "2")]).expect("a key of the import may be set");
    assert_eq!(scene.imports[0].scale, 2.0);
    for (key, brought) in [("materials.room/Glass.ior", "room/Glass"), ("lights.room/Lamp.spot.outer", "room/Lamp")] {
        let error = folder.load_with(import, &[(key, "1")]).unwrap_err();
        assert!(error.found.contains(&format!("`{brought}")), "{error}");
        assert!(error.remedy.contains("set keys of `imports.room`"), "{error}");
    }
    let error = folder.load_with(import, &[("imports.rom.scale", "2")]).unwrap_err();
    assert!(error.remedy.contains("`imports.room.scale`"), "{error}");
}

#[test]
fn a_mesh_of_an_object_is_judged_likewise() {
    let folder = Folder::new();
    let object = "[objects.stone]\nmaterial = \"white\"\nmesh = { file = \"bad.gltf\", fit = 1, center = [0, 0, 0] }\n";
    folder.write("bad.gltf", changed("/nodes/0/mesh", "3").embedded());
    let error = folder.load_with(object, &[]).unwrap_err();
    assert_eq!(error.key, "objects.stone.mesh.file", "{error}");
    assert!(error.found.contains("3 at bad.gltf: nodes[0].mesh"), "{error}");
    folder.write("bad.gltf", changed("/nodes/0/mesh", "null").embedded());
    let error = folder.load_with(object, &[]).unwrap_err();
    assert!(error.expected.contains("triangles in the nodes") && error.found.contains("none at bad.gltf"), "{error}");
    folder.write("bad.gltf", changed("/nodes/0/scale", "[1e300, 1, 1]").embedded());
    let error = folder.load_with(object, &[]).unwrap_err();
    assert!(error.expected.contains("single precision"), "{error}");
}
