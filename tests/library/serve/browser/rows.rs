//! Rows of a recording that are left out.

use super::*;

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
