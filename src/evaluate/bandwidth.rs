//! Files of schema `nephroid-theory-bandwidth/1`: expectations at finite bandwidth.
//!
//! The parameters are those of a `planar-mirror` reference configuration. A point has `x` and a list `expectations`; each
//! has a `technique`, a `kernel` (the technique's default without one) and `alpha` [rad] or `radius` [m]. Compared are `E` and
//! `second_moment`, where they are present.

use nephroid_analytic::bandwidth::{Bounded, Expectation, Kernel, PlanarSetting, Technique};
use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::scene::RectangleMirror;

use super::reading::Object;
use super::report::{self, Configuration, Item, Report, Rows};
use super::{BANDWIDTH, planar_mirror};
use crate::error::Error;

/// Relative tolerance of the quadrature: the tables are met to 1e-12 by a margin.
const TOLERANCE: f64 = 1e-13;

/// Evaluates a file of schema [`BANDWIDTH`].
pub fn evaluate(top: &Object<'_>) -> Result<Report, Error> {
    let scene = top.text("scene")?;
    if scene != "planar-mirror" {
        return Err(top.error("scene", &format!("`{scene}`"), "planar-mirror"));
    }
    let configurations = top
        .required_objects("configurations")?
        .into_iter()
        .map(|c| {
            let c = c.as_configuration()?;
            let setting = setting(&c.object("parameters")?)?;
            let mut items = c
                .required_objects("points")?
                .into_iter()
                .map(|p| point(&setting, p.as_item()?))
                .collect::<Result<Vec<_>, Error>>()?;
            report::compare(&mut items);
            let id = c.text("id")?.to_owned();
            Ok(Configuration { id, items })
        })
        .collect::<Result<_, Error>>()?;
    Ok(Report {
        schema: BANDWIDTH.to_owned(),
        scene: scene.to_owned(),
        configurations,
    })
}

fn setting(p: &Object<'_>) -> Result<PlanarSetting, Error> {
    // Checks every parameter and names the one that is out of range.
    planar_mirror::mirror(p)?;
    let (point, normal) = (
        p.vector("mirror_point")?.to_f64(),
        p.direction("mirror_normal")?.to_f64(),
    );
    let reflectance = p.fraction("R")?;
    let setting = PlanarSetting::unbounded(
        p.vector("light")?.to_f64(),
        p.positive("I")?,
        point,
        normal,
        reflectance,
        [0.0, 0.0, 1.0],
    )
    .map_err(|e| p.error(&e.key, &e.found, &e.allowed))?;
    if p.get("extent").is_none_or(|e| e.is_string()) {
        return Ok(setting);
    }
    let extent = p.object("extent")?;
    Ok(setting.with_mirror(&RectangleMirror {
        center: point,
        normal,
        edge: extent.direction("edge")?.to_f64(),
        half_width: extent.positive("half_width")?,
        half_height: extent.positive("half_height")?,
        reflectance,
    }))
}

fn point(setting: &PlanarSetting, point: Object<'_>) -> Result<Item, Error> {
    let x = point.receiver(0.0)?.to_f64();
    let mut rows = Rows::regular(point);
    for e in point.required_objects("expectations")? {
        let technique: Technique = e.text("technique")?.parse().map_err(
            |u: nephroid_analytic::bandwidth::UnknownName| {
                e.error("technique", &format!("`{}`", u.found), &u.allowed)
            },
        )?;
        let kernel: Kernel = if e.has("kernel") {
            e.text("kernel")?
                .parse()
                .map_err(|u: nephroid_analytic::bandwidth::UnknownName| {
                    e.error("kernel", &format!("`{}`", u.found), &u.allowed)
                })?
        } else {
            technique.default_kernel()
        };
        let key = if technique.bandwidth_is_angle() {
            "alpha"
        } else {
            "radius"
        };
        let bandwidth = e.positive(key)?;
        let expectation = Expectation::new(setting.clone(), technique, kernel, &[bandwidth])
            .map_err(|i| {
                let place = if i.key == "bandwidth" { key } else { &i.key };
                e.error(place, &i.found, &i.allowed)
            })?;
        let moments = expectation.at(x, TOLERANCE);
        let name = format!("{technique}.{kernel}.{bandwidth}");
        rows.add_as(&format!("{name}.E"), estimate(moments.mean), &e, "E")?;
        let second = estimate(moments.second_moment);
        rows.add_as(
            &format!("{name}.second_moment"),
            second,
            &e,
            "second_moment",
        )?;
    }
    rows.finish(None)
}

fn estimate(b: Bounded) -> Estimate<f64> {
    Estimate {
        value: b.value,
        error: b.error,
        roots: u32::from(b.value > 0.0),
    }
}
