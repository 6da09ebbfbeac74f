//! Slips, as they happen in a working.

use super::laboratory::{Budget, Item, Rounding, Rule};
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
    let items = budget.items.iter().enumerate();
    let mut all: Vec<Slip> = items
        .flat_map(|(row, item)| of_item(item).into_iter().map(move |slip| (row, slip)))
        .map(|(row, (id, way))| Slip {
            id,
            row: Some(row),
            way,
        })
        .collect();
    let of_whole = of_whole(budget).into_iter();
    all.extend(
        of_whole.flat_map(|(id, ways)| (0..ways).map(move |way| Slip { id, row: None, way })),
    );
    all
}

/// What can happen in a row, each slip in each of its ways.
fn of_item(item: &Item) -> Vec<(&'static str, usize)> {
    if item.contained {
        return vec![("res-and-rep", 0)];
    }
    let once = |id| (id, 0);
    let mut all: Vec<_> = of_known(item).into_iter().map(once).collect();
    all.push(once("row-dropped"));
    if (item.slope.abs() - 1.0).abs() > 0.02 {
        all.extend(["c-one", "c-wrong"].map(once));
    }
    if item.blank.unit == "°" {
        all.push(once("degrees"));
    }
    let figure = item.known.figure();
    if figure.is_some_and(|x| x != 0.0) && item.blank.unit != "1" {
        all.extend((0..2).map(|way| ("prefix", way)));
    }
    if figure.is_some_and(|x| two_digits(&plain(x, 2))) {
        all.push(once("input-transposed"));
    }
    all.push(once("hard-coded"));
    all
}

/// What can happen to what is known.
fn of_known(item: &Item) -> Vec<&'static str> {
    let mut all = Vec::new();
    match item.known {
        Known::Certificate(_, k) => {
            all.extend(["cert-undivided", "cert-by-root3", "ref-missing"]);
            if k != 2.0 {
                all.push("cert-k-2");
            }
        }
        Known::Limits(_) => {
            all.extend(["half-width-by-2", "root3-missing", "half-again", "triangle"]);
        }
        Known::Width(_) => all.extend(["full-width", "half-width-by-2", "root3-missing"]),
        Known::Step(_) => all.extend(["full-width", "root3-missing"]),
        Known::Triangle(_) => all.push("tri-by-root3"),
        Known::Cycle(_) => all.push("arcsine-as-rect"),
        Known::Uneven(..) => all.push("asym-max"),
        Known::Scatter(_, n, m) => {
            if m > 1 {
                all.extend(["s-not-mean", "s-over-n"]);
            }
            if n != m {
                all.push("s-wrong-m");
            }
            all.extend(["population-sd", "dof-n"]);
        }
        Known::Pooled(_, _, _, m) => {
            all.push("pooled-dof");
            if m > 1 {
                all.push("s-not-mean");
            }
        }
        Known::Spread(..) => all.push("range-C"),
        Known::Alike(..) => all.push("zero-scatter"),
        Known::OfReading(_) => all.extend(["percent-ppm", "rel-abs"]),
        Known::OfScale(..) => {
            all.extend(["percent-ppm", "rel-abs"]);
            if item.blank.estimate != 0.0 {
                all.push("fs-reading");
            }
        }
    }
    all
}

/// What can happen between the rows and the statement, and in how many ways.
fn of_whole(budget: &Budget) -> Vec<(&'static str, usize)> {
    let mut all = vec![
        ("linear-sum", 1),
        ("squares-not-rooted", 1),
        ("intermediates-rounded", 1),
        ("k-forgotten", 1),
        ("rounded-down", 1),
        ("digits-transposed", 1),
        ("too-many-digits", 2),
        ("U-unit", 1),
    ];
    if budget.correlation.is_some() {
        all.extend([("sign-lost", 1), ("corr-ignored", 1), ("corr-one", 1)]);
    }
    match budget.rule {
        Rule::Student(_) => {
            all.extend([
                ("k2-low-dof", 1),
                ("veff-up", 1),
                ("k-of-typeA", 1),
                ("k-level", 1),
            ]);
            let is_finite = |item: &Item| !item.contained && item.known.right(0.0).nu.is_finite();
            if budget.items.iter().any(is_finite) {
                all.push(("veff-wrong", 2));
            }
        }
        Rule::Rectangle => all.push(("k2-rect", 1)),
        Rule::Two => all.push(("k-twice", 1)),
    }
    if budget.cmc.is_some() {
        all.push(("below-cmc", 1));
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
