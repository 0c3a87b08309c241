//! Reference configurations with a vertical wall: PI (mirror pillar), CW (conic wall), GP (glass pillar).
//!
//! A pillar is given by `center`, radius `a` and height `H`, a conic wall by `focus`, `axis` (to the nearest vertex, of any
//! length), semi-latus rectum `p`, eccentricity `e`, height `H` and `half_arc` in radians or `"closed"`. Mirrors have `R` and
//! a point `light` with `I`; glass has `n`, a beam along +x with `E0`, `sin_elevation` and `cos_elevation`, and
//! `max_interactions`, the most with the side that are in `E_caustic`.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::glass_pillar::GlassPillar;
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::vector::Vec3;

use super::cylinder_cup::beam;
use super::reading::{Object, SMALLEST};
use super::report::{Item, Rows};
use super::{radiance, single, sum};
use crate::error::Error;

/// The most interactions with a glass pillar that a file may list.
const MAX_INTERACTIONS: u32 = 14;

/// One class at a point: its name with S for every interaction, its light, and that of each of its rays.
type Class = (String, Estimate<f64>, Vec<Estimate<f64>>);

fn floor_point(
    point: Object<'_>,
    albedo: f64,
    direct: Estimate<f64>,
    classes: &[Class],
    singularity: Option<f64>,
) -> Result<Item, Error> {
    let caustic = classes
        .iter()
        .map(|(_, total, _)| *total)
        .fold(Estimate::NONE, sum);
    let mut rows = Rows::near(point, &caustic);
    rows.add("E_direct", direct)?;
    rows.add("E_caustic", caustic)?;
    rows.add("L_caustic", radiance(albedo, caustic))?;
    rows.add("L_total", radiance(albedo, sum(direct, caustic)))?;
    for (class, total, roots) in classes {
        rows.add_class(class, *total, roots)?;
    }
    rows.add_missing_classes()?;
    rows.finish(singularity)
}

fn each_point<'a>(
    c: &Object<'a>,
    item: impl Fn(Object<'a>, Vec3<f64>) -> Result<Item, Error>,
) -> Result<Vec<Item>, Error> {
    let points = c.required_objects("points")?.into_iter();
    points
        .map(|point| {
            let point = point.as_item()?;
            let x = point.receiver(0.0)?;
            item(point, x)
        })
        .collect()
}

/// A point light above the floor.
fn light(
    p: &Object<'_>,
    allowed: &str,
    good: impl Fn(Vec3<f64>) -> bool,
) -> Result<Vec3<f64>, Error> {
    let light = p.vector("light")?;
    if light.z >= SMALLEST && good(light) {
        Ok(light)
    } else {
        Err(p.error("light", &format!("{:?}", light.to_f64()), allowed))
    }
}

/// Evaluates one configuration with a mirror pillar.
pub fn pillar(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let ([x, y], radius) = (p.numbers("center")?, p.positive("a")?);
    let allowed = format!("a light above the floor, farther than a = {radius} from the axis");
    let pillar = Pillar {
        x,
        y,
        radius,
        height: p.positive("H")?,
        reflectance: p.fraction("R")?,
        light: light(&p, &allowed, |at| libm::hypot(at.x - x, at.y - y) > radius)?,
        intensity: p.positive("I")?,
    };
    let albedo = p.fraction("albedo")?;
    each_point(c, |point, x| {
        let root = pillar.reflection(x.x, x.y).filter(|r| r.inside >= 0.0);
        let roots = root.map(|r| single(r.irradiance, r.conditioning));
        let class = (
            "LSDE".to_owned(),
            pillar.caustic(x.x, x.y),
            Vec::from_iter(roots),
        );
        floor_point(point, albedo, pillar.direct(x.x, x.y), &[class], None)
    })
}

/// Evaluates one configuration with a conic wall.
pub fn conic_wall(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let wall = conic(&p)?;
    let albedo = p.fraction("albedo")?;
    each_point(c, |point, x| {
        let mut roots = vec![];
        wall.for_each_root(x.x, x.y, |root| {
            if root.is_lit() {
                roots.push(single(root.irradiance, root.conditioning));
            }
        });
        let class = ("LSDE".to_owned(), wall.caustic(x.x, x.y), roots);
        let singularity = wall.singularity(x.x, x.y).map(|s| s.distance);
        floor_point(point, albedo, wall.direct(x.x, x.y), &[class], singularity)
    })
}

fn conic(p: &Object<'_>) -> Result<ConicWall<f64>, Error> {
    let [x, y] = p.numbers("focus")?;
    let [ax, ay]: [f64; 2] = p.numbers("axis")?;
    let length = libm::hypot(ax, ay);
    if !(length >= SMALLEST) {
        let allowed = "a vector of length 1e-9 or more";
        return Err(p.error("axis", "a vector of no length", allowed));
    }
    let eccentricity = p.number("e", 0.0, 10.0)?;
    let half_arc = match p.get("half_arc").and_then(|h| h.as_str()) {
        Some("closed") => None,
        _ => Some(p.number("half_arc", SMALLEST, core::f64::consts::PI)?),
    };
    let end = half_arc.unwrap_or(core::f64::consts::PI);
    if !(1.0 + eccentricity * libm::cos(end) > 0.0) {
        let allowed = "an arc of one branch: 1 + e cos(half_arc) above 0";
        return Err(p.error("half_arc", &end.to_string(), allowed));
    }
    let parameter = p.positive("p")?;
    let mut wall = ConicWall {
        x,
        y,
        axis: (ax / length, ay / length),
        parameter,
        eccentricity,
        half_arc,
        height: p.positive("H")?,
        reflectance: p.fraction("R")?,
        light: Vec3::from_f64([x, y, 1.0]),
        intensity: p.positive("I")?,
    };
    let allowed = "a light above the floor, on the inner side of the wall";
    wall.light = light(p, allowed, |at| wall.inside(at.x, at.y) > 0.0)?;
    Ok(wall)
}

/// Evaluates one configuration with a glass pillar.
pub fn glass_pillar(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let ([x, y], beam) = (p.numbers("center")?, beam(&p)?);
    let pillar = GlassPillar {
        x,
        y,
        radius: p.positive("a")?,
        height: p.positive("H")?,
        index: p.number("n", 1.000_001, 10.0)?,
        irradiance: beam.irradiance,
        sin_elevation: beam.sin_elevation,
        cos_elevation: beam.cos_elevation,
    };
    let most = p.whole("max_interactions", 1, MAX_INTERACTIONS)?;
    let albedo = p.fraction("albedo")?;
    each_point(c, |point, x| {
        let class = |m: u32| {
            let mut roots = vec![];
            if pillar.outside(x.x, x.y) > 0.0 {
                pillar.for_each_root(x.x, x.y, m, |root| {
                    if root.below_top >= 0.0 {
                        roots.push(single(root.irradiance, root.conditioning));
                    }
                });
            }
            let name = format!("L{}DE", "S".repeat(m as usize));
            (name, pillar.caustic(x.x, x.y, m), roots)
        };
        let classes: Vec<_> = (1..=most).map(class).collect();
        let distances = (1..=most).filter_map(|m| pillar.singularity(x.x, x.y, m));
        let nearest = distances.map(|s| s.distance).reduce(f64::min);
        floor_point(point, albedo, pillar.direct(x.x, x.y), &classes, nearest)
    })
}
