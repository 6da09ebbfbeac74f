//! Distributions of a known shape whose width is a half-width or a standard uncertainty.

use std::ops::Range;

use super::checker::Checker;
use super::draft::{Context, Core, show};
use crate::budget::distributions::{DistributionEntry, Shape};
use crate::budget::faults::{DISTRIBUTION, DOF, MISSING_KEY, MODIFIER, NO_COVERAGE_FACTOR};
use crate::budget::tables::ComponentTable;
use crate::distribution::Distribution;
use crate::fault::Fault;
use crate::special::student_t_two_sided_quantile;

/// Width of a shape before its parameters are known.
#[derive(Clone, Copy)]
pub(super) enum Width {
    /// Standard uncertainty.
    U(f64),
    /// Half-width.
    Half(f64),
}

/// A width from the file, whose shape is still to be found.
struct Unshaped<'a> {
    table: &'a ComponentTable,
    width: Width,
    /// How the width came about.
    how: &'a str,
    context: &'a Context<'a>,
}

/// The bells.
#[derive(Clone, Copy, PartialEq)]
enum Bell {
    /// Normal whatever ν is, because the file says so.
    Normal,
    /// t, because the file says so.
    StudentT,
    /// Nothing is said: t for finite ν, else normal.
    Either,
}

impl Unshaped<'_> {
    /// A symmetric distribution with the variance a²/`divisor`.
    fn symmetric(&self, divisor: f64, make: impl Fn(f64) -> Distribution) -> Core {
        let how = self.how;
        match self.width {
            Width::Half(a) => Core::new(
                make(a),
                a / divisor.sqrt(),
                format!("a/√{}, {how}", show(divisor)),
            ),
            Width::U(u) => Core::new(make(u * divisor.sqrt()), u, how),
        }
    }

    /// Where the shape is stated.
    fn place(&self) -> Range<usize> {
        let stated = self.table.distribution.as_ref();
        stated.map_or(self.context.place.clone(), |stated| stated.span.clone())
    }

    /// A parameter of the shape is missing.
    fn lacks(&self, key: &str, meaning: &str) -> Fault {
        let message = format!("the distribution of {} needs `{key}`", self.context.owner);
        Fault::new(MISSING_KEY, self.place(), message)
            .label(format!("`{key}` is missing"))
            .help(format!("add `{key}`: {meaning}"))
    }
}

impl Checker<'_> {
    /// A distribution of the shape that the table states, or of the default one.
    pub(super) fn shaped(
        &mut self,
        table: &ComponentTable,
        width: Width,
        default: Shape,
        how: String,
        context: &Context<'_>,
    ) -> Option<Core> {
        let stated = table
            .distribution
            .as_ref()
            .and_then(|entry| match &entry.value {
                DistributionEntry::Shape(shape) => Some(*shape),
                DistributionEntry::Full(_) => None,
            });
        let shape = stated.unwrap_or(default);
        self.shape_keys(table, shape);
        let dof = self.dof(table)?;
        let unshaped = Unshaped {
            table,
            width,
            how: &how,
            context,
        };
        let mut core = match shape {
            Shape::Normal if stated.is_some() => self.bell(&unshaped, Bell::Normal, dof),
            Shape::Normal => self.bell(&unshaped, Bell::Either, dof),
            Shape::StudentT => self.bell(&unshaped, Bell::StudentT, dof),
            Shape::Uniform => Some(unshaped.symmetric(3.0, |a| Distribution::Uniform {
                lower: -a,
                upper: a,
            })),
            Shape::Triangular => Some(unshaped.symmetric(6.0, |a| Distribution::Triangular {
                lower: -a,
                mode: 0.0,
                upper: a,
            })),
            Shape::Arcsine => Some(unshaped.symmetric(2.0, |a| Distribution::Arcsine {
                lower: -a,
                upper: a,
            })),
            Shape::Trapezoidal => self.trapezoid(&unshaped),
            Shape::CurvilinearTrapezoid => self.curvilinear(&unshaped),
        }?;
        core.dof = dof;
        Some(core)
    }

    /// Reports parameters that belong to another shape.
    pub(super) fn shape_keys(&mut self, table: &ComponentTable, shape: Shape) {
        let foreign = [
            (
                table.beta.as_ref().map(|beta| &beta.key),
                Shape::Trapezoidal,
                "beta",
            ),
            (
                table.d.as_ref().map(|d| &d.key),
                Shape::CurvilinearTrapezoid,
                "d",
            ),
        ];
        for (key, owner, name) in foreign {
            if let Some(span) = key.filter(|_| shape != owner) {
                let distribution = table
                    .distribution
                    .as_ref()
                    .map_or(span.clone(), |stated| stated.span.clone());
                self.report(
                    Fault::new(
                        MODIFIER,
                        span.clone(),
                        format!(
                            "`{name}` is no parameter of a {} distribution",
                            shape.word()
                        ),
                    )
                    .label(format!("goes with distribution = \"{}\"", owner.word()))
                    .related(distribution, format!("{} here", shape.word())),
                );
            }
        }
        if let Some(p) = table
            .p
            .as_ref()
            .filter(|_| !matches!(shape, Shape::Normal | Shape::StudentT))
        {
            self.report(
                Fault::new(
                    MODIFIER,
                    p.key.clone(),
                    format!("`p` does not go with a {} distribution", shape.word()),
                )
                .label("its limits hold everything")
                .help("write distribution = \"normal\" if the half-width is a coverage interval"),
            );
        }
    }

    /// Normal or t: from u, or from a half-width with its coverage probability.
    fn bell(&mut self, unshaped: &Unshaped<'_>, bell: Bell, dof: f64) -> Option<Core> {
        let owner = unshaped.context.owner;
        if bell == Bell::StudentT && dof.is_infinite() {
            let message = format!("the t distribution of {owner} has no degrees of freedom");
            return self.refuse(
                Fault::new(DOF, unshaped.place(), message)
                    .label("`dof` is missing")
                    .help("add `dof`, or write distribution = \"normal\""),
            );
        }
        let (u, how) = match unshaped.width {
            Width::U(u) => (u, unshaped.how.to_string()),
            Width::Half(a) => {
                let Some(p) = &unshaped.table.p else {
                    let message =
                        format!("the normal half-width of {owner} has no coverage probability");
                    return self.refuse(
                        Fault::new(NO_COVERAGE_FACTOR, unshaped.place(), message)
                            .label("`p` is missing")
                            .help("add `p`, for example p = 0.95; a normal distribution has no limits"),
                    );
                };
                let p = self.probability(p)?;
                let k = student_t_two_sided_quantile(p, dof);
                (a / k, format!("a/k = {}/{} (p = {p})", show(a), show(k)))
            }
        };
        let distribution = match bell {
            Bell::Normal => Distribution::Normal { mean: 0.0, sd: u },
            Bell::StudentT | Bell::Either => self.t_or_normal(u, dof, &unshaped.context.place)?,
        };
        Some(Core {
            dof,
            ..Core::new(distribution, u, how)
        })
    }

    fn trapezoid(&mut self, unshaped: &Unshaped<'_>) -> Option<Core> {
        let Some(beta) = &unshaped.table.beta else {
            let meaning = "top width / base width, from 0 to 1";
            return self.refuse(unshaped.lacks("beta", meaning));
        };
        if !(0.0..=1.0).contains(&beta.value) {
            return self.refuse(
                Fault::new(
                    DISTRIBUTION,
                    beta.span.clone(),
                    format!("beta is {}", beta.value),
                )
                .label("expected a number from 0 to 1")
                .help("beta is the width of the top divided by the width of the base: 0 makes a triangle, 1 a rectangle"),
            );
        }
        // Variance a²(1 + β²)/6, JCGM 101 6.4.4.4.
        let beta = beta.value;
        Some(
            unshaped.symmetric(6.0 / (1.0 + beta * beta), |a| Distribution::Trapezoidal {
                lower: -a,
                upper: a,
                beta,
            }),
        )
    }

    fn curvilinear(&mut self, unshaped: &Unshaped<'_>) -> Option<Core> {
        let Some(d) = &unshaped.table.d else {
            let meaning = "the half-width of the doubt about each limit";
            return self.refuse(unshaped.lacks("d", meaning));
        };
        let place = d.span.clone();
        let d = self.positive_deviation(d, "d", unshaped.context, false)?;
        // Variance a²/3 + d²/9, JCGM 101 6.4.3.4.
        let (a, u) = match unshaped.width {
            Width::Half(a) => (a, (a * a / 3.0 + d * d / 9.0).sqrt()),
            Width::U(u) => ((3.0 * (u * u - d * d / 9.0)).max(0.0).sqrt(), u),
        };
        if d > a {
            return self.refuse(
                Fault::new(
                    DISTRIBUTION,
                    place,
                    format!("d = {} is more than the half-width {}", show(d), show(a)),
                )
                .label("must not exceed the half-width"),
            );
        }
        let distribution = Distribution::CurvilinearTrapezoid {
            lower: -a,
            upper: a,
            d,
        };
        Some(Core::new(
            distribution,
            u,
            format!("√(a²/3 + d²/9), {}, d = {}", unshaped.how, show(d)),
        ))
    }
}

/// Normal when a coverage probability is stated, else rectangular (GUM 4.3.7).
pub(super) fn default_shape(table: &ComponentTable) -> Shape {
    if table.p.is_some() {
        Shape::Normal
    } else {
        Shape::Uniform
    }
}
