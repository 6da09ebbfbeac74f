//! °C is a point on a scale where the quantity is a temperature, and a difference in its uncertainty.

use super::*;
use crate::budget::{DecisionRule, Guard};

/// A difference of two temperatures in K, with more tables.
fn difference(more: &str) -> String {
    format!(
        "[measurand.d]\nmodel = \"t - t_0\"\nunit = \"K\"\n[constant]\nt_0 = \"20 °C\"\n[input.t]\nvalue = 20.5\nunit = \"°C\"\nu = \"0.1 °C\"\n{more}"
    )
}

#[test]
fn a_point_is_no_limit_of_a_difference() {
    for more in [
        "[conformity]\nupper = \"1 °C\"\nrule = \"simple\"\n",
        "[conformity]\nlower = \"1 °C\"\nrule = \"simple\"\n",
        "[claim]\nvalue = \"1 °C\"\n",
        "[claim]\ninterval = [\"1 °C\", 2]\n",
    ] {
        let rejection = refused(&difference(more));
        let fault = &rejection.faults[0];
        let help = fault.help.clone().unwrap_or_default().to_string();
        assert_eq!(fault.code.id, "B0112", "{more}{rejection}");
        assert!(
            help.contains("\"1 K\"") && help.contains("\"274.15 K\""),
            "{help}"
        );
    }
    let correction = "[input.c]\nunit = \"K\"\nlimits = [\"-0.03 °C\", \"0.03 °C\"]\n";
    let text = difference(correction).replace("t - t_0", "t - t_0 + c");
    assert_eq!(
        faults(&text),
        [("B0112", "°C".to_string()), ("B0112", "°C".to_string())]
    );
}

#[test]
fn deviations_in_celsius_are_differences() {
    let guarded =
        "[conformity]\nupper = 1\nrule = \"guarded-acceptance\"\nguard_band = \"0.1 °C\"\n";
    let claimed = "[claim]\nU = \"0.2 °C\"\nu = \"0.1 °C\"\nk = 2\n";
    let budget = budget(&difference(&format!("{guarded}{claimed}")));
    let rule = &budget.conformity[0].rule;
    let DecisionRule::GuardedAcceptance(Guard::Amount(band)) = rule else {
        panic!("{rule:?}");
    };
    close(*band, 0.1);
    let figures = &budget.claims[0].figures;
    let of = |what: Figure| figures.iter().find(|f| f.what == what).map(|f| f.value);
    assert_eq!(of(Figure::ExpandedUncertainty), Some(0.2));
    assert_eq!(of(Figure::StandardUncertainty), Some(0.1));
}

#[test]
fn thermodynamic_temperatures_are_never_negative() {
    let text = "[measurand.T]\nmodel = \"t\"\nunit = \"°C\"\n[input.t]\nunit = \"°C\"\n";
    let kelvin = format!("{text}value = \"293.15 K\"\nu = 0.1\n");
    close(budget(&kelvin).inputs[0].estimate, 20.0);
    let limits = format!("{text}value = 20\nlimits = [\"-0.5 K\", 0.5]\n");
    assert_eq!(faults(&limits)[0], ("B0112", "K".to_string()));
}
