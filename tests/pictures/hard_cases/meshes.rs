//! Meshes that are not as they should be, and one of a million triangles.

use super::*;
use glam::{DAffine3, Vec3};
use nephroid::{
    renderer::plan,
    scene::{Mesh, Shape},
};
use std::{f64::consts::PI, sync::Arc, time::Instant};

const CORNERS: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
/// Counter-clockwise from outside.
const FACES: [[u32; 4]; 6] = [[4, 3, 2, 1], [5, 6, 7, 8], [1, 2, 6, 5], [3, 4, 8, 7], [2, 3, 7, 6], [1, 5, 8, 4]];
/// Of the cube's faces: the four sides keep the faces' own normals, since each has its own vertices.
const BESIDE: &str = "[objects.ball.mesh]\nfile = \"m.obj\"\nfit = 1.0\ncenter = [0, 0, 0]\nrotate = [0, 20, 0]";

/// A cube with faces taken, repeated or turned over; each face has normals of its own.
fn cube(faces: &[[u32; 4]]) -> String {
    let mut text = CORNERS.to_owned();
    for normal in ["0 0 -1", "0 0 1", "0 -1 0", "0 1 0", "1 0 0", "-1 0 0"] {
        text += &format!("vn {normal}\n");
    }
    for face in faces {
        let mut sorted = *face;
        sorted.sort_unstable();
        let of = FACES
            .iter()
            .position(|f| {
                let mut g = *f;
                g.sort_unstable();
                g == sorted
            })
            .expect("a face of the cube");
        text += "f";
        face.iter().for_each(|corner| text += &format!(" {corner}//{}", of + 1));
        text += "\n";
    }
    text
}

fn of(text: &str) -> Scene {
    shaped(BESIDE, "", &[("m.obj", text)])
}

#[test]
fn a_mesh_of_a_cube_passes_light_as_a_plate() {
    let account = counted(of(&cube(&FACES)));
    close("emitted", account.emitted_w(), 1.0, SILHOUETTE);
    close("through", account.valid_w(), 0.96 * 0.96, SILHOUETTE);
}

#[test]
fn a_mesh_with_flipped_winding_is_told_and_counts_every_photon() {
    let flipped = FACES.map(|[a, b, c, d]| [d, c, b, a]);
    let scene = of(&cube(&flipped));
    assert!(scene.warnings.iter().any(|w| w.contains("m.obj")), "{:?}", scene.warnings);
    assert!(of(&cube(&FACES)).warnings.is_empty());
    let account = counted(scene);
    println!("{account:?}");
    close("emitted", account.emitted_w(), 1.0, SILHOUETTE);
}

#[test]
fn faces_that_are_there_twice_count_once() {
    let twice: Vec<_> = FACES.iter().chain(&FACES).copied().collect();
    let (once, twice) = (counted(of(&cube(&FACES))), counted(of(&cube(&twice))));
    close("through", twice.valid_w(), once.valid_w(), ROUNDING);
    close("reflected", twice.other_paths_w, once.other_paths_w, ROUNDING);
}

#[test]
fn a_mesh_without_a_face_is_told_and_counts_every_photon() {
    for missing in 0..6 {
        let faces: Vec<_> = FACES.iter().enumerate().filter(|(k, _)| *k != missing).map(|(_, f)| *f).collect();
        let scene = of(&cube(&faces));
        assert!(scene.warnings.iter().any(|w| w.contains("m.obj")), "{missing}: {:?}", scene.warnings);
        let account = counted(scene);
        close("emitted", account.emitted_w(), 1.0, SILHOUETTE);
    }
}

#[test]
fn a_vertex_that_is_no_number_is_refused_by_its_line() {
    for word in ["nan", "inf", "-inf", "1e39"] {
        let folder = tempfile::tempdir().unwrap();
        let text = cube(&FACES).replacen("v 1 1 1", &format!("v 1 {word} 1"), 1);
        std::fs::write(folder.path().join("m.obj"), text).unwrap();
        let sphere = "[objects.ball.sphere]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\n";
        let scene = rewritten("glass-sphere", &[(sphere, BESIDE)], "");
        std::fs::write(folder.path().join("s.toml"), scene).unwrap();
        let error = Scene::load(folder.path().join("s.toml").to_str().unwrap(), &[]).unwrap_err().to_string();
        assert!(error.contains("m.obj:7") && error.contains(word) && error.contains("finite"), "{error}");
    }
}

/// A roof whose normals lie almost along it, so that most of what they say cannot be.
#[test]
fn normals_that_face_away_bend_nothing_through_the_surface() {
    let text = CORNERS.to_owned()
        + "vn 1 0.01 1\nvn -1 0.01 -1\nvn 1 -0.01 -1\n\
           f 4//1 3//2 2//3 1//1\nf 5//1 6//2 7//3 8//1\nf 1//1 2//2 6//3 5//1\n\
           f 3//1 4//2 8//3 7//1\nf 2//1 3//2 7//3 6//1\nf 1//1 5//2 8//3 4//1\n";
    let account = counted(of(&text));
    close("emitted", account.emitted_w(), 1.0, SILHOUETTE);
    // The geometric normal answers for one in ten; what the others bend so far is reflected totally, or passes.
    assert!(account.bent > account.counts[0] / 20, "{account:?}");
}

/// Spent on a mesh of a million triangles: reading its arrays into a plan, trees included. Measured 3 s on one busy core in
/// the test profile.
const SECONDS: u64 = 60;
/// Bytes on the device for a triangle: corners and normals 72, two nodes 64, and what is not the mesh's.
const BYTES: u64 = 160;

#[test]
fn a_million_triangles_are_a_sphere() {
    let (across, down) = (1000u32, 501u32);
    let at = |x: u32, y: u32| {
        let (a, b) = (f64::from(x) / f64::from(across) * 2.0 * PI, f64::from(y) / f64::from(down) * PI);
        Vec3::new((b.sin() * a.cos()) as f32, b.cos() as f32, (b.sin() * a.sin()) as f32)
    };
    let positions: Vec<Vec3> = (0..=down).flat_map(|y| (0..=across).map(move |x| at(x, y))).collect();
    let corner = |x: u32, y: u32| y * (across + 1) + x;
    let cells = (0..down).flat_map(|y| (0..across).map(move |x| (x, y)));
    let triangles: Vec<[u32; 3]> = cells
        .flat_map(|(x, y)| {
            let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    assert!(triangles.len() > 1_000_000);
    let mut scene = scene("glass-sphere", &[]);
    let mesh = Arc::new(Mesh {
        file: "sphere".to_owned(),
        normals: positions.clone(),
        positions,
        triangles,
        coordinates: vec![],
        sheet: None,
    });
    let ball = scene.objects.iter_mut().find(|o| o.name == "ball").unwrap();
    ball.shape = Shape::Mesh { mesh: mesh.clone(), to_world: DAffine3::IDENTITY };
    let start = Instant::now();
    let planned = plan(&job_of(scene.clone(), &SMALL, "region", SIZE)).unwrap();
    println!("planned in {:.1} s", start.elapsed().as_secs_f64());
    assert!(start.elapsed().as_secs() < SECONDS);
    let without = plan(&job_of(self::scene("glass-sphere", &[]), &SMALL, "region", SIZE)).unwrap();
    let more = planned.plan.bytes() - without.plan.bytes();
    println!("{more} bytes more, {:.0} a triangle", more as f64 / mesh.triangles.len() as f64);
    assert!(more < BYTES * mesh.triangles.len() as u64);
    let (account, sphere) = (counted(scene), counted(self::scene("glass-sphere", &[])));
    close("emitted", account.emitted_w(), PI, SILHOUETTE);
    close("through", account.valid_w(), sphere.valid_w(), SILHOUETTE);
}
