//! Integrals of a kernel's shape, in the limit of small bandwidth, where every kernel is a function of t = distance/bandwidth
//! on a plane: φ = f(t)/α², 2π ∫ f t dt = 1.
//!
//! ```text
//! cone (angle), disc   f = 1/π               Epanechnikov  f = (2/π)(1 − t²)
//! biweight             f = (3/π)(1 − t²)²    cone (radius) f = (3/π)(1 − t)
//! von Mises–Fisher     f = (2/π) exp(−2t²)
//! ```
//!
//! All moments ∫ fⁿ tᵃ dt are Beta or Gamma functions. **Accuracy**: 1e-14 relative.

use core::f64::consts::PI;

use libm::{pow, tgamma};

use crate::bandwidth::Kernel;

/// B(a, b).
fn beta(a: f64, b: f64) -> f64 {
    tgamma(a) * tgamma(b) / tgamma(a + b)
}

/// The shape of a kernel at small bandwidth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    kernel: Kernel,
    angular: bool,
}

impl Shape {
    pub fn new(kernel: Kernel, angular: bool) -> Self {
        Shape { kernel, angular }
    }

    /// f at the top.
    pub fn top(&self) -> f64 {
        match (self.kernel, self.angular) {
            (Kernel::Cone, true) | (Kernel::Disc, _) => 1.0 / PI,
            (Kernel::Epanechnikov | Kernel::VonMisesFisher, _) => 2.0 / PI,
            (Kernel::Biweight, _) | (Kernel::Cone, false) => 3.0 / PI,
        }
    }

    /// ∫ fⁿ tᵃ dt over the support, n = 1 or 2, a > −1.
    pub fn radial(&self, n: i32, a: f64) -> f64 {
        let m = f64::from(n);
        let rest = match (self.kernel, self.angular) {
            (Kernel::Cone, true) | (Kernel::Disc, _) => 1.0 / (a + 1.0),
            (Kernel::Epanechnikov, _) => 0.5 * beta(0.5 * (a + 1.0), m + 1.0),
            (Kernel::Biweight, _) => 0.5 * beta(0.5 * (a + 1.0), 2.0 * m + 1.0),
            (Kernel::Cone, false) => beta(a + 1.0, m + 1.0),
            (Kernel::VonMisesFisher, _) => {
                let half = 0.5 * (a + 1.0);
                0.5 * tgamma(half) * pow(2.0 * m, -half)
            }
        };
        pow(self.top(), m) * rest
    }

    /// ⟨t²⟩ = 2π ∫ f t³ dt: 1/2 for the cone.
    pub fn second(&self) -> f64 {
        2.0 * PI * self.radial(1, 3.0)
    }

    /// ∫ fⁿ over the plane: 1 for n = 1, and for n = 2 what a second moment has times α².
    pub fn whole(&self, n: i32) -> f64 {
        2.0 * PI * self.radial(n, 1.0)
    }

    /// ∫ fⁿ |Y|ˢ over the plane, Y a Cartesian coordinate, s > −1.
    pub fn across(&self, n: i32, s: f64) -> f64 {
        2.0 * beta(0.5 * (s + 1.0), 0.5) * self.radial(n, s + 1.0)
    }

    /// ∫ fⁿ along a line through the middle.
    pub fn line(&self, n: i32) -> f64 {
        2.0 * self.radial(n, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the definitions, on a grid over the plane.
    #[test]
    fn moments_are_those_of_a_grid() {
        let kernels = [
            (Kernel::Cone, true),
            (Kernel::Epanechnikov, true),
            (Kernel::VonMisesFisher, true),
            (Kernel::Disc, false),
            (Kernel::Biweight, false),
            (Kernel::Cone, false),
        ];
        for (kernel, angular) in kernels {
            let s = Shape::new(kernel, angular);
            let f = |t: f64| match (kernel, angular) {
                (Kernel::VonMisesFisher, _) => 2.0 / PI * libm::exp(-2.0 * t * t),
                _ if t >= 1.0 => 0.0,
                (Kernel::Epanechnikov, _) => 2.0 / PI * (1.0 - t * t),
                (Kernel::Biweight, _) => 3.0 / PI * (1.0 - t * t) * (1.0 - t * t),
                (Kernel::Cone, false) => 3.0 / PI * (1.0 - t),
                _ => 1.0 / PI,
            };
            // Midpoints in √t, which takes the singular powers.
            let n = 20_000;
            let end = if kernel == Kernel::VonMisesFisher {
                2.4
            } else {
                1.0
            };
            for power in [1, 2] {
                for a in [-0.5, 0.0, 1.0, 2.0, 3.0] {
                    let sum: f64 = (0..n)
                        .map(|k| {
                            let v = end * (f64::from(k) + 0.5) / f64::from(n);
                            let t = v * v;
                            pow(f(t), f64::from(power)) * pow(t, a) * 2.0 * v * end / f64::from(n)
                        })
                        .sum();
                    let exact = s.radial(power, a);
                    assert!(
                        (sum / exact - 1.0).abs() < 1e-6,
                        "{kernel} {power} {a} {sum} {exact}"
                    );
                }
            }
            assert!((s.whole(1) - 1.0).abs() < 1e-14);
        }
        // theory/bandwidth.md, section 5, and facts.md, section 2.1.
        let disc = Shape::new(Kernel::Disc, false);
        assert!((0.5 * disc.across(1, -0.5) - 1.1128).abs() < 5e-5);
        assert!((disc.second() - 0.5).abs() < 1e-15);
        let biweight = Shape::new(Kernel::Biweight, false);
        assert!((biweight.second() - 0.25).abs() < 1e-15);
        assert!((biweight.whole(2) - 0.57296).abs() < 5e-6);
    }
}
