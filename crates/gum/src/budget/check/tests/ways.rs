//! Ways to state an uncertainty.

use super::*;
use gumption_core::distribution::{CurvilinearTrapezoid, StudentT};

#[test]
fn type_a_of_a_mean_a_single_reading_and_several() {
    // s² = 2.5 for 1 … 5.
    let (u, dof, distribution) = component("readings = [1, 2, 3, 4, 5]");
    close(u, 0.5f64.sqrt());
    assert_eq!(dof, 4.0);
    assert_eq!(
        distribution,
        Distribution::StudentT(StudentT {
            location: 0.0,
            scale: u,
            dof: 4.0
        })
    );
    assert_eq!(
        budget(&one("readings = [1, 2, 3, 4, 5]")).inputs[0].estimate,
        3.0
    );
    close(
        component("value = 2.5\nreadings = [1, 2, 3, 4, 5]\nof = \"single\"").0,
        2.5f64.sqrt(),
    );
    close(
        component("value = 2.5\nreadings = [1, 2, 3, 4, 5]\nof = 2").0,
        1.25f64.sqrt(),
    );
    let single = budget(&one("readings = [1, 2, 6]\nof = \"single\""));
    assert_eq!(
        (single.inputs[0].estimate, single.components[0].u),
        (3.0, 7f64.sqrt())
    );
}

#[test]
fn pooled_standard_deviation() {
    let (u, dof, _) = component("readings = [1, 3]\npooled = { s = 0.2, dof = 20 }");
    close(u, 0.2 / 2f64.sqrt());
    assert_eq!(dof, 20.0);
    close(
        component("value = 1\npooled = { s = \"200 mV\", dof = 20 }\nof = \"single\"").0,
        0.2,
    );
    assert_eq!(
        faults(&one("value = 1\npooled = { s = 0.2, dof = 20 }"))[0].0,
        "B0207"
    );
}

#[test]
fn limits_of_every_shape() {
    let u = |shape: &str| {
        component(&format!(
            "value = 1\nhalf_width = 0.6\ndistribution = {shape}"
        ))
        .0
    };
    close(u("\"uniform\""), 0.6 / 3f64.sqrt());
    close(u("\"triangular\""), 0.6 / 6f64.sqrt());
    close(u("\"arcsine\""), 0.6 / 2f64.sqrt());
    close(
        u("\"trapezoidal\"\nbeta = 0.5"),
        0.6 * (1.25f64 / 6.0).sqrt(),
    );
    close(
        u("\"curvilinear-trapezoid\"\nd = 0.3"),
        (0.12f64 + 0.01).sqrt(),
    );
    // GUM 4.3.4: half-width at 95 % of a normal distribution.
    assert!((u("\"normal\"\np = 0.95") - 0.6 / 1.959963984540054).abs() < 1e-12);
}

#[test]
fn a_stated_u_keeps_its_value_for_every_shape() {
    for shape in ["uniform", "triangular", "arcsine", "normal"] {
        let (u, _, distribution) =
            component(&format!("value = 1\nu = 0.3\ndistribution = \"{shape}\""));
        assert_eq!(u, 0.3);
        close(distribution.standard_deviation().unwrap(), 0.3);
    }
}

#[test]
fn certificates_with_k_or_p() {
    close(
        component("value = 1\ncertificate = { U = 0.4, k = 2 }").0,
        0.2,
    );
    // GUM table G.2: t_0.95(10) = 2.23.
    let (u, dof, _) = component("value = 1\ncertificate = { U = 2.228, p = 0.95, dof = 10 }");
    assert!((u - 1.0).abs() < 1e-4 && dof == 10.0);
    close(
        component("value = 1\ncertificate = { U = 0.4, k = 2, p = 0.95 }").0,
        0.2,
    );
    assert_eq!(
        faults(&one("value = 1\ncertificate = { U = 0.4 }")),
        [("B0205", "0.4".into())]
    );
    assert_eq!(
        faults(&one(
            "value = 1\ncertificate = { U = 0.4, k = 3, p = 0.95 }"
        ))[0]
            .0,
        "B0206"
    );
    assert_eq!(
        faults(&one("value = 1\ncertificate = { U = 0.4, p = 95 }"))[0].0,
        "B0204"
    );
    for (certificate, dof) in [
        ("k = 12.71", ""),
        ("k = 63.66", ", dof = 1"),
        ("k = 0.6745", ""),
    ] {
        component(&format!(
            "value = 1\ncertificate = {{ U = 0.4, {certificate}{dof} }}"
        ));
    }
    for k in [0.95, 20.0, 95.0, 99.73] {
        let text = one(&format!("value = 1\ncertificate = {{ U = 0.4, k = {k} }}"));
        assert_eq!(faults(&text)[0].0, "B0226", "{k}");
    }
}

/// U = 30 µV + 0.4·10⁻⁶·V with k = 2, at 100 V: 70 µV.
#[test]
fn a_certificate_may_grow_with_the_value() {
    let grows = "certificate = { U = \"30 µV\", reading = \"0.4 ppm\", k = 2 }";
    close(component(&format!("value = 100\n{grows}")).0, 35e-6);
    let remarks = |value: f64| {
        budget(&one(&format!("value = {value}\n{grows}")))
            .remarks
            .len()
    };
    assert_eq!([remarks(0.0), remarks(100.0)], [1, 0]);
    let without_unit = grows.replace("\"0.4 ppm\"", "4e-7");
    assert_eq!(
        faults(&one(&format!("value = 100\n{without_unit}")))[0].0,
        "B0111"
    );
}

#[test]
fn specification_resolution_and_bits() {
    let text = "value = -5\nspecification = { reading = \"0.002 %\", range = \"6 ppm\", span = 10, counts = 3, step = 1e-5 }";
    close(
        component(text).0,
        (5.0 * 2e-5 + 10.0 * 6e-6 + 3e-5) / 3f64.sqrt(),
    );
    close(
        component("value = 1\nstep = \"10 mV\"").0,
        0.005 / 3f64.sqrt(),
    );
    close(
        component("value = 1\nbits = 3\nrange = [-4, 4]").0,
        0.5 / 3f64.sqrt(),
    );
}

#[test]
fn a_value_beyond_the_span_is_told() {
    let remarks = |value: f64| {
        let text = format!(
            "[measurand.Y]\nmodel = \"X\"\nunit = \"mV\"\n[input.X]\nvalue = {value}\nunit = \"mV\"\nspecification = {{ reading = \"0.1 %\", range = \"0.01 %\", span = 10 }}\n"
        );
        budget(&text).remarks.len()
    };
    assert_eq!([remarks(2000.0), remarks(-10.0)], [1, 0]);
}

#[test]
fn a_part_of_a_value_that_is_zero_is_told_to_be_nothing() {
    let remarks = |value: f64| {
        let specification = "specification = { reading = \"0.01 %\", fixed = 0.001 }";
        let text =
            format!("[measurand.Y]\nmodel = \"X\"\n[input.X]\nvalue = {value}\n{specification}\n");
        budget(&text).remarks
    };
    let found = remarks(0.0);
    assert!(
        found[0]
            .to_string()
            .contains("0.01 % of the value of X, which is 0"),
        "{found:?}"
    );
    assert!(remarks(1.0).is_empty());
}

#[test]
fn what_a_count_or_a_small_sample_is_taken_for_is_told() {
    let remarks = |keys: &str| {
        budget(&format!(
            "[measurand.Y]\nmodel = \"X\"\n[input.X]\n{keys}\n"
        ))
        .remarks
    };
    let one = |keys: &str| {
        let found = remarks(keys);
        assert_eq!(found.len(), 1, "{keys}");
        found[0].to_string()
    };
    let counted = one("count = 3");
    assert!(
        counted.contains("the estimate is 4 and u² = 4"),
        "{counted}"
    );
    assert!(one("successes = 3\ntrials = 4").contains("= 4 / 6, by"));
    // What no event, or nothing but successes, allow is proposed: the reciprocal prior has no distribution there.
    for keys in [
        "count = 0",
        "successes = 0\ntrials = 4",
        "successes = 4\ntrials = 4",
    ] {
        let said = one(keys);
        assert!(
            said.contains("jeffreys") && !said.contains("reciprocal"),
            "{said}"
        );
        assert!(remarks(&format!("{keys}\nprior = \"jeffreys\"")).is_empty());
    }
    for prior in ["uniform", "jeffreys", "reciprocal"] {
        let counted = format!("count = 3\nprior = \"{prior}\"");
        assert!(remarks(&counted).is_empty(), "{prior}");
    }
    // Of 39 values none has 2.5 % beyond it.
    let sample = |n: usize| {
        let values: Vec<String> = (0..n).map(|i| i.to_string()).collect();
        format!("sample = [{}]", values.join(", "))
    };
    assert!(one(&sample(39)).contains("39 values of `sample`"));
    assert!(remarks(&sample(40)).is_empty());
}

#[test]
fn asymmetric_limits_move_the_estimate() {
    let budget = budget(&one("value = 10\nplus = 0.4\nminus = 0.2"));
    close(budget.inputs[0].estimate, 10.1);
    close(budget.components[0].u, 0.3 / 3f64.sqrt());
    assert_eq!(budget.remarks.len(), 1);
    assert_eq!(faults(&one("value = 10\nlimits = [1, 2]"))[0].0, "B0211");
}

#[test]
fn counts_and_proportions() {
    let dimensionless = |keys: &str| {
        let text = format!("[measurand.Y]\nmodel = \"X\"\n[input.X]\n{keys}\n");
        let budget = budget(&text);
        (budget.inputs[0].estimate, budget.components[0].u)
    };
    assert_eq!(dimensionless("count = 8"), (9.0, 3.0));
    assert_eq!(
        dimensionless("count = 16\nprior = \"reciprocal\""),
        (16.0, 4.0)
    );
    // Beta(2, 4): mean 1/3, variance 8/252.
    let (mean, u) = dimensionless("successes = 1\ntrials = 4");
    close(mean, 1.0 / 3.0);
    close(u, (8.0f64 / 252.0).sqrt());
}

#[test]
fn gum_u_and_dof_beside_a_shape() {
    // JCGM 101 9.5, δα: the GUM column uses the rectangle, Monte Carlo the curvilinear trapezoid.
    let keys = "value = 0\nhalf_width = 1\ndistribution = \"curvilinear-trapezoid\"\nd = 0.1\ndof = 50\ngum_u = 0.58";
    let (u, dof, distribution) = component(keys);
    assert_eq!((u, dof), (0.58, 50.0));
    assert_eq!(
        distribution,
        Distribution::CurvilinearTrapezoid(CurvilinearTrapezoid {
            lower: -1.0,
            upper: 1.0,
            d: 0.1
        })
    );
}

#[test]
fn the_t_scale_is_a_convention() {
    let text = format!(
        "[conventions]\nt_scale = \"standard-deviation\"\n{}",
        one("value = 1\nu = 0.3\ndof = 8")
    );
    let budget = budget(&text);
    assert_eq!(budget.conventions.t_scale, TScale::StandardDeviation);
    close(
        budget.components[0]
            .distribution
            .standard_deviation()
            .unwrap(),
        0.3,
    );
    assert_eq!(
        budget.conventions.overrides,
        ["t_scale = \"standard-deviation\""]
    );
}

/// The entries of the mend take the keys along that go with them: below `components` they would be refused.
#[test]
fn ways_become_components_with_their_keys() {
    let help = |text: &str| {
        refused(&one(text)).faults[0]
            .help
            .clone()
            .unwrap_or_default()
            .to_string()
    };
    let told = help(
        "value = 1\nreadings = [1, 2]\nof = \"single\"\nstep = 0.1\ndistribution = \"triangular\"\nu = 1\ndof = 5",
    );
    assert!(
        told.ends_with("components = [{ readings = …, of = … }, { step = …, distribution = … }, { u = …, dof = … }]"),
        "{told}"
    );
    let told = help("value = 1\nplus = 1\nminus = 2\nstep = 0.1");
    assert!(
        told.ends_with("components = [{ plus = …, minus = … }, { step = … }]"),
        "{told}"
    );
}

#[test]
fn numbers_that_cannot_be_meant() {
    // 4 of its value is 400 %.
    assert_eq!(
        faults(&one("value = 31\nu = 4\nrelative = true"))[0],
        ("B0113", "4".to_string())
    );
    assert!(
        refused(&one("value = 31\nu = 4\nrelative = true"))
            .to_string()
            .contains("\"4 %\"")
    );
    // 10.13, 10.15 …
    let commas = refused(&one("readings = [10,13, 10,15, 10,14]"));
    assert!(
        commas.to_string().contains("[10.13, 10.15, 10.14]"),
        "{commas}"
    );
    assert!(
        refused(&one("value = 1\nu = \"0,1 V\""))
            .to_string()
            .contains("\"0.1 V\"")
    );
    // Whole numbers all the same.
    close(
        component("readings = [10, 13, 10, 15]").0,
        1.2247448713915892,
    );
    close(component("readings = [1,2,3,4,5]").0, 0.5f64.sqrt());
}

#[test]
fn a_source_is_stated_absolutely_in_percent_too() {
    let text = "[measurand.Y]\nmodel = \"X\"\nunit = \"V\"\n[source.gain]\nhalf_width = \"0.3 %\"\n[input.X]\nvalue = 2\nunit = \"V\"\ncomponents = [{ source = \"gain\", relative = true }]\n";
    let budget = budget(text);
    close(budget.components[0].u, 0.003 / 3f64.sqrt());
}

/// A number without unit is a ratio of changes of the same kind: in mg or in g, 1 is what is left out.
#[test]
fn a_sensitivity_is_a_ratio_of_the_same_kind() {
    let coefficient = |unit: &str, stated: &str| {
        let text = format!(
            "[measurand.Y]\nmodel = \"X\"\nunit = \"g\"\n[source.balance]\nunit = \"{unit}\"\nu = 2\n[input.X]\nvalue = 2\nunit = \"g\"\ncomponents = [{{ source = \"balance\"{stated} }}]\n"
        );
        budget(&text).inputs[0].terms[0].coefficient
    };
    close(coefficient("mg", ""), 1e-3);
    close(coefficient("mg", ", sensitivity = -1"), -1e-3);
    close(coefficient("mg", ", sensitivity = \"-1 mg/mg\""), -1e-3);
    close(coefficient("g", ", sensitivity = -1"), -1.0);
    // Of another kind it is in the units of both.
    close(coefficient("K", ", sensitivity = 0.5"), 0.5);
}

#[test]
fn three_readings_go_with_every_profile() {
    for profile in ["GUM", "EA", "JJF", "NIST", "UKAS"] {
        let text = format!("profile = \"{profile}\"\n{}", one("readings = [1, 2, 3]"));
        close(budget(&text).components[0].u, 1.0 / 3f64.sqrt());
    }
    let stated = format!(
        "[conventions]\nt_scale = \"standard-deviation\"\n{}",
        one("readings = [1, 2, 3]")
    );
    assert_eq!(faults(&stated)[0].0, "B0210");
}

#[test]
fn relative_amounts() {
    close(component("value = -4\nu = \"50 ppm\"").0, 2e-4);
    close(component("value = -4\nu = 0.01\nrelative = true").0, 0.04);
    assert_eq!(faults(&one("value = 0\nu = \"50 ppm\""))[0].0, "B0214");
    let ratio = "[measurand.Y]\nmodel = \"X\"\n[input.X]\nvalue = 2\nu = \"1 %\"\n";
    assert_eq!(faults(ratio), [("B0113", "\"1 %\"".into())]);
    // Of a content the absolute reading of a percentage would be larger than the content.
    let content = |unit: &str, value: f64| {
        format!(
            "[measurand.Y]\nmodel = \"X\"\nunit = \"{unit}\"\n[input.X]\nvalue = {value}\nunit = \"{unit}\"\nu = \"2 %\"\n"
        )
    };
    close(budget(&content("mg/kg", 5.0)).components[0].u, 0.1);
    close(budget(&content("mmol/mol", 5.0)).components[0].u, 0.1);
    assert_eq!(faults(&content("g/kg", 950.0))[0].0, "B0113");
    assert_eq!(faults(&content("mm/m", 5.0))[0].0, "B0113");
    // Of one, both are the same; and the file may say which.
    let said = |word: &str| budget(&format!("{ratio}relative = {word}\n")).components[0].u;
    close(said("true"), 0.02);
    close(said("false"), 0.01);
    let volts = "[measurand.Y]\nmodel = \"X\"\nunit = \"V\"\n[input.X]\nvalue = 2\nunit = \"V\"\nu = \"1 %\"\nrelative = false\n";
    assert_eq!(faults(volts)[0].0, "B0112");
    close(component("value = 1\nu = \"1.67 %\"").0, 0.0167);
    let angle = "[measurand.Y]\nmodel = \"X\"\nunit = \"°\"\n[input.X]\nvalue = 2\nunit = \"°\"\nu = \"6 '\"\n";
    close(budget(angle).components[0].u, 0.1);
    let temperature = "[measurand.Y]\nmodel = \"X\"\nunit = \"°C\"\n[input.X]\nvalue = \"293.15 K\"\nunit = \"°C\"\nu = \"0.1 °C\"\n";
    let budget = budget(temperature);
    assert!(
        (budget.inputs[0].estimate - 20.0).abs() < 1e-9 && budget.components[0].unit.symbol == "K"
    );
    close(budget.components[0].u, 0.1);
}

#[test]
fn readings_without_scatter_are_left_to_the_resolution() {
    let text = one("components = [{ readings = [1.5, 1.5, 1.5] }, { step = 0.1 }]");
    let budget = budget(&text);
    assert_eq!(
        (budget.inputs[0].estimate, budget.components.len()),
        (1.5, 1)
    );
    assert_eq!(budget.remarks.len(), 1);
}

#[test]
fn the_larger_of_resolution_and_repeatability() {
    let parts = one("components = [{ readings = [1, 2, 3] }, { step = 0.1 }]");
    assert_eq!(budget(&parts).components.len(), 2);
    let largest = budget(&format!("[conventions]\nresolution = \"largest\"\n{parts}"));
    assert_eq!(largest.components.len(), 1);
    assert_eq!(largest.components[0].label, "repeatability");
    let fine = "[conventions]\nresolution = \"largest\"\n[measurand.Y]\nmodel = \"X\"\nunit = \"°C\"\n[input.X]\nunit = \"°C\"\ncomponents = [{ readings = [20.0001, 20.0003] }, { step = 0.0002309401 }]\n";
    let told = self::budget(fine).remarks[0].to_string();
    assert!(
        told.contains("(u = 6.67×10⁻⁵ °C) is left out beside the larger u = 0.000100 °C"),
        "{told}"
    );
}

/// A study of readings that was evaluated elsewhere is stated as u of type A: a gauge study (VDA 5) has its figures so.
#[test]
fn a_stated_repeatability_is_one() {
    let labels = |repeatability: &str, step: f64| {
        let parts = one(&format!(
            "components = [{{ name = \"EVR\", u = {repeatability} }}, {{ name = \"RE\", step = {step} }}]\nvalue = 20"
        ));
        let found = budget(&format!("[conventions]\nresolution = \"largest\"\n{parts}"));
        let labels = found.components.iter().map(|one| one.label.to_string());
        labels.collect::<Vec<_>>()
    };
    assert_eq!(labels("0.0002, type = \"A\"", 0.001), ["RE"]);
    assert_eq!(labels("0.002, type = \"A\"", 0.001), ["EVR"]);
    // Of another type it is no repeatability.
    assert_eq!(labels("0.0002", 0.001), ["EVR", "RE"]);
}

#[test]
fn directions_beside_each_other_are_told() {
    let vector = |values: &str| {
        format!(
            "[measurand.Y]\nmodel = \"mean(D)\"\nunit = \"°\"\n[input.D]\nunit = \"°\"\nu = 2\nvalues = {values}\n"
        )
    };
    let told = budget(&vector("[359, 1, 3]")).remarks;
    let told = told[0].to_string();
    assert!(told.contains("write -1 in place") || told.contains("write 361 in place"));
    assert!(budget(&vector("[0, 90, 180, 270]")).remarks.is_empty());
    assert!(budget(&vector("[-1, 1, 3]")).remarks.is_empty());
}

#[test]
fn constants_are_numbers_amounts_lists_or_tables() {
    let text = "[constant]\nx = [1, 2, 3]\nn = 2\n[measurand.Y]\nmodel = \"X * sum(x) / n\"\n[input.X]\nvalue = 2\nu = 1\n";
    assert_eq!(budget(text).constants[0].values, [1.0, 2.0, 3.0]);
}

#[test]
fn a_refused_assessment_has_no_further_faults() {
    let text = "[measurand.Y]\nmodel = \"X\"\n[input.X]\nvalue = 2\nu = 1\n[conformity]\nupper = 3\n[claim]\nfigures = { \"Y.p_c\" = 0.5 }\n";
    assert_eq!(faults(text).len(), 1, "the missing rule alone");
}
