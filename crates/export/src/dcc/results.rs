//! Measurement results: quantities of the D-SI with what belongs to them.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use gumption_format::document::{
    Administration, Attachment, Certificate, Certified, CertifiedConformity, CertifiedPoint,
    CertifiedUncertainty, CertifiedVerdict, Condition, Region, Told,
};

use super::{tidy, told, words};
use crate::xml::{self, Element, text};

/// What the D-SI writes where a number is not stated.
const NOT_STATED: &str = "NaN";

pub(super) fn element(certificate: &Certificate, given: &Administration) -> Element {
    let results = certificate.results.iter().enumerate();
    let results = results.map(|(at, result)| of_measurand(certificate, at, result));
    let region = certificate
        .region
        .iter()
        .map(|region| joint(certificate, region));
    let name = match certificate.title.0.is_empty() {
        true => words(certificate, "dcc:name", "Measurement", "测量"),
        false => told("dcc:name", &certificate.title),
    };
    let measured = xml::element("dcc:measurementResult")
        .with(name)
        .with_all(method(certificate))
        .with_all(conditions(given))
        .with(
            xml::element("dcc:results")
                .with_all(results)
                .with_all(region),
        )
        .with_all(attached(certificate));
    xml::element("dcc:measurementResults").with(measured)
}

fn method(certificate: &Certificate) -> Option<Element> {
    let method = certificate.method.as_ref()?;
    let method = xml::element("dcc:usedMethod")
        .attribute("refType", "basic_calibrationMethod")
        .with(told("dcc:name", method));
    Some(xml::element("dcc:usedMethods").with(method))
}

fn conditions(given: &Administration) -> Option<Element> {
    let condition = |condition: &Condition| {
        let mut real = xml::element("si:real")
            .with(text("si:value", condition.value.as_str()))
            .with(text("si:unit", condition.unit.as_str()));
        if let Some([expanded, k, p]) = &condition.expanded {
            let uncertainty = CertifiedUncertainty::Expanded {
                expanded: expanded.clone(),
                k: k.clone(),
                p: (!p.is_empty()).then(|| p.clone()),
                distribution: None,
            };
            real = real.with_all(univariate(&uncertainty));
        }
        let quantity = xml::element("dcc:quantity").with(real);
        xml::element("dcc:influenceCondition")
            .with(told("dcc:name", &condition.name))
            .with(xml::element("dcc:data").with(quantity))
    };
    let all = given.conditions.iter().map(condition);
    (!given.conditions.is_empty()).then(|| xml::element("dcc:influenceConditions").with_all(all))
}

fn of_measurand(certificate: &Certificate, at: usize, result: &Certified) -> Element {
    let made = xml::element("dcc:result")
        .attribute("id", format!("result{}", at + 1))
        .attribute("refType", "gumption_measurand")
        .with(told("dcc:name", &Told::everywhere(&result.name)))
        .with_all(
            result
                .description
                .as_ref()
                .map(|about| told("dcc:description", about)),
        );
    made.with(
        xml::element("dcc:data").with(match result.points.as_slice() {
            [point] => single(certificate, result, point),
            points => several(certificate, result, points),
        }),
    )
}

/// A quantity of one value.
fn single(certificate: &Certificate, result: &Certified, point: &CertifiedPoint) -> Element {
    let real = real(result, point);
    let mut data: Vec<Element> = Vec::new();
    data.extend(
        point
            .freedom
            .as_ref()
            .map(|freedom| freedoms(certificate, std::slice::from_ref(freedom))),
    );
    data.extend(
        result
            .conformity
            .iter()
            .map(|one| conformity(certificate, one)),
    );
    measured(&result.name, real, data)
}

/// Values at several points: lists of one length, the labels of the points beside them.
fn several(certificate: &Certificate, result: &Certified, points: &[CertifiedPoint]) -> Element {
    // White space ends an entry of a list; a space that no line breaks at does not.
    let labels = points.iter().map(|point| {
        let words: Vec<&str> = point.label.split_whitespace().collect();
        match words.is_empty() {
            true => "-".to_owned(),
            false => words.join("\u{a0}"),
        }
    });
    let labels: Vec<String> = labels.collect();
    let labels = xml::element("dcc:quantity")
        .attribute("refType", "gumption_point")
        .with(words(certificate, "dcc:name", "Point", "测量点"))
        .with(text("dcc:charsXMLList", labels.join(" ")));
    let mut data: Vec<Element> = Vec::new();
    // An infinite number has no form of its own.
    let stated = |point: &CertifiedPoint| point.freedom.clone();
    if points.iter().any(|point| point.freedom.is_some()) {
        let all = points.iter().map(stated);
        let all: Vec<String> = all.map(|own| own.unwrap_or(NOT_STATED.into())).collect();
        data.push(freedoms(certificate, &all));
    }
    data.extend(
        result
            .conformity
            .iter()
            .map(|one| conformity(certificate, one)),
    );
    let list = xml::element("dcc:list").with(labels);
    match lists(result, points) {
        Some(lists) => list.with(measured(&result.name, lists, data)),
        // Points whose uncertainties have different forms.
        None => {
            let each = points.iter().map(|point| {
                let name = format!("{} {}", result.name, point.label);
                measured(&name, real(result, point), Vec::new())
            });
            let list = list.with_all(each);
            match data.is_empty() {
                true => list,
                false => list.with(xml::element("dcc:measurementMetaData").with_all(data)),
            }
        }
    }
}

fn measured(name: &str, value: Element, data: Vec<Element>) -> Element {
    let quantity = xml::element("dcc:quantity")
        .attribute("refType", "basic_measuredValue")
        .with(told("dcc:name", &Told::everywhere(name)))
        .with(value);
    match data.is_empty() {
        true => quantity,
        false => quantity.with(xml::element("dcc:measurementMetaData").with_all(data)),
    }
}

fn real(result: &Certified, point: &CertifiedPoint) -> Element {
    xml::element("si:real")
        .with(text("si:value", point.value.as_str()))
        .with(text("si:unit", result.unit.as_str()))
        .with_all(univariate(&point.uncertainty))
}

fn univariate(uncertainty: &CertifiedUncertainty) -> Option<Element> {
    let stated = |p: &Option<String>| p.clone().unwrap_or_else(|| NOT_STATED.into());
    let inside = match uncertainty {
        CertifiedUncertainty::Expanded {
            expanded,
            k,
            p,
            distribution,
        } => xml::element("si:expandedMU")
            .with(text("si:valueExpandedMU", expanded.as_str()))
            .with(text("si:coverageFactor", k.as_str()))
            .with(text("si:coverageProbability", stated(p)))
            .with_all(
                distribution
                    .as_ref()
                    .map(|name| text("si:distribution", name.as_str())),
            ),
        CertifiedUncertainty::Interval { standard, ends, p } => {
            xml::element("si:coverageIntervalMU")
                .with(text("si:valueStandardMU", stated(standard)))
                .with(text("si:intervalMin", ends[0].as_str()))
                .with(text("si:intervalMax", ends[1].as_str()))
                .with(text("si:coverageProbability", stated(p)))
        }
        CertifiedUncertainty::None => return None,
    };
    Some(xml::element("si:measurementUncertaintyUnivariate").with(inside))
}

/// Points whose uncertainties have one form, as lists.
fn lists(result: &Certified, points: &[CertifiedPoint]) -> Option<Element> {
    let joined = |all: Vec<String>| all.join(" ");
    let stated = |p: &Option<String>| p.clone().unwrap_or_else(|| NOT_STATED.into());
    let expanded: Option<Vec<[String; 3]>> = points
        .iter()
        .map(|point| match &point.uncertainty {
            CertifiedUncertainty::Expanded { expanded, k, p, .. } => {
                Some([expanded.clone(), k.clone(), stated(p)])
            }
            _ => None,
        })
        .collect();
    let distributions: Option<Vec<String>> = points
        .iter()
        .map(|point| match &point.uncertainty {
            CertifiedUncertainty::Expanded { distribution, .. } => distribution.clone(),
            _ => None,
        })
        .collect();
    let expanded = expanded?;
    let column = |at: usize| joined(expanded.iter().map(|one| one[at].clone()).collect());
    let values = joined(points.iter().map(|point| point.value.clone()).collect());
    let units = vec![result.unit.clone(); points.len()];
    let uncertainty = xml::element("si:expandedMUXMLList")
        .with(text("si:valueExpandedMUXMLList", column(0)))
        .with(text("si:coverageFactorXMLList", column(1)))
        .with(text("si:coverageProbabilityXMLList", column(2)))
        .with_all(distributions.map(|all| text("si:distributionXMLList", joined(all))));
    Some(
        xml::element("si:realListXMLList")
            .with(text("si:valueXMLList", values))
            .with(text("si:unitXMLList", joined(units)))
            .with(xml::element("si:measurementUncertaintyUnivariateXMLList").with(uncertainty)),
    )
}

fn freedoms(certificate: &Certificate, all: &[String]) -> Element {
    let value = match all {
        [one] => xml::element("si:real")
            .with(text("si:value", one.as_str()))
            .with(text("si:unit", "\\one")),
        all => xml::element("si:realListXMLList")
            .with(text("si:valueXMLList", all.join(" ")))
            .with(text("si:unitXMLList", vec!["\\one"; all.len()].join(" "))),
    };
    xml::element("dcc:metaData")
        .attribute("refType", "gumption_effectiveDegreesOfFreedom")
        .with(words(
            certificate,
            "dcc:name",
            "Effective degrees of freedom",
            "有效自由度",
        ))
        .with(xml::element("dcc:data").with(xml::element("dcc:quantity").with(value)))
}

fn conformity(certificate: &Certificate, one: &CertifiedConformity) -> Element {
    let verdict = |verdict: &CertifiedVerdict| match verdict {
        CertifiedVerdict::Pass => "pass",
        CertifiedVerdict::Fail => "fail",
        CertifiedVerdict::ConditionalPass => "conditionalPass",
        CertifiedVerdict::ConditionalFail => "conditionalFail",
    };
    let (mut english, mut chinese) = (
        format!("Conformity of {}", one.name),
        format!("{} 的符合性", one.name),
    );
    if let Some(point) = &one.point {
        english = format!("{english}, {point}");
        chinese = format!("{chinese}，{point}");
    }
    let made = xml::element("dcc:metaData")
        .attribute("refType", "basic_conformity")
        .with(words(certificate, "dcc:name", &english, &chinese))
        .with(told("dcc:declaration", &one.rule));
    match one.verdicts.as_slice() {
        [] => made,
        [single] => made.with(text("dcc:conformity", verdict(single))),
        all => {
            let all: Vec<&str> = all.iter().map(verdict).collect();
            made.with(text("dcc:conformityXMLList", all.join(" ")))
        }
    }
}

/// All results of one point with their covariance.
fn joint(certificate: &Certificate, region: &Region) -> Element {
    let results = &certificate.results;
    let each =
        |of: &dyn Fn(&Certified) -> String| results.iter().map(of).collect::<Vec<_>>().join(" ");
    let first = |result: &Certified| {
        let point = result.points.first();
        point.map_or(NOT_STATED.into(), |point| point.value.clone())
    };
    let columns = region.columns.iter().map(|column| {
        let entries = column.iter().map(|(value, unit)| {
            xml::element("si:covarianceXMLList")
                .with(text("si:valueXMLList", value.as_str()))
                .with(text("si:unitXMLList", unit.as_str()))
        });
        xml::element("si:columnXMLList").with_all(entries)
    });
    let ellipsoid = xml::element("si:ellipsoidalRegionMUXMLList")
        .with(xml::element("si:covarianceMatrixXMLList").with_all(columns))
        .with(text("si:coverageFactorXMLList", region.k.as_str()))
        .with(text("si:coverageProbabilityXMLList", region.p.as_str()));
    let list = xml::element("si:realListXMLList")
        .with(text(
            "si:labelXMLList",
            each(&|result| result.name.replace(char::is_whitespace, "\u{a0}")),
        ))
        .with(text("si:valueXMLList", each(&first)))
        .with(text("si:unitXMLList", each(&|result| result.unit.clone())))
        .with(xml::element("si:measurementUncertaintyMultivariateXMLList").with(ellipsoid));
    let quantity = xml::element("dcc:quantity").with(list);
    xml::element("dcc:result")
        .attribute("refType", "gumption_jointResult")
        .with(words(
            certificate,
            "dcc:name",
            "Joint result with covariance",
            "联合结果及协方差",
        ))
        .with(xml::element("dcc:data").with(quantity))
}

fn attached(certificate: &Certificate) -> Option<Element> {
    let file = |attachment: &Attachment| {
        xml::element("dcc:byteData")
            .with(tidy("dcc:fileName", &attachment.name))
            .with(text("dcc:mimeType", attachment.media_type))
            .with(text("dcc:dataBase64", STANDARD.encode(&attachment.content)))
    };
    let files = certificate.attachments.iter().map(file);
    let data = xml::element("dcc:metaData")
        .attribute("refType", "gumption_budget")
        .with(words(
            certificate,
            "dcc:name",
            "Uncertainty budget",
            "不确定度评定",
        ))
        .with(xml::element("dcc:data").with_all(files));
    (!certificate.attachments.is_empty())
        .then(|| xml::element("dcc:measurementMetaData").with(data))
}
