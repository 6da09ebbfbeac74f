//! Type B evaluation: uncertainty from limits, certificates, specifications (GUM 4.3).

use super::amounts::Share;
use super::checker::Checker;
use super::draft::{Context, Core, Location, show};
use super::shapes::{default_shape, stated_shape};
use super::ways::Way;
use crate::budget::faults::{LIMITS, MISSING_KEY, NOT_POSITIVE, VECTOR};
use crate::budget::tables::ComponentTable;
use crate::budget::variants::Amounts;
use gumption_core::distribution::stating::Width;
use gumption_core::distribution::{Entry, Normal, Uniform};
use gumption_fault::{Fault, say};
use gumption_format::toml::Amount;
use gumption_format::toml::Stated;
use gumption_format::toml::faults::WRONG_TYPE;
use smol_str::SmolStr;

impl Checker<'_> {
    /// The component that limits, a certificate, a specification or a stated u describe.
    pub(super) fn type_b(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
    ) -> Option<Core> {
        match way {
            Way::U => {
                let u = self.single(table.u.as_ref()?, "u", context)?;
                let u = self.positive_deviation(&u, "u", context, table.share())?;
                self.shaped(
                    table,
                    Width::U(u),
                    Entry::of::<Normal>(),
                    SmolStr::new_static("u as stated"),
                    context,
                )
            }
            Way::HalfWidth => {
                let a = self.single(table.half_width.as_ref()?, "half_width", context)?;
                let a = self.positive_deviation(&a, "half_width", context, table.share())?;
                self.shaped(
                    table,
                    Width::Half(a),
                    default_shape(table),
                    format!("a = {}", show(a)),
                    context,
                )
            }
            Way::Limits => self.limits(table, context),
            Way::PlusMinus => self.plus_minus(table, context),
            Way::Certificate => self.expanded(table, context),
            Way::Specification => {
                let stated = table.specification.as_ref()?;
                let a = self.specification(stated, context)?;
                self.shaped(
                    table,
                    Width::Half(a),
                    default_shape(table),
                    format!("specification a = {}", show(a)),
                    context,
                )
            }
            Way::Step => {
                let q =
                    self.positive_deviation(table.step.as_ref()?, "step", context, Share::Unsaid)?;
                self.shaped(
                    table,
                    Width::Half(q / 2.0),
                    Entry::of::<Uniform>(),
                    format!("a = q/2 = {}", show(q / 2.0)),
                    context,
                )
            }
            Way::Bits => self.quantisation(table, context),
            _ => None,
        }
    }

    /// The one amount of a single quantity. (Lists for vectors are taken apart before.)
    fn single(
        &mut self,
        stated: &Stated<Amounts>,
        key: &str,
        context: &Context<'_>,
    ) -> Option<Stated<Amount>> {
        match &stated.value {
            Amounts::One(amount) => Some(stated.map(|_| amount.clone())),
            // The column was read already, and refused.
            Amounts::Column(table) if table.refused => None,
            Amounts::Column(_) => self.refuse(
                Fault::new(VECTOR, stated.span.clone(), say!("`{key}` of {} is a column of a CSV file", context.owner))
                    .label(say!("expected one amount"))
                    .help(say!("a column states the uncertainties of the data of a fit, or of the elements of a vector")),
            ),
            Amounts::Each(list) if key == "half_width" && list.len() == 2 => self.refuse(
                Fault::new(VECTOR, stated.span.clone(), say!("`{key}` of {} is a list, but {} is a single quantity", context.owner, context.owner))
                    .label(say!("expected one amount"))
                    .help(say!("limits that differ on both sides are minus = … and plus = …, or limits = [lower, upper]")),
            ),
            Amounts::Each(_) => self.refuse(
                Fault::new(VECTOR, stated.span.clone(), say!("`{key}` of {} is a list, but {} is a single quantity", context.owner, context.owner))
                    .label(say!("expected one amount"))
                    .help(say!("several reasons for doubt are `components = [{{ … }}, {{ … }}]`; the elements of a vector are `values = […]`")),
            ),
        }
    }

    fn limits(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let stated = table.limits.as_ref()?;
        let [lower, upper] = self.two(stated, "limits", context)?;
        if lower >= upper {
            return self.refuse(
                Fault::new(
                    LIMITS,
                    stated.span.clone(),
                    say!("the limits of {} are {lower} and {upper}", context.owner),
                )
                .label(say!("expected the lower limit first"))
                .help(if lower > upper {
                    say!("write [{upper}, {lower}]")
                } else {
                    say!("between equal limits there is no doubt: state different ones")
                }),
            );
        }
        let a = (upper - lower) / 2.0;
        let mut core = self.shaped(
            table,
            Width::Half(a),
            default_shape(table),
            format!("a = {}", show(a)),
            context,
        )?;
        core.location = Location::Between {
            expectation: lower + a,
            lower,
            upper,
        };
        Some(core)
    }

    /// Two amounts on the scale of the quantity.
    fn two(
        &mut self,
        stated: &Stated<Vec<Stated<Amount>>>,
        key: &str,
        context: &Context<'_>,
    ) -> Option<[f64; 2]> {
        let [first, second] = stated.value.as_slice() else {
            return self.refuse(
                Fault::new(
                    WRONG_TYPE,
                    stated.span.clone(),
                    say!("`{key}` has {} entries", stated.value.len()),
                )
                .label(say!("expected the lower and the upper one")),
            );
        };
        let first = self.quantity(first, context.unit, context.owner);
        let second = self.quantity(second, context.unit, context.owner);
        Some([first?, second?])
    }

    /// Limits at different distances from the value: the estimate moves to their expectation
    /// (GUM 4.3.8).
    fn plus_minus(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let (Some(plus), Some(minus)) = (&table.plus, &table.minus) else {
            let missing = if table.plus.is_none() {
                "plus"
            } else {
                "minus"
            };
            let stated = table.plus.as_ref().or(table.minus.as_ref());
            let place = stated.map_or(context.place.clone(), |stated| stated.key.clone());
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    place,
                    say!("{} lacks `{missing}`", context.owner),
                )
                .label(say!("`{missing}` is missing"))
                .help(say!(
                    "asymmetric limits need both; for symmetric ones write `half_width`"
                )),
            );
        };
        // A wear or a cosine error goes to one side only.
        let none = |amount: &Stated<Amount>| amount.value.number == 0.0;
        let (no_plus, no_minus) = (none(plus), none(minus));
        let mut side = |amount, key, left_out| match left_out {
            true => Some(0.0),
            false => self.positive_deviation(amount, key, context, table.share()),
        };
        let plus = side(plus, "plus", no_plus && !no_minus);
        let minus = side(minus, "minus", no_minus && !no_plus);
        let (plus, minus) = (plus?, minus?);
        let a = (plus + minus) / 2.0;
        let how = format!("limits +{}, -{}", show(plus), show(minus));
        let shape = stated_shape(table).unwrap_or(Entry::of::<Uniform>());
        let Some((spread, shift)) = shape.between(minus, plus) else {
            let mut core = self.shaped(table, Width::Half(a), shape, how, context)?;
            core.location = Location::Shift((plus - minus) / 2.0);
            return Some(core);
        };
        self.shape_keys(table, shape);
        let dof = self.dof(table)?;
        Some(Core {
            dof,
            location: Location::Shift(shift),
            ..Core::new(spread.distribution, spread.u, how)
        })
    }

    fn quantisation(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let (Some(bits), Some(range)) = (&table.bits, &table.range) else {
            let place = table
                .bits
                .as_ref()
                .map_or(context.place.clone(), |bits| bits.key.clone());
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    place,
                    say!("the quantiser of {} has no range", context.owner),
                )
                .label(say!("`range` is missing"))
                .help(say!(
                    "add the ends of its range: range = [0, 10] or range = [-5, 5]"
                )),
            );
        };
        let [lower, upper] = self.two(range, "range", context)?;
        if lower >= upper {
            return self.refuse(
                Fault::new(
                    LIMITS,
                    range.span.clone(),
                    say!("the range is {lower} to {upper}"),
                )
                .label(say!("lower end first")),
            );
        }
        if !(1..=64).contains(&bits.value) {
            return self.refuse(
                Fault::new(
                    NOT_POSITIVE,
                    bits.span.clone(),
                    say!("a quantiser of {} bits", bits.value),
                )
                .label(say!("expected 1 to 64")),
            );
        }
        // A correction for the digits may be zero in any range.
        let value = context.value().filter(|value| *value != 0.0);
        if let Some(value) = value.filter(|value| !(lower..=upper).contains(value)) {
            return self.refuse(
                Fault::new(
                    LIMITS,
                    range.span.clone(),
                    say!(
                        "the value {} is outside the range {lower} to {upper}",
                        show(value)
                    ),
                )
                .label(say!("does not contain the value"))
                .help(say!(
                    "correct the value, or the range in which the quantiser reads it"
                )),
            );
        }
        let step = (upper - lower) / libm::pow(2f64, bits.value as f64);
        let how = format!(
            "a = q/2, q = {}/2^{} = {}",
            show(upper - lower),
            bits.value,
            show(step)
        );
        self.shaped(
            table,
            Width::Half(step / 2.0),
            Entry::of::<Uniform>(),
            how,
            context,
        )
    }
}
