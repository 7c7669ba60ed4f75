//! GLSL under `glsl/`, carried in the binary, compiled at run time with includes; SPIR-V is kept in the store.

use include_dir::{Dir, include_dir};
use shaderc::{
    CompileOptions, Compiler, EnvVersion, OptimizationLevel, ResolvedInclude, ShaderKind as Kind, TargetEnv,
};
use std::collections::BTreeMap;

use super::{
    error::GpuError,
    plan::{Plan, Work},
};
use crate::store::{Key, Store};

static EMBEDDED: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/glsl");

/// Where SPIR-V lies in the store.
const STORE_KIND: &str = "spirv";

/// The stage a file is for, told by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShaderKind {
    /// `.vert`
    Vertex,
    /// `.geom`
    Geometry,
    /// `.frag`
    Fragment,
    /// `.comp`
    Compute,
}

impl ShaderKind {
    /// The stage of a file name.
    pub fn of(file: &str) -> Option<Self> {
        match file.rsplit('.').next()? {
            "vert" => Some(Self::Vertex),
            "geom" => Some(Self::Geometry),
            "frag" => Some(Self::Fragment),
            "comp" => Some(Self::Compute),
            _ => None,
        }
    }

    fn shaderc(self) -> Kind {
        match self {
            Self::Vertex => Kind::Vertex,
            Self::Geometry => Kind::Geometry,
            Self::Fragment => Kind::Fragment,
            Self::Compute => Kind::Compute,
        }
    }
}

/// The GLSL files by path below `glsl/`, and any that replace them (a test plants faults so).
#[derive(Clone, Default)]
pub struct Sources {
    replaced: BTreeMap<String, String>,
}

impl Sources {
    /// The text of a file.
    pub fn text(&self, path: &str) -> Option<&str> {
        self.replaced
            .get(path)
            .map(String::as_str)
            .or_else(|| EMBEDDED.get_file(path).and_then(|file| file.contents_utf8()))
    }

    /// Puts `text` in the place of a file, or adds one.
    pub fn replace(&mut self, path: &str, text: impl Into<String>) {
        self.replaced.insert(path.to_owned(), text.into());
    }

    /// Compiles a file with its defines; `provided` maps virtual includes to files. Words of SPIR-V.
    pub fn compile(
        &self,
        file: &str,
        defines: &[(String, String)],
        provided: &[(String, String)],
        store: &Store,
    ) -> Result<Vec<u32>, GpuError> {
        let fail = |text: String| GpuError::Shader { file: format!("glsl/{file}"), text };
        let kind = ShaderKind::of(file).ok_or_else(|| fail("its extension names no stage".into()))?;
        let source = self.text(file).ok_or_else(|| fail("there is no such file".into()))?;
        let key = self.key(file, defines, provided);
        if let Some(bytes) = store.get(STORE_KIND, &key)
            && bytes.len() % 4 == 0
        {
            return Ok(bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect());
        }
        let words = self.translate(file, kind, source, defines, provided).map_err(fail)?;
        store.put(STORE_KIND, &key, bytemuck::cast_slice(&words));
        Ok(words)
    }

    /// Compiles a shader that does nothing: whether the compiler is there and whole.
    pub fn try_compiler() -> Result<(), GpuError> {
        let mut sources = Self::default();
        sources.replace("nothing.comp", "#version 460\nvoid main() {}\n");
        sources.compile("nothing.comp", &[], &[], &Store::none()).map(drop)
    }

    fn translate(
        &self,
        file: &str,
        kind: ShaderKind,
        source: &str,
        defines: &[(String, String)],
        provided: &[(String, String)],
    ) -> Result<Vec<u32>, String> {
        // Only what the key holds is served: nothing else can be part of the SPIR-V.
        let reached = self.reached(file, provided);
        let compiler = Compiler::new().map_err(|e| e.to_string())?;
        let mut options = CompileOptions::new().map_err(|e| e.to_string())?;
        options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_3 as u32);
        options.set_optimization_level(OptimizationLevel::Performance);
        options.set_generate_debug_info(); // keeps the names that bindings are matched by
        for (name, value) in defines {
            options.add_macro_definition(name, Some(value));
        }
        options.set_include_callback(|asked, _, from, _| {
            let path = provided_for(asked, provided);
            let content = reached.get(path).ok_or_else(|| format!("{from} includes {path}, which is not in glsl/"))?;
            Ok(ResolvedInclude { resolved_name: path.to_owned(), content: (*content).to_owned() })
        });
        let binary = compiler
            .compile_into_spirv(source, kind.shaderc(), file, "main", Some(&options))
            .map_err(|e| e.to_string())?;
        Ok(binary.as_binary().to_vec())
    }

    /// What the SPIR-V depends on: the file and what it includes, the defines, this build.
    fn key(&self, file: &str, defines: &[(String, String)], provided: &[(String, String)]) -> Key {
        let mut inputs: Vec<&[u8]> = vec![file.as_bytes(), env!("CARGO_PKG_VERSION").as_bytes()];
        for (path, text) in self.reached(file, provided) {
            inputs.extend([path.as_bytes(), text.as_bytes()]);
        }
        for (name, value) in defines.iter().chain(provided) {
            inputs.extend([name.as_bytes(), value.as_bytes()]);
        }
        Key::of(inputs)
    }

    /// What all shaders of a plan depend on: it changes with any file that one of its passes compiles or includes, and
    /// with no other.
    pub fn plan_key(&self, plan: &Plan) -> Key {
        let keys = plan.passes.iter().flat_map(|pass| {
            let files = match &pass.work {
                Work::Compute { shader, .. } => std::slice::from_ref(shader),
                Work::Copy { .. } => &[],
                Work::Raster { shaders, .. } => shaders.as_slice(),
            };
            files.iter().map(|file| self.key(file, &pass.defines, &pass.provided).to_string())
        });
        Key::of(keys)
    }

    /// A file and all that it includes, however deep and under whichever condition, by path.
    fn reached<'s>(&'s self, file: &'s str, provided: &'s [(String, String)]) -> BTreeMap<&'s str, &'s str> {
        let (mut reached, mut waiting) = (BTreeMap::new(), vec![file]);
        while let Some(path) = waiting.pop() {
            let Some(text) = self.text(path).filter(|_| !reached.contains_key(path)) else { continue };
            reached.insert(path, text);
            waiting.extend(includes(text).map(|asked| provided_for(asked, provided)));
        }
        reached
    }
}

/// What the lines `#include "FILE"` of a text name.
fn includes(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let directive = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("include")?;
        let (_, rest) = directive.split_once('"')?;
        Some(rest.split_once('"')?.0)
    })
}

/// The file that an include means.
fn provided_for<'s>(asked: &'s str, provided: &'s [(String, String)]) -> &'s str {
    provided.iter().find(|(name, _)| name == asked).map_or(asked, |(_, path)| path)
}

/// The version of SPIR-V that the compiler writes.
pub fn spirv_version() -> String {
    let (version, _) = shaderc::get_spirv_version();
    format!("{}.{}", version >> 16, version >> 8 & 0xff)
}
