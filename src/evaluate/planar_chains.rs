//! Reference configurations with chains of plane mirrors: M1 (wedge), M2 (corridor).
//!
//! A configuration with `m` is a wedge, its light given by `light_polar` (radius, angle, z), or by `light` alone; one with
//! `W` is a corridor, of which `orders_listed` orders are in `E_caustic`.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::planar_chains::{Corridor, Image, MAX_BOUNCES, Wedge};
use nephroid_analytic::vector::Vec3;

use super::reading::{LARGEST, Object, SMALLEST};
use super::report::{Item, Rows};
use super::{radiance, single, sum};
use crate::error::Error;

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let albedo = p.fraction("albedo")?;
    let points = c.required_objects("points")?.into_iter();
    if p.has("m") {
        let wedge = wedge(&p)?;
        let point = |point: Object<'_>| {
            let point = point.as_item()?;
            let x = point.receiver(0.0)?;
            let class = |k| (wedge.caustic(x.x, x.y, k), wedge.images(x.x, x.y, k));
            floor_point(point, albedo, wedge.direct(x.x, x.y), wedge.m, class, None)
        };
        points.map(point).collect()
    } else if p.has("W") {
        let corridor = corridor(&p)?;
        let orders = p.whole("orders_listed", 1, MAX_BOUNCES)?;
        let point = |point: Object<'_>| {
            let point = point.as_item()?;
            let x = point.receiver(0.0)?;
            let class = |k| (corridor.caustic(x.x, x.y, k), corridor.images(x.x, x.y, k));
            let (direct, all) = (corridor.direct(x.x, x.y), corridor.all_orders(x.x, x.y));
            floor_point(point, albedo, direct, orders, class, Some(all))
        };
        points.map(point).collect()
    } else {
        Err(p.error(
            "m",
            "neither `m` nor `W`",
            "`m` for a wedge, `W` for a corridor",
        ))
    }
}

type Class = (Estimate<f64>, [Option<Image<f64>>; 2]);

fn floor_point(
    point: Object<'_>,
    albedo: f64,
    direct: Estimate<f64>,
    orders: u32,
    class: impl Fn(u32) -> Class,
    all_orders: Option<Estimate<f64>>,
) -> Result<Item, Error> {
    let classes: Vec<Class> = (1..=orders).map(class).collect();
    let caustic = classes
        .iter()
        .map(|(total, _)| *total)
        .fold(Estimate::NONE, sum);
    let mut rows = Rows::regular(point);
    rows.add("E_direct", direct)?;
    rows.add("E_caustic", caustic)?;
    rows.add("L_caustic", radiance(albedo, caustic))?;
    rows.add("L_total", radiance(albedo, sum(direct, caustic)))?;
    if let Some(all) = all_orders {
        rows.add("E_caustic_all_orders", all)?;
    }
    for (k, (total, images)) in (1..).zip(&classes) {
        let roots: Vec<_> = images
            .iter()
            .flatten()
            .filter(|_| total.roots > 0)
            .map(|image| single(image.irradiance, image.conditioning))
            .collect();
        rows.add_class(&format!("L{}DE", "S".repeat(k)), *total, &roots)?;
    }
    rows.add_missing_classes()?;
    rows.finish(None)
}

/// The wedge of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn wedge(p: &Object<'_>) -> Result<Wedge<f64>, Error> {
    let m = p.whole("m", 1, MAX_BOUNCES)?;
    let cartesian = if p.has("light") {
        let Vec3 { x, y, z } = p.vector("light")?;
        Some([libm::hypot(x, y), libm::atan2(y, x), z])
    } else {
        None
    };
    let [radius, angle, height] = match cartesian {
        Some(polar) if !p.has("light_polar") => polar,
        _ => p.numbers("light_polar")?,
    };
    let wedge = Wedge {
        m,
        radius,
        angle,
        height,
        intensity: p.positive("I")?,
        reflectance: p.fraction("R")?,
    };
    let key = if p.has("light_polar") {
        "light_polar"
    } else {
        "light"
    };
    let found = format!("(radius, angle, z) = {:?}", [radius, angle, height]);
    if !(radius >= SMALLEST && height >= SMALLEST && angle > 0.0 && angle < wedge.opening()) {
        let allowed = "a light above the floor and inside the wedge: angle from 0 to pi/m";
        return Err(p.error(key, &found, allowed));
    }
    let far = |polar: [f64; 3]| {
        let scale = 1.0 + radius + height;
        f64::abs(polar[0] - radius) > 1e-9 * scale
            || f64::abs(polar[1] - angle) > 1e-9 * scale
            || f64::abs(polar[2] - height) > 1e-9 * scale
    };
    if cartesian.is_some_and(far) {
        let allowed = "the position that `light` has, to 1e-9";
        return Err(p.error("light_polar", &found, allowed));
    }
    Ok(wedge)
}

/// The corridor of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn corridor(p: &Object<'_>) -> Result<Corridor<f64>, Error> {
    let width = p.number("W", SMALLEST, LARGEST)?;
    let light = p.vector("light")?;
    if !(light.x > 0.0 && light.x < width && light.z >= SMALLEST) {
        let allowed = "a light above the floor z = 0 and between the mirrors x = 0 and x = W";
        return Err(p.error("light", &format!("{:?}", light.to_f64()), allowed));
    }
    Ok(Corridor {
        width,
        light,
        intensity: p.positive("I")?,
        reflectance: p.fraction("R")?,
    })
}
