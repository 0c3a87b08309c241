//! Files of schema `nephroid-theory-bandwidth/1`: expectations at finite bandwidth.
//!
//! The parameters are those of a reference configuration of the same scene, in flatland the two distances themselves. A point has `x` and a list `expectations`; each
//! has a `technique`, a `kernel` (the technique's default without one) and `alpha` [rad] or `radius` [m]. Compared are `E` and
//! `second_moment`, where they are present.

use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::flatland::FlatlandMirror;
use nephroid_analytic::bandwidth::{
    self, Bounded, Convention, Expectation, Kernel, Moments, PlanarSetting, Technique, UnknownName,
};
use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::sphere_mirror::{Side, SphereMirror};
use nephroid_analytic::scene::{InvalidParameter, RectangleMirror};

use super::reading::Object;
use super::report::{self, Configuration, Item, Report, Rows};
use super::{BANDWIDTH, flat_interface, planar_mirror, sphere_mirror};
use crate::error::Error;

/// Relative tolerance of the quadrature: the tables are met to 1e-12 by a margin.
const TOLERANCE: f64 = 1e-13;
/// The same on curved surfaces, where the error bounds are wider than the errors.
const TOLERANCE_CURVED: f64 = 1e-11;

/// What a configuration is, ready for any estimator.
enum Setting {
    Planar(PlanarSetting),
    Sphere(SphereMirror<f64>),
    Interface(FlatInterface<f64>),
    Flatland(FlatlandMirror),
}

/// Evaluates a file of schema [`BANDWIDTH`].
pub fn evaluate(top: &Object<'_>) -> Result<Report, Error> {
    let scene = top.text("scene")?;
    let read: fn(&Object<'_>) -> Result<Setting, Error> = match scene {
        "planar-mirror" => |p| setting(p).map(Setting::Planar),
        "concave-sphere" => |p| sphere_mirror::mirror(p, Side::Concave).map(Setting::Sphere),
        "convex-sphere" => |p| sphere_mirror::mirror(p, Side::Convex).map(Setting::Sphere),
        "flat-interface" => |p| flat_interface::interface(p).map(Setting::Interface),
        "flatland-planar-mirror" => |p| flatland(p).map(Setting::Flatland),
        _ => {
            let allowed = "planar-mirror, concave-sphere, convex-sphere, flat-interface or flatland-planar-mirror";
            return Err(top.error("scene", &format!("`{scene}`"), allowed));
        }
    };
    let configurations = top
        .required_objects("configurations")?
        .into_iter()
        .map(|c| {
            let c = c.as_configuration()?;
            let setting = read(&c.object("parameters")?)?;
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

fn flatland(p: &Object<'_>) -> Result<FlatlandMirror, Error> {
    Ok(FlatlandMirror {
        receiver: p.positive("p_receiver_to_mirror")?,
        light: p.positive("q_light_to_mirror")?,
        strength: p.positive("I")? * p.fraction("R")?,
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

impl Setting {
    /// The receiver point; flatland has one only.
    fn receiver(&self, point: &Object<'_>) -> Result<[f64; 3], Error> {
        Ok(match self {
            Setting::Flatland(_) => [0.0; 3],
            Setting::Planar(_) => point.receiver(0.0)?.to_f64(),
            Setting::Sphere(m) => point.receiver(m.receiver_z)?.to_f64(),
            Setting::Interface(w) => point.receiver(w.receiver_z)?.to_f64(),
        })
    }

    fn moments(&self, x: [f64; 3], e: Estimator<'_>) -> Result<Option<Moments>, InvalidParameter> {
        let at = |expectation: EntryExpectation| {
            expectation
                .at(x[0], x[1], TOLERANCE_CURVED)
                .first()
                .copied()
        };
        Ok(match self {
            Setting::Planar(setting) => {
                let expectation =
                    Expectation::new(setting.clone(), e.technique, e.kernel, e.bandwidths)?;
                Some(expectation.at(x, TOLERANCE))
            }
            Setting::Sphere(mirror) => at(EntryExpectation::of_sphere(mirror, e)?),
            Setting::Interface(form) => EntryExpectation::of_interface(form, e)?.and_then(at),
            Setting::Flatland(mirror) => {
                bandwidth::check(e.technique, e.kernel, e.bandwidths)?;
                let flat = if e.technique.bandwidth_is_angle() {
                    Kernel::Cone
                } else {
                    Kernel::Disc
                };
                let moments = mirror.expectation(e.technique, e.bandwidths[0]);
                moments.filter(|_| e.kernel == flat)
            }
        })
    }
}

fn point(setting: &Setting, point: Object<'_>) -> Result<Item, Error> {
    let x = setting.receiver(&point)?;
    let mut rows = Rows::regular(point);
    for e in point.required_objects("expectations")? {
        let technique: Technique = e.text("technique")?.parse().map_err(|u: UnknownName| {
            e.error("technique", &format!("`{}`", u.found), &u.allowed)
        })?;
        let kernel: Kernel = if e.has("kernel") {
            e.text("kernel")?.parse().map_err(|u: UnknownName| {
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
        let estimator = Estimator {
            technique,
            kernel,
            convention: Convention::Exact,
            bandwidths: &[bandwidth],
        };
        let moments = setting.moments(x, estimator).map_err(|i| {
            let place = if i.key == "bandwidth" { key } else { &i.key };
            e.error(place, &i.found, &i.allowed)
        })?;
        let moments = moments.ok_or_else(|| {
            let found = format!("`{technique}` with the kernel {kernel}");
            e.error(
                "technique",
                &found,
                "a technique that is defined in this scene",
            )
        })?;
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
