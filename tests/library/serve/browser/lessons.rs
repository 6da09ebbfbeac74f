//! Lessons and exercises.

use super::*;

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
