//! A real display without a screen: windows are opened on it, seen and touched.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rilievo::color::Picture;
use rilievo::{Grid, Rgba8};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ConnectionExt as _, ImageFormat, InputFocus, KEY_PRESS_EVENT,
    KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

use crate::skip::has_program;

/// Width and height of the screen.
pub const SIZE: (u16, u16) = (1280, 860);
/// How long anything may take to show.
const PATIENCE: Duration = Duration::from_secs(90);

/// Xvfb, with a connection of our own.
#[derive(Debug)]
pub struct Display {
    server: Child,
    name: String,
    connection: RustConnection,
    root: u32,
}

impl Display {
    /// Starts it; `None`, and the test is skipped loudly, if there is none.
    ///
    /// # Panics
    /// If it does not start, or if there is none and `CI` is `true`.
    pub fn start() -> Option<Self> {
        if !has_program("Xvfb") {
            return None;
        }
        let screen = format!("{}x{}x24", SIZE.0, SIZE.1);
        // It chooses a number that is free and says it on descriptor 1, its stdout.
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0", &screen])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb runs");
        let mut number = String::new();
        let stdout = server.stdout.take().expect("it was piped");
        BufReader::new(stdout).read_line(&mut number).expect("Xvfb says its number");
        let name = format!(":{}", number.trim());
        let (connection, screen) = x11rb::connect(Some(&name)).expect("Xvfb answers");
        let root = connection.setup().roots[screen].root;
        Some(Self { server, name, connection, root })
    }

    /// What `DISPLAY` is for programs that are to open their windows on it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// All that is to be seen.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn picture(&self) -> Picture {
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, SIZE.0, SIZE.1, !0);
        let image = image.expect("a request").reply().expect("a screenshot");
        let pixels = image.data.chunks_exact(4).map(|p| Rgba8::new(p[2], p[1], p[0], 255)).collect();
        Grid::new(SIZE.0.into(), SIZE.1.into(), pixels).expect("invariant: as many pixels as the screen has")
    }

    /// Waits until `seen` is true of the screen; gives it.
    ///
    /// # Panics
    /// With `what` and the last screen's mean if it takes too long.
    #[track_caller]
    pub fn wait_for(&self, what: &str, seen: impl Fn(&Picture) -> bool) -> Picture {
        let start = Instant::now();
        loop {
            let picture = self.picture();
            if seen(&picture) {
                return picture;
            }
            assert!(start.elapsed() < PATIENCE, "{what} does not show; the mean is {:?}", mean(&picture));
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Waits until nothing has moved for a second.
    pub fn wait_until_still(&self) -> Picture {
        let (mut last, mut since) = (self.picture(), Instant::now());
        let start = Instant::now();
        while since.elapsed() < Duration::from_secs(1) && start.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(150));
            let now = self.picture();
            if now != last {
                (last, since) = (now, Instant::now());
            }
        }
        last
    }

    /// Presses a button, draws the pointer along, and lets go.
    ///
    /// # Panics
    /// If the server does not answer.
    pub fn drag(&self, button: u8, from: (i16, i16), to: (i16, i16)) {
        self.fake(MOTION_NOTIFY_EVENT, 0, from);
        self.fake(BUTTON_PRESS_EVENT, button, from);
        const STEPS: i16 = 8;
        for step in 1..=STEPS {
            let at = |a: i16, b: i16| a + (b - a) * step / STEPS;
            self.fake(MOTION_NOTIFY_EVENT, 0, (at(from.0, to.0), at(from.1, to.1)));
        }
        self.fake(BUTTON_RELEASE_EVENT, button, to);
    }

    /// Presses and releases a key of the keyboard, by its symbol, in whichever window was opened last.
    ///
    /// # Panics
    /// If the server does not answer, or the keyboard has no such key.
    pub fn key(&self, symbol: u32) {
        let tree = self.connection.query_tree(self.root).expect("a request").reply().expect("the windows");
        if let Some(&window) = tree.children.last() {
            self.connection.set_input_focus(InputFocus::PARENT, window, 0u32).expect("a request");
        }
        let setup = self.connection.setup();
        let count = setup.max_keycode - setup.min_keycode + 1;
        let map = self.connection.get_keyboard_mapping(setup.min_keycode, count).expect("a request");
        let map = map.reply().expect("the keyboard");
        let at = map.keysyms.iter().position(|&s| s == symbol).expect("a key of this symbol");
        let code = setup.min_keycode + (at / usize::from(map.keysyms_per_keycode)) as u8;
        self.fake(KEY_PRESS_EVENT, code, (0, 0));
        self.fake(KEY_RELEASE_EVENT, code, (0, 0));
    }

    /// An event, some milliseconds after the last: as from a hand.
    fn fake(&self, kind: u8, detail: u8, (x, y): (i16, i16)) {
        self.connection.xtest_fake_input(kind, detail, 0, self.root, x, y, 0).expect("a request");
        self.connection.flush().expect("the server listens");
        std::thread::sleep(Duration::from_millis(60));
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        // Gone already is gone too.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Mean of red, green and blue.
pub fn mean(picture: &Picture) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for pixel in picture.texels() {
        for (sum, v) in sum.iter_mut().zip(pixel.rgb()) {
            *sum += f64::from(v);
        }
    }
    sum.map(|s| s / picture.texels().len() as f64)
}
