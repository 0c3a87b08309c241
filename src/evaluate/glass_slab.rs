//! Reference configurations with a parallel glass slab: D1.
//!
//! `slab_z` is [lower, upper] surface, `Z` the receiver's height, 0 without it. `E_caustic` holds the orders 0 to
//! `orders_listed` - 1, five without that key; `E_caustic_all_orders` the whole series, and `E_tail_orders_ge_5` (with the
//! number of listed orders) what is beyond. Views are seen through the slab without internal reflection, and hold order 0
//! of the light.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::glass_slab::GlassSlab;

use super::reading::{LARGEST, Object, SMALLEST};
use super::report::{Item, Rows};
use super::{add_view, radiance, single, sum};
use crate::error::Error;

/// Orders in `E_caustic` where the file does not say.
const ORDERS: u32 = 5;

/// The slab of the parameters.
///
/// # Errors
/// [`Error::Content`] for a parameter that is missing or out of range.
pub fn slab(p: &Object<'_>) -> Result<GlassSlab<f64>, Error> {
    let [bottom, top] = p.numbers("slab_z")?;
    let light = p.vector("light")?;
    let receiver_z = if p.has("Z") {
        p.number("Z", -LARGEST, LARGEST)?
    } else {
        0.0
    };
    let room = SMALLEST * (1.0 + f64::abs(top) + f64::abs(bottom));
    if !(top - bottom >= room) {
        let allowed = "[lower, upper] with lower < upper";
        return Err(p.error("slab_z", &format!("{:?}", [bottom, top]), allowed));
    }
    if !(bottom >= receiver_z) {
        let allowed = "a lower surface that is not below the receiver";
        return Err(p.error("slab_z[0]", &bottom.to_string(), allowed));
    }
    if !(light.z - top >= room) {
        let allowed = "a height above the slab";
        return Err(p.error("light[2]", &light.z.to_string(), allowed));
    }
    Ok(GlassSlab {
        bottom,
        top,
        index: p.number("n", 0.1, 10.0)?,
        light,
        intensity: p.positive("I")?,
        receiver_z,
    })
}

/// Evaluates one configuration.
pub fn configuration(c: &Object<'_>) -> Result<Vec<Item>, Error> {
    let p = c.object("parameters")?;
    let (slab, albedo) = (slab(&p)?, p.fraction("albedo")?);
    let orders = if p.has("orders_listed") {
        p.whole("orders_listed", 1, 64)?
    } else {
        ORDERS
    };
    let points = c.required_objects("points")?.into_iter().map(|point| {
        let point = point.as_item()?;
        let x = point.receiver(slab.receiver_z)?;
        let listed: Vec<_> = (0..orders).map(|k| slab.caustic(x.x, x.y, k)).collect();
        let caustic = listed.iter().copied().fold(Estimate::NONE, sum);
        let tail = slab.all_orders_from(x.x, x.y, orders);
        // The slab covers the whole floor.
        let direct = Estimate::NONE;
        let mut rows = Rows::regular(point);
        rows.add("E_direct", direct)?;
        rows.add("E_caustic", caustic)?;
        rows.add("E_caustic_all_orders", sum(caustic, tail))?;
        rows.add(&format!("E_tail_orders_ge_{orders}"), tail)?;
        rows.add("L_caustic", radiance(albedo, caustic))?;
        rows.add("L_total", radiance(albedo, sum(direct, caustic)))?;
        for (k, order) in (1..).zip(listed) {
            rows.add_class(&format!("L{}DE", "SS".repeat(k)), order, &[order])?;
        }
        rows.add_missing_classes()?;
        rows.finish(None)
    });
    let views = c.objects("views")?.into_iter().map(|view| {
        let view = view.as_item()?;
        let (camera, aim) = view.ray()?;
        let none = Estimate::NONE;
        let mut rows = Rows::regular(view);
        match slab.look(camera, aim) {
            None => add_view(&mut rows, none, albedo, none, none)?,
            Some(seen) => {
                let x = seen.receiver;
                let relative = seen.error / (x.length() + slab.light.length());
                let caustic = slab.caustic(x.x, x.y, 0).displaced(relative);
                let weight = single(seen.weight, seen.conditioning);
                add_view(&mut rows, weight, albedo, none, caustic)?;
            }
        }
        rows.finish(None)
    });
    points.chain(views).collect()
}
