//! Conics of revolution with the light in one focus: all rays pass through, or come from, the other. Explicit. Theory
//! block I.

use crate::certificate::radiometry::{Bundle, Facing, Point, plan_squared, point_light_enclosed};
use crate::certificate::{Certified, Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// An ellipsoid or a hyperboloid, its receiver facing down.
#[derive(Clone, Copy, Debug)]
pub struct ConicMirror {
    shape: Shape,
    intensity: Enclosure,
    reflectance: Enclosure,
    /// How far the rim is below the image focus, where there is one: above it, this is negative.
    rim_below_image: Option<Enclosure>,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    /// Semi-major axis a, eccentricity e, receiver at a e + δ.
    Ellipsoid([Enclosure; 3]),
    /// Semi-axis A, eccentricity e, receiver height.
    Hyperboloid([Enclosure; 3]),
}

impl ConicMirror {
    /// `a`, `e`, `delta` or `A`, `e`, `zr`; and `I`, `R`; and, if the mirror ends at a rim, `rim_below_image`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let e = p.number("e")?;
        Some(ConicMirror {
            shape: if p.has("a") {
                Shape::Ellipsoid([p.number("a")?, e, p.number("delta")?])
            } else {
                Shape::Hyperboloid([p.number("A")?, e, p.number("zr")?])
            },
            intensity: p.number("I")?,
            reflectance: p.number("R")?,
            rim_below_image: p.number("rim_below_image"),
        })
    }

    /// Height of the receiver.
    pub fn receiver_z(&self) -> Enclosure {
        match self.shape {
            Shape::Ellipsoid([a, e, delta]) => a * e + delta,
            Shape::Hyperboloid([_, _, z]) => z,
        }
    }

    /// Light that the mirror sends to the receiver point (x, y): I R (r2/r1)² cos t/D², D and t being distance and polar
    /// angle of the point as seen from the other focus.
    pub fn caustic_enclosed(&self, x: Point) -> Bundle {
        let one = Enclosure::ONE;
        let plan = plan_squared(x.x, x.y);
        let (g, ratio, r2, mut lit);
        match self.shape {
            Shape::Ellipsoid([a, e, delta]) => {
                g = delta.abs();
                let distance = (plan + g.squared()).sqrt();
                r2 = a * (one - e) * (one + e) / (one - e * (g / distance));
                ratio = r2 / (Enclosure::TWO * a - r2);
                // Below the focus the receiver must be in front of the mirror.
                lit = match delta.sign() {
                    Some(1) => Lit::Yes,
                    Some(_) => Lit::where_positive(r2 - distance),
                    None => Lit::Undecided,
                };
            }
            Shape::Hyperboloid([a, e, z]) => {
                g = z + a * e;
                let distance = (plan + g.squared()).sqrt();
                r2 = a * (e - one) * (e + one) / (one + e * (g / distance));
                ratio = r2 / (r2 + Enclosure::TWO * a);
                lit = Lit::where_positive(g).and(Lit::where_positive(distance - r2));
            }
        }
        let squared = plan + g.squared();
        if let Some(rim) = self.rim_below_image {
            // How far the mirror point is above the image, or below it on a hyperboloid.
            let reach = r2 * g / squared.sqrt();
            lit = lit.and(match self.shape {
                Shape::Ellipsoid(_) => Lit::where_not_negative(reach + rim),
                Shape::Hyperboloid(_) => Lit::where_not_negative(reach - rim),
            });
        }
        let e =
            self.intensity * self.reflectance * ratio.squared() * g / (squared * squared.sqrt());
        Bundle::single(e, lit)
    }

    /// Light straight from the focus, where the receiver faces it.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let zero = Enclosure::ZERO;
        let light_z = match self.shape {
            Shape::Ellipsoid([a, e, _]) => -(a * e),
            Shape::Hyperboloid([a, e, _]) => a * e,
        };
        let (e, lit) = point_light_enclosed(
            vec3(zero, zero, light_z),
            self.intensity,
            vec3(x.x, x.y, self.receiver_z()),
            Facing::Down,
        );
        let mut sum = Certified::NONE;
        sum.add(e, lit);
        sum
    }
}
