//! The null test: a sphere of index 1 must vanish. Its caustic restores exactly the light that its shadow took.

use crate::common::{
    gpu,
    picture::{Picture, Pixels, job_of, picture, pixels_of_map, rewritten, scene, worst, written},
};
use glam::DVec3;
use nephroid::{
    gpu::Gpu,
    scene::{LightKind, Region, Scene, Shape},
    stats::percentile,
    truth::closed::{direct_parallel, direct_point},
};
use std::f64::consts::TAU;

/// Texels a side of the caustic map, and of one picture whose pixels are its texels.
const MAP: u32 = 256;
const PIXELS: u32 = pixels_of_map(MAP);
/// Map texels on each side of the shadow's edge within which a splat and the look-up mix light and shadow.
const BAND: f64 = 3.0;
/// Mean relative error outside the band: what is left of the photons' lattice, five to six a texel and axis.
const MEAN_ERROR: f64 = 0.005;
/// The error that 99 % of the pixels outside the band stay below.
const PERCENTILE_99: f64 = 0.02;
/// The same where clusters of photons become one splat with their first two moments: what is left of the third, which the lattice of
/// clusters makes; measured 0.0218.
const PERCENTILE_99_MERGED: f64 = 0.025;
/// Share of the band's flux that may be missing in each sector: photons stand for whole texels of the light's view.
const SECTOR_ERROR: f64 = 0.01;
const SECTORS: usize = 8;
/// Share of the region's flux that may be lost or made.
const REGION_ERROR: f64 = 0.001;
/// A caustic this much too bright is wrong, and must be found so.
const TOO_BRIGHT: f64 = 1.02;
/// The picture's own direct light outside the shadow against the closed form: float32 positions and products.
const DIRECT_ROUNDING: f64 = 2e-5;

const SETTINGS: [(&str, &str); 3] = [("light.side", "1024"), ("maps.side", "256"), ("eye.samples", "4")];

/// A null scene: its one light, its ball, where errors are judged.
struct Null<'a> {
    light: LightKind,
    ball: (DVec3, f64),
    region: &'a Region,
}

/// What is judged, each a share.
struct Figures {
    mean: f64,
    percentile: f64,
    /// Of the band's pixels in each sector round the shadow; none where it leaves the region.
    sectors: [Option<f64>; SECTORS],
    region: f64,
}

impl Null<'_> {
    fn of(scene: &Scene) -> Null<'_> {
        let ball = scene.objects.iter().find_map(|o| match o.shape {
            Shape::Sphere { center, radius } => Some((center, radius)),
            _ => None,
        });
        Null { light: scene.lights[0].kind.clone(), ball: ball.expect("a ball"), region: &scene.region }
    }

    /// Irradiance without the ball.
    fn direct(&self, p: DVec3) -> f64 {
        match self.light {
            LightKind::Directional { direction, irradiance } => {
                direct_parallel(direction, self.region.normal(), irradiance[0])
            }
            LightKind::Point { position, intensity } => direct_point(position, intensity[0], p, self.region.normal()),
            _ => unreachable!("others vanish in `lights`"),
        }
    }

    /// Travel of the light that reaches a point.
    fn travel(&self, p: DVec3) -> DVec3 {
        match self.light {
            LightKind::Directional { direction, .. } => direction,
            _ => (p - self.light.position().expect("a place")).normalize(),
        }
    }

    /// Distance of the ray that reaches p from the ball's centre, in radii: below 1 in the shadow.
    fn offset(&self, p: DVec3) -> f64 {
        (p - self.ball.0).cross(self.travel(p)).length() / self.ball.1
    }

    /// Distance of a point of the region from the shadow's edge, m, to first order; negative in the shadow.
    fn beyond_edge(&self, p: DVec3) -> f64 {
        let (u, v) = (self.region.u.normalize(), self.region.v.normalize());
        let h = 1e-5 * self.ball.1;
        let slope = |axis: DVec3| (self.offset(p + h * axis) - self.offset(p - h * axis)) / (2.0 * h);
        (self.offset(p) - 1.0) / slope(u).hypot(slope(v)).max(f64::MIN_POSITIVE)
    }

    /// Sector of a point, round where the ray through the ball's centre meets the region's plane.
    fn sector(&self, p: DVec3) -> usize {
        let (center, n) = (self.ball.0, self.region.normal());
        let d = self.travel(center);
        let foot = center + d * ((self.region.center - center).dot(n) / d.dot(n));
        let angle = (p - foot).dot(self.region.v).atan2((p - foot).dot(self.region.u)).rem_euclid(TAU);
        ((angle / TAU * SECTORS as f64) as usize).min(SECTORS - 1)
    }

    /// Judges `direct + gain · caustic` of a picture of the region.
    fn figures(&self, picture: &Picture, gain: f64) -> Figures {
        let pixels = Pixels { region: self.region, size: [PIXELS; 2] };
        let band = BAND * 2.0 * self.region.u.length() / f64::from(PIXELS);
        let (direct, caustic) = (picture.mean("irradiance.direct"), picture.mean("irradiance.caustic"));
        let (mut errors, mut ring, mut all) = (Vec::new(), [[0.0f64; 2]; SECTORS], [0.0f64; 2]);
        for (k, p) in pixels.centres().enumerate() {
            let (ours, exact) = (direct[k] + gain * caustic[k], self.direct(p));
            let at = self.beyond_edge(p);
            if at.abs() > band {
                errors.push((ours / exact - 1.0).abs());
            } else {
                let sector = &mut ring[self.sector(p)];
                *sector = [sector[0] + ours, sector[1] + exact];
            }
            if at > band {
                assert!(
                    (direct[k] / exact - 1.0).abs() < DIRECT_ROUNDING,
                    "direct light at {p}: {} for {exact}",
                    direct[k]
                );
            }
            all = [all[0] + ours, all[1] + exact];
        }
        Figures {
            mean: errors.iter().sum::<f64>() / errors.len() as f64,
            percentile: percentile(&errors, 99.0),
            sectors: ring.map(|[ours, exact]| (exact > 0.0).then(|| ours / exact - 1.0)),
            region: all[0] / all[1] - 1.0,
        }
    }
}

impl Figures {
    /// What does not hold.
    fn faults(&self, percentile: f64) -> Vec<String> {
        let mut faults = Vec::new();
        let mut hold = |what: String, error: f64, bound: f64| {
            if worst([error]) > bound {
                faults.push(format!("{what}: {error} of {bound}"));
            }
        };
        hold("mean outside the band".into(), self.mean, MEAN_ERROR);
        hold("99th percentile outside the band".into(), self.percentile, percentile);
        for (k, sector) in self.sectors.iter().enumerate() {
            hold(format!("band in sector {k}"), sector.unwrap_or(0.0), SECTOR_ERROR);
        }
        hold("region".into(), self.region, REGION_ERROR);
        faults
    }
}

/// The ball vanishes, and neither does its shadow without a caustic, nor one that is too bright.
fn vanishes(gpu: &Gpu, name: &str, scene: Scene, gather: &str, sectors: usize) {
    let set = [&SETTINGS[..], &[("maps.gather", gather)]].concat();
    let job = job_of(scene, &set, "region", [PIXELS; 2]);
    let picture = picture(gpu, &job);
    let null = Null::of(&job.scene);
    let figures = null.figures(&picture, 1.0);
    let band: Vec<_> = figures.sectors.iter().flatten().map(|s| format!("{s:+.5}")).collect();
    println!(
        "{name}: mean {:.6}, 99th percentile {:.6}, region {:+.7}, band [{}]",
        figures.mean,
        figures.percentile,
        figures.region,
        band.join(", ")
    );
    let percentile = if gather == "combine-exact" { PERCENTILE_99_MERGED } else { PERCENTILE_99 };
    assert_eq!(figures.faults(percentile), Vec::<String>::new(), "{name}");
    assert!(band.len() >= sectors, "{name}: the band shows in {} sectors", band.len());

    let without = null.figures(&picture, 0.0).faults(percentile);
    assert!(without.len() >= 2 + sectors, "{name}, no caustic, found only {without:?}");
    let bright = null.figures(&picture, TOO_BRIGHT).faults(percentile);
    assert!(bright.iter().any(|f| f.starts_with("region")), "{name}, too bright, found only {bright:?}");
}

#[test]
fn under_the_sun_overhead() {
    let gpu = gpu();
    for gather in ["fixed", "fetch", "elliptic", "combine-exact"] {
        vanishes(&gpu, &format!("sun overhead, {gather}"), scene("null", &[]), gather, SECTORS);
    }
}

/// The shadow's far end leaves the region, and with it some sectors of its edge.
#[test]
fn under_the_sun_at_forty_degrees() {
    let (sine, cosine) = 40f64.to_radians().sin_cos();
    let direction = format!("[{sine}, {}, 0.0]", -cosine);
    vanishes(&gpu(), "sun at 40°", scene("null", &[("lights.sun.direction", &direction)]), "fixed", 5);
}

#[test]
fn under_a_point_light() {
    let sun = "[lights.sun.directional]\ndirection = [0.0, -1.0, 0.0]\nirradiance = 1.0";
    let lamp = "[lights.lamp.point]\nposition = [0.6, 6.0, 0.4]\nintensity = 50.0";
    let text = rewritten("null", &[(sun, lamp)], "");
    vanishes(&gpu(), "point light", written(&text, &[]), "fixed", SECTORS);
}
