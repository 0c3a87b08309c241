//! Reference configurations with a conic mirror and the light in a focus: I1 (ellipsoid), I2 (hyperboloid).
//!
//! With `a` the mirror is an ellipsoid and the receiver z = a e + `delta`; with `A` a hyperboloid and z = `zr`. The
//! receiver faces down.

use nephroid_analytic::kinds::conic_mirrors::{Ellipsoid, Hyperboloid};

use super::reading::{LARGEST, Object};
use super::report::{Item, Rows};
use super::{add_one_root, on_axis};
use crate::error::Error;

/// The ellipsoid of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn ellipsoid(p: &Object<'_>) -> Result<Ellipsoid<f64>, Error> {
    let semi_axis = p.positive("a")?;
    let eccentricity = p.number("e", 0.0, 0.999_999)?;
    on_axis(
        p,
        "light",
        -semi_axis * eccentricity,
        "the lower focus [0, 0, -a e]",
    )?;
    Ok(Ellipsoid {
        semi_axis,
        eccentricity,
        defocus: p.number("delta", -LARGEST, LARGEST)?,
        intensity: p.positive("I")?,
        reflectance: p.fraction("R")?,
    })
}

/// The hyperboloid of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn hyperboloid(p: &Object<'_>) -> Result<Hyperboloid<f64>, Error> {
    let semi_axis = p.positive("A")?;
    let eccentricity = p.number("e", 1.000_001, LARGEST)?;
    on_axis(
        p,
        "light",
        semi_axis * eccentricity,
        "the upper focus [0, 0, A e]",
    )?;
    Ok(Hyperboloid {
        semi_axis,
        eccentricity,
        receiver_z: p.number("zr", -LARGEST, LARGEST)?,
        intensity: p.positive("I")?,
        reflectance: p.fraction("R")?,
    })
}

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let albedo = p.fraction("albedo")?;
    let points = c.required_objects("points")?.into_iter();
    let points = points.map(Object::as_item);
    if p.has("a") {
        let mirror = ellipsoid(&p)?;
        points
            .map(|point| {
                let point = point?;
                let x = point.receiver(mirror.receiver_z())?;
                let caustic = mirror.caustic(x.x, x.y);
                let mut rows = Rows::near(point, &caustic);
                let direct = mirror.direct(x.x, x.y);
                add_one_root(&mut rows, albedo, Some(direct), caustic)?;
                rows.finish(mirror.singularity(x.x, x.y).map(|s| s.distance))
            })
            .collect()
    } else if p.has("A") {
        let mirror = hyperboloid(&p)?;
        points
            .map(|point| {
                let point = point?;
                let x = point.receiver(mirror.receiver_z)?;
                let mut rows = Rows::regular(point);
                let direct = mirror.direct(x.x, x.y);
                add_one_root(&mut rows, albedo, Some(direct), mirror.caustic(x.x, x.y))?;
                rows.finish(None)
            })
            .collect()
    } else {
        let allowed = "a (ellipsoid) or A (hyperboloid)";
        Err(p.error("a", "neither `a` nor `A`", allowed))
    }
}
