//! The keys of the scene format by their place: what can be set, also where the file leaves it at its default.

/// Tables that say of what kind their parent is; a dotted key may leave them out.
pub const KINDS: [&str; 22] = [
    "box",
    "conductor",
    "cylinder",
    "dielectric",
    "diffuse",
    "directional",
    "disk",
    "gradient",
    "heights",
    "image",
    "mesh",
    "mirror",
    "orthographic",
    "paraboloid",
    "pinhole",
    "point",
    "quad",
    "sea",
    "sine",
    "sphere",
    "spot",
    "wave",
];

/// Keys that a table may have. The deserialiser judges them in the end; the test below holds the two together.
pub fn keys(path: &[&str]) -> &'static [&'static str] {
    match path {
        [] => &[
            "version",
            "title",
            "unit",
            "paths",
            "exposure",
            "region",
            "extent",
            "cameras",
            "objects",
            "materials",
            "lights",
            "sky",
            "imports",
        ],
        ["region"] => &["receiver", "center", "half"],
        ["extent"] => &["center", "half"],
        ["sky"] => &["gradient", "image"],
        ["sky", "gradient"] => &["zenith", "horizon", "ground", "up"],
        ["sky", "image"] => &["file", "scale", "up", "turn"],
        ["cameras", _] => &["pinhole", "orthographic"],
        ["objects", _] => &[
            "material",
            "visible_to_camera",
            "sphere",
            "quad",
            "box",
            "disk",
            "cylinder",
            "paraboloid",
            "sine",
            "heights",
            "wave",
            "sea",
            "mesh",
            "motion",
        ],
        ["materials", _] => &["diffuse", "dielectric", "mirror", "conductor"],
        ["lights", _] => &["directional", "point", "spot", "quad", "disk", "motion"],
        ["cameras", _, "pinhole"] => &["position", "target", "up", "hides_specular", "fov_y"],
        ["cameras", _, "orthographic"] => &["position", "target", "up", "hides_specular", "height", "width"],
        ["objects", _, "sphere"] => &["center", "radius"],
        ["objects", _, "quad"] => &["center", "u", "v"],
        ["objects", _, "box"] => &["center", "half", "rotate"],
        ["objects", _, "disk"] => &["center", "normal", "radius"],
        ["objects", _, "cylinder"] => &["base", "axis", "radius", "height", "arc", "middle"],
        ["objects", _, "paraboloid"] => &["vertex", "axis", "focal_length", "rim", "from", "middle"],
        ["objects", _, "sine"] => &["center", "u", "v", "amplitude", "wavelength", "speed"],
        ["objects", _, "heights"] => &["file", "center", "u", "v", "height", "base", "grid"],
        ["objects", _, "wave"] => &[
            "center",
            "u",
            "v",
            "length",
            "middle",
            "octaves",
            "wave_size",
            "factor",
            "speed",
            "vertex_size",
            "time",
            "grid",
        ],
        ["objects", _, "sea"] => &[
            "center",
            "u",
            "v",
            "wind",
            "direction",
            "spread",
            "count",
            "shortest",
            "longest",
            "factor",
            "speed",
            "seed",
            "time",
            "grid",
        ],
        ["objects", _, "mesh"] => &["file", "fit", "center", "rotate"],
        ["objects", _, "motion"] => &["position", "rotate", "scale", "twist", "bend", "wave", "period"],
        ["objects", _, "motion", "twist"] => &["axis", "angle"],
        ["objects", _, "motion", "bend"] => &["along", "towards", "angle"],
        ["objects", _, "motion", "wave"] => &["along", "towards", "amplitude", "wavelength", "speed"],
        ["materials", _, "diffuse"] => &["albedo", "texture", "repeat"],
        ["materials", _, "dielectric"] => &["ior", "absorption"],
        ["materials", _, "mirror"] => &["reflectance"],
        ["materials", _, "conductor"] => &["eta", "k"],
        ["lights", _, "motion"] => &["position", "direction", "irradiance", "radiance", "intensity", "period"],
        ["imports", _] => &["file", "scale", "position", "rotate", "materials", "lights", "watts_per_lumen"],
        ["lights", _, "directional"] => &["direction", "irradiance", "angular_diameter"],
        ["lights", _, "point"] => &["position", "intensity"],
        ["lights", _, "spot"] => &["position", "direction", "intensity", "inner", "image", "up", "outer"],
        ["lights", _, "quad"] => &["center", "u", "v", "radiance", "power"],
        ["lights", _, "disk"] => &["center", "normal", "radius", "radiance", "power"],
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::keys;
    use crate::scene::{file, imports, motion_files, sea_files, shape_files, sheet_files, sky};

    /// The keys that the deserialiser names when it meets one that it does not know.
    fn known<T: for<'de> Deserialize<'de>>() -> Vec<String> {
        let error = toml::from_str::<T>("no_key_of_any = 1").err().expect("an unknown key").message().to_owned();
        error.split('`').skip(3).step_by(2).map(str::to_owned).collect()
    }

    #[test]
    fn the_deserialiser_knows_the_same_keys() {
        assert_eq!(keys(&[]), known::<file::SceneFile>());
        assert_eq!(keys(&["region"]), known::<file::RegionFile>());
        assert_eq!(keys(&["extent"]), known::<file::PatchFile>());
        assert_eq!(keys(&["sky"]), known::<sky::SkyFile>());
        assert_eq!(keys(&["sky", "gradient"]), known::<sky::GradientFile>());
        assert_eq!(keys(&["sky", "image"]), known::<sky::ImageFile>());
        assert_eq!(keys(&["cameras", ""]), known::<file::CameraFile>());
        assert_eq!(keys(&["cameras", "", "pinhole"]), known::<file::PinholeFile>());
        assert_eq!(keys(&["cameras", "", "orthographic"]), known::<file::OrthographicFile>());
        assert_eq!(keys(&["objects", ""]), known::<file::ObjectFile>());
        assert_eq!(keys(&["objects", "", "sphere"]), known::<file::SphereFile>());
        assert_eq!(keys(&["objects", "", "quad"]), known::<file::QuadFile>());
        assert_eq!(keys(&["objects", "", "box"]), known::<shape_files::BoxFile>());
        assert_eq!(keys(&["objects", "", "disk"]), known::<shape_files::DiskFile>());
        assert_eq!(keys(&["objects", "", "cylinder"]), known::<shape_files::CylinderFile>());
        assert_eq!(keys(&["objects", "", "paraboloid"]), known::<shape_files::ParaboloidFile>());
        assert_eq!(keys(&["objects", "", "sine"]), known::<shape_files::SineFile>());
        assert_eq!(keys(&["objects", "", "heights"]), known::<sheet_files::HeightsFile>());
        assert_eq!(keys(&["objects", "", "wave"]), known::<sheet_files::WaveFile>());
        assert_eq!(keys(&["objects", "", "sea"]), known::<sea_files::SeaFile>());
        assert_eq!(keys(&["objects", "", "mesh"]), known::<file::MeshFile>());
        assert_eq!(keys(&["objects", "", "motion"]), known::<motion_files::ObjectMotionFile>());
        assert_eq!(keys(&["objects", "", "motion", "twist"]), known::<motion_files::TwistFile>());
        assert_eq!(keys(&["objects", "", "motion", "bend"]), known::<motion_files::BendFile>());
        assert_eq!(keys(&["objects", "", "motion", "wave"]), known::<motion_files::WaveFile>());
        assert_eq!(keys(&["lights", "", "motion"]), known::<motion_files::LightMotionFile>());
        assert_eq!(keys(&["materials", ""]), known::<file::MaterialFile>());
        assert_eq!(keys(&["materials", "", "diffuse"]), known::<file::DiffuseFile>());
        assert_eq!(keys(&["materials", "", "dielectric"]), known::<file::DielectricFile>());
        assert_eq!(keys(&["materials", "", "mirror"]), known::<file::MirrorFile>());
        assert_eq!(keys(&["materials", "", "conductor"]), known::<file::ConductorFile>());
        assert_eq!(keys(&["lights", ""]), known::<file::LightFile>());
        assert_eq!(keys(&["imports", ""]), known::<imports::ImportFile>());
        assert_eq!(keys(&["lights", "", "directional"]), known::<file::DirectionalFile>());
        assert_eq!(keys(&["lights", "", "point"]), known::<file::PointFile>());
        assert_eq!(keys(&["lights", "", "spot"]), known::<file::SpotFile>());
        assert_eq!(keys(&["lights", "", "quad"]), known::<file::QuadLightFile>());
        assert_eq!(keys(&["lights", "", "disk"]), known::<file::DiskLightFile>());
    }
}
