//! Which classes a study measures, and where.

use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, InvalidParameter};

use super::options::{check_options, chosen};
use super::region::{View, interior};
use crate::expectation::{is_planar, unknown};
use crate::integrators::{ClassPlan, Integrator, Treatment};
use crate::verify::expected::mollified;

/// What both studies are asked.
pub struct Asked<'a> {
    /// The scene.
    pub entry: &'a Entry,
    /// The integrator.
    pub integrator: &'a dyn Integrator,
    /// The mollifier that the integrator was built with; `None` for the technique's default.
    pub kernel: Option<Kernel>,
    /// The technique of the prediction; `None` for what the integrator's plan says.
    pub technique: Option<Technique>,
    /// Only this class.
    pub class: Option<PathClass>,
    /// Pixels x0, y0, x1, y1; `None` for an interior region, or the whole image of a class without bias.
    pub region: Option<[u32; 4]>,
    /// Independent repetitions.
    pub replicates: u32,
    /// The seed.
    pub seed: u64,
    /// Of all tests of a class together: the probability that a correct integrator is called different.
    pub level: f64,
}

/// A class that is not measured, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Skipped {
    /// The class.
    pub class: PathClass,
    /// Why.
    pub reason: String,
}

/// A class that is measured.
pub(super) struct Subject {
    /// The film's layer.
    pub layer: usize,
    /// The class.
    pub class: PathClass,
    /// The technique of the prediction; `None` for a class sampled without bias.
    pub technique: Option<Technique>,
    /// Where.
    pub view: View,
}

/// The bandwidths of a study.
pub(super) struct Bandwidths<'a> {
    /// Those that the user named.
    pub named: &'a [f64],
    /// Those at which a region must be interior: the ends of a schedule will do.
    pub extremes: &'a [f64],
}

impl Asked<'_> {
    /// The kernel of a technique's prediction.
    pub(super) fn kernel_of(&self, technique: Technique) -> Kernel {
        self.kernel.unwrap_or(technique.default_kernel())
    }

    /// Studies each class that can be: `without_bias` says why one that is sampled without bias cannot.
    ///
    /// # Errors
    /// A region, a kernel, a technique or a bandwidth that does not fit; what the study finds.
    pub(super) fn each<S>(
        &self,
        bandwidths: &Bandwidths,
        without_bias: Option<&str>,
        mut study: impl FnMut(Subject) -> Result<Option<S>, InvalidParameter>,
    ) -> Result<(Vec<S>, Vec<Skipped>), InvalidParameter> {
        let (mut studies, mut skipped) = (Vec::new(), Vec::new());
        let plan = self.integrator.plan(self.entry);
        check_options(&plan, self.technique, self.kernel, bandwidths.named)?;
        for (layer, planned) in plan.iter().enumerate() {
            let class = planned.class;
            if self.class.is_some_and(|c| c != class) {
                continue;
            }
            let found = match self.subject(layer, planned, bandwidths, without_bias)? {
                Ok(subject) => study(subject)?.ok_or("nothing of it in the region".to_owned()),
                Err(reason) => Err(reason),
            };
            match found {
                Ok(s) => studies.push(s),
                Err(reason) => skipped.push(Skipped { class, reason }),
            }
        }
        Ok((studies, skipped))
    }

    /// A class as it is measured, or why it is not.
    fn subject(
        &self,
        layer: usize,
        planned: &ClassPlan,
        bandwidths: &Bandwidths,
        without_bias: Option<&str>,
    ) -> Result<Result<Subject, String>, InvalidParameter> {
        let class = planned.class;
        let technique = match (planned.treatment, without_bias) {
            (Treatment::NotSampled, _) => {
                return Ok(Err("not sampled by this integrator".to_owned()));
            }
            (Treatment::Exact(_), Some(reason)) => return Ok(Err(reason.to_owned())),
            (Treatment::Exact(_), None) => None,
            (Treatment::Regularized(t), _) => {
                let Some(t) = chosen(mollified(t), self.technique)? else {
                    return Ok(Err("no exact expectation of this technique".to_owned()));
                };
                if let Some(reason) = unknown(self.entry, t) {
                    return Ok(Err(reason));
                }
                if self.region.is_none() && !is_planar(&self.entry.kind) {
                    let reason = "interior parts of a picture are looked for in planar scenes only: name a --region";
                    return Ok(Err(reason.to_owned()));
                }
                Some(t)
            }
        };
        let view = self.view(class, technique, bandwidths.extremes)?;
        Ok(view
            .map(|view| Subject {
                layer,
                class,
                technique,
                view,
            })
            .ok_or_else(|| {
                "no part of the picture is farther from every edge than the kernel reaches with a bias of one sign: \
                 use smaller bandwidths, or name a --region"
                    .to_owned()
            }))
    }

    fn view(
        &self,
        class: PathClass,
        technique: Option<Technique>,
        bandwidths: &[f64],
    ) -> Result<Option<View>, InvalidParameter> {
        if let Some(corners) = self.region {
            let invalid = |allowed| InvalidParameter {
                key: "region".to_owned(),
                found: corners.map(|c| c.to_string()).join(","),
                allowed,
            };
            return View::pixels(self.entry, corners).map(Some).map_err(invalid);
        }
        match technique {
            Some(t) => interior(self.entry, class, t, self.kernel_of(t), bandwidths),
            None => {
                let reason = "a class without bias needs no interior region";
                Ok(Some(View::whole(self.entry, reason)))
            }
        }
    }
}
