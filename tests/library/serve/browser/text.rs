//! The text: mended, completed, compared with what was saved.

use super::*;

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
