//! What if: numbers of a budget that the page moves in the text itself. Correlation coefficients, degrees of freedom, and how many readings
//! there are.

use std::ops::Range;

use serde_json::{Value, json};

use gumption_core::statistics::{Dd, Series};
use gumption_format::toml::{Places, Step, StringMap};

/// The numbers of a text that can be moved, each with its path and what it is called.
pub(crate) fn movable(text: &str) -> Vec<Value> {
    let Some(places) = Places::of(text) else {
        return Vec::new();
    };
    let scalars = places.scalars();
    let numbers = scalars
        .iter()
        .filter_map(|entry| number(text, &scalars, entry));
    let counts = scalars.iter().filter_map(|(path, _)| count(&places, path));
    numbers.chain(counts).collect()
}

/// As many readings as are wished for, as they would be typed: those of the text, again from the first where there are too few, with the mean and
/// the experimental standard deviation of those of the text. Nothing where there are no readings that scatter.
pub(crate) fn as_many(text: &str, path: &[Step], n: usize) -> Option<String> {
    let readings = readings(&Places::of(text)?, path)?;
    let stated = scattering(&readings)?;
    let again = |from: usize| -> Vec<f64> {
        let readings = readings.iter().cycle().skip(from);
        readings.take(n.max(2)).copied().collect()
    };
    // A few of them may be equal; not all neighbours are.
    let taken = (0..readings.len()).find_map(|from| scattering(&again(from)))?;
    let stretch = stated.standard_deviation() / taken.standard_deviation();
    let typed = taken.deviations().map(|deviation| {
        let reading = stated.mean() + deviation * stretch;
        format!("{reading:?}")
    });
    Some(typed.collect::<Vec<_>>().join(", "))
}

/// A correlation coefficient, or degrees of freedom.
fn number(
    text: &str,
    scalars: &[(Vec<Step>, Range<usize>)],
    (path, span): &(Vec<Step>, Range<usize>),
) -> Option<Value> {
    let number: f64 = text[span.clone()].parse().ok()?;
    let [Step::Key(table), .., Step::Key(key)] = path.as_slice() else {
        return None;
    };
    let parent = &path[..path.len() - 1];
    let said = |at| {
        let path = [parent, &[Step::Key("between".into()), Step::Index(at)]].concat();
        let (_, span) = scalars.iter().find(|(at, _)| *at == path)?;
        StringMap::new(text, span.clone()).map(|map| map.text().to_owned())
    };
    let name = match (table.as_str(), key.as_str()) {
        ("correlation", "r") => format!("r({}, {})", said(0)?, said(1)?),
        ("input", "dof") => format!("ν({})", component(parent)),
        _ => return None,
    };
    number.is_finite().then(|| entry(path, &name, key, number))
}

/// How many readings of an input or of a component there are, at the first of them.
fn count(places: &Places<'_>, first: &[Step]) -> Option<Value> {
    let (Step::Index(0), list) = first.split_last()? else {
        return None;
    };
    scattering(&readings(places, list)?)?;
    let (Step::Key(key), owner) = list.split_last()? else {
        return None;
    };
    let is_own = match owner {
        [Step::Key(table), Step::Key(_)] => table == "input",
        [
            Step::Key(table),
            Step::Key(_),
            Step::Key(inner),
            Step::Index(_),
        ] => table == "input" && inner == "components",
        _ => false,
    };
    // More readings of a series that is correlated are not told by those at hand.
    let serial = [owner, &[Step::Key("autocorrelated".into())]].concat();
    let is_moved = key == "readings" && is_own && places.value(&serial).is_none();
    let n = readings(places, list)?.len() as f64;
    is_moved.then(|| entry(list, &format!("n({})", component(owner)), key, n))
}

/// A list of plain numbers.
fn readings(places: &Places<'_>, path: &[Step]) -> Option<Vec<f64>> {
    let span = places.value(path)?.span.clone();
    let typed = format!("x = {}", &places.text[span]);
    let list = typed.parse::<toml::Table>().ok()?.remove("x")?;
    let number = |one: &toml::Value| match one {
        toml::Value::Integer(whole) => Some(*whole as f64),
        other => other.as_float().filter(|number| number.is_finite()),
    };
    list.as_array()?.iter().map(number).collect()
}

/// The statistics of readings of which not all are equal.
fn scattering(readings: &[f64]) -> Option<Series> {
    let exact: Vec<Dd> = readings.iter().map(|one| Dd::from_decimal(*one)).collect();
    let series = (exact.len() > 1).then(|| Series::new(&exact))?;
    (series.standard_deviation() > 0.0).then_some(series)
}

/// The component that a path leads to: `V`, or `V, 2`.
fn component(path: &[Step]) -> String {
    let steps = path[1..].iter().filter_map(|step| match step {
        Step::Key(key) if ["components", "certificate"].contains(&key.as_str()) => None,
        Step::Key(key) => Some(key.clone()),
        Step::Index(at) => Some((at + 1).to_string()),
    });
    steps.collect::<Vec<_>>().join(", ")
}

fn entry(path: &[Step], name: &str, key: &str, value: f64) -> Value {
    json!({ "path": path, "name": name, "key": key, "value": value })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str) -> Vec<Value> {
        let found = movable(text).into_iter();
        found
            .map(|one| json!([one["name"], one["value"], one["path"]]))
            .collect()
    }

    #[test]
    fn coefficients_and_degrees_of_freedom_are_movable() {
        let text = "[[correlation]]\nbetween = [\"a\", \"b\"]\nr = 0.3\n[input.a]\ndof = 4\n[input]\n\
            b.components = [{ u = 1 }, { u = 2, dof = 9 }]\nc.dof = inf\nd = { certificate = { dof = 7 } }\n";
        assert_eq!(
            shown(text),
            [
                json!(["r(a, b)", 0.3, ["correlation", 0, "r"]]),
                json!(["ν(a)", 4.0, ["input", "a", "dof"]]),
                json!(["ν(b, 2)", 9.0, ["input", "b", "components", 1, "dof"]]),
                json!(["ν(d)", 7.0, ["input", "d", "certificate", "dof"]]),
            ]
        );
    }

    #[test]
    fn numbers_of_readings_are_movable_where_they_scatter() {
        let text = "[input]\na.readings = [1, 2.5, 2]\nb.readings = [1, 1]\nc = { readings = [1, 2], autocorrelated = true }\n\
            d.components = [{ u = 1 }, { readings = [\n  3, # the first\n  4,\n] }]\ne.readings = [\"1 V\", \"2 V\"]\n\
            [fit.f.data.x]\nreadings = [1, 2]\n";
        assert_eq!(
            shown(text),
            [
                json!(["n(a)", 3.0, ["input", "a", "readings"]]),
                json!(["n(d, 2)", 2.0, ["input", "d", "components", 1, "readings"]]),
            ]
        );
    }

    #[test]
    fn more_or_fewer_readings_scatter_as_those_of_the_text() {
        let text = "[input.a]\nreadings = [10.1, 10.1, 10.4, 10.2]\n";
        let path = [
            Step::Key("input".into()),
            Step::Key("a".into()),
            Step::Key("readings".into()),
        ];
        // Mean 10.2, s = √(0.06/3).
        for n in [2, 3, 4, 5, 40] {
            let typed = as_many(text, &path, n).expect("readings");
            let readings: Vec<f64> = typed
                .split(", ")
                .map(|one| one.parse().expect("a number"))
                .collect();
            let mean = readings.iter().sum::<f64>() / n as f64;
            let squares: f64 = readings.iter().map(|one| (one - mean).powi(2)).sum();
            assert_eq!(readings.len(), n);
            assert!((mean - 10.2).abs() < 1e-12, "{typed}");
            assert!((squares / (n as f64 - 1.0) - 0.02).abs() < 1e-12, "{typed}");
        }
        assert_eq!(as_many(text, &path[..2], 3), None);
        assert_eq!(as_many("[input.a]\nreadings = [1, 1]\n", &path, 3), None);
    }
}
