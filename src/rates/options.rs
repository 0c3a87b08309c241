//! What both studies ask of technique, kernel and bandwidths.

use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::scene::InvalidParameter;

use crate::integrators::{Plan, Treatment};
use crate::verify::expected::mollified;

/// The technique of the prediction: the one asked for, if its bandwidth is of the same kind as that of the integrator's.
pub(super) fn chosen(
    planned: Option<Technique>,
    asked: Option<Technique>,
) -> Result<Option<Technique>, InvalidParameter> {
    let (Some(planned), Some(asked)) = (planned, asked) else {
        return Ok(planned);
    };
    let fits = |t: &Technique| t.bandwidth_is_angle() == planned.bandwidth_is_angle();
    if fits(&asked) {
        return Ok(Some(asked));
    }
    let names: Vec<_> = Technique::ALL
        .into_iter()
        .filter(fits)
        .map(Technique::name)
        .collect();
    Err(InvalidParameter {
        key: "technique".to_owned(),
        found: asked.to_string(),
        allowed: format!(
            "{} (the integrator's bandwidth is of that kind)",
            names.join(", ")
        ),
    })
}

/// Refuses what does not fit before anything is run.
pub(super) fn check_options(
    plan: &Plan,
    technique: Option<Technique>,
    kernel: Option<Kernel>,
    bandwidths: &[f64],
) -> Result<(), InvalidParameter> {
    for planned in plan {
        if let Treatment::Regularized(t) = planned.treatment
            && let Some(t) = chosen(mollified(t), technique)?
        {
            let kernel = kernel.unwrap_or(t.default_kernel());
            nephroid_analytic::bandwidth::check(t, kernel, bandwidths)?;
        }
    }
    Ok(())
}
