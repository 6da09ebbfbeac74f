//! The triangular distribution, JCGM 101 6.4.5, with the mode anywhere between the limits.

use gumption_lanes::Sampler;
use gumption_lanes::quantile::Quantile;

use super::stating::{
    Given, HALF_WIDTH, LOWER, ParameterError, ParameterRule, Parametric, Spread, UPPER, Width,
    Word, ascending, within,
};
use super::univariate::{Kind, Parameter, Univariate};

/// Triangular, symmetric (6.4.5) or not.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Triangular {
    /// Lower limit a.
    pub lower: f64,
    /// Most probable value.
    pub mode: f64,
    /// Upper limit b.
    pub upper: f64,
}

impl Univariate for Triangular {
    const KIND: Kind = Kind {
        key: "triangular",
        aliases: &["triangle", "三角", "三角形", "三角分布"],
        name_en: "triangular",
        name_zh: "三角分布",
        parameters: "T(a, c, b), mode c, symmetric when c = (a + b)/2",
        expectation: "(a + b + c)/3, symmetric: (a + b)/2",
        variance: "(a² + b² + c² - ab - ac - bc)/18, symmetric: (b - a)²/24",
        source: "JCGM 101:2008, 6.4.5",
        use_when: "two independent rectangular effects of equal width add up, or the middle is \
                   clearly the most probable value",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[
        LOWER,
        ParameterRule::number("mode", "Most likely value; the middle when left out."),
        UPPER,
        HALF_WIDTH,
    ];

    const WORD: Word = Word::Limits;

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        given.between(|lower, upper| {
            let mode = given.optional("mode").unwrap_or((lower + upper) / 2.0);
            Ok(Triangular { lower, mode, upper })
        })
    }

    fn of_width(width: Width, _: f64, how: &str) -> Result<Spread<Self>, ParameterError> {
        Ok(Spread::symmetric(width, (6.0, "6"), how, |a| Triangular {
            lower: -a,
            mode: 0.0,
            upper: a,
        }))
    }

    /// With its mode at the value.
    fn between(minus: f64, plus: f64) -> Option<(Spread<Self>, f64)> {
        let shift = (plus - minus) / 3.0;
        let spread = Spread {
            distribution: Triangular {
                lower: -minus - shift,
                mode: -shift,
                upper: plus - shift,
            },
            u: ((plus * plus + minus * minus + plus * minus) / 18.0).sqrt(),
            how: String::new(),
        };
        Some((spread, shift))
    }

    fn half_width(&self) -> Option<f64> {
        let Triangular { lower, mode, upper } = *self;
        ((lower + upper - 2.0 * mode).abs() <= 1e-12 * (upper - lower))
            .then_some(0.5 * (upper - lower))
    }

    fn validate(&self) -> Result<(), ParameterError> {
        ascending(self.lower, self.upper)?;
        within("mode", self.mode, [self.lower, self.upper])
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: lower, mode, upper)
    }

    fn shifted(&self, by: f64) -> Self {
        Triangular {
            lower: self.lower + by,
            mode: self.mode + by,
            upper: self.upper + by,
        }
    }

    fn stretched(&self, by: f64) -> Self {
        Triangular {
            lower: self.lower * by,
            mode: self.mode * by,
            upper: self.upper * by,
        }
    }

    fn mirrored(&self) -> Option<Self> {
        Some(Triangular {
            lower: -self.upper,
            mode: -self.mode,
            upper: -self.lower,
        })
    }

    fn mean(&self) -> Option<f64> {
        Some((self.lower + self.mode + self.upper) / 3.0)
    }

    fn variance(&self) -> Option<f64> {
        let (rise, fall) = (self.mode - self.lower, self.upper - self.mode);
        Some((rise * rise + rise * fall + fall * fall) / 18.0)
    }

    fn third_central_moment(&self) -> Option<f64> {
        let (rise, fall) = (self.mode - self.lower, self.upper - self.mode);
        Some((fall - rise) * (2.0 * rise + fall) * (rise + 2.0 * fall) / 270.0)
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        self.variance().map(|v| 2.4 * v * v)
    }

    fn cdf(&self, x: f64) -> f64 {
        below(x, self.lower, self.mode, self.upper)
    }

    fn sf(&self, x: f64) -> f64 {
        below(-x, -self.upper, -self.mode, -self.lower)
    }

    fn quantile(&self, p: f64) -> f64 {
        place(p, self.lower, self.mode, self.upper)
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        -place(q, -self.upper, -self.mode, -self.lower)
    }

    fn support(&self) -> (f64, f64) {
        (self.lower, self.upper)
    }

    fn kinks(&self) -> Vec<f64> {
        vec![self.mode]
    }

    fn fits_cells(&self) -> bool {
        true
    }

    fn sampler(&self) -> Sampler {
        let Triangular { lower, mode, upper } = *self;
        Sampler::Triangular { lower, mode, upper }
    }

    fn block_quantile(&self) -> Option<Quantile> {
        let Triangular { lower, mode, upper } = *self;
        Some(Quantile::Triangular { lower, mode, upper })
    }
}

/// Probability below x.
fn below(x: f64, lower: f64, mode: f64, upper: f64) -> f64 {
    let width = upper - lower;
    if x <= lower {
        0.0
    } else if x >= upper {
        1.0
    } else if x < mode {
        (x - lower) / width * ((x - lower) / (mode - lower))
    } else {
        1.0 - (upper - x) / width * ((upper - x) / (upper - mode))
    }
}

/// The place below which a fraction p lies.
fn place(p: f64, lower: f64, mode: f64, upper: f64) -> f64 {
    let width = upper - lower;
    if p * width < mode - lower {
        lower + (p * width * (mode - lower)).sqrt()
    } else {
        upper - ((1.0 - p) * width * (upper - mode)).sqrt()
    }
}
