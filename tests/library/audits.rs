//! Sealed budgets, audited: what is called sound is printed as it is claimed.

use gumption::audit::read::Mapping;
use gumption::audit::{Audit, Verdict, audit, claims};
use gumption::challenge::budget;

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
