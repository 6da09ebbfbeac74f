//! Sealed budgets, audited: what is called sound is printed as it is claimed.

use gumption::audit::read::Mapping;
use gumption::audit::{Audit, Verdict, audit, claims};
use gumption::challenge::budget;
use gumption::render::{FORMATS, Page};
use gumption::report::{self, Language};

/// Whether the recomputed U, rounded to nearest or up, is what is claimed.
fn is_printed_as_claimed(audited: &Audit<'_>) -> bool {
    let found = &audited.found;
    let Some(claimed) = &found.case.claimed.footer.expanded else {
        return true;
    };
    let open = found.open * found.right.expanded / found.right.u_c;
    let above = claimed.value - found.right.expanded;
    let half = claimed.half_of_digits();
    let tolerance = 1e-6 * (half + claimed.value);
    (-half - open - tolerance..2.0 * half + open + tolerance).contains(&above)
}

/// Of every layout and file: sound sheets, and those with a slip that printed digits hide.
#[test]
fn no_sound_verdict_beside_another_u() {
    let mut sound = 0;
    for number in 1..=200 {
        let sealed = budget::sheet(20_261_124, number);
        let name = format!("{number}.{}", sealed.ending);
        for claimed in claims(&name, &sealed.bytes, &Mapping::default()).unwrap() {
            let audited = audit(&claimed);
            if audited.verdict == Verdict::Sound {
                sound += 1;
                assert!(
                    is_printed_as_claimed(&audited),
                    "{name}: {:?}",
                    sealed.truth
                );
            }
        }
    }
    assert!(sound > 10, "{sound}");
}

/// √(0.025² + 0.005²/3 + 0.02²) = 0.032146: U is right, u_c is not.
#[test]
fn the_figure_that_departs_is_told() {
    let sheet = "Pressure gauge\nSource,Distribution,Half-width / kPa,Divisor,u / kPa\n\
                 certificate U = 0.05 kPa,normal,0.05,2,0.0250\n\
                 resolution 0.01 kPa,rectangular,0.005,√3,0.0029\n\
                 repeatability,normal,0.02,1,0.0200\n\
                 Combined standard uncertainty,,,,0.0332\nExpanded uncertainty (k = 2),,,,0.064\n";
    let found = claims("sheet.csv", sheet.as_bytes(), &Mapping::default()).unwrap();
    let document = report::audit("sheet.csv", &[audit(&found[0])], Language::English);
    let markdown = FORMATS.iter().find(|format| format.name == "markdown");
    let markdown = (markdown.expect("Markdown").render)(&document, &Page::default());
    let text = String::from_utf8(markdown.expect("it fits")).expect("text");
    let wanted = "u_c is 0.032146 kPa where 0.0332 kPa is claimed; U is 0.064 kPa, as claimed.";
    assert!(text.contains(wanted), "{text}");
}
