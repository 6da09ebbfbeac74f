//! `[conformity]`: tolerance, decision rule, knowledge of the process.

mod process;
mod rule;

use std::ops::Range;

use crate::budget::check::amounts::{Share, is_bare_ratio, is_in_ratios, is_ratio};
use crate::budget::check::draft::{Context, show};
use crate::budget::check::register::{Register, no_such_input};
use crate::budget::check::{Checker, entries};
use crate::budget::faults::{CLAIM, NAME_TWICE, RELATIVE_TO_ZERO, RELATIVE_UNCLEAR, TOLERANCE};
use crate::budget::tables::{ConformityTable, FileTable};
use crate::budget::{Conformity, Interval, StatedTolerance};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::Amount;
use gumption_format::toml::{Slot, Stated};

/// A name from the file and the unit in which amounts are understood.
struct Subject<'a> {
    name: &'a str,
    unit: &'a Unit,
}

impl Checker<'_> {
    /// Reads `[conformity]`.
    pub(in crate::budget::check) fn conformity(
        &mut self,
        file: &FileTable,
        register: &Register,
    ) -> Vec<Conformity> {
        let stated = file.conformity.as_ref().map_or(&[][..], |all| &all.value.0);
        let mut found: Vec<Conformity> = Vec::new();
        for one in stated {
            let Some(conformity) = self.assessment(one, file, register) else {
                self.figures.incomplete = true;
                continue;
            };
            if found.iter().any(|other| other.name == conformity.name) {
                self.report(
                    Fault::new(
                        NAME_TWICE,
                        one.span.clone(),
                        say!("two conformity assessments are called {}", conformity.name),
                    )
                    .label(say!("second one"))
                    .help(say!("give each a name of its own: name = \"…\"")),
                );
            }
            let names = Conformity::FIGURES.map(|figure| format!("{}.{figure}", conformity.name));
            self.figures.awaited.extend(names);
            found.push(conformity);
        }
        found
    }

    fn assessment(
        &mut self,
        stated: &Stated<ConformityTable>,
        file: &FileTable,
        register: &Register,
    ) -> Option<Conformity> {
        let table = &stated.value;
        let measurand = self.decided(&table.measurand, &stated.span, file, "conformity");
        let carrier = match &table.carrier {
            Some(carrier) => self.carrier(carrier, register).map(Some),
            None => Some(lone(register)),
        };
        let measurand = measurand?;
        let (name, entry) = entries(&file.measurand).get(measurand)?;
        let unit = self.unit(&entry.value.unit)?;
        let subject = Subject { name, unit: &unit };
        let (tolerance, compared) = self.tolerance(stated, &subject).unzip();
        let rule = self.rule(stated, &subject, tolerance);
        let process = match (&table.process, tolerance) {
            (Some(process), Some(tolerance)) => self.process(process, tolerance).map(Some),
            (Some(_), None) => None,
            (None, _) => Some(None),
        };
        Some(Conformity {
            name: table
                .name
                .as_ref()
                .map_or_else(|| name.to_string(), |text| text.value.clone()),
            measurand,
            tolerance: tolerance?,
            stated: compared?,
            rule: rule?,
            process: process?,
            carrier: carrier?,
            planning: table.planning.as_ref().is_some_and(|word| word.value),
        })
    }

    fn tolerance(
        &mut self,
        stated: &Stated<ConformityTable>,
        subject: &Subject<'_>,
    ) -> Option<(Interval, StatedTolerance)> {
        let table = &stated.value;
        if let Some(mpe) = &table.mpe {
            return self.permissible_error(table, mpe, subject);
        }
        if table.refused {
            return None;
        }
        if let Some(nominal) = &table.nominal {
            return self.refuse(
                Fault::new(
                    TOLERANCE,
                    nominal.key.clone(),
                    say!("a nominal value without `mpe`"),
                )
                .label(say!("how far from it may the value be?"))
                .help(say!("add `mpe`, the distance of both limits from it, or state `lower` and `upper` in its place")),
            );
        }
        let mut limit = |amount: &Slot<Amount>, missing: f64| match amount {
            Some(amount) => self.quantity(amount, subject.unit, subject.name),
            None => Some(missing),
        };
        let lower = limit(&table.lower, f64::NEG_INFINITY);
        let upper = limit(&table.upper, f64::INFINITY);
        let (lower, upper) = (lower?, upper?);
        match (&table.lower, &table.upper) {
            (None, None) if table.refused => None,
            (None, None) => self.refuse(
                Fault::new(
                    TOLERANCE,
                    stated.span.clone(),
                    say!("{} has no tolerance limit", subject.name),
                )
                .label(say!("`lower` and `upper` are missing"))
                .help(say!("state the permissible values: `lower`, `upper`, or both; or the maximum permissible error, `mpe`")),
            ),
            (Some(first), Some(second)) if lower >= upper => self.refuse(
                Fault::new(
                    TOLERANCE,
                    second.span.clone(),
                    say!(
                        "the tolerance limits of {} are {lower} and {upper}",
                        subject.name
                    ),
                )
                .label(say!("must be above the lower limit"))
                .related(first.span.clone(), say!("lower limit")),
            ),
            _ => Some((Interval { lower, upper }, StatedTolerance::Limits)),
        }
    }

    /// The limits nominal ± MPE.
    fn permissible_error(
        &mut self,
        table: &ConformityTable,
        mpe: &Stated<Amount>,
        subject: &Subject<'_>,
    ) -> Option<(Interval, StatedTolerance)> {
        if let Some(limit) = table.lower.as_ref().or(table.upper.as_ref()) {
            return self.refuse(
                Fault::new(
                    TOLERANCE,
                    mpe.key.clone(),
                    say!("the tolerance is stated twice, by limits and by `mpe`"),
                )
                .label(say!("the maximum permissible error"))
                .related(limit.key.clone(), say!("a limit"))
                .help(say!("keep one of them")),
            );
        }
        let nominal = match &table.nominal {
            Some(nominal) => Some(self.quantity(nominal, subject.unit, subject.name)?),
            None if subject.unit.is_point() => {
                let symbol = &subject.unit.symbol;
                return self.refuse(
                    Fault::new(
                        TOLERANCE,
                        mpe.key.clone(),
                        say!("{} is a temperature in {symbol}: from which value may it be so far?", subject.name),
                    )
                    .label(say!("`nominal` is missing"))
                    .help(say!("an error of indication is a difference, unit = \"K\", and has no nominal; of a temperature add nominal = \"100 {symbol}\"")),
                );
            }
            None => None,
        };
        if let (Some(of), Some(nominal)) = (&table.mpe_of, &table.nominal) {
            return self.refuse(
                Fault::new(
                    TOLERANCE,
                    of.key.clone(),
                    say!("`mpe_of` and `nominal` exclude one another"),
                )
                .label(say!("of an error of indication, whose limits are ±mpe"))
                .related(
                    nominal.key.clone(),
                    say!("of an indication, whose limits are nominal ± mpe"),
                )
                .help(say!("keep the one that {} is", subject.name)),
            );
        }
        let of = match &table.mpe_of {
            Some(of) if is_in_ratios(subject.unit) && self.has_dimension(of)? => {
                return self.refuse(of_a_part(of, mpe, subject));
            }
            Some(of) => Some(self.quantity(of, subject.unit, subject.name)?),
            None => nominal,
        };
        let context = Context::new(subject.name, of, subject.unit, mpe.span.clone());
        if mpe.value.number <= 0.0 {
            return self.refuse(
                Fault::new(
                    TOLERANCE,
                    mpe.span.clone(),
                    say!("the maximum permissible error is not positive"),
                )
                .label(say!("must be greater than zero"))
                .help(say!(
                    "write it without sign; both limits are `nominal` ± `mpe`"
                )),
            );
        }
        if let Some(own) = self.amount_unit(&mpe.value)?
            && is_ratio(&own.symbol)
            && !own.symbol.contains('/')
            && is_in_ratios(subject.unit)
        {
            return self.refuse(part_or_points(mpe, &own, nominal, subject));
        }
        if let Some(own) = self.amount_unit(&mpe.value)?
            && is_bare_ratio(&own)
            && of.is_none()
        {
            return self.refuse(of_nothing(mpe, subject));
        }
        let width = self.deviation(mpe, &context, Share::Unsaid)?;
        let compared = match nominal.filter(|nominal| *nominal != 0.0) {
            Some(nominal) => StatedTolerance::Nominal(nominal),
            None => StatedTolerance::Error { of },
        };
        let nominal = nominal.unwrap_or(0.0);
        Some((Interval::about(nominal, width), compared))
    }

    /// Whether an amount has a unit other than one.
    fn has_dimension(&mut self, amount: &Stated<Amount>) -> Option<bool> {
        let own = self.amount_unit(&amount.value)?;
        Some(own.is_some_and(|own| !own.dimension.is_none()))
    }

    /// An input by name that moves with the measurand.
    pub(in crate::budget::check) fn carrier(
        &mut self,
        stated: &Stated<String>,
        register: &Register,
    ) -> Option<usize> {
        let names = || register.inputs.iter().map(|input| input.name.as_str());
        if let Some(index) = names().position(|name| name == stated.value) {
            return Some(index);
        }
        self.refuse(no_such_input(stated, &names().collect::<Vec<_>>()))
    }

    /// The measurand that a decision is about.
    pub(in crate::budget::check) fn decided(
        &mut self,
        stated: &Slot<String>,
        place: &Range<usize>,
        file: &FileTable,
        table: &str,
    ) -> Option<usize> {
        if stated.is_none() && entries(&file.measurand).len() > 1 {
            let names: Vec<&str> = entries(&file.measurand)
                .iter()
                .map(|(name, _)| name.as_str())
                .collect();
            return self.refuse(
                Fault::new(
                    CLAIM,
                    place.clone(),
                    say!("[{table}] does not say which measurand it is about"),
                )
                .label(say!("`measurand` is missing"))
                .help(say!(
                    "add measurand = \"{}\" (of {})",
                    names[0],
                    names.join(", ")
                )),
            );
        }
        self.claimed(stated, place)
    }
}

/// A maximum permissible error that is a part of no value.
fn of_nothing(mpe: &Stated<Amount>, subject: &Subject<'_>) -> Fault {
    let message = say!("{} is an error: of what is its limit a part?", subject.name);
    Fault::new(RELATIVE_TO_ZERO, mpe.span.clone(), message)
        .label(say!("a fraction of what?"))
        .help(say!(
            "add the value of which it is a part, the reading or the end of the range: mpe_of = \"…\"; or write it in {}",
            subject.unit.symbol
        ))
}

/// The value of which a maximum permissible error is a part, where the error itself is stated as a part of it already.
fn of_a_part(of: &Stated<Amount>, mpe: &Stated<Amount>, subject: &Subject<'_>) -> Fault {
    let Subject { name, unit } = subject;
    Fault::new(
        TOLERANCE,
        of.key.clone(),
        say!("{name} is a relative error, and its limits are a part of nothing else"),
    )
    .label(say!("of an error that has a unit"))
    .related(mpe.key.clone(), say!("the limits of {name} itself"))
    .help(say!(
        "leave out `mpe_of`, and write `mpe` as the plain number, in {}",
        unit.symbol
    ))
}

/// A maximum permissible error in % of a quantity that is itself in %: of the nominal value, or points?
fn part_or_points(
    mpe: &Stated<Amount>,
    own: &Unit,
    nominal: Option<f64>,
    subject: &Subject<'_>,
) -> Fault {
    let Subject { name, unit } = subject;
    let number = mpe.value.number;
    let number_in = |unit: &Unit| {
        let conversion = own.conversion_to(unit);
        conversion.map_or(number, |conversion| conversion.apply(number))
    };
    let points = show(number_in(unit));
    let which = if unit.is_one() {
        Said::default()
    } else {
        say!(", which is in {}", unit.symbol)
    };
    let mut help =
        say!("write the plain number {points}{which}, if the error of {name} itself is meant");
    if let Some(nominal) = nominal {
        let part = show(number_in(&Unit::one()) * nominal.abs());
        help = say!(
            "{help}; for {number} {} of the nominal value write {part}",
            own.symbol
        );
    }
    Fault::new(
        RELATIVE_UNCLEAR,
        mpe.span.clone(),
        say!(
            "{number} {} of {name} may be meant of the nominal value or as it stands",
            own.symbol
        ),
    )
    .label(say!("relative or absolute?"))
    .help(help)
}

/// The only input, which then carries the measurand.
fn lone(register: &Register) -> Option<usize> {
    (register.inputs.len() == 1).then_some(0)
}
