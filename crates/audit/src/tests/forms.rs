//! Forms of budgets that are no plain table: subtotals, columns for each type, sentences over several lines, and what is left
//! open.

use super::{answer, first, is_sound, understood};

use crate::rules::{self, Finding};
use crate::{Verdict, audit};

fn findings(name: &str, text: &str) -> Vec<Finding> {
    let claims = understood(name, text);
    rules::findings(&audit(&claims[0]).found)
}

/// √(0.150² + 0.0577² + 0.289² + 0.2²) = 0.386: what the blocks come to is no further source.
#[test]
fn subtotals_are_no_sources() {
    for (name, combined) in [
        ("Subtotal", "Combined standard uncertainty"),
        ("小计", "合成标准不确定度"),
    ] {
        is_sound(
            "sheet.csv",
            &format!(
                "Source of uncertainty,Value ±,Unit,Divisor,u(x) / µm\nGauge block certificate,0.30,µm,2,0.150\n\
                 Drift of gauge block,0.10,µm,1.732,0.058\n{name},,,,0.161\nResolution,0.50,µm,1.732,0.289\n\
                 Repeatability,0.20,µm,1,0.200\n{name},,,,0.351\n{combined},,,,0.386\nExpanded uncertainty k=2,,,,0.77\n"
            ),
        );
    }
    // √(0.2² + 0.1² + 0.15² + 0.289²) = 0.395
    is_sound(
        "sheet.csv",
        "Source of uncertainty,Value ±,Unit,Divisor,u(x) / µm\nRepeatability,0.20,µm,1,0.200\nReproducibility,0.10,µm,1,0.100\n\
         Total type A,,,,0.224\nGauge block certificate,0.30,µm,2,0.150\nResolution,0.50,µm,1.732,0.289\nTotal type B,,,,0.325\n\
         Combined standard uncertainty,,,,0.395\nExpanded uncertainty k=2,,,,0.79\n",
    );
}

#[test]
fn a_source_that_stands_twice_is_asked_about() {
    let sheet = |second: &str| {
        format!(
            "Source,Value ±,Unit,Divisor,u(x) / µm\nGauge block,0.30,µm,2,0.150\nTemperature,0.50,µm,1.732,0.289\n\
             Repeatability,0.20,µm,1,0.200\n{second},0.50,µm,1.732,0.289\nCombined standard uncertainty,,,,0.479\n"
        )
    };
    let again = |second: &str| {
        let found = findings("sheet.csv", &sheet(second)).into_iter();
        let again: Vec<Finding> = found.filter(|one| one.rule == 32).collect();
        again
    };
    let found = again("Temperature");
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].row, Some(3));
    // 2·√(0.15² + 0.5²/3 + 0.2²) = 0.7638
    let corrected = found[0].corrected.unwrap();
    assert!((corrected - 0.7638).abs() < 1e-4, "{corrected}");
    assert!(again("Geometry").is_empty());
}

/// Type A and type B in columns of their own: one figure in a row, or both.
#[test]
fn types_may_have_columns_of_their_own() {
    for (a, b) in [("Type A (µm)", "Type B (µm)"), ("A类 (µm)", "B类 (µm)")] {
        is_sound(
            "sheet.md",
            &format!(
                "| Source | {a} | {b} |\n|---|---|---|\n| Repeatability | 0.32 | |\n\
                 | Gauge block, certificate U = 0.30 µm, k = 2 | | 0.15 |\n| Setting | 0.10 | 0.20 |\n\
                 | Resolution 1 µm | | 0.29 |\n\nCombined standard uncertainty: 0.51 µm\nExpanded uncertainty, k = 2: 1.0 µm\n"
            ),
        );
    }
    let sheet = "Source,Type A / mV,Type B / mV,Divisor,u / mV\nReadings,0.12,,1,0.12\nCalibrator (U; k = 2),,0.50,2,0.25\n\
                 Display ±0.3 mV,,0.30,2,0.15\nCombined,,,,0.315\nExpanded (k = 2),,,,0.63\n";
    assert_eq!(first("sheet.csv", sheet), "half-width-by-2@Display ±0.3 mV");
    // 0.040 + 0.030 + 0.025 + 0.029 = 0.124
    let added = "| Contribution | Type A (N·m) | Type B (N·m) |\n|---|---|---|\n| Repeatability | 0.040 | |\n| Reproducibility | 0.030 | |\n\
                 | Standard | | 0.025 |\n| Resolution | | 0.029 |\n\nu_c = 0.124 N·m\nU = 0.25 N·m, k = 2\n";
    assert_eq!(first("sheet.md", added), "linear-sum");
    // What each type comes to is no source, whatever it is called.
    is_sound(
        "sheet.csv",
        "Source,Type A,Type B\nRepeatability,0.30,\nStandard,,0.40\nResolution,,0.12\nTotal,0.30,0.418\n\
         Combined standard uncertainty (mm),0.514,\nExpanded uncertainty k=2 (mm),1.0,\n",
    );
}

#[test]
fn sentences_go_on_in_the_next_line() {
    let table = "Source              u / mm\nStandard            0.030\nReadings            0.040\nScale               0.020\n\n";
    for statement in [
        "The combined standard uncertainty is u_c =\n0.054 mm. The expanded uncertainty is U = 0.11 mm\n(k = 2).",
        "The expanded uncertainty is\nU = 0.11 mm\n(k = 2).",
    ] {
        is_sound("sheet.txt", &format!("{table}{statement}\n"));
    }
    // √(0.005² + 0.02²/12 + 0.004²) = 0.0086
    let story = "The standard has an expanded\nuncertainty of U = 0.010 kPa (k = 2). The resolution of the gauge is\n\
                 0.02 kPa. The standard deviation of the mean of ten readings is\n0.004 kPa. The combined standard uncertainty is therefore\n\
                 u_c = 0.0086 kPa, and the expanded\nuncertainty is U = 0.017 kPa\n(k = 2).\n";
    is_sound("sheet.txt", story);
}

#[test]
fn a_multiple_of_u_is_no_mass() {
    let rows = "| Quantity | u / mg | c | u_i(y) / mg |\n|---|---|---|---|\n| m_S | 0.05 | 1 | 0.05 |\n| dm | 0.40 | 1 | 0.40 |\n\
                | buoyancy | 0.50 | 1 | 0.50 |\n\nm = 100.0017 g, ";
    is_sound("sheet.md", &format!("{rows}U = 2 u = 1.3 mg\n"));
    is_sound("sheet.md", &format!("{rows}U = 3 u = 1.9 mg\n"));
    // √(1.5² + 0.4²) = 1.55
    let quoted = "Mass of a sample\nm_S: certificate, U = \"3e-6 kg\", k = 2\ndm: s of the mean of 10 readings u = \"4e-7 kg\"\n\
                  u_c = 1.55e-6 kg\nU = 2 u = 3.1e-6 kg\n";
    is_sound("sheet.txt", quoted);
}

/// U in µV below rows in ppm is a part of the 10 V that are measured; in percent above rows in mV the other way round.
#[test]
fn relative_rows_may_have_an_absolute_result() {
    let sheet = |expanded: &str| {
        format!(
            "Calibration of a 10 V source\nSource,Value ±,Unit,Divisor,u(x) / ppm\nReference,5,ppm,2,2.5\nTransfer,4,ppm,1.732,2.31\n\
             Readings,1.2,ppm,1,1.2\nCombined standard uncertainty,,,,3.61\nExpanded uncertainty U (k = 2),{expanded},,,\n"
        )
    };
    is_sound("sheet.csv", &sheet("72 µV"));
    assert_eq!(first("sheet.csv", &sheet("36 µV")), "k-forgotten");
    let absolute = |expanded: &str| {
        format!(
            "Calibration at 50 mV\nSource,Value ±,Unit,Divisor,u(x) / mV\nReference,0.05,mV,2,0.025\nTransfer,0.04,mV,1.732,0.0231\n\
             Combined standard uncertainty,,,,0.0340\nExpanded uncertainty U (k = 2),{expanded},,,\n"
        )
    };
    is_sound("sheet.csv", &absolute("0.14 %"));
    assert_eq!(first("sheet.csv", &absolute("0.068 %")), "k-forgotten");
}

/// Grams and millilitres come to no density without the coefficients of both.
#[test]
fn rows_of_several_quantities_need_coefficients() {
    let table = |heads: &str, cells: [&str; 3], u_c: &str| {
        format!(
            "Source,± a,Unit,Divisor,u{heads}\nMass,0.02,g,2,0.01{}\nVolume,0.05,mL,1.732,0.0289{}\nTemperature,0.5,°C,1.732,0.289{}\n\n\
             u_c = {u_c} g/mL\nU = 0.0042 g/mL (k = 2)\n",
            cells[0], cells[1], cells[2]
        )
    };
    let bare = table("", [""; 3], "0.0021");
    assert_eq!(
        answer("sheet.csv", &bare),
        (Verdict::NotRecomputed, Vec::new())
    );
    let claims = understood("sheet.csv", &bare);
    let audited = audit(&claims[0]);
    assert_eq!(audited.missing, [0, 1, 2]);
    assert!(audited.recomputed().is_none() && audited.found.gaps.is_empty());
    // 0.1·0.01, 0.06·0.0289, 0.002·0.289: √(1² + 1.73² + 0.58²)·10⁻³ = 0.00208
    is_sound(
        "sheet.csv",
        &table(",c", [",0.1", ",0.06", ",0.002"], "0.0021"),
    );
    // √(0.01² + 0.0289² + 0.289²) = 0.290: summed as they stand.
    let summed = table("", [""; 3], "0.290").replace("0.0042", "0.58");
    let rows = findings("sheet.csv", &summed)
        .into_iter()
        .filter(|one| one.rule == 86);
    assert_eq!(
        rows.map(|one| one.row).collect::<Vec<_>>(),
        [Some(0), Some(1), Some(2)]
    );
}

/// s of five readings stands above the table, and their mean is the result: u of the row is s/√5.
#[test]
fn readings_above_the_table_are_held_against_its_row() {
    let sheet = |said: &str, u: &str, u_c: &str| {
        format!(
            "Calibration of a caliper at 100 mm\n{said}\n\nSource              Type   Distribution   u (mm)\n\
             Repeatability       A      normal         {u}\nGauge block         B      normal         0.0010\n\
             Resolution 0.01 mm  B      rectangular    0.0029\n\nCombined standard uncertainty: u_c = {u_c} mm\n"
        )
    };
    for said in [
        "Readings (mm): 100.02, 100.05, 100.01, 100.04, 100.03\nMean 100.030 mm",
        "Mean value 100.030 mm, standard deviation s = 0.0158 mm, n = 5",
        "Mean                 100.030 mm\nStandard deviation   0.0158 mm\nn                    5",
        "平均值 100.030 mm，标准偏差 s = 0.0158 mm，n = 5",
    ] {
        is_sound("sheet.txt", &sheet(said, "0.0071", "0.0077"));
        assert_eq!(
            first("sheet.txt", &sheet(said, "0.0158", "0.0161")),
            "s-not-mean@Repeatability",
            "{said}"
        );
        assert_eq!(
            first("sheet.txt", &sheet(said, "0.0032", "0.0044")),
            "s-over-n@Repeatability",
            "{said}"
        );
    }
    // Nothing is said of a mean: a single reading may be what is reported.
    is_sound(
        "sheet.txt",
        &sheet(
            "Standard deviation s = 0.0158 mm, n = 5",
            "0.0158",
            "0.0161",
        ),
    );
}

/// The statement below the rows is no title, and a row may end in its u alone.
#[test]
fn stories_end_in_their_statement() {
    let story = |expanded: &str| {
        format!(
            "The reference flask has U = 0.08 mL (k = 2).\nThe temperature is within ±0.05 mL.\n\
             The standard deviation of the mean of six fillings is 0.02 mL.\n\
             The combined standard uncertainty is u_c = 0.053 mL, and the expanded uncertainty U = {expanded} mL (k = 2).\n"
        )
    };
    is_sound("sheet.txt", &story("0.11"));
    assert_eq!(first("sheet.txt", &story("0.16")), "k-other");
    is_sound(
        "sheet.txt",
        "频率计校准结果的不确定度评定\n1. 标准器引入的不确定度：证书给出 U = 0.02 Hz，k = 2，则 u1 = 0.02/2 = 0.010 Hz\n\
         2. 分辨力引入的不确定度：分辨力 0.01 Hz，均匀分布，u2 = 0.005/√3 = 0.0029 Hz\n\
         3. 重复性引入的不确定度：10 次测量的平均值标准差 u3 = 0.004 Hz\n合成标准不确定度 uc = √(u1²+u2²+u3²) = 0.0112 Hz\n\
         扩展不确定度 U = k·uc = 2×0.0112 = 0.022 Hz (k=2)\n",
    );
}

/// Sums of several quantities explain nothing, whatever figures they meet: 0.0004² + 0.0021² + 0.02² = 4.05·10⁻⁴.
#[test]
fn sums_of_several_quantities_explain_nothing() {
    let sheet = "Uncertainty budget for the density of a liquid\nQuantity,Value,Unit,Standard uncertainty\nMass of liquid,24.9512,g,0.0004\n\
                 Volume of pyknometer,25.0123,mL,0.0021\nTemperature,20.02,°C,0.02\nDensity,0.99756,g/mL,0.000088\n\
                 Expanded uncertainty (k=2),,g/mL,0.00018\n";
    assert_eq!(
        answer("sheet.csv", sheet),
        (Verdict::NotRecomputed, Vec::new())
    );
    // Leaving out the force leaves the temperature in the sum.
    let partial = "Source,u,Unit,c\nLength,0.002,mm,1\nTemperature,0.1,°C,\nForce,0.5,N,\nCombined standard uncertainty (mm),0.0045,,\n\
                   Expanded uncertainty (k=2) (mm),0.009,,\n";
    assert_eq!(
        answer("sheet.csv", partial),
        (Verdict::NotRecomputed, Vec::new())
    );
}

/// Figures below `Details` that no divisor gives u of are remarks; the ± column is called an estimate of uncertainty.
#[test]
fn details_with_figures_are_no_limits() {
    is_sound(
        "sheet.csv",
        "Contribution,Details,Estimate of uncertainty,Units,Distribution,Divisor,Std unc\nReference resistor,Cert no. 2024-118,0.8,mΩ,Normal,2,0.40\n\
         Bridge ratio,0.2 ppm spec,0.35,mΩ,Rectangular,1.732,0.202\nOil bath,0.01,0.12,mΩ,Rectangular,1.732,0.069\n\
         Scatter,12 readings,0.15,mΩ,Normal,1,0.15\nCombined standard uncertainty,,,,,,0.478\nExpanded uncertainty k=2,,,,,,0.96\n",
    );
}

/// Heads and labels in short, and words of a column whose head says nothing.
#[test]
fn short_heads_and_labels_are_known() {
    let chinese = |u: &str, whole: [&str; 2]| {
        format!(
            "来源,信息,除数,u/mm\n分辨力,分度值 0.02 mm,1.732,{u}\n量块,\"证书 U=0.001 mm, k=2\",2,0.0005\n重复性,\"s=0.008 mm\",1,0.008\n\
             合成标准不确定度,,,{}\n扩展不确定度 k=2,,,{}\n",
            whole[0], whole[1]
        )
    };
    is_sound("sheet.csv", &chinese("0.0058", ["0.0099", "0.020"]));
    assert_eq!(
        first("sheet.csv", &chinese("0.0115", ["0.0140", "0.028"])),
        "full-width@分辨力"
    );
    let german = "Einflussgröße;Angabe;Teiler;u / mm\nReferenz;Kalibrierschein U = 0,010 mm, k = 2;1;0,010\nAuflösung;±0,005 mm;1,732;0,0029\n\
                  Wiederholbarkeit;s = 0,004 mm;1;0,004\nKombinierte Standardunsicherheit;;;0,0112\nErweiterte Unsicherheit (k=2);;;0,022\n";
    assert_eq!(first("sheet.csv", german), "cert-undivided@Referenz");
    let list = "Beitrag,Standardunsicherheit (mm)\nMassstab,0.006\nTemperatur,0.004\nAblesung,0.005\nkombiniert,0.0088\nerweitert U,0.0088\nk,2\n";
    assert_eq!(first("sheet.csv", list), "k-forgotten");
}

/// JCGM 100, H.1: k of 99 % for 16 degrees of freedom, said in a bracket.
#[test]
fn the_level_may_stand_behind_k() {
    let sheet = |statement: &str| {
        format!(
            "End gauge\n\nSource                          u          c          |c|u (nm)   ν\nCalibration of the standard     25 nm      1          25          18\n\
             Measured difference             9.7 nm     1          9.7         25.6\nDifference of temperatures      0.029 K    575 nm/K   16.7        2\n\
             u_c                                                   31.6\n{statement}\n"
        )
    };
    is_sound(
        "sheet.txt",
        &sheet("ν_eff = 16, U99 = 92 nm, k = 2.92 (99 %)"),
    );
    assert_eq!(
        first(
            "sheet.txt",
            &sheet("ν_eff = 16, U95 = 92 nm, k = 2.92 (95 %)")
        ),
        "k-level"
    );
}

/// Items of a list that end in u are rows, with or without a symbol; commas of a title part no fields.
#[test]
fn titles_and_items_are_told_apart() {
    is_sound(
        "sheet.md",
        "Uncertainty of an RTD at 0 °C\n\n* Ice point realisation: ±0.005 °C, rectangular → 0.0029 °C\n* Bridge: U = 0.004 °C (k = 2) → 0.0020 °C\n\
         * Self-heating: limits ±0.003 °C → 0.0017 °C\n* Repeatability: s of mean 0.0015 °C → 0.0015 °C\n\n\
         Combined: 0.0042 °C. Expanded (k = 2): 0.0084 °C\n",
    );
    is_sound(
        "sheet.csv",
        "Flow meter, 100 L/min, air\nSource,Specification,u (L/min)\nMeter accuracy,\"±5 L/min, rectangular\",2.887\n\
         Reference,\"U = 0.5 L/min, k = 2\",0.250\nRepeatability,\"s = 0.40 L/min, mean of 1\",0.40\nCombined standard uncertainty,,2.925\n",
    );
}

/// 1 % of the full scale of 500 L/min, and 0.5 % of the reading of 100 L/min: each row has its own whole.
#[test]
fn percentages_are_of_the_range_or_of_the_reading() {
    let sheet = |meter: &str, u_c: &str| {
        format!(
            "Flow meter, full scale 500 L/min, reading 100 L/min\nSource,Specification,u (L/min)\n\
             Meter accuracy,\"±1 % of full scale, rectangular\",{meter}\nReference,\"U = 0.5 % of reading, k = 2\",0.250\n\
             Repeatability,s = 0.40 L/min,0.40\nCombined standard uncertainty,,{u_c}\n"
        )
    };
    is_sound("sheet.csv", &sheet("2.887", "2.925"));
    let wrong = first("sheet.csv", &sheet("0.577", "0.745"));
    assert!(wrong.ends_with("@Meter accuracy"), "{wrong}");
}

/// A line may name its source in words, with what is known right behind them.
#[test]
fn lines_may_name_their_source_in_words() {
    let list = |[first, second, third]: [&str; 3], u: &str, u_c: &str, expanded: &str| {
        format!(
            "Budget, torque wrench 50 N·m\n{first}: U = 0.10 N·m, k = 2 -> u = 0.05 N·m\n{second} 0.2 N·m step -> u = 0.0577 N·m\n\
             {third} -> u = {u} N·m\nu_c = {u_c} N·m\nU = {expanded} N·m (k = 2)\n"
        )
    };
    for lines in [
        [
            "reference certificate",
            "resolution:",
            "repeatability, s = 0.12 N·m of 5 readings, mean reported",
        ],
        [
            "reference certificate",
            "resolution",
            "repeatability s = 0.12 N·m, n = 5, mean reported",
        ],
    ] {
        is_sound("list.txt", &list(lines, "0.0537", "0.093", "0.19"));
        let single = first("list.txt", &list(lines, "0.12", "0.142", "0.28"));
        assert!(single.starts_with("s-not-mean@repeatability"), "{single}");
        let claimed = &super::understood("list.txt", &list(lines, "0.0537", "0.093", "0.19"))[0];
        assert!(claimed.model.is_none() && claimed.rows.len() == 3);
    }
}

/// a is the half-width of an interval (JCGM 100, 4.3.7), and no step.
#[test]
fn a_resolution_may_be_stated_by_its_half_width() {
    let list = |resolution: &str, u: &str, u_c: &str, expanded: &str| {
        format!(
            "标准器证书，U = 0.10 N·m，k = 2，u1 = 0.05 N·m\n分辨力，{resolution} N·m，u2 = {u} N·m\n\
             重复性，s = 0.12 N·m，n = 5，u3 = 0.0537 N·m\nuc = {u_c} N·m\nU = {expanded} N·m（k = 2）\n"
        )
    };
    is_sound("list.txt", &list("a = 0.1", "0.0577", "0.093", "0.19"));
    is_sound("list.txt", &list("d = 0.2", "0.0577", "0.093", "0.19"));
    let undivided = list("a = 0.100", "0.100", "0.124", "0.25");
    let slip = first("list.txt", &undivided);
    assert!(slip.starts_with("root3-missing@"), "{slip}");
}
