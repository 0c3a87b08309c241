//! Reference configurations with a flat mirror: B1 to B3.
//!
//! `extent` is `"unbounded"`, or an object `{"edge": [x, y, z], "half_width": w, "half_height": h}`: a rectangle centred at
//! `mirror_point`, with `half_width` along `edge` and `half_height` along normal × edge, as in a scene file.

use nephroid_analytic::kinds::planar_mirror::{PlanarMirror, Rectangle};

use super::reading::{Object, SMALLEST};
use super::report::{Item, Rows};
use super::{add_view, radiance, single, sum};
use crate::error::Error;

/// The mirror of the parameters of a reference or bandwidth file.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn mirror(p: &Object<'_>) -> Result<PlanarMirror<f64>, Error> {
    let light = p.vector("light")?;
    let normal = p.direction("mirror_normal")?;
    let extent = match p.get("extent") {
        None => None,
        Some(v) if v.as_str() == Some("unbounded") => None,
        Some(v) if v.is_object() => {
            let e = p.object("extent")?;
            let edge = e.direction("edge")?;
            if !(f64::abs(edge.dot(normal)) <= 1e-12) {
                let allowed = "a direction perpendicular to mirror_normal, to 1e-12";
                return Err(e.error("edge", "another direction", allowed));
            }
            Some(Rectangle {
                edge,
                other: normal.cross(edge),
                half_width: e.positive("half_width")?,
                half_height: e.positive("half_height")?,
            })
        }
        Some(v) => {
            let allowed = "\"unbounded\", or an object with edge, half_width and half_height";
            return Err(p.error("extent", &v.to_string(), allowed));
        }
    };
    let mirror = PlanarMirror::new(
        light,
        p.positive("I")?,
        p.fraction("R")?,
        p.vector("mirror_point")?,
        normal,
        extent,
    );
    if !(light.z >= SMALLEST && mirror.side(light) >= SMALLEST) {
        let allowed = "a light above the floor z = 0 and in front of the mirror";
        return Err(p.error("light", &format!("{:?}", light.to_f64()), allowed));
    }
    Ok(mirror)
}

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let (mirror, albedo) = (mirror(&p)?, p.fraction("albedo")?);
    let points = c.required_objects("points")?.into_iter().map(|point| {
        let point = point.as_item()?;
        let x = point.receiver(0.0)?;
        let (direct, caustic) = (mirror.direct(x), mirror.caustic(x));
        let mut rows = Rows::regular(point);
        rows.add("E_direct", direct)?;
        rows.add("E_caustic", caustic)?;
        rows.add("L_caustic", radiance(albedo, caustic))?;
        rows.add("L_total", radiance(albedo, sum(direct, caustic)))?;
        let roots = if caustic.roots > 0 {
            &[caustic][..]
        } else {
            &[]
        };
        rows.add_class("LSDE", caustic, roots)?;
        rows.add_missing_classes()?;
        rows.finish(None)
    });
    let views = c.objects("views")?.into_iter().map(|view| {
        let view = view.as_item()?;
        let (camera, aim) = view.ray()?;
        let mut rows = Rows::regular(view);
        match mirror.look(camera, aim, 0.0) {
            None => {
                let none = single(0.0, 0.0);
                add_view(&mut rows, none, albedo, none, none)?;
            }
            Some(seen) => {
                let x = seen.floor;
                // The conditioning is per relative change of coordinates of this size.
                let relative = seen.error / (x.length() + mirror.light.length());
                let (direct, caustic) = (mirror.direct(x), mirror.caustic(x));
                add_view(
                    &mut rows,
                    single(mirror.reflectance, 0.0),
                    albedo,
                    direct.displaced(relative),
                    caustic.displaced(relative),
                )?;
            }
        }
        rows.finish(None)
    });
    points.chain(views).collect()
}
