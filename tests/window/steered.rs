//! A window that is typed at, dragged, resized and hidden, under the validation layers.

use std::{path::Path, process::Stdio};

use crate::{
    QUICK,
    display::Display,
    hand::Hand,
    picture::{Picture, mean_difference},
    ran,
};

const ESCAPE: u32 = 0xff1b;

/// Opens a window, lets `steer` steer it until it closes, and gives its screenshot and what it printed.
fn steered(scene: &str, steer: impl FnOnce(&Hand)) -> (Picture, String, String) {
    let display = Display::start();
    let folder = tempfile::tempdir().unwrap();
    let shot = folder.path().join("shot.png");
    let view = format!("view {scene} {QUICK} --frames 1000000 --validation --screenshot {}", shot.display());
    let mut command = display.program(&view);
    let program = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut program = Ended(program);
    steer(&Hand::on(&display.name, scene));
    let (code, out, err) = ran(program.output());
    assert_eq!(code, Some(0), "{err}");
    (Picture::read(Path::new(&shot)), out, err)
}

#[test]
fn keys_change_what_is_shown_and_the_title_says_it() {
    let (_, out, err) = steered("glass-sphere", |hand| {
        hand.expect("method maps | radiance at +0.5 EV");
        hand.expect("eye/trace");
        hand.expect("software");
        hand.press('2'.into());
        hand.expect("| direct at");
        hand.press('l'.into());
        hand.expect("| caustic at");
        hand.press('='.into());
        hand.expect("at +1.0 EV");
        hand.press('-'.into());
        hand.expect("at +0.5 EV");
        hand.press('-'.into());
        hand.expect("at +0.0 EV");
        hand.press('m'.into());
        hand.expect("method waves | caustic");
        hand.press('m'.into());
        hand.expect("method none | caustic");
        hand.press('m'.into());
        hand.expect("method maps");
        hand.press(' '.into());
        hand.press('6'.into());
        hand.expect("| mask at");
        hand.press(' '.into());
        hand.press('h'.into());
        hand.press('t'.into());
        hand.press('r'.into());
        hand.expect("at +0.5 EV");
        hand.press('q'.into());
    });
    assert!(err.contains("next layer"), "H says the keys: {err}");
    assert!(out.contains("glass-sphere, method maps"), "{out}");
}

#[test]
fn a_resized_and_hidden_window_goes_on_at_its_new_size() {
    let (shot, out, _) = steered("null", |hand| {
        hand.expect("eye/");
        for size in [[240, 90], [64, 200], [200, 140]] {
            hand.resize(size);
            hand.press('l'.into());
            hand.expect("| direct at");
            hand.press('1'.into());
            hand.expect("| radiance at");
        }
        hand.hide_and_show();
        hand.press('4'.into());
        hand.expect("| irradiance.direct at");
        hand.press(ESCAPE);
    });
    assert_eq!(shot.size, [200, 140]);
    assert!(out.contains("200x140 pixels"), "{out}");
}

#[test]
fn a_drag_moves_the_eye_and_r_puts_it_back() {
    let move_about = |hand: &Hand| {
        hand.expect("eye/");
        hand.drag(1, [80, 60], [110, 70]);
        hand.drag(3, [80, 60], [70, 50]);
        hand.drag(4, [80, 60], [80, 60]); // a notch of the wheel
    };
    let (still, ..) = steered("glass-sphere", |hand| hand.press(ESCAPE));
    let (moved, ..) = steered("glass-sphere", |hand| {
        move_about(hand);
        hand.press('2'.into());
        hand.expect("| direct at");
        hand.press('1'.into());
        hand.expect("| radiance at");
        hand.press(ESCAPE);
    });
    let (back, ..) = steered("glass-sphere", |hand| {
        move_about(hand);
        hand.press('r'.into());
        hand.press('2'.into());
        hand.expect("| direct at");
        hand.press('1'.into());
        hand.expect("| radiance at");
        hand.press(ESCAPE);
    });
    let (far, near) = (mean_difference(&still, &moved), mean_difference(&still, &back));
    println!("moved {far:.2} steps, back {near:.4}");
    assert!(far > 3.0 && near == 0.0, "moved {far}, back {near}");
}

/// A program that does not outlive its test.
struct Ended(std::process::Child);

impl Ended {
    /// Waits for its end. It says less than a pipe holds.
    fn output(&mut self) -> std::process::Output {
        let status = self.0.wait().expect("it ends");
        let mut all = std::process::Output { status, stdout: Vec::new(), stderr: Vec::new() };
        let read = |from: Option<&mut dyn std::io::Read>, to: &mut Vec<u8>| {
            from.map(|from| from.read_to_end(to)).transpose().expect("its words are read")
        };
        read(self.0.stdout.as_mut().map(|s| s as _), &mut all.stdout);
        read(self.0.stderr.as_mut().map(|s| s as _), &mut all.stderr);
        all
    }
}

impl Drop for Ended {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
