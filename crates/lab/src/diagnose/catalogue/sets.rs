//! Several of many terms of one kind that together explain the residuals, where one alone does not: a staircase.

use gumption_core::least_squares::products;
use gumption_core::special::ln_gamma;
use nalgebra::{DMatrix, DVector};

use super::Term;
use super::absorbed::Absorbed;
use super::fitted::FittedModel;
use super::sharp::residuals;

/// Some of many terms.
pub(super) struct Set {
    /// Which of them, in their order.
    pub members: Vec<usize>,
    /// One over the number of sets of as many.
    pub share: f64,
}

/// Sets of two terms and more that explain the residuals better than any with fewer, by the likelihood with an unknown size of the noise
/// less what the choice of the set and its sizes cost (Schwarz 1978). Each term has a place; those of a set are two apart at least.
pub(super) fn sets(fitted: &FittedModel<'_>, terms: &[Term], places: Vec<usize>) -> Vec<Set> {
    let columns = || terms.iter().map(|term| fitted.column(term));
    let powers = residuals(fitted);
    let powers = powers.and_then(|absorbed| Powers::of(absorbed, columns().collect(), places));
    powers.map_or(Vec::new(), |powers| powers.leading())
}

/// What sets of regressors take away from residuals.
struct Powers {
    /// Products of what is left of the regressors, each of unit length, with one another and with the residuals.
    products: DMatrix<f64>,
    along: DVector<f64>,
    places: Vec<usize>,
    whole: f64,
    observations: f64,
    /// Degrees of freedom that the residuals have.
    degrees: f64,
}

impl Powers {
    /// `None` where there are too few to choose from.
    fn of(absorbed: &Absorbed, columns: Vec<DVector<f64>>, places: Vec<usize>) -> Option<Powers> {
        let unit = |column: &DVector<f64>| match absorbed.leaves(column) {
            true => absorbed.rest(column).normalize(),
            false => DVector::zeros(column.len()),
        };
        let units: Vec<DVector<f64>> = columns.iter().map(unit).collect();
        let observations = absorbed.left.len();
        (units.len() > 2).then(|| {
            let units = DMatrix::from_columns(&units);
            Powers {
                products: products(&units, &units),
                along: units.tr_mul(&absorbed.left),
                places,
                whole: absorbed.left.norm_squared(),
                observations: observations as f64,
                degrees: observations.saturating_sub(absorbed.directions()) as f64,
            }
        })
    }

    /// The best set of each size that beats all smaller ones.
    fn leading(&self) -> Vec<Set> {
        /// As many steps as ranges of the widest instruments.
        const MOST: usize = 8;
        let count = self.along.len();
        let one = (0..count).map(|at| self.score(&[at])).fold(0.0, f64::max);
        let (mut least, mut found) = (one, Vec::new());
        let Some(mut set) = self.best_pair() else {
            return found;
        };
        loop {
            self.exchange(&mut set);
            let score = self.score(&set);
            if score > least {
                least = score;
                let mut members = set.clone();
                members.sort_unstable();
                let share = libm::exp(-ln_choices(count, set.len()));
                found.push(Set { members, share });
            }
            let enough = set.len() == MOST.min(count);
            match self.next(&set).filter(|_| !enough) {
                Some(next) => set.push(next),
                None => return found,
            }
        }
    }

    /// The logarithm of how much likelier the residuals are with a set.
    fn score(&self, set: &[usize]) -> f64 {
        let free = self.degrees - set.len() as f64;
        let left = self.whole - self.power(set);
        if free <= 0.0 || left <= ROUNDED * self.whole {
            return f64::NEG_INFINITY;
        }
        let gain = 0.5 * self.degrees * libm::log(self.whole / left);
        let sizes = 0.5 * set.len() as f64 * libm::log(self.observations);
        gain - sizes - ln_choices(self.along.len(), set.len())
    }

    /// Sum of squares that a set takes away; nothing where its members do the same.
    fn power(&self, set: &[usize]) -> f64 {
        let products = self.products.select_columns(set).select_rows(set);
        let along = self.along.select_rows(set);
        let factor = products.cholesky();
        factor.map_or(0.0, |factor| along.dot(&factor.solve(&along)))
    }

    fn best_pair(&self) -> Option<Vec<usize>> {
        let count = self.along.len();
        let pairs = (0..count).flat_map(|b| (0..b).map(move |a| [a, b]));
        let pairs = pairs.filter(|[a, b]| self.goes_with(*a, &[*b]));
        let powers = pairs.map(|pair| (self.power(&pair), pair));
        let best = powers.max_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, pair)| pair.to_vec())
    }

    /// Whether a term is another than the members of a set, with more than one value between it and them: what one value does alone
    /// is no level.
    fn goes_with(&self, at: usize, set: &[usize]) -> bool {
        let mut others = set.iter().map(|other| self.places[*other]);
        others.all(|other| other.abs_diff(self.places[at]) > 1)
    }

    /// The member that adds most to a set.
    fn next(&self, set: &[usize]) -> Option<usize> {
        let others = (0..self.along.len()).filter(|at| self.goes_with(*at, set));
        let with = |at: usize| self.power(&[set, &[at]].concat());
        others
            .map(|at| (with(at), at))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, at)| at)
    }

    /// Exchanges one member after the other as long as that explains more.
    fn exchange(&self, set: &mut Vec<usize>) {
        let mut power = self.power(set);
        loop {
            let before = power;
            for place in 0..set.len() {
                let old = set.remove(place);
                let new = self.next(set).unwrap_or(old);
                set.insert(place, new);
                let then = self.power(set);
                match then > power * (1.0 + ROUNDED) {
                    true => power = then,
                    false => set[place] = old,
                }
            }
            if power <= before {
                return;
            }
        }
    }
}

/// Differences of sums of squares below this part are rounding.
const ROUNDED: f64 = 1e-12;

/// Logarithm of the number of sets of so many out of all.
fn ln_choices(all: usize, chosen: usize) -> f64 {
    let ln_factorial = |n: usize| ln_gamma(n as f64 + 1.0);
    ln_factorial(all) - ln_factorial(chosen) - ln_factorial(all - chosen)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps from each row on, beside a constant.
    fn staircase(residuals: &[f64]) -> Powers {
        let rows = residuals.len();
        let from =
            |first: usize| DVector::from_fn(rows, |row, _| f64::from(u8::from(row >= first)));
        let absorbed = Absorbed::by_columns(
            &DMatrix::from_element(rows, 1, 1.0),
            &DVector::from_row_slice(residuals),
            &DVector::from_element(rows, 1.0),
        );
        let places = (1..rows).collect();
        Powers::of(&absorbed, (1..rows).map(from).collect(), places).unwrap()
    }

    /// As much as noise of this size scatters, by turns.
    fn noise(row: usize) -> f64 {
        0.1 * libm::sin(1.0 + 2.4 * (row * row) as f64)
    }

    #[test]
    fn all_steps_of_a_staircase_are_found_together() {
        // Levels in turn, of which each step takes back the one before.
        let level = |row: usize| f64::from(u8::from((8..16).contains(&row) || row >= 22));
        let rows: Vec<f64> = (0..30).map(|row| level(row) + noise(row)).collect();
        let powers = staircase(&rows);
        let found = powers.leading();
        let best = found.last().unwrap();
        assert_eq!(best.members, [7, 15, 21]);
        // 29 choose 3.
        assert!((best.share * 3654.0 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn single_values_are_no_levels() {
        // One row of its own between two levels, and a level of two rows.
        let of_rows = |rows: std::ops::Range<usize>| -> Vec<f64> {
            let level = |row: usize| f64::from(u8::from(rows.contains(&row)));
            (0..30).map(|row| level(row) + noise(row)).collect()
        };
        for set in staircase(&of_rows(12..13)).leading() {
            let mut pairs = set.members.windows(2);
            assert!(pairs.all(|pair| pair[1] - pair[0] > 1));
        }
        let two = staircase(&of_rows(12..14)).leading();
        assert_eq!(two.last().unwrap().members, [11, 13]);
    }

    #[test]
    fn one_step_and_none_need_no_set() {
        let one: Vec<f64> = (0..30)
            .map(|row| f64::from(u8::from(row >= 12)) + noise(row))
            .collect();
        assert!(staircase(&one).leading().is_empty());
        let none: Vec<f64> = (0..30).map(noise).collect();
        assert!(staircase(&none).leading().is_empty());
    }
}
