//! Where nodes put their meshes, and what they share.
use std::{f64::consts::FRAC_1_SQRT_2, sync::Arc};

use glam::{DAffine3, DVec3, dvec3};
use nephroid::scene::Shape;
use serde_json::json;

use super::{
    Folder, SINGLE, close, imported,
    made::{FACES, Gltf, small},
    mesh, names, object, read, triangles,
};

/// A tree of nodes three deep, under the import's own place.
#[test]
fn nodes_are_placed_by_their_parents_and_by_the_import() {
    let mut file = small();
    file.json["nodes"][0] = json!({ "mesh": 0, "translation": [1, 0, 0] });
    let inner = file.push("nodes", json!({ "rotation": [0, FRAC_1_SQRT_2, 0, FRAC_1_SQRT_2], "children": [0] }));
    let outer = file.push("nodes", json!({ "scale": [2, 2, 2], "translation": [0, 5, 0], "children": [inner] }));
    file.json["scenes"][0]["nodes"] = json!([outer]);
    let keys = "scale = 0.1\nposition = [3, 0, 0]\nrotate = [0, 0, 90]\n";
    let scene = imported("room.glb", file.glb(), keys).unwrap();
    // (1, 0, 0) about y by 90° is (0, 0, -1), twice that and up 5; a tenth of it, about z by 90°, beside 3.
    let (_, to_world) = mesh(&scene, "room/node0");
    close(to_world.translation, dvec3(3.0 - 0.5, 0.0, -0.2), SINGLE);
    assert!((to_world.x_axis.length() - 0.2).abs() < SINGLE);
    // The scene's unit is of the place alone: glTF is in metres.
    let folder = Folder::new();
    folder.write("room.glb", file.glb());
    let scene = folder.load_with(&format!("[imports.room]\nfile = \"room.glb\"\n{keys}"), &[("unit", "0.5")]).unwrap();
    close(mesh(&scene, "room/node0").1.translation, dvec3(1.5 - 0.5, 0.0, -0.2), SINGLE);
}

#[test]
fn nodes_share_their_mesh_and_mirrored_ones_another() {
    let mut file = small();
    for scale in [[2.0, 2.0, 2.0], [0.5, 1.0, 3.0], [-1.0, 1.0, 1.0], [1.0, -2.0, 1.0], [-1.0, -1.0, 1.0]] {
        file.node(json!({ "name": "Stone", "mesh": 0, "scale": scale }));
    }
    let scene = read(&file);
    let of = |name: &str| mesh(&scene, &format!("room/{name}")).0;
    for shared in ["Stone#2", "Stone#3", "Stone#6"] {
        assert!(Arc::ptr_eq(of("Stone"), of(shared)), "{shared}");
    }
    assert!(Arc::ptr_eq(of("Stone#4"), of("Stone#5")) && !Arc::ptr_eq(of("Stone"), of("Stone#4")));
    for object in scene.objects.iter().filter(|object| object.name != "floor") {
        let Shape::Mesh { mesh, to_world } = &object.shape else { panic!("no mesh") };
        assert!(to_world.matrix3.determinant() > 0.0, "{}", object.name);
        let volume: f64 = triangles(&scene, &object.name).iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum();
        assert!(volume > 0.0, "{} is turned inside out", object.name);
        // Normals point away from the middle, as they do in the file.
        let to_normal = to_world.matrix3.inverse().transpose();
        let middle = mesh.positions.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / 4.0;
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            let out = to_world.transform_vector3(p.as_dvec3() - middle);
            assert!((to_normal * n.as_dvec3()).dot(out) > 0.0, "{}: {n} at {p}", object.name);
        }
    }
    // x goes to −x, in the world.
    let mirrored = triangles(&scene, "room/Stone#4");
    assert!(mirrored.iter().flatten().all(|p| p.x <= 0.0) && mirrored.iter().flatten().any(|p| p.x == -1.0));
}

/// What a node makes too flat for a ray of single precision is flattened in its mesh; what it leaves nothing of is told.
#[test]
fn flattened_nodes_have_meshes_of_their_own() {
    let mut file = small();
    file.node(json!({ "name": "Flat", "mesh": 0, "scale": [1, 1, 0], "translation": [0, 0, 7] }));
    file.node(json!({ "name": "Thin", "mesh": 0, "scale": [1e-6, 1, 1] }));
    file.node(json!({ "name": "Gone", "mesh": 0, "scale": [0, 1, 0] }));
    file.node(
        json!({ "name": "Huge", "mesh": 0, "matrix": [1e-20, 0, 0, 0, 0, 1e-20, 0, 0, 0, 0, 1e-20, 0, 0, 0, 0, 1] }),
    );
    let scene = read(&file);
    assert_eq!(names(&scene), ["floor", "room/Flat", "room/Huge", "room/Stone", "room/Thin"]);
    let (flat, to_world) = mesh(&scene, "room/Flat");
    assert_eq!(*to_world, DAffine3::from_translation(dvec3(0.0, 0.0, 7.0)));
    assert!(flat.positions.iter().all(|p| p.z == 0.0) && flat.normals.iter().all(|n| n.is_normalized()));
    let told = "1 mesh is scaled to nothing by its node and left out";
    assert!(scene.warnings.iter().any(|warning| warning.contains(told)), "{:?}", scene.warnings);
}

/// A body of two materials is two objects; of one material, in whatever parts, it is one and stays closed.
#[test]
fn a_mesh_of_several_materials_is_several_objects() {
    let mut file = small();
    let paint = file.push("materials", json!({ "name": "Paint", "pbrMetallicRoughness": { "metallicFactor": 0 } }));
    let [first, second] = [&FACES[..6], &FACES[6..]].map(|half| file.shorts(half));
    let half = |indices, material| json!({ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": indices, "material": material });
    file.json["meshes"][0]["primitives"] = json!([half(first, 0), half(second, paint)]);
    let scene = read(&file);
    assert_eq!(names(&scene), ["floor", "room/Stone/Glass", "room/Stone/Paint"]);
    assert_eq!(scene.imports[0].objects, 2);
    assert!(
        scene
            .warnings
            .iter()
            .any(|warning| warning.contains("`room/Stone/Glass` (room.glb) is a dielectric with 1 hole"))
    );
    file.json["meshes"][0]["primitives"] = json!([half(first, 0), half(second, 0)]);
    let scene = read(&file);
    assert_eq!(names(&scene), ["floor", "room/Stone"]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

/// The scene that is named, else the first, else all that nobody is a parent of.
#[test]
fn the_scene_that_the_file_names_is_read() {
    let mut file = small();
    file.json["scenes"] = json!([{ "nodes": [1] }, { "nodes": [0] }]);
    let objects = |file: &Gltf| read(file).imports[0].objects;
    assert_eq!(objects(&file), 0);
    file.json["scene"] = json!(1);
    assert_eq!(objects(&file), 1);
    file.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(objects(&file), 0);
    file.json.as_object_mut().unwrap().remove("scenes");
    file.push("nodes", json!({ "children": [0] }));
    let scene = read(&file);
    assert_eq!([scene.imports[0].objects, scene.imports[0].lights], [1, 1]);
}

/// As an object's mesh a whole file is one: its nodes where they are, in the object's own material.
#[test]
fn a_file_as_a_mesh_is_flattened_and_fitted() {
    let (folder, mut file) = (Folder::new(), small());
    file.node(json!({ "mesh": 0, "scale": [-1, 1, 1], "translation": [0, 1, 0] }));
    folder.write("stones.glb", file.glb());
    let objects = "[objects.stones]\nmaterial = \"white\"\nmesh = { file = \"stones.glb\", fit = 3, center = [0, 1, 0] }\n\
                   [objects.twins]\nmaterial = \"white\"\nmesh = { file = \"stones.glb\", fit = 1, center = [0, 2, 0] }\n";
    let scene = folder.load_with(objects, &[]).unwrap();
    let (stones, _) = mesh(&scene, "stones");
    assert!(Arc::ptr_eq(stones, mesh(&scene, "twins").0));
    assert_eq!(stones.triangles.len(), 8);
    let [low, high] = object(&scene, "stones").shape.bounds().unwrap();
    assert!(((high - low).max_element() - 3.0).abs() < SINGLE && (low.y - 1.0).abs() < SINGLE, "{low} {high}");
    let volume = |half: &[[DVec3; 3]]| half.iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum::<f64>();
    let all = triangles(&scene, "stones");
    let (first, mirrored) = (volume(&all[..4]), volume(&all[4..]));
    assert!(first > 0.0 && (mirrored - first).abs() < SINGLE * first, "{first} {mirrored}");
    assert!(scene.imports.is_empty() && scene.lights.is_empty() && scene.materials.len() == 1);
    let hash = scene.source.hash;
    file.bytes[0] ^= 1;
    folder.write("stones.glb", file.glb());
    assert_ne!(hash, folder.load_with(objects, &[]).unwrap().source.hash);
}
