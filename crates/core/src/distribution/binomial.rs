//! Successes of independent trials: what they say of the proportion is a beta distribution.

use super::beta::Beta;
use super::univariate::Kind;

pub(super) const KIND: Kind = Kind {
    key: "binomial",
    aliases: &[],
    name_en: "count out of trials (binomial), giving a beta distribution",
    name_zh: "二项分布(计数)",
    parameters: "k successes in n trials; Be(k + 1, n - k + 1) for a uniform prior, \
                 Be(k + 1/2, n - k + 1/2) Jeffreys",
    expectation: "α/(α + β)",
    variance: "αβ/((α + β)²(α + β + 1))",
    source: "ISO 3534-1:2006, 2.46 and 2.59",
    use_when: "a proportion is estimated from successes in independent trials",
    stated_by: Some("successes"),
};

/// What so many successes and failures say of the proportion of successes, to both of which the prior adds `prior`;
/// nothing proper where one of them is zero then.
pub fn proportion(successes: f64, failures: f64, prior: f64) -> Option<Beta> {
    let (alpha, beta) = (successes + prior, failures + prior);
    (alpha > 0.0 && beta > 0.0).then_some(Beta {
        alpha,
        beta,
        lower: 0.0,
        upper: 1.0,
    })
}
