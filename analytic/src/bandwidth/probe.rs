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
    largest: f64,
    smallest: f64,
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
        let profile = match technique {
            // The linked kernel has a bandwidth per mirror point: nothing can be averaged beforehand.
            Technique::Linked => Profile::default(),
            Technique::Merge => Profile::new(kernel, false, bandwidths),
            _ => Profile::new(kernel, true, bandwidths),
        };
        Ok(Expectation {
            profile,
            largest: bandwidths.iter().copied().fold(0.0, f64::max),
            smallest: bandwidths.iter().copied().fold(f64::INFINITY, f64::min),
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

    /// The kernel.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// The bandwidths over which it is averaged.
    pub fn bandwidths(&self) -> &[f64] {
        &self.bandwidths
    }

    pub(super) fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The irradiance at bandwidth zero [W/m²]: R I h/D³ where the mirror lights x, h the height and D the distance of the
    /// light's image.
    pub fn sharp(&self, x: [f64; 3]) -> f64 {
        let x = Vec3::from_f64(x);
        Landing::new(&self.setting, x, false).map_or(0.0, |l| l.sharp())
    }

    /// Moments of the irradiance [W/m², (W/m²)²] at a point of the receiver.
    ///
    /// The tolerance is relative; values that are fainter than 1e-6 of the irradiance by an unbounded mirror are
    /// computed to 1e-6 of the tolerance of that.
    ///
    /// **Domain**: the receiver's plane is the one through `x`. **Accuracy**: as stated in the error bounds; on the
    /// reference tables 1e-12 (tested).
    pub fn at(&self, x: [f64; 3], tolerance: f64) -> Moments {
        self.examine(x, tolerance).0
    }

    /// The moments, and whether the kernel's support is whole or misses the domain (roughly, for `Linked`): then a
    /// neighbourhood of x holds no kink.
    pub(super) fn examine(&self, x: [f64; 3], tolerance: f64) -> (Moments, bool) {
        let x = Vec3::from_f64(x);
        let tolerance = tolerance.clamp(2e-14, 0.1);
        let result = match self.technique {
            Technique::Merge => Landing::new(&self.setting, x, true).map(|landing| {
                let floor = self.floor(x);
                (
                    polar::integrate(&landing, &self.profile, tolerance, floor),
                    polar::is_plain(&landing, self.profile.end),
                )
            }),
            Technique::Linked => Unfolded::new(&self.setting, x, self.technique).map(|unfolded| {
                let reach = libm::atan2(self.largest, unfolded.a).min(1.0);
                (
                    self.linked(x, &unfolded, tolerance),
                    polar::is_plain(&unfolded, reach),
                )
            }),
            technique => Unfolded::new(&self.setting, x, technique).map(|unfolded| {
                (
                    polar::integrate(&unfolded, &self.profile, tolerance, self.floor(x)),
                    polar::is_plain(&unfolded, self.profile.end),
                )
            }),
        };
        let (r, plain) = result.unwrap_or((Pair::default(), true));
        // Where a border cuts the kernel, its place within the kernel is known to the rounding of the coordinates.
        let size = (self.setting.image() - x).length() + x.length();
        let finest = if plain { f64::INFINITY } else { self.smallest };
        let rounding = 8.0 * f64::EPSILON * (1.0 + size.max(1.0) / finest);
        let bounded = |k: usize| Bounded {
            value: r.value[k],
            error: r.error[k] + rounding * r.value[k],
        };
        let moments = Moments {
            mean: bounded(0),
            second_moment: bounded(1),
        };
        (moments, plain)
    }

    fn floor(&self, x: Vec3<f64>) -> [f64; 2] {
        self.unclipped(x).map(|v| FAINT * v)
    }

    /// Mean and second moment at small bandwidth if mirror and receiver were unbounded, to the leading order and without
    /// the receiver's cosine: what faint values are measured by.
    pub(super) fn unclipped(&self, x: Vec3<f64>) -> [f64; 2] {
        let strength = self.setting.strength;
        let from = self.setting.image() - x;
        let mean = strength / from.length_squared();
        let light = 4.0 * core::f64::consts::PI * strength;
        let factor = match (
            self.technique,
            Unfolded::new(&self.setting, x, self.technique),
        ) {
            (Technique::Merge, _) => light * self.profile.ratio(),
            (_, None) => 0.0,
            (Technique::Linked, Some(u)) => {
                let narrow = libm::atan2(self.smallest, u.a);
                u.sample_at_root() / (core::f64::consts::PI * narrow * narrow)
            }
            (_, Some(u)) => u.sample_at_root() * self.profile.ratio(),
        };
        [mean, mean * factor]
    }

    /// Whether a receiver point is on the border of what the mirror lights (for `Merge`, of what photons reach: the
    /// receiver's edges belong to it). The mollified irradiance changes fast there.
    pub(super) fn is_on_lit_border(&self, x: Vec3<f64>) -> bool {
        Landing::new(&self.setting, x, self.technique == Technique::Merge)
            .is_some_and(|l| l.is_on_border(1e-8 * (1.0 + x.length())))
    }

    fn linked(&self, x: Vec3<f64>, unfolded: &Unfolded, tolerance: f64) -> Pair {
        let mut sum = Pair::default();
        let share = 1.0 / self.bandwidths.len() as f64;
        let floor = self.floor(x);
        for &r in &self.bandwidths {
            let linked = Linked::new(&self.setting, x, unfolded, self.kernel, r, &self.rules);
            sum.add(&linked.integrate(tolerance, floor).scaled(share));
        }
        sum
    }
}
