//! Reference configurations without a specular surface: A1 (floor), A2 (sphere), A3 (furnace).

use nephroid_analytic::kinds::diffuse::{Sphere, direct, furnace};

use super::reading::{LARGEST, Object, SMALLEST};
use super::report::{Item, Rows};
use super::{radiance, single, sum};
use crate::error::Error;

/// Evaluates one configuration: a furnace if the parameters have `Le`, a sphere if they have `a`, else a floor.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let points = c.required_objects("points")?;
    let points = points.into_iter().map(Object::as_item);
    if p.has("Le") {
        points.map(|point| furnace_point(&p, point?)).collect()
    } else if p.has("a") {
        points.map(|point| sphere_point(&p, point?)).collect()
    } else {
        points.map(|point| floor_point(&p, point?)).collect()
    }
}

fn floor_point(p: &Object<'_>, point: Object<'_>) -> Result<Item, Error> {
    let light = p.vector("light")?;
    if !(light.z >= SMALLEST) {
        return Err(p.error(
            "light[2]",
            &light.z.to_string(),
            "a light above the floor z = 0",
        ));
    }
    let (intensity, albedo) = (p.positive("I")?, p.fraction("albedo")?);
    let e = direct(light, intensity, point.receiver(0.0)?);
    let mut rows = Rows::regular(point);
    rows.add("E_direct", e)?;
    // There is no specular surface: the file's caustic keys hold the direct light.
    rows.add("E_caustic", e)?;
    rows.add("L_caustic", radiance(albedo, e))?;
    rows.add("L_total", radiance(albedo, e))?;
    rows.add_class("LDE", e, &[e])?;
    rows.add_missing_classes()?;
    rows.finish(None)
}

fn sphere_point(p: &Object<'_>, point: Object<'_>) -> Result<Item, Error> {
    let radius = p.positive("a")?;
    let sphere = Sphere {
        radius,
        offset: p.number("s", -0.999_999 * radius, 0.999_999 * radius)?,
        intensity: p.positive("I")?,
        albedo: p.number("albedo2", 0.0, 0.999_999)?,
    };
    let e_direct = sphere.direct(point.number("c", -1.0, 1.0)?);
    let total = sum(e_direct, sphere.indirect());
    let mut rows = Rows::regular(point);
    rows.add("E_direct", e_direct)?;
    rows.add("E_bounce1", sphere.bounce(1))?;
    for key in point.keys().filter(|k| *k != "E_bounce1") {
        let bounce = key.strip_prefix("E_bounce").and_then(|k| k.parse().ok());
        if let Some(k) = bounce.filter(|k| (1..=100_000).contains(k)) {
            rows.add(key, sphere.bounce(k))?;
        }
    }
    rows.add("E_indirect_total", sphere.indirect())?;
    rows.add("E_total", total)?;
    rows.add("L_total", radiance(sphere.albedo, total))?;
    rows.finish(None)
}

fn furnace_point(p: &Object<'_>, point: Object<'_>) -> Result<Item, Error> {
    let emission = p.number("Le", 0.0, LARGEST)?;
    let albedo = p.number("albedo2", 0.0, 0.999_999)?;
    let forever = point.get("bounces").and_then(|b| b.as_str()) == Some("inf");
    let bounces = if forever {
        None
    } else {
        let whole = point.whole("bounces", 0, 1_000_000);
        Some(whole.map_err(|e| match e {
            Error::Content {
                file,
                message,
                help,
            } => Error::Content {
                file,
                message,
                help: format!("{help}, or \"inf\""),
            },
            other => other,
        })?)
    };
    let mut rows = Rows::regular(point);
    let l = furnace(emission, albedo, bounces);
    rows.add("L", if emission == 0.0 { single(0.0, 0.0) } else { l })?;
    rows.finish(None)
}
