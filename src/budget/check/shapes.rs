//! Distributions of a known shape whose width is a half-width or a standard uncertainty.

use std::ops::Range;

use super::Checker;
use super::draft::{Context, Core, show};
use crate::budget::distributions::{DistributionEntry, Shape};
use crate::budget::faults::{DISTRIBUTION, DOF, MISSING_KEY, MODIFIER, NO_COVERAGE_FACTOR};
use crate::budget::tables::ComponentTable;
use crate::distribution::Distribution;
use crate::fault::Fault;
use crate::special::student_t_two_sided_quantile;

/// Width of a shape before its parameters are known.
pub(super) enum Width {
    /// Standard uncertainty.
    U(f64),
    /// Half-width.
    Half(f64),
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
        let mut core = match shape {
            Shape::Normal | Shape::StudentT => {
                self.bell(table, width, shape, stated.is_some(), dof, &how, context)
            }
            Shape::Uniform => Some(symmetric(width, 3.0, &how, |a| Distribution::Uniform {
                lower: -a,
                upper: a,
            })),
            Shape::Triangular => Some(symmetric(width, 6.0, &how, |a| Distribution::Triangular {
                lower: -a,
                mode: 0.0,
                upper: a,
            })),
            Shape::Arcsine => Some(symmetric(width, 2.0, &how, |a| Distribution::Arcsine {
                lower: -a,
                upper: a,
            })),
            Shape::Trapezoidal => self.trapezoid(table, width, &how, context),
            Shape::CurvilinearTrapezoid => self.curvilinear(table, width, &how, context),
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
                self.faults.push(
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
            self.faults.push(
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
    #[allow(clippy::too_many_arguments)]
    fn bell(
        &mut self,
        table: &ComponentTable,
        width: Width,
        shape: Shape,
        stated: bool,
        dof: f64,
        how: &str,
        context: &Context<'_>,
    ) -> Option<Core> {
        if shape == Shape::StudentT && dof.is_infinite() {
            return self.refuse(
                Fault::new(
                    DOF,
                    shape_place(table, context),
                    format!(
                        "the t distribution of {} has no degrees of freedom",
                        context.owner
                    ),
                )
                .label("`dof` is missing")
                .help("add `dof`, or write distribution = \"normal\""),
            );
        }
        let (u, how) = match width {
            Width::U(u) => (u, how.to_string()),
            Width::Half(a) => {
                let Some(p) = &table.p else {
                    return self.refuse(
                        Fault::new(
                            NO_COVERAGE_FACTOR,
                            shape_place(table, context),
                            format!(
                                "the normal half-width of {} has no coverage probability",
                                context.owner
                            ),
                        )
                        .label("`p` is missing")
                        .help("add `p`, for example p = 0.95; a normal distribution has no limits"),
                    );
                };
                let p = self.probability(p)?;
                let k = student_t_two_sided_quantile(p, dof);
                (a / k, format!("a/k = {}/{} (p = {p})", show(a), show(k)))
            }
        };
        // A stated normal distribution stays normal; without a statement finite ν means t.
        let distribution = if shape == Shape::Normal && stated {
            Distribution::Normal { mean: 0.0, sd: u }
        } else {
            self.t_or_normal(u, dof, &context.place)?
        };
        Some(Core {
            dof,
            ..Core::new(distribution, u, how)
        })
    }

    fn trapezoid(
        &mut self,
        table: &ComponentTable,
        width: Width,
        how: &str,
        context: &Context<'_>,
    ) -> Option<Core> {
        let Some(beta) = &table.beta else {
            return self.refuse(missing_parameter(
                shape_place(table, context),
                "beta",
                "top width / base width, from 0 to 1",
                context,
            ));
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
        Some(symmetric(width, 6.0 / (1.0 + beta * beta), how, |a| {
            Distribution::Trapezoidal {
                lower: -a,
                upper: a,
                beta,
            }
        }))
    }

    fn curvilinear(
        &mut self,
        table: &ComponentTable,
        width: Width,
        how: &str,
        context: &Context<'_>,
    ) -> Option<Core> {
        let Some(d) = &table.d else {
            return self.refuse(missing_parameter(
                shape_place(table, context),
                "d",
                "the half-width of the doubt about each limit",
                context,
            ));
        };
        let place = d.span.clone();
        let d = self.positive_deviation(d, "d", context, false)?;
        // Variance a²/3 + d²/9, JCGM 101 6.4.3.4.
        let (a, u) = match width {
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
            format!("√(a²/3 + d²/9), {how}, d = {}", show(d)),
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

/// A symmetric distribution with the variance a²/`divisor`.
fn symmetric(width: Width, divisor: f64, how: &str, make: impl Fn(f64) -> Distribution) -> Core {
    match width {
        Width::Half(a) => Core::new(
            make(a),
            a / divisor.sqrt(),
            format!("a/√{}, {how}", show(divisor)),
        ),
        Width::U(u) => Core::new(make(u * divisor.sqrt()), u, how),
    }
}

/// Where the shape is stated.
fn shape_place(table: &ComponentTable, context: &Context<'_>) -> Range<usize> {
    table
        .distribution
        .as_ref()
        .map_or(context.place.clone(), |stated| stated.span.clone())
}

fn missing_parameter(
    place: Range<usize>,
    key: &str,
    meaning: &str,
    context: &Context<'_>,
) -> Fault {
    Fault::new(
        MISSING_KEY,
        place,
        format!("the distribution of {} needs `{key}`", context.owner),
    )
    .label(format!("`{key}` is missing"))
    .help(format!("add `{key}`: {meaning}"))
}
