//! Type A evaluation: readings in groups, outliers, vectors that share one u.

use super::*;
use crate::budget::Evaluation;

/// The value of a named figure.
fn figure(budget: &Budget, name: &str) -> f64 {
    let found = budget.figures.iter().find(|figure| figure.name == name);
    found.unwrap_or_else(|| panic!("no figure {name}")).value
}

#[test]
fn readings_in_groups() {
    let groups = "groups = [[1, 3], [5, 7], [6, 8]]";
    let included = budget(&one(groups));
    // Means 2, 6, 7; u = s(means)/√3, ν = 2.
    close(included.inputs[0].estimate, 5.0);
    close(included.components[0].u, (7.0f64 / 3.0).sqrt());
    close(included.components[0].dof, 2.0);
    assert_eq!(included.components[0].evaluation, Evaluation::TypeA);
    close(figure(&included, "X.anova.ms_within"), 2.0);
    close(figure(&included, "X.anova.F"), 7.0);
    let pooled = budget(&one(&format!("{groups}\nbetween = \"none\"")));
    close(pooled.components[0].dof, 5.0);
    close(pooled.components[0].u, (34.0f64 / 5.0 / 6.0).sqrt());
    // F = 7 against 9.55 at 5 %, 5.46 at 10 %.
    let test = |level: f64| {
        let keys = format!("{groups}\nbetween = \"test\"\nsignificance = {level}");
        budget(&one(&keys)).components[0].dof
    };
    close(test(0.05), 5.0);
    close(test(0.1), 2.0);
    let single = budget(&one(&format!("{groups}\nof = \"single\"")));
    close(single.inputs[0].estimate, 5.0);
    close(single.components[0].u, (6.0f64 + 2.0).sqrt());
}

#[test]
fn a_summary_of_groups_stands_for_their_readings() {
    let summary = "group_summary = { means = [2, 6, 7], s = [1.4142135623730951, 1.4142135623730951, \"1414.2135623730951 mV\"], n = 2 }";
    let (by_summary, by_readings) = (
        budget(&one(summary)),
        budget(&one("groups = [[1, 3], [5, 7], [6, 8]]")),
    );
    assert!((by_summary.components[0].u - by_readings.components[0].u).abs() < 1e-12);
}

#[test]
fn groups_that_say_nothing_are_refused() {
    let code = |keys: &str| faults(&one(keys))[0].0;
    assert_eq!(code("groups = [[1, 2, 3]]"), "B0219");
    assert_eq!(code("groups = [[1], [2], [3]]"), "B0219");
    assert_eq!(code("groups = [[1, 2], []]"), "B0219");
    assert_eq!(code("groups = [[1, 1], [2, 2]]"), "B0209");
    assert_eq!(code("groups = [1, 2, 3]"), "B0105");
    assert_eq!(code("groups = [[[1, 2]], [[3, 4]]]"), "B0219");
    assert_eq!(code("readings = [[1, 2], [3, 4]]\nvalue = 1"), "B0217");
    assert_eq!(code("readings = [1, 2]\nbetween = \"none\""), "B0207");
    assert_eq!(
        code("group_summary = { means = [1, 2], s = [1, 1, 1], n = 3 }"),
        "B0219"
    );
}

#[test]
fn tests_for_outliers_report_and_keep() {
    let readings = "readings = [1.0, 1.1, 0.9, 1.05, 3.0]";
    let plain = budget(&one(readings));
    let tested = budget(&one(&format!("{readings}\noutlier_test = \"dixon\"")));
    assert_eq!(plain.components, tested.components);
    close(figure(&tested, "X.outlier.place"), 5.0);
    assert!((figure(&tested, "X.outlier.statistic") - 1.9 / 2.1).abs() < 1e-12);
    // Two-sided 5 % critical value of five readings.
    assert!((figure(&tested, "X.outlier.critical") - 0.710).abs() < 0.001);
    assert_eq!(
        faults(&one(&format!("{readings}\noutlier_test = \"3s\"")))[0].0,
        "B0220"
    );
}

#[test]
fn successive_readings_that_are_correlated_are_remarked_on() {
    let drift = "readings = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]";
    let remarks = budget(&one(drift)).remarks;
    assert!(remarks[0].to_string().contains("lag-1"), "{remarks:?}");
    assert!(budget(&one("readings = [1, 3, 2, 4]")).remarks.is_empty());
}

#[test]
fn earlier_series_are_pooled() {
    let keys = "readings = [1, 3]\npooled = { readings = [[1, 2, 3], [10, 14]] }";
    let (u, dof, _) = component(keys);
    close(u, (10.0f64 / 3.0 / 2.0).sqrt());
    assert_eq!(dof, 3.0);
    let twice = "readings = [1, 3]\npooled = { s = 1, dof = 3, readings = [[1, 2, 3]] }";
    assert_eq!(faults(&one(twice))[0].0, "B0202");
}

#[test]
fn elements_that_share_one_u_share_its_doubt() {
    let text = "[measurand.Y]\nmodel = \"sum(X)\"\n[input.X]\nvalues = [1, 2, 3]\n";
    let common = budget(&format!("{text}u = 0.1\ndof = 9"));
    let [group] = common.groups.as_slice() else {
        panic!("{:?}", common.groups)
    };
    assert_eq!((group.members.len(), group.dof), (3, Some(9.0)));
    assert_eq!(*group.correlation, nalgebra::DMatrix::identity(3, 3));
    assert!(matches!(group.law, Law::StudentT { dof, .. } if dof == 9.0));
    // A list states each u by itself.
    assert_eq!(
        budget(&format!("{text}u = [0.1, 0.1, 0.1]\ndof = 9")).groups,
        []
    );
    assert_eq!(budget(&format!("{text}u = 0.1")).groups, []);
    // A correlation of two of them stands in the same matrix.
    let correlated = format!(
        "{text}u = 0.1\ndof = 9\n{}",
        correlation("X[1]", "X[3]", 0.5)
    );
    let group = budget(&correlated).groups.remove(0);
    assert_eq!((group.members.len(), group.dof), (3, Some(9.0)));
    assert_eq!(
        (group.correlation[(0, 2)], group.correlation[(0, 1)]),
        (0.5, 0.0)
    );
}

#[test]
fn limits_with_degrees_of_freedom_are_remarked_on() {
    let remarks = budget(&one("value = 1\nhalf_width = 0.1\ndof = 8")).remarks;
    assert!(remarks[0].to_string().contains("ν = 8"), "{remarks:?}");
    assert!(
        budget(&one("value = 1\nu = 0.1\ndof = 8"))
            .remarks
            .is_empty()
    );
}

#[test]
fn a_stated_u_may_be_of_type_a() {
    let evaluation = |keys: &str| budget(&one(keys)).components[0].evaluation;
    assert_eq!(
        evaluation("value = 1\nu = 0.1\ntype = \"A\""),
        Evaluation::TypeA
    );
    assert_eq!(evaluation("value = 1\nu = 0.1"), Evaluation::TypeB);
    assert_eq!(
        faults(&one("readings = [1, 2]\ntype = \"B\""))[0].0,
        "B0207"
    );
}

#[test]
fn elements_of_a_vector_may_have_readings() {
    let text = "[measurand.Y]\nmodel = \"sum(X)\"\n[input.X]\n";
    let found = budget(&format!("{text}readings = [[1, 2, 3], [10, 14]]"));
    let estimates: Vec<f64> = found.inputs.iter().map(|input| input.estimate).collect();
    assert_eq!(estimates, [2.0, 12.0]);
    assert_eq!(found.components[1].name, "X[2]");
    close(found.components[1].u, 2.0);
    assert_eq!(found.components[1].dof, 1.0);
    close(figure(&found, "X[1].s"), 1.0);
    let stated = format!("{text}values = [2, 12, 5]\nreadings = [[1, 2, 3], [10, 14]]");
    assert_eq!(faults(&stated)[0].0, "B0217");
    // Simultaneous readings of the elements.
    let joint =
        format!("{text}readings = [[1, 2, 4, 3], [2, 3, 7, 5]]\n[[joint]]\ninputs = [\"X\"]\n");
    assert!(budget(&joint).groups[0].correlation[(0, 1)] > 0.9);
}

/// A slip of the pen among readings is told, also where the others are rounded alike; a last digit is none.
#[test]
fn a_slip_among_readings_is_told() {
    let remarks = |readings: &str| budget(&one(&format!("readings = {readings}"))).remarks;
    for slip in [
        "[10.01, 10.02, 100.1, 10.03, 10.02, 10.01]",
        "[1.234, 1236, 1.235]",
        "[5.0, 5.0, 5.0, 50.0, 5.0]",
    ] {
        let found = remarks(slip);
        assert_eq!(found.len(), 1, "{slip}");
        assert!(found[0].to_string().contains("lies far from the others"));
    }
    for fine in [
        "[10, 10, 10, 11]",
        "[10.0, 10.0, 10.1, 10.0, 10.3]",
        "[1.234, 1.239, 1.235]",
        "[1, 2]",
    ] {
        assert!(remarks(fine).is_empty(), "{fine}");
    }
}
