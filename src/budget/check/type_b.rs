//! Type B evaluation: uncertainty from limits, certificates, specifications (GUM 4.3).

use super::Checker;
use super::draft::{Context, Core, Location, show};
use super::ways::Way;
use crate::budget::distributions::{DistributionEntry, Shape};
use crate::budget::faults::{
    DISTRIBUTION, DOF, K_AND_P, LIMITS, MISSING_KEY, MODIFIER, NO_COVERAGE_FACTOR, NOT_POSITIVE,
    PROBABILITY, UNIT, WRONG_TYPE,
};
use crate::budget::table::Stated;
use crate::budget::tables::{CertificateTable, ComponentTable, SpecificationTable};
use crate::budget::values::Amount;
use crate::distribution::Distribution;
use crate::fault::Fault;
use crate::special::student_t_two_sided_quantile;

/// Width of a shape before its parameters are known.
enum Width {
    /// Standard uncertainty.
    U(f64),
    /// Half-width.
    Half(f64),
}

impl Checker<'_> {
    /// The component that limits, a certificate, a specification or a stated u describe.
    pub(super) fn type_b(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
    ) -> Option<Core> {
        let relative = table.relative.as_ref().is_some_and(|stated| stated.value);
        match way {
            Way::U => {
                let u = self.positive_deviation(table.u.as_ref()?, "u", context, relative)?;
                self.shaped(
                    table,
                    Width::U(u),
                    Shape::Normal,
                    "u as stated".into(),
                    context,
                )
            }
            Way::HalfWidth => {
                let a = self.positive_deviation(
                    table.half_width.as_ref()?,
                    "half_width",
                    context,
                    relative,
                )?;
                self.shaped(
                    table,
                    Width::Half(a),
                    default_shape(table),
                    format!("a = {}", show(a)),
                    context,
                )
            }
            Way::Limits => self.limits(table, context),
            Way::PlusMinus => self.plus_minus(table, relative, context),
            Way::Certificate => self.expanded(table, relative, context),
            Way::Specification => {
                let stated = table.specification.as_ref()?;
                let a = self.specification(stated, context)?;
                self.shaped(
                    table,
                    Width::Half(a),
                    default_shape(table),
                    format!("specification a = {}", show(a)),
                    context,
                )
            }
            Way::Step => {
                let q = self.positive_deviation(table.step.as_ref()?, "step", context, false)?;
                self.shaped(
                    table,
                    Width::Half(q / 2.0),
                    Shape::Uniform,
                    format!("a = q/2 = {}", show(q / 2.0)),
                    context,
                )
            }
            Way::Bits => self.quantisation(table, context),
            _ => None,
        }
    }

    /// A distribution of the shape that the table states, or of the default one.
    fn shaped(
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
    fn shape_keys(&mut self, table: &ComponentTable, shape: Shape) {
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
                    context.place.clone(),
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
                            context.place.clone(),
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
                .label("top width / base width, from 0 to 1"),
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

    fn limits(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let stated = table.limits.as_ref()?;
        let [lower, upper] = self.two(stated, "limits", context)?;
        if lower >= upper {
            return self.refuse(
                Fault::new(
                    LIMITS,
                    stated.span.clone(),
                    format!("the limits of {} are {lower} and {upper}", context.owner),
                )
                .label("lower limit first"),
            );
        }
        let a = (upper - lower) / 2.0;
        let mut core = self.shaped(
            table,
            Width::Half(a),
            default_shape(table),
            format!("a = {}", show(a)),
            context,
        )?;
        core.location = Location::Between {
            expectation: lower + a,
            lower,
            upper,
        };
        Some(core)
    }

    /// Two amounts on the scale of the quantity.
    fn two(
        &mut self,
        stated: &Stated<Vec<Stated<Amount>>>,
        key: &str,
        context: &Context<'_>,
    ) -> Option<[f64; 2]> {
        let [first, second] = stated.value.as_slice() else {
            return self.refuse(
                Fault::new(
                    WRONG_TYPE,
                    stated.span.clone(),
                    format!("`{key}` has {} entries", stated.value.len()),
                )
                .label("expected the lower and the upper one"),
            );
        };
        let first = self.quantity(first, context.unit, context.owner);
        let second = self.quantity(second, context.unit, context.owner);
        Some([first?, second?])
    }

    /// Limits at different distances from the value: the estimate moves to their expectation
    /// (GUM 4.3.8).
    fn plus_minus(
        &mut self,
        table: &ComponentTable,
        relative: bool,
        context: &Context<'_>,
    ) -> Option<Core> {
        let (Some(plus), Some(minus)) = (&table.plus, &table.minus) else {
            let missing = if table.plus.is_none() {
                "plus"
            } else {
                "minus"
            };
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    context.place.clone(),
                    format!("{} lacks `{missing}`", context.owner),
                )
                .label(format!("`{missing}` is missing"))
                .help("asymmetric limits need both; for symmetric ones write `half_width`"),
            );
        };
        let plus = self.positive_deviation(plus, "plus", context, relative);
        let minus = self.positive_deviation(minus, "minus", context, relative);
        let (plus, minus) = (plus?, minus?);
        let a = (plus + minus) / 2.0;
        let how = format!("limits +{}, -{}", show(plus), show(minus));
        let triangular = matches!(
            table.distribution.as_ref().map(|entry| &entry.value),
            Some(DistributionEntry::Shape(Shape::Triangular))
        );
        if !triangular {
            let mut core = self.shaped(table, Width::Half(a), Shape::Uniform, how, context)?;
            core.location = Location::Shift((plus - minus) / 2.0);
            return Some(core);
        }
        // A triangle with its mode at the value: mean (plus − minus)/3 above it.
        let shift = (plus - minus) / 3.0;
        let u = ((plus * plus + minus * minus + plus * minus) / 18.0).sqrt();
        let distribution = Distribution::Triangular {
            lower: -minus - shift,
            mode: -shift,
            upper: plus - shift,
        };
        self.shape_keys(table, Shape::Triangular);
        let dof = self.dof(table)?;
        Some(Core {
            dof,
            location: Location::Shift(shift),
            ..Core::new(distribution, u, how)
        })
    }

    fn expanded(
        &mut self,
        table: &ComponentTable,
        relative: bool,
        context: &Context<'_>,
    ) -> Option<Core> {
        let certificate = table.certificate.as_ref()?;
        let expanded = certificate.value.U.as_ref()?;
        if certificate.value.refused {
            return None;
        }
        let u_capital = self.positive_deviation(expanded, "U", context, relative)?;
        if let (Some(inner), Some(outer)) = (&certificate.value.dof, &table.dof) {
            return self.refuse(
                Fault::new(
                    DOF,
                    outer.key.clone(),
                    "degrees of freedom are stated twice",
                )
                .label("stated again here")
                .related(inner.key.clone(), "stated in the certificate")
                .help("leave out one"),
            );
        }
        let dof = match &certificate.value.dof {
            Some(dof) => self.positive_dof(&dof.map(|dof| dof.0))?,
            None => self.dof(table)?,
        };
        let k = self.coverage_factor(&certificate.value, &expanded.span, dof)?;
        let how = format!("U/k = {}/{}", show(u_capital), show(k));
        let mut core = if certificate.value.dof.is_some() && table.distribution.is_none() {
            let distribution = self.t_or_normal(u_capital / k, dof, &certificate.key)?;
            Core::new(distribution, u_capital / k, how)
        } else {
            self.shaped(table, Width::U(u_capital / k), Shape::Normal, how, context)?
        };
        core.dof = dof;
        Some(core)
    }

    /// k as stated, or t_p(ν) from the stated coverage probability.
    fn coverage_factor(
        &mut self,
        table: &CertificateTable,
        place: &std::ops::Range<usize>,
        dof: f64,
    ) -> Option<f64> {
        let k = match &table.k {
            Some(k) => Some(self.positive(k, "k")?),
            None => None,
        };
        let from_p = match &table.p {
            Some(p) => Some(student_t_two_sided_quantile(self.probability(p)?, dof)),
            None => None,
        };
        match (k, from_p) {
            (Some(k), None) => Some(k),
            (None, Some(t)) => Some(t),
            // Certificates print k with two or three digits and p as "approximately 95 %".
            (Some(k), Some(t)) if (k / t - 1.0).abs() <= 0.03 => Some(k),
            (Some(k), Some(t)) => {
                let (k_key, p_key) = (table.k.as_ref()?.key.clone(), table.p.as_ref()?.key.clone());
                self.refuse(
                    Fault::new(
                        K_AND_P,
                        k_key,
                        format!(
                            "k = {k} does not belong to the stated p, which gives k = {}",
                            show(t)
                        ),
                    )
                    .label(format!("k = {k}"))
                    .related(p_key, format!("k = {} follows from p", show(t)))
                    .help("leave out the one that is not on the certificate"),
                )
            }
            (None, None) => self.refuse(
                Fault::new(
                    NO_COVERAGE_FACTOR,
                    place.clone(),
                    "U has no coverage factor",
                )
                .label("k or p is missing")
                .help(
                    "add the k of the certificate (k = 2), or its coverage probability (p = 0.95)",
                ),
            ),
        }
    }

    /// A number that must be a probability.
    pub(super) fn probability(&mut self, p: &Stated<f64>) -> Option<f64> {
        if p.value > 0.0 && p.value < 1.0 {
            return Some(p.value);
        }
        let fault = Fault::new(
            PROBABILITY,
            p.span.clone(),
            format!("a probability of {}", p.value),
        )
        .label("expected a number between 0 and 1");
        self.refuse(if p.value > 1.0 && p.value < 100.0 {
            fault.help(format!("for {} % write {}", p.value, show(p.value / 100.0)))
        } else {
            fault
        })
    }

    fn specification(
        &mut self,
        stated: &Stated<SpecificationTable>,
        context: &Context<'_>,
    ) -> Option<f64> {
        let table = &stated.value;
        if table.refused {
            return None;
        }
        for (key, present, partner, other) in [
            ("range", table.range.is_some(), "span", table.span.is_some()),
            (
                "counts",
                table.counts.is_some(),
                "step",
                table.step.is_some(),
            ),
        ] {
            if present != other {
                let (has, lacks) = if present {
                    (key, partner)
                } else {
                    (partner, key)
                };
                return self.refuse(
                    Fault::new(
                        MISSING_KEY,
                        stated.span.clone(),
                        format!("the specification has `{has}` and not `{lacks}`"),
                    )
                    .label(format!("`{lacks}` is missing")),
                );
            }
        }
        let reading = match &table.reading {
            Some(part) => self.part(part, "reading", context.value.map(f64::abs), context)?,
            None => 0.0,
        };
        let range = match (&table.range, &table.span) {
            (Some(part), Some(span)) => {
                let span = self.positive_deviation(span, "span", context, false)?;
                self.part(part, "range", Some(span), context)?
            }
            _ => 0.0,
        };
        let counts = match (&table.counts, &table.step) {
            (Some(counts), Some(step)) => {
                self.positive(counts, "counts")?
                    * self.positive_deviation(step, "step", context, false)?
            }
            _ => 0.0,
        };
        let fixed = match &table.fixed {
            Some(fixed) => self.positive_deviation(fixed, "fixed", context, false)?,
            None => 0.0,
        };
        let a = reading + range + counts + fixed;
        if a > 0.0 {
            return Some(a);
        }
        self.refuse(
            Fault::new(
                NOT_POSITIVE,
                stated.span.clone(),
                format!("the specification of {} allows no deviation", context.owner),
            )
            .label("all parts are zero"),
        )
    }

    /// A stated fraction of the reading or of the range.
    fn part(
        &mut self,
        amount: &Stated<Amount>,
        key: &str,
        whole: Option<f64>,
        context: &Context<'_>,
    ) -> Option<f64> {
        if amount.value.unit.is_none() {
            return self.refuse(
                Fault::new(
                    UNIT,
                    amount.span.clone(),
                    format!("`{key}` does not say whether it is a fraction or a percentage"),
                )
                .label("a unit is missing")
                .help(format!(
                    "write {key} = \"{} %\" or \"{} ppm\"",
                    amount.value.number, amount.value.number
                )),
            );
        }
        // The part is relative to `whole`, whatever the unit of the input.
        let of_whole = Context {
            value: whole,
            ..context.clone()
        };
        if amount.value.number == 0.0 || whole == Some(0.0) {
            return Some(0.0);
        }
        self.positive_deviation(amount, key, &of_whole, true)
    }

    fn quantisation(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let (Some(bits), Some(range)) = (&table.bits, &table.range) else {
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    context.place.clone(),
                    format!("the quantiser of {} has no range", context.owner),
                )
                .label("`range` is missing")
                .help("add the ends of its range: range = [0, 10] or range = [-5, 5]"),
            );
        };
        let [lower, upper] = self.two(range, "range", context)?;
        if lower >= upper {
            return self.refuse(
                Fault::new(
                    LIMITS,
                    range.span.clone(),
                    format!("the range is {lower} to {upper}"),
                )
                .label("lower end first"),
            );
        }
        if !(1..=64).contains(&bits.value) {
            return self.refuse(
                Fault::new(
                    NOT_POSITIVE,
                    bits.span.clone(),
                    format!("a quantiser of {} bits", bits.value),
                )
                .label("expected 1 to 64"),
            );
        }
        let step = (upper - lower) / 2f64.powf(bits.value as f64);
        let how = format!(
            "a = q/2, q = {}/2^{} = {}",
            show(upper - lower),
            bits.value,
            show(step)
        );
        self.shaped(table, Width::Half(step / 2.0), Shape::Uniform, how, context)
    }
}

/// Normal when a coverage probability is stated, else rectangular (GUM 4.3.7).
fn default_shape(table: &ComponentTable) -> Shape {
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

fn missing_parameter(key: &str, meaning: &str, context: &Context<'_>) -> Fault {
    Fault::new(
        MISSING_KEY,
        context.place.clone(),
        format!("the distribution of {} needs `{key}`", context.owner),
    )
    .label(format!("`{key}` is missing"))
    .help(format!("add `{key}`: {meaning}"))
}
