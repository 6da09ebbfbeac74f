//! Distribution functions and quantiles of the bounded symmetric kinds, which say only what they are on one side of ±1.

/// A bounded symmetric distribution, its support scaled to ±1.
pub(super) trait Symmetric {
    /// Smallest and largest value.
    fn ends(&self) -> [f64; 2];

    /// Probability beyond u on one side, 0 ≤ u ≤ 1.
    fn beyond(&self, u: f64) -> f64;

    /// Inverse of [`Symmetric::beyond`]: distance from the end, 0 … 1, that holds a fraction q ≤ ½.
    fn inward(&self, q: f64) -> f64;

    /// Probability below x.
    fn below(&self, x: f64) -> f64 {
        let (u, beyond) = self.one_side(x);
        if u < 0.0 { beyond } else { 1.0 - beyond }
    }

    /// Probability above x.
    fn above(&self, x: f64) -> f64 {
        let (u, beyond) = self.one_side(x);
        if u < 0.0 { 1.0 - beyond } else { beyond }
    }

    /// The x below which a fraction p lies.
    fn at_fraction_below(&self, p: f64) -> f64 {
        if p < 0.5 {
            self.on_side(p, -1.0)
        } else {
            self.on_side(1.0 - p, 1.0)
        }
    }

    /// The x above which a fraction q lies.
    fn at_fraction_above(&self, q: f64) -> f64 {
        if q < 0.5 {
            self.on_side(q, 1.0)
        } else {
            self.on_side(1.0 - q, -1.0)
        }
    }

    /// The place of x on ±1 and the probability beyond it.
    fn one_side(&self, x: f64) -> (f64, f64) {
        let [lower, upper] = self.ends();
        let u = (x - 0.5 * (lower + upper)) / (0.5 * (upper - lower));
        (u, self.beyond(u.abs().min(1.0)))
    }

    /// The place on the side `sign` beyond which a fraction q ≤ ½ lies.
    fn on_side(&self, q: f64, sign: f64) -> f64 {
        let [lower, upper] = self.ends();
        let (middle, half_width) = (0.5 * (lower + upper), 0.5 * (upper - lower));
        // From the end that is nearer, so that the ends themselves are exact.
        let inward = self.inward(q);
        if inward > 0.5 {
            middle + sign * half_width * (1.0 - inward)
        } else if sign < 0.0 {
            lower + half_width * inward
        } else {
            upper - half_width * inward
        }
    }
}

/// What every bounded symmetric kind with the fields `lower` and `upper` says in the same way.
macro_rules! symmetric {
    () => {
        fn shifted(&self, by: f64) -> Self {
            let mut shifted = *self;
            shifted.lower += by;
            shifted.upper += by;
            shifted
        }

        fn mirrored(&self) -> Option<Self> {
            let mut mirrored = *self;
            (mirrored.lower, mirrored.upper) = (-self.upper, -self.lower);
            Some(mirrored)
        }

        fn mean(&self) -> Option<f64> {
            Some(0.5 * (self.lower + self.upper))
        }

        fn third_central_moment(&self) -> Option<f64> {
            Some(0.0)
        }

        fn cdf(&self, x: f64) -> f64 {
            self.below(x)
        }

        fn sf(&self, x: f64) -> f64 {
            self.above(x)
        }

        fn quantile(&self, p: f64) -> f64 {
            self.at_fraction_below(p)
        }

        fn upper_quantile(&self, q: f64) -> f64 {
            self.at_fraction_above(q)
        }

        fn support(&self) -> (f64, f64) {
            let [lower, upper] = self.ends();
            (lower, upper)
        }
    };
}
pub(super) use symmetric;
