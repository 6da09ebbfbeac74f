//! Second-order terms of a formula in which many inputs meet in few values, its hubs ([`Cut`]).
//!
//! With x and the hubs s as variables of their own, L(x, s) = f(x, s) + Σ_k λ_k (s_k(x, s) − s_k) has the
//! derivatives of f(x, s(x)) where λ_k = ∂f/∂s_k: the first ones with respect to s vanish then. Along a direction
//! d of the inputs, with w = (d, S d), S = ds/dx, and s″ the second derivatives of the hubs, therefore
//!
//! - D²f[d, d] = D²L[w, w]
//! - D³f[d, e, g] = D³L[w_d, w_e, w_g] + D²L[w_d, s″_eg] + D²L[w_e, s″_dg] + D²L[w_g, s″_de],
//!
//! and D²L is a matrix A with few entries, bordered by one row B_k and column for each hub, with M where these
//! cross. The Hessian of f is A + B S + SᵀBᵀ + SᵀM S = A + U W Uᵀ with U = (B, Sᵀ): what it does to the
//! covariance of the inputs needs no sum over all pairs of them.
//!
//! Inputs are measured in their standard uncertainties, f in u(y), and hubs in theirs, so that C is a correlation
//! matrix and all numbers are of one size.

use nalgebra::DMatrix;

use super::sparse::sweeps;
use super::spread::Spread;
use super::{Outcome, Sums, unit};
use crate::budget::Budget;
use crate::model::{Along, Cut};
use crate::propagate::gum::Linear;

/// The outcomes of all measurands when some inputs change, where components are not shared between inputs and
/// hubs are few.
pub(super) fn outcomes(
    budget: &Budget,
    linear: &Linear,
    changing: &[bool],
) -> Option<Vec<Outcome>> {
    let spread = Spread::new(budget, linear, changing)?;
    let outputs = 0..linear.measurands.len();
    outputs
        .map(|output| outcome(budget, linear, &spread, output))
        .collect()
}

fn outcome(
    budget: &Budget,
    linear: &Linear,
    spread: &Spread<'_>,
    output: usize,
) -> Option<Outcome> {
    let measurand = linear.measurands.get(output)?;
    let unit = unit(measurand.u);
    let cut = budget.model.cut(output)?;
    let bordered = Bordered::new(&cut, &linear.x, spread, unit)?;
    let mut sums = Sums::new(measurand, unit, linear.x.len(), 0);
    sums.nonlinear = bordered.bends();
    if sums.nonlinear {
        bordered.add_to(&mut sums);
    }
    Some(sums.outcome(unit))
}

/// Second derivatives of a function of x and s.
#[derive(Clone)]
struct Hessian {
    /// A: per input the entries for its neighbours among the inputs, in their order.
    few: Vec<Vec<f64>>,
    /// B: per hub the entries for the inputs.
    border: Vec<Vec<f64>>,
    /// M.
    corner: DMatrix<f64>,
}

/// The function L at a point, and its hubs.
struct Bordered<'a> {
    cut: &'a Cut<'a>,
    spread: &'a Spread<'a>,
    point: Vec<f64>,
    /// Units of x and s.
    scales: Vec<f64>,
    /// Unit of f, and those of the hubs.
    units: Vec<f64>,
    /// 1 for f, λ_k for the hubs.
    weights: Vec<f64>,
    /// Per input those of its neighbours that are inputs.
    near: Vec<Vec<usize>>,
    /// ∂f/∂x of f(x, s(x)).
    gradient: Vec<f64>,
    /// ∂s_k/∂s_j of the hubs before.
    before: DMatrix<f64>,
    /// S: per hub its derivatives.
    hubs: Vec<Vec<f64>>,
    /// Inputs that move together.
    colours: Vec<Vec<usize>>,
    /// Of L.
    whole: Hessian,
    /// Of each s_k.
    parts: Vec<Hessian>,
}

impl<'a> Bordered<'a> {
    fn new(cut: &'a Cut<'a>, x: &[f64], spread: &'a Spread<'a>, unit: f64) -> Option<Self> {
        let (n, r) = (cut.inputs(), cut.hubs());
        let mut near = cut.neighbours()?;
        near.truncate(n);
        near.iter_mut()
            .for_each(|near| near.retain(|place| *place < n));
        let point = cut.point(x);
        let still = vec![0.0; n + r];
        let gradients: Vec<Vec<f64>> = cut
            .along(&point, &still)
            .into_iter()
            .map(|along| along.gradient)
            .collect();
        let mut scales = spread.scales().to_vec();
        let mut units = vec![unit];
        // ∂f/∂s_k through the hubs behind, which are behind it in the list.
        let mut lambda: Vec<f64> = gradients[0][n..].to_vec();
        for k in (0..r).rev() {
            for j in 0..k {
                lambda[j] += lambda[k] * gradients[k + 1][n + j];
            }
        }
        let mut hubs: Vec<Vec<f64>> = Vec::with_capacity(r);
        let mut before = DMatrix::zeros(r, r);
        for k in 0..r {
            let own = &gradients[k + 1];
            let mut slopes: Vec<f64> = own
                .iter()
                .zip(spread.scales())
                .map(|(g, u)| g * u)
                .collect();
            for (j, hub) in hubs.iter().enumerate() {
                before[(k, j)] = own[n + j] * scales[n + j];
                add_scaled(&mut slopes, before[(k, j)], hub);
            }
            let scale = usable(spread.deviation(&slopes)).unwrap_or((unit / lambda[k]).abs());
            let scale = usable(scale).unwrap_or(1.0);
            slopes.iter_mut().for_each(|slope| *slope /= scale);
            (0..k).for_each(|j| before[(k, j)] /= scale);
            hubs.push(slopes);
            scales.push(scale);
            units.push(scale);
        }
        let mut gradient: Vec<f64> = gradients[0]
            .iter()
            .zip(spread.scales())
            .map(|(g, u)| g * u / unit)
            .collect();
        for (k, hub) in hubs.iter().enumerate() {
            add_scaled(
                &mut gradient,
                gradients[0][n + k] * scales[n + k] / unit,
                hub,
            );
        }
        let weights = std::iter::once(1.0);
        let weights = weights.chain((0..r).map(|k| lambda[k] * scales[n + k] / unit));
        let moved = (0..n).filter(|input| scales[*input] > 0.0);
        let colours = sweeps(moved, &near);
        let nothing = Hessian {
            few: near.iter().map(|near| vec![0.0; near.len()]).collect(),
            border: vec![vec![0.0; n]; r],
            corner: DMatrix::zeros(r, r),
        };
        let mut bordered = Bordered {
            cut,
            spread,
            point,
            weights: weights.collect(),
            scales,
            units,
            near,
            gradient,
            before,
            hubs,
            colours,
            parts: vec![nothing.clone(); r],
            whole: nothing,
        };
        bordered.find_second_derivatives();
        Some(bordered)
    }

    fn inputs(&self) -> usize {
        self.cut.inputs()
    }

    /// Derivatives along a direction of x and s, all in their units.
    fn along(&self, direction: &[f64]) -> Vec<Along> {
        let moved: Vec<f64> = direction
            .iter()
            .zip(&self.scales)
            .map(|(d, u)| d * u)
            .collect();
        let mut all = self.cut.along(&self.point, &moved);
        for (along, unit) in all.iter_mut().zip(&self.units) {
            for part in [&mut along.second, &mut along.third] {
                part.iter_mut()
                    .zip(&self.scales)
                    .for_each(|(value, scale)| *value *= scale / unit);
            }
        }
        all
    }

    /// D³L[d, d, ·].
    fn third_along(&self, direction: &[f64]) -> Vec<f64> {
        self.weighted(&self.along(direction), |along| &along.third)
    }

    fn weighted(&self, all: &[Along], of: fn(&Along) -> &Vec<f64>) -> Vec<f64> {
        let mut sum = vec![0.0; self.scales.len()];
        for (weight, along) in self.weights.iter().zip(all) {
            add_scaled(&mut sum, *weight, of(along));
        }
        sum
    }

    /// One for these variables, zero for the others.
    fn ones(&self, places: &[usize]) -> Vec<f64> {
        let mut direction = vec![0.0; self.scales.len()];
        places.iter().for_each(|place| direction[*place] = 1.0);
        direction
    }

    fn find_second_derivatives(&mut self) {
        let n = self.inputs();
        for colour in &self.colours {
            let all = self.along(&self.ones(colour));
            let whole = self.weighted(&all, |along| &along.second);
            fill(&mut self.whole.few, &self.near, colour, &whole);
            for (part, along) in self.parts.iter_mut().zip(&all[1..]) {
                fill(&mut part.few, &self.near, colour, &along.second);
            }
        }
        for k in 0..self.cut.hubs() {
            let all = self.along(&self.ones(&[n + k]));
            let whole = self.weighted(&all, |along| &along.second);
            self.whole.set_border(k, &whole);
            for (part, along) in self.parts.iter_mut().zip(&all[1..]) {
                part.set_border(k, &along.second);
            }
        }
    }

    /// Whether L has second derivatives at all.
    fn bends(&self) -> bool {
        let Hessian {
            few,
            border,
            corner,
        } = &self.whole;
        let parts = self
            .parts
            .iter()
            .flat_map(|part| part.few.iter().chain(&part.border));
        let entries = few.iter().chain(border).chain(parts).flatten();
        entries.chain(corner.iter()).any(|entry| *entry != 0.0)
    }

    /// (d, S d).
    fn lifted(&self, d: Vec<f64>) -> Vec<f64> {
        let along: Vec<f64> = self.hubs.iter().map(|hub| dot(hub, &d)).collect();
        d.into_iter().chain(along).collect()
    }

    /// Adds all terms of the second order to sums that are empty.
    fn add_to(&self, sums: &mut Sums) {
        let (n, r) = (self.inputs(), self.cut.hubs());
        let correlation = Lifted::new(self.spread, &self.hubs);
        // D²f = A + U W Uᵀ.
        let whole = &self.whole;
        let u: Vec<&Vec<f64>> = whole.border.iter().chain(&self.hubs).collect();
        let mut w = DMatrix::zeros(2 * r, 2 * r);
        for k in 0..r {
            w[(k, r + k)] = 1.0;
            w[(r + k, k)] = 1.0;
        }
        w.view_mut((r, r), (r, r)).copy_from(&whole.corner);
        let cu: Vec<Vec<f64>> = u.iter().map(|u| self.spread.times(u)).collect();
        let acu: Vec<Vec<f64>> = cu.iter().map(|cu| self.times_few(whole, cu)).collect();
        let g = DMatrix::from_fn(2 * r, 2 * r, |a, b| dot(u[a], &cu[b]));
        let x = DMatrix::from_fn(2 * r, 2 * r, |a, b| dot(&cu[a], &acu[b]));
        let wg = &w * &g;
        // ½ tr(HC) and ½ tr(HCHC).
        sums.shift = 0.5 * (self.spread.trace(&self.near, &whole.few) + wg.trace());
        let few = self.spread.trace_of_square(&self.near, &whole.few);
        sums.curvature = (0.5 * (few + 2.0 * (&w * &x).trace() + (&wg * &wg).trace())).max(0.0);
        // (H C H)_ii.
        let wgw = &wg * &w;
        for i in (0..n).filter(|i| self.scales[*i] > 0.0) {
            let mut square = self.spread.around(&self.near[i], &whole.few[i]);
            for a in 0..2 * r {
                for b in 0..2 * r {
                    square += (2.0 * acu[a][i] * w[(a, b)] + u[a][i] * wgw[(a, b)]) * u[b][i];
                }
            }
            sums.slope[i] = square.max(0.0) / (self.scales[i] * self.scales[i]);
        }
        sums.added = self.drift(&correlation);
        self.add_moments(sums);
        sums.added += sums.curvature;
    }

    /// A d.
    fn times_few(&self, hessian: &Hessian, d: &[f64]) -> Vec<f64> {
        let rows = self.near.iter().zip(&hessian.few);
        let row = |(near, entries): (&Vec<usize>, &Vec<f64>)| {
            near.iter()
                .zip(entries)
                .map(|(j, entry)| entry * d[*j])
                .sum()
        };
        rows.map(row).collect()
    }

    /// D²φ w for the whole of φ(x, s).
    fn times(&self, hessian: &Hessian, w: &[f64]) -> Vec<f64> {
        let n = self.inputs();
        let mut out = self.times_few(hessian, w);
        for (k, border) in hessian.border.iter().enumerate() {
            add_scaled(&mut out, w[n + k], border);
        }
        for (k, border) in hessian.border.iter().enumerate() {
            let corner: f64 = (0..w.len() - n)
                .map(|l| hessian.corner[(k, l)] * w[n + l])
                .sum();
            out.push(dot(border, w) + corner);
        }
        out
    }

    /// Σ_l D³f[v, d_l, d_l] over the coordinates l, with v = Σ_l g_l d_l = C ∂f/∂x.
    fn drift(&self, correlation: &Lifted<'_>) -> f64 {
        let (n, r) = (self.inputs(), self.cut.hubs());
        let v = self.lifted(self.spread.times(&self.gradient));
        let resting = self.third_along(&v);
        // 2 D³L[v, d, ·]
        let mixed = |d: &[f64]| -> Vec<f64> {
            let both: Vec<f64> = v.iter().zip(d).map(|(v, d)| v + d).collect();
            let (both, alone) = (self.third_along(&both), self.third_along(d));
            (0..both.len())
                .map(|i| both[i] - resting[i] - alone[i])
                .collect()
        };
        let mut twice = Hessian {
            few: self.near.iter().map(|near| vec![0.0; near.len()]).collect(),
            border: vec![vec![0.0; n]; r],
            corner: DMatrix::zeros(r, r),
        };
        for colour in &self.colours {
            fill(
                &mut twice.few,
                &self.near,
                colour,
                &mixed(&self.ones(colour)),
            );
        }
        for k in 0..r {
            twice.set_border(k, &mixed(&self.ones(&[n + k])));
        }
        let mut sum = 0.5 * correlation.trace(&self.near, &twice);
        if r > 0 {
            let moved = self.times(&self.whole, &v);
            let bent = self.through_hubs(|part| correlation.trace(&self.near, part));
            sum += dot(&moved[n..], &bent);
            // s″_vl = q·w_l.
            let mut q: Vec<Vec<f64>> = Vec::with_capacity(r);
            for (k, part) in self.parts.iter().enumerate() {
                let mut own = self.times(part, &v);
                for (j, earlier) in q.iter().enumerate() {
                    add_scaled(&mut own, self.before[(k, j)], earlier);
                }
                q.push(own);
            }
            for (k, q) in q.iter().enumerate() {
                let column = self.times(&self.whole, &self.ones(&[n + k]));
                sum += 2.0 * dot(q, &correlation.times(&column));
            }
        }
        sum
    }

    /// Second derivatives of the hubs: what each has of its own, and what it has from those before.
    fn through_hubs(&self, own: impl Fn(&Hessian) -> f64) -> Vec<f64> {
        let mut bent: Vec<f64> = Vec::with_capacity(self.parts.len());
        for (k, part) in self.parts.iter().enumerate() {
            let earlier: f64 = bent
                .iter()
                .enumerate()
                .map(|(j, b)| self.before[(k, j)] * b)
                .sum();
            bent.push(own(part) + earlier);
        }
        bent
    }

    /// Adds what third and fourth moments of components that stand alone add to those of the normal
    /// distribution.
    fn add_moments(&self, sums: &mut Sums) {
        let own = self.spread.own_moments();
        if own.is_empty() {
            return;
        }
        let thirds = Thirds::new(self);
        for &(input, share, moments) in own {
            let h = share * share * self.second(&self.whole, input);
            let g = share * self.gradient[input];
            let t = share.powi(3) * thirds.of(input);
            sums.curvature += 0.25 * h * h * (moments.fourth - 3.0);
            sums.added += g * h * moments.third + g * t * (moments.fourth / 3.0 - 1.0);
        }
    }

    /// D²φ[w_i, w_i] of an input.
    fn second(&self, hessian: &Hessian, input: usize) -> f64 {
        let at = |k: usize| self.hubs[k][input];
        let own = self.near[input].iter().position(|j| *j == input);
        let mut sum = own.map_or(0.0, |place| hessian.few[input][place]);
        for k in 0..self.hubs.len() {
            sum += 2.0 * hessian.border[k][input] * at(k);
            let corner = (0..self.hubs.len()).map(|l| hessian.corner[(k, l)] * at(l));
            sum += at(k) * corner.sum::<f64>();
        }
        sum
    }
}

impl Hessian {
    /// Takes the column of a hub.
    fn set_border(&mut self, hub: usize, column: &[f64]) {
        let n = self.border[hub].len();
        self.border[hub].copy_from_slice(&column[..n]);
        self.corner.column_mut(hub).copy_from_slice(&column[n..]);
    }
}

/// Takes the entries of the columns of a colour, of which each row has one at most.
fn fill(few: &mut [Vec<f64>], near: &[Vec<usize>], colour: &[usize], column: &[f64]) {
    for &j in colour {
        for &i in &near[j] {
            if let Ok(place) = near[i].binary_search(&j) {
                few[i][place] = column[i];
            }
        }
    }
}

/// Third derivatives of L that decide D³f[d, d, d] for a direction of one input.
struct Thirds<'b, 'a> {
    of: &'b Bordered<'a>,
    /// L_iii
    own: Vec<f64>,
    /// Per hub 3 L_iik.
    once: Vec<Vec<f64>>,
    /// Per pair of hubs, k ≤ l, 3 L_ikl for both orders together, and L_jkl of hubs j.
    twice: Vec<(usize, usize, Vec<f64>)>,
}

impl<'b, 'a> Thirds<'b, 'a> {
    fn new(of: &'b Bordered<'a>) -> Self {
        let (n, r) = (of.inputs(), of.cut.hubs());
        let mut own = vec![0.0; n];
        let mut once = vec![vec![0.0; n]; r];
        let hubs: Vec<Vec<f64>> = (0..r).map(|k| of.third_along(&of.ones(&[n + k]))).collect();
        for colour in &of.colours {
            let alone = of.third_along(&of.ones(colour));
            colour.iter().for_each(|i| own[*i] = alone[*i]);
            for (k, hub) in hubs.iter().enumerate() {
                let mut places = colour.clone();
                places.push(n + k);
                let both = of.third_along(&of.ones(&places));
                for &i in colour {
                    once[k][i] = 1.5 * (both[i] - alone[i] - hub[i]);
                }
            }
        }
        let mut twice = Vec::new();
        for k in 0..r {
            twice.push((k, k, hubs[k].clone()));
            for l in k + 1..r {
                let both = of.third_along(&of.ones(&[n + k, n + l]));
                // L_ikl + L_ilk.
                let pair = (0..n + r).map(|i| both[i] - hubs[k][i] - hubs[l][i]);
                twice.push((k, l, pair.collect()));
            }
        }
        Thirds {
            of,
            own,
            once,
            twice,
        }
    }

    /// D³f[d, d, d] for a step of one unit of an input.
    fn of(&self, input: usize) -> f64 {
        let (n, hubs) = (self.of.inputs(), &self.of.hubs);
        let at = |k: usize| hubs[k][input];
        let mut sum = self.own[input];
        for (k, once) in self.once.iter().enumerate() {
            sum += once[input] * at(k);
        }
        for (k, l, pair) in &self.twice {
            let along_hubs: f64 = (0..hubs.len()).map(|j| pair[n + j] * at(j)).sum();
            sum += (3.0 * pair[input] + along_hubs) * at(*k) * at(*l);
        }
        let whole = &self.of.whole;
        let bent = self.of.through_hubs(|part| self.of.second(part, input));
        for (k, bent) in bent.iter().enumerate() {
            let corner: f64 = (0..hubs.len()).map(|l| whole.corner[(k, l)] * at(l)).sum();
            sum += 3.0 * bent * (whole.border[k][input] + corner);
        }
        sum
    }
}

/// The covariance of x and s to first order: that of x, C, bordered by K = C Sᵀ, with Q = S C Sᵀ.
struct Lifted<'a> {
    spread: &'a Spread<'a>,
    k: Vec<Vec<f64>>,
    q: DMatrix<f64>,
}

impl<'a> Lifted<'a> {
    fn new(spread: &'a Spread<'a>, hubs: &[Vec<f64>]) -> Self {
        let k: Vec<Vec<f64>> = hubs.iter().map(|hub| spread.times(hub)).collect();
        let q = DMatrix::from_fn(hubs.len(), hubs.len(), |a, b| dot(&hubs[a], &k[b]));
        Lifted { spread, k, q }
    }

    /// Σ_ij P_ij φ_ij.
    fn trace(&self, near: &[Vec<usize>], hessian: &Hessian) -> f64 {
        let borders = self.k.iter().zip(&hessian.border);
        let border: f64 = borders.map(|(k, b)| dot(k, b)).sum();
        let corner = self.q.dot(&hessian.corner);
        self.spread.trace(near, &hessian.few) + 2.0 * border + corner
    }

    /// P w.
    fn times(&self, w: &[f64]) -> Vec<f64> {
        let (x, s) = w.split_at(w.len() - self.k.len());
        let mut out = self.spread.times(x);
        for (k, s) in self.k.iter().zip(s) {
            add_scaled(&mut out, *s, k);
        }
        for (a, k) in self.k.iter().enumerate() {
            let corner: f64 = s.iter().enumerate().map(|(b, s)| self.q[(a, b)] * s).sum();
            out.push(dot(k, x) + corner);
        }
        out
    }
}

/// A number that can be divided by.
fn usable(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_normal())
}

/// a + c b, as far as both reach.
fn add_scaled(a: &mut [f64], c: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += c * b);
}

/// a·b, as far as both reach.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Terms, over};
    use super::*;
    use crate::propagate::gum::linearise;

    const COUNT: usize = 21;

    fn budget(text: &str) -> Budget {
        let loaded = crate::budget::read(text, "t", Path::new(""));
        let mut loaded = loaded.unwrap_or_else(|rejection| panic!("{text}\n{rejection}"));
        loaded.rows.remove(0).budget
    }

    /// A formula of many inputs, V, of which every third has another distribution, and of `a`.
    fn independent(model: &str) -> Budget {
        let names: Vec<String> = (0..COUNT).map(|i| format!("x{i}")).collect();
        let model = model.replace('V', &format!("[{}]", names.join(", ")));
        let mut text = format!(
            "title = \"T\"\n[measurand.Y]\nmodel = \"{model}\"\n[input.a]\nvalue = 1.5\nu = 0.2\n"
        );
        for (i, name) in names.iter().enumerate() {
            let u = ["u = 0.2", "half_width = 0.4", "plus = 0.3\nminus = 0.1"][i % 3];
            let value = 1.0 + 0.1 * i as f64;
            text += &format!("[input.{name}]\nvalue = {value}\n{u}\n");
        }
        budget(&text)
    }

    /// The same with inputs that are correlated, and have a component of their own besides.
    fn correlated(model: &str) -> Budget {
        let values: Vec<String> = (0..COUNT)
            .map(|i| format!("{}", 1.0 + 0.1 * i as f64))
            .collect();
        let row = |i: usize| {
            let row: Vec<String> = (0..COUNT)
                .map(|j| format!("{}", 0.5_f64.powi(i.abs_diff(j) as i32)))
                .collect();
            format!("[{}]", row.join(", "))
        };
        let rows: Vec<String> = (0..COUNT).map(row).collect();
        budget(&format!(
            "title = \"T\"\n[measurand.Y]\nmodel = \"{}\"\n[input.a]\nvalue = 1.5\nhalf_width = 0.2\n[input.x]\nvalues = [{}]\nu = 0.2\n[[joint]]\ninputs = [\"x\"]\ncorrelation = [{}]\n",
            model.replace('V', "x"),
            values.join(", "),
            rows.join(", ")
        ))
    }

    fn near(found: f64, expected: f64, size: f64, what: &str) {
        assert!(
            (found - expected).abs() <= 1e-11 * size.abs(),
            "{what}: {found:e}, not {expected:e}"
        );
    }

    fn agrees(budget: &Budget, model: &str) {
        let linear = linearise(budget).unwrap();
        let all = over(budget, &linear, &budget.model.interactions()).remove(0);
        let found = outcomes(budget, &linear, &vec![true; linear.x.len()])
            .unwrap_or_else(|| panic!("{model}: many hubs"))
            .remove(0);
        let u = linear.measurands[0].u;
        near(found.shift, all.shift, u, model);
        near(found.curvature, all.curvature, all.curvature, model);
        for (found, all) in found.slope_deviation.iter().zip(&all.slope_deviation) {
            near(*found, *all, u, model);
        }
        match (found.terms, all.terms) {
            (Terms::Found(found), Terms::Found(all)) => near(found.u, all.u, all.u, model),
            (found, all) => assert_eq!(found, all, "{model}"),
        }
    }

    const MODELS: [&str; 12] = [
        "a * sd(V)",
        "a * norm(V)",
        "a * mean(V)^2",
        "exp(mean(V) / 3) - a",
        "sum(V * V^3) / sum(V^3) - a",
        "sd(V) / mean(V) - a",
        "a * sum(V^2) + sqrt(sum(V))",
        "a * sum(V^2)",
        "sum(sin(V * a) + V)",
        "sum((V - mean(V))^3) / sd(V)^3 - a",
        "norm(V - a) * norm(V + mean(V))",
        "ln(sum(exp(V))) + sum(V) - a",
    ];

    #[test]
    fn sums_over_pairs_are_found_without_pairs() {
        for model in MODELS {
            agrees(&independent(model), model);
        }
    }

    #[test]
    fn correlated_inputs_too() {
        for model in MODELS {
            agrees(&correlated(model), model);
        }
    }

    #[test]
    fn what_has_many_hubs_is_left_alone() {
        let factors: Vec<String> = (0..300)
            .map(|i| format!("(1 + x[{}] * x[{}])", i + 1, (7 * i) % 300 + 1))
            .collect();
        let values = vec!["1"; 300].join(", ");
        let budget = budget(&format!(
            "title = \"T\"\n[measurand.Y]\nmodel = \"{}\"\n[input.x]\nvalues = [{values}]\nu = 0.1\n",
            factors.join(" * ")
        ));
        let linear = linearise(&budget).unwrap();
        assert!(outcomes(&budget, &linear, &[true; 300]).is_none());
    }
}
