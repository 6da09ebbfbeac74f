//! Whether a name that a diagnosis gives is right for a physics.

use super::answer::{Name, Variant};
use crate::effect::Physics;
use crate::names::accepted;

/// Whether a name is right for a physics.
pub fn accepts(physics: Physics, name: &Name) -> bool {
    accepted(physics).iter().any(|(id, along)| {
        (name.id == *id || holds(name, id))
            && (along.is_empty() || along.iter().any(|column| mentions(&name.along, column)))
    })
}

/// Whether a name leaves open that it is an effect in another order.
fn holds(name: &Name, id: &str) -> bool {
    /// An order with less than this share is ruled out.
    const OPEN: f64 = 0.01;
    let order = |variant: &Variant| variant.id == id && variant.share >= OPEN;
    name.variants.iter().any(order)
}

/// Whether a list of columns mentions one.
fn mentions(along: &str, column: &str) -> bool {
    along
        .split(|c: char| !c.is_alphanumeric())
        .any(|word| word == column)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(id: &str, along: &str) -> Name {
        let text = format!(r#"{{"id":"{id}","family":"","along":"{along}","probability":1}}"#);
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn the_column_matters_where_it_makes_the_physics() {
        assert!(accepts(Physics::Supply, &name("sensitivity", "supply")));
        assert!(!accepts(Physics::Supply, &name("sensitivity", "humidity")));
        assert!(accepts(Physics::ThirdOrder, &name("cubic", "head")));
        assert!(!accepts(Physics::LocalRub, &name("cubic", "head")));
    }
}
