//! The page by axe-core, enlarged, and by the Tab key.

use super::form::chooses;
use super::*;

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
