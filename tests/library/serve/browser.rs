//! The workbench as a reader sees it: Chromium without a window, spoken to through pipes by the protocol of its own tools.

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::{BUDGET, Served};
use crate::common::cases::folder;
use crate::common::root;

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
    browser.until(&format!("{DOCUMENT}.includes('代价最小')"));
    browser.presses("Tab", 0);
}

/// More readings of the same scatter, moved by the slider.
#[test]
fn the_number_of_readings_is_moved() {
    let stated = BUDGET.replace("u = 0.1", "readings = [1.9, 2.1]");
    let files = [("a.toml", stated.as_str())];
    let Some((served, mut browser)) = opened("browser-readings", &files, "en") else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    browser.value("document.getElementById('what-if').open = true");
    let slider = "document.querySelector('#sliders input[aria-label=\"n(a)\"]')";
    browser.until(&format!("{slider}?.value === '2'"));
    browser.value(&format!(
        "{slider}.value = 50, {slider}.dispatchEvent(new Event('input'))"
    ));
    // s = 0.2/√2 of n = 50 readings: u = 0.02.
    browser.until("Math.abs(state.beside.inputs[0].u - 0.02) < 1e-12");
    browser.until("document.querySelector('#ghosts .now')");
    browser.picture("what-if");
    assert_eq!(served.text("a.toml"), stated);
}

/// A recording that is dropped becomes an experiment of its own, with its plan.
#[test]
fn a_recording_is_dropped() {
    let files = [("a.toml", BUDGET)];
    let Some((served, mut browser)) = opened("browser-propose", &files, "en") else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    browser.value("void drop([new File(['x [V],y [mV]\\n1,1.01\\n2,2.02\\n1,1.02\\n2,2.01\\n3,3.01\\n3,3.03\\n'], 'run.csv')])");
    browser.until("document.getElementById('ask').open && document.getElementById('question').textContent.includes('run.csv')");
    browser.value("document.getElementById('yes').click()");
    browser.until("document.getElementById('ask').open && document.getElementById('option').options.length > 10");
    browser.value("document.getElementById('yes').click()");
    browser.until("text.value.includes('y = a + b*x')");
    browser.until(&format!("{DOCUMENT}.includes('b')"));
    assert!(served.text("run.toml").contains("recording = \"run.csv\""));
    browser.until("!document.getElementById('experiment').hidden");
    browser.value("document.getElementById('plan').click()");
    browser.until("state.shown === 'plan'");
}

/// A sheet that is dropped is audited; the certificate of a budget is downloaded, with the data that the page wrote to fill in.
#[test]
fn a_sheet_is_audited_and_a_certificate_downloaded() {
    let Some((served, mut browser)) = opened("browser-download", &[("a.toml", BUDGET)], "en")
    else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    let sheet = json!(
        std::fs::read_to_string(root().join("docs/examples/claimed-budget.csv")).expect("a text")
    );
    browser.value(&format!("void drop([new File([{sheet}], 'sheet.csv')])"));
    browser.until("document.getElementById('ask').open");
    browser.value("document.getElementById('other').click()");
    browser.until(&format!("{DOCUMENT}.includes('not divided by its k')"));
    browser.value("document.getElementById('back').click()");
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    set_silently(&mut browser, "#certificate", "new");
    browser.until("document.getElementById('ask').open");
    browser.value("document.getElementById('yes').click()");
    browser.until("text.value.includes('[laboratory]')");
    browser.until(&format!("{DOCUMENT}.includes('complete')"));
    assert!(served.text("laboratory.toml").contains("[customer]"));
    set_silently(&mut browser, "#file", "a.toml");
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    set_silently(&mut browser, "#certificate", "laboratory.toml");
    browser.until(&format!("{DOCUMENT}.includes('2026-0001')"));
    // What a hand would find in its folder of downloads.
    browser.value("HTMLAnchorElement.prototype.click = function () { window.name = this.download; }; URL.createObjectURL = blob => { blob.text().then(text => { window.got = text; }); return ''; }");
    set_silently(&mut browser, "#format", "dcc");
    browser.until("window.got");
    let got = browser.value("window.got");
    let text = got.as_str().expect("a text");
    assert_eq!(browser.value("window.name"), "a.xml");
    assert!(
        text.contains("digitalCalibrationCertificate") && text.contains("2026-0001"),
        "{text}"
    );
}

/// A lesson goes on by itself to its last picture, is stopped by a hand at the slider, and begins anew.
#[test]
fn a_lesson_is_played() {
    let Some((_served, mut browser)) = opened("browser-lesson", &[("a.toml", BUDGET)], "en") else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    browser.value("(box => { box.value = box.options[1].value; box.dispatchEvent(new Event('change')); })(document.getElementById('lesson'))");
    browser.until("!document.getElementById('size').hidden");
    let moved = |n: u32| {
        format!(
            "(n => {{ n.value = {n}; n.dispatchEvent(new Event('input')); }})(document.getElementById('n'))"
        )
    };
    browser.value(&moved(28));
    browser.value("document.getElementById('play').click()");
    browser.until("document.getElementById('n-shown').value === 'M = 10 000' && document.getElementById('play').textContent === 'Play'");
    browser.picture("lesson");
    browser.value("document.getElementById('play').click()");
    browser.until("document.getElementById('n-shown').value === 'M = 3' && document.getElementById('play').textContent === 'Pause'");
    browser.value(&moved(12));
    assert_eq!(
        browser.value("document.getElementById('play').textContent"),
        "Play"
    );
    browser.until("document.getElementById('n-shown').value === 'M = 40'");
}

/// An exercise is handed out without its truth, answered in the form, graded at once; the teacher's sheet is asked for.
#[test]
fn a_budget_with_a_slip_is_answered() {
    let Some((_served, mut browser)) = opened("browser-exercise", &[("a.toml", BUDGET)], "en-GB")
    else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    let truth = |number| gumption::challenge::budget::sheet(7, number).truth;
    let number = (1..=20).find(|number| {
        let truth = truth(*number);
        truth.slips.len() == 1 && truth.slips[0].contains('@')
    });
    let number = number.expect("a budget with one slip in a row");
    let truth = truth(number);
    set(&mut browser, "#exercise-kind", "budget");
    browser.until("practice.open && !flight");
    set(&mut browser, "#seed", "7");
    set(&mut browser, "#nth", &number.to_string());
    browser.value("document.getElementById('open-exercise').click()");
    browser.until(&format!("{DOCUMENT}.includes('Exercise 7, no. {number}')"));
    let (kind, row) = truth.slips[0].split_once('@').expect("a slip in a row");
    let known = browser.value("document.documentElement.outerHTML + JSON.stringify(practice)");
    assert!(!known.as_str().expect("a text").contains(&truth.slips[0]));
    browser.value("document.querySelector('[value=slips]').click()");
    set(&mut browser, "#claims .kind", kind);
    set(&mut browser, "#claims .row", row);
    set(&mut browser, "#U", &truth.expanded.to_string());
    let room = "$('practice').scrollWidth <= $('practice').clientWidth";
    assert_eq!(browser.value(room), true);
    browser.picture("exercise");
    browser.value("document.getElementById('practice').requestSubmit()");
    browser.until(&format!("{DOCUMENT}.includes('1 of 1 named first')"));
    browser.picture("graded");
    browser.value("document.getElementById('answers').click()");
    browser.until("document.getElementById('ask').open");
    browser.value("document.getElementById('yes').click()");
    browser.until(&format!("{DOCUMENT}.includes('For the teacher')"));
    browser.value("document.getElementById('leave-exercise').click()");
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
}

/// A recording stands in the editor as any experiment, and is answered in Chinese.
#[test]
fn a_recording_with_physics_is_answered() {
    let Some((_served, mut browser)) = opened("browser-physics", &[("a.toml", BUDGET)], "zh-CN")
    else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('不确定度')"));
    set(&mut browser, "#exercise-kind", "recording");
    browser.until("practice.open && !flight && state.path.startsWith('exercise-')");
    set(&mut browser, "#seed", "7");
    browser.value("document.getElementById('open-exercise').click()");
    browser.until("state.path === 'exercise-7-1.toml' && !flight");
    browser.until("text.value.includes('recording.csv') && !document.querySelector('#faults li')");
    browser.value("document.querySelector('[value=agrees]').click()");
    browser.value("document.getElementById('practice').requestSubmit()");
    browser.until(&format!("{DOCUMENT}.includes('得分')"));
    browser.picture("physics-zh");
}

/// What edits have changed since the file was saved is attributed to each, with what it is told.
#[test]
fn edits_are_compared_with_the_saved_text() {
    let Some((_served, mut browser)) = opened("browser-versions", &[("a.toml", BUDGET)], "en-GB")
    else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    assert_eq!(
        browser.value("document.getElementById('compare').disabled"),
        true
    );
    let edited = json!(
        BUDGET
            .replace("u = 0.1", "u = 0.2")
            .replace("u = 0.01", "u = 0.05")
    );
    browser.value(&format!(
        "text.value = {edited}, text.dispatchEvent(new Event('input'))"
    ));
    browser.until("!document.getElementById('compare').disabled && !flight");
    browser.value("document.getElementById('compare').click()");
    browser.until(&format!("{DOCUMENT}.includes('input.a') && {DOCUMENT}.includes('input.b') && {DOCUMENT}.includes('Shapley')"));
    browser.picture("versions");
}

const RUN: &str = "omega [deg/s],U [mV]\n0,1.1\n1,1.9\n2,3.2\n3,9\n4,4.9\n5,6.2\n";
const RATE: &str =
    "recording = { file = \"run.csv\", average = \"none\" }\nequations = \"U = K*omega + b\"\n";

/// A row is selected, left out with a reason, and both stay in the file.
#[test]
fn rows_are_left_out_with_a_reason() {
    let files = [("rate.toml", RATE), ("run.csv", RUN)];
    let Some((served, mut browser)) = opened("browser-left-out", &files, "en-GB") else {
        return;
    };
    browser.until("residuals.rows.length === 6 && !flight");
    browser.value("document.getElementById('residuals').open = true");
    // The largest one, by a hand over the picture.
    let place = browser.value(
        "(dot => { dot.scrollIntoView(); const box = dot.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })(residuals.dots[3])",
    );
    for kind in ["mousePressed", "mouseReleased"] {
        let event = json!({ "type": kind, "x": place[0], "y": place[1], "button": "left", "clickCount": 1 });
        browser.call("Input.dispatchMouseEvent", event);
    }
    browser.until("document.getElementById('rows').selectedOptions.length === 1");
    browser.picture("residuals");
    set(&mut browser, "#reason", "the \"door\" was open");
    browser.value("document.getElementById('residuals-form').requestSubmit()");
    browser.until("residuals.rows.length === 5 && !flight");
    browser.until(&format!("{DOCUMENT}.includes('was open')"));
    browser.presses("s", 2);
    browser.until("document.getElementById('status').textContent.startsWith('Saved')");
    let saved = served.text("rate.toml");
    assert!(
        saved.ends_with("[[left_out]]\nlines = [5]\nreason = \"the \\\"door\\\" was open\"\n"),
        "{saved}"
    );
}

/// Keys, words, units, functions and names are completed at the caret, by keyboard.
#[test]
fn what_was_begun_is_completed() {
    let Some((_served, mut browser)) = opened("browser-complete", &[("a.toml", BUDGET)], "en-GB")
    else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    let written = |browser: &mut Browser, begun: &str, typed: &str| {
        let begun = json!(begun);
        browser.value(&format!(
            "text.focus(), text.value = {begun}, text.setSelectionRange(text.value.length, text.value.length)"
        ));
        browser.types(typed);
        browser.until("complete.offers.length && !document.getElementById('offers').hidden");
        browser.presses("Tab", 0);
        browser.until("document.getElementById('offers').hidden");
        browser.value("text.value")
    };
    for (begun, typed, whole) in [
        ("[input.x]\nhalf", "_", "[input.x]\nhalf_width = "),
        (
            "[input]\nx = { value = 1, distri",
            "b",
            "[input]\nx = { value = 1, distribution = ",
        ),
        (
            "[input.x]\ndistribution = \"no",
            "r",
            "[input.x]\ndistribution = \"normal",
        ),
        (
            "[input.mass]\nvalue = 1\n[measurand.Y]\nmodel = \"2 * ma",
            "s",
            "[input.mass]\nvalue = 1\n[measurand.Y]\nmodel = \"2 * mass",
        ),
        (
            "[measurand.Y]\nmodel = \"sq",
            "r",
            "[measurand.Y]\nmodel = \"sqrt(",
        ),
        ("[input.x]\nunit = \"m", "i", "[input.x]\nunit = \"min"),
        ("[mon", "t", "[monte_carlo"),
        (
            "[input.x]\ncomponents = [{ u = 1 }, { na",
            "m",
            "[input.x]\ncomponents = [{ u = 1 }, { name = ",
        ),
    ] {
        let found = written(&mut browser, begun, typed);
        assert_eq!(found, whole);
    }
    // Asked for where nothing was begun; closed without a trace.
    browser.value("text.value = 'profile = ', text.setSelectionRange(10, 10)");
    browser.presses(" ", 2);
    browser.until("complete.offers.some(offer => offer.name === 'JJF')");
    browser.presses("ArrowDown", 0);
    browser.until("text.getAttribute('aria-activedescendant') === 'offer-1'");
    browser.presses("Escape", 0);
    browser.until("document.getElementById('offers').hidden");
    assert_eq!(browser.value("text.value"), "profile = ");
}

impl Browser {
    /// Goes on with the Tab key to the field of an entry.
    fn goes_to(&mut self, entry: &str) {
        let there = format!("document.activeElement.dataset.at === {}", json!(entry));
        for _ in 0..80 {
            if self.value(&there) == true {
                return;
            }
            self.presses("Tab", 0);
            self.value("form.queue.then(() => true)");
        }
        panic!("{entry}\n{}", self.value("$('form').innerText"));
    }

    /// Writes into the field of an entry, by keyboard.
    fn writes(&mut self, entry: &str, text: &str) {
        self.goes_to(entry);
        self.value("document.activeElement.select()");
        self.types(text);
    }
}

fn chooses(browser: &mut Browser, entry: &str, word: &str) {
    set(browser, &format!("[data-at='{entry}']"), word);
    browser.value("form.queue.then(() => true)");
}

/// From nothing to a statement without a look at the text: a budget by the form, its fields reached and filled by keyboard.
#[test]
fn a_budget_is_made_in_the_form() {
    let Some((served, mut browser)) = opened("browser-form", &[], "en-GB") else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('No budget here yet')"));
    browser.value("document.getElementById('new').click()");
    browser.until("document.getElementById('ask').open");
    browser.value("document.getElementById('other').click()");
    browser.until("document.activeElement.dataset.at === '[\"title\"]'");
    browser.types("Resistance of a \"resistor\"");
    browser.writes(r#"["measurand","+"]"#, "R");
    browser.presses("Enter", 0);
    browser.writes(r#"["measurand","R","model"]"#, "V / I");
    browser.writes(r#"["measurand","R","unit"]"#, "ohm");
    browser.writes(r#"["input","+"]"#, "V");
    browser.presses("Enter", 0);
    browser.writes(r#"["input","V","value"]"#, "10.00010");
    browser.writes(r#"["input","V","unit"]"#, "V");
    browser.goes_to(r#"["input","V","?"]"#);
    chooses(&mut browser, r#"["input","V","?"]"#, "certificate");
    browser.writes(r#"["input","V","certificate","U"]"#, "0.5 mV");
    browser.writes(r#"["input","V","certificate","k"]"#, "2");
    browser.writes(r#"["input","+"]"#, "I");
    browser.presses("Enter", 0);
    browser.writes(r#"["input","I","value"]"#, "2,0");
    browser.writes(r#"["input","I","unit"]"#, "mA");
    // The fault is said at its field, with what to write.
    let field = r#"document.querySelector('[data-at=\'["input","I","value"]\'][aria-invalid]')"#;
    browser.until(field);
    browser.until(&format!(
        "document.getElementById({field}.getAttribute('aria-describedby')).textContent.includes('decimal point: 2.0')"
    ));
    chooses(&mut browser, r#"["input","I","value"]"#, "2.0");
    chooses(&mut browser, r#"["input","I","?"]"#, "half_width");
    browser.writes(r#"["input","I","half_width"]"#, "0.010");
    browser.presses("Tab", 0);
    browser.until(&format!(
        "{DOCUMENT}.includes('Statement') && !document.querySelector('#faults li') && !flight"
    ));
    browser.presses("s", 2);
    browser.until("document.getElementById('status').textContent.startsWith('Saved')");
    let file = served.text("budget.toml");
    assert_eq!(
        file,
        "title = \"Resistance of a \\\"resistor\\\"\"\n\n[measurand.R]\nmodel = \"V / I\"\nunit = \"ohm\"\n\n\
         [input.V]\nvalue = 10.00010\nunit = \"V\"\ncertificate = { U = \"0.5 mV\", k = 2 }\n\n\
         [input.I]\nvalue = 2.0\nunit = \"mA\"\nhalf_width = 0.010\n"
    );
    // A second reason for doubt, a coefficient, another name; then none of them.
    browser.value(r#"document.querySelector('[data-at=\'["input","I","+"]\']').click(), form.queue.then(() => true)"#);
    chooses(
        &mut browser,
        r#"["input","I","components",1,"name"]"#,
        "drift",
    );
    chooses(
        &mut browser,
        r#"["input","I","components",1,"?"]"#,
        "readings",
    );
    chooses(
        &mut browser,
        r#"["input","I","components",1,"readings"]"#,
        "2.0, 2.01, 1.990, 2.005",
    );
    browser.until(&format!("{DOCUMENT}.includes('drift') && !flight"));
    browser.value("$('form').scrollTop = 0");
    browser.picture("form");
    let media = json!({ "features": [{ "name": "prefers-color-scheme", "value": "dark" }] });
    browser.call("Emulation.setEmulatedMedia", media);
    set(&mut browser, "#language", "zh");
    browser.until(&format!("{DOCUMENT}.includes('不确定度') && !flight"));
    browser.value("form.queue.then(() => true)");
    browser.picture("form-zh-dark");
    browser.value(r#"document.querySelector('[data-at=\'["correlation","+"]\']').click(), form.queue.then(() => true)"#);
    chooses(&mut browser, r#"["correlation",0,"between"]"#, "V, I");
    chooses(&mut browser, r#"["correlation",0,"r"]"#, "0.25");
    chooses(&mut browser, r#"["input","V","!"]"#, "U_x");
    let text = browser.value("text.value");
    let text = text.as_str().expect("a text");
    for part in [
        "model = \"U_x / I\"",
        "[input.U_x]\nvalue = 10.00010\n",
        "components = [\n    { half_width = 0.010 },\n    { name = \"drift\", readings = [2.0, 2.01, 1.990, 2.005] },\n]\n",
        "[[correlation]]\nbetween = [\"U_x\", \"I\"]\nr = 0.25\n",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    // A row moves with its button, and back with the key of the one that has the focus then.
    browser.value(r#"document.querySelector('[data-row=\'["input","I","components",1]\'] .moves button').click(), form.queue.then(() => true)"#);
    let drift_first = "components = [\n    { name = \"drift\", readings = [2.0, 2.01, 1.990, 2.005] },\n    { half_width = 0.010 },\n]\n";
    let moved = browser.value("text.value");
    assert!(
        moved.as_str().expect("a text").contains(drift_first),
        "{moved}"
    );
    browser.presses(" ", 0);
    browser.until("text.value.includes('components = [\\n    { half_width = 0.010 }')");
    browser.value("form.queue.then(() => true)");
    for row in [r#"["correlation",0]"#, r#"["input","I","components",1]"#] {
        browser.value(&format!(
            "document.querySelector('[data-row=\\'{row}\\'] .remove').click(), form.queue.then(() => true)"
        ));
    }
    let text = browser.value("text.value");
    let text = text.as_str().expect("a text");
    assert!(
        !text.contains("correlation") && !text.contains("drift"),
        "{text}"
    );
}

/// What is edited in the text shows in the form; an edit in the form leaves every other byte; a text that cannot be read
/// leaves the form to be read only.
#[test]
fn the_form_and_the_text_are_one_file() {
    let text = "# mine\ntitle=\"T\"   # kept\n[measurand.Y]\nmodel = \"a * b\"\nunit = \"V\"\n\n\n[input]\n\
        a = { value = 2.00, unit = \"V\", u = 0.1 } # a\nb = {value=3,u=0.01}\n";
    let Some((_served, mut browser)) = opened("browser-both", &[("a.toml", text)], "en-GB") else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    browser.value("document.getElementById('as-form').click(), form.queue.then(() => true)");
    browser.until(
        "document.querySelector('[data-at=\\'[\"input\",\"a\",\"value\"]\\']').value === '2.00'",
    );
    assert_eq!(browser.value("text.value"), text);
    chooses(&mut browser, r#"["input","b","u"]"#, "0.020");
    assert_eq!(browser.value("text.value"), text.replace("0.01}", "0.020}"));
    browser.value("document.getElementById('as-text').click(), text.value = text.value.replace('2.00', '2.50 V'), text.dispatchEvent(new Event('input'))");
    browser.until("document.querySelector('#faults li') && !flight");
    browser.value("document.getElementById('as-form').click(), form.queue.then(() => true)");
    browser.until("document.querySelector('#form .all').disabled");
    assert_eq!(
        browser.value("getComputedStyle($('editor')).display"),
        "none"
    );
    browser.value("document.querySelector('#faults button').click()");
    browser.until("document.activeElement === text");
    browser.value(
        "text.value = text.value.replace('2.50 V', '2.50'), text.dispatchEvent(new Event('input'))",
    );
    browser.value("document.getElementById('as-form').click(), form.queue.then(() => true)");
    browser.until(
        "document.querySelector('[data-at=\\'[\"input\",\"a\",\"value\"]\\']').value === '2.50'",
    );
}

/// What the page shows is accessible by axe-core: with everything open, in the light and in the dark; at 200 % nothing
/// is cut off; the Tab key reaches every part and is caught by none.
#[test]
fn the_page_is_accessible() {
    let files = [("a.toml", BUDGET), ("rate.toml", RATE), ("run.csv", RUN)];
    let Some((_served, mut browser)) = opened("browser-access", &files, "en-GB") else {
        return;
    };
    browser.until(&format!("{DOCUMENT}.includes('Statement')"));
    browser.value("document.getElementById('what-if').open = true");
    let axe = std::env::var("GUMPTION_AXE").ok();
    let axe = axe.and_then(|path| std::fs::read_to_string(path).ok());
    if axe.is_none() {
        eprintln!("skipped: GUMPTION_AXE names no axe.min.js");
    }
    let check = |browser: &mut Browser, what: &str| {
        for colours in ["light", "dark"] {
            let media =
                json!({ "features": [{ "name": "prefers-color-scheme", "value": colours }] });
            browser.call("Emulation.setEmulatedMedia", media);
            let Some(axe) = &axe else { continue };
            browser.value(&format!("{axe}; true"));
            // The document is checked as a page of its own.
            let found = browser.value(
                "axe.run({ exclude: ['#document'] }).then(found => found.violations.map(one => one.id + ': ' + one.nodes.map(node => node.html.slice(0, 160)).join(' ')))",
            );
            assert_eq!(found, json!([]), "{what}, {colours}");
        }
    };
    check(&mut browser, "what if");
    browser.value("text.focus(), text.setSelectionRange(0, 0)");
    browser.presses(" ", 2);
    browser.until("!document.getElementById('offers').hidden");
    check(&mut browser, "completion");
    browser.picture("completion-dark");
    browser.presses("Escape", 0);
    browser.value("document.getElementById('as-form').click(), form.queue.then(() => true)");
    chooses(&mut browser, r#"["input","a","u"]"#, "much");
    browser.until("document.querySelector('[aria-invalid]')");
    check(&mut browser, "form");
    let narrow = json!({ "width": 700, "height": 450, "deviceScaleFactor": 2, "mobile": false });
    browser.call("Emulation.setDeviceMetricsOverride", narrow);
    assert_eq!(
        browser.value("document.documentElement.scrollWidth <= innerWidth && $('form').scrollWidth <= $('form').clientWidth"),
        true
    );
    browser.call("Emulation.clearDeviceMetricsOverride", json!({}));
    browser.value("document.getElementById('as-text').click()");
    browser.presses("Escape", 0);
    set(&mut browser, "#exercise-kind", "budget");
    browser.until("practice.open && !flight");
    browser.value("document.querySelector('[value=slips]').click()");
    check(&mut browser, "exercise");
    browser.value("document.getElementById('leave-exercise').click()");
    browser.until("!practice.open && !flight");
    browser.value("open('rate.toml')");
    browser.until("residuals.rows.length && !flight");
    browser.value("document.getElementById('residuals').open = true");
    check(&mut browser, "residuals");
    browser.value("document.getElementById('new').click()");
    browser.until("document.getElementById('ask').open");
    check(&mut browser, "dialog");
    browser.presses("Escape", 0);
    browser.until("!document.getElementById('ask').open");
    // 200 % on a window of 1400 pixels.
    let zoomed = json!({ "width": 700, "height": 450, "deviceScaleFactor": 2, "mobile": false });
    browser.call("Emulation.setDeviceMetricsOverride", zoomed);
    assert_eq!(
        browser.value("document.documentElement.scrollWidth <= innerWidth"),
        true
    );
    browser.value("document.activeElement.blur(), window.reached = new Set()");
    for _ in 0..60 {
        browser.presses("Tab", 0);
        browser.value("window.reached.add(document.activeElement.id)");
    }
    for part in [
        "file",
        "new",
        "save",
        "pick",
        "format",
        "lesson",
        "exercise-kind",
        "language",
        "as-form",
        "text",
        "calibrate",
        "diagnose",
        "reason",
        "rows",
    ] {
        assert_eq!(
            browser.value(&format!("window.reached.has('{part}')")),
            true,
            "{part}"
        );
    }
}
