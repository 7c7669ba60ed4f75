//! What comes out of a frame: layers of the picture, any image or buffer of the plan, the light deposited.

use super::{RenderError, Renderer};
use crate::{
    gpu::{ImageId, Phase, Plan, Resource},
    image::Layers,
    names::NoSuch,
    passes::account::Account,
};

/// Any image or buffer of a plan, read back.
pub enum Dump {
    /// An image: one per array layer, channels interleaved.
    Image {
        /// Width and height.
        extent: [u32; 2],
        /// Channels a texel.
        channels: u32,
        /// Texels of each array layer.
        layers: Vec<Vec<f32>>,
    },
    /// A buffer: 32-bit words.
    Buffer(Vec<u32>),
}

/// The light of a frame, W, mean of the bands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Through the silhouettes of the specular objects.
    pub emitted_w: f64,
    /// Of the photons that the method takes.
    pub valid_w: f64,
    /// Sum over the finished map's texels, in float64.
    pub deposited_w: f64,
    /// Deposited over valid, or over what arrived by the method's own count; `None` where nothing is.
    pub ratio: Option<f64>,
    /// The method's own count, where it traces more than the photon buffer holds.
    pub counted: Option<Counted>,
}

/// What a method counted itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted {
    /// In the map, W, mean of the bands.
    pub arrived_w: f64,
    /// Of it, as points, W.
    pub points_w: f64,
    /// Light samples traced.
    pub samples: u64,
    /// Cells traced finer.
    pub refined: u64,
    /// Cells that were to be traced finer, but were more than a level takes.
    pub left: u64,
}

/// What a method without photons left out of its light, in the last frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unresolved {
    /// Pieces of light in all: of water, triangles of rays.
    pub pieces: u64,
    /// Of them those without any way on: the light meets them from behind.
    pub dark: u64,
    /// Those left out though at one or two of their corners light goes on: it grazes them.
    pub grazed: u64,
    /// Pixels one of whose searches the device ended before it was over: their light is lost.
    pub cut_pixels: u64,
}

impl Renderer {
    /// Counts what the method left out of its light; `None` of one that leaves nothing out, or says so by its photons.
    pub fn unresolved(&mut self) -> Result<Option<Unresolved>, RenderError> {
        let Some(left) = self.planned.left_out else { return Ok(None) };
        self.program.run(Phase::Account, &[])?;
        let rows: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(&self.program.read_buffer(left.buffer)?);
        let [dark, grazed] = [0, 1].map(|word: usize| rows.iter().map(|row| u64::from(row[word])).sum());
        // Alpha counts searches that were ended: of what is seen straight on, and through and in specular objects.
        let layers = self.planned.layers;
        let images = [layers.irradiance_caustic, layers.caustic].map(|image| image.map(|i| self.program.read_image(i)));
        let [straight, all] = images.map(Option::transpose);
        let (straight, all) = (straight?.unwrap_or_default(), all?.unwrap_or_default());
        let pixels = straight.chunks_exact(4).zip(all.chunks_exact(4));
        let cut_pixels = pixels.filter(|(a, b)| a[3] > 0.0 || b[3] > 0.0).count() as u64;
        Ok(Some(Unresolved { pieces: left.pieces, dark, grazed, cut_pixels }))
    }

    /// The picture's layers: `radiance`, `direct`, `caustic`, `irradiance.direct`, `irradiance.caustic`, `mask`, and
    /// `sky` where the scene has one.
    pub fn layers(&self) -> Result<Layers, RenderError> {
        let layers = self.planned.layers;
        let [width, height] = self.plan_extent(layers.radiance);
        let pixels = width as usize * height as usize;
        let mut picture = Layers::new(width as usize, height as usize);
        let rgb = |texels: &[f32]| texels.chunks_exact(4).flat_map(|t| [t[0], t[1], t[2]]).collect::<Vec<_>>();
        let read = |image: Option<ImageId>| match image {
            Some(image) => Ok::<_, RenderError>(self.program.read_image(image)?),
            None => Ok(vec![0.0; 4 * pixels]),
        };
        let direct = read(Some(layers.irradiance_direct))?;
        let mask = direct.chunks_exact(4).map(|t| t[3]).collect::<Vec<_>>();
        let all = [
            ("radiance", 3, rgb(&read(Some(layers.radiance))?)),
            ("direct", 3, rgb(&read(Some(layers.direct))?)),
            ("caustic", 3, rgb(&read(layers.caustic)?)),
            ("irradiance.direct", 3, rgb(&direct)),
            ("irradiance.caustic", 3, rgb(&read(layers.irradiance_caustic)?)),
            ("mask", 1, mask),
        ];
        for (name, channels, data) in all {
            picture.push(name, channels, data).expect("the layers above are of the picture's size");
        }
        if self.job.scene.sky.is_some() {
            let sky = rgb(&read(layers.sky)?);
            picture.push("sky", 3, sky).expect("it is of the picture's size");
        }
        Ok(picture)
    }

    /// Any image or buffer by the name that the plan prints.
    pub fn dump(&self, name: &str) -> Result<Dump, RenderError> {
        match resource(self.plan(), name)? {
            Resource::Buffer(buffer) => {
                let bytes = self.program.read_buffer(buffer)?;
                Ok(Dump::Buffer(bytemuck::pod_collect_to_vec(&bytes)))
            }
            Resource::Image(image) => {
                let decl = self.plan().image_decl(image);
                let texels = self.program.read_image(image)?;
                let each = texels.len() / decl.layers.max(1) as usize;
                Ok(Dump::Image {
                    extent: decl.extent,
                    channels: decl.format.channels(),
                    layers: texels.chunks_exact(each.max(1)).map(<[f32]>::to_vec).collect(),
                })
            }
        }
    }

    /// The light of the last frame beside the account of its photons.
    pub fn energy(&self, account: &Account) -> Result<Energy, RenderError> {
        let mut deposited_w = 0.0;
        for &image in &self.planned.deposits {
            let texels = self.program.read_image(image)?;
            let bands = texels.chunks_exact(4).flat_map(|t| &t[..3]).map(|&v| f64::from(v));
            deposited_w += bands.sum::<f64>() / 3.0;
        }
        let valid_w = account.valid_w();
        let counted = self.counted()?;
        let came = counted.map_or(valid_w, |c| c.arrived_w);
        let ratio = (came > 0.0).then(|| deposited_w / came);
        Ok(Energy { emitted_w: account.emitted_w(), valid_w, deposited_w, ratio, counted })
    }

    fn counted(&self) -> Result<Option<Counted>, RenderError> {
        let Some(tally) = self.planned.tally else { return Ok(None) };
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&self.program.read_buffer(tally.buffer)?);
        let mean = |bands: &[u32]| bands.iter().map(|&w| f64::from(f32::from_bits(w))).sum::<f64>() / 3.0;
        let [refined, left, finer] = [6, 7, 8].map(|word: usize| u64::from(words[word]));
        let samples = tally.samples + finer;
        Ok(Some(Counted { arrived_w: mean(&words[..3]), points_w: mean(&words[3..6]), samples, refined, left }))
    }

    /// Bytes a photon in the photon buffer; 0 without photons.
    pub fn photon_bytes(&self) -> u64 {
        self.planned.photon_bytes
    }

    fn plan_extent(&self, image: ImageId) -> [u32; 2] {
        self.plan().image_extent(image)
    }
}

/// The image or buffer of that name in a plan.
///
/// # Errors
/// Names the ones near it, or all.
pub fn resource(plan: &Plan, name: &str) -> Result<Resource, RenderError> {
    let known = || plan.images.iter().map(|i| &i.name).chain(plan.buffers.iter().map(|b| &b.name));
    let unknown = || NoSuch::new("image or buffer", name, known().map(String::as_str));
    Ok(plan.find(name).ok_or_else(unknown)?)
}
