//! Laws of textbooks that a straight line leaves out, and what of them a recording shows.

use std::fmt::Write;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with as diagnosed, first_names, named_apart};

/// The absorbance that a photometer with stray light shows: −lg((10⁻ᴬ + s)/(1 + s)).
#[test]
fn stray_light_is_no_change_of_slope() {
    let mut noise = Noise(511);
    let mut rows = "c [mg/L],A\n".to_owned();
    for row in 0..80 {
        let c = 10.0 * f64::from(row % 20 + 1);
        let true_one = 0.0132 * c;
        let shown = -((10_f64.powf(-true_one) + 4e-4) / (1.0 + 4e-4)).log10();
        let _ = writeln!(rows, "{c},{:.4}", shown + 0.0012 * noise.normal());
    }
    let case = "equations = \"A = A0 + k*c\"\n[columns]\nc = \"stimulus\"\nA = \"output\"\n";
    let found = diagnosed("stray", &rows, case);
    let listed = named_apart(&found).concat();
    assert!(listed.iter().any(|id| id == "exponential"), "{listed:?}");
}

/// The kinetic energy of the jet that leaves a capillary viscometer (Hagenbach): ν = C·t − B/t.
#[test]
fn a_correction_in_inverse_proportion_is_listed() {
    let mut noise = Noise(512);
    let mut rows = "nu [mm^2/s],t_flow [s]\n".to_owned();
    for row in 0..36_u32 {
        let nu = [1.0, 2.0, 3.5, 6.0, 10.0, 20.0][row as usize % 6];
        let time = (nu + (nu * nu + 4.0 * 0.01 * 1.0_f64).sqrt()) / 0.02;
        let _ = writeln!(rows, "{nu},{:.2}", time * (1.0 + 6e-4 * noise.normal()));
    }
    let case = "equations = \"t_flow = nu/C\"\n[columns]\nnu = \"stimulus\"\nt_flow = \"output\"\n[parameter]\nC = { start = 0.01, unit = \"mm^2/s^2\" }\n";
    let found = diagnosed("hagenbach", &rows, case);
    let listed = named_apart(&found).concat();
    assert!(listed.iter().any(|id| id == "reciprocal"), "{listed:?}");
}

/// The coils of a spring touch until the weight is more than their initial tension: a bend so strong that its place has to be met.
#[test]
fn the_place_of_a_strong_bend_is_met_at_once() {
    let mut noise = Noise(513);
    let mut rows = "m [g],x [mm]\n".to_owned();
    for row in 0..40 {
        let m = 50.0 * f64::from(row % 8 + 1);
        let x = 40.0 + (m - 120.0_f64).max(0.0) / 4.1;
        let _ = writeln!(rows, "{m},{:.2}", x + 0.03 * noise.normal());
    }
    let case = "equations = \"x = x0 + m/k\"\n[columns]\nm = \"stimulus\"\nx = \"output\"\n";
    let found = diagnosed("spring", &rows, case);
    assert_eq!(first_names(&found), ["kink"], "{found}");
}

/// A turbine meter loses pulses below some flow; the model has no offset that could take up one side of the bend.
#[test]
fn a_bend_may_be_on_the_lower_side() {
    let mut noise = Noise(514);
    let mut rows = "Q [L/min],f [Hz]\n".to_owned();
    for row in 0..90 {
        let q = 2.0 + f64::from(row % 30);
        let f = 24.6 * q - 0.5 * (7.0 - q).max(0.0);
        let _ = writeln!(rows, "{q},{:.2}", f + 0.08 * noise.normal());
    }
    let case = "equations = \"f = K*Q\"\n[columns]\nQ = \"stimulus\"\nf = \"output\"\n";
    let found = diagnosed("pulses", &rows, case);
    assert_eq!(first_names(&found), ["kink"], "{found}");
}

/// A crystal of the AT cut: the frequency is a cubic of the temperature.
#[test]
fn a_crystal_follows_a_cubic_of_the_temperature() {
    let mut noise = Noise(515);
    let mut rows = "T [°C],dF\n".to_owned();
    for row in 0..90 {
        let temperature = -10.0 + 70.0 * f64::from(row * 37 % 90) / 89.0;
        let from = temperature - 27.0;
        let df = 35.0 + 1e-4 * from * from * from - 0.06 * from;
        let _ = writeln!(rows, "{temperature:.1},{:.2}", df + 0.1 * noise.normal());
    }
    let case = "equations = \"dF = y0\"\n[columns]\nT = \"covariate\"\ndF = \"output\"\n";
    let found = diagnosed("crystal", &rows, case);
    assert_eq!(first_names(&found), ["tempco-cubic"], "{found}");
}

/// A lamp warms up while the readings are only numbered.
#[test]
fn numbered_readings_show_a_warm_up() {
    let mut noise = Noise(516);
    let mut rows = "No,c [mg/L],A\n".to_owned();
    for row in 0..60 {
        let c = 20.0 * f64::from(row * 7 % 10);
        let lamp = 0.012 * (-f64::from(row) / 8.0).exp();
        let shown = 0.0132 * c + lamp + 0.0008 * noise.normal();
        let _ = writeln!(rows, "{},{c},{shown:.4}", row + 1);
    }
    let case = "equations = \"A = A0 + k*c\"\n[columns]\nNo = \"order\"\nc = \"stimulus\"\nA = \"output\"\n";
    let found = diagnosed("lamp", &rows, case);
    let listed = named_apart(&found).concat();
    assert!(listed.iter().any(|id| id == "warm-up"), "{found}");
}

/// An ohmmeter changes its range twice, and each range has a zero of its own.
#[test]
fn two_changes_of_range_are_told_together() {
    let mut noise = Noise(517);
    let mut rows = "no,R_ref [ohm],R [ohm]\n".to_owned();
    for row in 0..120 {
        let r = 10.0 + 8.3 * f64::from(row * 37 % 120);
        let zero = match r {
            r if r > 600.0 => -0.02,
            r if r > 200.0 => 0.06,
            _ => 0.0,
        };
        let _ = writeln!(
            rows,
            "{},{r:.1},{:.3}",
            row + 1,
            r + zero + 0.006 * noise.normal()
        );
    }
    let case = "equations = \"R = r0 + g*R_ref\"\n[columns]\nno = \"order\"\nR_ref = \"stimulus\"\nR = \"output\"\n";
    let found = diagnosed("ranges", &rows, case);
    assert_eq!(found["verdict"], "identified", "{found}");
    assert_eq!(first_names(&found), ["transition"], "{found}");
    let variant = &found["effects"][0]["named"][0]["variants"][0];
    assert_eq!(variant["label"], "R_ref above 192.6, 599.3", "{found}");
}

/// Set points that are recorded as they were measured: what differs is the scale above 10 µW, and one head.
#[test]
fn a_change_of_range_lies_between_set_points() {
    let mut noise = Noise(519);
    let mut rows = "P [µW],head,I [µA]\n".to_owned();
    for row in 0..96 {
        let set = [1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0][row % 8];
        let power = set * (1.0 + 0.01 * noise.normal());
        let range = if set > 15.0 { 0.003 * power } else { 0.0 };
        let (head, shift) = [("h1", 0.0), ("h2", 0.06), ("h3", 0.0)][row / 32];
        let current = 1.0 + 2.0 * power + range + shift + 0.01 * noise.normal();
        let _ = writeln!(rows, "{power:.4},{head},{current:.4}");
    }
    let case = "equations = \"I = dark + s*P\"\n[columns]\nP = \"stimulus\"\nI = \"output\"\nhead = \"instrument\"\n";
    let found = diagnosed("measured", &rows, case);
    let listed = named_apart(&found).concat();
    for id in ["level-shift", "transition-scale"] {
        assert!(listed.iter().any(|one| one == id), "{id}: {found}");
    }
}

/// A potentiometer whose shaft is not in line with the scale: the angle is set, and called a stimulus.
#[test]
fn an_angle_that_is_set_has_harmonics() {
    let mut noise = Noise(518);
    let mut rows = "angle [deg],U [V]\n".to_owned();
    for row in 0..101 {
        let angle = 3.5 * f64::from(row);
        let error = 0.006 * libm::sin(angle.to_radians() + 0.4);
        let _ = writeln!(
            rows,
            "{angle},{:.4}",
            0.1 + 0.02 * angle + error + 0.002 * noise.normal()
        );
    }
    let case =
        "equations = \"U = U0 + k*angle\"\n[columns]\nangle = \"stimulus\"\nU = \"output\"\n";
    let found = diagnosed("potentiometer", &rows, case);
    let listed = named_apart(&found);
    assert_eq!(listed.len(), 1, "{found}");
    for id in ["eccentricity", "periodic"] {
        assert!(listed[0].iter().any(|one| one == id), "{listed:?}");
    }
}

#[test]
fn the_rate_of_a_clock_changes_at_one_moment() {
    let mut noise = Noise(74);
    let mut rows = "day [d],phase [ns]\n".to_owned();
    for row in 0..80 {
        let day = 0.5 * f64::from(row);
        let phase = 30.0 + 4.0 * day + 1.2 * (day - 21.0).max(0.0) + 1.1 * noise.normal();
        let _ = writeln!(rows, "{day},{phase:.3}");
    }
    let case = "equations = \"phase = x0 + y0*day\"\n[columns]\nphase = \"output\"\nday = \"time\"\n[noise]\nu = \"1.1 ns\"\n";
    let found = diagnosed("clock", &rows, case);
    assert_eq!(named_apart(&found), [["drift"]], "{found}");
    let label = found["effects"][0]["named"][0]["variants"][0]["label"]
        .as_str()
        .unwrap();
    let day = label
        .strip_prefix("from ")
        .and_then(|rest| rest.strip_suffix(" d on"));
    let day: f64 = day.unwrap_or(label).parse().unwrap();
    assert!((day - 21.0).abs() < 1.5, "{label}");
}
