//! Reference configurations with a flat interface: C1 to C3, and the fourth direction, air to air.
//!
//! `Z` is the receiver's height, 0 without it. A receiver below the surface faces up, one above it down.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::flat_interface::FlatInterface;

use super::reading::{LARGEST, Object, SMALLEST};
use super::report::{Item, Rows};
use super::{add_view, radiance, single, sum};
use crate::error::Error;

/// The interface of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn interface(p: &Object<'_>) -> Result<FlatInterface<f64>, Error> {
    let surface_z = p.number("surface_z", -LARGEST, LARGEST)?;
    let light = p.vector("light")?;
    let receiver_z = if p.has("Z") {
        p.number("Z", -LARGEST, LARGEST)?
    } else {
        0.0
    };
    let room = SMALLEST * (1.0 + f64::abs(surface_z));
    for (key, z) in [("light[2]", light.z), ("Z", receiver_z)] {
        if !(f64::abs(z - surface_z) >= room) {
            let allowed = "a height above or below surface_z, not on it";
            return Err(p.error(key, &z.to_string(), allowed));
        }
    }
    Ok(FlatInterface {
        surface_z,
        index: p.number("n", 0.1, 10.0)?,
        light,
        intensity: p.positive("I")?,
        receiver_z,
    })
}

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let (water, albedo) = (interface(&p)?, p.fraction("albedo")?);
    let kinked = water.distance_to_kink(0.0, 0.0).is_some();
    let points = c.required_objects("points")?.into_iter().map(|point| {
        let point = point.as_item()?;
        let x = point.receiver(water.receiver_z)?;
        let (direct, caustic) = (water.direct(x.x, x.y), water.caustic(x.x, x.y));
        let mut rows = if kinked {
            Rows::near(point, &caustic)
        } else {
            Rows::regular(point)
        };
        rows.add("E_direct", direct)?;
        rows.add("E_caustic", caustic)?;
        rows.add("L_caustic", radiance(albedo, caustic))?;
        rows.add("L_total", radiance(albedo, sum(direct, caustic)))?;
        rows.add_class("LSDE", caustic, &[caustic])?;
        rows.add_missing_classes()?;
        rows.finish(water.distance_to_kink(x.x, x.y).map(f64::abs))
    });
    let views = c.objects("views")?.into_iter().map(|view| {
        let view = view.as_item()?;
        let (camera, aim) = view.ray()?;
        let none = Estimate::NONE;
        let Some(seen) = water.look(camera, aim) else {
            let mut rows = Rows::regular(view);
            rows.add("T", none)?;
            add_view(&mut rows, none, albedo, none, none)?;
            return rows.finish(None);
        };
        let x = seen.receiver;
        let relative = seen.error / (x.length() + water.light.length());
        let caustic = water.caustic(x.x, x.y);
        let mut rows = if kinked {
            Rows::near(view, &caustic)
        } else {
            Rows::regular(view)
        };
        let transmittance = if seen.through {
            seen.fresnel
        } else {
            1.0 - seen.fresnel
        };
        rows.add("T", single(transmittance, seen.conditioning))?;
        add_view(
            &mut rows,
            single(seen.weight, seen.conditioning),
            albedo,
            water.direct(x.x, x.y).displaced(relative),
            caustic.displaced(relative),
        )?;
        rows.finish(water.distance_to_kink(x.x, x.y).map(f64::abs))
    });
    points.chain(views).collect()
}
