//! What a sound file becomes, however it is stored.
use glam::{DQuat, DVec3, Vec3, dvec3};
use nephroid::scene::{CameraKind, LightKind, MaterialKind, Scene};
use serde_json::{Value, json};

use super::{
    Folder, ROUNDING, SINGLE, close, light,
    made::{CORNERS, F32, FACES, Gltf, NORMALS, U8, U32, small},
    material, mesh, names, object, read, triangles,
};

/// The base with its one primitive changed.
fn with_primitive(change: impl FnOnce(&mut Gltf) -> Value) -> Gltf {
    let mut file = small();
    let primitive = change(&mut file);
    file.json["meshes"][0]["primitives"][0] = primitive;
    file
}

#[test]
fn each_kind_of_thing_comes_under_the_name_of_the_import() {
    let scene = read(&small());
    assert_eq!(names(&scene), ["floor", "room/Stone"]);
    let (mesh, to_world) = mesh(&scene, "room/Stone");
    assert_eq!((mesh.triangles.len(), mesh.positions.len(), mesh.file.as_str()), (4, 4, "room.glb"));
    let turn = DQuat::from_xyzw(0.0, 0.0, 0.6, 0.8);
    for corner in CORNERS.map(|corner| Vec3::from_array(corner).as_dvec3()) {
        close(to_world.transform_point3(corner), DVec3::Y + turn * corner, ROUNDING);
    }
    let ln2 = std::f64::consts::LN_2;
    assert_eq!(
        material(&scene, "room/Glass"),
        &MaterialKind::Dielectric { ior: [1.45; 3], absorption: [0.0, 0.5 * ln2, ln2] }
    );
    assert_eq!(scene.materials[object(&scene, "room/Stone").material].name, "room/Glass");
    let LightKind::Spot { position, intensity, beam, .. } = light(&scene, "room/Lamp") else { panic!("no spot") };
    close(*position, dvec3(0.0, 4.0, 0.0), ROUNDING);
    close(beam.axis, DVec3::NEG_Y, ROUNDING);
    close(DVec3::from_array(*intensity), DVec3::ONE, ROUNDING);
    assert!(
        (beam.inner - (1.0 - 0.25_f64.cos())).abs() < ROUNDING && (beam.outer - (1.0 - 0.5_f64.cos())).abs() < ROUNDING
    );
    let eye = &scene.cameras["room/Eye"];
    assert_eq!(eye.kind, CameraKind::Pinhole { fov_y: 0.75_f64.to_degrees() });
    close(eye.position, dvec3(0.0, 1.0, 4.0), ROUNDING);
    close((eye.target - eye.position).normalize(), DVec3::NEG_Z, ROUNDING);
    assert!(
        (eye.position.z - eye.target.z - 3.75).abs() < 0.5,
        "it looks at the middle of what is there: {}",
        eye.target
    );
    let import = &scene.imports[0];
    assert_eq!([import.objects, import.triangles, import.materials, import.lights, import.cameras], [1, 4, 1, 1, 1]);
    assert_eq!((import.name.as_str(), import.file.as_str(), import.scale), ("room", "room.glb", 1.0));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

/// One file, JSON with the buffer in it, JSON with the buffer beside it: one scene. All of them are of its hash.
#[test]
fn every_container_holds_the_same() {
    let (folder, file) = (Folder::new(), small());
    folder.write("a/room.glb", file.glb());
    folder.write("a/embedded.gltf", file.embedded());
    folder.write("a/beside.gltf", file.beside("./b%20c/./room.bin"));
    folder.write("a/b c/room.bin", &file.bytes);
    let load = |name: &str| folder.load_with(&format!("[imports.room]\nfile = \"a/{name}\"\n"), &[]).unwrap();
    let scenes = ["room.glb", "embedded.gltf", "beside.gltf"].map(load);
    let text = |scene: &Scene| format!("{:?}", (&scene.objects, &scene.materials, &scene.lights, &scene.cameras));
    let [first, others @ ..] = scenes.each_ref().map(|scene| {
        let file = &scene.imports[0].file;
        text(scene).replace(file.as_str(), "")
    });
    assert!(others.iter().all(|other| *other == first), "{first}\n{others:?}");
    let before = &scenes[2].source.hash;
    assert_eq!(*before, load("beside.gltf").source.hash);
    folder.write("a/b c/room.bin", [&file.bytes[..], b"more"].concat());
    assert_ne!(*before, load("beside.gltf").source.hash, "the buffer is of the hash");
    assert!(scenes[0].source.hash != scenes[1].source.hash);
}

/// Each way of storing the same triangles.
#[test]
fn every_way_of_storing_a_mesh_gives_the_same_triangles() {
    let expected = triangles(&read(&small()), "room/Stone");
    let bytes_of = |rows: &[[f32; 3]]| rows.iter().flatten().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let ways: [(&str, Gltf); 8] = [
        (
            "8 bits an index",
            with_primitive(|file| {
                let indices: Vec<u8> = FACES.iter().map(|&index| index as u8).collect();
                let indices = file.accessor(U8, "SCALAR", 12, &indices);
                json!({ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": indices, "material": 0 })
            }),
        ),
        (
            "32 bits an index",
            with_primitive(|file| {
                let indices: Vec<u8> = FACES.iter().flat_map(|&index| u32::from(index).to_le_bytes()).collect();
                let indices = file.accessor(U32, "SCALAR", 12, &indices);
                json!({ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": indices, "material": 0 })
            }),
        ),
        (
            "no indices",
            with_primitive(|file| {
                let corners: Vec<_> = FACES.iter().map(|&index| CORNERS[usize::from(index)]).collect();
                let positions = file.vectors(&corners);
                json!({ "attributes": { "POSITION": positions }, "material": 0 })
            }),
        ),
        (
            "positions and normals by turns",
            with_primitive(|file| {
                let rows: Vec<_> = CORNERS.iter().zip(&NORMALS).flat_map(|(p, n)| [*p, *n]).collect();
                let view = file.view(&bytes_of(&rows));
                file.json["bufferViews"][view]["byteStride"] = json!(24);
                let [positions, normals] =
                    [0, 12].map(|offset| {
                        file.push("accessors", json!({
                    "bufferView": view, "byteOffset": offset, "componentType": F32, "type": "VEC3", "count": 4
                }))
                    });
                json!({ "attributes": { "POSITION": positions, "NORMAL": normals }, "indices": 2, "material": 0 })
            }),
        ),
        (
            "sparse over nothing",
            with_primitive(|file| {
                let (indices, values) = (file.view(&[1, 2, 3]), file.view(&bytes_of(&CORNERS[1..])));
                let positions = file.push("accessors", json!({
                "componentType": F32, "type": "VEC3", "count": 4, "sparse": {
                    "count": 3, "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values }
                }
            }));
                json!({ "attributes": { "POSITION": positions, "NORMAL": 1 }, "indices": 2, "material": 0 })
            }),
        ),
        (
            "sparse over others",
            with_primitive(|file| {
                let moved = [CORNERS[0], [9.0; 3], CORNERS[2], CORNERS[3]];
                let base = file.view(&bytes_of(&moved));
                let (indices, values) = (file.view(&1_u32.to_le_bytes()), file.view(&bytes_of(&CORNERS[1..2])));
                let positions = file.push("accessors", json!({
                "bufferView": base, "componentType": F32, "type": "VEC3", "count": 4, "sparse": {
                    "count": 1, "indices": { "bufferView": indices, "componentType": U32 }, "values": { "bufferView": values }
                }
            }));
                json!({ "attributes": { "POSITION": positions, "NORMAL": 1 }, "indices": 2, "material": 0 })
            }),
        ),
        ("two primitives", {
            let mut file = small();
            let [first, second] = [&FACES[..6], &FACES[6..]].map(|half| file.shorts(half));
            let half =
                |indices| json!({ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": indices, "material": 0 });
            file.json["meshes"][0]["primitives"] = json!([half(first), half(second)]);
            file
        }),
        ("a matrix", {
            let mut file = small();
            // Columns: a turn of 2·acos(0.8) about z has cosine 0.28 and sine 0.96.
            file.json["nodes"][0] = json!({
                "name": "Stone", "mesh": 0, "matrix": [0.28, 0.96, 0, 0, -0.96, 0.28, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1]
            });
            file
        }),
    ];
    for (way, file) in ways {
        let scene = read(&file);
        let found = triangles(&scene, "room/Stone");
        assert_eq!(found.len(), expected.len(), "{way}");
        for (a, b) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((*a - *b).length() < SINGLE, "{way}: {a} is not {b}");
        }
    }
}

#[test]
fn quantized_numbers_are_shares() {
    let file = with_primitive(|file| {
        let positions: Vec<u8> =
            [[0_u16, 0, 0], [65535, 0, 0], [0, 65535, 0]].iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let positions = file.accessor(super::made::U16, "VEC3", 3, &positions);
        file.json["accessors"][positions]["normalized"] = json!(true);
        let normals: Vec<u8> =
            [[0_i8, 0, 127, 0], [0, 0, -128, 0], [0, 127, 0, 0]].iter().flatten().map(|x| *x as u8).collect();
        let view = file.view(&normals);
        file.json["bufferViews"][view]["byteStride"] = json!(4);
        let normals =
            json!({ "bufferView": view, "componentType": 5120, "type": "VEC3", "count": 3, "normalized": true });
        let normals = file.push("accessors", normals);
        file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        json!({ "attributes": { "POSITION": positions, "NORMAL": normals } })
    });
    let scene = read(&file);
    let (mesh, _) = mesh(&scene, "room/Stone");
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.normals, [Vec3::Z, Vec3::NEG_Z, Vec3::Y]);
}

/// (0, 0) is a picture's upper left there, and its lower left here; vertices with and without them in one object have none.
#[test]
fn texture_coordinates_are_read_where_all_vertices_have_them() {
    let mut file = small();
    let pairs = [[0.0_f32, 0.0], [1.0, 0.0], [0.25, 0.75], [0.5, 1.0]];
    let bytes: Vec<u8> = pairs.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let coordinates = file.accessor(F32, "VEC2", 4, &bytes);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(coordinates);
    let scene = read(&file);
    let (mesh, _) = mesh(&scene, "room/Stone");
    for (position, at) in mesh.positions.iter().zip(&mesh.coordinates) {
        let corner = CORNERS.iter().position(|corner| *corner == position.to_array()).expect("a corner");
        assert_eq!(at.to_array(), [pairs[corner][0], 1.0 - pairs[corner][1]]);
    }
    assert_eq!(mesh.coordinates.len(), 4);
    let more = json!({ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2, "material": 0 });
    file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(more);
    assert!(self::mesh(&read(&file), "room/Stone").0.coordinates.is_empty());
    // Of a file as a mesh too, which a material with a texture then may have.
    let folder = Folder::new();
    file.json["meshes"][0]["primitives"].as_array_mut().unwrap().pop();
    folder.write("room.glb", file.glb());
    folder.write("tiles.png", include_bytes!("../../../scenes/water.png"));
    let tiles = "[materials.tiles.diffuse]\ntexture = \"tiles.png\"\n";
    let stone = "[objects.stone]\nmaterial = \"tiles\"\nmesh = { file = \"room.glb\", fit = 1, center = [0, 1, 0] }\n";
    let import = "[imports.room]\nfile = \"room.glb\"\nmaterials = { Glass = \"tiles\" }\n";
    let scene = folder.load_with(&format!("{tiles}{stone}{import}"), &[]).unwrap();
    assert!(["stone", "room/Stone"].iter().all(|name| self::mesh(&scene, name).0.coordinates.len() == 4));
    folder.write("room.glb", small().glb());
    for (more, key) in [(stone, "objects.stone.material"), (import, "imports.room.materials")] {
        let error = folder.load_with(&format!("{tiles}{more}"), &[]).unwrap_err();
        assert!(error.key == key && error.expected.contains("texture coordinates"), "{error}");
        assert!(error.remedy.contains("`TEXCOORD_0` in glTF"), "{error}");
    }
}

/// Every other triangle of a strip is turned, so that all face one way; without normals each is flat.
#[test]
fn strips_and_fans_are_wound_one_way() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
    let around = [square[0], square[1], square[3], square[4]];
    for (mode, corners, count) in [(5, &square[..], 3), (6, &around, 2)] {
        let file = with_primitive(|file| {
            let positions = file.vectors(corners);
            json!({ "attributes": { "POSITION": positions }, "mode": mode })
        });
        let scene = read(&file);
        let (mesh, _) = mesh(&scene, "room/Stone");
        assert_eq!(mesh.triangles.len(), count);
        assert!(mesh.normals.iter().all(|n| *n == Vec3::Z), "{mode}: {:?}", mesh.normals);
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|k| mesh.positions[k as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        assert_eq!(mesh.triangles.iter().map(area).sum::<f32>(), 1.5, "{mode}");
    }
}

#[test]
fn normals_of_zero_are_made_from_the_triangles() {
    let file = with_primitive(|file| {
        let normals = file.vectors(&[NORMALS[0], [0.0; 3], NORMALS[2], NORMALS[3]]);
        json!({ "attributes": { "POSITION": 0, "NORMAL": normals }, "indices": 2 })
    });
    let scene = read(&file);
    assert!(scene.warnings.iter().any(|w| w.contains("1 normal was zero: it is made from the triangles about it")));
    let (mesh, _) = mesh(&scene, "room/Stone");
    assert!(mesh.normals.iter().all(|n| n.is_normalized()), "{:?}", mesh.normals);
    let at = mesh.positions.iter().position(|p| *p == Vec3::X).unwrap();
    assert!(mesh.normals[at].x > 0.5, "it points away from the body: {}", mesh.normals[at]);
}

/// The `gltf` crate, another reader, finds the same nodes, corners, normals, materials and lights.
#[test]
fn another_reader_reads_the_same() {
    let mut file = small();
    file.json["nodes"][0]["scale"] = json!([2, 1, 0.5]);
    file.json["nodes"][1]["children"] = json!([file.json["nodes"].as_array().unwrap().len()]);
    file.push("nodes", json!({ "name": "Below", "mesh": 0, "translation": [0.5, 0.25, 0] }));
    let bytes = file.glb();
    let (ours, theirs) = (read(&file), gltf::Gltf::from_slice(&bytes).unwrap());
    let blob = theirs.blob.clone().unwrap();
    let mut open: Vec<_> = theirs.default_scene().unwrap().nodes().map(|node| (node, glam::DMat4::IDENTITY)).collect();
    let mut seen = 0;
    while let Some((node, parent)) = open.pop() {
        let columns = node.transform().matrix().map(|column| column.map(f64::from));
        let world = parent * glam::DMat4::from_cols_array_2d(&columns);
        open.extend(node.children().map(|child| (child, world)));
        let name = format!("room/{}", node.name().unwrap());
        if let Some(written) = node.mesh() {
            let primitive = written.primitives().next().unwrap();
            let reader = primitive.reader(|_| Some(&blob));
            let corners: Vec<_> = reader.read_positions().unwrap().map(|p| Vec3::from_array(p).as_dvec3()).collect();
            let normals: Vec<_> = reader.read_normals().unwrap().map(Vec3::from_array).collect();
            let indices: Vec<_> = reader.read_indices().unwrap().into_u32().collect();
            let (mesh, _) = mesh(&ours, &name);
            for (corner, index) in triangles(&ours, &name).iter().flatten().zip(&indices) {
                close(*corner, world.transform_point3(corners[*index as usize]), SINGLE);
            }
            for (vertex, index) in mesh.triangles.iter().flatten().zip(&indices) {
                let (ours, theirs) = (mesh.normals[*vertex as usize], normals[*index as usize]);
                close(ours.as_dvec3(), theirs.as_dvec3(), SINGLE);
            }
            let material = primitive.material();
            let MaterialKind::Dielectric { ior, .. } = self::material(&ours, "room/Glass") else { panic!("no glass") };
            assert!((ior[0] - f64::from(material.ior().unwrap())).abs() < SINGLE);
            seen += 1;
        }
        if let Some(written) = node.light() {
            let LightKind::Spot { position, intensity, beam, .. } = light(&ours, &name) else { panic!("no spot") };
            close(*position, world.transform_point3(DVec3::ZERO), SINGLE);
            close(beam.axis, world.transform_vector3(DVec3::NEG_Z), SINGLE);
            assert!((intensity[0] * 683.0 - f64::from(written.intensity())).abs() < SINGLE * 683.0);
            seen += 1;
        }
        if let Some(written) = node.camera() {
            let gltf::camera::Projection::Perspective(view) = written.projection() else { panic!("no pinhole") };
            let CameraKind::Pinhole { fov_y } = ours.cameras[&name].kind else { panic!("no pinhole") };
            assert!((fov_y - f64::from(view.yfov()).to_degrees()).abs() < 1e-4);
            seen += 1;
        }
    }
    assert_eq!(seen, 4);
}
