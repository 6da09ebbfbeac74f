//! Whether a name that a diagnosis gives is right for an effect.

use super::answer::{Name, Variant};
use crate::names::Accepted;
use crate::truth::TrueEffect;

/// Whether a name is right for an effect.
pub fn accepts(truth: &TrueEffect, name: &Name) -> bool {
    truth.names.iter().any(|accepted| is(name, accepted))
}

/// Whether a name is right for an effect, or for another that gives the same recording: which of the two it was, nobody
/// can know.
pub(super) fn accepts_or_alias(truth: &TrueEffect, name: &Name) -> bool {
    accepts(truth, name) || truth.aliases.iter().any(|alias| is(name, alias))
}

/// Whether a name leaves open which of two effects it is that give the same recording.
pub(super) fn tells_both(truth: &TrueEffect, name: &Name) -> bool {
    let tells = |accepted: &Accepted| is(name, accepted);
    truth.names.iter().any(tells) && truth.aliases.iter().any(tells)
}

/// Where the readings hardly vary, a name says which effect on the scale gives the same.
fn is(name: &Name, accepted: &Accepted) -> bool {
    (name.id == accepted.id
        || name.on_scale.as_ref() == Some(&accepted.id)
        || holds(name, &accepted.id))
        && (accepted.along.is_empty()
            || [&name.along, &name.node].iter().any(|place| {
                let mut columns = accepted.along.iter();
                columns.any(|column| mentions(place, column))
            }))
}

/// Whether a name leaves open that it is an effect in another order.
fn holds(name: &Name, id: &str) -> bool {
    /// An order with less than this share is ruled out.
    const OPEN: f64 = 0.01;
    let order = |variant: &Variant| variant.id == id && variant.share >= OPEN;
    name.variants.iter().any(order)
}

/// Whether a list of columns mentions one.
fn mentions(columns: &str, column: &str) -> bool {
    columns
        .split(|c: char| !c.is_alphanumeric())
        .any(|word| word == column)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(id: &str, along: &str) -> Name {
        let text = format!(r#"{{"id":"{id}","along":"{along}"}}"#);
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn the_column_matters_where_it_makes_the_physics() {
        let accepted = Accepted {
            id: "sensitivity".into(),
            along: vec!["supply".into()],
        };
        let truth = TrueEffect {
            names: vec![accepted],
            ..TrueEffect::default()
        };
        assert!(accepts(&truth, &name("sensitivity", "supply")));
        assert!(!accepts(&truth, &name("sensitivity", "humidity")));
        assert!(!accepts(&TrueEffect::default(), &name("cubic", "head")));
    }

    /// What follows the past of a column acts on the column along time.
    #[test]
    fn a_lag_is_behind_the_column_that_it_acts_on() {
        let accepted = Accepted {
            id: "temperature-lag".into(),
            along: vec!["t".into()],
        };
        let truth = TrueEffect {
            names: vec![accepted],
            ..TrueEffect::default()
        };
        let behind = |node: &str| Name {
            node: node.into(),
            ..name("temperature-lag", "time")
        };
        assert!(accepts(&truth, &behind("t")));
        assert!(!accepts(&truth, &behind("temperature")));
    }

    #[test]
    fn a_name_that_says_or_on_the_scale_says_both() {
        let truth = TrueEffect {
            names: vec![Accepted {
                id: "step-scale".into(),
                along: Vec::new(),
            }],
            ..TrueEffect::default()
        };
        let step = name("step", "time");
        assert!(!accepts(&truth, &step));
        let on_scale = Some("step-scale".into());
        assert!(accepts(&truth, &Name { on_scale, ..step }));
    }
}
