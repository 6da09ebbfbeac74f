use super::super::draft::Draft;
use super::super::{MonteCarloChoice, Options, evaluate};
use super::*;
use gumption_core::distribution::{Normal, Uniform};

/// SplitMix64 on (0, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// With six decimals, or with all digits.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let x = low + (high - low) * self.next();
        if self.next() < 0.7 {
            (x * 1e6).round() / 1e6
        } else {
            x
        }
    }
}

/// A budget with normal components, the last with limits; each measurand behind the next semicolon.
fn budget(models: &str) -> Budget {
    let names = ["a", "b", "c", "d", "e"];
    let add = |draft: Draft, (at, name): (usize, &&str)| match at {
        4 => draft.rectangle(name, 1.5, 0.02, f64::INFINITY),
        _ => draft.normal(name, 1.5, 0.01, 5.0 + at as f64),
    };
    let draft = names.iter().enumerate().fold(Draft::new(), add);
    let outputs = ["y", "z"].into_iter().zip(models.split("; "));
    draft.budget(0.95, &outputs.collect::<Vec<_>>())
}

/// Rows of all kinds: most with small uncertainties, some whose uncertainties are large, or whose values nearly cancel.
fn rows(budget: &Budget, numbers: &mut Numbers) -> Rows {
    let mut rows = Rows::of(budget);
    for lane in 0..LANES {
        let wide = if lane % 8 == 7 { 0.5 } else { 0.005 };
        for at in 0..budget.inputs.len() {
            rows.estimates[at].0[lane] = numbers.between(0.2, 9.0);
            rows.u[at].0[lane] = numbers.between(1e-6, wide);
        }
        rows.dof[0].0[lane] = numbers.between(2.0, 200.0);
        if lane % 8 == 3 {
            rows.estimates[1].0[lane] = rows.estimates[0].0[lane] + numbers.between(-1e-6, 1e-6);
        }
    }
    rows
}

/// The budget with a row written into it.
fn written(budget: &Budget, rows: &Rows, lane: usize) -> Budget {
    let mut budget = budget.clone();
    for (input, x) in budget.inputs.iter_mut().zip(&rows.estimates) {
        input.estimate = x.0[lane];
    }
    for (at, component) in budget.components.iter_mut().enumerate() {
        (component.u, component.dof) = (rows.u[at].0[lane], rows.dof[at].0[lane]);
        let half = component.u * 3f64.sqrt();
        component.distribution = match component.distribution {
            Distribution::Uniform(_) => Distribution::Uniform(Uniform {
                lower: -half,
                upper: half,
            }),
            _ => Distribution::Normal(Normal {
                mean: 0.0,
                sd: component.u,
            }),
        };
    }
    budget
}

#[test]
fn rows_are_what_the_general_evaluation_gives_to_the_last_bit() {
    let models = [
        ("a * b / c + d * e", 0.7),
        ("a - b + 0.001 * c + d - e", 0.7),
        ("a * b * c * d * e", 0.7),
        ("(a - b) / c + d^2 + 1 / e", 0.5),
        ("sqrt(a * b) + ln(c) - sin(d) + exp(-e)", 0.5),
        ("a^3 / (b + c)^2 - d^0.5 + e", 0.5),
        ("a * b + a * c + d / a + e", 0.5),
        ("((a + b) * c)^2 / (d + e) + a", 0.5),
        // Neither measurand depends on all inputs.
        ("a * b / c; d + e", 0.7),
    ];
    let mut numbers = Numbers(1);
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        threads: 1,
        ..Options::default()
    };
    for (model, least) in models {
        let budget = budget(model);
        let mut rows_of = RowEvaluation::new(&budget).expect("a budget for rows");
        let (mut taken, mut all) = (0, 0);
        for _ in 0..4 {
            let rows = rows(&budget, &mut numbers);
            rows_of.evaluate(&rows, LANES);
            for lane in 0..LANES {
                all += 1;
                if rows_of.doubt().0[lane] != 0.0 {
                    continue;
                }
                let block = rows_of.figures(&rows, lane..lane + 1);
                let found = block.rows().next().expect("a row");
                taken += 1;
                let budget = written(&budget, &rows, lane);
                let expected = evaluate(&budget, &options).expect("a value");
                let place = format!("{model}, lane {lane}");
                let mut few = Vec::new();
                for (at, result) in expected.results.iter().enumerate() {
                    let reported = result.reported(&budget.conventions).figures();
                    assert_eq!(found.figures(at), reported, "{place}");
                    few.extend(found.few_degrees(at));
                    let shares = result.gum.inputs.iter().map(|line| line.share);
                    assert_eq!(found.shares(at), shares.collect::<Vec<_>>(), "{place}");
                    let components = result.gum.components.iter();
                    let contributions: Vec<f64> = components.map(|one| one.contribution).collect();
                    assert_eq!(found.contributions(at), contributions, "{place}");
                    let together = block.contributions(at).into_iter().map(|one| one[0]);
                    assert_eq!(together.collect::<Vec<_>>(), contributions, "{place}");
                    let few = found.few_degrees(at).is_some();
                    assert_eq!(block.have_few_degrees(at), few, "{place}");
                }
                let kinds: Vec<_> = expected.findings.into_iter().map(|one| one.kind).collect();
                assert_eq!(kinds, few, "{place}");
            }
        }
        // Else the bounds are worth nothing.
        assert!(
            f64::from(taken) > least * f64::from(all),
            "{model}: {taken} of {all}"
        );
    }
}
