//! What is read from files: a row a reader.

use std::{path::Path, sync::Arc};

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, LineOrder, Vec2, WritableImage, f16,
};
use nephroid::{
    image::{Layers, Provenance},
    lab::Picture,
    methods,
    renderer::{Job, Providers, plan},
    scene::Scene,
    settings::Settings,
};
use serde_json::json;

use crate::{
    gltf::{self, Gltf},
    mutate::Parts,
};

/// One reader, and what it is given.
pub struct Reader {
    /// The ending of its files, by which `NEPHROID_FUZZ_INPUT` finds it too.
    pub ending: &'static str,
    /// What of them is changed, beside bytes.
    pub parts: Parts,
    /// Sound files to begin with; each must be read.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Bytes of memory that reading may hold at a time, for each byte of the file, beside [`ROOM`].
    pub multiple: usize,
    /// Reads a file. What it gives is not asked; that it comes back is.
    pub read: fn(&Path) -> Result<Found, String>,
}

/// Bytes that reading any file may hold: the parsers' buffers, and the messages about one.
pub const ROOM: usize = 4 << 20;

/// The mesh that ships.
pub const BUNNY: &[u8] = include_bytes!("../../scenes/bunny-lo.obj");

/// What was read: a scene goes on to be planned, where memory is bound by what it asks for and not by its file.
pub enum Found {
    Scene(Box<Scene>),
    Other,
}

pub const READERS: [Reader; 5] = [
    Reader {
        ending: "toml",
        parts: Parts::Words,
        seeds: || {
            Scene::shipped().map(|(name, _)| text_of(name)).chain([under_a_sky()]).map(String::into_bytes).collect()
        },
        // The tree of the text is held three times (as parsed, as resolved, as text again), some 150 bytes a short key.
        multiple: 1000,
        read: |path| {
            let scene = Scene::load(&path.to_string_lossy(), &[]).map_err(|error| error.to_string())?;
            Ok(Found::Scene(Box::new(scene)))
        },
    },
    Reader {
        ending: "obj",
        parts: Parts::Words,
        seeds: || vec![small_mesh(), small_mesh(), BUNNY.to_vec()],
        // `f 1 1 1` is eight bytes; its corners are a list of 128, its triangle 12, its vertices' places some 100 more.
        multiple: 100,
        read: |path| {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            let scene = path.with_extension("obj.toml");
            std::fs::write(
                &scene,
                format!("{AROUND_A_MESH}mesh = {{ file = \"{file}\", fit = 1.0, center = [0, 0, 0] }}\n"),
            )
            .expect("a scene is written");
            let scene = Scene::load(&scene.to_string_lossy(), &[]).map_err(|error| error.to_string())?;
            Ok(Found::Scene(Box::new(scene)))
        },
    },
    Reader {
        ending: "gltf",
        parts: Parts::Values,
        seeds: || gltf_files().into_iter().map(|file| pretty(&file.embedded()).into_bytes()).collect(),
        multiple: OF_GLTF,
        read: read_gltf,
    },
    Reader {
        ending: "glb",
        parts: Parts::Values,
        seeds: || gltf_files().into_iter().map(|file| file.glb()).collect(),
        multiple: OF_GLTF,
        read: read_gltf,
    },
    Reader {
        ending: "exr",
        parts: Parts::Numbers,
        seeds: pictures,
        // A byte may hold 1400 of pixels; these are held once as planes, and twice while they are joined.
        multiple: 4200,
        read: |path| {
            let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
            let _ = Layers::provenance_of_exr(&bytes).map_err(|error| error.to_string())?;
            Picture::read(path).map(|_| Found::Other).map_err(|error| error.to_string())
        },
    },
];

/// Goes on with what was read as far as no device is needed.
pub fn go_on(found: Found) {
    if let Found::Scene(scene) = found {
        let providers = Providers::of(methods::find("maps").expect("maps is a method"));
        let camera = "main".to_owned();
        let job = Job { scene: Arc::new(*scene), providers, settings: Settings::default(), camera, size: [8, 8] };
        let _ = plan(&job).map_err(|error| error.to_string());
    }
}

fn under_a_sky() -> String {
    text_of("null") + "\n[sky.gradient]\nzenith = [0.1, 0.2, 0.4]\nhorizon = 1\nground = 0\nup = [0, 1, 0]\n"
}

fn text_of(name: &str) -> String {
    Scene::load(name, &[]).unwrap_or_else(|error| panic!("{error}")).source.text
}

/// A scene that lacks its object's mesh.
const AROUND_A_MESH: &str = r#"version = 1
title = "a mesh"
paths = "transmit-2"
region = { receiver = "floor", center = [0, 0], half = [1, 1] }
cameras.main.pinhole = { position = [0, 2, 4], target = [0, 0, 0], fov_y = 40 }
lights.sun.directional = { direction = [0, -1, 0], irradiance = 1 }
materials.white.diffuse = { albedo = 0.8 }
materials.glass.dielectric = { ior = 1.5 }
[objects.floor]
material = "white"
quad = { center = [0, -1, 0], u = [2, 0, 0], v = [0, 0, -2] }
[objects.thing]
material = "glass"
"#;

/// A byte may ask for a triangle: of 12 bytes, with three vertices of 24 of its own, held twice while they grow; eleven for an
/// object and a warning of its holes. The worst that was made, 100,000 nodes of one triangle of glass, held 300.
const OF_GLTF: usize = 600;

/// Both ways: as an object's mesh, and imported.
fn read_gltf(path: &Path) -> Result<Found, String> {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let mesh = format!("mesh = {{ file = \"{file}\", fit = 1.0, center = [0, 0, 0] }}\n");
    let import = format!("sphere = {{ center = [0, 0, 0], radius = 0.5 }}\n[imports.room]\nfile = \"{file}\"\n");
    let scene = path.with_extension("gltf.toml");
    let mut found = Err("no scene".to_owned());
    for way in [mesh, import] {
        std::fs::write(&scene, format!("{AROUND_A_MESH}{way}")).expect("a scene is written");
        let read = Scene::load(&scene.to_string_lossy(), &[]).map_err(|error| error.to_string());
        found = read.map(|scene| Found::Scene(Box::new(scene)));
    }
    found
}

fn pretty(json: &str) -> String {
    let json: serde_json::Value = serde_json::from_str(json).expect("JSON");
    serde_json::to_string_pretty(&json).expect("JSON")
}

/// Each kind of thing once; every way of storing a number, in a tree of nodes; and a body of some size.
fn gltf_files() -> Vec<Gltf> {
    let mut ways = gltf::small();
    let bytes: Vec<u8> = gltf::CORNERS.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let base = ways.view(&bytes);
    let indices = ways.view(&[1, 3]);
    let sparse = json!({ "count": 2, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": base } });
    let sparse = json!({ "bufferView": base, "componentType": 5126, "type": "VEC3", "count": 4, "sparse": sparse });
    let sparse = ways.push("accessors", sparse);
    let small = ways.accessor(gltf::U8, "SCALAR", 6, &[0, 1, 2, 3, 1, 0]);
    let shares = ways.accessor(gltf::U16, "VEC3", 4, &[7; 24]);
    ways.json["accessors"][shares]["normalized"] = json!(true);
    ways.json["meshes"][0]["primitives"].as_array_mut().expect("a list").extend([
        json!({ "attributes": { "POSITION": sparse }, "indices": small, "mode": 5 }),
        json!({ "attributes": { "POSITION": shares }, "mode": 6 }),
        json!({ "attributes": { "POSITION": 0 }, "mode": 1 }),
    ]);
    let matrix = json!([0, 2, 0, 0, -2, 0, 0, 0, 0, 0, -2, 0, 1, 2, 3, 1]);
    let inner = ways.push("nodes", json!({ "matrix": matrix, "mesh": 0 }));
    ways.node(json!({ "children": [inner], "scale": [1, 0.5, -2] }));
    let sun = ways.light(json!({ "type": "directional", "color": [1, 0.5, 0], "range": 4 }));
    ways.node(json!({ "extensions": { "KHR_lights_punctual": { "light": sun } } }));
    ways.push("materials", json!({ "pbrMetallicRoughness": { "metallicFactor": 1, "roughnessFactor": 0.25 } }));
    vec![gltf::small(), ways, ball()]
}

/// A sphere of 32 by 16 facets.
fn ball() -> Gltf {
    let mut file = Gltf::new();
    let at = |k: u16| {
        let (around, down) = (f32::from(k % 32) * 0.196_35, f32::from(k / 32) * 0.209_44);
        [around.cos() * down.sin(), down.cos(), around.sin() * down.sin()]
    };
    let rows: Vec<[f32; 3]> = (0..512).map(at).collect();
    let quad = |k: u16| [k, k + 1, k + 33, k, k + 33, k + 32];
    let corners: Vec<u16> = (0..479).flat_map(quad).collect();
    let (positions, normals, indices) = (file.vectors(&rows), file.vectors(&rows), file.shorts(&corners));
    let mesh = file.mesh(json!({ "attributes": { "POSITION": positions, "NORMAL": normals }, "indices": indices }));
    file.node(json!({ "mesh": mesh }));
    file
}

/// Each way of writing a corner, counted from both ends; a polygon; what is passed over.
fn small_mesh() -> Vec<u8> {
    b"# a tent\no tent\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 1 0.5\nvt 0 0\nvn 0 -1 0\nvn 1e-3 1 0\ns off\n\
      f 4//1 3//1 2//1 1//1\nf 1 2 5\nf 2/1 3/1 5/1\nf -3/1/2 -2/1/2 -1/1/2\nf 4 1 5\n"
        .to_vec()
}

/// A reference as it ships; small pictures with every kind of layer; and foreign ones in each compression that is read.
fn pictures() -> Vec<Vec<u8>> {
    let mut layers = Layers::new(7, 5);
    for (name, channels) in [("radiance", 3), ("mask", 1), ("pair", 2), ("four", 4)] {
        layers.push(name, channels, (0..35 * channels).map(|i| i as f32 * 0.37).collect()).expect("a layer that fits");
    }
    let about = Provenance::from([("scene.name".to_owned(), "null".to_owned()), ("e0".to_owned(), "1".to_owned())]);
    let small = layers.to_exr(&about).expect("encodes");
    let compressions =
        [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::PIZ, Compression::PXR24];
    let blocks = [Blocks::ScanLines, Blocks::Tiles(Vec2(16, 16))];
    let foreign = compressions.into_iter().flat_map(|c| blocks.map(|b| encoded(c, b)));
    foreign.chain([small, include_bytes!("../references/flat-water.exr").to_vec()]).collect()
}

/// 40 × 24 pixels of a channel of each type.
fn encoded(compression: Compression, blocks: Blocks) -> Vec<u8> {
    let ramp = |i: usize| (i % 7) as f32 * 0.25;
    let pixels = 0..40 * 24;
    let channels = [
        ("H", FlatSamples::F16(pixels.clone().map(|i| f16::from_f32(ramp(i))).collect())),
        ("U", FlatSamples::U32(pixels.clone().map(|i| i as u32).collect())),
        ("Y", FlatSamples::F32(pixels.map(ramp).collect())),
    ];
    let list = channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect();
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let mut file = std::io::Cursor::new(Vec::new());
    let image = Image::from_encoded_channels((40, 24), encoding, AnyChannels::sort(list));
    image.write().non_parallel().to_buffered(&mut file).expect("encodes");
    file.into_inner()
}
