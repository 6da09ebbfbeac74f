//! The statement of a sheet: closing lines that stand as the last row of a table, and the result itself.

use super::{answer, first, is_sound, understood};
use crate::claim::{Claimed, Footer};
use crate::printed::Printed;
use crate::read::{self, Mapping};
use crate::{Verdict, sheet};

fn footer(text: &str) -> (usize, Footer) {
    let claimed = claimed(text);
    (claimed.rows.len(), claimed.footer)
}

fn claimed(text: &str) -> Claimed {
    let grids = sheet::grids("sheet.csv", text.as_bytes()).unwrap();
    let mut claims = read::budgets(&grids, &Mapping::default());
    assert_eq!(claims.len(), 1, "{text}");
    claims.remove(0)
}

fn value(figure: &Option<Printed>) -> Option<f64> {
    figure.as_ref().map(|figure| figure.value)
}

const HEADS: [&str; 4] = [
    "Quantity,Estimate,Standard uncertainty,Distribution,Sensitivity coefficient,Uncertainty contribution",
    "Größe,Schätzwert,Standardmessunsicherheit,Verteilung,Sensitivitätskoeffizient,Unsicherheitsbeitrag",
    "Grandeur,Estimation,Incertitude-type,Loi,Coefficient de sensibilité,Contribution",
    "输入量,估计值,标准不确定度,概率分布,灵敏系数,不确定度分量",
];

/// The row of the measurand closes the table, wherever its u_c or U stands.
#[test]
fn the_last_row_is_the_result() {
    let (u_c, expanded) = (Some(29.3), Some(59.0));
    for head in HEADS {
        for (last, y, of_u_c, of_u) in [
            ("m_X,10000.025 g,,,,29.3 mg", Some(10000.025), u_c, None),
            ("m_X,10000.025 g,29.3 mg,,,", Some(10000.025), u_c, None),
            ("m_X,29.3 mg,,,,", None, u_c, None),
            ("m_X,10000.025 g,,,,59 mg", Some(10000.025), None, expanded),
            (
                "m_X,10000.025 g,,,,59 mg (k = 2)",
                Some(10000.025),
                None,
                expanded,
            ),
            (
                "m_X,10000.025 g,,,,U = 59 mg (k = 2)",
                Some(10000.025),
                None,
                expanded,
            ),
        ] {
            let text = format!(
                "Weight of 10 kg\n{head}\nm_S,10000.005 g,22.5 mg,normal,1,22.5 mg\ndm_D,0 g,8.95 mg,rectangular,1,8.95 mg\n\
                 dm,0.020 g,14.4 mg,normal,1,14.4 mg\ndm_C,0 g,5.77 mg,rectangular,1,5.77 mg\ndB,0 g,5.77 mg,rectangular,1,5.77 mg\n{last}\n"
            );
            let (rows, footer) = footer(&text);
            assert_eq!(rows, 5, "{text}");
            let read = [&footer.y, &footer.u_c, &footer.expanded].map(value);
            let near = |a: Option<f64>, b: Option<f64>| match (a, b) {
                (Some(a), Some(b)) => (a / b - 1.0).abs() < 1e-9,
                (a, b) => a == b,
            };
            assert!(
                near(read[0], y) && near(read[1], of_u_c) && near(read[2], of_u),
                "{text} {read:?}"
            );
            assert_eq!(
                answer("sheet.csv", &text),
                (Verdict::Sound, Vec::new()),
                "{text}"
            );
        }
    }
}

/// A last row with a distribution, a divisor or a coefficient is an input, whatever its figure.
#[test]
fn the_last_row_may_be_an_input() {
    let (rows, _) = footer(
        "Source,Half-width,Distribution,Divisor,u\nA,0.30,rectangular,√3,0.173\nB,0.40,rectangular,√3,0.231\n\
         C,0.50,rectangular,√3,0.289\nu_c,,,,0.408\n",
    );
    assert_eq!(rows, 3);
    let (rows, _) = footer(
        "Source,Half-width,Distribution,Divisor,u\nA,0.30,rectangular,√3,0.173\nB,0.40,rectangular,√3,0.231\n\
         Repeatability,,,,0.050\nu_c,,,,0.293\n",
    );
    assert_eq!(rows, 3);
    // At the same nominal as the standard.
    let (rows, _) = footer(
        "Quantity,Estimate,u,Distribution,c,u_i(y)\nV_S,10.0000 V,0.0012 V,normal,-1,0.0012 V\ndV_D,0 V,0.0006 V,rectangular,1,0.0006 V\n\
         V_X,10.0000 V,0.0003 V,,,\nu_c,,,,,0.0014 V\n",
    );
    assert_eq!(rows, 3);
}

fn gauge_block(model: &str, y: &str) -> String {
    format!(
        "Gauge block\n{model}quantity,estimate,standard uncertainty,probability distribution,sensitivity coefficient,uncertainty contribution\n\
         l_S,50.000020 mm,15 nm,normal,1,15.0 nm\ndl_D,0 mm,17.3 nm,rectangular,1,17.3 nm\ndl,-0.000094 mm,5.37 nm,normal,1,5.37 nm\n\
         l_X,{y},,,,23.5 nm\nU = 47 nm (k = 2)\n"
    )
}

/// A correction that is not in the result, or with the wrong sign; a nominal that the model has.
#[test]
fn a_result_without_a_correction_is_found() {
    let model = "Model: l_X = l_S + dl_D + dl\n";
    for text in [
        gauge_block(model, "49.999926 mm"),
        gauge_block("", "49.999926 mm"),
    ] {
        assert_eq!(answer("sheet.csv", &text), (Verdict::Sound, Vec::new()));
    }
    for (model, y, slip) in [
        (model, "50.000020 mm", "correction-left-out@dl"),
        ("", "50.000020 mm", "correction-left-out@dl"),
        (model, "50.000114 mm", "correction-sign@dl"),
        (model, "-0.000094 mm", "correction-left-out@l_S"),
    ] {
        assert_eq!(first("sheet.csv", &gauge_block(model, y)), slip, "{y}");
    }
    // The signs are printed: what no single correction explains is asked for all the same.
    let difference = "Quantity,Estimate,Standard uncertainty,Distribution,Sensitivity coefficient,Contribution\nt_S,100.05 °C,0.015 °C,normal,-1,0.015 °C\n\
                      t_X,100.20 °C,0.010 °C,normal,1,0.010 °C\ndt_H,0 °C,0.023 °C,rectangular,1,0.023 °C\nE_X,YYY °C,,,,0.029 °C\n";
    let departs = |y: &str| {
        let text = difference.replace("YYY", y);
        let claims = understood("sheet.csv", &text);
        crate::audit(&claims[0]).found.other_result().is_some()
    };
    assert!(!departs("0.15") && departs("0.20"));
    // Without a model, a result may be the deviation from the nominal.
    assert_eq!(
        answer("sheet.csv", &gauge_block("", "-0.000094 mm")).0,
        Verdict::Sound
    );
}

/// `°C` behind the U of a hardness.
#[test]
fn a_unit_of_another_quantity_is_named() {
    let sheet = |unit: &str| {
        format!(
            "Hardness block\nSource,Value,Unit,Distribution,Divisor,c,u (HRC)\nStandard block U (k=2),0.40,HRC,normal,2,1,0.20\n\
             Indenter,0.30,HRC,rectangular,1.732,1,0.173\nRepeatability s (n=5 mean),0.15,HRC,normal,2.236,1,0.067\n\
             Combined standard uncertainty,,,,,,0.273\nExpanded uncertainty (k=2),,{unit},,,,0.55\n"
        )
    };
    assert_eq!(
        answer("sheet.csv", &sheet("HRC")),
        (Verdict::Sound, Vec::new())
    );
    assert_eq!(first("sheet.csv", &sheet("°C")), "U-unit");
}

/// A row that is too small for the printed digits: whether it is in the sum cannot be told, and that is said.
#[test]
fn what_digits_do_not_tell_is_listed() {
    let text = "Source,Half-width,Distribution,Divisor,u\nA,0.30,rectangular,√3,0.17\nB,0.40,rectangular,√3,0.23\n\
                C,0.02,rectangular,√3,0.01\nu_c,,,,0.29\nU (k = 2),,,,0.58\n";
    let claims = understood("sheet.csv", text);
    let audited = crate::audit(&claims[0]);
    assert_eq!(audited.verdict, Verdict::Sound);
    let found = &audited.found;
    let ids: Vec<String> = found.untold.iter().map(|act| act.id(&found.case)).collect();
    assert!(ids.contains(&"row-dropped@C".to_string()), "{ids:?}");
    assert!(
        !ids.iter()
            .any(|id| id.ends_with("@A") || id.ends_with("@B")),
        "{ids:?}"
    );
}

/// A result that neither a model nor estimates give is taken as it stands, and that is known.
#[test]
fn a_result_that_nothing_gives_is_taken() {
    let taken = |estimates: &str, y: &str| {
        let text = format!(
            "Symbol,Source,Estimate,c,u_i(y) / mm\nl_S,\"certificate, U = 0.0006 mm, k = 2\",{estimates},1,0.0003\n\
             d,\"standard uncertainty 0.0004 mm\",0.0021 mm,1,0.0004\nu_c,,,,0.0005\nU (k = 2),,,,0.0010\nResult,{y}\n"
        );
        let claims = understood("sheet.csv", &text);
        assert!(claims[0].footer.y.is_some(), "{text}");
        crate::audit(&claims[0]).found.takes_result()
    };
    assert!(taken("", "50.0123 mm"));
    assert!(!taken("50.0012 mm", "50.0033 mm"));
}

/// What a sheet says to be of Monte Carlo, its rows do not give: k and U are set aside, and the rest is held against them.
#[test]
fn a_statement_of_monte_carlo_is_set_aside() {
    let sheet =
        |u_c: &str, statement: &str| format!("{}\n{UMASS}u_c,,,,,{u_c}\n{statement}\n", HEADS[0]);
    for (statement, is_aside) in [
        ("U = 29 mg\nReported is the Monte Carlo result", true),
        ("报告采用蒙特卡洛法的结果\n扩展不确定度 U = 29 mg", true),
        (
            "Expanded uncertainty from Monte Carlo (10^6 trials): U = 29 mg",
            true,
        ),
        (
            "U = 29 mg\nThe expanded uncertainty was validated by Monte Carlo",
            false,
        ),
        ("U = 29 mg\n已采用蒙特卡洛法验证", false),
    ] {
        let text = sheet("16.4 mg", statement);
        let claimed = claimed(&text);
        assert_eq!(claimed.footer.expanded.is_none(), is_aside, "{text}");
        assert_eq!(claimed.is_simulated(), is_aside, "{text}");
        let (verdict, _) = answer("sheet.csv", &text);
        assert_eq!(verdict == Verdict::Sound, is_aside, "{text}");
        let wrong = answer("sheet.csv", &sheet("19.4 mg", statement)).0;
        assert_ne!(wrong, Verdict::Sound, "{text}");
    }
}

const UMASS: &str = "m_S,10000.005 g,12.0 mg,normal,1,12.0 mg\nδm,0 g,11.2 mg,normal,1,11.2 mg\n";

/// A relative figure of the whole is of the result where the sheet computes in the unit of that, and the absolute one goes
/// before it.
#[test]
fn relative_figures_of_the_whole_are_of_the_result() {
    let sheet = |lines: &str| {
        format!(
            "Concentration c = m·P/V\nQuantity,Value x,Unit,u(x)\nm,100.28,mg,0.05\nP,0.9999,,0.000058\nV,0.1,L,0.00007\n\
             c,1002.7,mg/L,\n{lines}\n\"U(c), k=2\",1.7,mg/L\n"
        )
    };
    for (lines, u_c) in [
        ("u(c)/c,0.00086\nu(c),0.86,mg/L", 0.86),
        (
            "Combined relative standard uncertainty,0.086 %\nCombined standard uncertainty,0.86,mg/L",
            0.86,
        ),
        ("相对合成标准不确定度,0.086 %", 0.00086 * 1002.7),
        ("u(c)/c,0.00086", 0.00086 * 1002.7),
    ] {
        let text = sheet(lines);
        let read = value(&footer(&text).1.u_c).unwrap_or_default();
        assert!((read - u_c).abs() < 1e-9, "{text}: {read}");
        assert_eq!(
            answer("sheet.csv", &text),
            (Verdict::Sound, Vec::new()),
            "{text}"
        );
    }
    let wrong = sheet("u(c)/c,0.00086\nu(c),0.86,mg/L").replace("1.7,mg", "0.86,mg");
    assert_eq!(first("sheet.csv", &wrong), "k-forgotten");
    // A sheet in percent is held in percent.
    let percent = "Source,Relative standard uncertainty (%)\na,0.3\nb,0.4\nF,100 kN\nCombined relative standard uncertainty,0.50 %\n\
                   \"Expanded uncertainty, k = 2\",1.0 %\n";
    assert_eq!(value(&footer(percent).1.u_c), Some(0.5));
}

/// Lines that end in what they come to, one with its coefficient in it: √(0.025² + 0.0173² + 0.0332² + 0.0089²) = 0.0459 µm, and
/// 0.0451 µm with 0.030/2 in the second.
#[test]
fn a_conclusion_may_hold_its_coefficient() {
    let told = |second: &str| {
        format!(
            "Uncertainty of the length of a gauge block\n\nThe certificate of the reference block states U = 0.050 µm with k = 2, so u1 = 0.025 µm.\n\
             The comparator has an error limit of ±0.030 µm (rectangular): u2 = {second} µm.\n\
             Temperature difference ±0.05 °C, c = 1.15 µm/°C: u3 = 0.05/√3 × 1.15 = 0.0332 µm.\n\
             Repeatability: s = 0.020 µm, 5 readings, u4 = 0.020/√5 = 0.0089 µm.\n"
        )
    };
    let whole = |u_c: &str, expanded: &str| {
        format!(
            "Combined standard uncertainty u_c = {u_c} µm.\nExpanded uncertainty U = 2 × {u_c} µm = {expanded} µm (k = 2).\n"
        )
    };
    is_sound(
        "told.txt",
        &(told("0.030/√3 = 0.0173") + &whole("0.0459", "0.092")),
    );
    let slip = first(
        "told.txt",
        &(told("0.030/2 = 0.0150") + &whole("0.0451", "0.090")),
    );
    assert!(slip.starts_with("half-width-by-2@"), "{slip}");
}
