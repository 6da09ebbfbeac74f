//! The workbench as a reader sees it: Chromium without a window, spoken to through pipes by the protocol of its own tools.

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::{BUDGET, Served};
use crate::common::cases::folder;

/// A browser with one page.
struct Browser {
    program: Child,
    folder: PathBuf,
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
            .arg(&folder)
            .arg(language)
            .spawn()
            .expect("a shell");
        let to = File::options().write(true).open(&pipes[0]).expect("a pipe");
        let from = BufReader::new(File::open(&pipes[1]).expect("a pipe"));
        let mut browser = Browser {
            program,
            folder,
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

    /// Types where the caret is.
    fn types(&mut self, text: &str) {
        self.call("Input.insertText", json!({ "text": text }));
    }

    fn presses(&mut self, key: &str, modifiers: u8) {
        for kind in ["keyDown", "keyUp"] {
            let code = match key {
                "s" => 83,
                "Enter" => 13,
                _ => 9,
            };
            let event = json!({ "type": kind, "key": key, "modifiers": modifiers, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", event);
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

const DOCUMENT: &str = "document.getElementById('document').contentDocument.body.innerText";

/// From the text over a fault and its mend to the saved file, by keyboard alone; nothing else is asked for than the server.
#[test]
fn a_budget_is_mended_and_saved() {
    let served = Served::new("browser-edit", &[("a.toml", BUDGET)]);
    let address = format!("http://{}{}", served.host, served.base);
    let Some(mut browser) = Browser::open("browser-edit-profile", &address, "en-GB") else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    let place = BUDGET.find("u = 0.01").expect("a place");
    browser.value(&format!(
        "text.focus(), text.setSelectionRange({place}, {})",
        place + 1
    ));
    browser.types("uu");
    browser.until("document.querySelector('#marks mark')?.textContent === 'uu'");
    browser.until("document.querySelector('#faults li').innerText.includes('Line 7')");
    assert_eq!(
        browser.value("document.body.classList.contains('stale')"),
        true
    );
    browser.value(&format!("text.setSelectionRange({place}, {})", place + 2));
    browser.types("half_width");
    browser.until(
        "!document.body.classList.contains('stale') && !document.querySelector('#faults li')",
    );
    browser.until(&format!("{DOCUMENT}.includes('uniform')"));
    browser.presses("s", 2);
    browser.until("status.textContent !== null && document.getElementById('status').textContent.startsWith('Saved')");
    assert!(
        served
            .text("a.toml")
            .contains("b = { value = 3, half_width = 0.01 }")
    );
    let strangers: Vec<&String> = browser
        .asked
        .iter()
        .filter(|url| !url.starts_with(&address))
        .collect();
    let strangers: Vec<&&String> = strangers
        .iter()
        .filter(|url| !url.starts_with("data:") && !url.starts_with("about:"))
        .collect();
    assert!(strangers.is_empty(), "{strangers:?}");
}

/// In Chinese: what if, and a wish for U.
#[test]
fn what_if_is_seen_beside_what_is() {
    let served = Served::new("browser-what-if", &[("a.toml", BUDGET)]);
    let address = format!("http://{}{}", served.host, served.base);
    let Some(mut browser) = Browser::open("browser-what-if-profile", &address, "zh-CN") else {
        return;
    };
    browser.until("document.documentElement.lang === 'zh-Hans'");
    browser.until(&format!("{DOCUMENT}.includes('不确定度')"));
    browser.value("document.getElementById('what-if').open = true");
    browser.value("(slider => { slider.value = 8; slider.dispatchEvent(new Event('input')); })(document.querySelectorAll('#sliders input')[1])");
    browser.until("document.querySelector('#ghosts .now')");
    browser.until("document.getElementById('saved').textContent.includes('已保存')");
    browser.value("document.getElementById('wished').value = '0.3', document.getElementById('target').requestSubmit()");
    browser.until(&format!("{DOCUMENT}.includes('不可能')"));
    browser.presses("Tab", 0);
}
