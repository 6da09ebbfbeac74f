//! Correlation coefficients, and the joint distributions of correlated components.

use std::ops::Range;

use nalgebra::DMatrix;

use super::Checker;
use super::draft::show;
use super::register::{Register, t_dof};
use crate::budget::faults::{
    CORRELATION_TWICE, MISSING_KEY, NOT_A_CORRELATION, NOT_SEMIDEFINITE, PAIR_TWICE, SELF_PAIR,
    UNATTAINABLE, UNKNOWN_NAME, WRONG_TYPE,
};
use crate::budget::table::Stated;
use crate::budget::tables::{CorrelationTable, FileTable};
use crate::budget::{Group, Law};
use crate::distribution::{Distribution, latent_correlation};
use crate::fault::{Fault, nearest};

/// Eigenvalues down to this are zero within the rounding of the arithmetic.
const ROUNDING: f64 = 1e-9;

/// A stated correlation, spread over the components of its two sides.
#[derive(Debug, Clone)]
pub(super) struct Statement {
    pub names: [String; 2],
    pub r: f64,
    pub place: Range<usize>,
    /// Correlation of the sides' own parts = `scale`·r + `offset`.
    pub scale: f64,
    pub offset: f64,
    /// Component pairs, and the part of the correlation that falls on them.
    pub pairs: Vec<(usize, usize, f64)>,
}

/// One side of a correlation: components with their shares of the side's standard uncertainty.
struct Side {
    members: Vec<(usize, f64)>,
    /// Standard uncertainty of the side's own components.
    own: f64,
    /// Standard uncertainty with all causes.
    total: f64,
    place: Option<usize>,
}

impl Checker<'_> {
    /// The groups of correlated components.
    pub(super) fn groups(&mut self, file: &FileTable, register: &mut Register) -> Vec<Group> {
        let mut statements = Vec::new();
        let mut groups = self.joint_groups(file, register, &mut statements);
        let before = self.faults.len();
        for stated in file
            .correlation
            .as_ref()
            .map_or(&[][..], |list| &list.value.0)
        {
            let statement = self.statement(stated, register);
            statements.extend(statement);
        }
        self.twice(&statements);
        self.outside_groups(&statements, &groups, register);
        if self.faults.len() > before {
            return groups;
        }
        for members in connected(&statements, register.components.len()) {
            groups.extend(self.group(members, &statements, register));
        }
        groups
    }

    fn statement(
        &mut self,
        stated: &Stated<CorrelationTable>,
        register: &Register,
    ) -> Option<Statement> {
        let table = &stated.value;
        let (Some(between), Some(r)) = (&table.between, &table.r) else {
            if table.refused {
                return None;
            }
            let missing = if table.between.is_none() {
                "between"
            } else {
                "r"
            };
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    stated.span.clone(),
                    format!("the correlation lacks `{missing}`"),
                )
                .label(format!("`{missing}` is missing"))
                .help("write between = [\"a\", \"b\"] and r = 0.3"),
            );
        };
        let [first, second] = between.value.as_slice() else {
            return self.refuse(
                Fault::new(
                    WRONG_TYPE,
                    between.span.clone(),
                    format!("a correlation between {} quantities", between.value.len()),
                )
                .label("expected two names")
                .help("state each pair by itself, or a matrix in [[joint]]"),
            );
        };
        self.pair(first, second, r, register)
    }

    /// A statement about two names.
    pub(super) fn pair(
        &mut self,
        first: &Stated<String>,
        second: &Stated<String>,
        r: &Stated<f64>,
        register: &Register,
    ) -> Option<Statement> {
        let sides = (self.side(first, register), self.side(second, register));
        if !(-1.0..=1.0).contains(&r.value) {
            return self.refuse(
                Fault::new(
                    NOT_A_CORRELATION,
                    r.span.clone(),
                    format!("a correlation coefficient of {}", r.value),
                )
                .label("expected a number from -1 to 1"),
            );
        }
        let (a, b) = (sides.0?, sides.1?);
        if first.value == second.value
            || a.members
                .iter()
                .any(|(m, _)| b.members.iter().any(|(n, _)| m == n))
        {
            return self.refuse(
                Fault::new(
                    SELF_PAIR,
                    second.span.clone(),
                    format!("{} is correlated with itself", first.value),
                )
                .label("the same quantity")
                .related(first.span.clone(), "as this one"),
            );
        }
        let common = register.covariance(a.place, b.place);
        let product = a.own * b.own;
        let (scale, offset) = (a.total * b.total / product, -common / product);
        let own = scale * r.value + offset;
        if own.abs() > 1.0 + ROUNDING {
            return self.refuse(
                Fault::new(
                    NOT_A_CORRELATION,
                    r.span.clone(),
                    format!(
                        "r = {} cannot be reached beside the shared sources of {} and {}",
                        r.value, first.value, second.value
                    ),
                )
                .label(format!(
                    "the shared sources alone give r = {}",
                    show(common / (a.total * b.total))
                ))
                .help("leave the correlation out if it comes from those sources"),
            );
        }
        let pairs = a
            .members
            .iter()
            .flat_map(|(m, v)| b.members.iter().map(move |(n, w)| (*m, *n, v * w)))
            .collect();
        let place = first.span.start..r.span.end.max(second.span.end);
        let place = if place.start < r.span.start {
            r.span.clone()
        } else {
            place
        };
        Some(Statement {
            names: [first.value.clone(), second.value.clone()],
            r: r.value,
            place,
            scale,
            offset,
            pairs,
        })
    }

    fn side(&mut self, name: &Stated<String>, register: &Register) -> Option<Side> {
        let Some(members) = register.lookup(&name.value) else {
            if register.incomplete && name.value.contains(['.', '[']) {
                return None;
            }
            return self.refuse(unknown(name, register));
        };
        let u = |index: &usize| {
            register
                .components
                .get(*index)
                .map_or(0.0, |component| component.u)
        };
        let own = members
            .iter()
            .map(|index| u(index) * u(index))
            .sum::<f64>()
            .sqrt();
        if own <= 0.0 {
            if register.incomplete {
                return None;
            }
            return self.refuse(
                Fault::new(
                    UNKNOWN_NAME,
                    name.span.clone(),
                    format!(
                        "{} has no uncertainty of its own to be correlated",
                        name.value
                    ),
                )
                .label("its uncertainty comes from shared sources, whose correlation is known"),
            );
        }
        let place = register
            .inputs
            .iter()
            .position(|input| input.name == name.value);
        let total = match place {
            Some(place) => register
                .covariance(Some(place), Some(place))
                .mul_add(1.0, own * own)
                .sqrt(),
            None => own,
        };
        let members = members
            .iter()
            .map(|index| (*index, u(index) / own))
            .collect();
        Some(Side {
            members,
            own,
            total,
            place,
        })
    }

    /// Reports pairs that are stated more than once.
    fn twice(&mut self, statements: &[Statement]) {
        for (index, later) in statements.iter().enumerate() {
            let same = |earlier: &&Statement| {
                earlier.pairs.iter().any(|(a, b, _)| {
                    later
                        .pairs
                        .iter()
                        .any(|(c, d, _)| (a, b) == (c, d) || (a, b) == (d, c))
                })
            };
            if let Some(earlier) = statements[..index].iter().find(same) {
                let [a, b] = &later.names;
                self.faults.push(
                    Fault::new(
                        PAIR_TWICE,
                        later.place.clone(),
                        format!("the correlation of {a} and {b} is stated twice"),
                    )
                    .label("second statement")
                    .related(earlier.place.clone(), "first statement")
                    .help("leave out one"),
                );
            }
        }
    }

    /// Reports correlations of components that a joint statement already correlates.
    fn outside_groups(&mut self, statements: &[Statement], groups: &[Group], register: &Register) {
        for statement in statements {
            let taken = statement
                .pairs
                .iter()
                .flat_map(|(a, b, _)| [*a, *b])
                .find(|index| groups.iter().any(|group| group.members.contains(index)));
            if let Some(component) = taken.and_then(|index| register.components.get(index)) {
                self.faults.push(
                    Fault::new(
                        CORRELATION_TWICE,
                        statement.place.clone(),
                        format!("{} is already in a [[joint]] statement", component.name),
                    )
                    .label("correlated again here")
                    .help("put all its correlations into one matrix, or leave out this one"),
                );
            }
        }
    }

    fn group(
        &mut self,
        members: Vec<usize>,
        statements: &[Statement],
        register: &Register,
    ) -> Option<Group> {
        let own: Vec<&Statement> = statements
            .iter()
            .filter(|s| s.pairs.iter().any(|(a, ..)| members.contains(a)))
            .collect();
        let r: Vec<f64> = own.iter().map(|statement| statement.r).collect();
        let correlation = matrix(&members, &own, &r);
        let smallest = smallest_eigenvalue(&correlation);
        if smallest < -ROUNDING {
            return self.refuse(contradiction(&members, &own, &r, smallest));
        }
        let place = own
            .first()
            .map_or(0..0, |statement| statement.place.clone());
        self.join(members, correlation, register, &place)
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
            .all(|d| matches!(d, Distribution::Normal { .. }))
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
            correlation,
            law,
            dof,
        })
    }

    fn latent(
        &mut self,
        components: &[&crate::budget::Component],
        correlation: &DMatrix<f64>,
        place: &Range<usize>,
    ) -> Option<DMatrix<f64>> {
        let mut latent = DMatrix::identity(components.len(), components.len());
        for (i, a) in components.iter().enumerate() {
            for (j, b) in components.iter().enumerate().skip(i + 1) {
                let r = correlation[(i, j)].clamp(-1.0, 1.0);
                match latent_correlation(&a.distribution, &b.distribution, r) {
                    Ok(rho) => {
                        latent[(i, j)] = rho;
                        latent[(j, i)] = rho;
                    }
                    Err(reason) => {
                        return self.refuse(
                            Fault::new(UNATTAINABLE, place.clone(), format!("{} and {} cannot have r = {}", a.name, b.name, show(r)))
                                .label(reason.to_string())
                                .help("lower the correlation, or state the common cause as a [source.NAME]"),
                        );
                    }
                }
            }
        }
        let smallest = smallest_eigenvalue(&latent);
        if smallest >= -ROUNDING {
            return Some(latent);
        }
        self.refuse(
            Fault::new(
                UNATTAINABLE,
                place.clone(),
                "no joint distribution with these shapes has these correlations",
            )
            .label(format!(
                "smallest eigenvalue of the latent correlation matrix {}",
                show(smallest)
            ))
            .help("lower the correlations a little, or state the common cause as a [source.NAME]"),
        )
    }
}

fn scale(distribution: &Distribution) -> f64 {
    match distribution {
        Distribution::StudentT { scale, .. } => *scale,
        other => other.standard_deviation().unwrap_or(0.0),
    }
}

fn unknown(name: &Stated<String>, register: &Register) -> Fault {
    let fault = Fault::new(
        UNKNOWN_NAME,
        name.span.clone(),
        format!("nothing is called \"{}\"", name.value),
    )
    .label("not an input, a source or a component");
    if let Some(entry) = register
        .entries
        .iter()
        .find(|entry| entry.vector && entry.name == name.value)
    {
        return fault.help(format!(
            "{0} is a vector: name its elements, \"{0}[1]\" and so on",
            entry.name
        ));
    }
    let names = register.names();
    match nearest(&name.value, names.iter().map(String::as_str)) {
        Some(near) => fault.help(format!("did you mean \"{near}\"?")),
        None => fault.help(format!("known names: {}", names.join(", "))),
    }
}

impl Register {
    /// Covariance of two inputs that their shared causes make; of one input, the part of its variance
    /// that comes from them.
    fn covariance(&self, a: Option<usize>, b: Option<usize>) -> f64 {
        let (Some(a), Some(b)) = (a, b) else {
            return 0.0;
        };
        let (Some(first), Some(second)) = (self.inputs.get(a), self.inputs.get(b)) else {
            return 0.0;
        };
        let own = self.own(a);
        let shared = first
            .terms
            .iter()
            .filter(|term| a != b || !own.contains(&term.component));
        shared
            .filter_map(|term| {
                let other = second
                    .terms
                    .iter()
                    .find(|other| other.component == term.component)?;
                let u = self.components.get(term.component)?.u;
                Some(term.coefficient * other.coefficient * u * u)
            })
            .sum()
    }
}

/// The sets of components that statements connect, each in ascending order.
fn connected(statements: &[Statement], components: usize) -> Vec<Vec<usize>> {
    let mut root: Vec<usize> = (0..components).collect();
    let find = |root: &[usize], mut index: usize| {
        while root[index] != index {
            index = root[index];
        }
        index
    };
    for (a, b, _) in statements.iter().flat_map(|statement| &statement.pairs) {
        let (a, b) = (find(&root, *a), find(&root, *b));
        root[a.max(b)] = a.min(b);
    }
    let all = (0..components)
        .map(|index| find(&root, index))
        .collect::<Vec<_>>();
    let sets = (0..components).filter(|index| all[*index] == *index);
    let members = |set: usize| {
        (0..components)
            .filter(|index| all[*index] == set)
            .collect::<Vec<_>>()
    };
    sets.map(members).filter(|set| set.len() > 1).collect()
}

/// The correlation matrix of the members, with the statements' coefficients replaced by `r`.
fn matrix(members: &[usize], statements: &[&Statement], r: &[f64]) -> DMatrix<f64> {
    let mut matrix = DMatrix::identity(members.len(), members.len());
    for (statement, r) in statements.iter().zip(r) {
        let own = statement.scale * r + statement.offset;
        for (a, b, weight) in &statement.pairs {
            let index = |wanted| members.iter().position(|member| member == wanted);
            if let (Some(i), Some(j)) = (index(a), index(b)) {
                matrix[(i, j)] = own * weight;
                matrix[(j, i)] = own * weight;
            }
        }
    }
    matrix
}

/// Smallest eigenvalue of a symmetric matrix.
pub(super) fn smallest_eigenvalue(matrix: &DMatrix<f64>) -> f64 {
    matrix.clone().symmetric_eigenvalues().min()
}

/// The fault for correlations that cannot exist together, with the nearest mend if one coefficient
/// can be blamed.
fn contradiction(members: &[usize], statements: &[&Statement], r: &[f64], smallest: f64) -> Fault {
    let mends = (0..r.len()).filter_map(|index| {
        let mended = mend(members, statements, r, index)?;
        Some((index, mended, (mended - r[index]).abs()))
    });
    let best = mends.min_by(|a, b| a.2.total_cmp(&b.2));
    let blamed = best.map_or(r.len() - 1, |(index, ..)| index);
    let [a, b] = &statements[blamed].names;
    let mut fault = Fault::new(
        NOT_SEMIDEFINITE,
        statements[blamed].place.clone(),
        "these correlation coefficients cannot occur together",
    )
    .label(format!(
        "smallest eigenvalue of the correlation matrix {}",
        show(smallest)
    ));
    for (index, other) in statements
        .iter()
        .enumerate()
        .filter(|(index, _)| *index != blamed)
    {
        fault = fault.related(
            other.place.clone(),
            format!("r({}, {}) = {}", other.names[0], other.names[1], r[index]),
        );
    }
    match best {
        Some((index, mended, _)) => fault.help(format!(
            "check the signs; with the others as they are, the nearest possible r({a}, {b}) is {}, not {}",
            show(mended), r[index]
        )),
        None => fault.help("check the signs; changing a single coefficient does not mend it"),
    }
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
    let (mut bad, mut good) = (r[index], peak);
    for _ in 0..60 {
        let middle = (bad + good) / 2.0;
        if smallest(middle) < 0.0 {
            bad = middle
        } else {
            good = middle
        }
    }
    let inwards = if good > r[index] {
        (good * 1000.0).ceil()
    } else {
        (good * 1000.0).floor()
    };
    Some((inwards / 1000.0).clamp(-1.0, 1.0))
}
