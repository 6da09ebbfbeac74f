//! Quantities of the D-SI: single values and lists, with the uncertainty in each of its forms.

use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::{Said, say};
use roxmltree::Node;

use super::xml::{self, Faults, at, child, children, fault, numbers, text};

/// One value with its uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Value {
    pub value: f64,
    pub unit: Unit,
    pub uncertainty: Option<Uncertainty>,
}

/// U with what leads back to u.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Uncertainty {
    pub expanded: f64,
    pub k: Option<f64>,
    pub p: Option<f64>,
}

/// The names of the parts of one form of an uncertainty, for single values; lists have `XMLList` at their end.
struct Form {
    outer: &'static [&'static str],
    size: &'static str,
    k: Option<&'static str>,
    ends: Option<[&'static str; 2]>,
}

/// The forms of single values, D-SI 2.x first. Some list element is spelt so in the schema.
const FORMS: &[Form] = &[
    Form {
        outer: &["measurementUncertaintyUnivariate", "expandedMU"],
        size: "valueExpandedMU",
        k: Some("coverageFactor"),
        ends: None,
    },
    Form {
        outer: &["measurementUncertaintyUnivaraite", "expandedMU"],
        size: "valueExpandedMU",
        k: Some("coverageFactor"),
        ends: None,
    },
    Form {
        outer: &["listMeasurementUncertaintyUnivariate", "expandedMU"],
        size: "valueExpandedMU",
        k: Some("coverageFactor"),
        ends: None,
    },
    Form {
        outer: &["measurementUncertaintyUnivariate", "standardMU"],
        size: "valueStandardMU",
        k: None,
        ends: None,
    },
    Form {
        outer: &["measurementUncertaintyUnivaraite", "standardMU"],
        size: "valueStandardMU",
        k: None,
        ends: None,
    },
    Form {
        outer: &["measurementUncertaintyUnivariate", "coverageIntervalMU"],
        size: "valueStandardMU",
        k: None,
        ends: Some(["intervalMin", "intervalMax"]),
    },
    Form {
        outer: &["expandedUnc"],
        size: "uncertainty",
        k: Some("coverageFactor"),
        ends: None,
    },
    Form {
        outer: &["listUnivariateUnc", "expandedUnc"],
        size: "uncertainty",
        k: Some("coverageFactor"),
        ends: None,
    },
    Form {
        outer: &["coverageInterval"],
        size: "standardUnc",
        k: None,
        ends: Some(["intervalMin", "intervalMax"]),
    },
    Form {
        outer: &[
            "measurementUncertaintyUnivariateXMLList",
            "expandedMUXMLList",
        ],
        size: "valueExpandedMUXMLList",
        k: Some("coverageFactorXMLList"),
        ends: None,
    },
    Form {
        outer: &[
            "measurementUncertaintyUnivariateXMLList",
            "standardMUXMLList",
        ],
        size: "valueStandardMUXMLList",
        k: None,
        ends: None,
    },
    Form {
        outer: &[
            "measurementUncertaintyUnivariateXMLList",
            "coverageIntervalMUXMLList",
        ],
        size: "valueStandardMUXMLList",
        k: None,
        ends: Some(["intervalMinXMLList", "intervalMaxXMLList"]),
    },
    Form {
        outer: &["expandedUncXMLList"],
        size: "uncertaintyXMLList",
        k: Some("coverageFactorXMLList"),
        ends: None,
    },
    Form {
        outer: &["coverageIntervalXMLList"],
        size: "standardUncXMLList",
        k: None,
        ends: Some(["intervalMinXMLList", "intervalMaxXMLList"]),
    },
];

/// The values of a quantity, one for each point; nothing of a quantity that has none.
pub(super) fn values(quantity: Node<'_, '_>, faults: &mut Faults) -> Vec<Value> {
    let mut values = absolute(quantity, faults);
    if let Some(node) = child(quantity, "relativeUncertainty") {
        let sizes = relative(node, values.len(), faults);
        for (value, size) in values.iter_mut().zip(sizes) {
            // Of nothing no part says how uncertain it is.
            let expanded = size.map(|size| size * value.value.abs());
            let stated = expanded.filter(|u| *u > 0.0).map(|expanded| Uncertainty {
                expanded,
                k: None,
                p: None,
            });
            value.uncertainty = value.uncertainty.or(stated);
        }
    }
    values
}

/// Uncertainties as parts of their values (DCC 3.2 and later); k stands where they are stated in the unit, too, or nowhere.
fn relative(node: Node<'_, '_>, points: usize, faults: &mut Faults) -> Vec<Option<f64>> {
    let forms = [
        ("relativeUncertaintySingle", "value", "unit"),
        ("relativeUncertaintyXmlList", "valueXMLList", "unitXMLList"),
    ];
    let mut found = forms.into_iter().filter_map(|(outer, value, unit)| {
        let outer = child(node, outer)?;
        child(outer, value).zip(child(outer, unit))
    });
    let Some((value, unit_node)) = found.next() else {
        return vec![None; points];
    };
    let factors = text(unit_node).split_whitespace().map(|word| {
        let unit = unit(word, unit_node, faults)?;
        let one = unit.conversion_to(&Unit::one());
        if one.is_none() {
            let message = say!("a relative uncertainty in `{word}`");
            faults.push(fault(unit_node, message));
        }
        Some(one?.factor)
    });
    let factors = factors.collect();
    let factors = spread(factors, points, unit_node, faults);
    let sizes = numbers(value, faults);
    for size in sizes.iter().flatten().filter(|size| **size < 0.0) {
        faults.push(fault(value, no_uncertainty(*size)));
    }
    let sizes = spread(sizes, points, value, faults)
        .into_iter()
        .zip(factors);
    sizes.map(|(size, factor)| Some(size? * factor?)).collect()
}

fn absolute(quantity: Node<'_, '_>, faults: &mut Faults) -> Vec<Value> {
    if let Some(real) = child(quantity, "real") {
        return single(real, None, None, faults).into_iter().collect();
    }
    if let Some(hybrid) = child(quantity, "hybrid") {
        // The same in several units: the first of those that are known.
        let mut known = children(hybrid, "real").filter(|real| {
            let unit = child(*real, "unit").map(text).unwrap_or_default();
            UnitTable::default().parse_dsi(unit).is_some()
        });
        return match known.next() {
            Some(real) => single(real, None, None, faults).into_iter().collect(),
            None => absolute(hybrid, faults),
        };
    }
    if let Some(list) = child(quantity, "realListXMLList") {
        return with_joint(list, listed(list, faults), faults);
    }
    let lists = child(quantity, "list").into_iter();
    let lists = lists.flat_map(|list| [Some(list), child(list, "realList")]);
    for list in lists.flatten() {
        let unit = child(list, "listUnit");
        let all: Vec<Value> = children(list, "real")
            .filter_map(|real| single(real, unit, Some(list), faults))
            .collect();
        if !all.is_empty() {
            return with_joint(list, all, faults);
        }
        if let Some(inner) = child(list, "realListXMLList") {
            return with_joint(inner, listed(inner, faults), faults);
        }
    }
    Vec::new()
}

/// Values with the standard uncertainties of their covariance matrix, where that is how they are stated: the square roots of
/// its diagonal, whatever the factor of the region that they cover together.
fn with_joint(list: Node<'_, '_>, mut values: Vec<Value>, faults: &mut Faults) -> Vec<Value> {
    let begins = |node: &Node<'_, '_>, word: &str| node.tag_name().name().starts_with(word);
    let mut all = list.descendants();
    let Some(matrix) = all.find(|node| begins(node, "covarianceMatrix")) else {
        return values;
    };
    let columns = matrix.children().filter(|node| begins(node, "column"));
    for ((at, column), own) in columns.enumerate().zip(&mut values) {
        let mut entries = column.children().filter(|node| begins(node, "covariance"));
        let Some(entry) = entries.nth(at) else {
            continue;
        };
        let part = |name, of_list| child(entry, name).or_else(|| child(entry, of_list));
        let stated = part("value", "valueXMLList").zip(part("unit", "unitXMLList"));
        let Some((value, unit_node)) = stated else {
            continue;
        };
        let difference = own.unit.difference();
        let unit = unit(text(unit_node), unit_node, faults);
        let square = unit.map(|unit| unit.conversion_to(&difference.product(&difference)));
        if matches!(square, Some(None)) {
            let message = say!("a variance whose unit is not the square of that of its value");
            faults.push(fault(unit_node, message));
        }
        let variance = numbers(value, faults).into_iter().next().flatten();
        if let Some(variance) = variance.filter(|variance| *variance < 0.0) {
            faults.push(fault(value, no_uncertainty(variance)));
        }
        let u = variance
            .zip(square.flatten())
            .map(|(variance, square)| libm::sqrt(variance * square.factor));
        let stated = u.filter(|u| u.is_finite()).map(|u| Uncertainty {
            expanded: u,
            k: Some(1.0),
            p: None,
        });
        own.uncertainty = own.uncertainty.or(stated);
    }
    values
}

/// A value of its own, or of a list that has a unit and an uncertainty for all.
fn single(
    real: Node<'_, '_>,
    unit_of_all: Option<Node<'_, '_>>,
    list: Option<Node<'_, '_>>,
    faults: &mut Faults,
) -> Option<Value> {
    let value = child(real, "value")?;
    let unit = child(real, "unit").or(unit_of_all);
    let unit = unit_at(unit.unwrap_or(real), faults)?;
    let number = numbers(value, faults).into_iter().next().flatten()?;
    let own = uncertainties(real, 1, faults).into_iter().next().flatten();
    let shared = || {
        let list = list?;
        uncertainties(list, 1, faults).into_iter().next().flatten()
    };
    Some(Value {
        value: number,
        unit,
        uncertainty: own.or_else(shared),
    })
}

fn listed(list: Node<'_, '_>, faults: &mut Faults) -> Vec<Value> {
    let Some(node) = child(list, "valueXMLList") else {
        return Vec::new();
    };
    let values = numbers(node, faults);
    let Some(unit_node) = child(list, "unitXMLList") else {
        faults.push(fault(list, say!("a list of values has no unit")));
        return Vec::new();
    };
    let texts: Vec<&str> = text(unit_node).split_whitespace().collect();
    let units: Vec<Option<Unit>> = texts
        .iter()
        .map(|word| unit(word, unit_node, faults))
        .collect();
    let units = spread(units, values.len(), unit_node, faults);
    let uncertainties = uncertainties(list, values.len(), faults);
    let parts = values.into_iter().zip(units).zip(uncertainties);
    let all = parts.filter_map(|((value, unit), uncertainty)| {
        Some(Value {
            value: value?,
            unit: unit?,
            uncertainty,
        })
    });
    all.collect()
}

/// The unit of an element.
fn unit_at(node: Node<'_, '_>, faults: &mut Faults) -> Option<Unit> {
    if !matches!(node.tag_name().name(), "unit" | "listUnit") {
        faults.push(fault(node, say!("a value has no unit")));
        return None;
    }
    unit(text(node), node, faults)
}

fn unit(word: &str, node: Node<'_, '_>, faults: &mut Faults) -> Option<Unit> {
    let unit = UnitTable::default().parse_dsi(word);
    if unit.is_none() {
        let fault = fault(node, say!("`{word}` is not a unit of the D-SI"));
        faults.push(fault.label(say!(
            "expected names such as \\milli\\volt or \\metre\\second\\tothe{{-1}}"
        )));
    }
    unit
}

/// The uncertainties of so many values.
fn uncertainties(
    holder: Node<'_, '_>,
    points: usize,
    faults: &mut Faults,
) -> Vec<Option<Uncertainty>> {
    let found = FORMS
        .iter()
        .find_map(|form| Some((form, at(holder, form.outer)?)));
    let Some((form, node)) = found else {
        return vec![None; points];
    };
    let list = form.size.ends_with("XMLList");
    let mut column = |name: &'static str, check: fn(f64) -> bool, what: fn(f64) -> Said| {
        let Some(node) = child(node, name) else {
            return vec![None; points];
        };
        let all = numbers(node, faults);
        for number in all.iter().flatten() {
            if !check(*number) {
                faults.push(fault(node, what(*number)));
            }
        }
        spread(all, points, node, faults)
    };
    let size = column(form.size, |u| u >= 0.0, no_uncertainty);
    let k = match form.k {
        Some(name) => column(
            name,
            |k| k >= 1.0,
            |number| say!("{number} is no coverage factor"),
        ),
        // A standard uncertainty is its own multiple.
        None => size.iter().map(|u| u.map(|_| 1.0)).collect(),
    };
    let p_name = match list {
        true => "coverageProbabilityXMLList",
        false => "coverageProbability",
    };
    let p = column(
        p_name,
        |p| p > 0.0 && p < 1.0,
        |number| say!("{number} is no coverage probability"),
    );
    let half: Vec<Option<f64>> = match form.ends {
        None => vec![None; points],
        Some(names) => {
            let [low, high] = names.map(|name| column(name, |_| true, no_uncertainty));
            let halves = low.into_iter().zip(high);
            halves
                .map(|(low, high)| Some((high? - low?) / 2.0))
                .collect()
        }
    };
    let parts = size.into_iter().zip(k).zip(p).zip(half);
    let all = parts.map(|(((size, k), p), half)| match (size, half) {
        (Some(expanded), _) => {
            // The p of an interval says nothing about u itself.
            let p = p.filter(|_| form.ends.is_none() && form.k.is_some());
            Some(Uncertainty { expanded, k, p })
        }
        (None, Some(expanded)) => Some(Uncertainty {
            expanded,
            k: None,
            p,
        }),
        (None, None) => None,
    });
    all.collect()
}

fn no_uncertainty(number: f64) -> Said {
    say!("{number} is no uncertainty")
}

/// As many as there are points; one stands for all.
fn spread<T: Clone>(
    mut all: Vec<Option<T>>,
    points: usize,
    node: Node<'_, '_>,
    faults: &mut Faults,
) -> Vec<Option<T>> {
    match all.len() {
        n if n == points => all,
        1 => vec![all.remove(0); points],
        n => {
            let name = node.tag_name().name();
            let message = say!("{name} has {n} entries, and the list has {points} values");
            faults.push(xml::fault(node, message));
            vec![None; points]
        }
    }
}
