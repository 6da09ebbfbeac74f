//! Every rule fires where something is against it, and not on a sheet that is right.

mod against;
mod sheet;

use super::{RULES, findings};
use crate::read::Mapping;
use crate::{audit, read, sheet as grid};

use against::against;
use sheet::{noted, right, row, with};

#[test]
fn a_right_sheet_is_against_no_rule() {
    assert_eq!(right().rules(), Vec::<u8>::new(), "{}", right().text());
}

#[test]
fn numbers_are_those_of_the_list() {
    let numbers: Vec<u8> = RULES.iter().map(|rule| rule.number).collect();
    assert_eq!(numbers, (1..=86).collect::<Vec<u8>>());
    let mut names: Vec<&str> = RULES.iter().map(|rule| rule.id).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), 86);
}

#[test]
fn what_notes_say_may_be_right() {
    for note in [
        "One outlier was removed by the test of Grubbs, record 17",
        "CMC of the laboratory: 0.050 g (k = 2)",
        "Comparison of 2025: E_n = -0.4",
        "Calibrated by EN ISO 376",
        "Readings: 100.003, 100.001, 100.004, 100.002, 100.005, 100.001, 100.003, 100.002, 100.004, 100.003",
        "Fit of the drift: χ²/ν = 1.2 with ν = 12",
        "Monte Carlo, 10^6 trials: 95 % interval [99.948, 100.057] g",
        "Standard: calibrated range 20 g to 2000 g, used at 100 g",
        "Method revised on 2020-02-01; budget prepared on 2021-05-01",
        "Check standard: s = 0.014 g, predicted 0.012 g",
    ] {
        assert_eq!(noted(note).rules(), Vec::<u8>::new(), "{note}");
    }
}

#[test]
fn what_rows_say_may_be_right() {
    let pooled = row(1, |line| {
        line.known = "pooled s from 4 series of 6 readings: 0.0104, 0.0135, 0.0112 and 0.0127; s_p = 0.0120 g; mean of 4 readings";
    });
    let bent = with(|sheet| {
        sheet.notes[0] = "Model: m = m_S + dm + dr + dd + 4*dd*dd";
    });
    for (rule, sheet) in [(23, pooled), (52, bent)] {
        let fired = sheet.rules();
        assert!(!fired.contains(&rule), "{rule}: {fired:?}");
    }
}

#[test]
fn every_rule_fires() {
    let mut silent = Vec::new();
    let sheets = against();
    for (number, sheet) in &sheets {
        let fired = sheet.rules();
        if !fired.contains(number) {
            silent.push(format!("{number}: {fired:?}\n{}", sheet.text()));
        }
    }
    assert!(silent.is_empty(), "{}", silent.join("\n"));
    let tested: Vec<u8> = sheets
        .iter()
        .map(|(number, _)| *number)
        .chain([82])
        .collect();
    for rule in RULES {
        assert!(tested.contains(&rule.number), "{}", rule.number);
    }
}

#[test]
fn hidden_rows_are_found() {
    let grids = grid::grids("sheet.txt", right().text().as_bytes()).unwrap();
    let mut claims = read::budgets(&grids, &Mapping::default());
    claims[0].rows[2].is_hidden = true;
    let found = audit(&claims[0]).found;
    let hidden = findings(&found);
    assert_eq!((hidden[0].rule, hidden[0].row), (82, Some(2)));
}

/// A sound sheet may owe an answer, which is no error; a slip is one, and is told by its figures.
#[test]
fn questions_are_no_errors_and_slips_have_figures() {
    let sheet = |u: &str, u_c: &str, expanded: &str| {
        format!(
            "Mass comparison\nModel: m = m_S + dT\nCoverage factor k = 2\n\
             Symbol,Source of uncertainty,Value ±,Probability distribution,Divisor,c_i,u_i(y) / g,ν_i\n\
             m_S,\"certificate M-12: U = 0.040 g, k = 2\",0.040,normal,2,1,{u},∞\n\
             dT,\"limits ±0.030 g, nothing else known\",0.030,rectangular,√3,1,0.0173,∞\n\
             u_c,Combined standard uncertainty,,,,,{u_c},\nU,Expanded uncertainty,,,,,{expanded},\n"
        )
    };
    let told = |text: String| -> Vec<(u8, String, String)> {
        let grids = crate::sheet::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = crate::read::budgets(&grids, &crate::read::Mapping::default());
        let all = super::findings(&crate::audit(&claims[0]).found);
        let told = all
            .iter()
            .map(|one| (one.rule, one.said().to_string(), one.numbers.clone()));
        told.collect()
    };
    let sound = told(sheet("0.0200", "0.0264", "0.053"));
    assert!(
        sound
            .iter()
            .any(|(rule, said, _)| (*rule, said.as_str()) == (34, "question")),
        "{sound:?}"
    );
    assert!(
        sound.iter().all(|(_, said, _)| said != "error"),
        "{sound:?}"
    );
    let slip = told(sheet("0.0400", "0.0436", "0.087"));
    assert!(
        slip.iter()
            .any(|(_, said, numbers)| said == "error" && numbers == "u = 0.04 ≠ 0.02"),
        "{slip:?}"
    );
}

/// What two rows have in common is asked; the probability may stand beside U.
#[test]
fn rows_that_repeat_one_cause_are_asked_about() {
    let fired = |sheet: &str| -> Vec<u8> {
        let grids = grid::grids("sheet.csv", sheet.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let all = findings(&audit(&claims[0]).found);
        all.iter().map(|finding| finding.rule).collect()
    };
    let sheet = |second: &str, third: &str, expanded: &str| {
        format!(
            "Source,Half-width (hPa),Divisor,Standard uncertainty (hPa)\nReference (k=2),0.10,2,0.050\n{second},0.05,1.732,0.029\n\
             {third},0.05,1.732,0.029\nCombined standard uncertainty,,,0.065\n\"{expanded}\",,,0.13\n"
        )
    };
    let twice = fired(&sheet(
        "resolution 0.1 hPa",
        "reading error from the resolution 0.1 hPa",
        "U (k=2)",
    ));
    assert!(twice.contains(&32) && twice.contains(&45), "{twice:?}");
    let apart = fired(&sheet(
        "resolution 0.1 hPa",
        "resolution of the standard 0.1 hPa",
        "U (k=2, 95 %)",
    ));
    assert!(!apart.contains(&32) && !apart.contains(&45), "{apart:?}");
    let common = fired(
        "Model: R = R1 + R2\nQuantity,Estimate,Std uncertainty,c\nR1 (compared with standard S),1000.000 Ω,0.5 mΩ,1\n\
         R2 (compared with the same standard S),1000.000 Ω,0.5 mΩ,1\nR,2000.000 Ω,0.71 mΩ,\nU (k=2),,1.4 mΩ,\n",
    );
    assert!(common.contains(&56), "{common:?}");
}

/// The label of k may state its probability.
#[test]
fn the_probability_may_stand_in_the_label_of_k() {
    let fired = |label: &str| -> Vec<u8> {
        let text = format!(
            "Source,u_i (mm),c_i,u_i(y) (mm)\nReference,0.25,1,0.25\nDrift,0.15,1,0.15\nu_c,,,0.292\n{label},,,2.00\nU,,,0.58\n"
        );
        let grids = grid::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let all = findings(&audit(&claims[0]).found);
        all.iter().map(|finding| finding.rule).collect()
    };
    assert!(fired("k").contains(&45));
    assert!(!fired("k (95.45 %)").contains(&45));
}

/// A column of coverage factors states k of a certificate, and so does a coverage probability; a column of divisors does not. A
/// reference that is stated with a larger k than U is not more uncertain for that.
#[test]
fn the_k_of_a_certificate_may_stand_in_its_column() {
    let fired = |words: &str, head: &str, k: &str, u: &str| -> Vec<u8> {
        let text = format!(
            "Source,Expanded uncertainty (mV),Distribution,{head},Standard uncertainty (mV)\nReference{words},0.0500,normal,{k},{u}\n\
             Thermal voltages,0.0020,rectangular,√3,0.00115\nu_c,,,,0.0194\n\"U (k = 2)\",,,,0.039\n"
        );
        let grids = grid::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let all = findings(&audit(&claims[0]).found);
        all.iter().map(|finding| finding.rule).collect()
    };
    for (words, head, asked) in [
        ("", "Divisor", true),
        ("", "k", false),
        ("", "Coverage factor", false),
        ("", "包含因子", false),
        (" certificate at 99 %", "Divisor", false),
    ] {
        let rules = fired(words, head, "2.58", "0.0194");
        assert_eq!(rules.contains(&16), asked, "{words} {head}: {rules:?}");
        assert!(!rules.contains(&77), "{rules:?}");
    }
    let undivided = fired("", "k", "2.00", "0.0194");
    assert!(undivided.contains(&77), "{undivided:?}");
}

/// A date is that of what stands in front of it: a standard is calibrated on another day than it is used.
#[test]
fn a_certificate_ends_on_the_day_that_its_words_name() {
    let hits = |line: &str| -> Vec<String> {
        let text = format!(
            "Length of rod\n\"{line}\"\nSource,± value,unit,Distribution,Divisor,c,u_i(y) [µm]\n\
             Alignment,0.5,µm,rectangular,√3,1,0.29\nRepeatability (std of mean),0.3,µm,normal,1,1,0.3\n\
             u_c,,,,,,0.42\nU (k=2),,,,,,0.83\n"
        );
        let grids = grid::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let all = findings(&audit(&claims[0]).found);
        let of_rule = all.into_iter().filter(|finding| finding.rule == 80);
        of_rule.map(|finding| finding.numbers).collect()
    };
    for line in [
        "Reference standard calibrated on 2025-06-01, valid until 2027-06-01",
        "Laser interferometer: calibrated on 2025-06-01, next calibration due 2027-06-01. Measured on 2026-03-04",
        // Whether the standard or the device was calibrated on that day, is not said.
        "Calibrated on 2026-03-04. The certificate of the laser: due date: 2025-01-15",
        "Measured on 2026-03-04; the drift is due to the age of the lamp of 2025-01-01",
    ] {
        assert!(hits(line).is_empty(), "{line}: {:?}", hits(line));
    }
    for line in [
        "Certificate valid until 2025-01-15; measured on 2026-03-04",
        "Date of measurement: 2026-03-04. Certificate valid until 2025-01-15",
        "Date of this budget: 2026-03-04; certificate valid until 2025-01-15",
        "Date: 2026-03-04, laser No. 12, due 2025-01-15",
        "Calibration date 2026-03-04; certificate of the standard expired 2025-01-15",
    ] {
        assert_eq!(hits(line), ["2025-01-15 < 2026-03-04"], "{line}");
    }
}

/// What is in a row is not asked for, in whatever language of the heads that are read.
#[test]
fn french_and_german_rows_are_seen() {
    let fired = |[drift, scatter, step]: [&str; 3]| -> Vec<u8> {
        let text = format!(
            "Grandeur;Source d'incertitude;Étendue ±;Loi de distribution;Diviseur;Incertitude-type u(xi);Coefficient de sensibilité;Contribution (µm)\n\
             L_e;Étalon, certificate U (k=2);0,050 µm;normale;2;0,025 µm;1;0,025\nd_L;{drift};0,060 µm;rectangulaire;1,732;0,0346 µm;1;0,0346\n\
             r;{scatter};0,012 µm;normale;1;0,012 µm;1;0,012\nq;{step};0,010 µm;rectangulaire;1,732;0,0058 µm;1;0,0058\n\n\
             Incertitude-type composée u_c;;;;;;;0,0448 µm\nIncertitude élargie U (k=2);;;;;;;0,090 µm\n"
        );
        let grids = grid::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let all = findings(&audit(&claims[0]).found);
        all.iter().map(|finding| finding.rule).collect()
    };
    let asked = |rules: &[u8]| [34, 35, 36].map(|rule| rules.contains(&rule));
    let french = [
        "Dérive de l'étalon",
        "Répétabilité de la moyenne",
        "Résolution",
    ];
    let german = ["Alterung des Normals", "Wiederholbarkeit", "Auflösung"];
    for words in [french, german] {
        assert_eq!(asked(&fired(words)), [false; 3], "{words:?}");
    }
    assert_eq!(
        asked(&fired(["Pression", "Opérateur", "Humidité"])),
        [true; 3]
    );
}

/// A correlation that is told in words alone is asked about; one that is denied is not.
#[test]
fn a_correlation_in_words_is_asked_about() {
    let fired = |line: &str| -> bool {
        let text = format!(
            "Three 1 kg weights as a 3 kg standard\n\"{line}\"\nComponent,Uncertainty (mg),Distribution,Divisor,u (mg)\n\
             Weight 1 certificate U k=2,0.50,normal,2,0.25\nWeight 2 certificate U k=2,0.50,normal,2,0.25\n\
             Repeatability,0.10,normal,1,0.10\nCombined,,,,0.37\nExpanded k=2,,,,0.73\n"
        );
        let grids = grid::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let all = findings(&audit(&claims[0]).found);
        all.iter().any(|finding| finding.rule == 56)
    };
    for line in [
        "All three weights were calibrated against the same reference; their errors are fully correlated (r = 1)",
        "The weights are correlated since they were calibrated with the same standard; correlation neglected",
    ] {
        assert!(fired(line), "{line}");
    }
    for line in [
        "All inputs are uncorrelated",
        "Correlation: none, the inputs are independent",
    ] {
        assert!(!fired(line), "{line}");
    }
}

/// Shares that total 100 % may be those of the amounts, and not of their squares.
#[test]
fn shares_are_those_of_the_squares() {
    let fired = |first: u8, last: u8| {
        let text = format!(
            "Source,± / N,Distribution,Divisor,u / N,Contribution (%)\nStandard (k=2),0.40,normal,2,0.200,{first}\n\
             Drift,0.30,rectangular,1.732,0.173,37\nRepeatability of mean,0.10,normal,1,0.100,{last}\nu_c,,,,0.283,100\nU (k=2),,,,0.57,\n"
        );
        let grids = grid::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let numbers = findings(&audit(&claims[0]).found);
        numbers.iter().any(|finding| finding.rule().number == 5)
    };
    assert!(!fired(50, 13));
    // 0.200 of 0.473 is 42 %.
    assert!(fired(42, 21));
}

/// A short Chinese name in front of a colon names its row: the resolution is in the list.
#[test]
fn a_resolution_in_a_list_is_no_missing_one() {
    let asks = |row: &str| {
        let text = format!(
            "电子天平校准不确定度评定\n1. A类评定：重复测量6次，s = 0.32 mg，uA = s/√6 = 0.131 mg\n2. B类评定：\n 标准砝码：U = 0.3 mg，k = 2，uB1 = 0.15 mg\n\
             \x20{row}：0.5 mg（半宽），均匀分布，uB2 = 0.5/√3 = 0.289 mg\n3. 合成标准不确定度：uc = 0.351 mg\n4. 扩展不确定度：U = k·uc = 0.70 mg，k = 2\n"
        );
        let grids = grid::grids("list.txt", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let findings = findings(&audit(&claims[0]).found);
        findings.iter().any(|finding| finding.rule().number == 34)
    };
    assert!(!asks("天平分辨力"));
    assert!(asks("空气浮力"));
}
