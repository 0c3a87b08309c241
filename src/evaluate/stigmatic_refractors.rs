//! Reference configurations with a stigmatic refractor: J1 (ellipsoid in a beam), J2 (Cartesian oval).
//!
//! With `a` the front is an ellipsoid of eccentricity 1/n in a beam `E0`; with `C` the oval r1 + n r2 = C with a light `I`
//! at (0, 0, `D`). The receiver z = -`delta` lies in the glass and faces up.

use nephroid_analytic::kinds::stigmatic_refractors::{Front, StigmaticRefractor};

use super::add_one_root;
use super::reading::{LARGEST, Object};
use super::report::{Item, Rows};
use crate::error::Error;

/// The refractor of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn refractor(p: &Object<'_>) -> Result<StigmaticRefractor<f64>, Error> {
    let index = p.number("n", 1.000_001, 10.0)?;
    let front = if p.has("a") {
        Front::Ellipsoid {
            semi_axis: p.positive("a")?,
            irradiance: p.positive("E0")?,
        }
    } else {
        let light_z = p.positive("D")?;
        let optical_length = p.positive("C")?;
        if !(optical_length > light_z && optical_length < index * light_z) {
            let allowed = format!("a length between D = {light_z} and n D, both excluded");
            return Err(p.error("C", &optical_length.to_string(), &allowed));
        }
        Front::Oval {
            light_z,
            optical_length,
            intensity: p.positive("I")?,
        }
    };
    Ok(StigmaticRefractor {
        index,
        front,
        defocus: p.number("delta", -LARGEST, LARGEST)?,
    })
}

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let (refractor, albedo) = (refractor(&p)?, p.fraction("albedo")?);
    let points = c.required_objects("points")?.into_iter().map(|point| {
        let point = point.as_item()?;
        let x = point.receiver(-refractor.defocus)?;
        let caustic = refractor.caustic(x.x, x.y);
        let mut rows = Rows::near(point, &caustic);
        add_one_root(&mut rows, albedo, None, caustic)?;
        rows.finish(refractor.singularity(x.x, x.y).map(|s| s.distance))
    });
    points.collect()
}
