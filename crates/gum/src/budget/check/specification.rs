//! Accuracy specifications of instruments.

use super::amounts::Share;
use super::checker::Checker;
use super::draft::{Context, show};
use crate::budget::faults::{MISSING_KEY, NOT_POSITIVE, UNIT};
use crate::budget::tables::SpecificationTable;
use gumption_fault::{Fault, say};
use gumption_format::toml::Amount;
use gumption_format::toml::Stated;

impl Checker<'_> {
    pub(super) fn specification(
        &mut self,
        stated: &Stated<SpecificationTable>,
        context: &Context<'_>,
    ) -> Option<f64> {
        let table = &stated.value;
        if table.refused {
            return None;
        }
        for (key, present, partner, other) in [
            ("range", table.range.is_some(), "span", table.span.is_some()),
            (
                "counts",
                table.counts.is_some(),
                "step",
                table.step.is_some(),
            ),
        ] {
            if present != other {
                let (has, lacks) = if present {
                    (key, partner)
                } else {
                    (partner, key)
                };
                return self.refuse(
                    Fault::new(
                        MISSING_KEY,
                        stated.span.clone(),
                        say!("the specification has `{has}` and not `{lacks}`"),
                    )
                    .label(say!("`{lacks}` is missing"))
                    .help(match key {
                        "range" => say!(
                            "`range` is a part of `span`, the upper end of the range: range = \"0.001 %\", span = …"
                        ),
                        _ => say!(
                            "`counts` are steps of the display: counts = 2, step = …"
                        ),
                    }),
                );
            }
        }
        let reading = self.of_value(table.reading.as_deref(), context)?;
        let range = match (&table.range, &table.span) {
            (Some(part), Some(span)) => {
                let span = self.positive_deviation(span, "span", context, Share::Unsaid)?;
                self.remark_on_span(span, context);
                self.part(part, "range", Some(span), context)?
            }
            _ => 0.0,
        };
        let counts = match (&table.counts, &table.step) {
            (Some(counts), Some(step)) => {
                self.positive(counts, "counts")?
                    * self.positive_deviation(step, "step", context, Share::Unsaid)?
            }
            _ => 0.0,
        };
        let fixed = match &table.fixed {
            Some(fixed) => self.positive_deviation(fixed, "fixed", context, Share::Unsaid)?,
            None => 0.0,
        };
        let a = reading + range + counts + fixed;
        if a > 0.0 {
            self.remark_on_nothing(table.reading.as_deref(), context);
            return Some(a);
        }
        self.refuse(
            Fault::new(
                NOT_POSITIVE,
                stated.span.clone(),
                say!("the specification of {} allows no deviation", context.owner),
            )
            .label(say!("all parts are zero"))
            .help(say!(
                "a part of a reading that is zero is nothing: state the half-width by itself, half_width = …"
            )),
        )
    }

    /// The part `reading`, a share of the value; zero where it is not stated.
    pub(super) fn of_value(
        &mut self,
        share: Option<&Stated<Amount>>,
        context: &Context<'_>,
    ) -> Option<f64> {
        match share {
            Some(share) => self.part(share, "reading", context.value().map(f64::abs), context),
            None => Some(0.0),
        }
    }

    /// Whoever states a share of the value of a correction, whose value is zero, means a part of another quantity.
    pub(super) fn remark_on_nothing(
        &mut self,
        share: Option<&Stated<Amount>>,
        context: &Context<'_>,
    ) {
        let of_reading = share.map(|part| &part.value);
        let Some(part) =
            of_reading.filter(|part| part.number != 0.0 && context.value() == Some(0.0))
        else {
            return;
        };
        let (unit, _) = part.unit.clone().unwrap_or_default();
        self.remark(say!(
            "{} {unit} of the value of {}, which is 0, is nothing. If it is a share of another quantity, state it there, or what it comes to as an amount (`fixed`; in a certificate within U).",
            part.number,
            context.owner
        ));
    }

    /// A value beyond the range of which an accuracy is stated: mostly a span in another unit.
    fn remark_on_span(&mut self, span: f64, context: &Context<'_>) {
        let Some(value) = context.value().filter(|value| value.abs() > span) else {
            return;
        };
        let (owner, unit) = (context.owner, &context.unit.symbol);
        self.remark(say!("The value of {owner}, {} {unit}, lies beyond the span of its specification, {} {unit}. Unless the instrument reads so far, state the span with its unit: span = \"…\".", show(value), show(span)));
    }

    /// A stated fraction of the reading or of the range.
    fn part(
        &mut self,
        amount: &Stated<Amount>,
        key: &str,
        whole: Option<f64>,
        context: &Context<'_>,
    ) -> Option<f64> {
        if amount.value.unit.is_none() {
            return self.refuse(
                Fault::new(
                    UNIT,
                    amount.span.clone(),
                    say!("`{key}` does not say whether it is a fraction or a percentage"),
                )
                .label(say!("a unit is missing"))
                .help(say!(
                    "write {key} = \"{} %\" or \"{} ppm\"; of a fraction, {key} = \"{} %\"",
                    amount.value.number,
                    amount.value.number,
                    show(100.0 * amount.value.number)
                )),
            );
        }
        // The part is relative to `whole`, whatever the unit of the input.
        let of_whole = context.at(whole);
        if amount.value.number == 0.0 || whole == Some(0.0) {
            return Some(0.0);
        }
        self.positive_deviation(amount, key, &of_whole, Share::OfValue)
    }
}
