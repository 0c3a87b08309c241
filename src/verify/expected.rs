//! What each claimed class should be: the closed form where it is sampled without bias, the exact expectation at the
//! bandwidths of the run where it is regularized.

use std::collections::HashMap;

use nephroid_analytic::bandwidth::{Kernel, Moments, Technique as Mollified};
use nephroid_analytic::camera::Bounded;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::error::Error;
use crate::integrators::{Plan, Technique, Treatment};
use crate::{expectation, truth};

/// Relative tolerance of the class means: far below any margin, and part of every test.
const TOLERANCE: f64 = 1e-5;

/// Truths of a suite, each computed once.
#[derive(Default)]
pub struct Truths {
    exact: HashMap<usize, Vec<Bounded>>,
}

impl Truths {
    /// Per class of the plan, what its mean over the image should be; `None` for classes that are not sampled. `scene` is
    /// the entry's position in the suite; `bandwidths` are those of the iterations, which all have as many paths.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a kernel or a bandwidth that does not fit the technique.
    pub fn of(
        &mut self,
        scene: usize,
        entry: &Entry,
        plan: &Plan,
        kernel: Option<Kernel>,
        bandwidths: &[f64],
    ) -> Result<Vec<Option<Bounded>>, Error> {
        let mut regularized: Option<(Technique, Vec<(PathClass, Moments)>)> = None;
        let mut result = Vec::with_capacity(plan.len());
        for class in plan {
            result.push(match class.treatment {
                Treatment::NotSampled => None,
                Treatment::Exact(_) => {
                    let means = self
                        .exact
                        .entry(scene)
                        .or_insert_with(|| truth::image(entry, TOLERANCE).class_means());
                    let position = entry.kind.classes().iter().position(|&c| c == class.class);
                    position.map(|p| means[p])
                }
                Treatment::Regularized(technique) => {
                    // One computation serves all classes of a technique.
                    let known = regularized.take().filter(|(t, _)| *t == technique);
                    let (_, means) = match known {
                        Some(known) => regularized.insert(known),
                        None => regularized
                            .insert((technique, finite(entry, technique, kernel, bandwidths)?)),
                    };
                    let mean = means.iter().find(|(c, _)| *c == class.class);
                    mean.map(|(_, m)| m.mean)
                }
            });
        }
        Ok(result)
    }
}

/// Expectations of the regularized classes; none for a technique that the truth does not know.
fn finite(
    entry: &Entry,
    technique: Technique,
    kernel: Option<Kernel>,
    bandwidths: &[f64],
) -> Result<Vec<(PathClass, Moments)>, Error> {
    let Some(technique) = mollified(technique) else {
        return Ok(Vec::new());
    };
    let kernel = kernel.unwrap_or(default_kernel(technique));
    expectation::class_means(entry, technique, kernel, bandwidths, TOLERANCE).map_err(|e| {
        Error::Parameter {
            file: "command line".to_owned(),
            key: format!("--{}", e.key),
            found: e.found,
            allowed: e.allowed,
        }
    })
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
