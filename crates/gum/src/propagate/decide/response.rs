//! u of a measurand as a function of the measurand's value.
//!
//! One input carries the value: the gross counts, the indication. It takes the estimate that gives the measurand
//! the wanted value, what is stated relative to it follows, and the sensitivity coefficients are those there.

use crate::budget::Budget;
use crate::propagate::gum;

/// A measurand whose value moves with one of the inputs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Response<'b> {
    pub budget: &'b Budget,
    pub measurand: usize,
    /// Index of the input that carries the value.
    pub carrier: usize,
}

impl<'b> Response<'b> {
    /// The budget of a measurement that finds this value; `None` where no estimate of the input gives it.
    pub(super) fn budget_at(&self, value: f64) -> Option<Budget> {
        self.estimate_for(value)
            .map(|x| self.budget.at(self.carrier, x))
    }

    /// u of a measurement that finds this value.
    pub(super) fn u_at(&self, value: f64) -> Option<f64> {
        let linear = gum::linearise(&self.budget_at(value)?).ok()?;
        let u = linear.measurands.get(self.measurand)?.u;
        u.is_finite().then_some(u)
    }

    /// The estimate of the carrier for which the measurand has this value, by Newton's method from the
    /// estimate of the budget.
    fn estimate_for(&self, value: f64) -> Option<f64> {
        /// Quadratic convergence needs a handful; a linear model one.
        const MOST_STEPS: usize = 60;
        let mut x: Vec<f64> = self.budget.inputs.iter().map(|i| i.estimate).collect();
        let mut gap = self.value(&x)? - value;
        for _ in 0..MOST_STEPS {
            let slope = *self
                .budget
                .model
                .gradients(&x)
                .get((self.measurand, self.carrier))?;
            let step = gap / slope;
            if !step.is_finite() {
                return None;
            }
            let from = x[self.carrier];
            let (to, gap_there) = self.shortened(&mut x, from, step, value, gap)?;
            x[self.carrier] = to;
            let still = (to - from).abs() <= 4.0 * f64::EPSILON * to.abs().max(from.abs());
            gap = gap_there;
            if gap == 0.0 || still {
                return Some(to);
            }
        }
        None
    }

    /// The step of Newton's method, halved until the gap becomes smaller; no step where rounding alone is left.
    fn shortened(
        &self,
        x: &mut [f64],
        from: f64,
        step: f64,
        value: f64,
        gap: f64,
    ) -> Option<(f64, f64)> {
        let mut part = 1.0;
        while part > 1e-10 {
            let to = from - part * step;
            x[self.carrier] = to;
            match self.value(x).map(|found| found - value) {
                Some(there) if there.abs() < gap.abs() => return Some((to, there)),
                Some(_) if step.abs() <= 1e-12 * from.abs().max(to.abs()) => break,
                _ => part /= 2.0,
            }
        }
        let small = gap.abs() <= 1e-12 * value.abs().max((gap / step * from).abs());
        small.then_some((from, gap))
    }

    fn value(&self, x: &[f64]) -> Option<f64> {
        let value = *self.budget.model.values(x).get(self.measurand)?;
        value.is_finite().then_some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::read;

    fn response_of(text: &str, carrier: usize, check: impl Fn(Response<'_>)) {
        let loaded = read(text, "test", "".as_ref());
        let loaded = loaded.unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
        check(Response {
            budget: &loaded.rows[0].budget,
            measurand: 0,
            carrier,
        });
    }

    #[test]
    fn net_counts_have_the_u_of_iso_11929() {
        let text = r#"
            [measurand.a]
            model = "(n_g / 1200 - n_0 / 12000) * w"
            [input]
            n_g = { count = 21670, prior = "reciprocal" }
            n_0 = { count = 73150, prior = "reciprocal" }
            w = { value = 4.1, u = 0.6 }
        "#;
        response_of(text, 0, |response| {
            for a in [0.0, 3.0, 49.04625, 1000.0] {
                // ũ²(ã) = w²[(ã/w + r0)/t_g + r0/t_0] + ã² u²(w)/w²
                let (w, r0, r) = (4.1, 73150.0 / 12000.0, a / 4.1);
                let poisson = w * w * ((r + r0) / 1200.0 + r0 / 12000.0);
                let expected = (poisson + (r * 0.6f64).powi(2)).sqrt();
                let found = response.u_at(a).expect("a finite u");
                assert!((found / expected - 1.0).abs() < 1e-12, "{a}: {found}");
            }
            // Fewer than no counts.
            assert!(response.budget_at(-100.0).is_some());
        });
    }

    #[test]
    fn curved_models_are_followed() {
        let text = r#"
            [measurand.P]
            model = "U^2 / R"
            unit = "W"
            [input]
            U = { value = 10, unit = "V", u = "1 %" }
            R = { value = 50, unit = "ohm", u = 0.1 }
        "#;
        response_of(text, 0, |response| {
            for p in [2.0, 0.5, 80.0] {
                let u = response.u_at(p).expect("a finite u");
                let expected = p * 0.02f64.hypot(0.002);
                assert!((u / expected - 1.0).abs() < 1e-12, "{p}: {u} {expected}");
            }
            assert_eq!(response.u_at(-1.0), None);
        });
    }
}
