//! A hand at the window: it types, drags and resizes through the X server, as a user does.

use std::{
    io::IoSlice,
    thread::sleep,
    time::{Duration, Instant},
};

use x11rb::{
    connection::{Connection, RequestConnection},
    protocol::xproto::{ConfigureWindowAux, ConnectionExt, InputFocus, Window},
    rust_connection::RustConnection,
};

/// How long the window may take to do what it is told; a software device renders meanwhile.
const PATIENCE: Duration = Duration::from_secs(60);

const KEY: u8 = 2;
const BUTTON: u8 = 4;
const MOTION: u8 = 6;

pub struct Hand {
    server: RustConnection,
    root: Window,
    window: Window,
    /// The XTEST extension, whose one request is written by hand: its feature would build winit's x11rb twice.
    xtest: u8,
}

impl Hand {
    /// Waits for the window whose title has these words, and gives it the keys.
    pub fn on(display: &str, words: &str) -> Self {
        let (server, screen) = x11rb::connect(Some(display)).expect("the display takes clients");
        let root = server.setup().roots[screen].root;
        let xtest = server.query_extension(b"XTEST").unwrap().reply().expect("Xvfb has XTEST").major_opcode;
        let mut hand = Self { server, root, window: 0, xtest };
        hand.window = wait_for(words, || hand.windows().into_iter().find(|w| hand.title_of(*w).contains(words)));
        hand.focus();
        hand
    }

    fn windows(&self) -> Vec<Window> {
        self.server.query_tree(self.root).unwrap().reply().map(|tree| tree.children).unwrap_or_default()
    }

    fn title_of(&self, window: Window) -> String {
        let atom = |name: &[u8]| self.server.intern_atom(false, name).unwrap().reply().unwrap().atom;
        let (name, utf8) = (atom(b"_NET_WM_NAME"), atom(b"UTF8_STRING"));
        let property = self.server.get_property(false, window, name, utf8, 0, 1024).unwrap().reply();
        property.map(|p| String::from_utf8_lossy(&p.value).into_owned()).unwrap_or_default()
    }

    fn focus(&self) {
        self.server.set_input_focus(InputFocus::PARENT, self.window, x11rb::CURRENT_TIME).unwrap();
        self.server.flush().unwrap();
    }

    /// Waits until the title has these words.
    #[track_caller]
    pub fn expect(&self, words: &str) {
        wait_for(words, || self.title_of(self.window).contains(words).then_some(()));
    }

    /// Presses the key that has this symbol (Latin-1 as it is; Escape 0xff1b) without shift.
    pub fn press(&self, symbol: u32) {
        let setup = self.server.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let map = self.server.get_keyboard_mapping(first, last - first + 1).unwrap().reply().unwrap();
        let keys = map.keysyms.chunks(map.keysyms_per_keycode.into());
        let at = keys.into_iter().position(|symbols| symbols[0] == symbol).expect("a key of that symbol");
        self.fake(KEY, first + at as u8, [0, 0]);
        self.fake(KEY + 1, first + at as u8, [0, 0]);
    }

    /// Drags with a button; the window lies in the corner of the screen.
    pub fn drag(&self, button: u8, from: [i16; 2], to: [i16; 2]) {
        self.fake(MOTION, 0, from);
        self.fake(BUTTON, button, from);
        self.fake(MOTION, 0, to);
        self.fake(BUTTON + 1, button, to);
    }

    pub fn resize(&self, [width, height]: [u32; 2]) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.server.configure_window(self.window, &size).unwrap();
        self.server.flush().unwrap();
    }

    /// Takes the window off the screen and puts it back.
    pub fn hide_and_show(&self) {
        self.server.unmap_window(self.window).unwrap().check().unwrap();
        sleep(Duration::from_millis(200));
        self.server.map_window(self.window).unwrap().check().unwrap();
        sleep(Duration::from_millis(200));
        self.focus();
    }

    /// XTestFakeInput, in the byte order of this machine as every request.
    fn fake(&self, kind: u8, detail: u8, at: [i16; 2]) {
        let mut request = [0; 36];
        request[..2].copy_from_slice(&[self.xtest, 2]);
        request[2..4].copy_from_slice(&9u16.to_ne_bytes());
        request[4..6].copy_from_slice(&[kind, detail]);
        request[12..16].copy_from_slice(&self.root.to_ne_bytes());
        request[24..26].copy_from_slice(&at[0].to_ne_bytes());
        request[26..28].copy_from_slice(&at[1].to_ne_bytes());
        self.server.send_request_without_reply(&[IoSlice::new(&request)], Vec::new()).unwrap().check().unwrap();
    }
}

#[track_caller]
fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(start.elapsed() < PATIENCE, "waited in vain for {what:?}");
        sleep(Duration::from_millis(20));
    }
}
