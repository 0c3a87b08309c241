//! A spherical mirror, concave cap or convex ball: all mirror points that reflect the light to a receiver point, counted
//! over the full circle, the regime of four roots included. Theory blocks E and F.
//!
//! With light s and receiver b as complex numbers in the plane of both and the centre, in units of the radius, a mirror
//! point z = e^{iφ} reflects one to the other only where (s - z)(b - z)/z² is real:
//!
//! ```text
//! g(φ) = Im[s b z⁻²] - Im[(s + b) z⁻¹] = 0,      parallel light towards -s:   Im[s b z⁻²] - Im[s z⁻¹] = 0.
//! ```
//!
//! g is searched on a full turn. Of the zeros those count whose legs both are on the reflecting side; E = I R cos θ_x/|J_t
//! J_s|, and |J_s| = |s × b|/sin i besides its definition (|b × s| sums up the areas of the triangles of centre, mirror point
//! and either end): whichever enclosure is narrower holds. On the axis through light and centre any plane will do, so that
//! its second direction is all directions at once.

mod visibility;

use crate::certificate::radiometry::{Bundle, Point, plan_squared};
use crate::certificate::roots::{Jet, full_turn};
use crate::certificate::{Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// The mirror with its light and a receiver that faces up.
#[derive(Clone, Copy, Debug)]
pub struct SphereMirror {
    centre: Point,
    radius: Enclosure,
    concave: bool,
    cap_axis: Point,
    /// Cosine of the cap's half angle; `None` for a whole sphere.
    cap: Option<Enclosure>,
    reflectance: Enclosure,
    light: Light,
    receiver_z: Enclosure,
}

#[derive(Clone, Copy, Debug)]
enum Light {
    /// Position and intensity.
    Point(Point, Enclosure),
    /// Unit direction of propagation and irradiance.
    Beam(Point, Enclosure),
}

/// The plane of centre, light and receiver, in units of the radius.
struct Plane {
    e1: Point,
    e2: Point,
    s: (Enclosure, Enclosure),
    b: (Enclosure, Enclosure),
    far: bool,
}

fn unit(v: Point) -> Point {
    v * (Enclosure::ONE / length(v))
}

fn length(v: Point) -> Enclosure {
    (v.x.squared() + v.y.squared() + v.z.squared()).sqrt()
}

impl SphereMirror {
    /// `sphere_centre`, `a`, `R`, `z_receiver`, `cap_axis`, `cap_cos_min`, and `light`, `I` or `light_direction`, `E0`.
    pub fn read(p: &dyn Source, concave: bool) -> Option<Self> {
        let (zero, one) = (Enclosure::ZERO, Enclosure::ONE);
        let centre = p.point("sphere_centre")?;
        let radius = p.number("a")?;
        let light = if p.has("light_direction") {
            Light::Beam(unit(p.point("light_direction")?), p.number("E0")?)
        } else {
            Light::Point(p.point("light")?, p.number("I")?)
        };
        let cap_cos_min = p.number("cap_cos_min").unwrap_or(-one);
        Some(SphereMirror {
            centre,
            radius,
            concave,
            cap_axis: match p.point("cap_axis") {
                Some(axis) => unit(axis),
                None => vec3(zero, zero, one),
            },
            cap: (cap_cos_min.high() > -1.0).then_some(cap_cos_min),
            reflectance: p.number("R")?,
            light,
            receiver_z: p.number("z_receiver").unwrap_or(zero),
        })
    }

    /// Height of the receiver.
    pub fn receiver_z(&self) -> Enclosure {
        self.receiver_z
    }

    fn scaled(&self, x: Point) -> Point {
        (x - self.centre) * (Enclosure::ONE / self.radius)
    }

    /// The light, or the direction towards it if it is far, and the receiver.
    fn plane(&self, receiver: Point) -> Option<Plane> {
        let (source, far) = match self.light {
            Light::Point(position, _) => (self.scaled(position), false),
            Light::Beam(direction, _) => (-direction, true),
        };
        let (zero, one) = (Enclosure::ZERO, Enclosure::ONE);
        let reach = length(source);
        let central = reach == zero;
        let base = if central { receiver } else { source };
        if length(base).may_vanish() {
            return None;
        }
        let e1 = unit(base);
        let along = receiver.dot(e1);
        let across = length(e1.cross(receiver));
        let e2 = if across.may_vanish() || central {
            // Any direction perpendicular to e1.
            let any = |c: Enclosure| {
                let most = (one - c.squared()).sqrt().high();
                Enclosure::new(-most, most)
            };
            vec3(any(e1.x), any(e1.y), any(e1.z))
        } else {
            (receiver - e1 * along) * (one / across)
        };
        Some(Plane {
            e1,
            e2,
            s: (reach, zero),
            b: (along, if central { zero } else { across }),
            far,
        })
    }

    /// Light by one reflection at the receiver point (x, y).
    pub fn caustic_enclosed(&self, x: Point) -> Bundle {
        let mut bundle = Bundle::default();
        let receiver = self.scaled(vec3(x.x, x.y, self.receiver_z));
        let Some(plane) = self.plane(receiver) else {
            bundle.total.add_unresolved();
            return bundle;
        };
        let (s, b) = (plane.s, plane.b);
        let product = (s.0 * b.0, s.0 * b.1);
        let sum = if plane.far { s } else { (s.0 + b.0, b.1) };
        let jet = Jet::constant;
        let zeros = full_turn(|phi| {
            let twice = phi + phi;
            jet(product.1) * twice.cos()
                - jet(product.0) * twice.sin()
                - (jet(sum.1) * phi.cos() - jet(sum.0) * phi.sin())
        });
        let Some(zeros) = zeros else {
            bundle.total.add_unresolved();
            return bundle;
        };
        for phi in zeros.simple {
            let (irradiance, lit) = self.ray(&plane, receiver, phi);
            bundle.add(irradiance, lit);
        }
        for phi in zeros.undecided {
            // Any number of mirror points, if there is a mirror at all.
            if self.ray(&plane, receiver, phi).1 != Lit::No {
                bundle.total.add_unresolved();
            }
        }
        bundle
    }

    /// Irradiance by the mirror point at the angle φ of the plane, and whether it arrives.
    fn ray(&self, plane: &Plane, receiver: Point, phi: Enclosure) -> (Enclosure, Lit) {
        let (one, two) = (Enclosure::ONE, Enclosure::TWO);
        let sigma = if self.concave { one } else { -one };
        let (c, s) = (phi.cos(), phi.sin());
        let normal = plane.e1 * c + plane.e2 * s;
        let (source, b) = (plane.s, plane.b);
        // Components of a leg towards the reflecting side of the mirror.
        let toward = |v: (Enclosure, Enclosure)| -sigma * (v.0 * c + v.1 * s);
        let leg = |end: (Enclosure, Enclosure)| (end.0 - c, end.1 - s);
        let (r2, second) = {
            let v = leg(b);
            let r = plan_squared(v.0, v.1).sqrt();
            (r, toward(v) / r)
        };
        let (first, sum, double) = if plane.far {
            (toward(source) / source.0, one, two * r2)
        } else {
            let v = leg(source);
            let r1 = plan_squared(v.0, v.1).sqrt();
            (toward(v) / r1, r1 + r2, two * r1 * r2)
        };
        // Both are cos i at a mirror point that reflects.
        let cosine = first.intersection(second).unwrap_or(first.hull(second));
        let tangential = sum - sigma * double / cosine;
        let sine = {
            let v = leg(b);
            ((v.1 * c - v.0 * s) / r2).abs()
        };
        let plain = (sum - sigma * double * cosine).abs();
        let by_area = (source.0 * b.1 - source.1 * b.0).abs() / sine;
        let sagittal = plain.intersection(by_area).unwrap_or(plain);
        let height = normal.z - (self.receiver_z - self.centre.z) / self.radius;
        let strength = match self.light {
            Light::Point(_, intensity) => intensity / self.radius.squared(),
            Light::Beam(_, irradiance) => irradiance,
        };
        let e = strength * self.reflectance * height / (r2 * tangential.abs() * sagittal);
        let mut lit = Lit::where_positive(first)
            .and(Lit::where_positive(second))
            .and(Lit::where_positive(height));
        if lit != Lit::No {
            lit = lit.and(self.free(normal, receiver));
        }
        let positive = Enclosure::new(0.0, f64::INFINITY);
        (e.intersection(positive).unwrap_or(positive), lit)
    }
}
