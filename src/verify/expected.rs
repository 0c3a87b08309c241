//! What each claimed class should be: the closed form where it is sampled without bias, the exact expectation at the
//! bandwidths of the run where it is regularized.

use std::collections::HashMap;

use nephroid_analytic::bandwidth::{Kernel, Moments, Technique as Mollified};
use nephroid_analytic::camera::Bounded;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::error::Error;
use crate::integrators::{Plan, Technique, Treatment};
use crate::regions::Regions;
use crate::truth::TruthImage;
use crate::{expectation, truth};

/// Relative tolerance of the class means as a part of the margin. What is reached is a part of every test, and takes about
/// this much from the margin.
const TOLERANCE_PER_MARGIN: f64 = 0.02;

/// What a finite-bandwidth expectation depends on.
#[derive(Clone, Debug, PartialEq)]
struct Finite {
    scene: usize,
    technique: Mollified,
    kernel: Kernel,
    bandwidths: Vec<f64>,
}

type ClassMoments = Vec<(PathClass, Moments)>;

/// What one class should be, in each area of the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// Over the whole image [W m⁻² sr⁻¹].
    pub image: Bounded,
    /// Over each area of the regions, the image among them; empty where only the image is known.
    pub areas: Vec<Bounded>,
}

impl Expected {
    /// Known over the image only.
    pub fn of_image(image: Bounded) -> Self {
        Expected {
            image,
            areas: Vec::new(),
        }
    }
}

/// Truths of a list of scenes, each computed once.
pub struct Truths {
    tolerance: f64,
    exact: HashMap<usize, TruthImage>,
    finite: Vec<(Finite, ClassMoments)>,
}

impl Truths {
    /// Truths that are exact enough for an equivalence margin (relative to the truth).
    pub fn for_margin(margin: f64) -> Self {
        Truths {
            tolerance: TOLERANCE_PER_MARGIN * margin,
            exact: HashMap::new(),
            finite: Vec::new(),
        }
    }

    /// Per class of the plan, what its means should be; `None` for classes that are not sampled. `scene` is
    /// the entry's position in the list; `bandwidths` are those of the iterations, which all have as many paths.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a kernel or a bandwidth that does not fit the technique.
    pub fn of(
        &mut self,
        scene: usize,
        entry: &Entry,
        plan: &Plan,
        regions: &Regions,
        kernel: Option<Kernel>,
        bandwidths: &[f64],
    ) -> Result<Vec<Option<Expected>>, Error> {
        let mut result = Vec::with_capacity(plan.len());
        for class in plan {
            result.push(match class.treatment {
                Treatment::NotSampled => None,
                Treatment::Exact(_) => {
                    let tolerance = self.tolerance;
                    let image = self
                        .exact
                        .entry(scene)
                        .or_insert_with(|| truth::image(entry, tolerance));
                    let position = entry.kind.classes().iter().position(|&c| c == class.class);
                    position.map(|layer| Expected {
                        image: image.class_means()[layer],
                        areas: image.area_means(layer, regions),
                    })
                }
                Treatment::Regularized(technique) => match mollified(technique) {
                    Some(technique) => {
                        let key = Finite {
                            scene,
                            technique,
                            kernel: kernel.unwrap_or(default_kernel(technique)),
                            bandwidths: bandwidths.to_vec(),
                        };
                        let means = self.finite(entry, key)?;
                        let mean = means.iter().find(|(c, _)| *c == class.class);
                        mean.map(|(_, m)| Expected::of_image(m.mean))
                    }
                    None => None,
                },
            });
        }
        Ok(result)
    }

    /// The exact image of a scene, if it has been asked for.
    pub fn image(&self, scene: usize) -> Option<&TruthImage> {
        self.exact.get(&scene)
    }

    /// Expectations of the regularized classes.
    fn finite(&mut self, entry: &Entry, key: Finite) -> Result<&ClassMoments, Error> {
        let position = match self.finite.iter().position(|(k, _)| *k == key) {
            Some(position) => position,
            None => {
                let means = expectation::class_means(
                    entry,
                    key.technique,
                    key.kernel,
                    &key.bandwidths,
                    self.tolerance,
                )
                .map_err(|e| Error::Parameter {
                    file: "command line".to_owned(),
                    key: format!("--{}", e.key),
                    found: e.found,
                    allowed: e.allowed,
                })?;
                self.finite.push((key, means));
                self.finite.len() - 1
            }
        };
        Ok(&self.finite[position].1)
    }
}

/// The name under which the truth knows a regularizing technique.
pub fn mollified(technique: Technique) -> Option<Mollified> {
    match technique {
        Technique::Camera => Some(Mollified::Camera),
        Technique::Merge => Some(Mollified::Merge),
        Technique::NextEvent | Technique::LightTracing => None,
    }
}

/// The cone for an angle, the disc for a radius.
pub const fn default_kernel(technique: Mollified) -> Kernel {
    match technique {
        Mollified::Merge => Kernel::Disc,
        _ => Kernel::Cone,
    }
}
