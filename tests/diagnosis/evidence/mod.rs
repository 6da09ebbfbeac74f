//! The statistics of diagnosis on four rigs as matrices: false alarms, detection, naming, lists, effects
//! outside the catalogue.
//!
//! The small runs hold the machinery to wide limits. The figures of a full run are printed by
//! `cargo test --release --test diagnosis evidence -- --ignored --nocapture`.

mod bench;
mod grade;
mod rigs;

use std::collections::BTreeMap;

use bench::Bench;
use grade::{Grade, Open, Share, grade, grade_open, grade_several};
use gumption::diagnose::evidence::{State, Verdict};
use nalgebra::DVector;

/// Alarms and unique names among recordings of nothing.
fn nulls(count: u64) -> (Share, Share) {
    let (mut alarms, mut names) = (Share::default(), Share::default());
    for bench in Bench::all(1) {
        for k in 0..count {
            let found = bench.examine(&bench.nothing(), &bench.rig.atoms, 11, k);
            let alarm = found.verdict != Verdict::None;
            alarms.count(alarm);
            names.count(alarm && found.slots.iter().any(|s| s.state == State::Identified));
        }
    }
    (alarms, names)
}

/// Single effects of one strength in all rigs, with their κ.
fn singles(lambda: f64, count: u64) -> Vec<(f64, Grade)> {
    let mut grades = Vec::new();
    for (place, bench) in Bench::all(1).iter().enumerate() {
        for k in 0..count {
            let stream = place as u64 * 1_000_000 + 4 * k;
            let hidden = bench.hide(lambda, 5, stream);
            let found = bench.examine(&hidden.effect, &bench.rig.atoms, 5, stream + 2);
            grades.push((hidden.kappa, grade(&found, &hidden, lambda)));
        }
    }
    grades
}

/// Single effects that are at least 5 σ away from every other candidate, with their own taken away.
fn opened(lambda: f64, count: u64) -> Vec<Open> {
    let mut grades = Vec::new();
    for (place, bench) in Bench::all(1).iter().enumerate() {
        let far = (0..)
            .map(|k| place as u64 * 1_000_000 + 4 * k)
            .map(|stream| (stream, bench.hide(lambda, 6, stream)))
            .filter(|(_, hidden)| hidden.kappa >= 5.0);
        for (stream, hidden) in far.take(count as usize) {
            let atoms = bench.without(hidden.candidate);
            grades.push(grade_open(&bench.examine(
                &hidden.effect,
                &atoms,
                6,
                stream + 2,
            )));
        }
    }
    grades
}

/// Several different effects of one strength at once.
fn several(effects: usize, lambda: f64, count: u64) -> BTreeMap<&'static str, u64> {
    let mut tally = BTreeMap::new();
    for (place, bench) in Bench::all(1).iter().enumerate() {
        for k in 0..count {
            let stream = place as u64 * 1_000_000 + 64 * k;
            let mut truths: Vec<usize> = Vec::new();
            let mut sum: DVector<f64> = bench.nothing();
            let mut draw = stream;
            while truths.len() < effects {
                let hidden = bench.hide(lambda, 7, draw);
                draw += 1;
                if !truths.contains(&hidden.candidate) {
                    truths.push(hidden.candidate);
                    sum += hidden.effect;
                }
            }
            let found = bench.examine(&sum, &bench.rig.atoms, 7, stream + 63);
            *tally.entry(grade_several(&found, &truths)).or_default() += 1;
        }
    }
    tally
}

fn share_of(grades: &[(f64, Grade)], wanted: &[Grade]) -> Share {
    let mut share = Share::default();
    for (_, grade) in grades {
        share.count(wanted.contains(grade));
    }
    share
}

#[test]
fn nothing_gives_few_alarms() {
    let (alarms, names) = nulls(30);
    // 120 recordings at α = 1 %: 1.2 expected, more than 6 with a probability of 10⁻³.
    assert!(alarms.hits <= 6, "{alarms}");
    assert!(names.hits <= 3, "{names}");
}

#[test]
fn strong_effects_are_found_and_named_or_listed() {
    let grades = singles(12.0, 6);
    let good = share_of(&grades, &[Grade::Right, Grade::Listed]);
    assert!(good.hits >= 20, "{good}");
    assert_eq!(share_of(&grades, &[Grade::Miss]).hits, 0);
    assert!(share_of(&grades, &[Grade::Overclaim, Grade::WrongName]).hits <= 1);
}

#[test]
fn effects_outside_the_catalogue_are_mostly_unexplained() {
    let grades = opened(12.0, 4);
    let unexplained = grades.iter().filter(|g| **g == Open::Unexplained).count();
    assert!(unexplained >= 11, "{grades:?}");
}

#[test]
fn two_strong_effects_are_both_found() {
    let tally = several(2, 20.0, 3);
    let of = |grade| tally.get(grade).copied().unwrap_or(0);
    assert!(of("right") + of("listed") >= 9, "{tally:?}");
    // Kip and K2 together are what an eccentric encoder alone is (one mount).
    assert!(of("wrong name") <= 1, "{tally:?}");
}

/// The answer does not depend on the number of threads or on the order of the work: it is the same
/// when asked again.
#[test]
fn the_answer_is_reproducible() {
    let bench = &Bench::all(2)[0];
    let hidden = bench.hide(8.0, 3, 4);
    let ask = || bench.examine(&hidden.effect, &bench.rig.atoms, 3, 5);
    let (first, second) = (ask(), ask());
    assert_eq!(format!("{first:?}"), format!("{second:?}"));
}

/// Everything, with figures; a quarter of an hour on two cores.
#[test]
#[ignore = "a full measurement; prints figures"]
fn measured() {
    let (alarms, names) = nulls(1250);
    println!("nothing: alarms {alarms}, unique names {names}");
    let mut far = Vec::new();
    for lambda in [3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 25.0] {
        let grades = singles(lambda, 100);
        let each: Vec<String> = Grade::ALL
            .iter()
            .map(|g| format!("{g:?} {}", share_of(&grades, &[*g])))
            .collect();
        println!("λ {lambda}: {}", each.join(", "));
        if lambda >= 8.0 {
            far.extend(grades.into_iter().filter(|(kappa, _)| *kappa >= 6.0));
        }
    }
    println!("λ ≥ 8 and κ ≥ 6: right {}", share_of(&far, &[Grade::Right]));
    let open = opened(12.0, 50);
    for grade in Open::ALL {
        let mut share = Share::default();
        open.iter().for_each(|g| share.count(*g == grade));
        println!("outside the catalogue: {grade:?} {share}");
    }
    for (effects, lambda) in [(2, 10.0), (2, 20.0), (3, 20.0)] {
        println!(
            "{effects} effects of λ {lambda}: {:?}",
            several(effects, lambda, 25)
        );
    }
}
