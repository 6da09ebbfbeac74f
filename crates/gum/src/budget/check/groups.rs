//! Groups of correlated components: their matrix must exist, and so must a joint distribution.

use std::ops::Range;

use nalgebra::DMatrix;

use super::checker::Checker;
use super::draft::show;
use super::nearest::within_rounding;
use super::register::{Register, t_dof};
use super::statement::{ROUNDING, Statement};
use crate::budget::faults::{NOT_SEMIDEFINITE, UNATTAINABLE};
use crate::budget::{Component, Group, Law};
use crate::elimination::is_definite;
use gumption_core::distribution::{CopulaError, Distribution, StudentT, latent_correlation};
use gumption_core::special::roots::last;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

impl Checker<'_> {
    pub(super) fn group(
        &mut self,
        members: Vec<usize>,
        statements: &[Statement],
        register: &Register,
    ) -> Option<Group> {
        let places = places(&members);
        let own: Vec<&Statement> = statements
            .iter()
            .filter(|s| s.pairs().any(|(a, ..)| place(&places, a).is_some()))
            .collect();
        let r: Vec<f64> = own.iter().map(|statement| statement.r).collect();
        let correlation = matrix(&members, &own, &r);
        // Without a statement only a common ν joins them, and the matrix is the identity.
        let negative = match own.is_empty() {
            true => None,
            false => negative_eigenvalue(&correlation),
        };
        let correlation = match negative {
            None => correlation,
            Some(smallest) => match within_rounding(&correlation, &self.halves(&members, &own)) {
                Some(nearest) => {
                    self.remark_rounded(smallest, &correlation, &nearest);
                    nearest
                }
                None => return self.refuse(contradiction(&members, &own, &r, smallest)),
            },
        };
        let place = own.first().map_or(0..0, |statement| statement.place());
        self.join(members, correlation, register, &place)
    }

    /// Half a unit of the last digit of each coefficient, as it falls on the components.
    fn halves(&self, members: &[usize], statements: &[&Statement]) -> DMatrix<f64> {
        let places = places(members);
        let mut halves = DMatrix::zeros(members.len(), members.len());
        for statement in statements {
            let half = self.half_of(statement.r, statement.coefficient.clone());
            for (a, b, share) in statement.pairs() {
                let (Some(i), Some(j)) = (place(&places, a), place(&places, b)) else {
                    continue;
                };
                let half = (half * statement.scale() * share).abs();
                halves[(i, j)] = half;
                halves[(j, i)] = half;
            }
        }
        // The diagonal is one but for the last bits.
        halves.map(|half| half + 1e-9)
    }

    /// Half a unit of the last digit of an element of a matrix; 0 of a whole number.
    pub(super) fn half_of(&self, value: f64, place: Range<usize>) -> f64 {
        match value.fract() == 0.0 {
            true => 0.0,
            false => self.half_digit(&Stated {
                value,
                key: place.clone(),
                span: place,
            }),
        }
    }

    /// Tells that coefficients were moved within their rounding.
    pub(super) fn remark_rounded(
        &mut self,
        smallest: f64,
        stated: &DMatrix<f64>,
        nearest: &DMatrix<f64>,
    ) {
        let (smallest, moved) = (show(smallest), format!("{:.1e}", (nearest - stated).amax()));
        self.remark(say!("The stated correlation coefficients are rounded, and by that alone their matrix has the negative eigenvalue {smallest}, which no quantities have. The nearest possible matrix is used (Higham 2002); it differs from the stated one by at most {moved}, within the last digits that are stated."));
    }

    /// The joint distribution of correlated components.
    pub(super) fn join(
        &mut self,
        members: Vec<usize>,
        correlation: DMatrix<f64>,
        register: &Register,
        place: &Range<usize>,
    ) -> Option<Group> {
        let components: Vec<_> = members
            .iter()
            .filter_map(|index| register.components.get(*index))
            .collect();
        let dof = components
            .first()
            .map(|component| component.dof)
            .filter(|dof| dof.is_finite());
        let dof = dof.filter(|dof| components.iter().all(|component| component.dof == *dof));
        let distributions: Vec<&Distribution> = components
            .iter()
            .map(|component| &component.distribution)
            .collect();
        let t = distributions
            .first()
            .and_then(|distribution| t_dof(distribution));
        let law = if distributions
            .iter()
            .all(|d| matches!(d, Distribution::Normal(_)))
        {
            Law::Normal
        } else if let Some(dof) =
            t.filter(|dof| distributions.iter().all(|d| t_dof(d) == Some(*dof)))
        {
            let scale = distributions.iter().map(|d| scale(d)).collect();
            Law::StudentT { dof, scale }
        } else {
            Law::GaussianCopula {
                latent: self.latent(&components, &correlation, place)?,
            }
        };
        Some(Group {
            members,
            correlation: correlation.into(),
            law,
            dof,
        })
    }

    fn latent(
        &mut self,
        components: &[&Component],
        correlation: &DMatrix<f64>,
        place: &Range<usize>,
    ) -> Option<DMatrix<f64>> {
        let mut latent = DMatrix::identity(components.len(), components.len());
        for (i, a) in components.iter().enumerate() {
            for (j, b) in components.iter().enumerate().skip(i + 1) {
                let r = correlation[(i, j)].clamp(-1.0, 1.0);
                if r == 0.0 {
                    continue;
                }
                match latent_correlation(&a.distribution, &b.distribution, r) {
                    Ok(rho) => {
                        latent[(i, j)] = rho;
                        latent[(j, i)] = rho;
                    }
                    Err(reason) => {
                        // No other r would do for what has no standard deviation.
                        let help = match reason {
                            CopulaError::NoCorrelation => say!(
                                "t distributions have no standard deviation for ν ≤ 2: correlate the components that have the cause in common, between = [\"A.calibration\", \"B.calibration\"], or state it as a [source.NAME]"
                            ),
                            _ => say!(
                                "lower the correlation, or state the common cause as a [source.NAME]"
                            ),
                        };
                        return self.refuse(
                            Fault::new(
                                UNATTAINABLE,
                                place.clone(),
                                say!("{} and {} cannot have r = {}", a.name, b.name, show(r)),
                            )
                            .label(reason.said())
                            .help(help),
                        );
                    }
                }
            }
        }
        let Some(smallest) = negative_eigenvalue(&latent) else {
            return Some(latent);
        };
        self.refuse(
            Fault::new(
                UNATTAINABLE,
                place.clone(),
                say!("no joint distribution with these shapes has these correlations"),
            )
            .label(say!(
                "smallest eigenvalue of the latent correlation matrix {}",
                show(smallest)
            ))
            .help(say!(
                "lower the correlations a little, or state the common cause as a [source.NAME]"
            )),
        )
    }
}

fn scale(distribution: &Distribution) -> f64 {
    match distribution {
        Distribution::StudentT(StudentT { scale, .. }) => *scale,
        other => other.standard_deviation().unwrap_or(0.0),
    }
}

/// The sets of components that statements or a common ν connect, each in ascending order.
pub(super) fn connected(
    statements: &[Statement],
    families: &[Vec<usize>],
    components: usize,
) -> Vec<Vec<usize>> {
    let mut root: Vec<usize> = (0..components).collect();
    // Halves the path to the root on the way.
    let find = |root: &mut [usize], mut index: usize| {
        while root[index] != index {
            root[index] = root[root[index]];
            index = root[index];
        }
        index
    };
    let stated = statements
        .iter()
        .flat_map(|statement| statement.pairs().map(|(a, b, _)| (a, b)));
    let related = families
        .iter()
        .flat_map(|family| family.windows(2).map(|pair| (pair[0], pair[1])));
    for (a, b) in stated.chain(related) {
        let (a, b) = (find(&mut root, a), find(&mut root, b));
        root[a.max(b)] = a.min(b);
    }
    let mut sets = vec![Vec::new(); components];
    for index in 0..components {
        // A set has the place of its first component, which as a rule is alone.
        let first = find(&mut root, index);
        if first != index {
            if sets[first].is_empty() {
                sets[first].push(first);
            }
            sets[first].push(index);
        }
    }
    sets.retain(|set| !set.is_empty());
    sets
}

/// The correlation matrix of the members (in ascending order), with the statements' coefficients replaced by `r`.
fn matrix(members: &[usize], statements: &[&Statement], r: &[f64]) -> DMatrix<f64> {
    let places = places(members);
    let mut matrix = DMatrix::identity(members.len(), members.len());
    for (statement, r) in statements.iter().zip(r) {
        let own = statement.scale() * r + statement.offset;
        for (a, b, weight) in statement.pairs() {
            if let (Some(i), Some(j)) = (place(&places, a), place(&places, b)) {
                // Statements go along a row of a stated matrix, which is a column of the upper triangle here.
                matrix[(i.min(j), i.max(j))] = own * weight;
            }
        }
    }
    matrix.fill_lower_triangle_with_upper_triangle();
    matrix
}

/// Where each component stands among the members.
fn places(members: &[usize]) -> Vec<Option<usize>> {
    let mut places = vec![None; members.last().map_or(0, |last| last + 1)];
    for (place, member) in members.iter().enumerate() {
        places[*member] = Some(place);
    }
    places
}

fn place(places: &[Option<usize>], component: usize) -> Option<usize> {
    places.get(component).copied().flatten()
}

/// The smallest eigenvalue of a correlation matrix, if it is negative beyond rounding.
pub(super) fn negative_eigenvalue(matrix: &DMatrix<f64>) -> Option<f64> {
    // Whether R + ROUNDING·1 has a factor is found in a fraction of the time that eigenvalues take.
    if is_definite(matrix, ROUNDING) {
        return None;
    }
    Some(smallest_eigenvalue(matrix)).filter(|smallest| *smallest < -ROUNDING)
}

/// Smallest eigenvalue of a symmetric matrix.
fn smallest_eigenvalue(matrix: &DMatrix<f64>) -> f64 {
    matrix.clone().symmetric_eigenvalues().min()
}

/// The fault for correlations that cannot exist together, with the nearest mend if one coefficient
/// can be blamed.
fn contradiction(members: &[usize], statements: &[&Statement], r: &[f64], smallest: f64) -> Fault {
    if let Some(alike) = alike(statements, r, smallest) {
        return alike;
    }
    // The search for the mend of one coefficient takes some hundred eigenvalue problems for each.
    let tried = if members.len() * r.len() <= MOST_TRIED {
        r.len()
    } else {
        0
    };
    let mends = (0..tried).filter_map(|index| {
        let mended = mend(members, statements, r, index)?;
        Some((index, mended, (mended - r[index]).abs()))
    });
    let best = mends.min_by(|a, b| a.2.total_cmp(&b.2));
    let blamed = best.map_or(r.len() - 1, |(index, ..)| index);
    let [a, b] = statements[blamed].names();
    let mut fault = Fault::new(
        NOT_SEMIDEFINITE,
        statements[blamed].place(),
        say!("these correlation coefficients cannot occur together"),
    )
    .label(say!(
        "smallest eigenvalue of the correlation matrix {}",
        show(smallest)
    ));
    for (index, other) in statements
        .iter()
        .enumerate()
        .filter(|(index, _)| *index != blamed)
    {
        let [first, second] = other.names();
        fault = fault.related(
            other.place(),
            say!("r({}, {}) = {}", first, second, r[index]),
        );
    }
    match best {
        Some((index, mended, _)) => fault.help(say!(
            "check the signs; with the others as they are, the nearest possible r({a}, {b}) is {}, not {}",
            show(mended), r[index]
        )),
        None if tried == 0 => fault.help(say!("check the signs, and coefficients near 1 or -1")),
        None => fault.help(say!("check the signs; changing a single coefficient does not mend it")),
    }
}

/// Members times coefficients up to which single coefficients are tried.
const MOST_TRIED: usize = 500;

/// The fault when all coefficients are one statement about several quantities: n quantities that are
/// correlated alike need r ≥ -1/(n - 1).
fn alike(statements: &[&Statement], r: &[f64], smallest: f64) -> Option<Fault> {
    let first = statements.first()?;
    let n = first.whole;
    if n < 3 || statements.len() != n * (n - 1) / 2 || statements.iter().any(|s| s.whole != n) {
        return None;
    }
    let least = -1.0 / (n as f64 - 1.0);
    let fault = Fault::new(
        NOT_SEMIDEFINITE,
        first.place(),
        say!(
            "{n} quantities cannot have r = {} with one another",
            r.first()?
        ),
    )
    .label(say!(
        "smallest eigenvalue of the correlation matrix {}",
        show(smallest)
    ))
    .help(say!(
        "r cannot be less than -1/(n - 1) = {} for n = {n} quantities",
        show(least)
    ));
    Some(fault)
}

/// The possible value of one coefficient nearest to the stated one, rounded inwards to three decimals.
fn mend(members: &[usize], statements: &[&Statement], r: &[f64], index: usize) -> Option<f64> {
    let smallest = |value: f64| {
        let mut changed = r.to_vec();
        changed[index] = value;
        smallest_eigenvalue(&matrix(members, statements, &changed))
    };
    // The smallest eigenvalue is a concave function of the coefficient: find its maximum.
    let (mut low, mut high) = (-1.0_f64, 1.0_f64);
    for _ in 0..80 {
        let third = (high - low) / 3.0;
        if smallest(low + third) < smallest(high - third) {
            low += third
        } else {
            high -= third
        }
    }
    let peak = (low + high) / 2.0;
    if smallest(peak) < -ROUNDING {
        return None;
    }
    let good = last(peak, r[index], |value| smallest(value) >= 0.0);
    let inwards = if good > r[index] {
        (good * 1000.0).ceil()
    } else {
        (good * 1000.0).floor()
    };
    Some((inwards / 1000.0).clamp(-1.0, 1.0))
}
