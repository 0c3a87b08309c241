//! A paraboloid mirror with a light in its focus, or in a beam along its axis. Explicit. Theory block H.

use crate::certificate::radiometry::{Bundle, Facing, Point, plan_squared, point_light_enclosed};
use crate::certificate::{Certified, Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// The mirror z = r²/(4f) between two radii, over it a receiver that faces down.
#[derive(Clone, Copy, Debug)]
pub struct Paraboloid {
    focal_length: Enclosure,
    reflectance: Enclosure,
    light: Light,
    height: Enclosure,
    inner: Option<Enclosure>,
    outer: Enclosure,
}

#[derive(Clone, Copy, Debug)]
enum Light {
    Focus(Enclosure),
    Beam(Enclosure),
}

impl Paraboloid {
    /// With `light`: `f`, `I`, `R`, `zr`, `mirror_radius` and, if there is a hole, `r0`; without: `f`, `E0`, `R`, `c`, `r0`, `r1`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let (focal_length, reflectance) = (p.number("f")?, p.number("R")?);
        Some(if p.has("light") {
            Paraboloid {
                focal_length,
                reflectance,
                light: Light::Focus(p.number("I")?),
                height: p.number("zr")?,
                inner: p.number("r0").filter(|r| *r != Enclosure::ZERO),
                outer: p.number("mirror_radius")?,
            }
        } else {
            Paraboloid {
                focal_length,
                reflectance,
                light: Light::Beam(p.number("E0")?),
                height: p.number("c")?,
                inner: Some(p.number("r0")?).filter(|r| *r != Enclosure::ZERO),
                outer: p.number("r1")?,
            }
        })
    }

    /// Height of the receiver.
    pub fn receiver_z(&self) -> Enclosure {
        self.height
    }

    /// Light that the mirror sends to the receiver point (x, y).
    pub fn caustic_enclosed(&self, x: Point) -> Bundle {
        let (f, four) = (self.focal_length, Enclosure::point(4.0));
        let plan = plan_squared(x.x, x.y);
        let (e, radius) = match self.light {
            Light::Focus(intensity) => {
                let distance = f + plan / (four * f);
                (
                    intensity * self.reflectance / distance.squared(),
                    plan.sqrt(),
                )
            }
            Light::Beam(e0) => {
                // tan θ = r/g; the mirror point is at 2f tan(θ/2), tan(θ/2) = r/(D + g).
                let g = (self.height - f).abs();
                let distance = (plan + g.squared()).sqrt();
                let cosine = g / distance;
                let half = Enclosure::HALF * (Enclosure::ONE + cosine);
                let e = e0 * self.reflectance * f.squared() * cosine.squared() * cosine
                    / (half.squared() * g.squared());
                (e, Enclosure::TWO * f * plan.sqrt() / (distance + g))
            }
        };
        let mut lit = Lit::where_positive(self.height - radius.squared() / (four * f))
            .and(Lit::where_not_negative(self.outer - radius));
        if let Some(inner) = self.inner {
            lit = lit.and(Lit::where_not_negative(radius - inner));
        }
        Bundle::single(e, lit)
    }

    /// Light straight from the focus; the beam comes from behind.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let mut sum = Certified::NONE;
        if let Light::Focus(intensity) = self.light {
            let zero = Enclosure::ZERO;
            let light = vec3(zero, zero, self.focal_length);
            let x = vec3(x.x, x.y, self.height);
            let (e, lit) = point_light_enclosed(light, intensity, x, Facing::Down);
            sum.add(e, lit);
        }
        sum
    }
}
