//! What is measured: each measure once, with its definition and the floor that it has to keep.

use super::further::{Decision, Sequel};
use super::rate::Rate;
use super::record::{Outcome, Record};
use super::trial::Ablation;
use crate::grade::Finding;
use crate::scenario::{Class, NoiseKnowledge};
use gumption_core::statistics::median;

/// What a share has to keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Floor {
    /// Percent at most.
    AtMost(f64),
    /// Percent at least.
    AtLeast(f64),
    /// Percent from and to.
    Between(f64, f64),
    /// Nothing; it is told.
    Told,
}

impl Floor {
    /// Whether a share keeps it; nothing where there is none.
    fn holds(self, rate: Rate) -> Option<bool> {
        let percent = 100.0 * rate.share();
        match self {
            _ if rate.of == 0 => None,
            Floor::AtMost(most) => Some(percent <= most),
            Floor::AtLeast(least) => Some(percent >= least),
            Floor::Between(low, high) => Some((low..=high).contains(&percent)),
            Floor::Told => None,
        }
    }
}

impl std::fmt::Display for Floor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Floor::AtMost(most) => write!(f, "≤ {most} %"),
            Floor::AtLeast(least) => write!(f, "≥ {least} %"),
            Floor::Between(low, high) => write!(f, "{low}–{high} %"),
            Floor::Told => f.write_str("–"),
        }
    }
}

/// A measure with what was obtained.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// What it is.
    pub name: String,
    /// Of which cases, and what counts.
    pub definition: &'static str,
    /// What it has to keep.
    pub floor: Floor,
    /// What was obtained.
    pub rate: Rate,
}

impl Measure {
    /// Whether the floor is kept.
    pub fn holds(&self) -> Option<bool> {
        self.floor.holds(self.rate)
    }
}

/// λ from which an effect has to be detected and listed.
const PLAIN: f64 = 8.0;
/// λ from which a departure of 30 % from its shape would be seen: 0.3 λ ≥ 4.
const SEVERE: f64 = 13.0;
/// κ from which rivals are apart.
const APART: f64 = 6.0;
/// κ from which the nearest kin is apart where the true name is taken out.
const KIN: f64 = 5.0;
/// λ that nobody overlooks; strengths are within 10 % of what was asked for.
const OBVIOUS: f64 = 36.0;

/// The measures of the records of a study.
pub fn measures(records: &[Record]) -> Vec<Measure> {
    let whole = |class: Class| {
        records
            .iter()
            .filter(move |r| r.is_whole() && r.class == class)
    };
    let effects = |class: Class| whole(class).flat_map(|r| r.outcomes.iter().map(move |o| (r, o)));
    let single = |least: f64| effects(Class::Single).filter(move |(_, o)| o.lambda >= least);
    let noisy = |class, noise| whole(class).filter(move |r| r.noise == noise);
    let wrong = |r: &&Record| !r.wrong_names.is_empty();
    let acts = |r: &&Record| !r.wrong_likes.is_empty();
    let noticed = |r: &&Record| r.noticed;
    let is_strong = |o: &Outcome| o.lambda >= OBVIOUS;
    let taken = || {
        records
            .iter()
            .filter(|r| r.ablation == Ablation::WithoutTruth)
    };
    let strong_taken = || taken().filter(|r| r.outcomes.iter().all(|o| o.lambda >= PLAIN));
    let all_whole = || records.iter().filter(|r| r.is_whole());
    let outcomes = || all_whole().flat_map(|r| &r.outcomes);
    let mut all = Vec::new();
    let mut add = |name: String, definition: &'static str, floor: Floor, rate: Rate| {
        all.push(Measure {
            name,
            definition,
            floor,
            rate,
        });
    };
    for (noise, word) in NoiseKnowledge::ALL {
        let most = if noise == NoiseKnowledge::StatedCorrelated {
            3.0
        } else {
            1.5
        };
        add(
            format!("alarms, noise {word}"),
            "cases in which nothing is concealed; a verdict other than that recording and model agree",
            Floor::AtMost(most),
            Rate::count(noisy(Class::Null, noise), noticed),
        );
    }
    add(
        "detected".into(),
        "one effect with a name, λ ≥ 8; a verdict other than that recording and model agree",
        Floor::AtLeast(99.0),
        Rate::count(single(PLAIN), |(r, _)| r.noticed),
    );
    add(
        "named or listed".into(),
        "one effect with a name, λ ≥ 8; a right name identified, acted like, or in the list",
        Floor::AtLeast(97.0),
        Rate::count(single(PLAIN), |(_, o)| o.is_named_or_listed()),
    );
    add(
        "lists of at most six".into(),
        "lists of names in all whole cases; those with six names or fewer",
        Floor::AtLeast(90.0),
        Rate::count(all_whole().flat_map(|r| &r.lists), |length| **length <= 6),
    );
    let separate = single(SEVERE).filter(|(_, o)| o.kappa >= APART);
    add(
        "right and identified".into(),
        "one effect with a name, λ ≥ 13, every rival of simulator and catalogue at κ ≥ 6; its name identified",
        Floor::AtLeast(95.0),
        Rate::count(separate, |(_, o)| o.finding == Finding::Identified),
    );
    let separate = single(PLAIN).filter(|(_, o)| o.kappa >= APART);
    add(
        "right and alone".into(),
        "one effect with a name, λ ≥ 8, every rival at κ ≥ 6; its name identified or acted like",
        Floor::Told,
        Rate::count(separate, |(_, o)| o.is_alone()),
    );
    add(
        "wrongly identified, nothing concealed".into(),
        "cases in which nothing is concealed; with an identified name",
        Floor::Told,
        Rate::count(whole(Class::Null), wrong),
    );
    add(
        "wrongly identified, one effect".into(),
        "cases with one effect, of any strength; with an identified name that is not right",
        Floor::AtMost(0.3),
        Rate::count(whole(Class::Single), wrong),
    );
    add(
        "wrongly identified, two effects".into(),
        "cases with two effects or three; with an identified name that is right for none",
        Floor::AtMost(1.0),
        Rate::count(whole(Class::Double), wrong),
    );
    add(
        "wrongly identified, outside the catalogue".into(),
        "cases with something that no catalogue names, of any strength; with an identified name",
        Floor::AtMost(3.0),
        Rate::count(whole(Class::Outside), wrong),
    );
    add(
        "wrongly identified, true name taken out".into(),
        "one effect of λ ≥ 8 whose right names are excluded; with an identified name",
        Floor::AtMost(15.0),
        Rate::count(strong_taken(), wrong),
    );
    let apart = strong_taken().filter(|r| r.outcomes.iter().all(|o| o.kappa >= KIN));
    add(
        "wrongly identified, true name taken out, kin apart".into(),
        "the same where the nearest kin leaves κ ≥ 5",
        Floor::AtMost(8.0),
        Rate::count(apart, wrong),
    );
    add(
        "wrongly acts like, one effect".into(),
        "cases with one effect; with a name that it acts like and that is not right",
        Floor::Told,
        Rate::count(whole(Class::Single), acts),
    );
    add(
        "wrongly acts like, outside the catalogue".into(),
        "cases with something that no catalogue names; with a name that it acts like",
        Floor::AtMost(10.0),
        Rate::count(whole(Class::Outside), acts),
    );
    for (noise, word) in NoiseKnowledge::ALL {
        let strong = noisy(Class::Outside, noise).filter(|r| r.outcomes.iter().all(is_strong));
        add(
            format!("noticed at λ = 40, noise {word}"),
            "something that no catalogue names, made as strong as λ = 40 (36 at least); a verdict other than that \
             recording and model agree",
            Floor::AtLeast(97.0),
            Rate::count(strong, noticed),
        );
    }
    let pairs = || whole(Class::Double).filter(|r| r.outcomes.iter().all(|o| o.lambda >= PLAIN));
    add(
        "two effects, both named or listed".into(),
        "cases with two effects or three, each λ ≥ 8 beside the others; right names of all are there",
        Floor::AtLeast(80.0),
        Rate::count(pairs(), |r| {
            r.outcomes.iter().all(Outcome::is_named_or_listed)
        }),
    );
    add(
        "two effects, both alone".into(),
        "the same cases; each has its name alone",
        Floor::Told,
        Rate::count(pairs(), |r| r.outcomes.iter().all(Outcome::is_alone)),
    );
    let loops = all_whole().filter(|r| {
        r.class == Class::Single && r.outcomes.iter().any(|o| o.physics == "hysteresis")
    });
    add(
        "hysteresis identified as lag".into(),
        "one effect, a hysteresis; a lag identified or acted like",
        Floor::AtMost(0.0),
        Rate::count(loops, |r| {
            r.wrong_names
                .iter()
                .chain(&r.wrong_likes)
                .any(|name| name == "lag")
        }),
    );
    // How far a label slipped is no size of an effect.
    let sizes = outcomes()
        .filter(|o| o.physics != "swapped-label")
        .filter_map(|o| o.deviation);
    add(
        "size in its 95 % interval".into(),
        "right names that stand alone with one size; the size with which the named effect comes nearest to what was \
         concealed (noise-free twins) is in the interval",
        Floor::Between(93.0, 97.0),
        Rate::count(sizes, |deviation| deviation.abs() <= 1.0),
    );
    let predicted = effects(Class::Single)
        .filter(|(_, o)| o.is_named_or_listed() && !o.once)
        .filter_map(|(r, _)| r.predicted);
    add(
        "fresh recording predicted".into(),
        "one effect whose right name is alone or listed and that does not happen once (a jump, a wrong reading); the error of the prediction of a fresh recording (root mean \
         square) within 1.2 times the true noise of its rows",
        Floor::AtLeast(93.0),
        Rate::count(predicted, |ratio| *ratio <= 1.2),
    );
    for (noise, word) in NoiseKnowledge::ALL {
        let ratios = noisy(Class::Null, noise).filter_map(|r| r.predicted);
        add(
            format!("fresh recording predicted, nothing concealed, noise {word}"),
            "cases in which nothing is concealed, so that the declared model is the truth; the error of its prediction of a \
             fresh recording within 1.2 times the true noise of its rows",
            Floor::Told,
            Rate::count(ratios, |ratio| *ratio <= 1.2),
        );
    }
    let located = outcomes().filter_map(|o| o.located);
    add(
        "axis or moment stated wrongly".into(),
        "right names that stand alone and state an axis or a moment; another one, or more than 1.5 rows away",
        Floor::AtMost(2.0),
        Rate::count(located, |right| !right),
    );
    let aliased = outcomes().filter(|o| o.finding == Finding::Identified);
    add(
        "identified though another gives the same recording".into(),
        "right names that are identified; a rival leaves less than 5 % of the effect",
        Floor::AtMost(0.0),
        Rate::count(aliased, |o| o.overclaimed),
    );
    let made = all_whole()
        .filter_map(|r| r.further.as_ref())
        .filter_map(|sequel| match sequel {
            Sequel::Made(_, decision) => Some(*decision),
            _ => None,
        });
    add(
        "recommended measurement decides".into(),
        "lists of one effect of λ ≥ 8 on a rig for which a measurement promises to decide with 95 %, made by the \
         simulator; the right name, alone or with names that say the same of every measurement",
        Floor::AtLeast(95.0),
        Rate::count(made, |d| matches!(d, Decision::Resolved | Decision::Class)),
    );
    all
}

/// Median of the seconds that a diagnosis took.
pub(super) fn median_seconds(records: &[Record]) -> f64 {
    let seconds = records.iter().map(|r| r.seconds);
    median(seconds.filter(|s| s.is_finite()).collect())
}
