//! What figures of the whole are called, and sources that are called like them.

use super::{answer, first, is_sound, understood};
use crate::Verdict;
use crate::read::Mapping;

/// Four sources whose u_c is 0.6116 mV.
fn summed(whole: &str) -> String {
    format!(
        "Source,Distribution,Divisor,u (mV)\nRef,normal,2,0.30\nRep,normal,1,0.40\n\
         Res,rectangular,√3,0.29\nTemp,rectangular,√3,0.20\n{whole}\n"
    )
}

/// A wrong U is read whatever it is called, and is no source.
#[test]
fn a_wrong_u_is_no_source() {
    for label in [
        "\"U, k = 2\"",
        "\"U, k = 2, 95 %\"",
        "U: k=2",
        "U k=2",
        "Uncertainty (k=2)",
        "Messunsicherheit (k=2)",
        "Incertidumbre expandida (k=2)",
        "Rozšířená nejistota",
        "Overall uncertainty U",
        "2·u_c",
        "±U",
    ] {
        let sheet = summed(&format!("u_c,,,0.61\n{label},,,5.0"));
        assert_eq!(
            answer("sheet.csv", &sheet).0,
            Verdict::Unexplained,
            "{label}"
        );
        let claims = crate::claims("sheet.csv", sheet.as_bytes(), &Mapping::default()).unwrap();
        let footer = &claims[0].footer;
        assert_eq!(
            footer.expanded.as_ref().map(|u| u.value),
            Some(5.0),
            "{label}"
        );
        assert_eq!(claims[0].rows.len(), 4, "{label}");
        is_sound("sheet.csv", &summed(&format!("u_c,,,0.61\n{label},,,1.2")));
    }
}

/// A wrong sum is u_c, whatever it is called.
#[test]
fn a_wrong_sum_is_no_source() {
    for label in [
        "Total",
        "Gesamt",
        "Root sum square",
        "合成",
        "Gesamtstandardunsicherheit",
        "beigeordnete Standardmessunsicherheit",
        "Incertitude type",
        "Comb. unc.",
    ] {
        let sheet = summed(&format!("{label},,,1.19\nU (k = 2),,,2.4"));
        assert_eq!(first("sheet.csv", &sheet), "linear-sum", "{label}");
    }
}

/// The result may be stated alone, in a sentence, and U in another unit.
#[test]
fn the_result_tells_its_statement() {
    for statement in [
        "(10 000.025 ± 0.095) g",
        "The measured mass of the nominal 10 kg weight is 10.000 025 kg ± 95 mg.",
        "U = k × u(m_X) = 2 × 29.3 mg ≅ 95 mg",
    ] {
        let sheet = format!(
            "quantity X_i,estimate x_i,standard uncertainty u(x_i),probability distribution,\
             sensitivity coefficient c_i,uncertainty contribution u_i(y)\n\
             m_S,10 000.005 g,22.5 mg,normal,1.0,22.5 mg\nδm,0.020 g,18.8 mg,normal,1.0,18.8 mg\n\
             m_X,10 000.025 g,,,,29.3 mg\n{statement}\n"
        );
        assert_eq!(
            first("sheet.csv", &sheet),
            "digits-transposed",
            "{statement}"
        );
    }
}

/// Sources have names like those of figures of the whole: their divisors, and u_c below them, tell.
#[test]
fn sources_may_be_called_like_the_whole() {
    for (source, u_c) in [
        (
            "Thermometer certificate 95 % (k = 1.96),0.2,1.96,0.102",
            "0.246",
        ),
        (
            "Expanded uncertainty of the thermometer (k=2),0.2,2,0.100",
            "0.245",
        ),
        ("Combined effect of temperature,0.2,2,0.100", "0.245"),
    ] {
        is_sound(
            "sheet.csv",
            &format!(
                "Source,U or s (mV),k / divisor,u (mV)\n\
             Standard: certificate U = 0.6 mV (k = 3),0.6,3,0.200\n\
             Repeatability (standard deviation of the mean),0.1,1,0.100\n{source}\n\
             Combined,,,{u_c}\nExpanded k=2,,,0.49\n"
            ),
        );
    }
    for names in [
        ["R", "T", "U"],
        ["x", "y", "k"],
        ["U", "I", "t"],
        ["重复性", "标准器扩展不确定度 k=2", "漂移"],
    ] {
        let [a, b, c] = names;
        is_sound(
            "sheet.csv",
            &format!(
                "Source,u (mV)\n{a},0.31\n{b},0.47\n{c},0.27\n\
             Combined standard uncertainty,0.624\nExpanded uncertainty U (k=2),1.2\n"
            ),
        );
    }
    is_sound(
        "sheet.csv",
        "Symbol,Source,Value ± (mV),Distribution,Divisor,u (mV)\n\
         k,temperature coefficient,0.2,normal,1,0.2000\nU,voltage,0.3,rectangular,1.732,0.1732\n\
         u,speed,0.5,normal,2,0.2500\n\
         u_c,Combined standard uncertainty,,,,0.3640\nU,Expanded uncertainty (k=2),,,,0.73\n",
    );
    for [a, b, c, d] in [["A", "B", "C", "D"], ["a", "b", "c", "d"]] {
        is_sound(
            "sheet.csv",
            &format!(
                "Source,u (mV)\n{a},0.31\n{b},0.47\n{c},0.27\n{d},0.11\n\
             Combined standard uncertainty,0.634\nExpanded uncertainty U (k=2),1.3\n"
            ),
        );
    }
}

/// Coefficients in letters leave the last source without one (JCGM 100, H.1).
#[test]
fn a_source_above_the_sum_is_no_result() {
    is_sound(
        "sheet.csv",
        "GUM H.1 end gauge\nu,source,value,c,u_i (nm),dof\n\
         u(l_s),Calibration of standard end gauge,25 nm,1,25,18\n\
         u(d),Measured difference between end gauges,9.7 nm,1,9.7,25.6\n\
         u(δα),Difference in expansion coefficients,0.58×10⁻⁶ °C⁻¹,-l_s θ,2.9,50\n\
         u(δθ),Difference in temperatures of end gauges,0.029 °C,-l_s α_s,16.6,2\n\
         u_c(l),,,,32,16\nU99 = 2.92 × 32 nm = 93 nm\n",
    );
}

/// What stands below u_c and is not understood is no source, and is said where no U is.
#[test]
fn a_line_that_may_state_u_is_told() {
    for (whole, line) in [
        ("u_c,,,0.61\nEMU,,,5.0", Some("EMU ; 5.0")),
        (
            "u_c,,,0.61\n\nThe uncertainty for customers is 5.0 mV",
            Some("The uncertainty for customers is 5.0 mV"),
        ),
        ("u_c,,,0.61\n\nTemperature 20 °C", None),
    ] {
        let sheet = summed(whole);
        let claims = crate::claims("sheet.csv", sheet.as_bytes(), &Mapping::default()).unwrap();
        assert_eq!(claims[0].rows.len(), 4, "{whole}");
        let told = crate::read::unread_expanded(&claims[0]);
        assert_eq!(told.map(|line| line.text.as_str()), line, "{whole}");
    }
}

/// A rule for rounding may stand where a title would: 2 · 0.4163 = 0.8327 is 0.84, rounded up.
#[test]
fn the_first_line_may_be_a_rule() {
    let sheet = |first: &str, expanded: &str| {
        format!(
            "{first}\nSource,u_i (µm),c_i,u_i(y) (µm)\nReference,0.30,1,0.300\nResolution,0.2887,1,0.2887\nu_c,,,0.4163\nU (k = 2),,,{expanded}\n"
        )
    };
    let rule = "Lab rule: U is rounded up to two significant digits";
    is_sound("sheet.csv", &sheet(rule, "0.84"));
    assert_eq!(first("sheet.csv", &sheet(rule, "0.83")), "rounded-down");
    is_sound("sheet.csv", &sheet("Round gauges", "0.83"));
}

/// u_c may be called by its symbol behind a word for an uncertainty: √(0.030² + 0.0346² + 0.0115² + 0.024²) = 0.0530, and
/// 0.1001 where the amounts are added.
#[test]
fn u_c_may_stand_behind_another_name() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "Größe;Bezeichnung;Halbweite / Unsicherheit;Verteilung;Teiler;Empfindlichkeitskoeffizient;Beitrag\n\
             p_N;Normal, Kalibrierschein (U, k=2);0,060;normal;2;1;0,0300\nδp_D;Drift des Normals;0,060;Rechteck;√3;1;0,0346\n\
             δp_A;Ablesung;0,020;Rechteck;√3;1;0,0115\nδp_W;Standardabweichung des Mittelwerts;0,024;normal;1;1;0,0240\n\n\
             ;Standardunsicherheit u_c;;;;;{u_c}\n;Erweiterte Unsicherheit U (k = 2,00);;;;;{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0,0530", "0,11"));
    assert_eq!(first("sheet.csv", &sheet("0,1001", "0,20")), "linear-sum");
    let claims = understood("sheet.csv", &sheet("0,0530", "0,11"));
    assert!(claims[0].footer.u_c.is_some());
}
