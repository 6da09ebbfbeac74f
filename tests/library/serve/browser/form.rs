//! The form of a budget, by keyboard.

use super::*;

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

pub fn chooses(browser: &mut Browser, entry: &str, word: &str) {
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
