//! Expectations at points of the receiver.

use super::kernel::Profile;
use super::linked::Linked;
use super::merge::Landing;
use super::polar;
use super::quadrature::{Pair, gauss_rules};
use super::setting::PlanarSetting;
use super::unfold::Unfolded;
use super::{Bounded, Kernel, Moments, Technique, check};
use crate::pixel::rule::Rule;
use crate::scene::InvalidParameter;
use crate::vector::Vec3;

/// Values below this part of the unclipped irradiance are computed to an absolute tolerance only.
const FAINT: f64 = 1e-6;

/// An estimator of the irradiance of class L S D, and its exact moments.
#[derive(Clone, Debug)]
pub struct Expectation {
    setting: PlanarSetting,
    technique: Technique,
    kernel: Kernel,
    bandwidths: Vec<f64>,
    profile: Profile,
    rules: Vec<Rule>,
}

impl Expectation {
    /// Prepares a technique and a kernel, averaged over a list of bandwidths (one, or a schedule): angles [rad], or radii
    /// [m] for `Merge` and `Linked`.
    ///
    /// # Errors
    /// What [`check`] finds.
    pub fn new(
        setting: PlanarSetting,
        technique: Technique,
        kernel: Kernel,
        bandwidths: &[f64],
    ) -> Result<Self, InvalidParameter> {
        check(technique, kernel, bandwidths)?;
        let angular = technique != Technique::Merge;
        // The linked kernel has a bandwidth per mirror point, so nothing can be averaged beforehand.
        let profiled = match technique {
            Technique::Linked => &bandwidths[..1],
            _ => bandwidths,
        };
        let profiled: Vec<f64> = profiled
            .iter()
            .map(|b| {
                if technique == Technique::Linked {
                    b.min(1.0)
                } else {
                    *b
                }
            })
            .collect();
        Ok(Expectation {
            profile: Profile::new(kernel, angular, &profiled),
            setting,
            technique,
            kernel,
            bandwidths: bandwidths.to_vec(),
            rules: gauss_rules(),
        })
    }

    /// The setting.
    pub fn setting(&self) -> &PlanarSetting {
        &self.setting
    }

    /// The technique.
    pub fn technique(&self) -> Technique {
        self.technique
    }

    /// Moments of the irradiance [W/m², (W/m²)²] at a point of the receiver.
    ///
    /// The tolerance is relative; values that are fainter than 1e-6 of the irradiance by an unbounded mirror are
    /// computed to 1e-6 of the tolerance of that.
    ///
    /// **Domain**: the receiver's plane is the one through `x`. **Accuracy**: as stated in the error bounds; on the
    /// reference tables 1e-12 (tested).
    pub fn at(&self, x: [f64; 3], tolerance: f64) -> Moments {
        let x = Vec3::from_f64(x);
        let tolerance = tolerance.clamp(2e-14, 0.1);
        let result = match self.technique {
            Technique::Merge => Landing::new(&self.setting, x).map(|landing| {
                let strength = self.setting.strength;
                let from = self.setting.image() - x;
                let brightest = strength / from.length_squared();
                let floor = FAINT * brightest;
                let factor = 4.0 * core::f64::consts::PI * strength * self.profile.ratio();
                polar::integrate(&landing, &self.profile, tolerance, [floor, floor * factor])
            }),
            technique => Unfolded::new(&self.setting, x, technique).map(|unfolded| {
                let distance = unfolded.a + unfolded.b;
                let floor = FAINT * self.setting.strength / (distance * distance);
                let sample = unfolded.sample_at_root();
                if technique == Technique::Linked {
                    self.linked(x, &unfolded, tolerance, floor, sample)
                } else {
                    let factor = sample * self.profile.ratio();
                    polar::integrate(&unfolded, &self.profile, tolerance, [floor, floor * factor])
                }
            }),
        };
        let r = result.unwrap_or_default();
        let bounded = |k: usize| Bounded {
            value: r.value[k],
            error: r.error[k],
        };
        Moments {
            mean: bounded(0),
            second_moment: bounded(1),
        }
    }

    fn linked(
        &self,
        x: Vec3<f64>,
        unfolded: &Unfolded,
        tolerance: f64,
        floor: f64,
        sample: f64,
    ) -> Pair {
        let mut sum = Pair::default();
        let share = 1.0 / self.bandwidths.len() as f64;
        for &r in &self.bandwidths {
            let narrow = libm::atan2(r, unfolded.a);
            let floors = [floor, floor * sample / (narrow * narrow)];
            let linked = Linked::new(&self.setting, x, unfolded, self.kernel, r, &self.rules);
            sum.add(&linked.integrate(tolerance, floors).scaled(share));
        }
        sum
    }
}
