//! Expectations at points of the floor of any catalogue or user entry.

use super::chart::chain::Chained;
use super::chart::connection::{Caustic, Connection};
use super::chart::link::{Case, Link, Receiver};
use super::chart::merging::Merging;
use super::chart::{integrate, scenes};
use super::kernel::Profile;
use super::light::{self, Class};
use super::quadrature::Pair;
use super::{Bounded, Convention, Kernel, Moments, Technique, check};
use crate::class::PathClass;
use crate::kinds::flat_interface::FlatInterface;
use crate::kinds::sphere_mirror::SphereMirror;
use crate::scene::{Entry, InvalidParameter};

/// An estimator of the irradiance that a floor receives through specular surfaces, and its exact moments, per path class.
#[derive(Clone, Debug)]
pub struct EntryExpectation {
    classes: Vec<Class>,
    receiver: Receiver,
    technique: Technique,
    kernel: Kernel,
    convention: Convention,
    /// Whether linked paths are built from the camera.
    from_camera: bool,
    bandwidths: Vec<f64>,
    profile: Profile,
}

/// Which estimator: a technique and a kernel, averaged over a list of bandwidths (one, or a schedule).
#[derive(Clone, Copy, Debug)]
pub struct Estimator<'a> {
    /// The technique.
    pub technique: Technique,
    /// The kernel.
    pub kernel: Kernel,
    /// How a linked bandwidth is found; of no meaning otherwise.
    pub convention: Convention,
    /// Angles [rad], or radii [m] for `Merge` and `Linked`.
    pub bandwidths: &'a [f64],
}

impl EntryExpectation {
    /// Prepares an estimator for an entry.
    ///
    /// Second moments are those of one sample with the densities of `theory/bandwidth.md` section 2. `beam_area` is the
    /// cross-section [m²] over which the photons of parallel light are uniform.
    ///
    /// # Errors
    /// What [`Entry::validate`] and [`check`] find; a kind of which the technique has no expectation here.
    pub fn new(
        entry: &Entry,
        estimator: Estimator<'_>,
        beam_area: f64,
    ) -> Result<Self, InvalidParameter> {
        entry.validate()?;
        let technique = estimator.technique;
        check(technique, estimator.kernel, estimator.bandwidths)?;
        if estimator.convention == Convention::Light
            && technique == Technique::Linked
            && scenes::is_beam(&entry.kind)
        {
            return Err(InvalidParameter {
                key: "convention".to_owned(),
                found: estimator.convention.name().to_owned(),
                allowed: "exact, vertex (parallel light is infinitely far away)".to_owned(),
            });
        }
        let (receiver, classes) = light::of_entry(entry, technique, beam_area)?;
        Ok(Self::of(classes, receiver, estimator))
    }

    /// The technique `camera` with a linked bandwidth: paths from the floor point, mollified at the vertex s next to the light within
    /// atan(r/d), r a radius [m], `Linked` from the other side. `convention` is where d ends: what the exact ray from s meets first
    /// (the floor, or the surface again; where it leaves the scene, d is the scene's diagonal), the floor point, or the light.
    ///
    /// # Errors
    /// As for [`Self::new`] with `Linked`.
    pub fn linked_from_camera(
        entry: &Entry,
        kernel: Kernel,
        convention: Convention,
        radii: &[f64],
    ) -> Result<Self, InvalidParameter> {
        let estimator = Estimator {
            technique: Technique::Linked,
            kernel,
            convention,
            bandwidths: radii,
        };
        // No photons: the beam's cross-section is of no meaning.
        let mut expectation = Self::new(entry, estimator, 1.0)?;
        expectation.from_camera = true;
        Ok(expectation)
    }

    fn of(classes: Vec<Class>, receiver: Receiver, estimator: Estimator<'_>) -> Self {
        let Estimator {
            technique,
            kernel,
            convention,
            bandwidths,
        } = estimator;
        EntryExpectation {
            classes,
            receiver,
            technique,
            kernel,
            convention,
            from_camera: false,
            bandwidths: bandwidths.to_vec(),
            profile: match technique {
                Technique::Linked => Profile::default(),
                Technique::Merge => Profile::new(kernel, false, bandwidths),
                _ => Profile::new(kernel, true, bandwidths),
            },
        }
    }

    /// The light of a spherical mirror on an unbounded receiver. The photons of parallel light are uniform over the sphere's
    /// cross-section.
    ///
    /// # Errors
    /// What [`check`] finds.
    pub fn of_sphere(
        mirror: &SphereMirror<f64>,
        estimator: Estimator<'_>,
    ) -> Result<Self, InvalidParameter> {
        Self::unbounded(scenes::sphere(mirror), mirror.receiver_z, estimator)
    }

    /// The light refracted by a flat interface onto an unbounded receiver; `None` where it is reflected.
    ///
    /// # Errors
    /// What [`check`] finds.
    pub fn of_interface(
        form: &FlatInterface<f64>,
        estimator: Estimator<'_>,
    ) -> Result<Option<Self>, InvalidParameter> {
        scenes::interface(form)
            .map(|caustic| Self::unbounded(vec![caustic], form.receiver_z, estimator))
            .transpose()
    }

    fn unbounded(
        caustics: Vec<Caustic>,
        z: f64,
        estimator: Estimator<'_>,
    ) -> Result<Self, InvalidParameter> {
        check(estimator.technique, estimator.kernel, estimator.bandwidths)?;
        let (receiver, class) = light::unbounded(caustics, z);
        Ok(Self::of(vec![class], receiver, estimator))
    }

    /// The classes `L S+ D` in the order in which everything here lists them, each as the class that is seen directly.
    pub fn classes(&self) -> Vec<PathClass> {
        self.classes.iter().map(|c| c.class).collect()
    }

    /// Moments of the irradiance [W/m², (W/m²)²] at the floor point (x, y, 0), per class, to a relative tolerance.
    ///
    /// **Accuracy**: as stated in the error bounds, which are estimates: the size of the last two orders of every interpolant,
    /// and rounding of the parameters at the kernel's edge.
    pub fn at(&self, x: f64, y: f64, tolerance: f64) -> Vec<Moments> {
        (0..self.classes.len())
            .map(|k| self.of_class(k, [x, y], tolerance, [0.0; 2]))
            .collect()
    }

    pub(super) fn light(&self, position: usize) -> &Class {
        &self.classes[position]
    }

    pub(super) fn receiver(&self) -> Receiver {
        self.receiver
    }

    pub(super) fn estimator(&self) -> (Technique, Kernel, &[f64]) {
        (self.technique, self.kernel, &self.bandwidths)
    }

    /// The moments of one class, relative to a floor where they are smaller than that.
    pub(super) fn of_class(
        &self,
        position: usize,
        x: [f64; 2],
        tolerance: f64,
        floor: [f64; 2],
    ) -> Moments {
        let (class, tolerance) = (&self.classes[position], tolerance.clamp(1e-13, 0.1));
        let mut sum = Pair::default();
        let mut weighted = true;
        for bundle in &class.bundles {
            let merging = Merging::new(bundle, self.receiver, x, &self.profile, class.photons);
            weighted &= merging.is_weighted();
            sum.add(&integrate(&merging, tolerance, floor));
        }
        if !weighted {
            (sum.value[1], sum.error[1]) = (f64::NAN, f64::INFINITY);
        }
        let technique = if self.from_camera {
            Technique::Camera
        } else {
            self.technique
        };
        for caustic in &class.caustics {
            let conditions = caustic.surface.again_conditions();
            sum.add(&self.connected(conditions, |link| {
                let (receiver, profile) = (self.receiver, &self.profile);
                let c = Connection::new(caustic, x, receiver, technique, profile, link);
                integrate(&c, tolerance, floor)
            }));
        }
        for (source, chain) in class
            .chains
            .iter()
            .flat_map(|c| c.families.iter().map(|chain| (c.source, chain)))
        {
            sum.add(&self.connected(chain.again_conditions(), |link| {
                Chained::new(
                    chain.as_ref(),
                    (source, class.photons),
                    x,
                    self.receiver,
                    technique,
                    &self.profile,
                    link,
                )
                .map_or_else(Pair::default, |c| integrate(&c, tolerance, floor))
            }));
        }
        let bounded = |k: usize| Bounded {
            value: sum.value[k],
            error: sum.error[k] + 16.0 * f64::EPSILON * sum.value[k],
        };
        Moments {
            mean: bounded(0),
            second_moment: bounded(1),
        }
    }

    /// The sum over all links of what is connected, or the one value of a technique that links nothing. `conditions` is the number of
    /// those under which a ray towards the light meets the surface again.
    fn connected(&self, conditions: usize, connect: impl Fn(Option<Link>) -> Pair) -> Pair {
        if self.technique != Technique::Linked {
            return connect(None);
        }
        let conditions = if self.from_camera { conditions } else { 0 };
        let cases = Case::all(self.convention, conditions, self.receiver.escape.is_some());
        let mut sum = Pair::default();
        let share = 1.0 / self.bandwidths.len() as f64;
        for &radius in &self.bandwidths {
            for &case in &cases {
                let link = Link {
                    convention: self.convention,
                    radius,
                    kernel: self.kernel,
                    case,
                };
                sum.add(&connect(Some(link)).scaled(share));
            }
        }
        sum
    }
}
