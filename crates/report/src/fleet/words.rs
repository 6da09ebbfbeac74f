//! What is said of a fleet in sentences.

use gumption_fault::{Said, say};
use gumption_fleet::{Drift, GroupResult, Measurand, SIGNIFICANCE, Scatter};

use super::Shown;
use super::tables::expected;
use crate::number::{grouped, percent, significant};

/// Names that one sentence lists.
const LISTED: usize = 8;

impl Shown<'_> {
    /// Where estimates scatter otherwise than u says; what that may mean.
    pub fn consistency(self, one: &Measurand) -> Vec<String> {
        let l = self.l;
        let tested = one
            .groups
            .iter()
            .filter(|group| group.consistency.is_some());
        let tests = tested.count();
        let mut more = Vec::new();
        let mut less = Vec::new();
        for (at, group) in one.groups.iter().enumerate() {
            let Some(found) = &group.consistency else {
                continue;
            };
            match found.scatter(tests) {
                Scatter::More => more.push((at, found.birge)),
                Scatter::Less => less.push((at, found.birge)),
                Scatter::AsClaimed => {}
            }
        }
        let mut sentences = self.left_out(one);
        if tests == 0 {
            sentences.push(say!("No group has two estimates with an uncertainty: of their scatter nothing can be said.").in_language(l));
            return sentences;
        }
        if !more.is_empty() {
            let groups = self.ratios(&more);
            sentences.push(say!("More scatter than u claims ({groups} times as much): the items differ from each other, or u leaves something out. Which of the two, the scatter alone does not tell; real differences between items are no fault of u.").in_language(l));
        }
        if !less.is_empty() {
            let groups = self.ratios(&less);
            sentences.push(say!("Less scatter than u claims ({groups} times as much): what all of them share, such as the error of one reference, is part of u and does not scatter; or u is too large.").in_language(l));
        }
        if more.is_empty() && less.is_empty() {
            sentences.push(say!("The estimates scatter as their u lets expect. Where all share a reference, whose error is part of u but does not scatter, that may hide differences between the items.").in_language(l));
        }
        sentences
    }

    /// How many rows say too little, and where they are left out.
    fn left_out(self, one: &Measurand) -> Vec<String> {
        let sum = |of: fn(&GroupResult) -> usize| one.groups.iter().map(of).sum::<usize>();
        let [missing, values, unweighed] = [
            sum(|group| group.missing),
            sum(|group| group.values),
            sum(|group| group.unweighed),
        ];
        let mut sentences = Vec::new();
        if missing > 0 {
            let [missing, rows] = [missing, missing + values].map(|n| grouped(n as u64));
            sentences.push(say!("Without an estimate, though no fault is stated: {missing} of {rows} rows. Their field is empty, or holds a number that instruments write for an overload (9.9e37 and more)."));
        }
        if unweighed > 0 {
            let [unweighed, values] = [unweighed, values].map(|n| grouped(n as u64));
            sentences.push(say!("Without a u that weighs them: {unweighed} of {values} estimates. They count in n, mean and s, and nowhere else: their u is missing, 0, or beyond the range of numbers."));
        }
        let sentences = sentences.into_iter();
        sentences.map(|said| said.in_language(self.l)).collect()
    }

    /// The first of some groups, with their ratios.
    fn ratios(self, groups: &[(usize, f64)]) -> String {
        let ratio = |(at, birge): &(usize, f64)| {
            let birge = significant(*birge, 2);
            match self.fleet.by.is_empty() {
                true => birge,
                false => format!("{} {birge}", self.group(*at)),
            }
        };
        self.list(groups.iter().map(ratio))
    }

    /// The first of some names.
    fn list(self, names: impl Iterator<Item = String>) -> String {
        let mut all: Vec<String> = Vec::new();
        for name in names {
            // A device may have several rows.
            if !all.contains(&name) {
                all.push(name);
            }
        }
        Said::first(&all, LISTED).in_language(self.l)
    }

    pub fn agreement_words(self, one: &Measurand) -> String {
        let l = self.l;
        let found = &one.agreement;
        let [tested, beyond] = [found.tested, found.beyond].map(|n| grouped(n as u64));
        let by_chance = expected(found.expected);
        let against = match &one.reference {
            Some(name) => say!("the reference {name}").in_language(l),
            None => say!("the weighted mean of the others of their group").in_language(l),
        };
        let all = say!("|E_n| > 1: {beyond} of {tested} rows, against {against}; chance lets expect {by_chance}.").in_language(l);
        if super::differ(one) {
            return say!("|E_n| > 1: {beyond} of {tested} rows, against {against}. The items differ by more than their uncertainties, so that none of them stands out, and none is named. E_n tells something against a reference value (`--reference`), or among items that should be alike (`--by`).").in_language(l);
        }
        let named = found.apart.iter().filter(|one| one.is_named());
        let names = self.list(named.map(|one| one.device.clone()));
        let named = match found.named {
            0 => say!("Over all that was tested, chance explains each of them.").in_language(l),
            count => self.unexplained(count, "行", &names),
        };
        let shared = match &one.reference {
            Some(_) => String::new(),
            None => say!(" What all rows share, such as the error of one reference, is in both sides and cancels, though U has it: E_n is then smaller than the difference deserves.").in_language(l),
        };
        format!("{all}{}{named}{shared}", l.pick(" ", ""))
    }

    /// Those that chance does not explain; Chinese has a word with which they are counted.
    fn unexplained(self, count: usize, counted: &str, names: &str) -> String {
        let (count, limit) = (grouped(count as u64), self.limit());
        self.l.pick(
            format!("Not explained by chance (●, p < {limit} over all), {count}: {names}."),
            format!("其中 {count} {counted}不能由偶然性解释（●，总体 p < {limit}）：{names}。"),
        )
    }

    fn limit(self) -> String {
        format!("{} %", percent(SIGNIFICANCE).trim_end_matches(".0"))
    }

    pub fn drift_words(self, drift: &Drift) -> String {
        let l = self.l;
        if drift.devices == 0 {
            return say!("No device has calibrations at two dates in one group: of a drift nothing can be said.").in_language(l);
        }
        let [devices, beyond] = [drift.devices, drift.beyond].map(|n| grouped(n as u64));
        let by_chance = expected(drift.expected);
        let all = match drift.devices {
            1 => say!(
                "Rate beyond its U: {beyond} of 1 device with calibrations at several dates; chance lets expect {by_chance}."
            ),
            _ => say!(
                "Rate beyond its U: {beyond} of {devices} devices with calibrations at several dates; chance lets expect {by_chance}."
            ),
        };
        let all = all.in_language(l);
        let named = drift.apart.iter().filter(|one| one.is_named());
        let names = self.list(named.map(|one| one.device.clone()));
        let named = match drift.named {
            0 => say!("Over all devices, chance explains each of them.").in_language(l),
            count => self.unexplained(count, "个", &names),
        };
        let shared = say!("Where all calibrations used the same reference, its error is in both sides and cancels: U is then larger than a difference needs, and a drift that is seen is seen all the more; one that is not seen may be there. Where the reference was changed or calibrated anew in between, it does not cancel.").in_language(l);
        let space = l.pick(" ", "");
        format!("{all}{space}{named}{space}{shared}")
    }

    /// Definitions and where they come from.
    pub fn sources(self) -> Vec<String> {
        let l = self.l;
        let p = self.limit();
        [
            say!("s: standard deviation of the estimates; u: claimed standard uncertainty, root mean square. Birge = √(χ²/(n − 1)) with χ² = Σ (x − x̄)²/u² and the mean x̄ with weights 1/u² (Birge 1932); p(χ²): probability of a larger χ². u(x̄): standard uncertainty of x̄ by the claimed u.").in_language(l),
            say!("E_n = (x − X)/√(U_x² + U_X²) (ISO/IEC 17043, ISO 13528). Without a reference, X is the weighted mean of the others of the group, with the k of the row; rows far from the median are left out of it. p over all: probability of such a difference, times the number of tests (Bonferroni); below {p} a device is named.").in_language(l),
        ]
        .to_vec()
    }
}
