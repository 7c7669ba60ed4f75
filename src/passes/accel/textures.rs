//! Textures, slides and the sky as the shaders read them: the pixels of all pictures of a use in one array.
use std::sync::Arc;

use super::{AccelError, Slide, Texture, check_count};
use crate::scene::{Beam, LightKind, MOST_PIXELS, MaterialKind, Picture, Scene, Sky, Slide as SceneSlide};

/// Of a scene; empty where it has none.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    /// One for each material that has one.
    pub all: Vec<Texture>,
    /// Linear red, green and blue, as bytes of float32.
    pub texels: Arc<[u8]>,
    /// Of each material, 1 + index in `all`; 0 for none.
    pub of_material: Vec<u32>,
    /// Pixels of the pictures that spots project, in the order of the lights; as `texels`.
    pub slides: Arc<[u8]>,
    /// Pixels of a sky that is a picture; as `texels`.
    pub sky: Arc<[u8]>,
}

impl Textures {
    /// In the order of the materials.
    pub fn of(scene: &Scene) -> Result<Self, AccelError> {
        let (mut textures, mut texels) = (Self::default(), Vec::<[f32; 3]>::new());
        let mut known: Vec<(&Arc<Picture>, u32)> = vec![];
        for material in &scene.materials {
            let MaterialKind::Diffuse { texture: Some(texture), .. } = &material.kind else {
                textures.of_material.push(0);
                continue;
            };
            let picture = &texture.picture;
            let before = known.iter().find(|(other, _)| Arc::ptr_eq(other, picture)).map(|(_, first)| *first);
            let first = match before {
                Some(first) => first,
                None => {
                    let first = texels.len();
                    check_count("pixels of textures", first + picture.pixels.len(), MOST_PIXELS)?;
                    texels.extend(&picture.pixels);
                    known.push((picture, first as u32));
                    first as u32
                }
            };
            let size = [picture.width, picture.height].map(|side| side as u32);
            textures.all.push(Texture { first, size, repeat: texture.repeat.map(|times| times as f32) });
            textures.of_material.push(textures.all.len() as u32);
        }
        textures.texels = bytemuck::cast_slice(&texels).into();
        let slides: Vec<[f32; 3]> =
            slides(scene).flat_map(|(.., slide)| slide.picture.pixels.iter().copied()).collect();
        check_count("pixels of projected images", slides.len(), MOST_PIXELS)?;
        textures.slides = bytemuck::cast_slice(&slides).into();
        if let Some(Sky::Image { picture, .. }) = &scene.sky {
            textures.sky = bytemuck::cast_slice(&picture.pixels).into();
        }
        Ok(textures)
    }
}

/// Indices of the lights that project a picture, with it.
fn slides(scene: &Scene) -> impl Iterator<Item = (usize, &Beam, &SceneSlide)> {
    scene.lights.iter().enumerate().filter_map(|(index, light)| match &light.kind {
        LightKind::Spot { beam, slide: Some(slide), .. } => Some((index, beam, slide)),
        _ => None,
    })
}

/// Where the slides are thrown now, and of each light 1 + index of its own; 0 for none.
pub fn thrown(scene: &Scene) -> (Vec<Slide>, Vec<u32>) {
    let (mut all, mut of_light, mut first) = (vec![], vec![0; scene.lights.len()], 0);
    for (light, beam, slide) in slides(scene) {
        let size = [slide.picture.width, slide.picture.height].map(|side| side as u32);
        let [right, up] = slide.axes(beam.axis).map(|across| across.as_vec3().to_array());
        all.push(Slide { first, size, right, up });
        of_light[light] = all.len() as u32;
        first += size[0] * size[1];
    }
    (all, of_light)
}
