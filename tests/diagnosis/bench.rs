//! Recordings as they come from a bench: what is off in the record or in the electronics rather than in the sensor.

use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{
    diagnosed as diagnosed_in, diagnosed_with as diagnosed, first_names, folder, named_apart,
};

/// The likeliest variant of the first effect.
fn variant(diagnosis: &Value) -> &str {
    let named = &diagnosis["effects"][0]["named"][0];
    named["variants"][0]["label"].as_str().unwrap_or_default()
}

/// Whether the first size of the improved model is this one.
fn has_size(diagnosis: &Value, truth: f64) -> bool {
    let first = &diagnosis["improved"]["coefficients"][0];
    let figure = |key: &str| first[key].as_f64().unwrap_or(f64::NAN);
    (figure("value") - truth).abs() < 4.0 * figure("u")
}

/// Ten rows of forty are in psi where kPa is meant: the noise is that of the other rows.
#[test]
fn a_stretch_of_rows_is_in_another_unit() {
    let mut noise = Noise(28);
    let mut rows = "no,p_ref [kPa],p [kPa]\n".to_owned();
    for row in 0..40 {
        let p = 50.0 * f64::from(row % 5 + 1);
        let unit = if (20..30).contains(&row) {
            6.894_757
        } else {
            1.0
        };
        let _ = writeln!(
            rows,
            "{row},{p},{:.3}",
            (p + 0.2 + 0.08 * noise.normal()) / unit
        );
    }
    let case = "equations = \"p = a + b*p_ref\"\n[columns]\nno = \"order\"\n";
    let found = diagnosed("psi", &rows, case);
    assert_eq!(first_names(&found), ["stretch-scale"], "{found}");
    // The zero error is in psi, too.
    assert_eq!(variant(&found), "rows 21 to 30, of the whole reading");
    assert!(has_size(&found, 1.0 / 6.894_757 - 1.0), "{found}");
}

/// From row 46 on every reading is the one before.
#[test]
fn a_reading_was_taken_twice() {
    let mut noise = Noise(50);
    let mut rows = "t [s],x [mm],U [V]\n".to_owned();
    let x = |row: i32| f64::from(20 + 2 * (7 * row % 10));
    for row in 0..80 {
        let read = x(if row >= 45 { row - 1 } else { row });
        let _ = writeln!(
            rows,
            "{row},{},{:.4}",
            x(row),
            0.2 * read + 0.003 * noise.normal()
        );
    }
    let found = diagnosed(
        "twice",
        &rows,
        "equations = \"U = a + b*x\"\n[columns]\nt = \"time\"\n",
    );
    assert_eq!(first_names(&found), ["shifted"], "{found}");
    assert_eq!(variant(&found), "one row late, from row 46 on");
}

/// A converter ends at 10 V and at −10 V, which with an offset are different stimuli.
#[test]
fn a_converter_ends_on_both_sides() {
    let mut noise = Noise(30);
    let mut rows = "a [gn],U [V]\n".to_owned();
    for row in 0..39 {
        let a = f64::from(row / 3 - 6);
        let volt = (2.0 * a + 0.1 + 0.01 * noise.normal()).clamp(-10.0, 10.0);
        let _ = writeln!(rows, "{a},{volt:.3}");
    }
    let found = diagnosed("converter", &rows, "equations = \"U = b + K*a\"\n");
    assert_eq!(first_names(&found), ["saturation"], "{found}");
    assert_eq!(variant(&found), "above 10 V, below -10 V");
}

/// A Geiger counter with a dead time of 90 µs: the loss is a half at 11 111 counts per second, and the size of the square is K²τ.
#[test]
fn a_counter_loses_what_its_dead_time_says() {
    let mut noise = Noise(13);
    let mut rows = "A,N\n".to_owned();
    for row in 0..28 {
        let a = 100.0 * f64::from(1 << (row / 4));
        let n = 60.0 * a / (1.0 + 9e-5 * a);
        let _ = writeln!(rows, "{a},{:.0}", n + 200.0 * noise.normal());
    }
    let found = diagnosed("counter", &rows, "equations = \"N = K*A + B\"\n");
    assert_eq!(first_names(&found), ["quadratic"], "{found}");
    // `levelling off, half at 11100 1`
    let half = variant(&found).split(' ').nth(4).map(str::parse::<f64>);
    let Some(Ok(half)) = half else {
        panic!("{}", variant(&found));
    };
    assert!((half / 11_111.0 - 1.0).abs() < 0.1, "{half}");
}

/// A latency of less than the interval has the size that it is found to have.
#[test]
fn a_latency_is_told_by_its_size() {
    let mut noise = Noise(31);
    let mut rows = "t [s],x [mm],U [V]\n".to_owned();
    let x = |t: f64| 50.0 * libm::sin(4.4 * t);
    for row in 0..150 {
        let t = 0.02 * f64::from(row);
        let _ = writeln!(
            rows,
            "{t:.2},{:.4},{:.4}",
            x(t),
            0.1 * x(t - 0.006) + 0.004 * noise.normal()
        );
    }
    let found = diagnosed(
        "latency",
        &rows,
        "equations = \"U = a + K*x\"\n[columns]\nt = \"time\"\n",
    );
    assert_eq!(first_names(&found)[0], "timing-skew", "{found}");
    assert_eq!(variant(&found), "");
    assert!(has_size(&found, 0.006), "{found}");
}

/// A delay of more than an interval, along a course that bends between the rows and was under way before the first of them.
#[test]
fn a_delay_along_a_bending_course_is_told_by_its_size() {
    let mut noise = Noise(84);
    let mut rows = "t [s],x [mm],U [mV]\n".to_owned();
    let x = |t: f64| 5.0 * libm::sin(0.105 * t) + 2.0 * libm::sin(0.273 * t + 1.0);
    for row in 0..200 {
        let t = 2.0 * f64::from(row);
        let output = 0.4 + 3.0 * x(t - 2.4) + 0.05 * noise.normal();
        let _ = writeln!(rows, "{t},{:.5},{output:.4}", x(t));
    }
    let found = diagnosed(
        "delay",
        &rows,
        "equations = \"U = a + K*x\"\n[columns]\nt = \"time\"\nx = \"stimulus\"\nU = \"output\"\n",
    );
    assert_eq!(first_names(&found)[0], "timing-skew", "{found}");
    assert_eq!(found["verdict"], "identified", "{found}");
    let delay = &found["improved"]["coefficients"][0]["value"];
    let delay = delay.as_f64().unwrap_or(f64::NAN);
    // A hundredth of an interval: what a spline leaves.
    assert!((delay - 2.4).abs() < 0.02, "{found}");
}

/// A gyroscope that is switched off between its runs warms up in each.
#[test]
fn an_instrument_warms_up_anew_in_each_run() {
    let mut noise = Noise(7);
    let mut rows = "t [s],run,w [deg/s],U [mV]\n".to_owned();
    for run in 0..5 {
        for (row, w) in [0, 50, 100, 50, 0, -50, -100, -50]
            .repeat(2)
            .iter()
            .enumerate()
        {
            let since = 60.0 * row as f64;
            let volt = f64::from(*w) + 0.4 * libm::exp(-since / 240.0) + 0.012 * noise.normal();
            let _ = writeln!(
                rows,
                "{},{run},{w},{volt:.4}",
                7200.0 * f64::from(run) + since
            );
        }
    }
    let case = "equations = \"U = K*w + b\"\n[columns]\nt = \"time\"\nrun = \"run\"\n";
    let found = diagnosed("turn-on", &rows, case);
    assert_eq!(first_names(&found), ["warm-up"], "{found}");
    assert!(variant(&found).ends_with("anew in each run"), "{found}");
    assert!(has_size(&found, 0.4), "{found}");
}

/// The resistance at 0 °C is not the nominal one; the model has the square of the temperature already.
#[test]
fn a_nominal_value_is_not_kept() {
    let mut noise = Noise(59);
    let mut rows = "no,t [degC],R [ohm]\n".to_owned();
    for row in 0..33_i32 {
        let t = f64::from(20 * (5 - (row % 11 - 5).abs()));
        let r = 100.05 * (1.0 + 3.9083e-3 * t - 5.775e-7 * t * t) + 0.003 * noise.normal();
        let _ = writeln!(rows, "{row},{t},{r:.4}");
    }
    let case = "equations = \"R = R0*(1 + A*t + B*t^2)\"\n[columns]\nno = \"order\"\n[constant]\nR0 = \"100 ohm\"\n[parameter]\nA = { unit = \"1/K\" }\nB = { unit = \"1/K^2\" }\n";
    let found = diagnosed("pt100", &rows, case);
    let mut names = named_apart(&found).remove(0);
    names.sort();
    assert_eq!(names, ["factor", "zero", "zero-of"], "{found}");
}

/// A capacitor is charged to 4.545 V and not to the 5 V that the model takes as exact: the fit bends the time constant until
/// nothing is left of the form, which is a scale error all the same.
#[test]
fn a_nominal_value_bends_the_fit_of_what_is_not_linear() {
    let mut noise = Noise(61);
    let mut rows = "t [s],U [V]\n".to_owned();
    for row in 0..60 {
        let t = f64::from(row);
        let u = -4.545 * libm::expm1(-t / 9.09) + 0.003 * noise.normal();
        let _ = writeln!(rows, "{t},{u:.4}");
    }
    let found = diagnosed(
        "charging",
        &rows,
        "equations = \"U = U0*(1 - exp(-t/tau))\"\n[columns]\nt = \"stimulus\"\n[constant]\nU0 = \"5 V\"\n[parameter]\ntau = { start = \"10 s\" }\n",
    );
    assert_eq!(first_names(&found), ["factor"], "{found}");
    assert!(has_size(&found, -0.091), "{found}");
}

/// A reference that walks at random is no effect: of thirty recordings with nothing else one may be an alarm by chance, at a
/// probability of 1 % in each.
#[test]
fn a_walk_of_the_reference_is_noise() {
    let alarms = (0..30).filter(|seed| {
        let mut noise = Noise(6000 + seed);
        let mut rows = "t [s],x [N],U [V]\n".to_owned();
        let mut walk = 0.0;
        for row in 0..24 + 12 * (seed % 4) {
            let x = row % 6;
            walk += 0.01 * noise.normal();
            let _ = writeln!(rows, "{row},{x},{:.4}", 0.1 + 2.0 * x as f64 + walk);
        }
        let case = "equations = \"U = a + b*x\"\n[columns]\nt = \"time\"\n";
        diagnosed("walk", &rows, case)["verdict"] != "none"
    });
    let alarms = alarms.count();
    assert!(alarms <= 2, "{alarms}");
}

/// Six positions, three times, of a triad without any effect.
#[test]
fn nothing_found_is_no_mismatch() {
    for seed in 0..6 {
        let mut noise = Noise(6100 + seed);
        let mut rows = "nx,ny,nz,ax [m/s2],ay [m/s2],az [m/s2]\n".to_owned();
        for place in 0..18 {
            let (axis, sign) = (place % 6 / 2, 1 - 2 * (place % 2));
            let up = [0, 1, 2].map(|at| if at == axis { f64::from(sign) } else { 0.0 });
            let shown = up.map(|up| 9.8 * up + 0.02 + 0.002 * noise.normal());
            let [x, y, z] = shown;
            let _ = writeln!(rows, "{},{},{},{x:.5},{y:.5},{z:.5}", up[0], up[1], up[2]);
        }
        let case = "equations = [\"ax = a1 + b11*nx + b12*ny + b13*nz\", \"ay = a2 + b21*nx + b22*ny + b23*nz\", \"az = a3 + b31*nx + b32*ny + b33*nz\"]\n";
        let found = diagnosed("six", &rows, case);
        let p = found["levels"][0]["p"].as_f64().unwrap_or(1.0);
        let is_alarm = found["verdict"] != "none";
        assert_eq!(is_alarm, p < 0.01, "{p} {}", found["statement"]);
    }
}

/// A decay above a background of a thirteenth of it: along the slopes of the fit, which takes the background for a longer time, a
/// relaxation with two time constants does as well, and as it is fitted only the background.
#[test]
fn a_background_is_told_from_a_slower_decay() {
    let mut noise = Noise(62);
    let mut rows = "t [s],A [V]\n".to_owned();
    for row in 0..60 {
        let t = f64::from(row);
        let a = 5.0 * libm::exp(-t / 12.0) + 0.4 + 0.01 * noise.normal();
        let _ = writeln!(rows, "{t},{a:.4}");
    }
    let found = diagnosed(
        "decay",
        &rows,
        "equations = \"A = A0*exp(-t/tau)\"\n[columns]\nt = \"time\"\n[parameter]\nA0 = { start = \"4 V\" }\ntau = { start = \"10 s\" }\n",
    );
    assert_eq!(first_names(&found), ["zero"], "{found}");
    assert!(has_size(&found, 0.4), "{found}");
}

/// The first gauge reading is zero, where the root of an orifice has no slope.
#[test]
fn a_zero_error_is_found_where_the_model_has_no_slope() {
    let mut noise = Noise(63);
    let mut rows = "h [m],Q [L/s]\n".to_owned();
    for row in 0..30 {
        let h = f64::from(row) / 15.0;
        let q = 26.6 * libm::sqrt(h + 0.03) + 0.02 * noise.normal();
        let _ = writeln!(rows, "{h:.4},{q:.4}");
    }
    let found = diagnosed(
        "weir",
        &rows,
        "equations = \"Q = C*sqrt(2*g*h)\"\n[columns]\nh = \"stimulus\"\n[constant]\ng = \"9.81 m/s2\"\n[parameter]\nC = { start = \"0.005 m2\" }\n",
    );
    assert_eq!(first_names(&found), ["zero-of"], "{found}");
    assert!(has_size(&found, 0.03), "{found}");
}

/// A resonance on a baseline that is neither zero nor level.
#[test]
fn a_sloping_baseline_has_a_name() {
    let mut noise = Noise(64);
    let mut rows = "f [GHz],S [V]\n".to_owned();
    for row in 0..80 {
        let f = f64::from(row) / 8.0 - 5.0;
        let from_middle = (f - 0.3) / 0.8;
        let peak = 2.0 / (1.0 + from_middle * from_middle);
        let _ = writeln!(
            rows,
            "{f:.4},{:.4}",
            peak + 0.1 + 0.06 * f + 0.01 * noise.normal()
        );
    }
    let case = "equations = \"S = A/(1 + ((f - f0)/w)^2)\"\n[columns]\nf = \"stimulus\"\n[parameter]\nA = { start = \"1 V\" }\nf0 = { start = \"0 GHz\" }\nw = { start = \"1 GHz\" }\n";
    let found = diagnosed("peak", &rows, case);
    assert_eq!(first_names(&found), ["background"], "{found}");
    assert_eq!(variant(&found), "with a constant");
    let sizes = found["improved"]["coefficients"].as_array().unwrap();
    for (size, truth) in sizes.iter().zip([0.06, 0.1]) {
        let [value, u] = ["value", "u"].map(|key| size[key].as_f64().unwrap());
        assert!((value - truth).abs() < 4.0 * u, "{truth} {found}");
    }
}

/// The current of a photodiode in the dark doubles every nine kelvin: it is no parabola.
#[test]
fn a_dark_current_is_exponential_in_the_temperature() {
    let mut noise = Noise(41);
    let mut rows = "P [µW],T [°C],I [µA]\n".to_owned();
    for row in 0..66 {
        let (power, temperature) = (f64::from(row % 6), 10.0 + 5.0 * f64::from(row / 6));
        let dark = 0.002 * libm::exp2((temperature - 25.0) / 9.0);
        let current = 0.45 * power + dark + 0.001 * noise.normal();
        let _ = writeln!(rows, "{power},{temperature},{current:.5}");
    }
    let case = "equations = \"I = R*P + I_0\"\n[columns]\nP = \"stimulus\"\nT = \"covariate\"\nI = \"output\"\n";
    let found = diagnosed("dark", &rows, case);
    assert_eq!(first_names(&found), ["exponential"], "{found}");
    // `growing over 13 K`: 9 K/ln 2.
    let width = variant(&found).split(' ').nth(2).map(str::parse::<f64>);
    let Some(Ok(width)) = width else {
        panic!("{}", variant(&found));
    };
    assert!((width / 12.98 - 1.0).abs() < 0.15, "{width}");
}

/// Readings of a bath that were taken too soon: four times of waiting are enough to tell an exponential from a parabola.
#[test]
fn what_settles_dies_away_with_the_time_of_waiting() {
    let mut noise = Noise(47);
    let mut rows = "T [°C],wait [s],y [°C]\n".to_owned();
    for row in 0..48 {
        let (bath, wait) = (
            25.0 * f64::from(row / 8),
            [5.0, 10.0, 20.0, 40.0][row as usize % 4],
        );
        let reading = bath + 0.1 - 1.5 * libm::exp(-wait / 12.0) + 0.04 * noise.normal();
        let _ = writeln!(rows, "{bath},{wait},{reading:.3}");
    }
    let case = "equations = \"y = z + T\"\n[columns]\nT = \"stimulus\"\nwait = \"covariate\"\ny = \"output\"\n[noise]\nu = \"0.04 K\"\n";
    let found = diagnosed("settling", &rows, case);
    assert_eq!(first_names(&found), ["exponential"], "{found}");
    assert!(variant(&found).starts_with("dying away over 1"), "{found}");
}

/// A temperature coefficient that is 1 % larger in the second half: a departure that nobody would call another effect, and more than
/// noise.
#[test]
fn an_effect_that_differs_between_parts_only_acts_like_its_name() {
    let state = |later: f64| {
        let mut noise = Noise(53);
        let mut rows = "x [V],T [°C],y [V]\n".to_owned();
        for row in 0..60 {
            let (x, warmth) = (f64::from(row * 7 % 11), 3.0 * noise.normal());
            let size = if row < 30 { 0.1 } else { later };
            let reading = 0.2 + 2.0 * x + size * warmth + 1e-3 * noise.normal();
            let _ = writeln!(rows, "{x},{:.4},{reading:.5}", 23.0 + warmth);
        }
        let case = "equations = \"y = z + k*x\"\n[columns]\nx = \"stimulus\"\nT = \"covariate\"\ny = \"output\"\n[noise]\nu = \"1 mV\"\n";
        let found = diagnosed(&format!("parts-{later}"), &rows, case);
        assert_eq!(first_names(&found), ["tempco-bias"], "{found}");
        found["effects"][0]["state"].as_str().map(str::to_owned)
    };
    assert_eq!(state(0.1).as_deref(), Some("identified"));
    assert_eq!(state(0.101).as_deref(), Some("acts-like"));
}

/// The force on what moves while it turns: the product of a speed and a rate that takes both signs, which leaves nothing of the response
/// where it does not turn.
#[test]
fn a_product_may_take_all_of_the_response() {
    let mut noise = Noise(59);
    let mut rows = "w [rad/s],v [m/s],a [m/s^2]\n".to_owned();
    for row in 0..70 {
        let turning = 3.0 * libm::sin(1.3 * f64::from(row));
        let speed = libm::sin(2.1 * f64::from(row) + 0.4);
        let force = 0.02 + 0.5 * speed + 0.2 * turning * speed + 0.05 * noise.normal();
        let _ = writeln!(rows, "{turning:.4},{speed:.4},{force:.4}");
    }
    let case = "equations = \"a = b + c*v\"\n[columns]\nw = \"covariate\"\nv = \"stimulus\"\na = \"output\"\n[noise]\nu = \"0.05 m/s^2\"\n";
    let found = diagnosed("product", &rows, case);
    assert_eq!(first_names(&found), ["sensitivity-scale"], "{found}");
}

/// A counter that is blind for 3 µs after each count loses 13 % of the largest rate: no parabola, nor a piece of a cubic.
#[test]
fn counting_losses_of_a_dead_time_level_off() {
    let mut noise = Noise(85);
    let mut rows = "A [1/s],n [1/s]\n".to_owned();
    for row in 0..40 {
        let rate = [1e3, 2e3, 5e3, 1e4, 2e4, 3e4, 4e4, 5e4][row % 8];
        let counted = rate / (1.0 + 3e-6 * rate);
        let _ = writeln!(
            rows,
            "{rate},{:.2}",
            counted * (1.0 + 3e-4 * noise.normal())
        );
    }
    let case = "equations = \"n = k*A + n_0\"\n[columns]\nA = \"stimulus\"\nn = \"output\"\n";
    let found = diagnosed("dead-time", &rows, case);
    assert_eq!(first_names(&found), ["quadratic"], "{found}");
    assert!(variant(&found).starts_with("levelling off"), "{found}");
    assert!(has_size(&found, -3e-6), "{found}");
}

/// It doubles every six kelvin and is recorded over twenty, so that it grows tenfold: a cubic comes near, at the price of two sizes more.
#[test]
fn a_dark_current_is_exponential_over_a_narrow_range() {
    let mut noise = Noise(83);
    let mut rows = "P [µW],T [°C],I [µA]\n".to_owned();
    for row in 0..36 {
        let (power, temperature) = (f64::from(row % 6), 20.0 + 4.0 * f64::from(row / 6));
        let dark = 0.02 * libm::exp2((temperature - 20.0) / 6.0);
        let current = 0.55 * power + dark + 0.001 * noise.normal();
        let _ = writeln!(rows, "{power},{temperature},{current:.4}");
    }
    let case = "equations = \"I = R*P + I_0\"\n[columns]\nP = \"stimulus\"\nT = \"covariate\"\nI = \"output\"\n";
    let found = diagnosed("narrow", &rows, case);
    assert_eq!(first_names(&found), ["exponential"], "{found}");
    let width = &found["improved"]["shapes"][0]["estimate"];
    let [width, u] = ["value", "u"].map(|key| width[key].as_f64().unwrap_or(f64::NAN));
    assert!(
        (width - 6.0 / core::f64::consts::LN_2).abs() < 4.0 * u,
        "{found}"
    );
}

/// A probe that cools by one time constant in the model and by two in truth.
#[test]
fn a_second_relaxation_is_told_from_curvature() {
    let mut noise = Noise(43);
    let mut rows = "t,T\n".to_owned();
    for row in 0..121 {
        let t = 0.5 * f64::from(row);
        let slow = 68.0 * libm::exp(-t / 14.0);
        let fast = 12.0 * libm::exp(-t / 3.5);
        let _ = writeln!(
            rows,
            "{t},{:.3}",
            21.0 + slow + fast + 0.05 * noise.normal()
        );
    }
    let case = "equations = \"T = T_a + D*exp(-t/tau)\"\n[columns]\nt = \"stimulus\"\nT = \"output\"\n[parameter]\nT_a = { start = 20 }\nD = { start = 80 }\ntau = { start = 12 }\n";
    let found = diagnosed("relaxations", &rows, case);
    assert_eq!(first_names(&found), ["exponential"], "{found}");
}

/// Abbe's offset: where the model takes the scale as exact, it is so at the height of zero and not at the mean height.
#[test]
fn a_condition_with_a_zero_acts_in_proportion() {
    let mut noise = Noise(47);
    let mut rows = "x [mm],height [mm],y [mm]\n".to_owned();
    for row in 0..84 {
        let (x, height) = (25.0 * f64::from(row % 21), 20.0 * f64::from(row / 21));
        let y = x + 8e-8 * x * height + 3e-4 * noise.normal();
        let _ = writeln!(rows, "{x},{height},{y:.5}");
    }
    let case = "equations = \"y = x + z\"\n[columns]\nx = \"stimulus\"\nheight = \"covariate\"\ny = \"output\"\n";
    let found = diagnosed("abbe", &rows, case);
    assert_eq!(first_names(&found), ["sensitivity-scale"], "{found}");
    assert_eq!(variant(&found), "about zero");
}

#[test]
fn the_first_row_is_told_by_its_number() {
    let mut noise = Noise(83);
    let mut rows = "t [s],x [mm],U [V]\n".to_owned();
    for row in 0..30 {
        let x = f64::from(7 * row % 10);
        let wrong = if row == 0 { 0.1 } else { 0.0 };
        let read = 0.2 * x + wrong + 0.003 * noise.normal();
        let _ = writeln!(rows, "{row},{x},{read:.4}");
    }
    let case =
        "equations = \"U = z + k*x\"\n[columns]\nt = \"time\"\nx = \"stimulus\"\nU = \"output\"\n";
    let found = diagnosed("first", &rows, case);
    let statement = found["statement"].as_str().unwrap_or_default();
    assert!(statement.contains("(row 1)"), "{statement}");
}

/// A worn place of a scale, which positions anywhere along it pass; another pass stops at other places.
#[test]
fn a_worn_place_deviates_about_one_position() {
    let mut noise = Noise(91);
    let mut pass = |stops: u32, offset: f64| {
        let mut rows = "x [mm],y [mm]\n".to_owned();
        for row in 0..stops {
            let x = offset + 1000.0 * f64::from(row) / f64::from(stops);
            let z = (x - 340.0) / 20.0;
            let worn = 0.012 * libm::exp(-0.5 * z * z);
            let y = 0.05 + 1.0002 * x + worn + 0.001 * noise.normal();
            let _ = writeln!(rows, "{x:.3},{y:.4}");
        }
        rows
    };
    let folder = folder("worn");
    for (name, rows) in [("recording", pass(90, 3.0)), ("second", pass(70, 1.0))] {
        std::fs::write(folder.join(format!("{name}.csv")), rows).expect("written");
    }
    let case = "recording = \"recording.csv\"\nheld_out = { file = \"second.csv\" }\nequations = \"y = y_0 + k*x\"\n[columns]\nx = \"stimulus\"\ny = \"output\"\n[noise]\nu = \"0.001 mm\"\n";
    let found = diagnosed_in(&folder, case);
    assert_eq!(first_names(&found), ["excursion"], "{found}");
    let label = variant(&found);
    let place: f64 = label
        .split(' ')
        .nth(1)
        .and_then(|text| text.parse().ok())
        .unwrap_or(f64::NAN);
    let width = &found["improved"]["shapes"][0]["estimate"];
    let [width, u] = ["value", "u"].map(|key| width[key].as_f64().unwrap_or(f64::NAN));
    assert!((place - 340.0).abs() < 3.0, "{label}");
    assert!((width - 20.0).abs() < 3.0 * u && u < 3.0, "{width} {u}");
    // The other pass is predicted to its noise.
    let rms = found["held_out"]["after"]["rms"][0].as_f64();
    assert!(rms.is_some_and(|rms| rms < 0.0012), "{rms:?}");
}

/// Steps enough follow any course: a curve as a resonance has it, of which one step would be weak by itself, is no staircase.
#[test]
fn a_smooth_course_is_no_staircase() {
    let mut noise = Noise(11);
    let mut rows = "F [N],U [mV]\n".to_owned();
    for row in 0..66 {
        let force = 200.0 * (0.618_033_988_7 * f64::from(row)).fract();
        let z = (force - 100.0) / 10.0;
        let course = 0.025 * z / (1.0 + z * z);
        let reading = 0.3 + 0.025 * force + course + 0.002 * noise.normal();
        let _ = writeln!(rows, "{force:.2},{reading:.4}");
    }
    let case = "equations = \"U = U_0 + S*F\"\n[columns]\nF = \"stimulus\"\nU = \"output\"\n[noise]\nu = \"0.002 mV\"\n";
    let found = diagnosed("staircase", &rows, case);
    assert_ne!(found["verdict"], "identified", "{found}");
}
