//! Files dropped on the page, and what it hands out.

use super::*;

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
