//! Whether a verdict may come from a comparison that was not meant: an error of indication is compared with zero, the
//! quantity itself with its nominal value.

use super::result::{ConformityResult, FindingKind, Verdict};
use crate::budget::{Conformity, StatedTolerance};

/// Accuracy classes of indicating instruments end at 5 % (IEC 60051-1): an indication is at least so many times its
/// maximum permissible error.
const INDICATION: f64 = 1.0 / 0.05;

/// A value that does not conform and that seems to be meant for another comparison. One that conforms with limits about
/// its nominal and lies nearer to zero conforms with the same limits about zero, too.
pub(super) fn other_value(stated: &Conformity, found: &ConformityResult) -> Option<FindingKind> {
    let verdict = found.verdict?;
    if verdict == Verdict::Conforming {
        return None;
    }
    let (y, assessment) = (found.estimate, stated.name.clone());
    match stated.stated {
        StatedTolerance::Limits if stated.tolerance.lower != -stated.tolerance.upper => None,
        StatedTolerance::Nominal(nominal) => {
            let error = y.abs() < (y - nominal).abs();
            error.then_some(FindingKind::ErrorMeant {
                assessment,
                nominal,
            })
        }
        StatedTolerance::Limits => indication(y, stated, None),
        StatedTolerance::Error { of } => indication(y, stated, of),
    }
}

fn indication(y: f64, stated: &Conformity, of: Option<f64>) -> Option<FindingKind> {
    let assessment = stated.name.clone();
    let ratio = y.abs() / stated.tolerance.upper;
    let indication = match of {
        Some(of) => (y - of).abs() < y.abs(),
        None => ratio >= INDICATION,
    };
    indication.then_some(FindingKind::IndicationMeant {
        assessment,
        ratio,
        of,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::read;
    use crate::propagate::{MonteCarloChoice, Options, evaluate};

    /// What is found of a value in V under a tolerance, beside few other findings.
    fn found(value: &str, tolerance: &str) -> Option<FindingKind> {
        let text = format!(
            "[measurand.E]\nmodel = \"x\"\nunit = \"V\"\n[input.x]\nvalue = {value}\nunit = \"V\"\nu = 0.0001\n[conformity]\nrule = \"simple\"\n{tolerance}\n"
        );
        let loaded = read(&text, "b.toml", std::path::Path::new("")).unwrap();
        let options = Options {
            monte_carlo: MonteCarloChoice::Off,
            ..Options::default()
        };
        let evaluation = evaluate(&loaded.rows[0].budget, &options).unwrap();
        let mut findings = evaluation.findings;
        assert!(findings.len() < 2, "{findings:?}");
        findings.pop().map(|finding| finding.kind)
    }

    #[test]
    fn an_error_compared_with_its_nominal_is_asked_for() {
        let assessment = "E".to_string();
        let nominal = "nominal = 10\nmpe = \"0.1 %\"";
        for error in ["0.002", "-0.012", "0"] {
            let kind = FindingKind::ErrorMeant {
                assessment: assessment.clone(),
                nominal: 10.0,
            };
            assert_eq!(found(error, nominal), Some(kind), "{error}");
        }
        // The quantity itself, whether it conforms or not.
        assert_eq!(found("10.002", nominal), None);
        assert_eq!(found("9.2", nominal), None);
        // Limits say themselves what they are about.
        assert_eq!(found("0.002", "lower = 9.99\nupper = 10.01"), None);
        assert_eq!(
            found("0.002", "nominal = 10\nmpe = 1\nplanning = true"),
            None
        );
    }

    #[test]
    fn an_indication_compared_with_zero_is_asked_for() {
        let meant = |ratio, of| {
            let assessment = "E".to_string();
            Some(FindingKind::IndicationMeant {
                assessment,
                ratio,
                of,
            })
        };
        assert_eq!(found("10", "mpe = 0.5"), meant(20.0, None));
        // An error is not twenty times what is permissible, or nobody can tell.
        assert_eq!(found("9", "mpe = 0.5"), None);
        // Limits about zero are those of an error, too.
        assert_eq!(found("20", "lower = -0.5\nupper = 0.5"), meant(40.0, None));
        assert_eq!(found("20", "lower = -0.5\nupper = 0.4"), None);
        let of = "mpe_of = 10\nmpe = \"10 %\"";
        assert_eq!(found("9", of), meant(9.0, Some(10.0)));
        assert_eq!(found("-1.5", of), None);
    }
}
