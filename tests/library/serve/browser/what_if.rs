//! Sliders: what if, and how many readings.

use super::*;

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
