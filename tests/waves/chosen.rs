//! What a metre of water takes by `waves.absorbed` is what the scene's water takes that absorbs as much.

use crate::{
    common::{gpu, picture::worst},
    inverse::inverse,
    shown,
};

#[test]
fn a_share_of_each_metre_is_an_absorption() {
    let gpu = gpu();
    let slanting = ("scene.lights.sun.directional.direction", "[0.6, -1, 0.2]");
    let absorption = (-0.7_f64.ln()).to_string();
    for variant in ["inverse", "pixel", "shortcut", "texture", "vertex"] {
        let of = |set: (&str, &str)| {
            shown(&gpu, &inverse("sine-water", &[slanting, ("waves.variant", variant), set], "region", [12, 12])).0
        };
        let absorbed = of(("waves.absorbed", "0.3"));
        let same = of(("scene.materials.water.absorption", &absorption));
        let clear = of(("waves.absorbed", "0"));
        let off = worst(absorbed.iter().zip(&same).map(|(a, b)| a - b));
        let kept = absorbed.iter().sum::<f64>() / clear.iter().sum::<f64>();
        println!("{variant}: off {off:.1e}, kept {kept:.4}");
        assert!(off < 1e-6, "{variant}: {off:e}");
        // 0.8 m of it, at most a fifth longer where light is bent by 30°.
        assert!((0.70..0.77).contains(&kept), "{variant}: {kept}");
    }
}
