//! The water of a scene on the device (`glsl/shared/water.glsl`): a height over a rectangle that bounds a dielectric.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::{
    gpu::{BufferId, PassBuilder, Plan},
    scene::{Canonical, MaterialKind, Mesh, Relief, Scene, Shape, Sheet},
};

/// `Water` of the shaders.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct WaterData {
    pub center: [f32; 3],
    pub u: [f32; 3],
    pub v: [f32; 3],
    pub n: [f32; 3],
    pub half_size: [f32; 2],
    pub ior: [f32; 3],
}

/// `WaterSine` of the shaders.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct WaterSine {
    pub amplitude: f32,
    pub number: f32,
    pub phase: f32,
}

/// `WaterWave` of the shaders.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct WaterWave {
    pub middle: [f32; 2],
    pub unit: f32,
    pub phase: f32,
    pub wave_size: f32,
    pub factor: f32,
    pub vertex_size: f32,
    pub octaves: u32,
}

/// `WaterVertex` of the shaders.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct WaterVertex {
    pub height: f32,
    pub normal: [f32; 3],
}

/// `Ripple` of the shaders.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct RippleData {
    pub number: [f32; 2],
    pub amplitude: f32,
    pub phase: f32,
}

/// The rectangle that the water's heights are over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// m
    pub center: DVec3,
    /// Half edge, m.
    pub u: DVec3,
    /// Half edge, m, at right angles to `u`.
    pub v: DVec3,
}

impl Frame {
    /// Unit vector out of the water.
    pub fn normal(&self) -> DVec3 {
        self.u.cross(self.v).normalize_or_zero()
    }
}

/// The water, in a plan.
#[derive(Clone, Debug)]
pub struct Water {
    /// Index into [`Scene::objects`].
    pub object: usize,
    /// Its rectangle.
    pub frame: Frame,
    /// Cells of the triangles that stand for it where rays are traced, along u and v; none of what its equation makes.
    pub cells: Option<[usize; 2]>,
    defines: Vec<(&'static str, String)>,
    data: BufferId,
    shape: Option<BufferId>,
}

/// Every object that can be water: a dielectric height over a rectangle.
pub fn waters(scene: &Scene) -> impl Iterator<Item = usize> {
    let clear = |k: usize| matches!(scene.materials[scene.objects[k].material].kind, MaterialKind::Dielectric { .. });
    (0..scene.objects.len()).filter(move |&k| clear(k) && frame(&scene.objects[k].shape).is_some())
}

/// What a pass is told by the preprocessor, and the buffers that it may read.
pub type Parts = (Vec<(&'static str, String)>, Vec<(&'static str, BufferId)>);

impl Water {
    /// The first water of the scene, each kind as its function says; heights of a picture have none, and are their triangles.
    pub fn of(plan: &mut Plan, scene: &Scene) -> Option<Self> {
        Self::planned(plan, scene, true)
    }

    /// The same as rays meet it: what is a mesh to them is its triangles.
    pub fn as_traced(plan: &mut Plan, scene: &Scene) -> Option<Self> {
        Self::planned(plan, scene, false)
    }

    fn planned(plan: &mut Plan, scene: &Scene, by_function: bool) -> Option<Self> {
        let object = waters(scene).next()?;
        let shape = &scene.objects[object].shape;
        let frame = frame(shape)?;
        let MaterialKind::Dielectric { ior, .. } = scene.materials[scene.objects[object].material].kind else {
            return None;
        };
        let [u, v] = [frame.u, frame.v].map(DVec3::normalize_or_zero);
        let f32s = |v: DVec3| v.as_vec3().to_array();
        let data = WaterData {
            center: f32s(frame.center),
            u: f32s(u),
            v: f32s(v),
            n: f32s(frame.normal()),
            half_size: DVec2::new(frame.u.length(), frame.v.length()).as_vec2().to_array(),
            ior: f32s(ior.into()),
        };
        let data = plan.upload("water", &[data]);
        let (defines, buffer) = match shape {
            Shape::Canonical { kind: Canonical::Sine { wave, phase }, to_world } => {
                let sine = WaterSine {
                    amplitude: to_world.matrix3.z_axis.length() as f32,
                    number: (wave / frame.u.length()) as f32,
                    phase: phase.rem_euclid(TAU) as f32,
                };
                (vec![("WATER_SINE", "1".to_owned())], Some(plan.upload("water/shape", &[sine])))
            }
            Shape::Mesh { mesh, to_world } => {
                let sheet = mesh.sheet.as_ref()?;
                let (defines, buffer) = relief(plan, mesh, sheet, to_world.matrix3.x_axis.length(), by_function);
                (defines, Some(buffer))
            }
            _ => (vec![("WATER_FLAT", "1".to_owned())], None),
        };
        let cells = match shape {
            Shape::Mesh { mesh, .. } => mesh.sheet.as_ref().map(|sheet| sheet.cells),
            _ => None,
        };
        Some(Self { object, frame, cells, defines, data, shape: buffer })
    }

    /// For a pass that includes `shared/water.glsl`.
    pub fn provide<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let (defines, offers) = self.parts();
        offers.into_iter().fold(pass.defines(&defines), |pass, (name, buffer)| pass.offer(name, buffer))
    }

    /// What [`Self::provide`] defines and offers, for a slot's provider.
    pub fn parts(&self) -> Parts {
        let shape = self.shape.map(|shape| ("water_shape", shape));
        (self.defines.clone(), [("water", self.data)].into_iter().chain(shape).collect())
    }
}

/// What a sheet of triangles is made of; one unit of the mesh is `unit` metres now, which moving it may have changed.
fn relief(
    plan: &mut Plan,
    mesh: &Mesh,
    sheet: &Sheet,
    unit: f64,
    by_function: bool,
) -> (Vec<(&'static str, String)>, BufferId) {
    let scale = unit / sheet.unit;
    match &sheet.relief {
        Relief::Wave(at) if by_function => {
            let wave = WaterWave {
                middle: at.middle.as_vec2().to_array(),
                unit: (at.length * scale) as f32,
                phase: (at.wave.speed * at.time).rem_euclid(TAU) as f32,
                wave_size: at.wave.wave_size as f32,
                factor: at.wave.factor as f32,
                vertex_size: at.wave.vertex_size as f32,
                octaves: at.wave.octaves,
            };
            (vec![("WATER_WAVE", "1".to_owned())], plan.upload("water/shape", &[wave]))
        }
        Relief::Sea(waves) if by_function => {
            let one = |wave: &crate::scene::Ripple| RippleData {
                number: (wave.number / scale).as_vec2().to_array(),
                amplitude: (wave.amplitude * scale) as f32,
                phase: wave.phase as f32,
            };
            let waves: Vec<_> = waves.iter().map(one).collect();
            (vec![("WATER_SEA", "1".to_owned())], plan.upload("water/shape", &waves))
        }
        _ => {
            let [across, along] = sheet.cells;
            let vertices = mesh.positions.iter().zip(&mesh.normals);
            let one = |(p, n): (&glam::Vec3, &glam::Vec3)| WaterVertex {
                height: (f64::from(p.z) * unit) as f32,
                normal: n.to_array(),
            };
            let vertices: Vec<_> = vertices.map(one).collect();
            let defines = vec![
                ("WATER_HEIGHTS", "1".to_owned()),
                ("WATER_ACROSS", format!("{across}u")),
                ("WATER_ALONG", format!("{along}u")),
            ];
            (defines, plan.upload("water/shape", &vertices))
        }
    }
}

/// Unit vector out of the water; nothing of other shapes.
pub fn normal(shape: &Shape) -> DVec3 {
    frame(shape).map_or(DVec3::ZERO, |frame| frame.normal())
}

/// The rectangle below a shape that is a height over one.
fn frame(shape: &Shape) -> Option<Frame> {
    match shape {
        Shape::Quad { center, u, v } => Some(Frame { center: *center, u: *u, v: *v }),
        Shape::Canonical { kind: Canonical::Sine { .. }, to_world } => {
            let [u, v] = [to_world.matrix3.x_axis, to_world.matrix3.y_axis];
            Some(Frame { center: to_world.translation, u, v })
        }
        Shape::Mesh { mesh, to_world } => {
            mesh.sheet.as_ref()?;
            let corner = mesh.positions.last()?.as_dvec3();
            let [u, v] = [to_world.matrix3.x_axis * corner.x, to_world.matrix3.y_axis * corner.y];
            Some(Frame { center: to_world.translation, u, v })
        }
        _ => None,
    }
}
