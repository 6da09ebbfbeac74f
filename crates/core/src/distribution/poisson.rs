//! Counts of independent events: what they say of the expected number is a gamma distribution.

use super::gamma::Gamma;
use super::univariate::Kind;

pub(super) const KIND: Kind = Kind {
    key: "poisson",
    aliases: &[],
    name_en: "count (Poisson), giving a gamma distribution",
    name_zh: "泊松分布(计数)",
    parameters: "n events counted; G(n + 1, 1) for a uniform prior, G(n + 1/2, 1) Jeffreys, \
                 G(n, 1) reciprocal",
    expectation: "n + 1, n + 1/2 or n",
    variance: "n + 1, n + 1/2 or n",
    source: "JCGM 101:2008, 6.4.11",
    use_when: "independent events were counted (radioactive decay, particles)",
    stated_by: Some("count"),
};

/// What so many counted events say of their expected number, to which the prior adds `prior` events (JCGM 101
/// 6.4.11); nothing proper where both are zero.
pub fn expected_events(events: f64, prior: f64) -> Option<Gamma> {
    let shape = events + prior;
    (shape > 0.0).then_some(Gamma {
        origin: 0.0,
        shape,
        scale: 1.0,
    })
}
