//! Reference configurations with a circular wall: G1, G2, G7 (beam), G3, G4 (point light), G5, G6 (flatland).
//!
//! A configuration with `x_line` is flat; one with `light` has a point light inside the circle or on the wall; otherwise a
//! beam along +x comes in with `sin_elevation` and `cos_elevation`, or with `light_direction` alone. `wall` is `"half"`
//! (x > 0) or `"full"`, `wall_height` a number or `"unbounded"`.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::cylinder_cup::flatland::Flatland;
use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{Beam, CylinderCup, Light, MAX_BOUNCES, Wall};
use nephroid_analytic::vector::Vec3;

use super::reading::{LARGEST, Object, SMALLEST};
use super::report::{Item, Rows};
use super::{add_view, radiance, single, sum};
use crate::error::Error;

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    if p.has("x_line") {
        return flatland(c, &p);
    }
    let (cup, albedo) = (cup(&p)?, p.fraction("albedo")?);
    let bounces = p.whole("max_bounces", 1, MAX_BOUNCES)?;
    let points = c
        .required_objects("points")?
        .into_iter()
        .map(|point| floor_point(&cup, albedo, bounces, point.as_item()?));
    let views = c
        .objects("views")?
        .into_iter()
        .map(|item| view(&cup, albedo, bounces, item.as_item()?));
    points.chain(views).collect()
}

fn floor_point(
    cup: &CylinderCup<f64>,
    albedo: f64,
    bounces: u32,
    point: Object<'_>,
) -> Result<Item, Error> {
    let x = point.receiver(0.0)?;
    let (direct, caustic) = (cup.direct(x.x, x.y), all_orders(cup, x.x, x.y, bounces));
    let mut rows = Rows::near(point, &caustic);
    rows.add("E_direct", direct)?;
    rows.add("E_caustic", caustic)?;
    rows.add("L_caustic", radiance(albedo, caustic))?;
    rows.add("L_total", radiance(albedo, sum(direct, caustic)))?;
    for k in 1..=bounces {
        let mut roots = vec![];
        cup.for_each_lit_root(x.x, x.y, k, |root| {
            roots.push(single(
                root.irradiance,
                cup.conditioning(x.x, x.y, k, &root),
            ));
        });
        let class = format!("L{}DE", "S".repeat(k as usize));
        rows.add_class(&class, cup.caustic(x.x, x.y, k), &roots)?;
    }
    rows.add_missing_classes()?;
    rows.finish(cup.distance_to_fold(x.x, x.y, bounces))
}

fn all_orders(cup: &CylinderCup<f64>, x: f64, y: f64, bounces: u32) -> Estimate<f64> {
    (1..=bounces)
        .map(|k| cup.caustic(x, y, k))
        .fold(Estimate::NONE, |a, b| {
            if b.roots + a.roots == 0 && b.error == 0.0 {
                a
            } else {
                sum(a, b)
            }
        })
}

fn view(
    cup: &CylinderCup<f64>,
    albedo: f64,
    bounces: u32,
    item: Object<'_>,
) -> Result<Item, Error> {
    let (camera, aim) = item.ray()?;
    let Some(seen) = cup.look(camera, aim, bounces) else {
        let mut rows = Rows::regular(item);
        let none = Estimate::NONE;
        add_view(&mut rows, none, albedo, none, none)?;
        return rows.finish(None);
    };
    let (x, y) = (seen.x, seen.y);
    let weight = (0..seen.bounces).fold(1.0, |w, _| w * cup.reflectance);
    let caustic = all_orders(cup, x, y, bounces);
    let mut rows = Rows::near(item, &caustic);
    let relative = seen.error / cup.wall.radius.max(libm::hypot(x, y));
    add_view(
        &mut rows,
        single(weight, f64::from(seen.bounces)),
        albedo,
        cup.direct(x, y).displaced(relative),
        caustic.displaced(relative),
    )?;
    rows.finish(cup.distance_to_fold(x, y, bounces))
}

/// The cup of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn cup(p: &Object<'_>) -> Result<CylinderCup<f64>, Error> {
    let radius = p.positive("a")?;
    let height = match p.get("wall_height").and_then(|h| h.as_str()) {
        Some("unbounded") => None,
        _ => Some(p.positive("wall_height")?),
    };
    let cos_half_arc = match p.text("wall")? {
        "half" => Some(0.0),
        "full" => None,
        other => {
            let found = format!("`{other}`");
            return Err(p.error("wall", &found, "\"half\" or \"full\""));
        }
    };
    let light = if p.has("light") {
        Light::Point(lamp(p, radius)?)
    } else {
        Light::Beam(beam(p)?)
    };
    Ok(CylinderCup {
        wall: Wall {
            radius,
            height,
            cos_half_arc,
        },
        reflectance: p.fraction("R")?,
        light,
    })
}

fn lamp(p: &Object<'_>, radius: f64) -> Result<Lamp<f64>, Error> {
    let Vec3 { x, y, z } = p.vector("light")?;
    let inside = libm::hypot(x, y) <= radius * (1.0 + 4.0 * f64::EPSILON);
    if !(inside && z >= SMALLEST) {
        let allowed = "a light above the floor, inside the circle of radius a or on it";
        return Err(p.error("light", &format!("{:?}", [x, y, z]), allowed));
    }
    Ok(Lamp {
        x,
        y,
        height: z,
        intensity: p.positive("I")?,
    })
}

/// The beam along +x of the parameters.
pub(super) fn beam(p: &Object<'_>) -> Result<Beam<f64>, Error> {
    let given = if p.has("light_direction") {
        let d = p.direction("light_direction")?;
        if !(f64::abs(d.y) <= 1e-12 && d.x > 0.0 && d.z < 0.0) {
            let found = format!("{:?}", d.to_f64());
            return Err(p.error("light_direction", &found, "a direction along +x and down"));
        }
        Some((d.x, -d.z))
    } else {
        None
    };
    let (cosine, sine) = match given {
        Some(given) if !p.has("sin_elevation") && !p.has("cos_elevation") => given,
        _ => (
            p.number("cos_elevation", SMALLEST, 1.0)?,
            p.number("sin_elevation", SMALLEST, 1.0)?,
        ),
    };
    let unit = f64::abs(libm::hypot(cosine, sine) - 1.0) <= 1e-9;
    let agrees =
        given.is_none_or(|(c, s)| f64::abs(c - cosine) <= 1e-9 && f64::abs(s - sine) <= 1e-9);
    if !(unit && agrees) {
        let allowed = "the sine that belongs to cos_elevation and light_direction, to 1e-9";
        return Err(p.error("sin_elevation", &sine.to_string(), allowed));
    }
    Ok(Beam {
        irradiance: p.positive("E0")?,
        sin_elevation: sine,
        cos_elevation: cosine,
    })
}

/// Flatland: points (x_line, y), roots directly under the point.
fn flatland(c: &Object<'_>, p: &Object<'_>) -> Result<Vec<Item>, Error> {
    let cup = Flatland::new(p.positive("a")?, p.positive("E0")?, p.fraction("R")?);
    let line = p.number("x_line", -LARGEST, LARGEST)?;
    let points = c.required_objects("points")?.into_iter();
    points
        .map(|point| {
            let point = point.as_item()?;
            let [x, y] = point.numbers("x")?;
            if !(f64::abs(x - line) <= 1e-9 * (1.0 + f64::abs(line))) {
                let allowed = format!("a point of the line x = {line}");
                return Err(point.error("x[0]", &x.to_string(), &allowed));
            }
            let (fluence, irradiance) = cup.caustic(x, y);
            let (mut fluences, mut irradiances) = (vec![], vec![]);
            cup.for_each_root(x, y, |root, e| {
                fluences.push(single(root.irradiance, fluence.conditioning()));
                irradiances.push(single(e, irradiance.conditioning()));
            });
            let expected = point.objects("roots")?;
            let mut rows = Rows::near(point, &fluence);
            rows.add("fluence_caustic", fluence)?;
            rows.add("E_caustic", irradiance)?;
            rows.add_roots("roots", "fluence", &fluences, &expected)?;
            rows.add_roots("roots", "E", &irradiances, &expected)?;
            rows.finish(cup.distance_to_fold(x, y))
        })
        .collect()
}
