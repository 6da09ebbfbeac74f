//! Results stated with their uncertainty: `y = (50.001 ± 0.054) mm`.

use crate::printed::{Printed, leading};
use crate::units;

use super::words::has;

/// The result that a text states, and its expanded uncertainty. Of an air temperature of (20 ± 5) °C it is not said that it is
/// the result, unless that is known to be this.
pub(super) fn of_result(text: &str, known: Option<&Printed>) -> Option<(Printed, Printed)> {
    let (front, behind) = text.split_once('±')?;
    let (expanded, rest) = leading(behind)?;
    let unit = unit_of(rest);
    let y = last_figure(front)?;
    let y = match y.unit.is_empty() {
        true => with_unit(y, unit),
        false => y,
    };
    let is_known = known.is_some_and(|known| is_same(known, &y));
    let is_said = front.contains('=')
        || has(
            &text.to_lowercase(),
            &["result", "结果", "uncertainty", "不确定度", "k =", "k="],
        );
    (is_known || is_said).then(|| (y, with_unit(expanded, unit)))
}

fn with_unit(figure: Printed, unit: &str) -> Printed {
    let unit = unit.into();
    Printed { unit, ..figure }
}

/// The unit behind the figures of `(50.001 ± 0.054) mm` and `50.001 mm ± 0.054 mm.`
fn unit_of(rest: &str) -> &str {
    let rest = rest.trim_start_matches([')', ' ']);
    let mut parts = rest.split([' ', ',', ';', '(', '，', '；', '（', '。']);
    parts.next().unwrap_or_default().trim_end_matches('.')
}

/// The figure at the end of a text, with its unit if it has one: `10 000.025` of `m = (10 000.025`.
fn last_figure(front: &str) -> Option<Printed> {
    let begins = |at: &usize| {
        let before = front[..*at].chars().next_back();
        before.is_none_or(|c| " (=≈:：".contains(c) || !c.is_ascii())
    };
    let places = (0..front.len()).filter(|at| front.is_char_boundary(*at));
    let whole = places.filter(begins).find_map(|at| {
        let (figure, rest) = leading(&front[at..])?;
        let unit = rest.trim();
        let is_end = unit.is_empty() || units::parse(unit).is_some();
        is_end.then(|| with_unit(figure, unit))
    });
    // What stands behind the last figure may be a unit that is not known.
    let in_words = || front.rsplit(['(', '=', ' ']).find_map(leading);
    whole.or_else(|| in_words().map(|(figure, _)| figure))
}

/// Whether a figure is the result that is known, if need be in another unit.
fn is_same(known: &Printed, y: &Printed) -> bool {
    let factor = match known.unit.is_empty() || y.unit.is_empty() {
        true => Some(1.0),
        false => units::factor(&y.unit, &known.unit),
    };
    factor.is_some_and(|factor| {
        let half = known.half.max(y.half * factor);
        known.is_met_within(y.value * factor, half)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_stated_with_their_uncertainty() {
        let known = Printed::parse("10 000.025 g");
        for (text, y, expanded) in [
            ("(10 000.025 ± 0.095) g", 10000.025, "g"),
            (
                "The mass of the 10 kg weight is 10.000 025 kg ± 95 mg.",
                10.000025,
                "mg",
            ),
            ("m = (50.001 ± 0.054) mm; k = 2", 50.001, "mm"),
            ("result: 50.001 mm ± 0.054 mm", 50.001, "mm"),
        ] {
            let (own, reported) = of_result(text, known.as_ref()).unwrap();
            assert_eq!((own.value, reported.unit.as_str()), (y, expanded), "{text}");
        }
        assert_eq!(
            of_result("Air temperature (20 ± 5) °C", known.as_ref()),
            None
        );
    }
}
