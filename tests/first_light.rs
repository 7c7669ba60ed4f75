//! The first picture, looked at while building.
mod common;
use common::{assert_quiet, gpu};
use nephroid::{
    image, methods,
    renderer::{Frame, Job, Providers, Renderer},
    scene::Scene,
    settings::Settings,
};
use std::sync::Arc;

#[test]
fn first_light() {
    let gpu = gpu();
    for name in ["glass-sphere", "bunny", "flat-water", "diffuse", "null"] {
        let scene = Arc::new(Scene::load(name, &[]).unwrap());
        let mut settings = Settings::default();
        let known = nephroid::renderer::all_settings();
        settings.set(&known, "light.side", "1024").unwrap();
        settings.set(&known, "eye.samples", "2").unwrap();
        let job = Job {
            scene: scene.clone(),
            providers: Providers::of(methods::find("maps").unwrap()),
            settings,
            camera: "main".into(),
            size: [512, 512],
        };
        let mut r = Renderer::new(&gpu, &job).unwrap();
        let t = r.frame(&Frame::default()).unwrap();
        let t = r.frame(&Frame::default()).unwrap();
        println!(
            "{name} {:?} span {} wall {} record {} prepare {:?}",
            r.stages().iter().zip(&t.passes).collect::<Vec<_>>(),
            t.span_ms,
            t.wall_ms,
            t.record_ms,
            r.prepare_ms()
        );
        let a = r.account().unwrap();
        println!("{a:?}\n{:?}", r.energy(&a).unwrap());
        let layers = r.layers().unwrap();
        let png = image::to_png(&layers, "radiance", scene.exposure, &Default::default()).unwrap();
        std::fs::create_dir_all("out").unwrap();
        std::fs::write(format!("out/first-{name}.png"), png).unwrap();
        assert_quiet(&gpu);
    }
}
