//! Reference configurations with a spherical mirror: E1 to E4 (concave), F1 and F2 (convex).
//!
//! A configuration with `light` has a point light of intensity `I`, one with `light_direction` a beam of irradiance `E0`.
//! `cap_axis` and `cap_cos_min` bound the mirror; without them it is the whole sphere. `side` must be what the scene says.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::sphere_mirror::{Light, Side, SphereMirror};
use nephroid_analytic::vector::vec3;

use super::reading::{LARGEST, Object, SMALLEST};
use super::report::{Item, Rows};
use super::{add_view, radiance, single, sum};
use crate::error::Error;

/// Evaluates one configuration of the scene `concave-sphere`.
pub fn concave(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    configuration(c, Side::Concave)
}

/// Evaluates one configuration of the scene `convex-sphere`.
pub fn convex(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    configuration(c, Side::Convex)
}

/// Only a concave mirror has singularities.
fn rows_of<'a>(mirror: &SphereMirror<f64>, item: Object<'a>, caustic: &Estimate<f64>) -> Rows<'a> {
    match mirror.side {
        Side::Concave => Rows::near(item, caustic),
        Side::Convex => Rows::regular(item),
    }
}

fn configuration(c: &Object<'_>, side: Side) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let (mirror, albedo) = (mirror(&p, side)?, p.fraction("albedo")?);
    let points = c.required_objects("points")?.into_iter().map(|point| {
        let point = point.as_item()?;
        let x = point.receiver(mirror.receiver_z)?;
        let (direct, caustic) = (mirror.direct(x), mirror.caustic(x));
        let mut roots = vec![];
        mirror.for_each_lit_root(x, |root| {
            roots.push(single(root.irradiance, root.conditioning));
        });
        let mut rows = rows_of(&mirror, point, &caustic);
        rows.add("E_direct", direct)?;
        rows.add("E_caustic", caustic)?;
        rows.add("L_caustic", radiance(albedo, caustic))?;
        rows.add("L_total", radiance(albedo, sum(direct, caustic)))?;
        rows.add_class("LSDE", caustic, &roots)?;
        rows.add_missing_classes()?;
        rows.finish(mirror.singularity(x).map(|s| s.distance))
    });
    let views = c.objects("views")?.into_iter().map(|view| {
        let view = view.as_item()?;
        let (camera, aim) = view.ray()?;
        let none = Estimate::NONE;
        let Some(seen) = mirror.look(camera, aim) else {
            let mut rows = Rows::regular(view);
            add_view(&mut rows, none, albedo, none, none)?;
            return rows.finish(None);
        };
        let x = seen.receiver;
        let relative = seen.error / mirror.scale(x);
        let (direct, caustic) = (mirror.direct(x), mirror.caustic(x));
        let mut rows = rows_of(&mirror, view, &caustic);
        add_view(
            &mut rows,
            single(mirror.reflectance, 0.0),
            albedo,
            direct.displaced(relative),
            caustic.displaced(relative),
        )?;
        rows.finish(mirror.singularity(x).map(|s| s.distance))
    });
    points.chain(views).collect()
}

/// The mirror of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn mirror(p: &Object<'_>, side: Side) -> Result<SphereMirror<f64>, Error> {
    let name = match side {
        Side::Concave => "concave",
        Side::Convex => "convex",
    };
    if p.has("side") && p.text("side")? != name {
        let found = format!("`{}`", p.text("side")?);
        return Err(p.error("side", &found, &format!("\"{name}\", as the scene says")));
    }
    let (centre, radius) = (p.vector("sphere_centre")?, p.positive("a")?);
    let receiver_z = if p.has("z_receiver") {
        p.number("z_receiver", -LARGEST, LARGEST)?
    } else {
        0.0
    };
    let cap_axis = if p.has("cap_axis") {
        p.direction("cap_axis")?
    } else {
        vec3(0.0, 0.0, 1.0)
    };
    let cap_cos_min = if p.has("cap_cos_min") {
        p.number("cap_cos_min", -1.0, 1.0)?
    } else {
        -1.0
    };
    let light = if p.has("light_direction") {
        Light::Beam {
            direction: p.direction("light_direction")?,
            irradiance: p.positive("E0")?,
        }
    } else {
        let position = p.vector("light")?;
        if side == Side::Convex && !((position - centre).length() >= radius * (1.0 + SMALLEST)) {
            let allowed = "a light outside the sphere";
            return Err(p.error("light", &format!("{:?}", position.to_f64()), allowed));
        }
        Light::Point {
            position,
            intensity: p.positive("I")?,
        }
    };
    Ok(SphereMirror {
        centre,
        radius,
        side,
        cap_axis,
        cap_cos_min,
        reflectance: p.fraction("R")?,
        light,
        receiver_z,
    })
}
