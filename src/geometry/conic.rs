//! A conic of revolution above the floor: an ellipsoid above its rim, or the upper sheet of a hyperboloid below its rim.
//!
//! With the centre as origin both are r²/(1 - e²) + z² = a². Along a ray the left side is a quadratic of its parameter; the
//! reflecting side is where it is less than a²: inside the ellipsoid, between the sheets of the hyperboloid.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{ConicMirrorsScene, Family};

use super::chains::{Chains, Leg, Vertex};
use super::quadratic::zeros;
use super::scene::unit;
use super::specular::reflected;

/// The mirror, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Conic {
    center: DVec3,
    /// 1/(1 - e²), negative for a hyperboloid.
    across: f64,
    /// a.
    semi_axis: f64,
    /// Range of the mirror's height above the centre [m].
    range: [f64; 2],
    reflectance: f64,
    classes: &'static [PathClass],
}

impl Conic {
    /// Prepares a validated scene's mirror; `reflectance` replaces the scene's own.
    pub fn new(scene: &ConicMirrorsScene, reflectance: f64) -> Self {
        let conic = &scene.conic;
        let (a, e) = (conic.semi_axis, conic.eccentricity);
        // The foci are ae from the centre; the image is the lower one of an ellipsoid, the upper one of a hyperboloid.
        let ellipsoid = e < 1.0;
        let center_z = conic.image_z + if ellipsoid { a * e } else { -a * e };
        let rim = conic.rim_z - center_z;
        Conic {
            center: DVec3::new(conic.center[0], conic.center[1], center_z),
            across: 1.0 / (1.0 - e * e),
            semi_axis: a,
            range: if ellipsoid {
                [rim, f64::INFINITY]
            } else {
                // Everything above the middle belongs to the upper sheet.
                [0.0, rim]
            },
            reflectance,
            classes: scene.classes(),
        }
    }

    /// Coefficients of the left side less a² along a ray: of t², of 2t, and the value at its origin.
    fn quadratic(&self, o: DVec3, d: DVec3) -> [f64; 3] {
        let p = o - self.center;
        [
            (d.x * d.x + d.y * d.y) * self.across + d.z * d.z,
            (p.x * d.x + p.y * d.y) * self.across + p.z * d.z,
            (p.x * p.x + p.y * p.y) * self.across + (p.z - self.semi_axis) * (p.z + self.semi_axis),
        ]
    }

    fn is_mirror(&self, o: DVec3, d: DVec3, t: f64) -> bool {
        let z = o.z + d.z * t - self.center.z;
        z >= self.range[0] && z <= self.range[1]
    }

    /// The first meeting of a ray with the mirror, and whether it is on the reflecting side.
    fn meet(&self, o: DVec3, d: DVec3) -> Option<(f64, bool)> {
        let [a, b, c] = self.quadratic(o, d);
        zeros(a, b, c)
            .into_iter()
            .filter(|&t| t > 0.0 && self.is_mirror(o, d, t))
            .min_by(f64::total_cmp)
            .map(|t| (t, a * t + b > 0.0))
    }
}

impl Chains for Conic {
    const MEETS_ITSELF: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        match (chain, self.meet(origin, direction)) {
            (0, None) => Leg {
                origin,
                direction,
                weight: 1.0,
            },
            (1, Some((t, true))) => {
                let point = origin + direction * t;
                let p = point - self.center;
                let gradient = DVec3::new(p.x * self.across, p.y * self.across, p.z);
                let normal = gradient / f64::sqrt(gradient.dot(gradient));
                let direction = reflected(direction, normal);
                // The other zero, where the ray starts on the surface.
                let [a, b, _] = self.quadratic(point, direction);
                let again = -2.0 * b / a;
                let returns = again > 0.0 && self.is_mirror(point, direction, again);
                Leg {
                    origin: point,
                    direction,
                    weight: if returns { 0.0 } else { self.reflectance },
                }
            }
            _ => Leg::DARK,
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        self.meet(origin, direction).is_some_and(|(t, _)| t < t_end)
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let (t, true) = self.meet(origin, direction)? else {
            return None;
        };
        let point = origin + direction * t;
        let p = point - self.center;
        let normal = -unit(DVec3::new(p.x * self.across, p.y * self.across, p.z));
        Some(Vertex {
            point,
            direction: reflected(direction, normal),
            normal,
            weight: self.reflectance,
        })
    }

    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        // The zero that is not the vertex itself.
        let [a, b, _] = self.quadratic(vertex.point, direction);
        let t = -2.0 * b / a;
        if t > 0.0 && self.is_mirror(vertex.point, direction, t) {
            t
        } else {
            f64::INFINITY
        }
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let (a, [low, high]) = (self.semi_axis, self.range);
        // An ellipsoid ends at its top, the upper sheet of a hyperboloid begins at its bottom.
        let (low, high) = if self.across > 0.0 {
            (low, a)
        } else {
            (a, high)
        };
        // The ellipsoid is widest in its middle, the hyperboloid at its rim.
        let at = if self.across > 0.0 {
            low.max(0.0)
        } else {
            high
        };
        let wide = f64::sqrt((a * a - at * at) / self.across);
        Some([
            self.center + DVec3::new(-wide, -wide, low),
            self.center + DVec3::new(wide, wide, high),
        ])
    }

    /// The floor, or a box around the mirror.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            return floor.to_vec();
        }
        let mut points = Vec::with_capacity(8);
        // r² = (a² - z²)(1 - e²) is largest in the middle of an ellipsoid and at the rim of a hyperboloid.
        let (a, ellipsoid) = (self.semi_axis, self.across > 0.0);
        let (high, widest) = if ellipsoid {
            (a, 0.0)
        } else {
            (self.range[1], self.range[1])
        };
        let (low, r) = (
            self.range[0],
            f64::sqrt((a * a - widest * widest) / self.across),
        );
        for z in [low, high] {
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
                points.push(self.center + DVec3::new(x * r, y * r, z));
            }
        }
        points
    }
}
