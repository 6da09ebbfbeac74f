//! Points side by side, whatever they are called.

use super::understood;
use crate::{Verdict, audit};

/// Whether both points of a sheet are read with their own figures, and sound.
fn are_both_sound(sheet: &str) {
    let claims = understood("sheet.csv", sheet);
    let found: Vec<_> = claims
        .iter()
        .map(|claimed| {
            let expanded = claimed.footer.expanded.as_ref().map(|u| u.value);
            (audit(claimed).verdict, expanded)
        })
        .collect();
    let both = [13.0, 17.0].map(|u| (Verdict::Sound, Some(u)));
    assert_eq!(found, both, "{sheet}");
}

const ROWS: &str = "Reference,N,2,10,5.00,12,6.00\nUniformity,R,1.732,6,3.46,8,4.62\n\
    Stability,R,1.732,4,2.31,6,3.46\nu_c,,,,6.51,,8.33\nU (k=2),,,,13,,17\n";

#[test]
fn points_have_any_name() {
    for [first, second] in [
        ["20 °C", "100 °C"],
        ["-20 °C", "100 °C"],
        ["−20 ℃", "−10 ℃"],
        ["+20 °C", "+100 °C"],
        ["±10 V", "±100 V"],
        ["10 V (50 Hz)", "100 V (50 Hz)"],
        ["10 V @ 50 Hz", "10 V @ 1 kHz"],
        ["10 %FS", "100 %FS"],
        ["0.1 MPa", "−0.1 MPa"],
        ["Point 1", "Point 2"],
        ["测点1", "测点2"],
        ["M1", "M2"],
        ["1:1", "10:1"],
        ["low", "high"],
        ["低温", "高温"],
        ["A", "B"],
    ] {
        are_both_sound(&format!(
            "Source,Dist,Div,a ({first}) / mK,u ({first}) / mK,a ({second}) / mK,u ({second}) / mK\n{ROWS}"
        ));
        are_both_sound(&format!(
            "Source,Dist,Div,{first},,{second},\n,,,a / mK,u / mK,a / mK,u / mK\n{ROWS}"
        ));
    }
    are_both_sound(&format!(
        "来源,分布,除数,a(-20℃) / mK,u(-20℃) / mK,a(100℃) / mK,u(100℃) / mK\n{ROWS}"
    ));
}

/// Columns of the two types of evaluation are no points.
#[test]
fn types_are_no_points() {
    let sheet = "Source,Type A,,Type B,\n,a / mK,u / mK,a / mK,u / mK\nReference,,,10,5.00\nUniformity,,,6,3.46\n\
        Readings,2.31,2.31,,\nu_c,,,,6.51\nU (k=2),,,,13\n";
    assert!(understood("sheet.csv", sheet).len() <= 1);
}
