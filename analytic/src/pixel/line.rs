//! One-dimensional quadrature between known break points, where the integrand is analytic.

use crate::camera::Bounded;
use crate::pixel::rule::Rule;

/// Gauss rules of increasing order.
#[derive(Clone, Debug)]
pub struct Line {
    rules: Vec<Rule>,
}

impl Default for Line {
    fn default() -> Self {
        Line {
            rules: [3, 4, 6, 9, 13, 18].map(Rule::gauss).into(),
        }
    }
}

/// How often an interval is halved at most: an end singularity is approached to 2⁻⁴⁰ of its length.
const DEEPEST: u32 = 40;

impl Line {
    /// ∫ f over [a, b] to an absolute tolerance.
    ///
    /// The order is raised until two neighbours agree, to the tolerance or to the integrand's own error bound, which the
    /// value of `f` carries; then the interval is halved. The error is the difference of the last two orders on each piece
    /// or, should these agree by chance, a tenth of the one before, plus rounding, plus the integrand's own.
    pub fn integrate(
        &self,
        a: f64,
        b: f64,
        tolerance: f64,
        f: &mut impl FnMut(f64) -> Bounded,
    ) -> Bounded {
        self.descend(a, b, tolerance, DEEPEST, f)
    }

    fn descend(
        &self,
        a: f64,
        b: f64,
        tolerance: f64,
        depth: u32,
        f: &mut impl FnMut(f64) -> Bounded,
    ) -> Bounded {
        let length = b - a;
        if !(length > 0.0) {
            return Bounded::default();
        }
        let (mut before, mut last) = (f64::INFINITY, f64::INFINITY);
        let mut result = Bounded::default();
        for rule in &self.rules {
            let mut sum = Bounded::default();
            for (x, w) in rule.iter() {
                let y = f(a + length * x);
                sum.value += w * y.value;
                sum.error += w * y.error;
            }
            let value = sum.value * length;
            let own = sum.error * length + 16.0 * f64::EPSILON * value.abs();
            let step = (value - before).abs();
            let difference = step.max(0.1 * last);
            result = Bounded {
                value,
                error: own + difference,
            };
            if difference <= tolerance.max(2.0 * own) {
                return result;
            }
            (before, last) = (value, step);
        }
        let middle = a + 0.5 * length;
        if depth == 0 || !(middle > a && middle < b) {
            return result;
        }
        // Half the tolerance each would ask too much near a singular end, where only one side is difficult.
        let share = 0.7 * tolerance;
        let left = self.descend(a, middle, share, depth - 1, f);
        let right = self.descend(middle, b, share, depth - 1, f);
        Bounded {
            value: left.value + right.value,
            error: left.error + right.error,
        }
    }
}
