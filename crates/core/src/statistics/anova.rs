//! Analysis of variance of readings in groups (GUM H.5, ISO 5725-2): one-way, balanced or not.

use super::{Dd, Series};
use crate::special::{f_quantile, f_sf};

/// The readings of one group, or what is known of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Group {
    /// Number of readings.
    pub count: usize,
    mean: Dd,
    /// Sum of squared deviations from the mean.
    squares: Dd,
}

/// A line of the table: sum of squares, degrees of freedom, mean square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Sum of squares.
    pub ss: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Mean square, ss/df.
    pub ms: f64,
}

/// A ratio of mean squares and what it says.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Ratio {
    /// F.
    pub f: f64,
    /// Degrees of freedom of the numerator.
    pub numerator: f64,
    /// Degrees of freedom of the denominator.
    pub denominator: f64,
}

/// What is done with a difference between groups.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Policy {
    /// It is taken for real: the groups scatter (GUM H.5.2.3, the cautious choice).
    Include,
    /// It is taken for real where the F test finds it at this level of significance.
    Test,
    /// It is denied: all readings are of one population (GUM H.5.2.2).
    Ignore,
}

/// What was done with a difference between groups.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The between-group variance is part of u.
    Included,
    /// It would be negative, and is zero.
    Negative,
    /// The F test did not find it.
    NotSignificant,
    /// The file denies it.
    Ignored,
}

/// What value the uncertainty is for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Of {
    /// The mean of all readings of the analysis.
    Mean,
    /// The mean of so many later readings in one group.
    Later(f64),
}

/// Standard uncertainty and degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncertainty {
    /// u.
    pub u: f64,
    /// ν.
    pub dof: f64,
}

/// One-way analysis of variance.
#[derive(Debug, Clone, PartialEq)]
pub struct OneWay {
    /// Number of groups J.
    pub groups: usize,
    /// Number of readings N.
    pub readings: usize,
    /// Mean of all readings.
    pub mean: f64,
    /// Between the groups.
    pub between: Line,
    /// Within the groups.
    pub within: Line,
    /// Standard deviation of the group means.
    pub s_of_means: f64,
    /// n₀ = (N - Σn²/N)/(J - 1), which multiplies the between-group variance in the expectation of
    /// its mean square; the number of readings of each group where all have equally many.
    pub effective_count: f64,
    /// Σn²/N²: by this the between-group variance enters that of the mean.
    concentration: f64,
}

impl Group {
    /// A group with its readings.
    pub fn new(readings: &[Dd]) -> Self {
        let series = Series::new(readings);
        Group {
            count: readings.len(),
            mean: series.exact_mean(),
            squares: series.exact_squares(),
        }
    }

    /// A group of which mean, experimental standard deviation and number of readings are known.
    pub fn summary(mean: Dd, s: f64, count: usize) -> Self {
        let freedom = Dd::from(count as f64 - 1.0);
        Group {
            count,
            mean,
            squares: Dd::from(s).squared() * freedom,
        }
    }

    /// All readings of several groups in one.
    pub fn merged(groups: &[Group]) -> Self {
        let count = groups.iter().map(|group| group.count).sum();
        let total: Dd = groups.iter().map(|group| group.weight() * group.mean).sum();
        let mean = total / Dd::from(count as f64);
        let within: Dd = groups.iter().map(|group| group.squares).sum();
        Group {
            count,
            mean,
            squares: within + scatter(groups, mean),
        }
    }

    /// Mean of its readings.
    pub fn mean(&self) -> f64 {
        self.mean.value()
    }

    /// Experimental standard deviation of its readings; nothing for a single one.
    pub fn standard_deviation(&self) -> Option<f64> {
        let freedom = Dd::from(self.count as f64 - 1.0);
        (self.count > 1).then(|| (self.squares / freedom).sqrt().value())
    }

    /// Variance of a reading, all readings taken as one population, and its degrees of freedom.
    pub(super) fn variance(&self) -> Line {
        Line::new(self.squares, self.count as f64 - 1.0)
    }

    pub(super) fn exact_mean(&self) -> Dd {
        self.mean
    }

    pub(super) fn exact_squares(&self) -> Dd {
        self.squares
    }

    fn weight(&self) -> Dd {
        Dd::from(self.count as f64)
    }
}

/// Σ n (mean - centre)².
pub(super) fn scatter(groups: &[Group], centre: Dd) -> Dd {
    groups
        .iter()
        .map(|group| group.weight() * (group.mean - centre).squared())
        .sum()
}

impl Line {
    pub(super) fn new(ss: Dd, df: f64) -> Self {
        Line {
            ss: ss.value(),
            df,
            ms: (ss / Dd::from(df)).value(),
        }
    }
}

impl Ratio {
    /// The probability of such a ratio or a larger one if the groups do not differ.
    pub fn p(&self) -> f64 {
        f_sf(self.f, self.numerator, self.denominator)
    }

    /// The ratio that is not exceeded with this probability if the groups do not differ.
    pub fn critical(&self, probability: f64) -> f64 {
        f_quantile(probability, self.numerator, self.denominator)
    }

    /// What is done under a policy, with a between-group variance of this sign.
    pub(super) fn verdict(&self, policy: Policy, significance: f64, variance: f64) -> Verdict {
        match policy {
            Policy::Ignore => Verdict::Ignored,
            Policy::Test if self.p() > significance => Verdict::NotSignificant,
            _ if variance <= 0.0 => Verdict::Negative,
            _ => Verdict::Included,
        }
    }
}

/// u² as a combination of mean squares, with ν by Welch–Satterthwaite (GUM G.4.1).
pub(super) fn combined(parts: &[(f64, Line)]) -> Uncertainty {
    let variance: f64 = parts.iter().map(|(c, line)| c * line.ms).sum();
    let largest = parts
        .iter()
        .fold(0.0_f64, |m, (c, line)| m.max((c * line.ms).abs()));
    // Coefficients that are zero in a balanced design are not quite so in floating point.
    let spread: f64 = parts
        .iter()
        .map(|(c, line)| c * line.ms)
        .zip(parts)
        .filter(|(part, _)| part.abs() > 1e-13 * largest)
        .map(|(part, (_, line))| (part / variance).powi(2) / line.df)
        .sum();
    Uncertainty {
        u: variance.sqrt(),
        dof: 1.0 / spread,
    }
}

/// u where all readings are of one population.
pub(super) fn one_population(all: &Group, of: Of) -> Uncertainty {
    let share = match of {
        Of::Mean => all.count as f64,
        Of::Later(count) => count,
    };
    combined(&[(1.0 / share, all.variance())])
}

impl OneWay {
    /// The analysis of at least two groups, one of which has two readings at least.
    pub fn new(groups: &[Group]) -> Self {
        let all = Group::merged(groups);
        let n = all.count as f64;
        let between = groups.len() as f64 - 1.0;
        let within: Dd = groups.iter().map(|group| group.squares).sum();
        let squares: f64 = groups
            .iter()
            .map(|group| (group.count as f64).powi(2))
            .sum();
        let means: Vec<Dd> = groups.iter().map(|group| group.mean).collect();
        OneWay {
            groups: groups.len(),
            readings: all.count,
            mean: all.mean(),
            between: Line::new(scatter(groups, all.mean), between),
            within: Line::new(within, n - groups.len() as f64),
            s_of_means: Series::new(&means).standard_deviation(),
            effective_count: (n - squares / n) / between,
            concentration: squares / (n * n),
        }
    }

    /// The F test for a difference between the groups.
    pub fn ratio(&self) -> Ratio {
        Ratio {
            f: self.between.ms / self.within.ms,
            numerator: self.between.df,
            denominator: self.within.df,
        }
    }

    /// Between-group variance (MS_between - MS_within)/n₀; negative when the group means scatter less
    /// than the readings within make them.
    pub fn between_variance(&self) -> f64 {
        (self.between.ms - self.within.ms) / self.effective_count
    }

    /// The part of the total sum of squares that lies between the groups.
    pub fn r_squared(&self) -> f64 {
        self.between.ss / (self.between.ss + self.within.ss)
    }

    /// u and ν with the between-group variance.
    fn included(&self, of: Of) -> Uncertainty {
        let (between, within) = match of {
            Of::Mean => (self.concentration, 1.0 / self.readings as f64),
            Of::Later(count) => (1.0, 1.0 / count),
        };
        let share = between / self.effective_count;
        combined(&[(share, self.between), (within - share, self.within)])
    }

    /// What is done with the difference between the groups, and u and ν that follow.
    pub fn uncertainty(
        groups: &[Group],
        policy: Policy,
        significance: f64,
        of: Of,
    ) -> (Verdict, Uncertainty) {
        let analysis = OneWay::new(groups);
        let verdict = analysis
            .ratio()
            .verdict(policy, significance, analysis.between_variance());
        let uncertainty = match verdict {
            Verdict::Included => analysis.included(of),
            _ => one_population(&Group::merged(groups), of),
        };
        (verdict, uncertainty)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(texts: &[&str]) -> Group {
        let readings: Vec<Dd> = texts.iter().filter_map(|text| Dd::parse(text)).collect();
        Group::new(&readings)
    }

    /// GUM table H.9: means in volt less 10 V, in microvolt, and standard deviations.
    fn zener() -> Vec<Group> {
        let days = [
            (172.0, 60.0),
            (116.0, 77.0),
            (13.0, 111.0),
            (144.0, 101.0),
            (106.0, 67.0),
            (31.0, 93.0),
            (60.0, 80.0),
            (125.0, 73.0),
            (163.0, 88.0),
            (41.0, 86.0),
        ];
        days.map(|(mean, s)| Group::summary(Dd::from(mean), s, 5))
            .to_vec()
    }

    fn close(obtained: f64, expected: f64, tolerance: f64) {
        assert!(
            (obtained - expected).abs() <= tolerance,
            "{obtained} is not {expected}"
        );
    }

    #[test]
    fn gum_h_5() {
        let days = zener();
        let analysis = OneWay::new(&days);
        close(analysis.mean, 97.1, 1e-12);
        close(analysis.s_of_means, 57.0, 0.5);
        close(analysis.between.ms.sqrt(), 128.0, 0.5);
        close(analysis.within.ms.sqrt(), 85.0, 0.5);
        close(analysis.between_variance().sqrt(), 43.0, 0.5);
        close(analysis.ratio().f, 2.25, 0.02);
        close(analysis.ratio().critical(0.95), 2.12, 0.005);
        close(analysis.ratio().critical(0.975), 2.45, 0.005);
        let (verdict, found) = OneWay::uncertainty(&days, Policy::Include, 0.05, Of::Mean);
        assert_eq!(verdict, Verdict::Included);
        close(found.u, 18.0, 0.5);
        close(found.dof, 9.0, 1e-9);
        let (verdict, found) = OneWay::uncertainty(&days, Policy::Ignore, 0.05, Of::Mean);
        assert_eq!(verdict, Verdict::Ignored);
        close(found.u, 13.0, 0.5);
        close(found.dof, 49.0, 1e-9);
        // Significant at 5 %, not at 2.5 % (GUM H.5.2.4).
        let test = |level| OneWay::uncertainty(&days, Policy::Test, level, Of::Mean).0;
        assert_eq!(test(0.05), Verdict::Included);
        assert_eq!(test(0.025), Verdict::NotSignificant);
    }

    /// NIST StRD SmLs: nine treatments about an offset, certified values.
    fn simulated(offset: &str, pairs: usize) -> Vec<Group> {
        [4, 3, 5, 3, 5, 3, 5, 3, 5]
            .map(|middle| {
                let tenth = |k: i32| format!("{offset}.{k}");
                let mut readings = vec![tenth(middle)];
                for _ in 0..pairs {
                    readings.extend([tenth(middle - 1), tenth(middle + 1)]);
                }
                let texts: Vec<&str> = readings.iter().map(String::as_str).collect();
                group(&texts)
            })
            .to_vec()
    }

    #[test]
    fn strd_simulated_sets_to_all_certified_digits() {
        // SmLs01, 04, 07; 02, 05, 08; 03, 06, 09.
        for offset in ["1", "1000000", "1000000000000"] {
            for (pairs, ss, f) in [
                (10, 1.68, 21.0),
                (100, 16.08, 201.0),
                (1000, 160.08, 2001.0),
            ] {
                let analysis = OneWay::new(&simulated(offset, pairs));
                for (obtained, certified) in [
                    (analysis.between.ss, ss),
                    (analysis.between.ms, ss / 8.0),
                    (analysis.within.ms, 0.01),
                    (analysis.ratio().f, f),
                    (analysis.within.ms.sqrt(), 0.1),
                ] {
                    assert!(
                        (obtained / certified - 1.0).abs() < 1e-15,
                        "{obtained} is not {certified} at {offset}"
                    );
                }
            }
        }
    }

    #[test]
    fn unbalanced_groups_have_the_expected_mean_squares() {
        // n = 1, 2, 3: n₀ = (6 - 14/6)/2 = 11/6.
        let groups = [group(&["1"]), group(&["4", "6"]), group(&["8", "9", "10"])];
        let analysis = OneWay::new(&groups);
        close(analysis.effective_count, 11.0 / 6.0, 1e-15);
        close(analysis.mean, 38.0 / 6.0, 1e-14);
        // Within: 2 + 2 with ν = 3. Between: 1·(1 - m)² + 2·(5 - m)² + 3·(9 - m)².
        close(analysis.within.ss, 4.0, 1e-14);
        let m = 38.0 / 6.0;
        let between =
            (1.0 - m) * (1.0 - m) + 2.0 * (5.0 - m) * (5.0 - m) + 3.0 * (9.0 - m) * (9.0 - m);
        close(analysis.between.ss, between, 1e-12);
        let (_, found) = OneWay::uncertainty(&groups, Policy::Include, 0.05, Of::Mean);
        let variance = analysis.between_variance() * 14.0 / 36.0 + analysis.within.ms / 6.0;
        close(found.u, variance.sqrt(), 1e-12);
        let (_, later) = OneWay::uncertainty(&groups, Policy::Include, 0.05, Of::Later(1.0));
        close(
            later.u * later.u,
            analysis.between_variance() + analysis.within.ms,
            1e-12,
        );
    }

    #[test]
    fn a_negative_variance_between_groups_is_zero() {
        let groups = [group(&["1", "5"]), group(&["2", "4"])];
        let (verdict, found) = OneWay::uncertainty(&groups, Policy::Include, 0.05, Of::Mean);
        assert_eq!(verdict, Verdict::Negative);
        assert_eq!(found.dof, 3.0);
        close(found.u, (10.0_f64 / 3.0 / 4.0).sqrt(), 1e-15);
    }
}
