//! How an integrator is built: its kernel, and the defect it is given on purpose.

use nephroid_analytic::class::PathClass;

use super::kernel::Kernel;
use crate::geometry::scene::Overrides;

/// How an integrator is built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// The mollifier of methods that regularize; `None` is the method's default. Ignored by the others.
    pub kernel: Option<Kernel>,
    /// A defect, to test what judges the integrator.
    pub fault: Option<Fault>,
}

/// A defect modelled on what goes wrong in real renderers.
///
/// It is injected where the code would have it, by changing constants when the scene is prepared, so that a healthy
/// integrator pays nothing for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The cosine at the receiver once more: in next event estimation, at a regularized connection's sampled direction,
    /// and on photons, whose flux has it already.
    CosineTwice,
    /// The kernel on the angle normalised on the tangent plane, by πα² for a cone, in place of the sphere. Changes
    /// nothing for kernels on a radius, for which it is right.
    KernelNormalizedByPiAlphaSquared,
    /// The bandwidth in place of its square in the kernel's normalisation.
    RadiusForRadiusSquared,
    /// Intensity (or irradiance of a directional light) 1 in place of the light's own.
    IntensityForgotten,
    /// Reflectance 1 in place of the mirror's own. Changes nothing where there is no mirror.
    ReflectanceForgotten,
    /// The paths of one class are lost.
    ClassDropped(PathClass),
}

/// A fault as multipliers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Defect {
    fault: Option<Fault>,
    /// An extra factor 1 + slope (cos θ - 1) where a cosine at the receiver enters: exactly 1 for slope 0.
    cosine_slope: f64,
}

impl Defect {
    pub(super) fn new(fault: Option<Fault>) -> Self {
        let twice = fault == Some(Fault::CosineTwice);
        Defect {
            fault,
            cosine_slope: if twice { 1.0 } else { 0.0 },
        }
    }

    /// The factor that belongs beside the cosine at the receiver: 1 without a fault.
    #[inline(always)]
    pub(super) fn beside_cosine(&self, cosine: f64) -> f64 {
        1.0 + self.cosine_slope * (cosine - 1.0)
    }

    /// 0 for a lost class, else 1.
    pub(super) fn class_scale(&self, class: PathClass) -> f64 {
        if self.fault == Some(Fault::ClassDropped(class)) {
            0.0
        } else {
            1.0
        }
    }

    /// What the fault does to the scene's constants.
    pub(super) fn overrides(&self) -> Overrides {
        let one_if = |fault| (self.fault == Some(fault)).then_some(1.0);
        Overrides {
            light_strength: one_if(Fault::IntensityForgotten),
            reflectance: one_if(Fault::ReflectanceForgotten),
        }
    }
}
