//! What cannot be shown is said, with what to do, before a window opens.

use crate::{display::Display, program, ran};

const USAGE: i32 = 2;
const NO_DEVICE: i32 = 4;

#[test]
fn without_a_display_the_error_says_so() {
    for (display, wayland) in [(None, None), (Some(":4095"), None), (None, Some("no-such-socket"))] {
        let mut command = program("view glass-sphere --frames 1");
        let named = [("DISPLAY", display), ("WAYLAND_DISPLAY", wayland)];
        command.envs(named.into_iter().filter_map(|(name, value)| Some((name, value?))));
        let (code, out, err) = ran(command.output().unwrap());
        assert_eq!((code, out.as_str()), (Some(NO_DEVICE), ""), "{display:?} {wayland:?}: {err}");
        assert!(!err.contains(".rs"), "{display:?} {wayland:?}: places in sources: {err}");
        for words in ["no window can be opened", "DISPLAY", "xvfb-run", "scripts/setup"] {
            assert!(err.contains(words), "{display:?} {wayland:?}: the message lacks {words:?}: {err}");
        }
    }
}

#[test]
fn options_are_checked_before_the_display() {
    for (options, wanted) in [
        ("glass-sphere --frames 0", "--frames"),
        ("glass-sphere --frames some", "--frames"),
        ("glass-sphere --screenshot", "--screenshot"),
        ("glass-sphere --method map", "there is no method"),
        ("glass-sphere --camera side", "no camera `side`"),
        ("glass-sphere --medium maps", "does not fill the slot medium"),
        ("glas-sphere", "glass-sphere"),
        ("", "<SCENE>"),
    ] {
        let (code, _, err) = ran(program(&format!("view {options}")).output().unwrap());
        assert_eq!(code, Some(USAGE), "{options}: {err}");
        assert!(err.contains(wanted), "{options}: the message lacks {wanted:?}: {err}");
    }
}

#[test]
fn a_device_that_is_not_there_is_refused_as_by_render() {
    let display = Display::start();
    let (code, _, err) = ran(display.program("view null --frames 1 --device voodoo").output().unwrap());
    assert_eq!(code, Some(NO_DEVICE), "{err}");
    assert!(err.contains("no device matches 'voodoo'"), "{err}");
    let mut command = display.program("view null --frames 1");
    command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
    let (code, _, err) = ran(command.output().unwrap());
    assert_eq!(code, Some(NO_DEVICE), "{err}");
}

#[test]
fn the_keys_are_said_in_the_help() {
    let (code, out, _) = ran(program("view --help").output().unwrap());
    assert_eq!(code, Some(0));
    assert!(
        ["next layer", "next method", "orbit", "irradiance.caustic"].iter().all(|words| out.contains(words)),
        "{out}"
    );
}
