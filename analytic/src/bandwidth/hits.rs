//! How often a sample is not zero: the probability that one sample of the estimator falls inside the kernel's support.
//!
//! With w the density of the mean and f the value of a sample, both without the kernel, samples are drawn with density
//! w/f. So the probability of a sample that is not zero is ∫ w/f over the support, which is ∫ φ w/f divided by the height
//! of a kernel that is constant. Merging: w/f = E/(4πRI), one photon. A bandwidth that shrinks faster than n^(−1/2) makes the
//! sum of these probabilities finite while every expectation stays right: only counts show it
//! (`theory/consistency.md`, section 2). Derived here.

use super::clip::Domain;
use super::kernel::cone_height;
use super::merge::Landing;
use super::polar::{self, Chart};
use super::probe::Expectation;
use super::unfold::Unfolded;
use super::{Bounded, Kernel, Technique};
use crate::vector::Vec3;

/// A chart whose density is that of the samples.
struct Sampled<'a, C>(&'a C);

impl<C: Chart> Chart for Sampled<'_, C> {
    type Line = C::Line;

    fn line(&self, c: f64, s: f64) -> C::Line {
        self.0.line(c, s)
    }

    fn level(&self, line: &C::Line, rho: f64) -> f64 {
        self.0.level(line, rho)
    }

    fn density(&self, line: &C::Line, level: f64) -> [f64; 2] {
        let [mean, second] = self.0.density(line, level);
        [
            if mean > 0.0 {
                mean * mean / second
            } else {
                0.0
            },
            0.0,
        ]
    }

    fn farthest(&self, level: f64) -> f64 {
        self.0.farthest(level)
    }

    fn domain(&self) -> &Domain {
        self.0.domain()
    }
}

impl Expectation {
    /// The probability that one sample at a point of the receiver is not zero, to a relative tolerance. `None` unless the kernel
    /// is constant within its support (cone on the angle, disc on the radius) and there is one bandwidth, or for the
    /// technique `linked`.
    pub fn hit_probability(&self, x: [f64; 3], tolerance: f64) -> Option<Bounded> {
        let &[bandwidth] = self.bandwidths() else {
            return None;
        };
        let x = Vec3::from_f64(x);
        let tolerance = tolerance.clamp(2e-14, 0.1);
        // Probabilities below this are known to an absolute tolerance only.
        let floor = [1e-12, 1.0];
        let (sum, height) = match (self.technique(), self.kernel()) {
            (Technique::Merge, Kernel::Disc) => {
                let chart = Landing::new(self.setting(), x, true);
                let height = 1.0 / (core::f64::consts::PI * bandwidth * bandwidth);
                let sum = chart.map(|c| {
                    polar::integrate(
                        &Sampled(&c),
                        self.profile(),
                        tolerance,
                        floor.map(|f| f * height),
                    )
                });
                (sum, height)
            }
            (Technique::Camera | Technique::Light | Technique::Symmetric, Kernel::Cone) => {
                let chart = Unfolded::new(self.setting(), x, self.technique());
                let height = cone_height(bandwidth);
                let sum = chart.map(|c| {
                    polar::integrate(
                        &Sampled(&c),
                        self.profile(),
                        tolerance,
                        floor.map(|f| f * height),
                    )
                });
                (sum, height)
            }
            _ => return None,
        };
        let sum = sum.unwrap_or_default();
        Some(Bounded {
            value: sum.value[0] / height,
            error: sum.error[0] / height + 4.0 * f64::EPSILON * sum.value[0] / height,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::PlanarSetting;
    use super::*;

    fn expectation(technique: Technique, kernel: Kernel, bandwidth: f64) -> Expectation {
        // Scene B1: light on the mirror's normal at 0.8, receiver at 2, mirror and receiver parallel.
        let setting = PlanarSetting::unbounded(
            [0.0, 0.0, 1.2],
            1.5,
            [0.0, 0.0, 2.0],
            [0.0, 0.0, -1.0],
            0.9,
            [0.0, 0.0, 1.0],
        );
        let setting = setting.unwrap_or_else(|e| panic!("{e}"));
        Expectation::new(setting, technique, kernel, &[bandwidth]).unwrap_or_else(|e| panic!("{e}"))
    }

    /// `theory/bandwidth.md` section 4, small angles: (i) c_x a² r2²/(r1+r2)², (ii) a² r1²/(4 (r1+r2)²), (iii) E r²/(4 R I).
    #[test]
    fn small_bandwidths_have_the_table_of_the_theory() {
        let a = 1e-3;
        let (r1, r2) = (2.0_f64, 0.8_f64);
        let d2 = (r1 + r2) * (r1 + r2);
        let at = |t, k, b| {
            let p = expectation(t, k, b).hit_probability([0.0; 3], 1e-10);
            p.map_or(f64::NAN, |p| p.value)
        };
        let camera = at(Technique::Camera, Kernel::Cone, a) / (a * a * r2 * r2 / d2);
        let light = at(Technique::Light, Kernel::Cone, a) / (a * a * r1 * r1 / (4.0 * d2));
        let merge = at(Technique::Merge, Kernel::Disc, a) / (a * a / (4.0 * d2));
        for ratio in [camera, light, merge] {
            assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
        }
    }

    /// On the axis the hits of the camera side are a disc about the axis: the deflection at distance t from it is
    /// atan(t/p) + atan(t/q), and cos/π integrates to sin² of the angle at x.
    #[test]
    fn a_wide_cone_on_the_axis() {
        let (p, q, a) = (2.0, 0.8, 0.6);
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..200 {
            let t: f64 = 0.5 * (low + high);
            if libm::atan(t / p) + libm::atan(t / q) < a {
                low = t;
            } else {
                high = t;
            }
        }
        let sine = libm::sin(libm::atan(low / p));
        let found =
            expectation(Technique::Camera, Kernel::Cone, a).hit_probability([0.0; 3], 1e-12);
        let found = found.unwrap_or_default();
        assert!(
            (found.value / (sine * sine) - 1.0).abs() < 1e-11,
            "{found:?}"
        );
        assert!(found.error < 1e-9 * found.value);
    }

    #[test]
    fn kernels_that_are_not_constant_have_no_single_height() {
        for (technique, kernel) in [
            (Technique::Camera, Kernel::VonMisesFisher),
            (Technique::Merge, Kernel::Epanechnikov),
            (Technique::Linked, Kernel::Cone),
        ] {
            let found = expectation(technique, kernel, 0.2).hit_probability([0.0; 3], 1e-6);
            assert!(found.is_none());
        }
    }
}
