//! What each variant should show, in float64, from the equations alone.

use glam::{DVec2, DVec3};
use nephroid::scene::{Relief, Scene, Shape, WaveAt};

use crate::common::picture::Pixels;

/// The paper's wave over its rectangle, and the sun map above it.
pub struct Model {
    wave: WaveAt,
    center: DVec3,
    /// Unit vectors along the rectangle and out of the water.
    axes: [DVec3; 3],
    half: DVec2,
    ior: f64,
    /// 1/m
    attenuation: f64,
    /// rad, at half brightness.
    sun: f64,
    /// How much of that, on both sides of it, is the sun's edge.
    pub edge: f64,
    /// Where the shortcut's sun map lies, m.
    pub distance: f64,
}

impl Model {
    /// Of a scene with one wave, the sun as wide as this (degrees).
    pub fn of(scene: &Scene, sun_width: f64) -> Self {
        let water = scene.objects.iter().find(|object| object.name == "water").expect("water");
        let Shape::Mesh { mesh, to_world } = &water.shape else { panic!("a wave is a mesh") };
        let Relief::Wave(wave) = mesh.sheet.as_ref().expect("a sheet").relief else { panic!("it is a wave") };
        let corner = mesh.positions.last().expect("vertices").as_dvec3();
        let [x, y, z] = [to_world.matrix3.x_axis, to_world.matrix3.y_axis, to_world.matrix3.z_axis];
        let half = DVec2::new(x.length() * corner.x, y.length() * corner.y);
        let axes = [x, y, z].map(DVec3::normalize);
        let (ior, attenuation) = (1.33, 0.24); // as the file says
        Self {
            wave,
            center: to_world.translation,
            axes,
            half,
            ior,
            attenuation,
            sun: 0.5 * sun_width.to_radians(),
            edge: 1.0,
            distance: 0.8,
        }
    }

    fn sun_map(&self, angle: f64) -> f64 {
        let t = (0.5 + 0.5 * (1.0 - angle / self.sun) / self.edge).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }

    /// The sun's share below water of such a slope: by Snell's law, the angle beyond that of incidence.
    fn below(&self, slope: DVec2) -> f64 {
        let incidence = slope.length().atan();
        let sine = self.ior * incidence.sin();
        if sine >= 1.0 { 0.0 } else { self.sun_map(sine.asin() - incidence) }
    }

    fn dimmed(&self, share: f64, depth: f64) -> f64 {
        if depth < 0.0 { 0.0 } else { share * (-self.attenuation * depth).exp() }
    }

    fn place(&self, p: DVec3) -> (DVec2, f64) {
        let [u, v, n] = self.axes.map(|axis| axis.dot(p - self.center));
        (DVec2::new(u, v), n)
    }

    /// At a place of the rectangle, from 0 to 1.
    fn shared(&self, share: DVec2) -> DVec2 {
        (2.0 * share - 1.0) * self.half
    }

    /// W/m² at a point, where the sun has 1.
    pub fn pixel(&self, p: DVec3) -> f64 {
        let (at, above) = self.place(p);
        self.dimmed(self.below(self.wave.gradient(at)), self.wave.height(at) - above)
    }

    /// The same without refraction.
    pub fn shortcut(&self, p: DVec3) -> f64 {
        let (at, above) = self.place(p);
        let depth = self.wave.height(at) - above;
        self.dimmed(self.sun_map((self.wave.gradient(at).length() * depth).atan2(self.distance)), depth)
    }

    /// As printed, the screen's depth being `w`.
    pub fn listing(&self, p: DVec3, w: f64) -> f64 {
        let (at, _) = self.place(p);
        let intercept = 0.5 + 0.5 * at / self.half + self.wave.gradient(at) * (-0.8 / w);
        let read = 0.8 * intercept;
        self.sun_map(((read - read.floor()) - 0.5).length().atan2(0.8 * 0.8))
    }

    /// Colours and heights at the vertices of so many cells, linear on triangles.
    pub fn vertex(&self, p: DVec3, cells: i32) -> f64 {
        let (at, above) = self.place(p);
        let height = |k: [i32; 2]| self.wave.height(self.shared(DVec2::from(k.map(f64::from)) / f64::from(cells)));
        let colour = |k: [i32; 2]| {
            let along = |axis: usize| {
                let [mut low, mut high] = [k; 2];
                low[axis] = (k[axis] - 1).max(0);
                high[axis] = (k[axis] + 1).min(cells);
                let metres = f64::from(high[axis] - low[axis]) / f64::from(cells) * 2.0 * self.half[axis];
                (height(high) - height(low)) / metres
            };
            self.below(DVec2::new(along(0), along(1)))
        };
        let place = (0.5 + 0.5 * at / self.half) * f64::from(cells);
        let first = place.floor().min(DVec2::splat(f64::from(cells - 1)));
        let (k, f) = ([first.x as i32, first.y as i32], place - first);
        let beside = if f.x >= f.y { [k[0] + 1, k[1]] } else { [k[0], k[1] + 1] };
        let corners =
            [(k, 1.0 - f.max_element()), (beside, (f.x - f.y).abs()), ([k[0] + 1, k[1] + 1], f.min_element())];
        let mean = |of: &dyn Fn([i32; 2]) -> f64| corners.iter().map(|&(k, weight)| weight * of(k)).sum::<f64>();
        self.dimmed(mean(&colour), mean(&height) - above)
    }

    /// The target of so many texels a side where `lod` is what a pixel covers: between levels, each linear between texels.
    pub fn texture(&self, p: DVec3, side: i32, lod: f64) -> f64 {
        let (at, above) = self.place(p);
        let share = 0.5 + 0.5 * at / self.half;
        let level = lod.floor();
        let fine = self.in_level(share, side, level as i32);
        let coarse = if lod > level { self.in_level(share, side, level as i32 + 1) } else { fine };
        let [colour, height] = [0, 1].map(|k| fine[k] + (lod - level) * (coarse[k] - fine[k]));
        self.dimmed(colour, height - above)
    }

    fn in_level(&self, share: DVec2, side: i32, level: i32) -> [f64; 2] {
        let count = side >> level;
        let place = share * f64::from(count) - 0.5;
        let (low, f) = (place.floor(), place - place.floor());
        let texel = |x: i32, y: i32| {
            let [x, y] = [low.x as i32 + x, low.y as i32 + y].map(|k| k.clamp(0, count - 1));
            self.texel(side, level, x, y)
        };
        let corners = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| {
            let weight = |k: i32, f: f64| if k == 1 { f } else { 1.0 - f };
            (texel(x, y), weight(x, f.x) * weight(y, f.y))
        });
        [0, 1].map(|k| corners.iter().map(|(texel, weight)| texel[k] * weight).sum())
    }

    /// Colour and height: of a coarse level the mean of all texels of the first that it covers.
    fn texel(&self, side: i32, level: i32, x: i32, y: i32) -> [f64; 2] {
        let each = 1 << level;
        let mut sum = [0.0; 2];
        for k in 0..each * each {
            let texel = DVec2::new(f64::from(x * each + k % each), f64::from(y * each + k / each));
            let at = self.shared((texel + 0.5) / f64::from(side));
            sum[0] += self.below(self.wave.gradient(at));
            sum[1] += self.wave.height(at);
        }
        sum.map(|sum| sum / f64::from(each * each))
    }

    /// Of each pixel.
    pub fn of_pixels(pixels: &Pixels<'_>, value: impl Fn(DVec3) -> f64) -> Vec<f64> {
        pixels.centres().map(value).collect()
    }
}
