//! Forms of certificates, old and new, and what is wrong with some.

use super::certificate::{DigitalCertificate, read};

/// A certificate of a version with these results.
fn certificate(version: &str, data: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<dcc:digitalCalibrationCertificate xmlns:dcc="https://ptb.de/dcc" xmlns:si="https://ptb.de/si" schemaVersion="{version}">
  <dcc:administrativeData>
    <dcc:coreData>
      <dcc:uniqueIdentifier>A-17</dcc:uniqueIdentifier>
      <dcc:beginPerformanceDate>2025-03-01</dcc:beginPerformanceDate>
      <dcc:endPerformanceDate>2025-03-02</dcc:endPerformanceDate>
    </dcc:coreData>
    <dcc:calibrationLaboratory><dcc:contact><dcc:name><dcc:content>Institute</dcc:content></dcc:name></dcc:contact></dcc:calibrationLaboratory>
  </dcc:administrativeData>
  <dcc:measurementResults><dcc:measurementResult><dcc:results>
    <dcc:result id="r1"><dcc:name><dcc:content lang="en">Mass</dcc:content><dcc:content lang="de">Masse</dcc:content></dcc:name>
    <dcc:data>{data}</dcc:data></dcc:result>
  </dcc:results></dcc:measurementResult></dcc:measurementResults>
</dcc:digitalCalibrationCertificate>"#
    )
}

fn good(version: &str, data: &str) -> DigitalCertificate {
    read(&certificate(version, data)).unwrap_or_else(|faults| panic!("{faults:?}"))
}

fn bad(data: &str) -> Vec<String> {
    let content = certificate("3.3.0", data);
    let faults = read(&content).expect_err("a refused certificate");
    let told = faults.into_iter().map(|fault| {
        let place = content.get(fault.span.clone()).unwrap_or_default();
        format!("{} at {}", fault.message, place.trim())
    });
    told.collect()
}

/// value, U, k, p of every point.
fn numbers(certificate: &DigitalCertificate) -> Vec<(f64, f64, Option<f64>, Option<f64>)> {
    let values = certificate.quantities.iter().flat_map(|one| &one.values);
    let all = values.map(|one| {
        let u = one.uncertainty.expect("an uncertainty");
        (one.value, u.expanded, u.k, u.p)
    });
    all.collect()
}

#[test]
fn old_and_new_forms_say_the_same() {
    let head = "<dcc:quantity><si:real><si:value>100.02</si:value><si:unit>\\milli\\gram</si:unit>";
    let end = "</si:real></dcc:quantity>";
    for (version, form) in [
        (
            "2.4.0",
            "<si:expandedUnc><si:uncertainty>0.04</si:uncertainty><si:coverageFactor>2</si:coverageFactor><si:coverageProbability>0.95</si:coverageProbability></si:expandedUnc>",
        ),
        (
            "3.1.2",
            "<si:expandedUnc><si:uncertainty>4e-2</si:uncertainty><si:coverageFactor>2</si:coverageFactor><si:coverageProbability>0.95</si:coverageProbability></si:expandedUnc>",
        ),
        (
            "3.2.1",
            "<si:measurementUncertaintyUnivariate><si:expandedMU><si:valueExpandedMU>0.04</si:valueExpandedMU><si:coverageFactor>2</si:coverageFactor><si:coverageProbability>0.95</si:coverageProbability></si:expandedMU></si:measurementUncertaintyUnivariate>",
        ),
        (
            "3.3.0",
            "<si:measurementUncertaintyUnivariate><si:expandedMU><si:valueExpandedMU>0.04</si:valueExpandedMU><si:coverageFactor>2</si:coverageFactor><si:coverageProbability>0.95</si:coverageProbability></si:expandedMU></si:measurementUncertaintyUnivariate>",
        ),
    ] {
        let read = good(version, &format!("{head}{form}{end}"));
        assert_eq!(
            numbers(&read),
            [(100.02, 0.04, Some(2.0), Some(0.95))],
            "{version}"
        );
        assert_eq!(read.quantities[0].values[0].unit.symbol, "mg");
        assert_eq!(read.number.as_deref(), Some("A-17"));
        assert_eq!(read.laboratory.as_deref(), Some("Institute"));
        assert_eq!(read.date.as_deref(), Some("2025-03-02"));
    }
    let standard = "<si:measurementUncertaintyUnivariate><si:standardMU><si:valueStandardMU>0.02</si:valueStandardMU></si:standardMU></si:measurementUncertaintyUnivariate>";
    let read = good("3.3.0", &format!("{head}{standard}{end}"));
    assert_eq!(numbers(&read), [(100.02, 0.02, Some(1.0), None)]);
    let interval = "<si:coverageInterval><si:standardUnc>0.02</si:standardUnc><si:intervalMin>99.98</si:intervalMin><si:intervalMax>100.06</si:intervalMax><si:coverageProbability>0.95</si:coverageProbability></si:coverageInterval>";
    let read = good("2.3.0", &format!("{head}{interval}{end}"));
    assert_eq!(numbers(&read), [(100.02, 0.02, Some(1.0), None)]);
}

#[test]
fn lists_have_points_and_one_entry_may_stand_for_all() {
    let list = "<dcc:list><dcc:quantity><dcc:charsXMLList>10\u{a0}V 20\u{a0}V</dcc:charsXMLList></dcc:quantity>\
        <dcc:quantity refType=\"basic_measurementError\"><si:realListXMLList><si:valueXMLList>1.5 2.5</si:valueXMLList><si:unitXMLList>\\milli\\volt</si:unitXMLList>\
        <si:measurementUncertaintyUnivariateXMLList><si:expandedMUXMLList><si:valueExpandedMUXMLList>0.1 0.2</si:valueExpandedMUXMLList><si:coverageFactorXMLList>2</si:coverageFactorXMLList><si:coverageProbabilityXMLList>0.95</si:coverageProbabilityXMLList></si:expandedMUXMLList></si:measurementUncertaintyUnivariateXMLList>\
        </si:realListXMLList></dcc:quantity></dcc:list>";
    let read = good("3.3.0", list);
    assert_eq!(
        numbers(&read),
        [
            (1.5, 0.1, Some(2.0), Some(0.95)),
            (2.5, 0.2, Some(2.0), Some(0.95))
        ]
    );
    assert_eq!(read.quantities[0].labels, ["10 V", "20 V"]);
    let old = "<dcc:quantity><si:list><si:listUnit>\\volt</si:listUnit><si:listUnivariateUnc><si:expandedUnc><si:uncertainty>0.1</si:uncertainty><si:coverageFactor>2</si:coverageFactor><si:coverageProbability>0.95</si:coverageProbability></si:expandedUnc></si:listUnivariateUnc>\
        <si:real><si:value>1</si:value></si:real><si:real><si:value>2</si:value></si:real></si:list></dcc:quantity>";
    assert_eq!(
        numbers(&good("2.4.0", old)),
        [
            (1.0, 0.1, Some(2.0), Some(0.95)),
            (2.0, 0.1, Some(2.0), Some(0.95))
        ]
    );
}

#[test]
fn what_the_schema_does_not_check_is_refused_at_its_place() {
    let real = |value: &str, unit: &str, k: &str, p: &str| {
        format!(
            "<dcc:quantity><si:real><si:value>{value}</si:value><si:unit>{unit}</si:unit><si:measurementUncertaintyUnivariate><si:expandedMU><si:valueExpandedMU>0.04</si:valueExpandedMU><si:coverageFactor>{k}</si:coverageFactor><si:coverageProbability>{p}</si:coverageProbability></si:expandedMU></si:measurementUncertaintyUnivariate></si:real></dcc:quantity>"
        )
    };
    let only = |data: &str| {
        let faults = bad(data);
        assert_eq!(faults.len(), 1, "{faults:?}");
        faults[0].clone()
    };
    assert_eq!(
        only(&real("1", "mg", "2", "0.95")),
        "`mg` is not a unit of the D-SI at mg"
    );
    assert_eq!(
        only(&real("1", "\\gram", "0.5", "0.95")),
        "0.5 is no coverage factor at 0.5"
    );
    assert_eq!(
        only(&real("1", "\\gram", "2", "95")),
        "95 is no coverage probability at 95"
    );
    assert_eq!(
        only(&real("1,5", "\\gram", "2", "0.95")),
        "`1,5` is not a number, in value at 1,5"
    );
    let list = "<dcc:quantity><si:realListXMLList><si:valueXMLList>1 2 3</si:valueXMLList><si:unitXMLList>\\volt \\volt</si:unitXMLList></si:realListXMLList></dcc:quantity>";
    assert_eq!(
        only(list),
        "unitXMLList has 2 entries, and the list has 3 values at \\volt \\volt"
    );
}

#[test]
fn relative_uncertainties_are_parts_of_the_values() {
    let relative = |unit: &str, size: &str| {
        format!(
            "<dcc:quantity><si:real><si:value>-20</si:value><si:unit>\\volt</si:unit></si:real><dcc:relativeUncertainty><dcc:relativeUncertaintySingle><si:value>{size}</si:value><si:unit>{unit}</si:unit></dcc:relativeUncertaintySingle></dcc:relativeUncertainty></dcc:quantity>"
        )
    };
    let found = |unit: &str, size: &str| numbers(&good("3.2.1", &relative(unit, size)));
    assert_eq!(found("\\one", "0.0005"), [(-20.0, 0.01, None, None)]);
    let [(_, percent, ..)] = found("\\percent", "0.05")[..] else {
        panic!("one point");
    };
    assert!((percent - 0.01).abs() < 1e-15);
    let list = "<dcc:quantity><si:realListXMLList><si:valueXMLList>10 20</si:valueXMLList><si:unitXMLList>\\volt</si:unitXMLList></si:realListXMLList><dcc:relativeUncertainty><dcc:relativeUncertaintyXmlList><si:valueXMLList>0.5 0.25</si:valueXMLList><si:unitXMLList>\\one</si:unitXMLList></dcc:relativeUncertaintyXmlList></dcc:relativeUncertainty></dcc:quantity>";
    let all = numbers(&good("3.3.0", list));
    assert_eq!(all, [(10.0, 5.0, None, None), (20.0, 5.0, None, None)]);
    assert!(bad(&relative("\\volt", "0.1"))[0].contains("a relative uncertainty in"));
    assert!(bad(&relative("\\one", "-0.1"))[0].contains("is no uncertainty"));
}

#[test]
fn statements_say_until_when_a_certificate_is_used() {
    let data = "<dcc:quantity><si:real><si:value>1</si:value><si:unit>\\volt</si:unit></si:real></dcc:quantity>";
    let validity = |statement: &str| {
        let statements = format!(
            "<dcc:statements><dcc:statement {statement}</dcc:statement></dcc:statements></dcc:administrativeData>"
        );
        let content = certificate("3.3.0", data).replace("</dcc:administrativeData>", &statements);
        read(&content).expect("a certificate").validity
    };
    let until = |statement: &str| validity(statement).until.map(|day| day.to_string());
    for (statement, day) in [
        (
            "refType=\"basic_recalibrationDate\"><dcc:date>2026-05-01</dcc:date>",
            Some("2026-05-01"),
        ),
        (
            "><dcc:valid>true</dcc:valid><dcc:period>P1Y</dcc:period>",
            Some("2026-03-02"),
        ),
        (
            "><dcc:valid>true</dcc:valid><dcc:date>2025-03-10</dcc:date><dcc:period>P6M</dcc:period>",
            Some("2025-09-10"),
        ),
        ("><dcc:date>2026-05-01</dcc:date>", None),
    ] {
        assert_eq!(until(statement).as_deref(), day, "{statement}");
    }
    assert_eq!(
        validity("><dcc:valid>false</dcc:valid>").refused,
        ["statement"]
    );
    // A statement about a standard is not one about the certificate.
    let norm = "><dcc:norm>ISO 376 class 0.5</dcc:norm><dcc:valid>false</dcc:valid><dcc:period>P1Y</dcc:period>";
    let found = validity(norm);
    assert_eq!(found.refused, ["ISO 376 class 0.5"]);
    assert_eq!(found.until, None);
}

#[test]
fn other_files_are_refused() {
    for (content, words) in [
        ("<a><b></a>", "not well-formed"),
        ("<html/>", "begins with digitalCalibrationCertificate"),
        (
            "<digitalCalibrationCertificate schemaVersion=\"9.0\"/>",
            "`9.0`",
        ),
        (
            "<digitalCalibrationCertificate schemaVersion=\"3.3.0\"/>",
            "no result",
        ),
        ("", "not well-formed"),
        (
            "<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>",
            "not well-formed",
        ),
    ] {
        let faults = read(content).expect_err("a refused file");
        let message = faults[0].message.to_string();
        assert!(message.contains(words), "{content}: {message}");
    }
}
