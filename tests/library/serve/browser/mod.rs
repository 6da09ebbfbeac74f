//! The workbench as a reader sees it: Chromium without a window, spoken to through pipes by the protocol of its own tools.

mod accessible;
mod dropped;
mod form;
mod lessons;
mod rows;
mod text;
mod what_if;

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::{BUDGET, Served};
use crate::common::cases::folder;
use crate::common::{Folder, root};

/// A browser with one page.
struct Browser {
    program: Child,
    /// Where its pipes and its profile are.
    _folder: Folder,
    to: File,
    from: BufReader<File>,
    session: Option<String>,
    number: u64,
    /// Addresses that were asked for.
    asked: Vec<String>,
}

fn chromium() -> Option<&'static str> {
    let known = ["chromium", "chromium-browser", "google-chrome"];
    known.into_iter().find(|name| {
        let there = Command::new(name).arg("--version").output();
        there.is_ok_and(|there| there.status.success())
    })
}

impl Browser {
    /// Opens an address; nothing where there is no browser.
    fn open(name: &str, address: &str, language: &str) -> Option<Browser> {
        let Some(browser) = chromium() else {
            eprintln!("skipped: there is no chromium");
            return None;
        };
        let folder = folder(name);
        let pipes = ["in", "out"].map(|pipe| folder.join(pipe));
        let made = Command::new("mkfifo").args(&pipes).status();
        assert!(made.is_ok_and(|made| made.success()), "no pipes");
        // The descriptors 3 and 4 are where the browser listens and speaks.
        let command = "exec \"$0\" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
            --remote-debugging-pipe --user-data-dir=\"$1/profile\" --lang=\"$2\" --accept-lang=\"$2\" \
            --window-size=1400,900 about:blank 3<\"$1/in\" 4>\"$1/out\" 2>/dev/null";
        let program = Command::new("sh")
            .args(["-c", command, browser])
            .arg(folder.as_os_str())
            .arg(language)
            .spawn()
            .expect("a shell");
        let to = File::options().write(true).open(&pipes[0]).expect("a pipe");
        let from = BufReader::new(File::open(&pipes[1]).expect("a pipe"));
        let mut browser = Browser {
            program,
            _folder: folder,
            to,
            from,
            session: None,
            number: 0,
            asked: Vec::new(),
        };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attach);
        browser.session = session["sessionId"].as_str().map(str::to_owned);
        browser.call("Network.enable", json!({}));
        browser.call("Page.enable", json!({}));
        browser.call("Page.navigate", json!({ "url": address }));
        Some(browser)
    }

    fn call(&mut self, method: &str, params: Value) -> Value {
        self.number += 1;
        let mut message = json!({ "id": self.number, "method": method, "params": params });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        write!(self.to, "{message}\0").expect("the browser listens");
        loop {
            let mut bytes = Vec::new();
            self.from
                .read_until(0, &mut bytes)
                .expect("the browser speaks");
            bytes.pop();
            let answer: Value = serde_json::from_slice(&bytes).expect("JSON");
            if answer["method"] == "Network.requestWillBeSent" {
                let url = answer["params"]["request"]["url"].as_str();
                self.asked.extend(url.map(str::to_owned));
            }
            if answer["id"] == self.number {
                assert!(answer["error"].is_null(), "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }

    /// The value of an expression of the page.
    fn value(&mut self, expression: &str) -> Value {
        let asked =
            json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        self.call("Runtime.evaluate", asked)["result"]["value"].clone()
    }

    /// Waits until an expression holds.
    fn until(&mut self, expression: &str) {
        let start = Instant::now();
        while self.value(&format!("Boolean({expression})")) != true {
            let state = "document.body.innerText.slice(0, 3000)";
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "{expression}\n{}",
                self.value(state)
            );
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Keeps a picture of the page in `reports/workbench`, where `GUMPTION_PICTURES` is set: pictures are looked at, not compared.
    fn picture(&mut self, name: &str) {
        if std::env::var_os("GUMPTION_PICTURES").is_none() {
            return;
        }
        let taken = self.call("Page.captureScreenshot", json!({ "format": "png" }));
        let folder = root().join("reports/workbench");
        std::fs::create_dir_all(&folder).expect("a folder");
        let bytes = from_base64(taken["data"].as_str().expect("a picture"));
        std::fs::write(folder.join(format!("{name}.png")), bytes).expect("written");
    }

    /// Types where the caret is.
    fn types(&mut self, text: &str) {
        self.call("Input.insertText", json!({ "text": text }));
    }

    fn presses(&mut self, key: &str, modifiers: u8) {
        for kind in ["keyDown", "keyUp"] {
            let code = match key {
                "s" => 83,
                "Enter" => 13,
                "Escape" => 27,
                " " => 32,
                "ArrowDown" => 40,
                _ => 9,
            };
            let name = if key == " " { "Space" } else { key };
            let event = json!({ "type": kind, "key": key, "code": name, "modifiers": modifiers, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", event);
        }
    }
}

/// RFC 4648, section 4.
fn from_base64(text: &str) -> Vec<u8> {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digits = text
        .bytes()
        .filter_map(|c| DIGITS.iter().position(|d| *d == c));
    let (mut bytes, mut held, mut bits) = (Vec::new(), 0_usize, 0);
    for digit in digits {
        held = held << 6 | digit;
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            bytes.push((held >> bits) as u8);
            held &= (1 << bits) - 1;
        }
    }
    bytes
}

/// A workbench with files, and a browser that shows it; nothing where there is no browser.
fn opened(name: &str, files: &[(&str, &str)], language: &str) -> Option<(Served, Browser)> {
    let served = Served::new(name, files);
    let address = format!("http://{}{}", served.host, served.base);
    let browser = Browser::open(&format!("{name}-profile"), &address, language)?;
    Some((served, browser))
}

/// Sets a field of the page as a hand would, so that the page hears of it.
fn set(browser: &mut Browser, field: &str, value: &str) {
    let (field, value) = (json!(field), json!(value));
    let done = browser.value(&format!(
        "(field => {{ field.value = {value}; for (const kind of ['input', 'change']) field.dispatchEvent(new Event(kind, {{ bubbles: true }})); return field.value; }})(document.querySelector({field}))"
    ));
    assert_eq!(done, value, "{field}");
}

/// Sets a field of the page, which may answer by setting it otherwise.
fn set_silently(browser: &mut Browser, field: &str, value: &str) {
    let (field, value) = (json!(field), json!(value));
    browser.value(&format!(
        "(field => {{ field.value = {value}; field.dispatchEvent(new Event('change', {{ bubbles: true }})); }})(document.querySelector({field}))"
    ));
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

const DOCUMENT: &str = "document.getElementById('document').contentDocument.body.innerText";

const RUN: &str = "omega [deg/s],U [mV]\n0,1.1\n1,1.9\n2,3.2\n3,9\n4,4.9\n5,6.2\n";
const RATE: &str =
    "recording = { file = \"run.csv\", average = \"none\" }\nequations = \"U = K*omega + b\"\n";
