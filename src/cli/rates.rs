//! What `bias` and `converge` read alike.

use nephroid_analytic::bandwidth;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, InvalidParameter};

use crate::error::Error;
use crate::integrators::{Integrator, Kernel};

/// A list of bandwidths.
#[derive(Clone, Debug)]
pub struct Bandwidths(pub Vec<f64>);

/// Reads two to 32 different positive numbers.
pub fn bandwidths(text: &str) -> Result<Bandwidths, String> {
    let allowed = || "expected 2 to 32 different positive numbers, such as 0.3,0.1,0.03".to_owned();
    let values = text.split(',').map(|t| t.trim().parse().ok());
    let values: Vec<f64> = values.collect::<Option<_>>().ok_or_else(allowed)?;
    let mut sorted = values.clone();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    let fits = (2..=32).contains(&values.len())
        && sorted.len() == values.len()
        && values.iter().all(|v| *v > 0.0 && v.is_finite());
    if fits {
        Ok(Bandwidths(values))
    } else {
        Err(allowed())
    }
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug)]
pub struct Corners(pub [u32; 4]);

/// Reads `x0,y0,x1,y1`.
pub fn corners(text: &str) -> Result<Corners, String> {
    let allowed = "expected four whole numbers x0,y0,x1,y1 with x0 < x1 and y0 < y1 (pixels)";
    let values: Option<Vec<u32>> = text.split(',').map(|t| t.trim().parse().ok()).collect();
    match values.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Corners([x0, y0, x1, y1])),
        _ => Err(allowed.to_owned()),
    }
}

fn in_range(text: &str, low: f64, high: f64) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v| (low..=high).contains(v))
        .ok_or_else(|| format!("expected a number from {low:e} to {high:e}"))
}

/// A probability of error.
pub fn level(text: &str) -> Result<f64, String> {
    in_range(text, 1e-15, 0.1)
}

/// Half of the width of an interval of an exponent.
pub fn half_width(text: &str) -> Result<f64, String> {
    in_range(text, 1e-3, 10.0)
}

/// A number of replicates.
pub fn replicates(text: &str) -> Result<u32, String> {
    let range = 16..=65_536;
    let value = super::count(text).ok().and_then(|n| u32::try_from(n).ok());
    value
        .filter(|n| range.contains(n))
        .ok_or_else(|| "expected a whole number from 16 to 65536".to_owned())
}

/// The name under which the truth knows a kernel.
pub fn truth_kernel(kernel: Option<Kernel>) -> Option<bandwidth::Kernel> {
    kernel.and_then(|k| k.to_string().parse().ok())
}

/// An option out of range.
pub fn refused(option: &str, found: impl ToString, allowed: &str) -> Error {
    Error::Parameter {
        file: "command line".to_owned(),
        key: format!("--{option}"),
        found: found.to_string(),
        allowed: allowed.to_owned(),
    }
}

/// What the truth finds wrong, as an option; `bandwidths` is the one that bandwidths came from.
pub fn invalid(e: InvalidParameter, bandwidths: &str) -> Error {
    let option = if e.key == "bandwidth" {
        bandwidths.to_owned()
    } else {
        e.key
    };
    refused(&option, e.found, &e.allowed)
}

/// Refuses a scene that the integrator cannot be prepared for.
pub fn supported(entry: &Entry, integrator: &dyn Integrator) -> Result<(), Error> {
    integrator.supports(entry).map_err(|reason| {
        let allowed = format!("an integrator that supports {}: {reason}", entry.name);
        refused("integrator", integrator.name(), &allowed)
    })
}

/// Refuses a class that the scene does not have.
pub fn class_exists(entry: &Entry, class: Option<PathClass>) -> Result<(), Error> {
    let classes = entry.kind.classes();
    match class {
        Some(c) if !classes.contains(&c) => {
            let names: Vec<_> = classes.iter().map(PathClass::to_string).collect();
            Err(refused("class", c, &names.join(", ")))
        }
        _ => Ok(()),
    }
}
