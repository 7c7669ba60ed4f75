use super::*;
use crate::scene::Mesh;
use glam::Vec3;

/// Stored entries and three products of float32, on coordinates of order one.
const ROUNDING: f32 = 1e-6;

fn load(name: &str) -> Scene {
    Scene::load(name, &[]).unwrap()
}

fn arrays(scene: &Scene) -> SceneArrays {
    SceneArrays::build(scene).unwrap()
}

fn map(rows: &[[f32; 4]; 3], p: [f32; 3]) -> [f32; 3] {
    rows.map(|r| r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3])
}

#[test]
fn constants_agree_with_the_shaders() {
    let source =
        |file: &str| std::fs::read_to_string(format!("{}/glsl/shared/{file}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    assert!(source("bvh.glsl").contains(&format!("const int TRAVERSAL_STACK = {TRAVERSAL_STACK};")));
    let scene = source("scene.glsl");
    assert!(scene.contains(&format!("const uint NODE_INDEX = {LARGEST_INDEX:#010x}u;")));
    for (name, value) in [
        ("GRID_ENTRIES", GRID_ENTRIES),
        ("SHAPE_SPHERE", SHAPE_SPHERE),
        ("SHAPE_QUAD", SHAPE_QUAD),
        ("SHAPE_MESH", SHAPE_MESH),
        ("SHAPE_BOX", SHAPE_BOX),
        ("SHAPE_DISK", SHAPE_DISK),
        ("SHAPE_CYLINDER", SHAPE_CYLINDER),
        ("SHAPE_PARABOLOID", SHAPE_PARABOLOID),
        ("SHAPE_SINE", SHAPE_SINE),
        ("MATERIAL_DIFFUSE", MATERIAL_DIFFUSE),
        ("MATERIAL_DIELECTRIC", MATERIAL_DIELECTRIC),
        ("MATERIAL_MIRROR", MATERIAL_MIRROR),
        ("MATERIAL_CONDUCTOR", MATERIAL_CONDUCTOR),
        ("LIGHT_DIRECTIONAL", LIGHT_DIRECTIONAL),
        ("LIGHT_PATCH", LIGHT_PATCH),
        ("LIGHT_POINT", LIGHT_POINT),
    ] {
        assert!(scene.contains(&format!("const uint {name} = {value}u;")), "{name}");
    }
}

#[test]
fn media_are_packed_with_the_innermost_lowest() {
    assert_eq!(packed_media(&[]), u32::MAX);
    assert_eq!(packed_media(&[3, 7]), 0xffff_0307);
    assert_eq!(packed_media(&[9, 1, 2, 3, 4]), 0x0102_0304, "the outermost of five is left out");
}

#[test]
fn canonical_shapes_land_where_the_scene_puts_them() {
    let scene = load("glass-sphere");
    let all = arrays(&scene);
    for instance in &all.instances {
        let (name, shape) = {
            let o = &scene.objects[instance.object as usize];
            (&o.name, &o.shape)
        };
        let (canonical, place) = match shape {
            Shape::Sphere { center, radius } => ([0.0, 1.0, 0.0], *center + DVec3::Y * *radius),
            Shape::Quad { center, u, v } => ([1.0, -1.0, 0.0], *center + *u - *v),
            Shape::Mesh { .. } | Shape::Canonical { .. } => panic!("{name} is no sphere or quad"),
        };
        let world = map(&instance.to_world, canonical);
        let back = map(&instance.to_object, world);
        let size = place.abs().max_element().max(1.0) as f32;
        assert!((Vec3::from(world) - place.as_vec3()).length() < ROUNDING * size, "{name}: {world:?} for {place}");
        assert!((Vec3::from(back) - Vec3::from(canonical)).length() < ROUNDING * size, "{name}: back at {back:?}");
    }
}

#[test]
fn a_mesh_used_twice_is_built_once() {
    let mut scene = load("bunny");
    let once = arrays(&scene);
    let twin = scene.objects.iter().find(|o| matches!(o.shape, Shape::Mesh { .. })).unwrap().clone();
    scene.objects.push(Object { name: "twin".into(), ..twin });
    let twice = arrays(&scene);
    assert_eq!(twice.triangles.len(), once.triangles.len());
    assert_eq!(twice.instances.len(), once.instances.len() + 1);
    let roots: Vec<u32> = twice.instances.iter().filter(|i| i.kind == SHAPE_MESH).map(|i| i.detail).collect();
    assert_eq!(roots, [roots[0]; 2]);
    assert!(roots[0] > 0 && (roots[0] as usize) < twice.nodes.len());
}

#[test]
fn indices_stay_inside_their_arrays() {
    let all = arrays(&load("bunny"));
    let (mut open, mut triangles) = (vec![], 0);
    open.extend(all.instances.iter().filter(|i| i.kind == SHAPE_MESH).map(|i| i.detail + GRID_ENTRIES));
    while let Some(index) = open.pop() {
        let node = all.nodes[index as usize];
        if node.count() == 0 {
            open.extend([node.first(), node.first() + 1]);
        } else {
            assert!((node.first() + node.count()) as usize <= all.triangles.len());
            triangles += node.count() as usize;
        }
    }
    assert_eq!(triangles, all.triangles.len());
    assert_eq!(all.normals.len(), all.triangles.len());
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let (a, b) = (arrays(&load("bunny")), arrays(&load("bunny")));
    assert_eq!(a.nodes, b.nodes);
    assert_eq!(a.triangles, b.triangles);
    assert_eq!(a.instances, b.instances);
}

#[test]
fn nothing_and_an_empty_mesh_have_no_instance() {
    let mut scene = load("bunny");
    scene.objects.retain(|o| matches!(o.shape, Shape::Mesh { .. }));
    let Shape::Mesh { mesh, .. } = &mut scene.objects[0].shape else { panic!("not a mesh") };
    *mesh = Arc::new(Mesh {
        file: "none.obj".into(),
        positions: vec![],
        normals: vec![],
        triangles: vec![],
        coordinates: vec![],
        sheet: None,
    });
    for objects in [scene.objects.clone(), vec![]] {
        scene.objects = objects;
        let all = arrays(&scene);
        let [origin, cell, root] = all.nodes[..] else { panic!("{} entries", all.nodes.len()) };
        assert_eq!([origin.corners, cell.corners], [[f32::MAX.to_bits(); 3], [0; 3]]);
        assert_eq!((root.corners, root.count(), root.first()), ([0; 3], 1, 0));
        assert_eq!(all.instances, [Instance::default()]);
        assert_eq!(all.triangles.len(), 1);
    }
}

#[test]
fn normals_follow_their_triangles() {
    let scene = load("bunny");
    let all = arrays(&scene);
    let of = |k: usize| (all.triangles[k], all.normals[k]);
    let Some(mesh) =
        scene.objects.iter().find_map(|o| if let Shape::Mesh { mesh, .. } = &o.shape { Some(mesh) } else { None })
    else {
        panic!("bunny has a mesh")
    };
    for k in [0, 17, all.triangles.len() - 1] {
        let (t, n) = of(k);
        let vertex = mesh
            .triangles
            .iter()
            .find(|&&[a, b, c]| [a, b, c].map(|i| mesh.positions[i as usize].to_array()) == [t.a, t.b, t.c]);
        let [a, _, c] = vertex.unwrap().map(|i| mesh.normals[i as usize].to_array());
        assert_eq!([n.a, n.c], [a, c]);
    }
}

#[test]
fn what_float32_cannot_square_is_named() {
    let with = |shape: Shape| {
        let mut scene = load("glass-sphere");
        scene.objects[0].shape = shape;
        scene.objects[0].name = "odd".into();
        SceneArrays::build(&scene).unwrap_err().to_string()
    };
    let far = with(Shape::Sphere { center: DVec3::X * 1e16, radius: 1.0 });
    assert_eq!(
        far,
        "`odd`: its place or size is 1e16, beyond the ±1e15 that float32 shaders can square; rescale the scene"
    );
    let small = with(Shape::Sphere { center: DVec3::ZERO, radius: 1e-16 });
    assert!(small.contains("`odd`: the inverse of its size is 1.0"), "{small}");
    let flat = with(Shape::Quad { center: DVec3::ZERO, u: DVec3::X, v: DVec3::X });
    assert!(flat.starts_with("`odd`: its shape is flat"), "{flat}");
    let nan = with(Shape::Sphere { center: DVec3::NAN, radius: 1.0 });
    assert!(nan.contains("`odd`"), "{nan}");
    let mesh = Mesh {
        file: "m.obj".into(),
        positions: vec![Vec3::ZERO],
        normals: vec![],
        triangles: vec![[0, 0, 9]],
        coordinates: vec![],
        sheet: None,
    };
    let missing = with(Shape::Mesh { mesh: Arc::new(mesh), to_world: DAffine3::IDENTITY });
    assert_eq!(missing, "`odd`: triangle 0 of `m.obj` names a vertex that the mesh does not have");
}

/// A twist of some degrees is followed by refitting; one that winds the knot up wears the tree, which is built again.
#[test]
fn trees_are_refitted_until_they_are_worn() {
    let keys = "[{ time = 0, value = 0 }, { time = 1, value = 4000 }]";
    let wound = ("objects.knot.motion.twist.angle".to_owned(), keys.to_owned());
    let scene = Scene::load("bending", &[wound, ("objects.knot.motion.period".to_owned(), "2".to_owned())]).unwrap();
    let mut trees = Trees::default();
    let mut at = |time: f64| {
        let start = std::time::Instant::now();
        let built = SceneArrays::build_with(&scene.at(time), &mut trees).unwrap();
        println!(
            "{time} s: {:.2} ms, {} refitted, {} rebuilt",
            start.elapsed().as_secs_f64() * 1e3,
            trees.refitted,
            trees.rebuilt
        );
        (built.nodes.len(), trees.refitted, trees.rebuilt)
    };
    let (nodes, ..) = at(0.0);
    assert_eq!(at(0.002), (nodes, 1, 0), "eight degrees a metre");
    assert_eq!(at(1.0), (nodes, 1, 1), "eleven turns a metre");
    assert_eq!(at(1.0), (nodes, 2, 1), "what was built there fits");
}
