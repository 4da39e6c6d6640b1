//! A real browser, driven over its debugging pipe: no driver program and no port in between.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::skip::has_program;

/// How long a page may take for anything.
const PATIENCE: Duration = Duration::from_secs(60);

/// Between two movements of a hand: a frame or more.
const BETWEEN: Duration = Duration::from_millis(60);

/// Where a hand passes.
fn way(from: [f64; 2], to: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    (1..=8).map(move |step| [0, 1].map(|i: usize| from[i] + (to[i] - from[i]) * f64::from(step) / 8.0))
}

/// Chromium without a window, with one page.
#[derive(Debug)]
pub struct Browser {
    child: Child,
    to: File,
    from: BufReader<File>,
    session: Option<String>,
    number: u64,
    /// What the page asked for, by address.
    pub requests: Vec<String>,
    /// Errors of its scripts and of its console.
    pub complaints: Vec<String>,
    folder: PathBuf,
}

impl Browser {
    /// Starts it; `None`, and the test is skipped loudly, if there is none. `flags` are the browser's own.
    ///
    /// # Panics
    /// If it does not start, or if there is none and `CI` is `true`.
    pub fn start(flags: &[&str]) -> Option<Self> {
        Self::launch(&[&["--disable-gpu"], flags].concat())
    }

    /// With a software GPU for WebGPU and for WebGL2: without the Vulkan flags WebGPU says that all is well and shows black.
    ///
    /// # Panics
    /// As [`Browser::start`].
    pub fn start_with_gpu() -> Option<Self> {
        Self::launch(Self::SOFTWARE_GPU)
    }

    /// As [`Browser::start_with_gpu`], on a telephone: so many CSS pixels wide and high, two points each, for fingers.
    ///
    /// # Panics
    /// As [`Browser::start`].
    pub fn start_in_hand([width, height]: [u32; 2]) -> Option<Self> {
        // Of the browser as a whole: a page for which the points are overridden sees other sizes of its own canvas.
        let mut browser = Self::launch(&[Self::SOFTWARE_GPU, &["--force-device-scale-factor=2"]].concat())?;
        let screen = json!({ "width": width, "height": height, "deviceScaleFactor": 0, "mobile": true });
        browser.call("Emulation.setDeviceMetricsOverride", &screen);
        browser.call("Emulation.setTouchEmulationEnabled", &json!({ "enabled": true }));
        Some(browser)
    }

    const SOFTWARE_GPU: &[&str] = &[
        "--enable-unsafe-webgpu",
        "--use-webgpu-adapter=swiftshader",
        "--enable-features=Vulkan",
        "--use-vulkan=swiftshader",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
    ];

    fn launch(flags: &[&str]) -> Option<Self> {
        if !cfg!(unix) || !has_program("chromium") {
            return None;
        }
        static STARTED: AtomicU32 = AtomicU32::new(0);
        let name = format!("rilievo-browser-{}-{}", std::process::id(), STARTED.fetch_add(1, Ordering::Relaxed));
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder).expect("a temporary folder");
        let [to, from] = ["to", "from"].map(|name| folder.join(name));
        let made = Command::new("mkfifo").args([&to, &from]).status().expect("mkfifo runs");
        assert!(made.success(), "mkfifo failed");
        // A shell puts the pipes where the browser looks for them: the standard library has no way to.
        let child = Command::new("sh")
            .arg("-c")
            .arg("to=$1; from=$2; shift 2; exec chromium \"$@\" 3<\"$to\" 4>\"$from\"")
            .arg("sh")
            .args([&to, &from])
            .args(["--headless", "--no-sandbox", "--no-first-run", "--disable-quic", "--disable-background-networking"])
            .args(["--disable-component-update", "--disable-sync", "--remote-debugging-pipe", "--window-size=900,1000"])
            .arg(format!("--user-data-dir={}", folder.join("profile").display()))
            .args(flags)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("a shell runs");
        // In the order in which the shell opens them: each waits for the other side.
        let to = fs::OpenOptions::new().write(true).open(&to).expect("the browser listens");
        let from = BufReader::new(File::open(&from).expect("the browser speaks"));
        let (requests, complaints) = (Vec::new(), Vec::new());
        let mut browser = Self { child, to, from, session: None, number: 0, requests, complaints, folder };
        let target = browser.call("Target.createTarget", &json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", &attach);
        browser.session = session["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), &json!({}));
        }
        Some(browser)
    }

    /// Opens a file and waits until it is loaded.
    pub fn open(&mut self, file: &Path) {
        self.go_to(&format!("file://{}", file.canonicalize().expect("the page is there").display()));
    }

    /// Opens an address and waits until its document is loaded.
    pub fn go_to(&mut self, url: &str) {
        self.call("Page.navigate", &json!({ "url": url }));
        self.wait_until("document.readyState === 'complete' && location.protocol !== 'about:'");
    }

    /// Runs a script in every page that is opened from now on, before the page's own.
    pub fn before(&mut self, script: &str) {
        self.call("Page.addScriptToEvaluateOnNewDocument", &json!({ "source": script }));
    }

    /// Draws a finger along, in CSS pixels.
    pub fn swipe(&mut self, from: [f64; 2], to: [f64; 2]) {
        let mut touch = |what: &str, points: Value| {
            self.call("Input.dispatchTouchEvent", &json!({ "type": what, "touchPoints": points }));
            std::thread::sleep(BETWEEN);
        };
        touch("touchStart", json!([{ "x": from[0], "y": from[1] }]));
        for [x, y] in way(from, to) {
            touch("touchMove", json!([{ "x": x, "y": y }]));
        }
        touch("touchEnd", json!([]));
    }

    /// What is to be seen, as a PNG.
    ///
    /// # Panics
    /// If the browser sends none.
    pub fn screenshot(&mut self) -> Vec<u8> {
        let shot = self.call("Page.captureScreenshot", &json!({ "format": "png" }));
        from_base64(shot["data"].as_str().expect("a screenshot"))
    }

    /// Presses a button, `left` or `right`, at a place of the page, draws the mouse along, and lets go.
    pub fn drag(&mut self, button: &str, from: [f64; 2], to: [f64; 2]) {
        let held = if button == "right" { 2 } else { 1 };
        let mut event = |what: &str, [x, y]: [f64; 2], buttons: u32| {
            let event = json!({ "type": what, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1 });
            self.call("Input.dispatchMouseEvent", &event);
            std::thread::sleep(BETWEEN);
        };
        event("mouseMoved", from, 0);
        event("mousePressed", from, held);
        for place in way(from, to) {
            event("mouseMoved", place, held);
        }
        event("mouseReleased", to, 0);
    }

    /// Hands a file to the page, to be dropped later.
    pub fn take_in_hand(&mut self, name: &str, bytes: &[u8]) {
        let text = to_base64(bytes);
        self.eval(&format!(
            "(async () => {{ const read = await fetch('data:application/octet-stream;base64,{text}'); \
             globalThis.inHand = new File([await read.arrayBuffer()], {name:?}); }})()"
        ));
    }

    /// Drops that file on what is in the middle of the page; gives the page's clock, in milliseconds.
    pub fn let_go(&mut self) -> f64 {
        let now = self.eval(
            "(() => { const t = new DataTransfer(); t.items.add(inHand); const now = performance.now(); \
             [...document.querySelectorAll('canvas')].find((c) => c.clientWidth > 0) \
             .dispatchEvent(new DragEvent('drop', { dataTransfer: t, bubbles: true, cancelable: true })); return now; })()",
        );
        now.as_f64().expect("a time")
    }

    /// Drops a file on what is in the middle of the page.
    pub fn drop_file(&mut self, name: &str, bytes: &[u8]) {
        self.take_in_hand(name, bytes);
        self.let_go();
    }

    /// The value of an expression on the page; of a promise, what it comes to.
    ///
    /// # Panics
    /// If the expression throws.
    pub fn eval(&mut self, expression: &str) -> Value {
        let asked = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let said = self.call("Runtime.evaluate", &asked);
        assert!(said.get("exceptionDetails").is_none(), "{expression}: {said}");
        said["result"]["value"].clone()
    }

    /// Waits until an expression is true.
    ///
    /// # Panics
    /// If it is not within a minute.
    pub fn wait_until(&mut self, expression: &str) {
        let start = Instant::now();
        while self.eval(expression) != Value::Bool(true) {
            assert!(start.elapsed() < PATIENCE, "not within {PATIENCE:?}: {expression}; {:?}", self.complaints);
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The mouse at a place of the page, in CSS pixels: `mousePressed`, `mouseMoved` or `mouseReleased`.
    pub fn mouse(&mut self, what: &str, [x, y]: [f64; 2]) {
        let button = if what == "mouseMoved" { "none" } else { "left" };
        let event = json!({ "type": what, "x": x, "y": y, "button": button, "clickCount": 1, "pointerType": "mouse" });
        self.call("Input.dispatchMouseEvent", &event);
    }

    /// A key, by its name.
    pub fn key(&mut self, key: &str) {
        for what in ["keyDown", "keyUp"] {
            self.call("Input.dispatchKeyEvent", &json!({ "type": what, "key": key, "code": key }));
        }
    }

    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.number += 1;
        let mut message = json!({ "id": self.number, "method": method, "params": parameters });
        if let (Some(session), Some(object)) = (&self.session, message.as_object_mut()) {
            object.insert("sessionId".to_owned(), session.clone().into());
        }
        self.to.write_all(format!("{message}\0").as_bytes()).expect("the browser listens");
        loop {
            let mut bytes = Vec::new();
            let read = self.from.read_until(0, &mut bytes).expect("the browser speaks");
            assert!(read > 0, "the browser ended before it answered {method}");
            bytes.pop();
            let said: Value = serde_json::from_slice(&bytes).expect("the browser speaks JSON");
            if said["id"] == self.number {
                assert!(said.get("error").is_none(), "{method}: {said}");
                return said["result"].clone();
            }
            self.hear(&said);
        }
    }

    /// What the browser says unasked.
    fn hear(&mut self, said: &Value) {
        let about = &said["params"];
        match said["method"].as_str() {
            Some("Network.requestWillBeSent") => {
                self.requests.extend(about["request"]["url"].as_str().map(str::to_owned));
            }
            Some("Runtime.exceptionThrown") => self.complaints.push(about["exceptionDetails"].to_string()),
            Some("Log.entryAdded") if about["entry"]["level"] == "error" => {
                self.complaints.push(about["entry"].to_string());
            }
            Some("Runtime.consoleAPICalled") if about["type"] == "error" => self.complaints.push(about.to_string()),
            _ => {}
        }
    }
}

/// Where `cargo xtask web` puts the page, and the program that serves it.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/web/page");
const SERVER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/web/serve");

/// The viewer's page, served to this machine.
#[derive(Debug)]
pub struct Server {
    child: Child,
    address: String,
}

impl Server {
    /// Serves the page that was built.
    ///
    /// # Panics
    /// If none was: `cargo xtask web --build` builds it.
    pub fn start() -> Self {
        assert!(Path::new(PAGE).join("index.html").is_file(), "no page: `cargo xtask web --build` makes it");
        let mut child = Command::new(SERVER)
            .args(["--only-serve", PAGE])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the server of `cargo xtask web --build`");
        let mut address = String::new();
        let told = child.stdout.take().map(BufReader::new).map(|mut told| told.read_line(&mut address));
        assert!(matches!(told, Some(Ok(_))) && !address.is_empty(), "the server does not tell its address");
        Self { child, address: address.trim().to_owned() }
    }

    /// Where it is, with a slash at the end.
    pub fn address(&self) -> &str {
        &self.address
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // As with the browser.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Bytes as a text (RFC 4648).
fn to_base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0u32, |bits, i| bits << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        let digit = |i: usize| char::from(DIGITS[(bits >> (18 - 6 * i)) as usize & 63]);
        text.extend((0..4).map(|i| if i <= three.len() { digit(i) } else { '=' }));
    }
    text
}

/// The bytes of a text of the browser's (RFC 4648).
fn from_base64(text: &str) -> Vec<u8> {
    let value = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let (mut bytes, mut bits, mut count) = (Vec::with_capacity(text.len() / 4 * 3), 0u32, 0);
    for c in text.bytes().filter(|&c| c != b'=') {
        bits = bits << 6 | u32::from(value(c));
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Whatever becomes of it, the test is over.
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = fs::remove_dir_all(&self.folder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_all_lengths() {
        let decoded = |text| String::from_utf8(from_base64(text)).unwrap();
        assert_eq!(["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg=="].map(decoded), ["", "f", "fo", "foo", "foob"]);
        assert_eq!(from_base64("+/8A"), [0xfb, 0xff, 0]);
        for bytes in [&b""[..], b"f", b"fo", b"foo", b"foob", &[0xfb, 0xff, 0]] {
            assert_eq!(from_base64(&to_base64(bytes)), bytes);
        }
        assert_eq!(to_base64(b"foob"), "Zm9vYg==");
    }
}
