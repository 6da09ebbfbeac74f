//! Against closed forms, published values, and simulated fleets of which the truth is known.

use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{ChiSquared, Distribution, Normal};

use gumption_format::csv::Cells;

use super::*;
use crate::deviation::Others;
use crate::results::Values;

fn found(table: &str, wanted: &Wanted) -> Fleet {
    match fleet((table.as_bytes(), "results.csv"), wanted) {
        Ok(found) => found,
        Err(rejection) => panic!("{}", rejection.render(false)),
    }
}

fn refusal(table: &str, wanted: &Wanted) -> String {
    let refused = fleet((table.as_bytes(), "results.csv"), wanted);
    refused.expect_err("refused").render(false)
}

fn by(columns: &[&str]) -> Wanted {
    Wanted {
        by: columns.iter().map(|one| (*one).to_owned()).collect(),
        ..Wanted::default()
    }
}

#[track_caller]
fn close(found: f64, expected: f64, relative: f64) {
    let size = expected.abs().max(f64::MIN_POSITIVE);
    assert!(
        (found - expected).abs() <= relative * size,
        "{found} for {expected}"
    );
}

/// A row without k has a weight in the mean, and no expanded uncertainty to be tested by.
#[test]
fn a_row_without_k_is_not_tested() {
    let found = found(
        "label,y,u(y),k(y)\na,1.0,0.1,2\nb,1.1,0.1,\nc,0.9,0.1,2\n",
        &Wanted::default(),
    );
    let agreement = &found.measurands[0].agreement;
    assert_eq!(agreement.tested, 2);
    assert!(agreement.expected.is_finite(), "{agreement:?}");
}

/// Five items with u and U of four degrees of freedom, in a unit 2^exponent times as small: every probability stays.
#[test]
fn the_unit_decides_nothing() {
    let rows = [1.0, 1.3, 0.9, 1.05, 1.6, 1.2];
    let devices = ["a", "b", "c", "d", "e", "a"];
    let in_unit = |exponent: i32| {
        let scale = 2.0_f64.powi(exponent);
        let row = |(at, x): (usize, &f64)| {
            let [x, u, expanded] = [*x, 0.1, 0.25].map(|x| x * scale);
            format!("{},{x:e},{u:e},{expanded:e},4,202{at}-03-01", devices[at])
        };
        let rows: Vec<String> = rows.iter().enumerate().map(row).collect();
        let table = format!("label,K,u(K),U(K),nu(K),date\n{}\n", rows.join("\n"));
        let wanted = Wanted {
            date: Some("date".to_owned()),
            ..Wanted::default()
        };
        (scale, found(&table, &wanted).measurands.remove(0))
    };
    let (_, plain) = in_unit(0);
    assert_eq!(plain.agreement.named, 1);
    let drift = plain.drift.as_ref().expect("dates");
    assert_eq!(drift.devices, 1);
    for exponent in [-1000, -700, -300, -60, 60, 120] {
        let (scale, other) = in_unit(exponent);
        let [own, scaled] = [&plain, &other].map(|one| &one.groups[0]);
        assert_eq!(scaled.s.map(|s| s / scale), own.s, "2^{exponent}");
        assert_eq!([scaled.u / scale, scaled.mean / scale], [own.u, own.mean]);
        let [own, scaled] = [own, scaled].map(|group| group.consistency.expect("weights"));
        assert_eq!([scaled.mean / scale, scaled.u / scale], [own.mean, own.u]);
        assert_eq!(
            [scaled.chi_squared, scaled.birge, scaled.p_larger],
            [own.chi_squared, own.birge, own.p_larger],
            "2^{exponent}"
        );
        assert_eq!(other.agreement.expected, plain.agreement.expected);
        for (own, scaled) in plain.agreement.apart.iter().zip(&other.agreement.apart) {
            assert_eq!((scaled.en, scaled.probability), (own.en, own.probability));
            assert_eq!(scaled.other / scale, own.other);
        }
        let courses = |one: &Measurand| one.drift.as_ref().expect("dates").expected;
        assert_eq!(courses(&other), drift.expected, "2^{exponent}");
        let group = |one: &Measurand| one.drift.as_ref().expect("dates").groups[0].clone();
        assert_eq!(group(&other).mean / scale, group(&plain).mean);
        assert_eq!(group(&other).u / scale, group(&plain).u);
        let apart = [&plain, &other].map(|one| one.agreement.apart.len());
        assert_eq!(apart[0], apart[1]);
    }
}

/// Of nine rows one has a fault, two no estimate, one of them by an overload, three an estimate and no u that weighs it.
#[test]
fn what_is_left_out_is_counted() {
    let table = "label,y,u(y),U(y),error\na,1,0.1,0.2,\nb,1.1,0.1,0.2,\nc,,,,\nd,9.9e37,0.1,0.2,\ne,1,0,0,\n\
                 f,1,,0.2,\ng,1,1e38,0.2,\nh,,,,B0101: no\ni,0.9,0.1,0.2,\n";
    let found = found(table, &Wanted::default());
    let group = &found.measurands[0].groups[0];
    assert_eq!((found.rows, group.values), (9, 6));
    assert_eq!((group.missing, group.unweighed), (2, 3));
    assert_eq!(group.consistency.expect("three").count, 3);
}

/// By hand: 1, 2, 4 with u = 1, 1, 2: weights 1, 1, 1/4, mean 4/2.25, χ² = Σ w x² − (Σ w x)²/Σ w.
#[test]
fn a_group_is_what_arithmetic_makes_of_it() {
    let table = "label,y [V],u(y) [mV],U(y) [V]\na,1,1000,2\nb,2,1000,2\nc,4,2000,4\n";
    let found = found(table, &Wanted::default());
    assert_eq!((found.rows, found.groups.len(), found.tests), (3, 1, 3));
    let y = &found.measurands[0];
    assert_eq!((y.name.as_str(), y.unit.symbol.as_str()), ("y", "V"));
    let group = &y.groups[0];
    close(group.mean, 7.0 / 3.0, 1e-15);
    close(group.s.expect("s"), (7.0_f64 / 3.0).sqrt(), 1e-15);
    assert_eq!(group.range, [1.0, 4.0]);
    close(group.u, 2.0_f64.sqrt(), 1e-15);
    let consistency = group.consistency.expect("three values");
    close(consistency.mean, 16.0 / 9.0, 1e-15);
    close(consistency.u, 2.0 / 3.0, 1e-15);
    let chi_squared = 9.0 - 16.0 / 2.25;
    close(consistency.chi_squared, chi_squared, 1e-14);
    close(consistency.birge, (chi_squared / 2.0).sqrt(), 1e-14);
    // Of two degrees of freedom it is exp(−χ²/2).
    close(consistency.p_larger, (-chi_squared / 2.0).exp(), 1e-14);
    // c against (1 + 2)/2 with u² = 1/2: 2.5/√4.5 standard deviations, k = 2.
    assert_eq!((y.agreement.beyond, y.agreement.tested), (0, 3));
    close(y.agreement.expected, 3.0 * 0.045_500_263_896_358_4, 1e-12);
}

/// CODATA 2018 (Rev. Mod. Phys. 93, 025010, table XXIX): values of the Newtonian constant of gravitation G/(10^-11 m³ kg⁻¹ s⁻²), of
/// which the weighted mean is published as 6.674 30, χ² as 198 and the Birge ratio as 3.63.
const GRAVITATION: [(&str, f64, f64); 16] = [
    ("NIST-82", 6.672_48, 0.000_43),
    ("TR&D-96", 6.672_9, 0.000_50),
    ("LANL-97", 6.673_98, 0.000_70),
    ("UWash-00", 6.674_255, 0.000_092),
    ("BIPM-01", 6.675_59, 0.000_27),
    ("UWup-02", 6.674_22, 0.000_98),
    ("MSL-03", 6.673_87, 0.000_27),
    ("HUST-05", 6.672_22, 0.000_87),
    ("UZur-06", 6.674_25, 0.000_12),
    ("HUST-09", 6.673_49, 0.000_18),
    ("JILA-18", 6.672_60, 0.000_25),
    ("BIPM-14", 6.675_54, 0.000_16),
    ("LENS-14", 6.671_91, 0.000_99),
    ("UCI-14", 6.674_35, 0.000_13),
    ("HUST-T-18", 6.674_184, 0.000_078),
    ("HUST-A-18", 6.674_484, 0.000_077),
];

#[test]
fn the_constant_of_gravitation_is_as_published() {
    let rows = GRAVITATION.map(|(name, x, u)| format!("{name},{x},{u},2"));
    let table = format!("label,G,u(G),k(G)\n{}\n", rows.join("\n"));
    let found = found(&table, &Wanted::default());
    let g = &found.measurands[0];
    let consistency = g.groups[0].consistency.expect("values");
    // The covariances of three pairs, which CODATA takes into account, shift the last digit of the mean.
    assert!(
        (consistency.mean - 6.674_30).abs() < 1.5e-5,
        "{consistency:?}"
    );
    assert!(
        (consistency.chi_squared - 198.0).abs() < 0.5,
        "{consistency:?}"
    );
    assert!((consistency.birge - 3.63).abs() < 0.005, "{consistency:?}");
    let sum = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        GRAVITATION.iter().map(|(_, x, u)| f(*x, *u)).sum()
    };
    let w = sum(&|_, u| 1.0 / (u * u));
    let mean = sum(&|x, u| x / (u * u)) / w;
    close(consistency.mean, mean, 1e-13);
    close(
        consistency.chi_squared,
        sum(&|x, u| ((x - mean) / u).powi(2)),
        1e-9,
    );
    assert!(consistency.p_larger < 1e-20);
}

/// How many times the scatter is what u says does not depend on how well u is known: 20 items at ±30 about 0 with u = 1 have
/// √(20·30²/19) = 30.78.
#[test]
fn the_birge_ratio_is_that_of_the_figures() {
    let birge = |dof: &str| {
        let rows =
            (0..20).map(|i| format!("S{i},{},1,2,{dof}\n", if i % 2 == 0 { 30 } else { -30 }));
        let table = format!("label,y,u(y),k(y),nu(y)\n{}", rows.collect::<String>());
        let found = found(&table, &Wanted::default());
        found.measurands[0].groups[0].consistency.expect("values")
    };
    let [known, loose] = ["inf", "5"].map(birge);
    for one in [known, loose] {
        close(one.chi_squared, 20.0 * 900.0, 1e-12);
        close(one.birge, (18_000.0_f64 / 19.0).sqrt(), 1e-12);
        assert_eq!(one.scatter(1), Scatter::More);
    }
    assert!(known.p_larger < loose.p_larger);
}

/// One u for all rows, known to 10 % (ν = 50): rows without number do not prove it 2 % too large. Known exactly, they do.
#[test]
fn a_shared_u_is_known_no_better_than_its_degrees_of_freedom() {
    let scatter = |birge: f64, dof_of_u| {
        let dof = 50_000;
        let chi_squared = birge * birge * f64::from(dof);
        let found = Consistency {
            count: dof as usize + 1,
            mean: 0.0,
            u: 1.0,
            chi_squared,
            dof: dof as usize,
            birge,
            p_larger: gumption_core::special::chi_squared_sf(chi_squared, f64::from(dof)),
            dof_of_u,
        };
        found.scatter(1)
    };
    assert_eq!(scatter(0.98, 50.0), Scatter::AsClaimed);
    assert_eq!(scatter(0.98, f64::INFINITY), Scatter::Less);
    assert_eq!(scatter(1.02, f64::INFINITY), Scatter::More);
    assert_eq!(scatter(0.8, 50.0), Scatter::Less);
    assert_eq!(scatter(1.3, 50.0), Scatter::More);
}

/// A value that lies apart does not make the others lie apart, and is named as the only one.
#[test]
fn one_that_lies_apart_is_named_alone() {
    for count in [4_usize, 5, 20] {
        let mut table = String::from("label,y,u(y),k(y)\nbad,30,1,2\n");
        for row in 1..count {
            table += &format!("good {row},{},1,2\n", [0.3, -0.4, 0.1, 0.6, -0.6][row % 5]);
        }
        let found = found(&table, &Wanted::default());
        let agreement = &found.measurands[0].agreement;
        assert_eq!(
            (agreement.beyond, agreement.named),
            (1, 1),
            "{count}: {agreement:?}"
        );
        assert_eq!(
            (agreement.apart[0].device.as_str(), agreement.apart[0].row),
            ("bad", 1)
        );
    }
    // Of two neither is the one.
    let found = found("y,u(y),k(y)\n0,1,2\n30,1,2\n", &Wanted::default());
    let apart = &found.measurands[0].agreement.apart;
    close(apart[0].en, -30.0 / (2.0 * 2.0_f64.sqrt()), 1e-15);
    assert_eq!(apart[0].en, -apart[1].en);
    assert_eq!([&apart[0].device, &apart[1].device], ["1", "2"]);
}

/// ISO 13528: E_n = (x − X)/√(U_x² + U_X²), each U as it is stated.
#[test]
fn stated_references_are_what_rows_are_held_against() {
    let table = "label,y [V],u(y) [V],k(y),X [mV],U(X) [mV]\n\
                 a,1.000,0.01,2,1030,10\nb,1.100,0.02,2,1000,30\nc,1,0.01,2,,\nd,1.5,0.01,2,1000,0\n";
    let wanted = Wanted {
        references: vec!["X".into()],
        ..Wanted::default()
    };
    let found = found(table, &wanted);
    assert_eq!(found.measurands.len(), 1);
    let y = &found.measurands[0];
    assert_eq!(
        (
            y.reference.as_deref(),
            y.agreement.tested,
            y.agreement.beyond
        ),
        (Some("X"), 3, 3)
    );
    let apart = &y.agreement.apart;
    let en: Vec<(&str, f64)> = apart
        .iter()
        .map(|one| (one.device.as_str(), one.en))
        .collect();
    assert_eq!([en[0].0, en[1].0, en[2].0], ["d", "b", "a"]);
    close(en[0].1, 0.5 / 0.02, 1e-12);
    close(en[1].1, 0.1 / 0.05, 1e-12);
    close(en[2].1, -0.03 / 0.0005_f64.sqrt(), 1e-12);
    // Three tests, each of 2 Φ(−|d|/u), u(X) being U(X)/2.
    close(
        apart[2].probability,
        3.0 * 2.0 * gumption_core::special::normal_sf(0.06 / 0.0005_f64.sqrt()),
        1e-9,
    );
    let two = "y,u(y),k(y),z,u(z),k(z),X,U(X)\n1,1,2,1,1,2,1,1\n";
    let refused = refusal(two, &wanted);
    assert!(refused.contains("--reference MEASURAND=X"), "{refused}");
    assert!(refused.contains("with one of y, z"), "{refused}");
    let of_z = Wanted {
        references: vec!["z=X".into()],
        ..Wanted::default()
    };
    assert_eq!(
        fleet((two.as_bytes(), ""), &of_z)
            .expect("results")
            .measurands[1]
            .reference
            .as_deref(),
        Some("X")
    );
    assert!(refusal("y,u(y),k(y),X\n1,1,2,1\n", &wanted).contains("add a column U(X)"));
    // Without the argument X is no measurand with half an uncertainty, but a reference.
    let untold = "y,u(y),k(y),X,U(X)\n1,1,2,1,1\n";
    assert!(refusal(untold, &Wanted::default()).contains("write `--reference X`"));
    // Nothing is said of the reference where no measurand is understood.
    let other = refusal("y [m],u(y),k(y),X,U(X)\n1,1,2,1,1\n", &wanted);
    assert!(!other.contains("MEASURAND"), "{other}");
}

/// A row with a fault, and good ones below it: the fault is told, with those of further rows.
#[test]
fn rows_with_faults_stand_before_good_ones() {
    let dated = Wanted {
        date: Some("date".into()),
        ..Wanted::default()
    };
    let table = "y,u(y),k(y),date\n1,1,2,2023-13-45\n1,1,2,2023-01-01\n1,x,2,2023-01-01\n1,1,2,2023-01-01\n";
    let said = refusal(table, &dated);
    assert!(
        said.contains("line 2: \"2023-13-45\" is not a date"),
        "{said}"
    );
    assert!(said.contains("line 4: \"x\" is not a number"), "{said}");
}

/// What is said of so many simulated fleets of 25 devices whose u is right: E_n beyond 1, how many chance lets expect, fleets in which a
/// device is named, fleets in which p(χ²) is below 5 %.
fn honest(fleets: usize, dof: f64) -> (usize, f64, [usize; 2]) {
    let mut rng = StdRng::seed_from_u64(1);
    let normal = Normal::new(0.0, 1.0).expect("a distribution");
    let (mut beyond, mut expected, mut counts) = (0, 0.0, [0; 2]);
    for _ in 0..fleets {
        let mut table = String::from("label,y,u(y),nu(y),k(y)\n");
        for row in 0..25 {
            let sigma = 1.0 + f64::from(row % 3);
            let u = match dof.is_finite() {
                true => {
                    let squares = ChiSquared::new(dof).expect("a distribution");
                    sigma * (squares.sample(&mut rng) / dof).sqrt()
                }
                false => sigma,
            };
            let x = 100.0 + sigma * normal.sample(&mut rng);
            table += &format!("{row},{x},{u},{dof},2\n");
        }
        let y = found(&table, &Wanted::default()).measurands.remove(0);
        beyond += y.agreement.beyond;
        expected += y.agreement.expected;
        let consistency = y.groups[0].consistency.expect("values");
        counts[0] += usize::from(y.agreement.named > 0);
        counts[1] += usize::from(consistency.p_larger < SIGNIFICANCE);
    }
    (beyond, expected, counts)
}

/// Also where ν is small: as many E_n beyond 1 as expected, χ² as probable as it says, and a name in no more fleets than stated.
#[test]
fn honest_fleets_are_called_so() {
    const FLEETS: usize = 500;
    // Counts within four standard deviations of Poisson's distribution.
    let near = |count: usize, mean: f64| (count as f64 - mean).abs() < 4.0 * mean.sqrt();
    for dof in [10.0, f64::INFINITY] {
        let (beyond, expected, [named, improbable]) = honest(FLEETS, dof);
        let stated = SIGNIFICANCE * FLEETS as f64;
        assert!(near(beyond, expected), "ν {dof}: {beyond} for {expected}");
        assert!(
            near(improbable, stated),
            "ν {dof}: {improbable} for {stated}"
        );
        assert!(near(named, stated), "ν {dof}: {named} for {stated}");
    }
}

#[test]
#[ignore = "prints the figures of docs/fleet-statistics.md"]
fn honest_fleets_in_figures() {
    const FLEETS: usize = 8000;
    for dof in [f64::INFINITY, 20.0, 10.0, 4.0] {
        let (beyond, expected, counts) = honest(FLEETS, dof);
        let [named, improbable] = counts.map(|count| 100.0 * count as f64 / FLEETS as f64);
        println!(
            "ν {dof}: {beyond} E_n beyond 1 for {expected:.0}, named in {named:.1} %, p < 5 % in {improbable:.1} %"
        );
    }
}

/// Two dates: rate, u and U are differences over the time; more of them: least squares by the normal equations.
#[test]
fn drift_is_a_weighted_slope() {
    let wanted = Wanted {
        date: Some("date".into()),
        ..by(&["type"])
    };
    let table = "label,type,date,y,u(y),U(y)\n\
        p,A,2020-01-01,1,0.1,0.2\nq,A,2020-01-01,5,0.1,0.2\np,A,2024-01-01,3,0.1,0.2\nq,A,2024-01-01,5.1,0.1,0.2\n\
        r,B,2020-01-01,0,1,2\nr,B,2021-01-01,2,2,4\nr,B,2022-01-01 12:00,3,1,2\nr,B,,99,1,2\ns,B,2020-01-01,1,1,2\n";
    let found = found(table, &wanted);
    assert_eq!(
        found
            .groups
            .iter()
            .map(|one| one.key[0].as_str())
            .collect::<Vec<_>>(),
        ["A", "B"]
    );
    let drift = found.measurands[0].drift.as_ref().expect("dates");
    assert_eq!((drift.devices, drift.beyond, drift.named), (3, 2, 1));
    let p = &drift.apart[0];
    // 1461 days are four years of 365.25.
    close(p.rate, 0.5, 1e-14);
    close(p.u, 0.02_f64.sqrt() / 4.0, 1e-14);
    close(p.expanded, 0.08_f64.sqrt() / 4.0, 1e-14);
    close(p.en, 2.0 / 0.08_f64.sqrt(), 1e-14);
    assert_eq!((p.device.as_str(), p.calibrations), ("p", 2));
    let a = &drift.groups[0];
    assert_eq!((a.devices, a.pairs, a.pairs_beyond), (2, 2, 1));
    close(a.mean, 0.2625, 1e-13);
    close(a.s.expect("two"), (0.5 - 0.025) / 2.0_f64.sqrt(), 1e-13);
    let years = [0.0, 366.0 / 365.25, 731.5 / 365.25];
    let (x, w) = ([0.0, 2.0, 3.0], [1.0, 0.25, 1.0]);
    let sum = |f: &dyn Fn(usize) -> f64| -> f64 { (0..3).map(|i| w[i] * f(i)).sum() };
    let (n, t, tt) = (
        sum(&|_| 1.0),
        sum(&|i| years[i]),
        sum(&|i| years[i] * years[i]),
    );
    let (s, st) = (sum(&|i| x[i]), sum(&|i| x[i] * years[i]));
    let b = &drift.groups[1];
    assert_eq!((b.devices, b.s), (1, None));
    close(b.mean, (n * st - t * s) / (n * tt - t * t), 1e-13);
    close(b.u, (n / (n * tt - t * t)).sqrt(), 1e-13);
    assert_eq!(drift.courses.len(), 3);
}

#[test]
fn what_rows_have_is_counted() {
    let table = "label;y;u(y);k(y);share(y, a);share(y, b);verdict(c);findings;error\n\
        1;1;1;2;0,6;0,4;conforms;k_from_t few;\n2;2;1;2;0,3;0,7;conforms;k_from_t;\n3;;;;;;;;B0201: nothing: at all\n4;3;1;2;0,8;0,2;does not;;\n";
    let found = found(table, &Wanted::default());
    let group = &found.groups[0];
    let counts = |all: &[(&str, usize)]| {
        all.iter()
            .map(|(a, b)| ((*a).to_owned(), *b))
            .collect::<Vec<_>>()
    };
    assert_eq!(group.faulty, counts(&[("B0201", 1)]));
    assert_eq!(group.findings, counts(&[("k_from_t", 2), ("few", 1)]));
    assert_eq!(
        group.verdicts[0].1,
        counts(&[("conforms", 2), ("does not", 1)])
    );
    let components = &found.measurands[0].groups[0].components;
    let component = |name: &str, dominates, median_share| Component {
        name: name.into(),
        dominates,
        median_share,
    };
    assert_eq!(
        *components,
        [component("a", 2, 0.6), component("b", 1, 0.4)]
    );
}

#[test]
fn groups_may_be_small_or_without_anything() {
    let table = "label,type,lab,y,u(y),k(y)\na,A,x,1,1,2\nb,B,x,2,0,2\nc,C,y,,,\nd,D,y,1,,\n";
    let all = found(table, &by(&["lab", "type"]));
    assert_eq!(all.groups[1].key, ["x", "B"]);
    let y = &all.measurands[0];
    assert_eq!(
        y.groups.iter().map(|one| one.values).collect::<Vec<_>>(),
        [1, 1, 0, 1]
    );
    assert!(
        y.groups
            .iter()
            .all(|one| one.consistency.is_none() && one.tested == 0)
    );
    assert_eq!((y.groups[0].s, y.agreement.tested), (None, 0));
}

/// Rows of several groups and dates, more of them than one stretch of one thread, from numbers that look random.
fn large() -> String {
    let mut random = StdRng::seed_from_u64(11);
    let normal = Normal::new(0.0, 1.0).expect("a distribution");
    let mut table = String::from("label,type,date,y,u(y),nu(y),k(y)\n");
    for row in 0..70_000 {
        let (device, dof) = (row / 3, 5 + row % 90);
        let x = 10.0 + 0.01 * normal.sample(&mut random);
        let kind = ["A", "B"][device % 2];
        table += &format!(
            "d{device},{kind},202{}-03-01,{x:.9},0.01,{dof},2\n",
            row % 3
        );
    }
    table
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let table = large();
    let on = |threads: usize| {
        let wanted = Wanted {
            date: Some("date".into()),
            threads: Some(threads),
            ..by(&["type"])
        };
        format!("{:?}", found(&table, &wanted))
    };
    let one = on(1);
    assert!(one.contains("tests: 70000"));
    for threads in [2, 3, 16] {
        assert!(on(threads) == one, "{threads} threads");
    }
}

#[test]
fn columns_in_memory_are_a_table() {
    let table = "label,type,y [V],u(y) [mV],U(y) [V],error\na,A,1,1000,2,\nb,A,2,1000,2,\nc,B,,,,\"G0101: no\"\nd,A,9.5,1000,2,\n";
    let wanted = by(&["type"]);
    let expected = format!("{:?}", found(table, &wanted));
    let texts = |all: [&str; 4]| Cells::Texts(all.map(str::to_owned).to_vec());
    let numbers = |all: [f64; 4]| Cells::Numbers(all.to_vec().into());
    let missing = f64::NAN;
    let columns = vec![
        ("label".to_owned(), texts(["a", "b", "c", "d"])),
        ("type".to_owned(), texts(["A", "A", "B", "A"])),
        ("y [V]".to_owned(), numbers([1.0, 2.0, missing, 9.5])),
        (
            "u(y) [mV]".to_owned(),
            numbers([1000.0, 1000.0, missing, 1000.0]),
        ),
        ("U(y) [V]".to_owned(), texts(["2", "2", "", "2"])),
        ("error".to_owned(), texts(["", "", "G0101: no", ""])),
    ];
    let columns = Columns::new(columns).expect("equal lengths");
    let in_memory = fleet_of_columns((&columns, "table"), &wanted);
    let in_memory = in_memory.map_err(|rejection| rejection.render(false));
    assert_eq!(format!("{:?}", in_memory.expect("a fleet")), expected);
}

#[test]
fn what_is_missing_or_wrong_is_told() {
    let table =
        "label,typ,date,y [V],u(y) [V],k(y)\na,A,2026-01-01,1,1,2\nb,A,9:30,1,1,2\nc,A,x,1,1,2\n";
    let dated = Wanted {
        date: Some("date".into()),
        ..Wanted::default()
    };
    let said = refusal(table, &dated);
    assert!(
        said.contains("line 3: \"9:30\" is not a date") && said.contains("line 4: \"x\""),
        "{said}"
    );
    for (field, mend) in [
        ("15/01/2026", "write 2026-01-15"),
        (
            "3/1/2026",
            "write 2026-03-01, or 2026-01-03 if the day goes first",
        ),
    ] {
        let said = refusal(&table.replace("9:30", field), &dated);
        assert!(said.contains(mend), "{said}");
    }
    assert!(refusal(table, &by(&["type"])).contains("did you mean \"typ\"?"));
    assert!(refusal(table, &by(&["laboratory"])).contains("`gumption batch --keep laboratory`"));
    assert!(refusal("label,y\na,1\n", &Wanted::default()).contains("F0101"));
    assert!(refusal("y,U(y)\n1,1\n", &Wanted::default()).contains("two of u(y), k(y) and U(y)"));
    assert!(refusal("y [V],u(y),k(y)\n1,1,2\n", &Wanted::default()).contains("write u(y) [V]"));
    assert!(refusal("y [V],u(y) [m],k(y)\n1,1,2\n", &Wanted::default()).contains("dimension of V"));
    assert!(
        refusal("y,u(y),k(y)\n1,one,2\n", &Wanted::default())
            .contains("line 2: \"one\" is not a number")
    );
    for (row, said) in [
        ("1,-1,2,5", "u(y) cannot be -1"),
        ("1,1,-2,5", "k(y) cannot be -2"),
        ("1,1,2,0", "nu(y) cannot be 0"),
    ] {
        let table = format!("y,u(y),k(y),nu(y)\n1,1,2,\n{row}\n");
        assert!(refusal(&table, &Wanted::default()).contains(&format!("line 3: {said}")));
    }
    assert!(refusal("y,u(y),k(y)\n", &Wanted::default()).contains("the table has no rows"));
    assert!(refusal("y,y [V],u(y),k(y)\n1,1,1,2\n", &Wanted::default()).contains("two columns"));
    assert!(refusal("", &Wanted::default()).contains("empty"));
}

/// U, k and u that are all given belong together, as far as their digits tell.
#[test]
fn an_expanded_uncertainty_is_k_times_u() {
    let row = |figures: &str| format!("label,y [V],u(y) [mV],k(y),U(y) [V]\na,1,{figures}\n");
    for fit in [
        "1000,2,2",
        "1000,2,2.0",
        "1000,1.96,1.96",
        "12.3,2,0.025",
        "1000,,2",
        "1000,2,",
    ] {
        found(&row(fit), &Wanted::default());
    }
    for unfit in ["1000,2,2.5", "1000,2,2000", "12.3,2,0.0300"] {
        let said = refusal(&row(unfit), &Wanted::default());
        assert!(said.contains("F0105"), "{unfit}: {said}");
    }
    assert!(refusal(&row("1000,0,0"), &Wanted::default()).contains("F0104"));
    let engine = found(
        "label,y [V],u(y) [V],expanded(y) [V]\na,1,0.1,0.2\nb,1.1,0.1,0.2\n",
        &Wanted::default(),
    );
    assert_eq!(engine.measurands[0].agreement.tested, 2);
}

/// What is no row of the table, or read in two ways, is refused.
#[test]
fn what_a_batch_refuses_is_refused() {
    let rows = "label;y;u(y);k(y)\nA;1,0;0,1;2\nB;1,1;0,1;2\nC;1,2;0,1;2\n";
    assert_eq!(found(rows, &Wanted::default()).rows, 3);
    let said = refusal(&format!("{rows}D;1.234;0,1;2\n"), &Wanted::default());
    assert!(said.contains("decimal"), "{said}");
    let said = refusal(&format!("{rows}mean;1,1;0,1;2\n"), &Wanted::default());
    assert!(said.contains("means of those"), "{said}");
}

/// Certificates of thermometers state U in °C: a difference, of values and of references alike.
#[test]
fn an_uncertainty_in_degrees_is_a_difference() {
    let units = [
        ["°C", "K", "0.02"],
        ["°C", "°C", "0.02"],
        ["℃", "℃", "0.02"],
        ["K", "°C", "0.02"],
        ["°C", "℉", "0.036"],
    ];
    for [unit, of_u, expanded] in units {
        let row = |(name, t): (&str, &str)| format!("{name},{t},{expanded},2,20,{expanded}\n");
        let rows = [("a", "20.01"), ("b", "22.02"), ("c", "20.00"), ("d", "20")].map(row);
        let heads = format!("label,t [{unit}],U(t) [{of_u}],k(t)");
        let alone = format!("{heads},kept,kept too\n{}", rows.concat());
        let found_alone = found(&alone, &Wanted::default());
        let t = &found_alone.measurands[0];
        close(t.groups[0].u, 0.01, 1e-9);
        assert_eq!(t.agreement.named, 1, "{unit}, {of_u}");
        let referred = format!("{heads},X [{unit}],U(X) [{of_u}]\n{}", rows.concat());
        let wanted = Wanted {
            references: vec!["X".to_owned()],
            ..Wanted::default()
        };
        let found_referred = found(&referred, &wanted);
        let apart = &found_referred.measurands[0].agreement.apart;
        assert_eq!(apart.len(), 1, "{unit}, {of_u}");
        close(apart[0].en, 2.02 / (0.02 * 2.0_f64.sqrt()), 1e-9);
    }
}

/// Heads as tables of devices may have them, where the unit stands in round brackets or behind a solidus.
#[test]
fn units_stand_in_other_brackets_and_behind_a_solidus() {
    let rows = "a,20.01,0.01,2\nb,22.02,0.01,2\nc,20.00,0.01,2\nd,20.00,0.01,2\n";
    for heads in [
        "y (mm),u(y) (mm),k(y)",
        "y（mm）,u(y)（mm）,k(y)",
        "y/mm,u(y)/mm,k(y)",
        "y ［mm］,u(y) ［mm］,k(y)",
        "y [mm],u(y)/mm,k(y)",
    ] {
        let found = found(&format!("label,{heads}\n{rows}"), &Wanted::default());
        let y = &found.measurands[0];
        assert_eq!((y.name.as_str(), y.unit.symbol.as_str()), ("y", "mm"));
        assert_eq!(y.agreement.apart[0].device, "b", "{heads}");
    }
    // What is in brackets behind these words is a name, also where it is that of a unit.
    let named = "label,m,u(m),k(m),verdict(m),share(m; A)\na,1,0.1,2,conforming,1\nb,1,0.1,2,conforming,1\n";
    let found = found(named, &Wanted::default());
    assert!(found.measurands[0].unit.is_one());
}

/// What is wrong with a device is wrong with its other calibrations: others are other devices.
#[test]
fn other_calibrations_of_a_device_are_none_of_the_others() {
    let dated = Wanted {
        date: Some("date".to_owned()),
        ..Wanted::default()
    };
    let head = "label,date,y,u(y),k(y)\n";
    let sound = [
        "b,2023-01-01,10.0,0.1,2\n",
        "c,2023-01-01,10.02,0.1,2\n",
        "d,2024-01-01,9.98,0.1,2\n",
    ];
    let apart = ["a,2023-01-01,10.25,0.1,2\n", "a,2024-01-01,10.26,0.1,2\n"];
    let table = |rows: &[&str]| format!("{head}{}{}", sound.concat(), rows.concat());
    let of_a = |found: &Fleet, row: usize| {
        let mut all = found.measurands[0].agreement.apart.iter();
        let one = all.find(|one| one.row == row).expect("a row that is apart");
        one.other
    };
    let both = found(&table(&apart), &dated);
    close(of_a(&both, 4), 10.0, 1e-12);
    close(of_a(&both, 5), 10.0, 1e-12);
    assert_eq!(both.measurands[0].agreement.tested, 5);
    let alone = found(&format!("{head}{}", apart.concat()), &dated);
    assert_eq!((alone.tests, alone.measurands[0].agreement.tested), (0, 0));
    // Without dates each row is an item of its own.
    let undated = found(&table(&apart), &Wanted::default());
    assert!(undated.measurands[0].agreement.tested == 5);
}

/// Also where a device weighs more than all others, of which a difference of sums would leave nothing.
#[test]
fn a_device_that_weighs_most_leaves_the_others_whole() {
    let values = Values {
        estimate: vec![1.0, 1.1, 3.0, 3.2, 5.0],
        u: vec![1e-9, 1e-9, 0.1, 0.1, 0.2],
        dof: vec![f64::INFINITY; 5],
        expanded: vec![f64::NAN; 5],
    };
    let devices = [7, 7, 8, 8, 9];
    let rows = [0, 1, 2, 3, 4];
    let others = Others::of(&values, &rows, 3.0, Some(&devices));
    let other = |row: usize| others.deviation(row, true).expect("others").other;
    for row in [0, 1] {
        close(other(row), (300.0 + 320.0 + 125.0) / 225.0, 1e-14);
    }
    close(other(2), 1.05, 1e-12);
    close(other(4), 1.05, 1e-12);
}

/// Chinese tables have such dates.
#[test]
fn dates_are_read_in_chinese() {
    let rows =
        |a: &str, b: &str| format!("label,日期,y,u(y),k(y)\nd,{a},1.0,0.1,2\nd,{b},1.3,0.1,2\n");
    let dated = Wanted {
        date: Some("日期".to_owned()),
        ..Wanted::default()
    };
    let rate = |table: &str| {
        let found = found(table, &dated);
        let drift = found.measurands[0].drift.clone().expect("dates");
        drift.groups[0].mean
    };
    let iso = rate(&rows("2022-03-01", "2023-03-01"));
    assert_eq!(rate(&rows("2022年3月1日", "2023年03月01日")), iso);
}
