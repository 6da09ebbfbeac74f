//! Roots of implicit equations F(y, p) = 0, with derivatives by the implicit function theorem.

use super::graph::Graph;
use super::jet::Jet;

/// Newton steps before a root is given up.
const MAX_STEPS: usize = 200;
/// Halvings of a step that does not lessen |F|.
const MAX_HALVINGS: usize = 60;
/// Relative length of a last Newton step that may be rounding noise.
const NEAR: f64 = 1e-8;

/// y(p) as a jet; not a number where no root is found.
pub fn root<const N: usize>(residual: &Graph, start: f64, parameters: &[Jet<N>]) -> Jet<N> {
    let fixed = parameters.iter().map(Jet::value);
    let Some((value, slope)) = Newton::new(residual).run(start, fixed) else {
        return Jet::constant(f64::NAN);
    };
    // Each chord step with the slope at the root makes one more derivative right.
    let mut y = Jet::constant(value);
    let mut inputs = Vec::with_capacity(parameters.len() + 1);
    for _ in 1..N {
        inputs.clear();
        inputs.push(y);
        inputs.extend_from_slice(parameters);
        let f = residual.evaluate(&inputs)[residual.outputs[0] as usize];
        y = (y - f / Jet::constant(slope)).with_value(value);
    }
    y
}

/// ∂y/∂p_k = -F_pk / F_y at the root y(p).
pub fn slopes<const N: usize>(residual: &Graph, y: Jet<N>, parameters: &[Jet<N>]) -> Vec<Jet<N>> {
    let inputs: Vec<Jet<N>> = std::iter::once(y)
        .chain(parameters.iter().copied())
        .collect();
    let values = residual.evaluate(&inputs);
    let gradient = residual.gradient(&values, residual.outputs[0], inputs.len());
    let by_y = -gradient[0].recip();
    gradient[1..].iter().map(|by_p| *by_p * by_y).collect()
}

/// Newton's method at fixed parameters; used again and again for the trials of a block.
pub struct Newton<'g> {
    residual: &'g Graph,
    inputs: Vec<Jet<2>>,
    values: Vec<Jet<2>>,
    /// Points between which F changes its sign, each with the sign of F there.
    bracket: [Option<f64>; 2],
}

impl<'g> Newton<'g> {
    /// Prepares for one equation.
    pub fn new(residual: &'g Graph) -> Self {
        Newton {
            residual,
            inputs: Vec::new(),
            values: Vec::new(),
            bracket: [None, None],
        }
    }

    /// F and F_y at y; remembers on which side of the root y is.
    fn at(&mut self, y: f64) -> (f64, f64) {
        self.inputs[0] = Jet::line(y, 1.0);
        self.residual.evaluate_into(&self.inputs, &mut self.values);
        let [f, slope] = self.values[self.residual.outputs[0] as usize].0;
        if f < 0.0 {
            self.bracket[0] = Some(y);
        } else if f > 0.0 {
            self.bracket[1] = Some(y);
        }
        (f, slope)
    }

    /// The root and F_y there.
    ///
    /// A step that does not lessen |F| is halved; once F has changed its sign, a step that leaves the
    /// bracket goes to its middle instead.
    pub fn run(&mut self, start: f64, parameters: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
        self.bracket = [None, None];
        self.inputs.clear();
        self.inputs
            .extend(std::iter::once(start).chain(parameters).map(Jet::constant));
        let mut y = start;
        let mut size = start.abs();
        let (mut f, mut slope) = self.at(y);
        for _ in 0..MAX_STEPS {
            if f == 0.0 {
                return slope.is_finite().then_some((y, slope));
            }
            if !f.is_finite() {
                return None;
            }
            size = size.max(y.abs());
            let whole_step = self.step(y, f, slope)?;
            let mut step = whole_step;
            let mut next = self.at(y + step);
            // At the rounding level |F| no longer falls; the step is then as small as it can be.
            let tiny = 4.0 * f64::EPSILON * y.abs();
            let lessens = |g: f64| g.abs() < f.abs();
            let mut halvings = 0;
            while !lessens(next.0) && step.abs() > tiny && halvings < MAX_HALVINGS {
                step /= 2.0;
                next = self.at(y + step);
                halvings += 1;
            }
            if step.abs() <= tiny || y + step == y || halvings == MAX_HALVINGS {
                // A long step that had to shrink to nothing was stuck at a minimum of |F| or a pole.
                let (y, slope) = if lessens(next.0) {
                    (y + step, next.1)
                } else {
                    (y, slope)
                };
                let at_root = whole_step.abs() <= NEAR * size && slope.is_finite() && slope != 0.0;
                return at_root.then_some((y, slope));
            }
            y += step;
            (f, slope) = next;
        }
        None
    }

    /// Newton's step from y, kept inside the bracket.
    fn step(&self, y: f64, f: f64, slope: f64) -> Option<f64> {
        let newton = -f / slope;
        match self.bracket {
            [Some(a), Some(b)] => {
                let inside = newton.is_finite() && (y + newton - a) * (y + newton - b) <= 0.0;
                Some(if inside { newton } else { 0.5 * (a + b) - y })
            }
            _ => newton.is_finite().then_some(newton),
        }
    }
}
