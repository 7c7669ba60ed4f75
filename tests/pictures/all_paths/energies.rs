//! How much arrives by each class, against closed forms and the truth.

use nephroid::{
    optics::fresnel,
    scene::{PathClass, Scene},
    truth::{light::Photons, trace::Space},
};

use super::{BALL, arrives, bucket, close, count, gpu, room, scene};

/// Sums of float32 products, as in `energy`.
const ROUNDING: f64 = 1e-5;
/// Shares of the emitted flux at light.side 256: measured 8e-5, the lattice of photons at the silhouette, where Fresnel's
/// share is steepest; allowed five times that.
const SHARE: f64 = 5e-4;
/// Shares against the truth's 2^17 photons. Measured up to 4.4e-4, by the two lattices at the silhouettes of cube and bunny;
/// allowed twice that.
const TRUTH: f64 = 9e-4;

/// Fluxes over the emitted that leave a ball of glass by its first events: reflected, then after 2, 3, … events. A lamp at
/// three radii lights it evenly in cos α over the cone of sin α < 1/3, with sin θ = 3 sin α; inside, all bounces are alike.
fn leaves(events: usize) -> Vec<f64> {
    const STEPS: u32 = 1_000_000;
    let lowest = (1.0f64 - 1.0 / 9.0).sqrt();
    let mut sums = vec![0.0; events];
    for k in 0..STEPS {
        let cosine = lowest + (1.0 - lowest) * (f64::from(k) + 0.5) / f64::from(STEPS);
        let f = fresnel((1.0 - 9.0 * (1.0 - cosine * cosine)).sqrt(), 1.0, 1.5);
        sums[0] += f / f64::from(STEPS);
        for (inside, sum) in sums[1..].iter_mut().enumerate() {
            *sum += (1.0 - f).powi(2) * f.powi(inside as i32) / f64::from(STEPS);
        }
    }
    sums
}

/// In a room all that leaves the ball arrives: after N events as much as the first N ways out take. What is too faint is
/// booked, and the rest is inside.
#[test]
fn a_ball_of_glass_by_fresnels_integrals() {
    let (gpu, scene, leaves) = (gpu(), room(&[]), leaves(12));
    for most in [1, 2, 3, 12] {
        let account = count(&gpu, &scene, &format!("all:{most}"), "256", "16");
        let exact: f64 = leaves[..most].iter().sum();
        let (ours, faint) = (arrives(&account), bucket(&account, "faint"));
        let share = (ours + faint) / account.emitted_w();
        println!("all:{most}: {share:.6} for {exact:.6}, {:+.1e}", share - exact);
        assert!((share - exact).abs() <= SHARE, "all:{most}: {share} for {exact}");
        let inside = bucket(&account, "bounce_limit");
        close("all of it", ours + faint + inside + bucket(&account, "missed"), account.emitted_w(), ROUNDING);
        assert_eq!(account.no_layer_w(), 0.0, "16 layers hold {most} photons");
    }
}

/// Chains of two events: reflected, or in and out. (In and reflected is inside still.)
#[test]
fn short_classes_are_parts_of_it() {
    let (gpu, scene) = (gpu(), room(&[]));
    let of = |class: &str| arrives(&count(&gpu, &scene, class, "128", "8"));
    let (reflected, through) = (of("reflect-1"), of("transmit-2"));
    close("all:1", of("all:1"), reflected, ROUNDING);
    close("all:2", of("all:2"), reflected + through, ROUNDING);
}

/// Landed, absorbed and missed, W and mean of the bands, by the truth's own tree.
fn truth(scene: &Scene, class: PathClass) -> [f64; 4] {
    let space = Space::new(scene);
    let balance = Photons::new(&space, class, 1, 1 << 17).chunk(0, |_| {});
    [balance.emitted, balance.landed, balance.absorbed, balance.missed].map(|flux| flux.element_sum() / 3.0)
}

/// A cube and a cut diamond, where most light is totally reflected within; coloured glass, whose absorption follows the way
/// inside; glass in glass; a bunny, out of which light goes in again.
#[test]
fn as_the_truth_has_it() {
    let gpu = gpu();
    let cube = "box = { center = [0.0, 0.0, 0.0], half = [0.8, 0.8, 0.8], rotate = [20.0, 30.0, 40.0] }";
    let coloured = [("absorption = 0.0", "absorption = [0.1, 0.4, 2.0]")];
    let within = "[materials.white.diffuse]";
    let inner = "[objects.inner]\nmaterial = \"dense\"\nsphere = { center = [0.2, 0.1, 0.0], radius = 0.5 }\n\
                 [materials.dense.dielectric]\nior = 1.9\nabsorption = [0.0, 0.3, 0.1]\n[materials.white.diffuse]";
    let dispersive = [("ior = 1.5", "ior = [1.5, 1.6, 1.7]"), (BALL, cube)];
    for (name, scene, events) in [
        ("cube", room(&[(BALL, cube)]), 8),
        ("cube of diamond", room(&[(BALL, cube), ("ior = 1.5", "ior = 2.4175")]), 24),
        ("coloured", room(&coloured), 6),
        ("nested", room(&[(within, inner)]), 10),
        ("dispersive", room(&dispersive), 8),
        ("bunny", scene("bunny", &[]), 8),
        ("ring", scene("ring", &[]), 8),
    ] {
        let class = PathClass::All(events);
        let ours = count(&gpu, &scene, &class.to_string(), "256", "64");
        let [emitted, landed, absorbed, missed] = truth(&scene, class);
        let share = |w: f64| w / ours.emitted_w();
        println!(
            "{name}: faint {:.1e}, too long {:.1e}",
            share(bucket(&ours, "faint")),
            share(bucket(&ours, "bounce_limit"))
        );
        for (what, of, exact) in [
            ("emitted", ours.emitted_w(), emitted),
            ("arrives", arrives(&ours), landed),
            ("absorbed", bucket(&ours, "absorbed"), absorbed),
            ("missed", bucket(&ours, "missed"), missed),
        ] {
            println!("  {what}: {:.5} for {:.5}, {:+.1e}", share(of), share(exact), share(of - exact));
            assert!(share(of - exact).abs() <= TRUTH, "{name}: {what} is {of} W for {exact} W");
        }
        let sum: f64 = ours.flux_w[1..].iter().sum();
        close(&format!("{name}: all of it"), sum, ours.emitted_w(), ROUNDING);
        assert_eq!(ours.other_paths_w, 0.0, "{name}: a class of all paths has no others");
    }
}

/// Two walls of mirror 1 m apart and 10 m high, and a sun that comes down 0.5 m on each way across: what comes in at the
/// top meets them 20 times, what meets the first from without once.
const MIRRORS: &str = "[objects.floor]\nmaterial = \"white\"\n\
    quad = { center = [0.0, -0.1, 0.0], u = [60.0, 0.0, 0.0], v = [0.0, 0.0, -60.0] }\n\
    [objects.west]\nmaterial = \"silver\"\nvisible_to_camera = true\n\
    quad = { center = [-0.5, 5.0, 0.0], u = [0.0, 5.0, 0.0], v = [0.0, 0.0, 4.0] }\n\
    [objects.east]\nmaterial = \"silver\"\n\
    quad = { center = [0.5, 5.0, 0.0], u = [0.0, 5.0, 0.0], v = [0.0, 0.0, -4.0] }\n";

fn mirrors(reflectance: f64) -> Scene {
    let text = include_str!("room.toml");
    let (head, _) = text.split_once("[objects.ball]").expect("a ball");
    let tail = "[materials.white.diffuse]\nalbedo = 0.5\n[lights.sun.directional]\ndirection = [1.0, -0.5, 0.0]\n\
                irradiance = 1.0\n";
    let silver = format!("[materials.silver.mirror]\nreflectance = {reflectance:?}\n");
    super::written(&format!("{head}{MIRRORS}{silver}{tail}"), &[])
}

/// The widths of the two beams are cut by the photons' lattice, 0.04 m of 5 and of 0.5.
const BEAMS: f64 = 0.02;

#[test]
fn a_mirror_that_faces_a_mirror() {
    let gpu = gpu();
    let cosine = 1.25f64.sqrt().recip();
    let (between, without) = (8.0 * 0.5 * cosine, 80.0 * cosine);
    let scene = mirrors(0.9);
    let long = count(&gpu, &scene, "all:32", "512", "8");
    close("emitted", long.emitted_w(), between + without, BEAMS);
    assert_eq!(bucket(&long, "bounce_limit"), 0.0);
    let short = count(&gpu, &scene, "all:19", "512", "8");
    close("after 20", arrives(&long) - arrives(&short), between * 0.9f64.powi(20), BEAMS);
    close("after 19", bucket(&short, "bounce_limit"), between * 0.9f64.powi(19), BEAMS);
    let half = count(&gpu, &mirrors(0.5), "all:32", "512", "8");
    close("too faint after 14", bucket(&half, "faint"), between * 0.5f64.powi(14), BEAMS);
}
