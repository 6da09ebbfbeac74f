//! Claims: what somebody's certificate says, each figure with the tolerance of its digits.

use super::amounts::{is_bare_ratio, is_in_ratios};
use super::checker::Checker;
use super::entries::entries;
use super::register::Register;
use crate::budget::faults::{CLAIM, LIMITS, NOT_POSITIVE, UNKNOWN_NAME};
use crate::budget::tables::{ClaimTable, FileTable, InputClaimTable, MethodWord, ToleranceTable};
use crate::budget::{Claim, ClaimedFigure, ClaimedMethod, Confidence, Figure, Part};
use gumption_core::quantity::{Decimal, Unit};
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Amount;
use gumption_format::toml::{OneOrMany, Slot, Stated};

/// The keys of a claim that state a figure.
const FIGURES: [&str; 18] = [
    "value",
    "u",
    "U",
    "variance",
    "covariance",
    "k",
    "dof",
    "p",
    "interval",
    "shortest",
    "at_least",
    "at_most",
    "shift",
    "correlation",
    "region",
    "validated",
    "inputs",
    "figures",
];

/// Decimals of so many digits survive a double; of more, nobody could say that they agree.
const MOST_DIGITS: u64 = 15;

/// The significant digits that a claim asks for.
fn correct_digits(stated: &Stated<u64>) -> u8 {
    stated.value.min(MOST_DIGITS) as u8
}

/// k = 2 is meant as 2.00.
const COARSEST_K: f64 = 0.005;

/// The figures of one claim while they are read.
struct Reading<'a> {
    table: &'a ClaimTable,
    /// Name and unit of the measurand.
    name: &'a str,
    unit: &'a Unit,
    figures: Vec<ClaimedFigure>,
}

impl Reading<'_> {
    /// A tolerance that the file states.
    fn tolerance(&self, of: impl Fn(&ToleranceTable) -> &Slot<f64>) -> Option<f64> {
        let table = &self.table.tolerance.as_ref()?.value;
        of(table).as_ref().map(|stated| stated.value)
    }

    /// The tolerances of both ends of an interval.
    fn ends(&self, of: impl Fn(&ToleranceTable) -> &Slot<OneOrMany<f64>>) -> [Option<f64>; 2] {
        let stated = self.table.tolerance.as_ref();
        let stated = stated.and_then(|table| of(&table.value).as_ref());
        let list = stated.map_or(&[][..], |stated| &stated.value.0);
        let end = |place: usize| list.get(place).or(list.first()).map(|stated| stated.value);
        [end(0), end(1)]
    }

    fn push(&mut self, what: Figure, value: f64, half_digit: f64, stated: Option<f64>) {
        let by_digits = self.table.digits.as_ref().map(|digits| {
            let scale = if value == 0.0 { 1.0 } else { value.abs() };
            scale * 10f64.powi(-i32::from(correct_digits(digits)))
        });
        self.figures.push(ClaimedFigure {
            what,
            value,
            tolerance: stated.or(by_digits).unwrap_or(half_digit),
        });
    }
}

impl Checker<'_> {
    /// Reads `[claim]`.
    pub(super) fn claims(&mut self, file: &FileTable, register: &Register) -> Vec<Claim> {
        let stated = file
            .claim
            .as_ref()
            .map_or(&[][..], |claims| &claims.value.0);
        stated
            .iter()
            .filter_map(|claim| self.claim(claim, file, register))
            .collect()
    }

    fn claim(
        &mut self,
        stated: &Stated<ClaimTable>,
        file: &FileTable,
        register: &Register,
    ) -> Option<Claim> {
        let table = &stated.value;
        if !table.present.iter().any(|(key, _)| FIGURES.contains(key)) {
            return self.refuse(
                Fault::new(
                    CLAIM,
                    stated.span.clone(),
                    say!("the claim states no figure"),
                )
                .label(say!("nothing to compare"))
                .help(say!("add at least one of {}", FIGURES.join(", "))),
            );
        }
        if let Some(digits) = table
            .digits
            .as_ref()
            .filter(|digits| digits.value > MOST_DIGITS)
        {
            self.report(
                Fault::new(
                    CLAIM,
                    digits.span.clone(),
                    say!("{} correct digits cannot be shown", digits.value),
                )
                .label(say!("at most {MOST_DIGITS}"))
                .help(say!(
                    "the numbers of a report are doubles, in which 15 decimal digits survive"
                )),
            );
        }
        let about_analyses = table.measurand.is_none()
            && table
                .present
                .iter()
                .all(|(key, _)| *key == "figures" || !FIGURES.contains(key));
        let measurand = if about_analyses {
            0
        } else {
            self.claimed(&table.measurand, &stated.span)?
        };
        let (name, source) = self.names.results.get(measurand).cloned()?;
        let (_, entry) = entries(&file.measurand).get(source)?;
        let unit = self.measurand_unit(&name, &entry.value.unit)?;
        let mut reading = Reading {
            table,
            name: &name,
            unit: &unit,
            figures: Vec::new(),
        };
        self.claimed_amounts(&mut reading);
        self.claimed_numbers(&mut reading);
        self.claimed_limits(&mut reading);
        self.claimed_ends(&mut reading);
        self.correlations_claimed(&mut reading);
        self.verdict(&mut reading);
        self.input_figures(&mut reading, register);
        self.named_figures(&mut reading);
        Some(Claim {
            measurand,
            method: match table.method.as_ref().map(|word| word.value) {
                None => ClaimedMethod::Unstated,
                Some(MethodWord::Gum) => ClaimedMethod::Gum,
                Some(MethodWord::SecondOrder) => ClaimedMethod::SecondOrder,
                Some(MethodWord::MonteCarlo) => ClaimedMethod::MonteCarlo,
            },
            figures: reading.figures,
            confidence: table
                .confidence
                .as_ref()
                .map_or(Confidence::High, |word| word.value),
            digits: table.digits.as_deref().map(correct_digits),
            reference: table.reference.as_ref().map(|text| text.value.clone()),
            note: table.note.as_ref().map(|text| text.value.clone()),
        })
    }

    /// Estimate, u, U and shift.
    fn claimed_amounts(&mut self, reading: &mut Reading<'_>) {
        let table = reading.table;
        if let Some(value) = &table.value
            && let Some(number) = self.quantity(value, reading.unit, reading.name)
        {
            let half = self.half_digit_of(value, reading.unit, reading.name);
            let stated = reading.tolerance(|t| &t.value);
            reading.push(Figure::Estimate, number, half, stated);
        }
        let deviations = [
            (
                &table.u,
                Figure::StandardUncertainty,
                reading.tolerance(|t| &t.u),
            ),
            (
                &table.U,
                Figure::ExpandedUncertainty,
                reading.tolerance(|t| &t.U),
            ),
            (&table.shift, Figure::Shift, reading.tolerance(|t| &t.shift)),
        ];
        for (amount, what, tolerance) in deviations {
            let Some(amount) = amount else { continue };
            if amount.value.number < 0.0 && what != Figure::Shift {
                self.report(
                    Fault::new(
                        NOT_POSITIVE,
                        amount.span.clone(),
                        say!("the claimed uncertainty is negative"),
                    )
                    .label(say!("must not be negative"))
                    .help(say!("write it without sign")),
                );
                continue;
            }
            if let Some((relative, scale)) = self.claimed_of_value(amount, &what, reading.unit) {
                let half = scale * self.half_digit(amount);
                reading.push(relative, scale * amount.value.number, half, tolerance);
            } else if let Some(number) = self.difference(amount, reading.unit, reading.name) {
                let half = self.half_digit_of(amount, reading.unit, reading.name);
                reading.push(what, number, half, tolerance);
            }
        }
        if let Some(variance) = &table.variance {
            let stated = reading.tolerance(|t| &t.variance);
            let half = self.half_digit(variance);
            reading.push(Figure::Variance, variance.value, half, stated);
        }
    }

    /// An uncertainty in % or ppm of a value that has another unit: which relative figure it is, and the factor that
    /// makes it a number.
    fn claimed_of_value(
        &mut self,
        amount: &Stated<Amount>,
        what: &Figure,
        unit: &Unit,
    ) -> Option<(Figure, f64)> {
        let relative = match what {
            Figure::StandardUncertainty => Figure::RelativeUncertainty,
            Figure::ExpandedUncertainty => Figure::RelativeExpanded,
            _ => return None,
        };
        amount.value.unit.as_ref()?;
        let own = self.amount_unit(&amount.value)??;
        let share = is_bare_ratio(&own) && !is_in_ratios(unit);
        let conversion = own.conversion_to(&Unit::one())?;
        share.then_some((relative, conversion.factor))
    }

    /// k, ν, p and the factors of the region.
    fn claimed_numbers(&mut self, reading: &mut Reading<'_>) {
        let table = reading.table;
        if let Some(k) = &table.k
            && let Some(value) = self.positive(k, "k")
        {
            let half = self.half_digit(k).min(COARSEST_K);
            let stated = reading.tolerance(|t| &t.k);
            reading.push(Figure::CoverageFactor, value, half, stated);
        }
        if let Some(dof) = &table.dof
            && let Some(value) = self.positive_dof(dof)
        {
            let stated = reading.tolerance(|t| &t.dof);
            reading.push(
                Figure::DegreesOfFreedom,
                value,
                self.half_digit(dof),
                stated,
            );
        }
        if let Some(p) = &table.p
            && let Some(value) = self.probability(p)
        {
            let stated = reading.tolerance(|t| &t.p);
            reading.push(
                Figure::CoverageProbability,
                value,
                self.half_digit(p),
                stated,
            );
        }
        let Some(region) = table.region.as_ref().map(|region| &region.value) else {
            return;
        };
        let stated = reading.tolerance(|t| &t.region);
        for (number, what) in [
            (&region.ellipsoid, Figure::Ellipsoid),
            (&region.rectangle, Figure::Rectangle),
            (&region.dof, Figure::RegionFreedom),
        ] {
            if let Some(number) = number {
                reading.push(what, number.value, self.half_digit(number), stated);
            }
        }
    }

    /// Limits of one-sided intervals.
    fn claimed_ends(&mut self, reading: &mut Reading<'_>) {
        let table = reading.table;
        let ends = [
            (&table.at_least, Figure::AtLeast),
            (&table.at_most, Figure::AtMost),
        ];
        for (stated, what) in ends {
            let Some(limit) = stated else { continue };
            if let Some(value) = self.quantity(limit, reading.unit, reading.name) {
                let half = self.half_digit_of(limit, reading.unit, reading.name);
                let tolerance = reading.tolerance(|t| &t.one_sided);
                reading.push(what, value, half, tolerance);
            }
        }
    }

    fn claimed_limits(&mut self, reading: &mut Reading<'_>) {
        let table = reading.table;
        let intervals = [
            (
                &table.interval,
                [Figure::Lower, Figure::Upper],
                reading.ends(|t| &t.interval),
            ),
            (
                &table.shortest,
                [Figure::ShortestLower, Figure::ShortestUpper],
                reading.ends(|t| &t.shortest),
            ),
        ];
        for (stated, figures, tolerances) in intervals {
            let Some(stated) = stated else { continue };
            let limits: Vec<Option<f64>> = stated
                .value
                .iter()
                .map(|limit| self.quantity(limit, reading.unit, reading.name))
                .collect();
            if limits.contains(&None) {
                continue;
            }
            if !matches!(limits.as_slice(), [Some(lower), Some(upper)] if lower < upper) {
                self.report(
                    Fault::new(
                        LIMITS,
                        stated.span.clone(),
                        say!("the claimed interval is not a lower and an upper limit"),
                    )
                    .label(say!("expected [lower, upper]")),
                );
                continue;
            }
            let ends = limits.into_iter().zip(&stated.value);
            for (((limit, amount), what), tolerance) in ends.zip(figures).zip(tolerances) {
                let half = self.half_digit_of(amount, reading.unit, reading.name);
                reading.push(what, limit.unwrap_or(f64::NAN), half, tolerance);
            }
        }
    }

    fn correlations_claimed(&mut self, reading: &mut Reading<'_>) {
        let table = reading.table;
        let correlations = entries(&table.correlation).iter();
        let covariances = entries(&table.covariance).iter();
        let all = correlations
            .map(|entry| (entry, Figure::Correlation as fn(usize) -> Figure))
            .chain(covariances.map(|entry| (entry, Figure::Covariance as fn(usize) -> Figure)));
        for ((name, number), figure) in all {
            let wanted = number.map(|_| name.to_string());
            let wanted = Some(Box::new(Stated {
                span: number.key.clone(),
                ..wanted
            }));
            if let Some(with) = self.claimed(&wanted, &number.key) {
                let figure = figure(with);
                let stated = match figure {
                    Figure::Covariance(_) => reading.tolerance(|t| &t.covariance),
                    _ => reading.tolerance(|t| &t.correlation),
                };
                reading.push(figure, number.value, self.half_digit(number), stated);
            }
        }
    }

    fn verdict(&mut self, reading: &mut Reading<'_>) {
        let Some(stated) = &reading.table.validated else {
            return;
        };
        match (&stated.value.digits, &stated.value.verdict) {
            (Some(digits), Some(verdict)) if matches!(digits.value, 1 | 2) => {
                let what = Figure::Validated(if digits.value == 1 { 1 } else { 2 });
                // An undecided validation, one half, agrees with neither verdict.
                reading.push(what, f64::from(u8::from(verdict.value)), 0.25, None);
            }
            _ => self.report(
                Fault::new(
                    CLAIM,
                    stated.span.clone(),
                    say!("the claimed verdict is incomplete"),
                )
                .label(say!(
                    "expected {{ digits = 2, verdict = true }} or the like, with 1 or 2 digits"
                )),
            ),
        }
    }

    fn input_figures(&mut self, reading: &mut Reading<'_>, register: &Register) {
        for (name, stated) in entries(&reading.table.inputs) {
            let input = register.inputs.iter().position(|input| input.name == *name);
            let component = register
                .components
                .iter()
                .position(|component| component.name == *name);
            let (unit, figure): (Unit, Box<dyn Fn(Part) -> Figure>) = match (input, component) {
                (Some(index), _) => (
                    register.inputs[index].unit.clone(),
                    Box::new(move |part| Figure::Input(index, part)),
                ),
                (None, Some(index)) => (
                    register.components[index].unit.clone(),
                    Box::new(move |part| Figure::Component(index, part)),
                ),
                (None, None) => {
                    self.unknown_input(name, stated, register);
                    continue;
                }
            };
            self.parts(reading, &stated.value, (name, &unit), &figure);
        }
    }

    fn parts(
        &mut self,
        reading: &mut Reading<'_>,
        table: &InputClaimTable,
        (name, unit): (&str, &Unit),
        figure: &dyn Fn(Part) -> Figure,
    ) {
        let value = table.value.as_ref();
        let u = table.u.as_ref();
        let amounts = [
            (
                value,
                value.and_then(|value| self.quantity(value, unit, name)),
                Part::Estimate,
            ),
            (
                u,
                u.and_then(|u| self.difference(u, unit, name)),
                Part::StandardUncertainty,
            ),
        ];
        for (amount, number, part) in amounts {
            if let (Some(amount), Some(number)) = (amount, number) {
                let half = self.half_digit_of(amount, unit, name);
                reading.push(figure(part), number, half, None);
            }
        }
        let numbers = [
            (&table.dof, Part::DegreesOfFreedom, None),
            (
                &table.sensitivity,
                Part::Sensitivity,
                reading.tolerance(|t| &t.sensitivity),
            ),
            (
                &table.contribution,
                Part::Contribution,
                reading.tolerance(|t| &t.contribution),
            ),
        ];
        for (number, part, tolerance) in numbers {
            if let Some(number) = number {
                reading.push(
                    figure(part),
                    number.value,
                    self.half_digit(number),
                    tolerance,
                );
            }
        }
    }

    fn named_figures(&mut self, reading: &mut Reading<'_>) {
        for (name, stated) in entries(&reading.table.figures) {
            let known = || {
                let found = self.figures.found.iter().map(|figure| figure.name.as_str());
                found.chain(self.figures.awaited.iter().map(String::as_str))
            };
            if known().any(|figure| figure == name) {
                let tolerance = reading.tolerance(|t| &t.figures);
                let half = self.half_digit(stated);
                reading.push(
                    Figure::Named(name.to_string()),
                    stated.value,
                    half,
                    tolerance,
                );
                continue;
            }
            if self.figures.incomplete || self.scatters.iter().any(|fit| fit.withholds(name)) {
                continue;
            }
            let help = match nearest(name, known()) {
                Some(near) => say!("did you mean \"{near}\"?"),
                None if known().next().is_none() => {
                    say!(
                        "the file has no analysis (fit, groups of readings, conformity …) with figures"
                    )
                }
                None => say!("figures: {}", known().collect::<Vec<_>>().join(", ")),
            };
            self.report(
                Fault::new(
                    UNKNOWN_NAME,
                    stated.key.clone(),
                    say!("there is no figure \"{name}\""),
                )
                .label(say!("not known"))
                .help(help),
            );
        }
    }

    fn unknown_input(&mut self, name: &str, stated: &Stated<InputClaimTable>, register: &Register) {
        let known = register
            .inputs
            .iter()
            .map(|input| input.name.as_str())
            .chain(
                register
                    .components
                    .iter()
                    .map(|component| component.name.as_str()),
            );
        let fault = Fault::new(
            UNKNOWN_NAME,
            stated.key.clone(),
            say!("there is no input or component \"{name}\""),
        )
        .label(say!("not declared"));
        self.report(match nearest(name, known) {
            Some(near) => fault.help(say!("did you mean \"{near}\"?")),
            None => fault.help(say!("name an input (V) or a component (\"V.calibration\")")),
        });
    }

    /// Half a unit of the last digit as the file writes the number: 0.5e-4 for `0.0710`.
    pub(super) fn half_digit<T>(&self, stated: &Stated<T>) -> f64 {
        let text = self
            .source
            .text
            .get(stated.span.clone())
            .unwrap_or_default();
        let number: String = text
            .trim_start_matches(['"', '\'', ' '])
            .chars()
            .take_while(|c| c.is_ascii_digit() || matches!(c, '.' | '_' | '+' | '-' | 'e' | 'E'))
            .filter(|c| *c != '_')
            .collect();
        // The unit of `"5 e"`-like texts never follows the digits directly.
        let number = number.trim_end_matches(['e', 'E']);
        Decimal::from_text(number)
            .and_then(|decimal| decimal.place())
            .map_or(0.0, |place| 0.5 * 10f64.powi(place))
    }

    /// The same for an amount that may carry a unit of its own, as a difference of a quantity in `unit`.
    fn half_digit_of(&mut self, amount: &Stated<Amount>, unit: &Unit, owner: &str) -> f64 {
        let half = amount.map(|value| Amount {
            number: self.half_digit(amount),
            unit: value.unit.clone(),
        });
        self.difference(&half, unit, owner).map_or(0.0, f64::abs)
    }

    /// Which measurand a claim is about.
    pub(super) fn claimed(
        &mut self,
        stated: &Slot<String>,
        place: &std::ops::Range<usize>,
    ) -> Option<usize> {
        let names: Vec<String> = self
            .names
            .results
            .iter()
            .map(|(name, _)| name.clone())
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        match stated {
            None if names.len() == 1 => Some(0),
            // Without measurands there is a fault about that already.
            None if names.is_empty() => None,
            None => self.refuse(
                Fault::new(
                    CLAIM,
                    place.clone(),
                    say!("the claim does not say which measurand it is about"),
                )
                .label(say!("`measurand` is missing"))
                .help(say!(
                    "add measurand = \"{}\" (or another of {})",
                    names[0],
                    names.join(", ")
                )),
            ),
            Some(wanted) => match names.iter().position(|name| *name == wanted.value) {
                Some(index) => Some(index),
                None => {
                    let help = match nearest(&wanted.value, names.iter().copied()) {
                        Some(near) => say!("did you mean \"{near}\"?"),
                        None => say!("measurands: {}", names.join(", ")),
                    };
                    self.refuse(
                        Fault::new(
                            UNKNOWN_NAME,
                            wanted.span.clone(),
                            say!("there is no measurand \"{}\"", wanted.value),
                        )
                        .label(say!("not declared"))
                        .help(help),
                    )
                }
            },
        }
    }
}
