//! Nested analysis of variance: readings in subgroups, subgroups in groups (days within laboratories),
//! balanced or not. Expected mean squares of unbalanced designs as in ISO 5725-3 and Searle's
//! classical formulas.

use super::anova::{Group, Line, Of, Policy, Ratio, Uncertainty, Verdict, combined, scatter};
use super::{Dd, OneWay};

/// Two-stage nested analysis of variance.
#[derive(Debug, Clone, PartialEq)]
pub struct Nested {
    /// Number of groups.
    pub groups: usize,
    /// Number of subgroups.
    pub subgroups: usize,
    /// Number of readings.
    pub readings: usize,
    /// Mean of all readings.
    pub mean: f64,
    /// Between the groups.
    pub top: Line,
    /// Between the subgroups of one group.
    pub middle: Line,
    /// Within the subgroups.
    pub within: Line,
    /// Expectations: middle = σ² + k₁σ_B², top = σ² + k₂σ_B² + k₃σ_A².
    pub coefficients: [f64; 3],
    /// Σ n_i²/N² over groups and over subgroups.
    concentration: [f64; 2],
}

/// What was done with the differences between groups and between subgroups.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Verdicts {
    /// Between the groups.
    pub top: Verdict,
    /// Between the subgroups.
    pub middle: Verdict,
}

impl Nested {
    /// The analysis of at least two groups, one of which has two subgroups at least, one of which has
    /// two readings at least.
    pub fn new(design: &[Vec<Group>]) -> Self {
        let groups: Vec<Group> = design.iter().map(|cells| Group::merged(cells)).collect();
        let cells: Vec<Group> = design.iter().flatten().copied().collect();
        let all = Group::merged(&groups);
        let (n, a, b) = (all.count as f64, groups.len() as f64, cells.len() as f64);
        let square = |group: &Group| (group.count as f64).powi(2);
        let by_group: f64 = groups.iter().map(square).sum::<f64>() / n;
        let by_cell: f64 = cells.iter().map(square).sum::<f64>() / n;
        let own: f64 = design
            .iter()
            .zip(&groups)
            .map(|(cells, group)| cells.iter().map(square).sum::<f64>() / group.count as f64)
            .sum();
        let middle: Dd = design
            .iter()
            .zip(&groups)
            .map(|(cells, group)| scatter(cells, group.exact_mean()))
            .sum();
        let within: Dd = cells.iter().map(Group::exact_squares).sum();
        Nested {
            groups: groups.len(),
            subgroups: cells.len(),
            readings: all.count,
            mean: all.mean(),
            top: Line::new(scatter(&groups, all.exact_mean()), a - 1.0),
            middle: Line::new(middle, b - a),
            within: Line::new(within, n - b),
            coefficients: [
                (n - own) / (b - a),
                (own - by_cell) / (a - 1.0),
                (n - by_group) / (a - 1.0),
            ],
            concentration: [by_group / n, by_cell / n],
        }
    }

    /// Variance between the subgroups of one group.
    pub fn middle_variance(&self) -> f64 {
        (self.middle.ms - self.within.ms) / self.coefficients[0]
    }

    /// Variance between the groups.
    pub fn top_variance(&self) -> f64 {
        (self.top.ms - self.denominator().u.powi(2)) / self.coefficients[2]
    }

    /// The F test for a difference between the subgroups.
    pub fn middle_ratio(&self) -> Ratio {
        Ratio {
            f: self.middle.ms / self.within.ms,
            numerator: self.middle.df,
            denominator: self.within.df,
        }
    }

    /// The F test for a difference between the groups. Its denominator is what the mean square of the
    /// groups would be without such a difference, in unbalanced designs a combination of the other two
    /// with ν after Satterthwaite.
    pub fn top_ratio(&self) -> Ratio {
        let denominator = self.denominator();
        Ratio {
            f: self.top.ms / denominator.u.powi(2),
            numerator: self.top.df,
            denominator: denominator.dof,
        }
    }

    /// σ² + k₂σ_B² as root and ν.
    fn denominator(&self) -> Uncertainty {
        let share = self.coefficients[1] / self.coefficients[0];
        combined(&[(share, self.middle), (1.0 - share, self.within)])
    }

    fn included(&self, of: Of) -> Uncertainty {
        let [k1, k2, k3] = self.coefficients;
        let (top, middle, within) = match of {
            Of::Mean => (
                self.concentration[0],
                self.concentration[1],
                1.0 / self.readings as f64,
            ),
            Of::Later(count) => (1.0, 1.0, 1.0 / count),
        };
        let (of_top, of_middle) = (top / k3, middle / k1 - top * k2 / (k3 * k1));
        combined(&[
            (of_top, self.top),
            (of_middle, self.middle),
            (within - of_top - of_middle, self.within),
        ])
    }

    /// What is done with both differences, and u and ν that follow. A difference that is not there makes
    /// a simpler design: without one between subgroups the readings of a group are alike, without one
    /// between groups all subgroups are.
    pub fn uncertainty(
        design: &[Vec<Group>],
        policy: Policy,
        significance: f64,
        of: Of,
    ) -> (Verdicts, Uncertainty) {
        let analysis = Nested::new(design);
        let middle =
            analysis
                .middle_ratio()
                .verdict(policy, significance, analysis.middle_variance());
        if middle != Verdict::Included {
            let groups: Vec<Group> = design.iter().map(|cells| Group::merged(cells)).collect();
            let (top, uncertainty) = OneWay::uncertainty(&groups, policy, significance, of);
            return (Verdicts { top, middle }, uncertainty);
        }
        let top = analysis
            .top_ratio()
            .verdict(policy, significance, analysis.top_variance());
        if top != Verdict::Included {
            let cells: Vec<Group> = design.iter().flatten().copied().collect();
            // Subgroups differ; that was decided above.
            let (middle, uncertainty) =
                OneWay::uncertainty(&cells, Policy::Include, significance, of);
            return (Verdicts { top, middle }, uncertainty);
        }
        (Verdicts { top, middle }, analysis.included(of))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(readings: &[&[&[f64]]]) -> Vec<Vec<Group>> {
        let cell = |cell: &&[f64]| {
            let readings: Vec<Dd> = cell.iter().map(|x| Dd::from(*x)).collect();
            Group::new(&readings)
        };
        readings
            .iter()
            .map(|group| group.iter().map(cell).collect())
            .collect()
    }

    fn close(obtained: f64, expected: f64) {
        let tolerance = 1e-12 * expected.abs().max(1.0);
        assert!(
            (obtained - expected).abs() <= tolerance,
            "{obtained} is not {expected}"
        );
    }

    #[test]
    fn a_balanced_design_by_hand() {
        // Two laboratories, two days each, two readings: means 2, 4 | 10, 14, all 7.5.
        let data = design(&[&[&[1.0, 3.0], &[3.0, 5.0]], &[&[9.0, 11.0], &[13.0, 15.0]]]);
        let found = Nested::new(&data);
        close(found.mean, 7.5);
        close(found.top.ss, 8.0 * 4.5 * 4.5);
        close(found.middle.ss, 4.0 * 1.0 + 4.0 * 4.0);
        close(found.within.ss, 8.0);
        assert_eq!(
            (found.top.df, found.middle.df, found.within.df),
            (1.0, 2.0, 4.0)
        );
        assert_eq!(found.coefficients, [2.0, 2.0, 4.0]);
        close(found.middle_ratio().f, 10.0 / 2.0);
        close(found.top_ratio().f, 162.0 / 10.0);
        close(found.top_ratio().denominator, 2.0);
        close(found.middle_variance(), 4.0);
        close(found.top_variance(), 38.0);
        // The mean of a balanced design has u² = MS_top/N, and ν of it.
        let (verdicts, mean) = Nested::uncertainty(&data, Policy::Include, 0.05, Of::Mean);
        assert_eq!(verdicts.top, Verdict::Included);
        close(mean.u, (162.0_f64 / 8.0).sqrt());
        close(mean.dof, 1.0);
        let (_, single) = Nested::uncertainty(&data, Policy::Include, 0.05, Of::Later(1.0));
        close(single.u * single.u, 38.0 + 4.0 + 2.0);
    }

    #[test]
    fn unbalanced_coefficients_are_expectations() {
        // The expectation of a quadratic form: its value for readings that only a group effect, or only a
        // subgroup effect makes, averaged over unit effects.
        let counts: [&[usize]; 3] = [&[1, 3], &[2], &[2, 2, 4]];
        let unit = |group: usize, cell: Option<usize>| -> Nested {
            let data: Vec<Vec<Group>> = counts
                .iter()
                .enumerate()
                .map(|(i, cells)| {
                    cells
                        .iter()
                        .enumerate()
                        .map(|(j, n)| {
                            let hit = i == group && cell.is_none_or(|cell| cell == j);
                            Group::new(&vec![Dd::from(f64::from(u8::from(hit))); *n])
                        })
                        .collect()
                })
                .collect();
            Nested::new(&data)
        };
        let [k1, k2, k3] = unit(0, None).coefficients;
        let by_group: f64 = (0..3).map(|i| unit(i, None).top.ms).sum();
        close(k3, by_group);
        let cells = || (0..3).flat_map(|i| (0..counts[i].len()).map(move |j| (i, j)));
        close(k2, cells().map(|(i, j)| unit(i, Some(j)).top.ms).sum());
        close(k1, cells().map(|(i, j)| unit(i, Some(j)).middle.ms).sum());
    }

    #[test]
    fn absent_differences_simplify_the_design() {
        let data = design(&[&[&[1.0, 5.0], &[2.0, 4.0]], &[&[11.0, 15.0], &[12.0, 14.0]]]);
        let (verdicts, found) = Nested::uncertainty(&data, Policy::Include, 0.05, Of::Mean);
        assert_eq!(verdicts.middle, Verdict::Negative);
        assert_eq!(verdicts.top, Verdict::Included);
        close(found.dof, 1.0);
        let (verdicts, found) = Nested::uncertainty(&data, Policy::Ignore, 0.05, Of::Mean);
        assert_eq!(
            (verdicts.top, verdicts.middle),
            (Verdict::Ignored, Verdict::Ignored)
        );
        close(found.dof, 7.0);
    }
}
