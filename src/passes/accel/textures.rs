//! Textures as the shaders read them: the pixels of all pictures in one array, each picture once.
use std::sync::Arc;

use super::{AccelError, LARGEST_INDEX, Texture, check_count};
use crate::scene::{MaterialKind, Picture, Scene};

/// Of a scene; empty where it has none.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    /// One for each material that has one.
    pub all: Vec<Texture>,
    /// Linear red, green and blue, as bytes of float32.
    pub texels: Arc<[u8]>,
    /// Of each material, 1 + index in `all`; 0 for none.
    pub of_material: Vec<u32>,
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
            let before = known.iter().find(|(other, _)| other.file == picture.file).map(|(_, first)| *first);
            let first = match before {
                Some(first) => first,
                None => {
                    let first = texels.len();
                    check_count("pixels of textures", first + picture.pixels.len(), LARGEST_INDEX)?;
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
        Ok(textures)
    }
}
