//! Reference configurations with a paraboloid mirror: H1 (point light at the focus), H2 (beam along the axis).
//!
//! With `light`, the receiver is z = `zr` and the mirror ends at `mirror_radius`; with `E0`, the receiver is z = `c` and the
//! mirror is the annulus from `r0` to `r1`. The receiver faces down.

use nephroid_analytic::kinds::paraboloid::{Light, Paraboloid};

use super::reading::{LARGEST, Object};
use super::report::{Item, Rows};
use super::{add_one_root, on_axis};
use crate::error::Error;

/// The mirror of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn dish(p: &Object<'_>) -> Result<Paraboloid<f64>, Error> {
    let focal_length = p.positive("f")?;
    let (light, receiver, inner_radius, outer) = if p.has("light") {
        on_axis(p, "light", focal_length, "the focus [0, 0, f]")?;
        (Light::Focus(p.positive("I")?), "zr", 0.0, "mirror_radius")
    } else {
        let inner = p.number("r0", 0.0, LARGEST)?;
        (Light::Beam(p.positive("E0")?), "c", inner, "r1")
    };
    let outer_radius = p.positive(outer)?;
    if !(outer_radius > inner_radius) {
        return Err(p.error(outer, &outer_radius.to_string(), "a radius larger than r0"));
    }
    Ok(Paraboloid {
        focal_length,
        reflectance: p.fraction("R")?,
        light,
        receiver_z: p.number(receiver, -LARGEST, LARGEST)?,
        inner_radius,
        outer_radius,
    })
}

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let (dish, albedo) = (dish(&p)?, p.fraction("albedo")?);
    let points = c.required_objects("points")?.into_iter().map(|point| {
        let point = point.as_item()?;
        let x = point.receiver(dish.receiver_z)?;
        let (direct, caustic) = (dish.direct(x.x, x.y), dish.caustic(x.x, x.y));
        let mut rows = match dish.light {
            Light::Focus(_) => Rows::regular(point),
            Light::Beam(_) => Rows::near(point, &caustic),
        };
        add_one_root(&mut rows, albedo, Some(direct), caustic)?;
        rows.finish(dish.singularity(x.x, x.y).map(|s| s.distance))
    });
    points.collect()
}
