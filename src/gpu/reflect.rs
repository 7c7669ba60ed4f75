//! What a shader says of itself: bindings by name, push constants, the offsets of its blocks' members.

use spirq::{
    ReflectConfig,
    ty::{DescriptorType, Type},
    var::Variable,
};

/// How a shader sees a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A storage buffer.
    Buffer,
    /// A storage image.
    StorageImage,
    /// A combined image sampler.
    Sampler,
}

/// One member of a block or structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockMember {
    /// The structure's name in GLSL.
    pub structure: String,
    /// The member's name.
    pub member: String,
    /// Bytes from the structure's start.
    pub offset: usize,
}

/// The reflected interface of one stage.
#[derive(Clone, Debug, Default)]
pub struct Reflection {
    /// Bindings of set 0: name, number, kind.
    pub bindings: Vec<(String, u32, BindingKind)>,
    /// Bytes of the push constant block.
    pub push_bytes: u32,
    /// Members of every structure that a binding or push constant holds.
    pub members: Vec<BlockMember>,
}

impl Reflection {
    /// Reads SPIR-V. The text of an error names what was not understood.
    pub fn of(spirv: &[u32]) -> Result<Self, String> {
        let entries = ReflectConfig::new().spv(spirv.to_vec()).reflect().map_err(|e| e.to_string())?;
        let mut found = Self::default();
        for variable in entries.into_iter().flat_map(|entry| entry.vars) {
            match variable {
                Variable::Descriptor { name, desc_bind, desc_ty, ty, .. } => {
                    let kind = match desc_ty {
                        DescriptorType::StorageBuffer(_) => BindingKind::Buffer,
                        DescriptorType::StorageImage(_) => BindingKind::StorageImage,
                        DescriptorType::CombinedImageSampler() => BindingKind::Sampler,
                        other => return Err(format!("binding {desc_bind} is of a kind not used here: {other:?}")),
                    };
                    let name = name.ok_or_else(|| format!("binding {desc_bind} has no name"))?;
                    if desc_bind.set() != 0 {
                        return Err(format!("binding '{name}' is in set {}; only set 0 is used", desc_bind.set()));
                    }
                    found.bindings.push((name, desc_bind.bind(), kind));
                    collect(&ty, &mut found.members);
                }
                Variable::PushConstant { ty, .. } => {
                    found.push_bytes = ty.nbyte().unwrap_or(0).next_multiple_of(4) as u32;
                    collect(&ty, &mut found.members);
                }
                _ => {}
            }
        }
        Ok(found)
    }
}

fn collect(ty: &Type, members: &mut Vec<BlockMember>) {
    match ty {
        Type::Struct(s) => {
            let structure = s.name.clone().unwrap_or_default();
            for m in &s.members {
                let member = BlockMember {
                    structure: structure.clone(),
                    member: m.name.clone().unwrap_or_default(),
                    offset: m.offset.unwrap_or(0),
                };
                if !members.contains(&member) {
                    members.push(member);
                }
                collect(&m.ty, members);
            }
        }
        Type::Array(a) => collect(&a.element_ty, members),
        Type::DevicePointer(p) => collect(&p.pointee_ty, members),
        _ => {}
    }
}
