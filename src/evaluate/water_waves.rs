//! Reference configurations with a vertical beam through waves: L1, L2.
//!
//! `waves_A_k_phase` has one row [A, k, phase] per wave A cos(kx + phase); the surface is at `mean_depth_H` above the floor
//! z = 0, which is lit by LSDE alone. Views come from above the crests.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::water_waves::{Refused, WaterWaves, Wave};

use super::reading::Object;
use super::report::{Item, Rows};
use super::{add_view, radiance, single};
use crate::error::Error;

/// The most waves in one configuration.
const MAX_WAVES: usize = 64;
/// The largest phase of a wave at x = 0 and at a point [rad]: farther away rounding of the phase outweighs the waves.
const MAX_PHASE: f64 = 1e7;

/// The waves of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn waves(p: &Object<'_>) -> Result<WaterWaves<f64>, Error> {
    let key = "waves_A_k_phase";
    let rows = p.rows::<3>(key)?;
    if rows.len() > MAX_WAVES {
        let allowed = format!("at most {MAX_WAVES} rows");
        return Err(p.error(key, &format!("{} rows", rows.len()), &allowed));
    }
    for (i, [_, _, phase]) in rows.iter().enumerate() {
        if !(phase.abs() <= MAX_PHASE) {
            let allowed = format!("a phase from -{MAX_PHASE:e} to {MAX_PHASE:e} rad");
            return Err(p.error(&format!("{key}[{i}][2]"), &phase.to_string(), &allowed));
        }
    }
    if p.has("light_direction") {
        let d = p.direction("light_direction")?;
        if !(d.x.abs().max(d.y.abs()) <= 1e-12 && d.z < 0.0) {
            let found = format!("{:?}", d.to_f64());
            return Err(p.error("light_direction", &found, "[0, 0, -1]"));
        }
    }
    let waves = rows
        .into_iter()
        .map(|[amplitude, wave_number, phase]| Wave {
            amplitude,
            wave_number,
            phase,
        })
        .collect();
    let index = p.number("n", 1.000_001, 10.0)?;
    let depth = p.positive("mean_depth_H")?;
    WaterWaves::new(index, depth, p.positive("E0")?, waves).map_err(|refused| {
        let (key, found, allowed) = match refused {
            Refused::Index => ("n", index.to_string(), "an index above 1"),
            Refused::Depth => (
                "mean_depth_H",
                depth.to_string(),
                "a depth above the sum of all |A|: the troughs must not reach the floor",
            ),
            Refused::Steep => (
                key,
                "waves so steep that refracted light could meet them again".to_owned(),
                "a sum s of all |A k| for which s times the tangent of the deviation at slope s is below 1",
            ),
            Refused::TooManyWavelengths => (
                key,
                "too many wavelengths over the floor that one point can be lit from".to_owned(),
                "(H + sum |A|) times the tangent of the largest deviation times the largest |k| below 2e4",
            ),
        };
        p.error(key, &found, allowed)
    })
}

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let (water, albedo) = (waves(&p)?, p.fraction("albedo")?);
    let points = c.required_objects("points")?.into_iter().map(|point| {
        let point = point.as_item()?;
        let x = point.receiver(0.0)?.x;
        if !(x.abs() * water.largest_wave_number() <= MAX_PHASE) {
            let allowed = format!("a point at most {MAX_PHASE:e} rad of the shortest wave from 0");
            return Err(point.error("x[0]", &x.to_string(), &allowed));
        }
        let caustic = water.caustic(x);
        let mut rows = Rows::near(point, &caustic);
        rows.add("E_caustic", caustic)?;
        rows.add("L_caustic", radiance(albedo, caustic))?;
        let mut roots = vec![];
        water.for_each_root(x, |root| {
            let mut one = Estimate::NONE;
            one.add(root.irradiance, root.conditioning);
            roots.push(one);
        });
        rows.add_class("LSDE", caustic, &roots)?;
        rows.add_missing_classes()?;
        rows.finish(water.singularity(x).map(|s| s.distance))
    });
    let views = c
        .objects("views")?
        .into_iter()
        .map(|item| view(&water, albedo, item.as_item()?));
    points.chain(views).collect()
}

fn view(water: &WaterWaves<f64>, albedo: f64, item: Object<'_>) -> Result<Item, Error> {
    let (camera, aim) = item.ray()?;
    if !(camera.z > water.highest()) {
        let allowed = format!("a camera above the crests, z > {}", water.highest());
        return Err(item.error("camera[2]", &camera.z.to_string(), &allowed));
    }
    if !(camera.length().max(aim.length()) * water.largest_wave_number() <= MAX_PHASE) {
        let allowed = format!("a position at most {MAX_PHASE:e} rad of the shortest wave from 0");
        return Err(item.error("camera", &format!("{:?}", camera.to_f64()), &allowed));
    }
    if !water.is_searched(camera, aim) {
        let key = if item.has("aim") { "aim" } else { "first_hit" };
        let allowed = "a ray that passes over less than 1e5 radians of phase within the waves";
        return Err(item.error(key, "a ray almost along the surface", allowed));
    }
    let none = Estimate::NONE;
    let Some(seen) = water.look(camera, aim) else {
        let mut rows = Rows::regular(item);
        rows.add("T", none)?;
        add_view(&mut rows, none, albedo, none, none)?;
        return rows.finish(None);
    };
    let x = seen.floor.x;
    let caustic = water.caustic(x);
    let mut rows = Rows::near(item, &caustic);
    // The conditioning is per relative change of lengths of at least this size. Flat water lights all places alike.
    let size = x.abs().max(water.reach());
    let caustic = if water.reach() > 0.0 {
        caustic.displaced(seen.error / size)
    } else {
        caustic
    };
    rows.add("T", single(seen.transmittance, seen.conditioning))?;
    let weight = single(seen.weight, seen.conditioning);
    add_view(&mut rows, weight, albedo, none, caustic)?;
    rows.finish(water.singularity(x).map(|s| s.distance))
}
