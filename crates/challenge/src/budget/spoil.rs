//! Slips, as they happen in a working.

use super::laboratory::{Budget, Rounding, Rule};
use super::quantity::{Divisor, Known, RANGE};
use super::words::plain;
use super::working::{Factor, Nu, Sum, Working, exchanged};

/// A slip at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slip {
    pub id: &'static str,
    pub row: Option<usize>,
    /// Which of several ways.
    pub way: usize,
}

impl Slip {
    /// As in the neutral answer form.
    pub(super) fn name(&self, budget: &Budget) -> String {
        match self.row {
            Some(row) => format!("{}@{}", self.id, budget.items[row].blank.symbol),
            None => self.id.into(),
        }
    }
}

/// All that can happen to a budget.
pub(super) fn possible(budget: &Budget) -> Vec<Slip> {
    let mut all = Vec::new();
    for (i, item) in budget.items.iter().enumerate() {
        let row = Some(i);
        let mut here = |id| all.push(Slip { id, row, way: 0 });
        if item.contained {
            here("res-and-rep");
            continue;
        }
        match item.known {
            Known::Certificate(_, k) => {
                here("cert-undivided");
                here("cert-by-root3");
                here("ref-missing");
                if k != 2.0 {
                    here("cert-k-2");
                }
            }
            Known::Limits(_) => ["half-width-by-2", "root3-missing", "half-again", "triangle"]
                .into_iter()
                .for_each(&mut here),
            Known::Width(_) => ["full-width", "half-width-by-2", "root3-missing"]
                .into_iter()
                .for_each(&mut here),
            Known::Step(_) => ["full-width", "root3-missing"]
                .into_iter()
                .for_each(&mut here),
            Known::Triangle(_) => here("tri-by-root3"),
            Known::Cycle(_) => here("arcsine-as-rect"),
            Known::Uneven(..) => here("asym-max"),
            Known::Scatter(_, n, m) => {
                if m > 1 {
                    here("s-not-mean");
                    here("s-over-n");
                }
                if n != m {
                    here("s-wrong-m");
                }
                here("population-sd");
                here("dof-n");
            }
            Known::Pooled(_, _, _, m) => {
                here("pooled-dof");
                if m > 1 {
                    here("s-not-mean");
                }
            }
            Known::Spread(..) => here("range-C"),
            Known::Alike(..) => here("zero-scatter"),
            Known::OfReading(_) => ["percent-ppm", "rel-abs"].into_iter().for_each(&mut here),
            Known::OfScale(..) => {
                here("percent-ppm");
                here("rel-abs");
                if item.blank.estimate != 0.0 {
                    here("fs-reading");
                }
            }
        }
        here("row-dropped");
        if (item.slope.abs() - 1.0).abs() > 0.02 {
            here("c-one");
            here("c-wrong");
        }
        if item.blank.unit == "°" {
            here("degrees");
        }
        if item.known.figure().is_some_and(|x| x != 0.0) && item.blank.unit != "1" {
            all.extend((0..2).map(|way| Slip {
                id: "prefix",
                row,
                way,
            }));
        }
        if item
            .known
            .figure()
            .is_some_and(|x| two_digits(&plain(x, 2)))
        {
            all.push(Slip {
                id: "input-transposed",
                row,
                way: 0,
            });
        }
        all.push(Slip {
            id: "hard-coded",
            row,
            way: 0,
        });
    }
    let mut add = |id, row, ways: usize| all.extend((0..ways).map(|way| Slip { id, row, way }));
    [
        "linear-sum",
        "squares-not-rooted",
        "intermediates-rounded",
        "k-forgotten",
        "rounded-down",
        "digits-transposed",
    ]
    .into_iter()
    .for_each(|id| add(id, None, 1));
    add("too-many-digits", None, 2);
    add("U-unit", None, 1);
    if budget.correlation.is_some() {
        ["sign-lost", "corr-ignored", "corr-one"]
            .into_iter()
            .for_each(|id| add(id, None, 1));
    }
    match budget.rule {
        Rule::Student(_) => {
            ["k2-low-dof", "veff-up", "k-of-typeA", "k-level"]
                .into_iter()
                .for_each(|id| add(id, None, 1));
            let finite = |item: &super::laboratory::Item| {
                !item.contained && item.known.right(0.0).nu.is_finite()
            };
            if budget.items.iter().any(finite) {
                add("veff-wrong", None, 2);
            }
        }
        Rule::Rectangle => add("k2-rect", None, 1),
        Rule::Two => add("k-twice", None, 1),
    }
    if budget.cmc.is_some() {
        add("below-cmc", None, 1);
    }
    all
}

/// Whether a text shows two digits that differ, none of them zero: others are not exchanged without notice.
fn two_digits(text: &str) -> bool {
    let digits: Vec<char> = text.chars().filter(|c| ('1'..='9').contains(c)).collect();
    digits.len() == 2 && digits[0] != digits[1]
}

/// Makes a slip.
pub(super) fn spoil(budget: &Budget, slip: &Slip, working: &mut Working) {
    if let Some(row) = slip.row {
        in_row(budget, slip, row, working);
        return;
    }
    match slip.id {
        "linear-sum" => working.sum = Sum::Linear,
        "squares-not-rooted" => working.sum = Sum::Squares,
        "intermediates-rounded" => working.sum = Sum::OneDigit,
        "sign-lost" => working.signs_lost = true,
        "corr-ignored" => working.r = None,
        "corr-one" => working.r = working.r.map(|(a, b, r)| (a, b, r.signum())),
        "k-forgotten" => working.power = 0,
        "k-twice" => working.power = 2,
        "rounded-down" => working.down = true,
        "digits-transposed" => working.exchanged = Some((true, slip.way)),
        "too-many-digits" => working.digits = 3 + slip.way,
        "U-unit" => working.wrong_unit = true,
        "k2-low-dof" | "k2-rect" => working.k = Factor::Rule(Rule::Two),
        "veff-up" => working.nu = Nu::Up,
        "veff-wrong" => working.nu = if slip.way == 0 { Nu::Total } else { Nu::Least },
        "k-level" => {
            let other = if budget.rule == Rule::Student(0.95) {
                0.9545
            } else {
                0.95
            };
            working.k = Factor::Rule(Rule::Student(other));
        }
        "k-of-typeA" => {
            let of = |item: &super::laboratory::Item| {
                item.known.is_type_a().then(|| item.known.right(0.0).nu)
            };
            if let Some(nu) = budget.items.iter().find_map(of).filter(|nu| nu.is_finite()) {
                working.k = Factor::OfReadings(nu);
                if let Rule::Student(p) = budget.rule
                    && p != 0.95
                {
                    working.k = Factor::Rule(budget.rule);
                }
            }
        }
        "below-cmc" => working.cmc = None,
        _ => {}
    }
    if slip.id == "rounded-down" && budget.rounding == Rounding::Unsaid {
        working.down = true;
    }
}

fn in_row(budget: &Budget, slip: &Slip, row: usize, working: &mut Working) {
    let item = &budget.items[row];
    let line = &mut working.lines[row];
    let step = &mut line.step;
    let (root, number) = (Divisor::Root, Divisor::Number);
    let estimate = item.blank.estimate.abs();
    match (slip.id, item.known) {
        ("cert-undivided" | "root3-missing" | "s-not-mean", Known::Spread(_, n, _)) => {
            step.divisor = number(RANGE[n as usize - 2].0)
        }
        ("cert-undivided" | "root3-missing" | "s-not-mean", _) => step.divisor = number(1.0),
        ("cert-by-root3" | "tri-by-root3" | "arcsine-as-rect", _) => step.divisor = root(3.0),
        ("cert-k-2" | "half-width-by-2", _) => step.divisor = number(2.0),
        ("full-width", _) => step.used *= 2.0,
        ("half-again", _) => step.used /= 2.0,
        ("triangle", _) => step.divisor = root(6.0),
        ("asym-max", Known::Uneven(plus, minus)) => step.used = plus.max(minus),
        ("s-over-n", Known::Scatter(_, _, m)) => step.divisor = number(f64::from(m)),
        ("s-wrong-m", Known::Scatter(_, n, _)) => step.divisor = root(f64::from(n)),
        ("population-sd", Known::Scatter(s, n, _)) => {
            step.used = s * libm::sqrt((f64::from(n) - 1.0) / f64::from(n))
        }
        ("range-C", Known::Spread(_, n, m)) => {
            let at = if n >= 9 { n - 3 } else { n - 1 };
            step.divisor = number(RANGE[at as usize].0 * libm::sqrt(f64::from(m)));
        }
        ("pooled-dof", Known::Pooled(_, _, n, _)) => step.nu = f64::from(n) - 1.0,
        ("dof-n", _) => step.nu += 1.0,
        ("zero-scatter", _) => step.used = 0.0,
        ("percent-ppm", _) => step.used /= 10.0,
        ("rel-abs", Known::OfReading(p) | Known::OfScale(p, _)) => step.used = p / 100.0,
        ("fs-reading", Known::OfScale(p, _)) => step.used = p / 100.0 * estimate,
        ("prefix", _) => step.used *= if slip.way == 0 { 1e3 } else { 1e-3 },
        ("input-transposed", known) => {
            let (Some(x), used) = (known.figure(), step.used) else {
                return;
            };
            let wrong: f64 = exchanged(&plain(x, 2), 0).parse().unwrap_or(x);
            step.used = used * wrong / x;
        }
        ("c-one", _) => line.c = 1.0,
        ("c-wrong", _) => line.c *= 2.0,
        ("degrees", _) => line.c *= 180.0 / std::f64::consts::PI,
        ("row-dropped", _) => line.summed = false,
        ("res-and-rep", _) => line.summed = true,
        ("ref-missing", _) => line.listed = false,
        ("hard-coded", _) => line.stale = Some(line.c * step.used / step.divisor.value() * 1.31),
        _ => {}
    }
}
