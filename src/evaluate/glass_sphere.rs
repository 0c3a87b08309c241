//! Reference configurations with a glass sphere in a beam: K1, K2 (two refractions), K3 (one internal reflection).
//!
//! `light_direction` is along ±z, `receiver_z` at least a radius from the centre, the receiver faces the sphere. The
//! classes of a configuration are those that its points list in `paths`; where no point lists any, LSSDE for a receiver
//! behind the sphere, as seen from the light, and LSSSDE for one before it. `i_max` is π/2 where it is missing.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::glass_sphere::{GlassSphere, MAX_INTERACTIONS};
use nephroid_analytic::kinds::singularity::Singularity;

use super::reading::{LARGEST, Object};
use super::report::{Item, Rows};
use super::{radiance, sum};
use crate::error::Error;

/// The sphere of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn sphere(p: &Object<'_>) -> Result<GlassSphere<f64>, Error> {
    let radius = p.positive("a")?;
    let plane = p.number("receiver_z", -LARGEST, LARGEST)?;
    if !(f64::abs(plane) >= radius) {
        let allowed = format!("a plane that does not cut the sphere: a = {radius} or more from 0");
        return Err(p.error("receiver_z", &plane.to_string(), &allowed));
    }
    let mut receiver_z = plane;
    if p.has("light_direction") {
        let d = p.direction("light_direction")?;
        if !(d.x.abs().max(d.y.abs()) <= 1e-12) {
            let found = format!("{:?}", d.to_f64());
            return Err(p.error("light_direction", &found, "a direction along +z or -z"));
        }
        // Along -z everything is upside down.
        receiver_z = if d.z < 0.0 { -plane } else { plane };
    }
    let quarter = core::f64::consts::FRAC_PI_2;
    let max_incidence = if p.has("i_max") {
        p.number("i_max", 1e-6, quarter)?
    } else {
        quarter
    };
    Ok(GlassSphere {
        index: p.number("n", 1.000_001, 10.0)?,
        radius,
        irradiance: p.positive("E0")?,
        receiver_z,
        max_incidence,
    })
}

/// The numbers of interactions whose light `E_caustic` holds, in ascending order.
fn listed_classes(points: &[Object<'_>], sphere: &GlassSphere<f64>) -> Result<Vec<u32>, Error> {
    let mut listed = vec![];
    for point in points {
        let point = point.as_item()?;
        for path in point.objects("paths")? {
            let name = path.text("class")?;
            let chain = name.strip_prefix('L').and_then(|t| t.strip_suffix("DE"));
            let count = chain
                .filter(|c| c.chars().all(|l| "SRT".contains(l)))
                .and_then(|c| u32::try_from(c.len()).ok())
                .filter(|m| (1..=MAX_INTERACTIONS).contains(m));
            let Some(interactions) = count else {
                let allowed = format!("L, 1 to {MAX_INTERACTIONS} of S R T, then DE");
                return Err(path.error("class", &format!("`{name}`"), &allowed));
            };
            if !listed.contains(&interactions) {
                listed.push(interactions);
            }
        }
    }
    listed.sort_unstable();
    if listed.is_empty() {
        listed.push(if sphere.receiver_z > 0.0 { 2 } else { 3 });
    }
    Ok(listed)
}

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let (sphere, albedo) = (sphere(&p)?, p.fraction("albedo")?);
    let plane = p.number("receiver_z", -LARGEST, LARGEST)?;
    let points = c.required_objects("points")?;
    let classes = listed_classes(&points, &sphere)?;
    let points = points.into_iter().map(|point| {
        let point = point.as_item()?;
        let x = point.receiver(plane)?;
        let rho = libm::hypot(x.x, x.y);
        let caustics = classes.iter().map(|&m| sphere.caustic(rho, m));
        let caustic = caustics.reduce(sum).unwrap_or(Estimate::NONE);
        let mut rows = Rows::near(point, &caustic);
        rows.add("E_caustic", caustic)?;
        rows.add("L_caustic", radiance(albedo, caustic))?;
        let mut singularity = None;
        for &m in &classes {
            let mut roots = vec![];
            sphere.for_each_root(rho, m, |root| {
                if root.inside >= 0.0 {
                    let mut one = Estimate::NONE;
                    one.add(root.irradiance, root.conditioning);
                    roots.push(one);
                }
            });
            let class = format!("L{}DE", "S".repeat(m as usize));
            rows.add_class(&class, sphere.caustic(rho, m), &roots)?;
            singularity = Singularity::nearer(singularity, sphere.singularity(rho, m));
        }
        rows.finish(singularity.map(|s| s.distance))
    });
    points.collect()
}
