//! Effective degrees of freedom.
//!
//! Welch–Satterthwaite (GUM G.4.1) holds for independent terms only. Correlated components that
//! share one ν (readings taken together) are one term with their joint variance: a linear
//! combination of them has exactly that ν (Willink 2007). Correlated components of different
//! finite ν have no such rule, and no ν is invented for them. For several measurands the formula
//! of Willink and Hall (2002) takes the place of Welch–Satterthwaite.

use std::collections::BTreeMap;

use gumption_core::statistics::{effective_freedom, norm};
use nalgebra::{DMatrix, DVector};

use super::covariance::{Covariance, Form};
use super::result::Freedom;

/// ν of a combination of components.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Effective {
    /// ν_eff; where it is refused, what the smallest ν of the components concerned would give.
    pub dof: f64,
    pub origin: Origin,
}

/// How ν was found.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Origin {
    /// Independent terms.
    Independent,
    /// Among the terms are correlated components of one common ν.
    Ensembles,
    /// These components are correlated and differ in ν.
    Refused { members: Vec<usize> },
}

impl Effective {
    /// As the evaluation reports it.
    pub(super) fn report(self, name: impl Fn(usize) -> String) -> Freedom {
        match self.origin {
            Origin::Refused { members } => Freedom::Refused {
                lower_bound: self.dof,
                members: members.into_iter().map(name).collect(),
            },
            _ if self.dof.is_infinite() => Freedom::Infinite,
            Origin::Independent => Freedom::WelchSatterthwaite(self.dof),
            Origin::Ensembles => Freedom::Ensembles(self.dof),
        }
    }
}

/// ν of one combination.
pub(super) fn effective(covariance: &Covariance, form: &[(usize, f64)]) -> Effective {
    let active = form.iter().filter(|(_, weight)| *weight != 0.0);
    if active
        .clone()
        .all(|(component, _)| covariance.group(*component).is_none())
    {
        // Each is a term by itself.
        let part = |&(component, weight): &(usize, f64)| (weight, covariance.dof(component));
        return Effective {
            dof: effective_freedom(active.map(part)),
            origin: Origin::Independent,
        };
    }
    let active = active.map(|(component, _)| *component);
    let terms = independent_terms(covariance, active.collect());
    let parts: Vec<(f64, f64)> = terms
        .iter()
        .map(|term| (norm(term.standard(covariance, form).into_iter()), term.dof))
        .collect();
    Effective {
        dof: effective_freedom(parts.iter().copied()),
        origin: origin(&terms),
    }
}

/// ν of the covariance matrix of several combinations. Each is divided by its `scales` first: by u(y) the result
/// does not depend on the units.
pub(super) fn effective_joint(
    covariance: &Covariance,
    forms: &[&Form],
    scales: &[f64],
) -> Effective {
    let terms = terms_of(covariance, forms);
    Effective {
        dof: willink_hall(&parts(covariance, &terms, forms, scales)),
        origin: origin(&terms),
    }
}

/// How the estimated variances of several combinations, each divided by its `scales` first, go together: the correlation
/// coefficients of u²(y_a) and u²(y_b), which the terms k that act on both give in common. The parts of one term are known from the same
/// s², be it of readings taken together or of the residuals of a fit: the variances v_aa and v_bb of its parts have the covariance
/// 2·v_aa·v_bb/ν_k. Zero where a variance is exactly known.
pub(super) fn of_variances(
    covariance: &Covariance,
    forms: &[&Form],
    scales: &[f64],
) -> DMatrix<f64> {
    let count = forms.len();
    let terms = terms_of(covariance, forms);
    let mut sums: DMatrix<f64> = DMatrix::zeros(count, count);
    for (vectors, dof) in parts(covariance, &terms, forms, scales) {
        let squares = |vector: &Vec<f64>| vector.iter().map(|x| x * x).sum::<f64>();
        let own = DVector::from_iterator(count, vectors.iter().map(squares));
        sums.ger(1.0 / dof, &own, &own, 1.0);
    }
    DMatrix::from_fn(count, count, |a, b| {
        match sums[(a, a)] > 0.0 && sums[(b, b)] > 0.0 {
            true => sums[(a, b)] / (sums[(a, a)] * sums[(b, b)]).sqrt(),
            false => 0.0,
        }
    })
}

/// The independent terms of several combinations.
fn terms_of(covariance: &Covariance, forms: &[&Form]) -> Vec<Term> {
    let mut active: Vec<usize> = forms
        .iter()
        .flat_map(|form| {
            form.iter()
                .filter(|(_, weight)| *weight != 0.0)
                .map(|(component, _)| *component)
        })
        .collect();
    active.sort_unstable();
    active.dedup();
    independent_terms(covariance, active)
}

/// The standard coordinates of each combination in each term, with the ν of the term.
fn parts(
    covariance: &Covariance,
    terms: &[Term],
    forms: &[&Form],
    scales: &[f64],
) -> Vec<(Vec<Vec<f64>>, f64)> {
    let of_term = |term: &Term| {
        let vectors = forms.iter().zip(scales).map(|(form, scale)| {
            term.standard(covariance, form)
                .into_iter()
                .map(|value| value / scale)
                .collect()
        });
        (vectors.collect(), term.dof)
    };
    terms.iter().map(of_term).collect()
}

/// Willink and Hall (Metrologia 39 (2002) 361): ν_eff = S(V)/Σ_k S(V_k)/ν_k with
/// S(V) = Σ_{i≤j} (v_ii v_jj + v_ij²), V = Σ_k V_k, for independent terms k. Published for two
/// dimensions; for one it is Welch–Satterthwaite. Every term gives one vector of standard
/// coordinates per measurand.
pub(super) fn willink_hall(parts: &[(Vec<Vec<f64>>, f64)]) -> f64 {
    let count = parts.first().map_or(0, |(vectors, _)| vectors.len());
    let size = norm(
        parts
            .iter()
            .flat_map(|(vectors, _)| vectors.iter().flatten().copied()),
    );
    if size == 0.0 || !size.is_finite() {
        return f64::INFINITY;
    }
    let mut total = vec![0.0; count * count];
    let mut sum = 0.0;
    for (vectors, dof) in parts {
        // Of hundreds of measurands a term mostly acts on a few.
        let acts = |of: &usize| vectors[*of].iter().any(|x| *x != 0.0);
        let active: Vec<usize> = (0..count).filter(acts).collect();
        let mut part = vec![0.0; active.len() * active.len()];
        for (row, i) in active.iter().enumerate() {
            for (column, j) in active.iter().enumerate() {
                let products = vectors[*i]
                    .iter()
                    .zip(&vectors[*j])
                    .map(|(a, b)| (a / size) * (b / size));
                let product: f64 = products.sum();
                part[row * active.len() + column] = product;
                total[i * count + j] += product;
            }
        }
        if dof.is_finite() {
            sum += size_of_matrix(&part, active.len()) / dof;
        }
    }
    size_of_matrix(&total, count) / sum
}

/// Σ_{i≤j} (v_ii v_jj + v_ij²).
fn size_of_matrix(v: &[f64], count: usize) -> f64 {
    let pairs = (0..count).flat_map(|i| (i..count).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| v[i * count + i] * v[j * count + j] + v[i * count + j].powi(2))
        .sum()
}

/// Components that are independent of those of every other term.
struct Term {
    members: Vec<usize>,
    dof: f64,
    agreement: Agreement,
}

/// Whether the members of a term have one ν.
#[derive(PartialEq)]
enum Agreement {
    Single,
    Common,
    Different,
}

impl Term {
    /// Its part of a combination, in standard coordinates.
    fn standard(&self, covariance: &Covariance, form: &[(usize, f64)]) -> Vec<f64> {
        let own: Form = self
            .members
            .iter()
            .filter_map(|member| {
                let place = form
                    .binary_search_by_key(member, |(component, _)| *component)
                    .ok()?;
                Some(form[place])
            })
            .collect();
        if let [(component, weight)] = own[..]
            && covariance.group(component).is_none()
        {
            return vec![weight];
        }
        // A group's coordinates are contiguous; take them all so that vectors can be multiplied.
        let first = self
            .members
            .first()
            .and_then(|member| covariance.group(*member));
        let Some((group, _)) = first else {
            return vec![0.0];
        };
        let range = covariance.correlated(group).coordinates();
        let mut vector = vec![0.0; range.len()];
        for (coordinate, value) in covariance.standard(&own) {
            vector[coordinate - range.start] = value;
        }
        vector
    }
}

/// Splits components into independent terms.
fn independent_terms(covariance: &Covariance, active: Vec<usize>) -> Vec<Term> {
    let mut terms = Vec::new();
    let mut grouped: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for component in active {
        match covariance.group(component) {
            None => terms.push(single(covariance, component)),
            Some((group, _)) => grouped.entry(group).or_default().push(component),
        }
    }
    for (group, members) in grouped {
        match covariance.correlated(group).dof {
            Some(dof) => terms.push(Term {
                members,
                dof,
                agreement: Agreement::Common,
            }),
            None => terms.extend(
                blocks(covariance, members)
                    .into_iter()
                    .map(|b| block(covariance, b)),
            ),
        }
    }
    terms
}

fn single(covariance: &Covariance, component: usize) -> Term {
    Term {
        members: vec![component],
        dof: covariance.dof(component),
        agreement: Agreement::Single,
    }
}

/// A term of components that are all linked by correlation.
fn block(covariance: &Covariance, members: Vec<usize>) -> Term {
    let mut dofs = members.iter().map(|member| covariance.dof(*member));
    if let [only] = members[..] {
        return single(covariance, only);
    }
    let first = dofs.next().unwrap_or(f64::INFINITY);
    let (smallest, alike) = dofs.fold((first, true), |(smallest, alike), dof| {
        (smallest.min(dof), alike && dof == first)
    });
    let agreement = if alike {
        Agreement::Common
    } else {
        Agreement::Different
    };
    Term {
        members,
        dof: smallest,
        agreement,
    }
}

/// Members of one group, divided so that members of different blocks are uncorrelated.
fn blocks(covariance: &Covariance, members: Vec<usize>) -> Vec<Vec<usize>> {
    let linked = |a: usize, b: usize| match (covariance.group(a), covariance.group(b)) {
        (Some((group, i)), Some((_, j))) => covariance.correlated(group).correlation[(i, j)] != 0.0,
        _ => false,
    };
    let mut blocks = Vec::new();
    let mut rest = members;
    while !rest.is_empty() {
        let mut block = vec![rest.remove(0)];
        let mut known = 0;
        while let Some(&member) = block.get(known) {
            let (linked, apart) = rest.into_iter().partition(|other| linked(member, *other));
            block.extend::<Vec<usize>>(linked);
            rest = apart;
            known += 1;
        }
        block.sort_unstable();
        blocks.push(block);
    }
    blocks
}

fn origin(terms: &[Term]) -> Origin {
    let refused: Vec<usize> = terms
        .iter()
        .filter(|term| term.agreement == Agreement::Different)
        .flat_map(|term| term.members.iter().copied())
        .collect();
    if !refused.is_empty() {
        return Origin::Refused { members: refused };
    }
    let ensembles = terms
        .iter()
        .any(|term| term.agreement == Agreement::Common && term.dof.is_finite());
    if ensembles {
        Origin::Ensembles
    } else {
        Origin::Independent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::{Group, Law};
    use nalgebra::DMatrix;

    fn welch_satterthwaite(parts: &[(f64, f64)]) -> f64 {
        effective_freedom(parts.iter().copied())
    }

    const INF: f64 = f64::INFINITY;

    fn group(members: &[usize], entries: &[f64], dof: Option<f64>) -> Group {
        let n = members.len();
        Group {
            members: members.to_vec(),
            correlation: DMatrix::from_row_slice(n, n, entries).into(),
            law: Law::Normal,
            dof,
        }
    }

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance, "{a} is not {b}");
    }

    #[test]
    fn gum_g_4_1_product_of_three() {
        // Relative u 0.25 %, 0.57 %, 0.82 %, ν = 9, 4, 14: published 19.0.
        let dof = welch_satterthwaite(&[(0.25, 9.0), (0.57, 4.0), (0.82, 14.0)]);
        close(dof, 19.0, 0.05);
    }

    #[test]
    fn gum_h_1_end_gauge() {
        // Table H.1 with its sensitivities at full precision: published 16.7.
        let parts = [(25.0, 18.0), (9.7, 25.6), (2.9000, 50.0), (16.6752, 2.0)];
        close(welch_satterthwaite(&parts), 16.7, 0.06);
        // All nine inputs, twelve digits (a regression value of another program).
        let parts = [
            (25.0, 18.0),
            (5.8, 24.0),
            (3.9, 5.0),
            (6.7, 8.0),
            (5e7 * 1e-6 / 3f64.sqrt() * 0.1, 50.0),
            (5e7 * 1.15e-5 * 0.05 / 3f64.sqrt(), 2.0),
        ];
        close(welch_satterthwaite(&parts), 16.7521475092, 2e-8);
    }

    #[test]
    fn a_value_of_a_fitted_line() {
        // Willink (2008) 2.1: (y1+y2+y3)/3 + (y3−y1)/2·⅔ has ν = 25·2/17.
        let u = |c: f64| (c * 0.1, 2.0);
        close(
            welch_satterthwaite(&[u(0.0), u(1.0 / 3.0), u(2.0 / 3.0)]),
            50.0 / 17.0,
            1e-12,
        );
    }

    #[test]
    fn correlated_components_of_equal_dof_are_one_term() {
        for dof in [None, Some(5.0)] {
            let groups = [group(&[0, 1], &[1.0, 0.5, 0.5, 1.0], dof)];
            let covariance = Covariance::from_parts(vec![1.0, 1.0], vec![5.0, 5.0], &groups);
            let form = covariance.form([(0, 1.0), (1, 1.0)]);
            let found = effective(&covariance, &form);
            close(found.dof, 5.0, 1e-12);
            assert_eq!(found.origin, Origin::Ensembles);
        }
    }

    #[test]
    fn different_dof_under_correlation_are_refused() {
        let groups = [group(&[0, 1], &[1.0, 0.5, 0.5, 1.0], None)];
        let covariance = Covariance::from_parts(vec![1.0; 3], vec![5.0, 9.0, INF], &groups);
        let both = covariance.form([(0, 1.0), (1, 1.0)]);
        let found = effective(&covariance, &both);
        assert_eq!(
            found.origin,
            Origin::Refused {
                members: vec![0, 1]
            }
        );
        close(found.dof, 5.0, 1e-12);
        // An independent term beside them: (1 + 3)²/(3²/5).
        let more = covariance.form([(0, 1.0), (1, 1.0), (2, 1.0)]);
        close(effective(&covariance, &more).dof, 16.0 / (9.0 / 5.0), 1e-12);
        // One of them alone is an ordinary term.
        let one = covariance.form([(1, 1.0), (2, 1.0)]);
        let found = effective(&covariance, &one);
        assert_eq!(found.origin, Origin::Independent);
        close(found.dof, 4.0 * 9.0, 1e-12);
    }

    #[test]
    fn uncorrelated_members_of_a_group_are_independent_terms() {
        // a–b–c is a chain: without b, a and c are independent.
        let entries = [1.0, 0.5, 0.0, 0.5, 1.0, 0.5, 0.0, 0.5, 1.0];
        let covariance = Covariance::from_parts(
            vec![1.0; 3],
            vec![4.0, 6.0, 8.0],
            &[group(&[0, 1, 2], &entries, None)],
        );
        let found = effective(&covariance, &covariance.form([(0, 1.0), (2, 1.0)]));
        assert_eq!(found.origin, Origin::Independent);
        close(
            found.dof,
            welch_satterthwaite(&[(1.0, 4.0), (1.0, 8.0)]),
            1e-12,
        );
    }

    #[test]
    fn infinite_degrees_of_freedom() {
        let groups = [group(&[0, 1], &[1.0, 0.5, 0.5, 1.0], None)];
        let covariance = Covariance::from_parts(vec![1.0; 2], vec![INF; 2], &groups);
        let found = effective(&covariance, &covariance.form([(0, 1.0), (1, 1.0)]));
        assert_eq!(found.clone().report(|i| i.to_string()), Freedom::Infinite);
        assert!(effective(&covariance, &Form::new()).dof.is_infinite());
    }

    /// Covariance of the mean of pairs of readings.
    fn of_mean(readings: &[[f64; 2]]) -> (Vec<f64>, DMatrix<f64>) {
        let n = readings.len() as f64;
        let mean = |k: usize| readings.iter().map(|r| r[k]).sum::<f64>() / n;
        let mean = [mean(0), mean(1)];
        let s = |a: usize, b: usize| {
            let sum: f64 = readings
                .iter()
                .map(|r| (r[a] - mean[a]) * (r[b] - mean[b]))
                .sum();
            sum / (n - 1.0) / n
        };
        let u = vec![s(0, 0).sqrt(), s(1, 1).sqrt()];
        let r = s(0, 1) / (u[0] * u[1]);
        (u, DMatrix::from_row_slice(2, 2, &[1.0, r, r, 1.0]))
    }

    #[test]
    fn willink_hall_example_1() {
        let s11 = [
            [0.0242, -0.0101],
            [-0.0023, 0.2229],
            [0.0599, 0.0601],
            [0.0433, 0.21],
            [-0.0026, 0.0627],
        ];
        let reflection = [
            [0.1648, -0.025],
            [0.1568, -0.0179],
            [0.1598, -0.1367],
            [0.1198, -0.0045],
            [0.3162, -0.131],
        ];
        let (u1, r1) = of_mean(&s11);
        let (u2, r2) = of_mean(&reflection);
        let groups = [
            Group {
                members: vec![0, 1],
                correlation: r1.into(),
                law: Law::Normal,
                dof: Some(4.0),
            },
            Group {
                members: vec![2, 3],
                correlation: r2.into(),
                law: Law::Normal,
                dof: Some(4.0),
            },
        ];
        let u = [u1, u2].concat();
        let covariance = Covariance::from_parts(u, vec![4.0; 4], &groups);
        let re = covariance.form([(0, -1.0), (2, 1.0)]);
        let im = covariance.form([(1, -1.0), (3, 1.0)]);
        close(covariance.uncertainty(&re).powi(2), 0.0013175, 6e-8);
        close(covariance.uncertainty(&im).powi(2), 0.0029425, 6e-8);
        let (re_vector, im_vector) = (covariance.dense(&re), covariance.dense(&im));
        let product: f64 = re_vector.iter().zip(&im_vector).map(|(a, b)| a * b).sum();
        close(product, -0.0007256, 6e-8);
        close(
            effective_joint(&covariance, &[&re, &im], &[1.0, 1.0]).dof,
            6.85,
            0.006,
        );
        // One measurand: Welch–Satterthwaite.
        let alone = effective_joint(&covariance, &[&re], &[1.0]);
        close(alone.dof, effective(&covariance, &re).dof, 1e-12);
    }
}
