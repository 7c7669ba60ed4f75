//! What a sound scene means: units, overrides, the region and its camera, meshes in place.
use glam::{DVec3, dvec3};
use nephroid::scene::{CameraKind, LightKind, MaterialKind, PathClass, Scene, Shape};

use super::{BASE, Folder, load};

/// Rounding of a handful of double-precision operations on numbers of order one.
const ROUNDING: f64 = 1e-12;
/// Mesh positions are stored in single precision.
const SINGLE: f64 = 1e-6;

#[track_caller]
fn close(a: DVec3, b: DVec3, tolerance: f64) {
    assert!((a - b).length() <= tolerance, "{a} is not {b}");
}

fn quad(scene: &Scene, name: &str) -> [DVec3; 3] {
    match scene.objects.iter().find(|object| object.name == name).map(|object| &object.shape) {
        Some(&Shape::Quad { center, u, v }) => [center, u, v],
        _ => panic!("no quad `{name}`"),
    }
}

#[test]
fn the_base_scene_is_read_as_written() {
    let scene = Folder::new().load(BASE, &[]).unwrap();
    assert_eq!([scene.name.as_str(), scene.title.as_str()], ["scene", "Test"]);
    assert_eq!(scene.paths, PathClass::Transmit2);
    assert_eq!(scene.exposure, 0.0);
    let names = |names: Vec<&String>| names.into_iter().cloned().collect::<Vec<_>>().join(" ");
    assert_eq!(names(scene.objects.iter().map(|o| &o.name).collect()), "ball floor");
    assert_eq!(names(scene.materials.iter().map(|m| &m.name).collect()), "glass silver white");
    assert_eq!(names(scene.lights.iter().map(|l| &l.name).collect()), "lamp sun");
    assert_eq!(names(scene.cameras.keys().collect()), "main region");
    assert_eq!(scene.objects[0].material, 0);
    assert!(scene.objects[0].visible_to_camera && scene.has_specular());
    assert_eq!(scene.materials[0].kind, MaterialKind::Dielectric { ior: [1.5; 3], absorption: [0.0, 0.1, 0.0] });
    assert_eq!(scene.lights[0].kind, LightKind::Point { position: dvec3(1.0, 3.0, 0.0), intensity: [20.0; 3] });
    assert_eq!(scene.lights[1].kind, LightKind::Directional { direction: DVec3::NEG_Y, irradiance: [1.0; 3] });
    assert_eq!(scene.region.normal(), DVec3::Y);
    assert_eq!(scene.region.area(), 4.0);
}

#[test]
fn path_classes_are_read_as_they_are_shown() {
    for class in
        [PathClass::Reflect1, PathClass::Transmit1, PathClass::Transmit2, PathClass::All(1), PathClass::All(64)]
    {
        assert_eq!(class.to_string().parse(), Ok(class));
    }
    for text in ["", "all", "all:", "all:0", "all:65", "all:-1", "all: 2", "Reflect-1"] {
        assert!(text.parse::<PathClass>().is_err(), "{text}");
    }
}

#[test]
fn shipped_scenes_load_by_name_and_have_titles() {
    let names: Vec<_> = Scene::shipped().map(|(name, _)| name).collect();
    assert_eq!(
        names,
        [
            "bending",
            "bunny",
            "diffuse",
            "flat-water",
            "gem",
            "glass-sphere",
            "knot",
            "moving-sphere",
            "null",
            "paraboloid",
            "ring",
            "room",
            "sine-water",
            "water"
        ]
    );
    let of_papers: Vec<_> = Scene::of_papers().map(|(name, _)| name).collect();
    assert_eq!(of_papers, ["sea", "two-lights", "waves"]);
    for (name, title) in Scene::shipped().chain(Scene::of_papers()) {
        let scene = load(name, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert!(!title.is_empty() && scene.title == title && scene.name == name);
        assert_eq!(scene.has_specular(), name != "diffuse");
    }
}

#[test]
fn null_is_glass_sphere_at_index_one() {
    let null = load("null", &[]).unwrap();
    let glass = load("glass-sphere", &[("materials.glass.dielectric.ior", "1.0"), ("title", &null.title)]).unwrap();
    assert_eq!(null.source.resolved, glass.source.resolved);
}

/// `unit` scales every length, and leaves W/sr, W/m², 1/m, degrees and the exposure alone.
#[test]
fn unit_scales_lengths_alone() {
    const UNIT: f64 = 0.001;
    for (name, _) in Scene::shipped() {
        let (one, small) = (load(name, &[]).unwrap(), load(name, &[("unit", "0.001")]).unwrap());
        for (a, b) in one.objects.iter().zip(&small.objects) {
            let (Some(a), Some(b)) = (a.shape.bounds(), b.shape.bounds()) else { panic!("no bounds") };
            (0..2).for_each(|i| close(a[i] * UNIT, b[i], ROUNDING));
        }
        for (a, b) in [(&one.region, &small.region), (&one.extent, &small.extent)] {
            for (a, b) in [(a.center, b.center), (a.u, b.u), (a.v, b.v)] {
                close(a * UNIT, b, ROUNDING);
            }
        }
        for (a, b) in one.cameras.values().zip(small.cameras.values()) {
            close(a.position * UNIT, b.position, ROUNDING);
            close(a.target * UNIT, b.target, ROUNDING);
        }
        let mut light = one.lights[0].kind.clone();
        if let LightKind::Point { position, .. } | LightKind::Spot { position, .. } = &mut light {
            let small = small.lights[0].kind.position().expect("a light of the same kind");
            close(*position * UNIT, small, ROUNDING);
            *position = small;
        }
        assert_eq!(light, small.lights[0].kind);
        let kinds = |scene: &Scene| scene.materials.iter().map(|m| m.kind.clone()).collect::<Vec<_>>();
        assert_eq!(kinds(&one), kinds(&small));
    }
}

#[test]
fn the_region_is_placed_in_the_receivers_own_metres() {
    let text = BASE.replace("center = [0, 0]\nhalf = [1, 1]", "center = [1, 2]\nhalf = [2.5, 0.5]");
    let scene = Folder::new().load(text, &[]).unwrap();
    assert_eq!(scene.objects[scene.region.receiver].name, "floor");
    close(scene.region.center, dvec3(1.0, -1.5, -2.0), ROUNDING);
    close(scene.region.u, dvec3(2.5, 0.0, 0.0), ROUNDING);
    close(scene.region.v, dvec3(0.0, 0.0, -0.5), ROUNDING);
    // Twice the region about (1, 2) reaches from -4 to 6 along u: cut to the floor's ±4.
    close(scene.extent.center, dvec3(0.0, -1.5, -2.0), ROUNDING);
    close(scene.extent.u, dvec3(4.0, 0.0, 0.0), ROUNDING);
    close(scene.extent.v, dvec3(0.0, 0.0, -1.0), ROUNDING);
    let stated = "[extent]\ncenter = [0, 0]\nhalf = [3, 3]\n\n[cameras.main.pinhole]";
    let scene = Folder::new().load(BASE.replace("[cameras.main.pinhole]", stated), &[]).unwrap();
    assert_eq!(scene.extent.area(), 36.0);
}

#[test]
fn the_region_camera_sees_just_the_region_from_above_everything() {
    let scene = Folder::new().load(BASE, &[("region.half", "[2, 1]")]).unwrap();
    let (camera, region) = (&scene.cameras["region"], &scene.region);
    assert_eq!(camera.kind, CameraKind::Orthographic { height: 2.0, width: Some(4.0) });
    assert!(camera.hides_specular && camera.target == region.center && camera.up == DVec3::NEG_Z);
    close((camera.target - camera.position).normalize(), -region.normal(), ROUNDING);
    assert!(camera.position.y > 1.0, "above the ball");
    // Up × back = right: the region's u runs to the right.
    close(camera.up.cross(region.normal()).normalize(), region.u.normalize(), ROUNDING);
}

#[test]
fn overrides_are_applied_checked_and_kept() {
    let folder = Folder::new();
    let plain = folder.load(BASE, &[]).unwrap();
    let set = [
        ("materials.glass.dielectric.ior", "1.33"),
        ("objects.floor.quad.center", "[0, -2, 0]"),
        ("paths", "all:3"),
        ("objects.floor.material", "'white'"),
    ];
    let scene = folder.load(BASE, &set).unwrap();
    assert!(matches!(scene.materials[0].kind, MaterialKind::Dielectric { ior: [1.33, 1.33, 1.33], .. }));
    assert_eq!(quad(&scene, "floor")[0].y, -2.0);
    assert_eq!(scene.region.center.y, -2.0);
    assert_eq!(scene.paths, PathClass::All(3));
    assert_eq!(scene.source.overrides.len(), set.len());
    assert_eq!(scene.source.text, BASE);
    assert_ne!(scene.source.hash, plain.source.hash);
    // What is resolved is a scene, and the same one.
    let again = folder.load(&scene.source.resolved, &[]).unwrap();
    assert_eq!([&again.source.resolved, &again.source.hash], [&scene.source.resolved, &scene.source.hash]);
    assert_eq!(quad(&again, "floor"), quad(&scene, "floor"));
}

#[test]
fn a_kind_may_be_left_out_or_changed() {
    let folder = Folder::new();
    let short = folder.load(BASE, &[("materials.glass.ior", "1.33"), ("objects.ball.radius", "2")]).unwrap();
    let full = [("materials.glass.dielectric.ior", "1.33"), ("objects.ball.sphere.radius", "2")];
    assert_eq!(short.source.resolved, folder.load(BASE, &full).unwrap().source.resolved);
    let mirror = folder.load(BASE, &[("materials.glass", "{ mirror = { reflectance = [1, 0.9, 0.5] } }")]).unwrap();
    assert_eq!(mirror.materials[0].kind, MaterialKind::Mirror { reflectance: [1.0, 0.9, 0.5] });
}

/// Keys that the file leaves at their default are set as if it had written them.
#[test]
fn what_the_file_leaves_out_can_be_set() {
    let folder = Folder::new();
    let set = |key, value| folder.load(BASE, &[(key, value)]).unwrap();
    assert_eq!(set("extent.half", "[3, 3]").extent.area(), 36.0);
    let aside = set("extent.center", "[1, 1]").extent;
    close(aside.center, dvec3(1.0, -1.5, -1.0), ROUNDING);
    assert_eq!(aside.area(), 16.0);
    assert_eq!(set("exposure", "2").exposure, 2.0);
    assert!(!set("objects.floor.visible_to_camera", "false").objects[1].visible_to_camera);
    let bare = BASE.replace("up = [0, 1, 0]\n", "").replace("absorption = [0, 0.1, 0]\n", "");
    for key in ["cameras.main.pinhole.up", "cameras.main.up"] {
        let scene = folder.load(&bare, &[(key, "[1, 0, 0]"), ("cameras.main.hides_specular", "true")]).unwrap();
        assert!(scene.cameras["main"].up == DVec3::X && scene.cameras["main"].hides_specular, "{key}");
    }
    let scene = folder.load(&bare, &[("materials.glass.absorption", "0.5")]).unwrap();
    assert_eq!(scene.materials[0].kind, MaterialKind::Dielectric { ior: [1.5; 3], absorption: [0.5; 3] });
    assert!(scene.source.resolved.contains("absorption = 0.5"));
}

#[test]
fn comments_do_not_change_the_hash_and_meshes_do() {
    let folder = Folder::new();
    let hash = |text: &str| folder.load(text, &[]).unwrap().source.hash;
    assert_eq!(hash(BASE), hash(&format!("# a comment\n{BASE}")));
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let before = hash(&with_mesh("m.obj"));
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    assert_ne!(before, hash(&with_mesh("m.obj")));
}

fn with_mesh(file: &str) -> String {
    let mesh = format!("[objects.ball.mesh]\nfile = \"{file}\"\nfit = 3\ncenter = [1, 2, 3]\nrotate = [0, 0, 0]");
    BASE.replace("[objects.ball.sphere]\ncenter = [0, 0, 0]\nradius = 1", &mesh)
}

fn ball(scene: &Scene) -> &Shape {
    &scene.objects[0].shape
}

/// A box of 1 × 2 × 4: its longest side is scaled to 3, and its base rests on (1, 2, 3), turned or not.
#[test]
fn a_mesh_is_fitted_and_rests_on_its_center() {
    let folder = Folder::new();
    folder.write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 4\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
    let text = with_mesh("box.obj");
    let base = |[low, high]: [DVec3; 2]| (0.5 * (low + high)).with_y(low.y);
    let plain = ball(&folder.load(&text, &[]).unwrap()).bounds().unwrap();
    close(plain[1] - plain[0], dvec3(0.75, 1.5, 3.0), SINGLE);
    close(base(plain), dvec3(1.0, 2.0, 3.0), SINGLE);
    // A quarter turn about x takes y to z.
    let turned = folder.load(&text, &[("objects.ball.mesh.rotate", "[90, 0, 0]")]).unwrap();
    let turned = ball(&turned).bounds().unwrap();
    close(turned[1] - turned[0], dvec3(0.75, 3.0, 1.5), SINGLE);
    close(base(turned), dvec3(1.0, 2.0, 3.0), SINGLE);
    // About x first, then z: z goes to -y, and on to x.
    let twice = folder.load(&text, &[("objects.ball.mesh.rotate", "[90, 0, 90]")]).unwrap();
    let Shape::Mesh { to_world, .. } = ball(&twice) else { panic!("no mesh") };
    close(to_world.transform_vector3(DVec3::Z).normalize(), DVec3::X, ROUNDING);
}

#[test]
fn polygons_normals_and_backward_indices_are_read() {
    let folder = Folder::new();
    let obj = "v 0 0 0\nv 1 0 0\nv 1 0 -1 # far\nv 0 0 -1\nvt 0 0\nvn 0 2 0\nvn 1 0 0\n\n\
               f 1/1/1 2/1/1 3/1/1 4/1/1\nf -4//2 -3//2 -2//2\n";
    folder.write("m.obj", obj);
    let scene = folder.load(with_mesh("m.obj"), &[]).unwrap();
    let Shape::Mesh { mesh, .. } = ball(&scene) else { panic!("no mesh") };
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6]]);
    assert_eq!(mesh.normals[0], glam::Vec3::Y);
    assert_eq!(mesh.normals[4], glam::Vec3::X, "a vertex of another normal is another vertex");
    assert_eq!(mesh.positions[4], mesh.positions[0]);
}

/// Hard cases that must load: no face at all, and triangles without area, even a mesh of one point.
#[test]
fn empty_and_degenerate_meshes_load() {
    let folder = Folder::new();
    folder.write("empty.obj", "# nothing\nv 0 0 0\n");
    let scene = folder.load(with_mesh("empty.obj"), &[]).unwrap();
    let Shape::Mesh { mesh, to_world } = ball(&scene) else { panic!("no mesh") };
    assert!(mesh.triangles.is_empty() && mesh.positions.is_empty() && mesh.bounds(|p| p).is_none());
    assert!(to_world.is_finite());
    folder.write("point.obj", "v 5 5 5\nf 1 1 1\n");
    let scene = folder.load(with_mesh("point.obj"), &[]).unwrap();
    assert_eq!(ball(&scene).bounds(), Some([dvec3(1.0, 2.0, 3.0); 2]));
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 0 -1\nf 1 2 3\nf 1 2 4\n");
    let scene = folder.load(with_mesh("flat.obj"), &[]).unwrap();
    let Shape::Mesh { mesh, .. } = ball(&scene) else { panic!("no mesh") };
    assert!(mesh.normals.iter().all(|n| *n == glam::Vec3::Y), "{:?}", mesh.normals);
}

#[test]
fn the_bunny_is_whole_and_its_normals_point_outwards() {
    let scene = load("bunny", &[]).unwrap();
    let Shape::Mesh { mesh, to_world } = &scene.objects[0].shape else { panic!("no mesh") };
    assert_eq!([mesh.triangles.len(), mesh.positions.len(), mesh.normals.len()], [3674, 1839, 1839]);
    let [low, high] = scene.objects[0].shape.bounds().unwrap();
    assert!(((high - low).max_element() - 1.5).abs() < SINGLE && low.y.abs() < SINGLE);
    // Flux of the position through the surface is three times the volume: positive if it is wound outwards.
    let corner = |i: u32| to_world.transform_point3(mesh.positions[i as usize].as_dvec3());
    let volume: f64 = mesh.triangles.iter().map(|t| t.map(corner)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
    assert!(volume > 0.3, "{volume} m³");
    let aligned = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(corner);
        let along = (b - a).cross(c - a);
        t.iter().all(|&i| mesh.normals[i as usize].as_dvec3().dot(along) > 0.0)
    };
    let share = mesh.triangles.iter().filter(aligned).count() as f64 / mesh.triangles.len() as f64;
    assert!(share > 0.99, "{share} of the triangles agree with their vertices' normals");
}

/// A mesh named in an override of a shipped scene is sought in the program, then from the working directory.
#[test]
fn a_shipped_scene_takes_a_users_mesh() {
    let folder = Folder::new();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let path = folder.write("tetrahedron.obj", obj);
    let scene = load("bunny", &[("objects.bunny.mesh.file", path.to_str().unwrap())]).unwrap();
    let Shape::Mesh { mesh, .. } = &scene.objects[0].shape else { panic!("no mesh") };
    assert_eq!(mesh.triangles.len(), 4);
}
