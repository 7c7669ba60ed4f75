//! Materials, lights and cameras, and what is told of what they lose.
use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DVec3, dvec3};
use nephroid::scene::{CameraKind, LightKind, MaterialKind};
use serde_json::{Value, json};

use super::{
    ROUNDING, close, imported, light,
    made::{Gltf, small},
    material, object, read,
};

/// A material's keys, what it becomes, and words of what is told of it.
#[test]
fn materials_become_ours_and_what_they_lose_is_told() {
    let pbr = |colour: [f64; 3], metallic: f64, roughness: f64| json!({ "baseColorFactor": [colour[0], colour[1], colour[2], 1], "metallicFactor": metallic, "roughnessFactor": roughness });
    let clear = |more: Value| {
        let mut extensions = json!({ "KHR_materials_transmission": { "transmissionFactor": 1 } });
        extensions.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        json!({ "pbrMetallicRoughness": pbr([1.0; 3], 0.0, 0.0), "extensions": extensions })
    };
    let solid = |volume: Value| {
        let mut volume = volume;
        volume["thicknessFactor"] = json!(1);
        clear(json!({ "KHR_materials_volume": volume }))
    };
    let glass = |absorption| MaterialKind::Dielectric { ior: [1.5; 3], absorption };
    let diffuse = |albedo| MaterialKind::Diffuse { albedo, texture: None };
    let ln2 = std::f64::consts::LN_2;
    let cases: Vec<(Value, MaterialKind, &[&str])> = vec![
        (json!({}), diffuse([1.0; 3]), &["being a rough metal (roughness 1)"]),
        (json!({ "pbrMetallicRoughness": pbr([0.1, 0.2, 0.3], 0.0, 1.0) }), diffuse([0.1, 0.2, 0.3]), &[]),
        (json!({ "pbrMetallicRoughness": pbr([0.5; 3], 0.4, 0.2) }), diffuse([0.5; 3]), &["its gloss (roughness 0.2)"]),
        (
            json!({ "pbrMetallicRoughness": pbr([1.0, 0.75, 0.25], 1.0, 0.0) }),
            MaterialKind::Mirror { reflectance: [1.0, 0.75, 0.25] },
            &[],
        ),
        (
            json!({ "pbrMetallicRoughness": pbr([0.5; 3], 0.6, 0.25) }),
            MaterialKind::Mirror { reflectance: [0.5; 3] },
            &["what of it is no metal (metallic 0.6)", "its roughness 0.25"],
        ),
        // Glass: without a thickness the file means a wall.
        (clear(json!({})), glass([0.0; 3]), &["the thinness of a wall (no thickness is given: it is solid)"]),
        (
            clear(json!({ "KHR_materials_ior": { "ior": 1.33 }, "KHR_materials_volume": { "thicknessFactor": 0.5 } })),
            MaterialKind::Dielectric { ior: [1.33; 3], absorption: [0.0; 3] },
            &[],
        ),
        // Absorption: no distance, no colour, white, black, nearly black over next to nothing.
        (solid(json!({ "attenuationColor": [0.5, 0.5, 0.5] })), glass([0.0; 3]), &[]),
        (solid(json!({ "attenuationDistance": 2 })), glass([0.0; 3]), &[]),
        (
            solid(json!({ "attenuationDistance": 0.5, "attenuationColor": [1, 0.5, 0] })),
            glass([0.0, 2.0 * ln2, 1e12]),
            &[],
        ),
        (
            solid(json!({ "attenuationDistance": 1e-300, "attenuationColor": [1, 0.999, 1] })),
            glass([0.0, 1e12, 0.0]),
            &[],
        ),
        (
            json!({ "pbrMetallicRoughness": pbr([1.0, 0.5, 0.5], 0.1, 0.5),
            "extensions": { "KHR_materials_transmission": { "transmissionFactor": 0.25, "transmissionTexture": { "index": 0 } },
                "KHR_materials_volume": { "thicknessFactor": 1 }, "KHR_materials_dispersion": { "dispersion": 0.1 } } }),
            glass([0.0; 3]),
            &[
                "what it does not let through (transmission 0.25)",
                "what of it is metal (metallic 0.1)",
                "its roughness 0.5",
                "the tint of its surface",
                "its transmission texture (not read)",
                "\"KHR_materials_dispersion\"",
            ],
        ),
        // A metal lets nothing through.
        (
            json!({ "pbrMetallicRoughness": pbr([0.9; 3], 1.0, 0.0),
            "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 } } }),
            MaterialKind::Mirror { reflectance: [0.9; 3] },
            &[],
        ),
        (
            json!({ "pbrMetallicRoughness": { "metallicRoughnessTexture": { "index": 0 }, "metallicFactor": 0, "baseColorFactor": [1, 1, 1, 0.5] },
            "normalTexture": { "index": 1 }, "emissiveFactor": [0, 1, 0], "alphaMode": "BLEND" }),
            diffuse([1.0; 3]),
            &[
                "its metallic and roughness texture (not read)",
                "its normal texture",
                "its transparency (alpha 0.5)",
                "the light that it gives",
            ],
        ),
    ];
    for (written, expected, told) in cases {
        let mut file = small();
        file.json["materials"][0] = written.clone();
        let scene = read(&file);
        assert_eq!(material(&scene, "room/material0"), &expected, "{written}");
        let warning = scene.warnings.iter().find(|warning| warning.contains("`room/material0`"));
        assert_eq!(warning.is_some(), !told.is_empty(), "{written}: {warning:?}");
        for words in told {
            assert!(warning.is_some_and(|warning| warning.contains(words)), "{words}: {warning:?}");
        }
    }
}

#[test]
fn a_scale_is_of_every_length_and_of_no_power() {
    let scene = imported("room.glb", small().glb(), "scale = 0.01\n").unwrap();
    let MaterialKind::Dielectric { absorption, .. } = material(&scene, "room/Glass") else { panic!("no glass") };
    let ln2 = std::f64::consts::LN_2;
    close(DVec3::from_array(*absorption), dvec3(0.0, 50.0 * ln2, 100.0 * ln2), 1e-9);
    let LightKind::Spot { position, intensity, .. } = light(&scene, "room/Lamp") else { panic!("no spot") };
    close(*position, dvec3(0.0, 0.04, 0.0), ROUNDING);
    close(DVec3::from_array(*intensity), DVec3::ONE, ROUNDING);
}

#[test]
fn materials_are_replaced_by_the_scenes_own() {
    let scene = imported("room.glb", small().glb(), "materials = { Glass = \"white\" }\n").unwrap();
    assert_eq!(scene.materials[object(&scene, "room/Stone").material].name, "white");
    assert_eq!((scene.materials.len(), scene.imports[0].materials), (1, 0));
    let mut bare = small();
    bare.json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("material");
    let scene = imported("room.glb", bare.glb(), "").unwrap();
    assert_eq!(material(&scene, "room/default"), &MaterialKind::Diffuse { albedo: [1.0; 3], texture: None });
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let scene = imported("room.glb", bare.glb(), "materials = { default = \"white\" }\n").unwrap();
    assert_eq!(scene.materials[object(&scene, "room/Stone").material].name, "white");
}

#[test]
fn lights_keep_their_place_colour_and_unit() {
    let mut file = Gltf::new();
    let turned = json!([-(15_f64.to_radians().sin()), 0, 0, 15_f64.to_radians().cos()]);
    for (kind, name) in [("directional", "Sun"), ("point", "Bulb"), ("spot", "Torch")] {
        let light = file.light(json!({ "type": kind, "color": [1, 0.5, 0], "intensity": 1366, "range": 9 }));
        file.node(json!({
            "name": name, "translation": [1, 2, 3], "rotation": turned, "scale": [2, 2, 2],
            "extensions": { "KHR_lights_punctual": { "light": light } }
        }));
    }
    let scene = read(&file);
    let along = dvec3(0.0, -0.5, -(30_f64.to_radians().cos()));
    let strength = [2.0, 1.0, 0.0];
    let LightKind::Directional { direction, irradiance } = light(&scene, "room/Sun") else { panic!("no sun") };
    close(*direction, along, ROUNDING);
    close(DVec3::from_array(*irradiance), DVec3::from_array(strength), ROUNDING);
    let LightKind::Point { position, intensity } = light(&scene, "room/Bulb") else { panic!("no bulb") };
    close(*position, dvec3(1.0, 2.0, 3.0), ROUNDING);
    close(DVec3::from_array(*intensity), DVec3::from_array(strength), ROUNDING);
    let LightKind::Spot { beam, .. } = light(&scene, "room/Torch") else { panic!("no torch") };
    close(beam.axis, along, ROUNDING);
    assert!(beam.inner == 0.0 && (beam.outer - (1.0 - FRAC_1_SQRT_2)).abs() < ROUNDING);
    assert!(scene.warnings.iter().any(|w| w.contains("3 lights are given without end: their `range` is not read")));
    let watts = imported("room.glb", file.glb(), "watts_per_lumen = 1\n").unwrap();
    let LightKind::Point { intensity, .. } = light(&watts, "room/Bulb") else { panic!("no bulb") };
    assert_eq!(*intensity, [1366.0, 683.0, 0.0]);
    let mut stone = small();
    stone.light(json!({ "type": "point" }));
    let dark = imported("room.glb", stone.glb(), "lights = false\n").unwrap();
    assert!(dark.lights.is_empty() && dark.imports[0].lights == 0 && dark.objects.len() == 2);
}

#[test]
fn an_orthographic_camera_keeps_its_height() {
    let mut file = small();
    file.json["cameras"][0] =
        json!({ "type": "orthographic", "orthographic": { "xmag": 2, "ymag": 1.5, "zfar": 9, "znear": 0 } });
    let scene = imported("room.glb", file.glb(), "scale = 2\n").unwrap();
    assert_eq!(scene.cameras["room/Eye"].kind, CameraKind::Orthographic { height: 6.0, width: None });
}

#[test]
fn what_stands_still_or_is_not_drawn_is_told() {
    let mut file = small();
    file.json["animations"] = json!([{ "channels": [], "samplers": [] }]);
    file.json["skins"] = json!([{ "joints": [1] }]);
    file.json["nodes"][0]["skin"] = json!(0);
    file.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing", "KHR_lights_punctual", "KHR_materials_clearcoat"]);
    let primitives = file.json["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives[0]["targets"] = json!([{ "POSITION": 0 }]);
    primitives[0]["attributes"]["COLOR_0"] = json!(0);
    primitives.push(json!({ "attributes": { "POSITION": 0 }, "mode": 1 }));
    primitives.push(json!({ "attributes": { "POSITION": 0 }, "mode": 0 }));
    let told = read(&file).warnings;
    for words in [
        "`room` (room.glb): 1 animation is not played",
        "1 node is read without its skin, as its mesh stands",
        "1 mesh is read without its morph targets",
        "1 mesh has colours of its vertices, which are not read",
        "2 primitives of points or lines are left out",
        "without \"EXT_mesh_gpu_instancing\"",
    ] {
        assert!(told.iter().any(|warning| warning.contains(words)), "{words}: {told:?}");
    }
    assert_eq!(told.len(), 6, "{told:?}");
}
