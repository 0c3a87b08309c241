//! What each claimed class should be: the closed form where it is sampled without bias, the exact expectation at the
//! bandwidths of the run where it is regularized.

use std::collections::HashMap;

use nephroid_analytic::bandwidth::{Kernel, Moments, Technique as Mollified};
use nephroid_analytic::camera::Bounded;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::error::Error;
use crate::integrators::{Plan, Technique, Treatment};
use crate::regions::{Area, Regions};
use crate::truth::TruthImage;
use crate::{connected_and_merged, expectation, truth};

/// Relative tolerance of the class means as a part of the margin. What is reached is a part of every test, and takes about
/// this much from the margin.
const TOLERANCE_PER_MARGIN: f64 = 0.02;

/// What an expectation at finite bandwidth is one of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Estimate {
    Mollified(Mollified),
    ConnectedAndMerged,
}

/// What a finite-bandwidth expectation depends on.
#[derive(Clone, Debug, PartialEq)]
struct Finite {
    scene: usize,
    estimate: Estimate,
    kernel: Kernel,
    bandwidths: Vec<f64>,
    regions: Regions,
}

/// Per class the means over each area.
type AreaMeans = Vec<(PathClass, Vec<Bounded>)>;

/// What one class should be, in each area of the image [W m⁻² sr⁻¹]: first in the one that decides, which is the whole image
/// or a mask.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    areas: Vec<Bounded>,
}

impl Expected {
    /// In the deciding area, and in others.
    pub fn new(first: Bounded, others: impl IntoIterator<Item = Bounded>) -> Self {
        Expected {
            areas: core::iter::once(first).chain(others).collect(),
        }
    }

    /// In the deciding area only.
    pub fn of_first(first: Bounded) -> Self {
        Expected::new(first, [])
    }

    /// In the deciding area.
    pub fn first(&self) -> Bounded {
        self.areas[0]
    }

    /// In each area, the deciding one first.
    pub fn areas(&self) -> &[Bounded] {
        &self.areas
    }
}

/// Truths of a list of scenes, each computed once.
pub struct Truths {
    tolerance: f64,
    exact: HashMap<usize, TruthImage>,
    finite: Vec<(Finite, AreaMeans)>,
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
                    position.map(|layer| {
                        let areas = image.area_means(layer, regions).into_iter();
                        match regions.areas()[0] {
                            // The image's own sum is compensated.
                            Area::Image => Expected::new(image.class_means()[layer], areas.skip(1)),
                            _ => Expected {
                                areas: areas.collect(),
                            },
                        }
                    })
                }
                Treatment::Regularized(technique) => match estimate(technique) {
                    Some((estimate, default)) => {
                        let key = Finite {
                            scene,
                            estimate,
                            kernel: kernel.unwrap_or(default),
                            bandwidths: bandwidths.to_vec(),
                            regions: regions.clone(),
                        };
                        let means = self.finite(entry, key)?;
                        let mean = means.iter().find(|(c, _)| *c == class.class);
                        mean.map(|(_, areas)| Expected {
                            areas: areas.clone(),
                        })
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

    /// The exact image of a scene, computed if it has not been.
    pub fn image_of(&mut self, scene: usize, entry: &Entry) -> &TruthImage {
        let tolerance = self.tolerance;
        self.exact
            .entry(scene)
            .or_insert_with(|| truth::image(entry, tolerance))
    }

    /// Expectations of the regularized classes.
    fn finite(&mut self, entry: &Entry, key: Finite) -> Result<&AreaMeans, Error> {
        let position = match self.finite.iter().position(|(k, _)| *k == key) {
            Some(position) => position,
            None => {
                let means = match key.estimate {
                    // No test asks for second moments.
                    Estimate::Mollified(technique) => expectation::area_moments(
                        entry,
                        technique,
                        key.kernel,
                        &key.bandwidths,
                        [self.tolerance, f64::INFINITY],
                        &key.regions,
                    )
                    .map(|moments| {
                        let means = |areas: Vec<Moments>| areas.iter().map(|m| m.mean).collect();
                        moments.into_iter().map(|(c, a)| (c, means(a))).collect()
                    }),
                    Estimate::ConnectedAndMerged => {
                        let tolerance = self.tolerance;
                        let image = self
                            .exact
                            .entry(key.scene)
                            .or_insert_with(|| truth::image(entry, tolerance));
                        connected_and_merged::area_means(
                            entry,
                            key.kernel,
                            &key.bandwidths,
                            tolerance,
                            &key.regions,
                            image,
                        )
                    }
                };
                let means = means.map_err(|e| Error::Parameter {
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

/// What a regularizing technique estimates, and the kernel that is meant where none is named; `None` where it is not known.
fn estimate(technique: Technique) -> Option<(Estimate, Kernel)> {
    if technique == Technique::ConnectionAndMerging {
        let default = Mollified::Merge.default_kernel();
        return Some((Estimate::ConnectedAndMerged, default));
    }
    mollified(technique).map(|t| (Estimate::Mollified(t), t.default_kernel()))
}

/// Whether an expectation at finite bandwidth is known for a technique, on the kinds for which any is.
pub fn is_judged(technique: Technique) -> bool {
    estimate(technique).is_some()
}

/// The name under which the truth knows a regularizing technique.
pub const fn mollified(technique: Technique) -> Option<Mollified> {
    match technique {
        Technique::Camera => Some(Mollified::Camera),
        Technique::Symmetric => Some(Mollified::Symmetric),
        Technique::Merge => Some(Mollified::Merge),
        Technique::NextEvent
        | Technique::Bidirectional
        | Technique::LightTracing
        | Technique::ManifoldSampling
        | Technique::CameraEveryVertex
        | Technique::Connection
        | Technique::ConnectionAndMerging
        | Technique::AdaptiveMerge => None,
    }
}
