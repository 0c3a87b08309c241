//! Truth at the points of a reference file, compared with the file's expected values.
//!
//! A file of schema `nephroid-theory-reference/1` has a `scene` and `configurations`; each has an `id`, `parameters`,
//! `points` and, for some, `views`. Only ids, parameters and points are needed: whatever expected value is there is
//! compared, `null` counts as absent. Compared are the radiometric keys (`E*`, `L*`, `fluence*`, `specular_weight`, `T`);
//! everything else is ignored.
//!
//! Each other schema is one more arm of [`evaluate`].

mod bandwidth;
mod certify;
mod conic_mirrors;
mod cylinder_cup;
mod diffuse;
mod flat_interface;
mod glass_slab;
mod glass_sphere;
mod paraboloid;
mod planar_chains;
mod planar_mirror;
pub mod reading;
pub mod report;
mod sphere_mirror;
mod stigmatic_refractors;
mod vertical_walls;
mod water_waves;

use nephroid_analytic::kinds::{Estimate, rounding_error};
use serde_json::Value;

use crate::error::Error;
pub use crate::evaluate::certify::Certificate;
use crate::evaluate::reading::Object;
pub use crate::evaluate::report::{Configuration, Item, Placed, Report, Row};

/// The schema of tables of points.
pub const REFERENCE: &str = "nephroid-theory-reference/1";
/// The schema of tables of expectations at finite bandwidth.
pub const BANDWIDTH: &str = "nephroid-theory-bandwidth/1";

/// Evaluates the text of a reference file; `file` is its name for messages.
///
/// # Errors
/// [`Error::Content`] or [`Error::UnknownName`] for anything that is not such a file, with the place and what is allowed.
pub fn evaluate(file: &str, text: &str) -> Result<Report, Error> {
    let value: Value = serde_json::from_str(text).map_err(|e| Error::Content {
        file: file.to_owned(),
        message: format!("line {}, column {}: {e}", e.line(), e.column()),
        help: "allowed: JSON with the keys schema, scene and configurations".into(),
    })?;
    let top = Object::top(file, &value)?;
    match top.text("schema")? {
        REFERENCE => evaluate_reference(&top),
        BANDWIDTH => bandwidth::evaluate(&top),
        other => {
            let allowed = format!("{REFERENCE} or {BANDWIDTH}");
            Err(top.error("schema", &format!("`{other}`"), &allowed))
        }
    }
}

/// As [`evaluate`], with a [`Certificate`] for every value of a file of schema [`REFERENCE`] that has one.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_certified(file: &str, text: &str) -> Result<Report, Error> {
    let mut report = evaluate(file, text)?;
    certify::certify(text, &mut report);
    Ok(report)
}

/// Evaluates a file of schema [`REFERENCE`].
fn evaluate_reference(top: &Object<'_>) -> Result<Report, Error> {
    let scene = top.text("scene")?;
    let evaluate: fn(&Object<'_>) -> Result<Vec<Item>, Error> = match scene {
        "diffuse" => diffuse::configuration,
        "planar-mirror" => planar_mirror::configuration,
        "cylinder-cup" => cylinder_cup::configuration,
        "flat-interface" => flat_interface::configuration,
        "glass-slab" => glass_slab::configuration,
        "concave-sphere" => sphere_mirror::concave,
        "convex-sphere" => sphere_mirror::convex,
        "planar-chains" => planar_chains::configuration,
        "paraboloid" => paraboloid::configuration,
        "conic-mirrors" => conic_mirrors::configuration,
        "stigmatic-refractors" => stigmatic_refractors::configuration,
        "glass-sphere" => glass_sphere::configuration,
        "water-waves" => water_waves::configuration,
        "pillar" => vertical_walls::pillar,
        "conic-wall" => vertical_walls::conic_wall,
        "glass-pillar" => vertical_walls::glass_pillar,
        other => {
            let allowed = "diffuse, planar-mirror, cylinder-cup, flat-interface, glass-slab, \
                           concave-sphere, convex-sphere, planar-chains, paraboloid, \
                           conic-mirrors, stigmatic-refractors, glass-sphere, water-waves, pillar, conic-wall, \
                           glass-pillar";
            return Err(top.error("scene", &format!("`{other}`"), allowed));
        }
    };
    let configurations = top
        .required_objects("configurations")?
        .into_iter()
        .map(|c| {
            let c = c.as_configuration()?;
            let mut items = evaluate(&c)?;
            report::compare(&mut items);
            let id = c.text("id")?.to_owned();
            Ok(Configuration { id, items })
        })
        .collect::<Result<_, Error>>()?;
    Ok(Report {
        schema: REFERENCE.to_owned(),
        scene: scene.to_owned(),
        configurations,
    })
}

/// Radiance ρE/π of a Lambertian receiver.
fn radiance(albedo: f64, irradiance: Estimate<f64>) -> Estimate<f64> {
    scaled(irradiance, albedo / core::f64::consts::PI, 1.0)
}

/// A value times a factor that has its own conditioning.
fn scaled(estimate: Estimate<f64>, factor: f64, conditioning: f64) -> Estimate<f64> {
    let value = estimate.value * factor;
    Estimate {
        value,
        error: estimate.error * factor + rounding_error(value, conditioning),
        roots: estimate.roots,
    }
}

/// The sum of two estimates.
fn sum(a: Estimate<f64>, b: Estimate<f64>) -> Estimate<f64> {
    let value = a.value + b.value;
    Estimate {
        value,
        error: a.error + b.error + rounding_error(value, 0.0),
        roots: a.roots + b.roots,
    }
}

/// One value with a conditioning.
fn single(value: f64, conditioning: f64) -> Estimate<f64> {
    Estimate {
        value,
        error: rounding_error(value, conditioning),
        roots: 1,
    }
}

/// The rows of a point that at most one ray of the class LSDE lights; direct light only where the scene compares it.
fn add_one_root(
    rows: &mut report::Rows<'_>,
    albedo: f64,
    direct: Option<Estimate<f64>>,
    caustic: Estimate<f64>,
) -> Result<(), Error> {
    if let Some(direct) = direct {
        rows.add("E_direct", direct)?;
        rows.add("L_total", radiance(albedo, sum(direct, caustic)))?;
    }
    rows.add("E_caustic", caustic)?;
    rows.add("L_caustic", radiance(albedo, caustic))?;
    let roots = [caustic];
    let count = usize::from(caustic.roots > 0);
    rows.add_class("LSDE", caustic, roots.get(..count).unwrap_or_default())?;
    rows.add_missing_classes()
}

/// Checks that the position `key` is (0, 0, z), to 1e-9 of its size.
fn on_axis(p: &Object<'_>, key: &str, z: f64, what: &str) -> Result<(), Error> {
    let at = p.vector(key)?;
    let off = at.x.abs().max(at.y.abs()).max(f64::abs(at.z - z));
    if off <= 1e-9 * (1.0 + z.abs()) {
        Ok(())
    } else {
        let allowed = format!("{what}, here [0, 0, {z}]");
        Err(p.error(key, &format!("{:?}", at.to_f64()), &allowed))
    }
}

/// What is seen of a receiver point by way of a specular surface: the rows that all views have.
fn add_view(
    rows: &mut report::Rows<'_>,
    weight: Estimate<f64>,
    albedo: f64,
    direct: Estimate<f64>,
    caustic: Estimate<f64>,
) -> Result<(), Error> {
    let seen = |e: Estimate<f64>| {
        let l = radiance(albedo, e);
        let relative = if weight.value > 0.0 {
            weight.error / weight.value
        } else {
            0.0
        };
        Estimate {
            value: l.value * weight.value,
            error: l.error * weight.value + l.value * relative * weight.value,
            roots: l.roots,
        }
    };
    rows.add("specular_weight", weight)?;
    rows.add("E_direct", direct)?;
    rows.add("E_caustic", caustic)?;
    rows.add("L_direct_seen", seen(direct))?;
    rows.add("L_caustic_seen", seen(caustic))?;
    rows.add("L", seen(sum(direct, caustic)))
}
