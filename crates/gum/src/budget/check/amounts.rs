//! Units and amounts: from "25 µV" to a number in the unit of its input.

use std::ops::Range;

use super::checker::Checker;
use super::draft::{Context, show};
use super::entries::entries;
use super::units;
use crate::budget::faults::{NOT_POSITIVE, RELATIVE_TO_ZERO, RELATIVE_UNCLEAR, UNIT_CLASH};
use crate::budget::tables::{ComponentTable, FileTable};
use gumption_core::quantity::{Unit, hint_for_clash, per_coulomb, revolutions_as_angle};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::Amount;
use gumption_format::toml::{Slot, Stated};

/// Whether a unit of dimension one names a ratio, of which one asks "of what?" (in contrast to angles).
pub(super) fn is_ratio(symbol: &str) -> bool {
    matches!(symbol, "%" | "‰" | "ppm" | "ppb" | "ppt" | "1") || symbol.contains('/')
}

/// The mend of "0.25 % FS" and "0.1 % of 10 V": shares of a range or of a reading are parts of a specification.
fn share_of(unit: &str) -> Option<Said> {
    let (share, of) = ["%", "‰", "ppm"]
        .into_iter()
        .find_map(|share| Some((share, unit.strip_prefix(share)?)))?;
    let of = of.to_lowercase().replace('.', "");
    Some(match of.split_whitespace().next()? {
        "fs" | "fso" | "span" | "range" | "满量程" => {
            say!(
                "a share of a range is specification = {{ range = \"… {share}\", span = … }}, in [conformity] mpe = \"… {share}\" with mpe_of = …"
            )
        }
        "rdg" | "reading" | "rd" | "读数" => {
            say!(
                "a share of the value is the plain \"… {share}\", beside others specification = {{ reading = \"… {share}\", … }}"
            )
        }
        "of" => say!(
            "a share of a range is specification = {{ range = \"… {share}\", span = … }}, a share of the value the plain \"… {share}\""
        ),
        _ => return None,
    })
}

/// Whether a quantity in this unit is itself such a ratio, so that `2 %` of it has two meanings.
pub(in crate::budget) fn is_in_ratios(unit: &Unit) -> bool {
    unit.dimension.is_none() && (is_ratio(&unit.symbol) || unit.symbol.starts_with('%'))
}

/// Whether a unit is a share of something, % or ppm, that does not say of what.
pub(in crate::budget) fn is_bare_ratio(unit: &Unit) -> bool {
    unit.dimension.is_none() && is_ratio(&unit.symbol) && !unit.symbol.contains('/')
}

/// What `relative` says of the figures beside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Share {
    /// Nothing: their units tell.
    Unsaid,
    /// They are fractions of the value.
    OfValue,
    /// They are amounts in the unit of the quantity, also those in per cent.
    AsItStands,
}

impl ComponentTable {
    /// What its figures are said to be a part of.
    pub(super) fn share(&self) -> Share {
        match self.relative.as_ref().map(|stated| stated.value) {
            None => Share::Unsaid,
            Some(true) => Share::OfValue,
            Some(false) => Share::AsItStands,
        }
    }
}

impl Checker<'_> {
    /// Reads the `[unit]` table.
    pub(super) fn define_units(&mut self, file: &FileTable) {
        let (units, faults) = units::defined(entries(&file.unit), self.source.text);
        self.names.units = units;
        self.messages.faults.extend(faults);
    }

    /// A stated unit; dimension one when none is stated, nothing when it was refused.
    pub(super) fn unit(&mut self, stated: &Slot<String>) -> Option<Unit> {
        let Some(stated) = stated else {
            return Some(Unit::one());
        };
        let files = self.source.origin.files;
        match files.unit(&self.names.units, &stated.value) {
            Ok(unit) => {
                if let Some(remark) = per_coulomb(&unit) {
                    self.remark(remark);
                }
                Some(unit)
            }
            Err(error) => {
                let fault = units::placed(Fault::from(error), stated, self.source.text);
                self.refuse(match share_of(&stated.value) {
                    Some(mend) => fault.help(mend),
                    None => fault,
                })
            }
        }
    }

    /// The unit of an amount, if it has one of its own.
    pub(super) fn amount_unit(&mut self, amount: &Amount) -> Option<Option<Unit>> {
        match &amount.unit {
            None => Some(None),
            Some((text, span)) => {
                let stated = Stated {
                    value: text.clone(),
                    span: span.clone(),
                    key: span.clone(),
                };
                self.unit(&Some(Box::new(stated))).map(Some)
            }
        }
    }

    /// The unit that a table states, or else that of its value: `value = "20.5 °C"` says both.
    pub(super) fn unit_or_of_value(
        &mut self,
        unit: &Slot<String>,
        value: &Slot<Amount>,
    ) -> Option<Unit> {
        match (unit, value) {
            (None, Some(amount)) => self
                .amount_unit(&amount.value)
                .map(|own| own.unwrap_or_else(Unit::one)),
            _ => self.unit(unit),
        }
    }

    /// A value of a quantity in its unit (a point on the scale, for °C).
    pub(super) fn quantity(
        &mut self,
        amount: &Stated<Amount>,
        unit: &Unit,
        owner: &str,
    ) -> Option<f64> {
        let Some(own) = self.amount_unit(&amount.value)? else {
            return Some(amount.value.number);
        };
        let Some(conversion) = own.conversion_to(unit) else {
            let fault = clash(amount, &own, unit, owner);
            return self.refuse(fault);
        };
        let number = conversion.apply(amount.value.number);
        // 5 % of mg/kg is no value that anybody reads as 50 000 mg/kg.
        if is_bare_ratio(&own) && unit.symbol.contains('/') && !own.is_one() {
            let fault = share_of_what(amount, &own, unit, owner);
            return self.refuse(fault);
        }
        match (own.is_point(), unit.is_point()) {
            (true, false) => {
                let fault = point_for_difference(amount, &own, unit, owner, number);
                self.refuse(fault)
            }
            _ if revolutions_as_angle(&own, unit, owner).is_some() => {
                let fault = counted_revolutions(amount, &own, unit, owner);
                self.refuse(fault)
            }
            (false, true) if amount.value.number < 0.0 => {
                let fault = below_absolute_zero(amount, &own, unit, owner);
                self.refuse(fault)
            }
            _ => Some(number),
        }
    }

    /// A difference of two values of a quantity, in the unit of its differences: `"0.5 °C"` is 0.5 K.
    pub(super) fn difference(
        &mut self,
        amount: &Stated<Amount>,
        unit: &Unit,
        owner: &str,
    ) -> Option<f64> {
        let unit = unit.difference();
        let Some(own) = self.amount_unit(&amount.value)? else {
            return Some(amount.value.number);
        };
        if is_bare_ratio(&own) && is_in_ratios(&unit) && !own.is_one() {
            let fault = share_of_what(amount, &own, &unit, owner);
            return self.refuse(fault);
        }
        self.difference_in(amount, &own.difference(), &unit, owner)
    }

    /// The same, of an amount in `own` that is asked for in `unit`.
    fn difference_in(
        &mut self,
        amount: &Stated<Amount>,
        own: &Unit,
        unit: &Unit,
        owner: &str,
    ) -> Option<f64> {
        let fault = match own.conversion_to(unit) {
            Some(_) if revolutions_as_angle(own, unit, owner).is_some() => {
                counted_revolutions(amount, own, unit, owner)
            }
            Some(conversion) => return Some(conversion.apply(amount.value.number)),
            None => clash(amount, own, unit, owner),
        };
        self.refuse(fault)
    }

    /// A deviation of a quantity, in the unit of its differences. Amounts such as `50 ppm`, and all
    /// numbers where the file says so, are fractions of the value.
    pub(super) fn deviation(
        &mut self,
        amount: &Stated<Amount>,
        context: &Context<'_>,
        share: Share,
    ) -> Option<f64> {
        let number = amount.value.number;
        let relative = share == Share::OfValue;
        let unit = context.unit.difference();
        let Some(own) = self.amount_unit(&amount.value)? else {
            return match relative {
                true if number >= 1.0 => self.refuse(percent_meant(amount, context)),
                true => self.fraction(amount, number, context),
                false => Some(number),
            };
        };
        let own = own.difference();
        let one = Unit::one();
        if own.dimension == one.dimension && share != Share::AsItStands {
            let fraction = own
                .conversion_to(&one)
                .map_or(number, |conversion| conversion.apply(number));
            // In its own unit, mm/m, nobody means a fraction of the value.
            let plain = !relative && own.symbol == unit.symbol && own.symbol.contains('/');
            if plain {
                return Some(number);
            }
            if relative || (is_ratio(&own.symbol) && !is_in_ratios(&unit)) {
                self.remark_on_level(amount, &own, &unit, context);
                return self.fraction(amount, fraction, context);
            }
            // A source has no value that its amounts could be relative to, nothing is a part of zero, and of one both
            // meanings are the same.
            let unclear = |value: f64| {
                unit.symbol.contains('/') || value != 0.0 && !(value == 1.0 && unit.is_one())
            };
            if is_ratio(&own.symbol) && context.value().is_some_and(unclear) {
                let absolute = one
                    .conversion_to(&unit)
                    .map_or(number, |conversion| conversion.apply(fraction));
                if self.is_content(&unit)
                    && context.value().is_some_and(|value| absolute > value.abs())
                {
                    return self.fraction(amount, fraction, context);
                }
                return self.refuse(
                    Fault::new(
                        RELATIVE_UNCLEAR,
                        amount.span.clone(),
                        say!(
                            "{number} {} of {} may be meant of its value or as it stands",
                            own.symbol,
                            context.owner
                        ),
                    )
                    .label(say!("relative or absolute?"))
                    .help(ratio_help(context, number, fraction, &unit)),
                );
            }
        }
        if relative && own.dimension == unit.dimension {
            return self.refuse(
                Fault::new(
                    UNIT_CLASH,
                    amount.span.clone(),
                    say!("a relative uncertainty in {}", own.symbol),
                )
                .label(say!("has a unit"))
                .help(say!(
                    "write a fraction (\"0.1 %\", \"50 ppm\"); an amount with a unit stands without `relative`, and in a specification as `fixed`"
                )),
            );
        }
        self.difference_in(amount, &own, &unit, context.owner)
    }

    /// A share of a level, which is a part of its number: mostly the ratio is meant, of which the level is the logarithm.
    fn remark_on_level(
        &mut self,
        amount: &Stated<Amount>,
        own: &Unit,
        unit: &Unit,
        context: &Context<'_>,
    ) {
        let level = self.names.units.parse("dB");
        if level.is_ok_and(|level| level.dimension == unit.dimension) {
            let (number, owner) = (amount.value.number, context.owner);
            self.remark(say!("{owner}: {number} {} of a level is taken of its number in {}. If the ratio is meant of which it is the logarithm, state the uncertainty in {1}.", own.symbol, unit.symbol));
        }
    }

    /// Whether a unit is that of a content, mg/kg or mmol/mol: an uncertainty larger than the content itself is not what
    /// anybody means by a percentage of it.
    fn is_content(&self, unit: &Unit) -> bool {
        let is_amount = |symbol: &str| {
            let own = self.names.units.parse(symbol.trim()).ok();
            let of_amounts = ["kg", "mol", "L"]
                .into_iter()
                .filter_map(|amount| self.names.units.parse(amount).ok());
            let of_amounts: Vec<Unit> = of_amounts.collect();
            own.is_some_and(|own| {
                of_amounts
                    .iter()
                    .any(|amount| amount.dimension == own.dimension)
            })
        };
        unit.symbol
            .split_once('/')
            .is_some_and(|(part, whole)| is_amount(part) && is_amount(whole))
    }

    /// A deviation that must be greater than zero.
    pub(super) fn positive_deviation(
        &mut self,
        amount: &Stated<Amount>,
        key: &str,
        context: &Context<'_>,
        share: Share,
    ) -> Option<f64> {
        if amount.value.number > 0.0 {
            return self.deviation(amount, context, share);
        }
        let fault = Fault::new(
            NOT_POSITIVE,
            amount.span.clone(),
            say!("`{key}` of {} is {}", context.owner, amount.value.number),
        )
        .label(say!("must be greater than zero"));
        self.refuse(if amount.value.number < 0.0 {
            fault.help(say!("write it without sign"))
        } else {
            fault.help(say!("leave the component out if there is no such doubt; an exact number belongs into [constant]"))
        })
    }

    fn fraction(
        &mut self,
        amount: &Stated<Amount>,
        fraction: f64,
        context: &Context<'_>,
    ) -> Option<f64> {
        match context.value() {
            Some(value) if value != 0.0 => Some(fraction * value.abs()),
            Some(_) => self.refuse(
                Fault::new(
                    RELATIVE_TO_ZERO,
                    amount.span.clone(),
                    say!("relative to the value of {}, which is 0", context.owner),
                )
                .label(say!("a fraction of 0 is 0"))
                .help(say!(
                    "state it absolutely, in {}",
                    context.unit.difference().symbol
                )),
            ),
            None => self.refuse(
                Fault::new(
                    RELATIVE_TO_ZERO,
                    amount.span.clone(),
                    say!(
                        "relative to {}, which has no value of its own",
                        context.owner
                    ),
                )
                .label(say!("a fraction of what?"))
                .help(say!(
                    "state it absolutely, in {}",
                    context.unit.difference().symbol
                )),
            ),
        }
    }
}

/// A share of a quantity that is itself a ratio: of its value, or as it stands?
fn share_of_what(amount: &Stated<Amount>, own: &Unit, unit: &Unit, owner: &str) -> Fault {
    let number = amount.value.number;
    let plain = own.conversion_to(unit);
    let plain = show(plain.map_or(number, |conversion| conversion.apply(number)));
    let (symbol, within) = (
        &own.symbol,
        match unit.is_one() {
            true => Said::default(),
            false => say!(", in {}", unit.symbol),
        },
    );
    Fault::new(
        RELATIVE_UNCLEAR,
        amount.span.clone(),
        say!("{number} {symbol} of {owner} may be meant of its value or as it stands"),
    )
    .label(say!("relative or absolute?"))
    .help(say!(
        "as it stands, write the plain number {plain}{within}; of the value, write what {number} {symbol} of it is{within}"
    ))
}

/// The two readings of `"1 %"` for a quantity that is itself a ratio, with their numbers.
fn ratio_help(context: &Context<'_>, number: f64, fraction: f64, unit: &Unit) -> Said {
    let relative = match context.value() {
        Some(value) => say!(
            "for {} of the value {} write {} with relative = true beside it (of a certificate, not between its braces)",
            show(fraction),
            show(value),
            show(fraction)
        ),
        None => say!(
            "for a fraction of the value write {} with relative = true beside it (of a certificate, not between its braces)",
            show(fraction)
        ),
    };
    let absolute = Unit::one()
        .conversion_to(unit)
        .map_or(number, |conversion| conversion.apply(fraction));
    let name = if unit.is_one() {
        Said::default()
    } else {
        say!(" (in {})", unit.symbol)
    };
    say!(
        "{relative}; for an absolute amount write the plain number {}{name}",
        show(absolute)
    )
}

/// A plain number that is relative and 1 or more: hardly a fraction.
fn percent_meant(amount: &Stated<Amount>, context: &Context<'_>) -> Fault {
    let number = amount.value.number;
    Fault::new(
        RELATIVE_UNCLEAR,
        amount.span.clone(),
        say!(
            "a relative uncertainty of {number} is {} % of the value of {}",
            show(100.0 * number),
            context.owner
        ),
    )
    .label(say!("a fraction"))
    .help(say!(
        "write \"{number} %\" if per cent are meant, or \"{} %\"",
        show(100.0 * number)
    ))
}

/// Where the unit of an amount is, or the amount where it has none.
fn place_of_unit(amount: &Stated<Amount>) -> Range<usize> {
    let unit = amount.value.unit.as_ref();
    unit.map_or(amount.span.clone(), |(_, span)| span.clone())
}

/// Revolutions that are an angle in one of two units and counted in the other.
fn counted_revolutions(amount: &Stated<Amount>, own: &Unit, unit: &Unit, owner: &str) -> Fault {
    clash(amount, own, unit, owner).help(say!(
        "a revolution is an angle, 2π, in r/min, °/s and rad/s, and counted in Hz, 1/min and seconds: state the amount in {}",
        unit.symbol
    ))
}

/// A temperature in °C where the quantity is in K: the difference of so many °C, or the point?
fn point_for_difference(
    amount: &Stated<Amount>,
    own: &Unit,
    unit: &Unit,
    owner: &str,
    converted: f64,
) -> Fault {
    let number = amount.value.number;
    let difference = own.difference();
    Fault::new(
        UNIT_CLASH,
        place_of_unit(amount),
        say!(
            "{number} {} is a point on a scale, but {owner} is in {}",
            own.symbol, unit.symbol
        ),
    )
    .label(say!("a point on the {} scale", own.symbol))
    .help(say!(
        "a difference, a correction or a limit of one is \"{number} {}\"; the thermodynamic temperature of this point is \"{} {}\"",
        difference.symbol,
        show(converted),
        unit.symbol
    ))
}

/// A negative amount in K where the quantity is a temperature in °C.
fn below_absolute_zero(amount: &Stated<Amount>, own: &Unit, unit: &Unit, owner: &str) -> Fault {
    let number = amount.value.number;
    Fault::new(
        UNIT_CLASH,
        place_of_unit(amount),
        say!(
            "{owner} is a temperature in {}, and {number} {} lies below the absolute zero",
            unit.symbol, own.symbol
        ),
    )
    .label(say!("read as a thermodynamic temperature"))
    .help(say!(
        "state the point on the scale, \"{number} {0}\"; where {owner} is a difference or a correction, its unit is {1}: unit = \"{1}\"",
        unit.symbol,
        unit.difference().symbol
    ))
}

fn clash(amount: &Stated<Amount>, own: &Unit, unit: &Unit, owner: &str) -> Fault {
    let fault = Fault::new(
        UNIT_CLASH,
        place_of_unit(amount),
        say!(
            "{} cannot be converted to {}, the unit of {owner}",
            own.symbol,
            unit.symbol
        ),
    )
    .label(say!("expected a unit like {}", unit.symbol));
    if let Some(hint) = hint_for_clash(unit, own) {
        fault.help(hint)
    } else if unit.is_one() {
        fault.help(say!(
            "add the missing unit to {owner}: unit = \"{}\"",
            own.symbol
        ))
    } else {
        fault.help(say!(
            "write the amount in a unit like {0}, or as a plain number, which is in {0}",
            unit.symbol
        ))
    }
}
