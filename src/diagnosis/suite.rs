//! The diagnosis of a whole suite's verdicts.

use nephroid_analytic::scene::Entry;

use super::{Known, Subject, of};
use crate::error::Error;
use crate::integrators::{ClassPlan, Kernel, Plan, Treatment};
use crate::judge::finding::State;
use crate::regions::Regions;
use crate::verify::effort::Effort;
use crate::verify::expected::Truths;
use crate::verify::replicates::{Seeds, Shape};
use crate::verify::run::{Request, first_shape};
use crate::verify::suite::Pair;
use crate::verify::verdicts::Verdict;

/// Means of each class at half of the bandwidths; `None` for classes that are not regularized.
///
/// # Errors
/// A kernel or a bandwidth that does not fit.
pub fn means_at_half(
    truths: &mut Truths,
    entry: &Entry,
    pair: &Pair,
    regions: &Regions,
    kernel: Option<Kernel>,
    shape: &Shape,
) -> Result<Vec<Option<f64>>, Error> {
    let half: Vec<f64> = shape.bandwidths.iter().map(|b| 0.5 * b).collect();
    let kernel = kernel.and_then(|k| k.to_string().parse().ok());
    // Only what is regularized, so that no image is computed for this.
    let plan: Plan = pair
        .plan
        .iter()
        .map(|class| match class.treatment {
            Treatment::Exact(_) => ClassPlan {
                treatment: Treatment::NotSampled,
                ..class.clone()
            },
            _ => class.clone(),
        })
        .collect();
    let expected = truths.of(pair.scene, entry, &plan, regions, kernel, &half)?;
    Ok(expected
        .into_iter()
        .map(|e| e.map(|e| e.first().value))
        .collect())
}

/// Adds what they look like to the verdicts of a suite that are different.
///
/// # Errors
/// A kernel or a bandwidth that does not fit.
pub fn annotate(
    request: &Request,
    verdicts: &mut [Verdict],
    truths: &mut Truths,
) -> Result<(), Error> {
    // A changed scene's verdict says by which change it is.
    let is_told = |v: &&mut Verdict| v.finding.state == State::Different && v.variation.is_none();
    for verdict in verdicts.iter_mut().filter(is_told) {
        let scene = request
            .scenes
            .iter()
            .position(|s| s.entry.name == verdict.scene);
        let integrator = request
            .integrators
            .iter()
            .position(|i| i.name() == verdict.integrator);
        let (Some(scene), Some(integrator)) = (scene, integrator) else {
            continue;
        };
        let entry = &request.scenes[scene].entry;
        let classes = entry.kind.classes();
        let Some(layer) = classes.iter().position(|c| c.to_string() == verdict.class) else {
            continue;
        };
        let method = request.integrators[integrator].as_ref();
        let pair = Pair::new(scene, entry, integrator, method);
        let (width, height) = (entry.camera.width, entry.camera.height);
        let shape = first_shape(
            method,
            &pair.plan,
            request.bandwidth,
            entry,
            Effort::Standard,
        );
        let treatment = pair.plan[layer].treatment;
        let means = match (treatment, verdict.truth) {
            (Treatment::Regularized(_), Some(truth)) => {
                let regions = Regions::quadtree(width, height);
                let half = means_at_half(truths, entry, &pair, &regions, request.kernel, &shape)?;
                half[layer].map(|half| [truth.value, half])
            }
            _ => None,
        };
        let Some(truth) = Known::of(treatment, truths.image(scene), layer, means) else {
            continue;
        };
        verdict.looks_like = of(&Subject {
            entry,
            prepared: method.prepare(entry).as_ref(),
            layer,
            shape: &shape,
            seeds: Seeds::new(request.seed, &entry.name, method.name()),
            truth,
        });
    }
    Ok(())
}
