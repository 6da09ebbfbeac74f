//! A sealed budget from a seed.

use rand::RngExt;
use rand::seq::IndexedRandom;

use super::laboratory::{Budget, draw};
use super::page::{Form, Manner, manner, pages};
use super::paper::Paper;
use super::spoil::{Slip, possible, spoil};
use super::working::Working;
use crate::random::{Random, Stream, source};

/// A claimed budget, and the truth about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Ending of the file.
    pub ending: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
    /// Symbols of its rows, as answers name them.
    pub symbols: Vec<&'static str>,
    /// What is in it.
    pub truth: SheetTruth,
}

/// The truth about a claimed budget.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SheetTruth {
    /// `sound`, `slips` or `unexplained`.
    pub verdict: String,
    /// The slips, as in the neutral answer form.
    pub slips: Vec<String>,
    /// The combined standard uncertainty that is right.
    pub u_c: f64,
    /// The expanded uncertainty that is right, not rounded.
    #[serde(rename = "U")]
    pub expanded: f64,
    /// The layout.
    pub layout: String,
    /// Other sets of slips, no larger than the true one, that would give the same sheet to every digit.
    pub rivals: usize,
}

/// The `number`-th budget of a seed.
pub fn sheet(seed: u64, number: u64) -> Sheet {
    let mut random = source(seed, Stream::Case, number);
    loop {
        if let Some(sheet) = attempt(&mut random) {
            return sheet;
        }
    }
}

/// What is to be concealed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Concealed {
    Nothing,
    One,
    Two,
    Strange,
}

fn attempt(random: &mut Random) -> Option<Sheet> {
    // 15 % sound, 10 % that nothing explains, 20 % pairs.
    let what = match random.random_range(0..100) {
        0..15 => Concealed::Nothing,
        15..25 => Concealed::Strange,
        25..45 => Concealed::Two,
        _ => Concealed::One,
    };
    let mut budget = draw(random);
    let manner = manner(random);
    let of_reading =
        |item: &super::laboratory::Item| matches!(item.known, super::quantity::Known::OfReading(_));
    if budget.items.iter().any(of_reading) && !manner.form.has_estimates() {
        return None;
    }
    let right = Working::right(&budget);
    let figures = right.figures();
    if random.random_bool(0.15) {
        budget.cmc = super::words::plain(figures.expanded * random.random_range(0.7..1.4), 2)
            .parse()
            .ok();
    }
    let right = Working::right(&budget);
    let figures = right.figures();
    let mut working = right.clone();
    let slips = choose(random, &budget, what);
    slips
        .iter()
        .for_each(|slip| spoil(&budget, slip, &mut working));
    if what == Concealed::Strange {
        working.strange = random.random_range(1.06..1.6);
        if random.random_bool(0.5) {
            working.strange = 1.0 / working.strange;
        }
    }
    let ids: Vec<&str> = slips.iter().map(|slip| slip.id).collect();
    let (paper, manner) = paper(random, manner, &ids)?;
    let page = pages(&budget, &working, manner);
    let same = |other: &[Slip]| {
        let mut working = right.clone();
        other
            .iter()
            .for_each(|slip| spoil(&budget, slip, &mut working));
        pages(&budget, &working, manner) == page
    };
    let visible = match what {
        Concealed::Nothing => true,
        Concealed::Strange => !possible(&budget).iter().any(|slip| same(&[*slip])),
        _ => !same(&[]) && (slips.len() == 1 || slips.iter().all(|slip| !same(&[*slip]))),
    };
    if !visible {
        return None;
    }
    let rivals = rivals(&budget, &slips, same);
    Some(Sheet {
        ending: paper.ending(),
        bytes: paper.bytes(&page),
        symbols: budget.items.iter().map(|item| item.blank.symbol).collect(),
        truth: SheetTruth {
            verdict: match what {
                Concealed::Nothing => "sound",
                Concealed::Strange => "unexplained",
                _ => "slips",
            }
            .into(),
            slips: slips.iter().map(|slip| slip.name(&budget)).collect(),
            u_c: figures.u_c,
            expanded: figures.expanded,
            layout: manner.form.name().into(),
            rivals,
        },
    })
}

fn choose(random: &mut Random, budget: &Budget, what: Concealed) -> Vec<Slip> {
    let all = possible(budget);
    // Kinds are equally frequent, not places.
    let mut kinds: Vec<&str> = all.iter().map(|slip| slip.id).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut one = |without: Option<Slip>| {
        let free: Vec<&str> = kinds
            .iter()
            .filter(|id| without.is_none_or(|slip| slip.id != **id))
            .copied()
            .collect();
        let id = free.choose(random)?;
        let places: Vec<Slip> = all
            .iter()
            .filter(|slip| {
                slip.id == *id
                    && without.is_none_or(|other| {
                        other.row.is_none() && slip.row.is_none() || other.row != slip.row
                    })
            })
            .copied()
            .collect();
        places.choose(random).copied()
    };
    match what {
        Concealed::Nothing | Concealed::Strange => Vec::new(),
        Concealed::One => one(None).into_iter().collect(),
        Concealed::Two => {
            let first = one(None);
            let second = first.and_then(|first| one(Some(first)));
            first.into_iter().chain(second).collect()
        }
    }
}

/// A paper that suits a manner, and the manner on it; none where a slip could not be seen.
fn paper(random: &mut Random, mut manner: Manner, ids: &[&str]) -> Option<(Paper, Manner)> {
    let paper = *Paper::ALL.choose(random).unwrap_or(&Paper::Markdown);
    manner.formulas = paper
        == Paper::Workbook {
            decimal_comma: false,
        }
        && matches!(manner.form, Form::Jjf | Form::Free)
        && random.random_bool(0.7);
    let hard = ids.contains(&"hard-coded");
    let stated_elsewhere = matches!(manner.form, Form::Ea | Form::TwoHeads | Form::Groups);
    let missing = ids.contains(&"ref-missing");
    // A coefficient can be checked only against a model at stated estimates.
    let slope = ids
        .iter()
        .any(|id| matches!(*id, "c-one" | "c-wrong" | "degrees"));
    let checked = !slope || manner.form.has_estimates() && manner.variant % 3 != 2;
    let turned = manner.form == Form::Turned && matches!(paper, Paper::Markdown);
    let possible = (!hard || manner.formulas && !manner.variant.is_multiple_of(3))
        && (!missing || stated_elsewhere)
        && !turned
        && checked;
    possible.then_some((paper, manner))
}

/// Sets of other slips, no larger, that give the same pages.
fn rivals(budget: &Budget, slips: &[Slip], same: impl Fn(&[Slip]) -> bool) -> usize {
    let name = |set: &[Slip]| {
        let mut names: Vec<String> = set.iter().map(|slip| slip.name(budget)).collect();
        names.sort();
        names
    };
    let truth = name(slips);
    let all = possible(budget);
    let singles = all
        .iter()
        .filter(|slip| !slips.is_empty() && name(&[**slip]) != truth && same(&[**slip]))
        .count();
    if slips.len() < 2 {
        return singles;
    }
    let mut pairs = 0;
    for (i, a) in all.iter().enumerate() {
        for b in &all[i + 1..] {
            pairs += usize::from(name(&[*a, *b]) != truth && same(&[*a, *b]));
        }
    }
    singles + pairs
}
