//! A closed diffuse sphere with a point light and the camera inside: everything sees everything.

use glam::DVec3;
use nephroid_analytic::scene::SphereWall;

use super::light::Point;
use super::pinhole::Pinhole;
use super::turn::sin_cos_of_turns;

/// The scene, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Furnace {
    /// The light.
    pub light: Point,
    /// The camera.
    pub camera: Pinhole,
    /// Albedo of the wall.
    pub albedo: f64,
    center: DVec3,
    radius: f64,
}

impl Furnace {
    /// Prepares a validated wall.
    pub fn new(light: Point, camera: Pinhole, wall: &SphereWall) -> Self {
        Furnace {
            light,
            camera,
            albedo: wall.albedo,
            center: DVec3::from_array(wall.center),
            radius: wall.radius,
        }
    }

    /// Where a ray from inside, or from the wall inwards, meets the wall.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> DVec3 {
        let p = origin - self.center;
        let (dd, pd) = (direction.dot(direction), p.dot(direction));
        let c = p.dot(p) - self.radius * self.radius;
        let t = (f64::sqrt(pd * pd - dd * c) - pd) / dd;
        // Back on the sphere, so that errors do not add up over many bounces.
        let q = p + direction * t;
        self.center + q * (self.radius / f64::sqrt(q.dot(q)))
    }

    /// The unit normal into the sphere.
    pub fn normal(&self, point: DVec3) -> DVec3 {
        (self.center - point) / self.radius
    }

    /// A direction about the normal with the density cos θ/π.
    pub fn scattered(normal: DVec3, u: f64, v: f64) -> DVec3 {
        // Two directions across: from the axis that is least along the normal.
        let axis = if normal.x * normal.x < 0.5 {
            DVec3::X
        } else {
            DVec3::Y
        };
        let first = axis - normal * normal.dot(axis);
        let first = first / f64::sqrt(first.dot(first));
        let second = normal.cross(first);
        let (s, c) = sin_cos_of_turns(u);
        let r = f64::sqrt(v);
        first * (r * c) + second * (r * s) + normal * f64::sqrt(1.0 - v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and second moments of cos θ/π over a hemisphere: 2/3 along the normal, then 1/2 along it and 1/4 across. The
    /// midpoint rule in both numbers is exact to 1/n.
    #[test]
    fn scattered_directions_have_the_moments_of_the_cosine_law() {
        for normal in [
            DVec3::new(0.6, 0.0, -0.8),
            DVec3::new(-0.96, 0.2, 0.195_959_179_422_654_25),
            DVec3::NEG_Z,
        ] {
            let n = 400;
            let (mut mean, mut along, mut x) = (DVec3::ZERO, 0.0, 0.0);
            let across = normal.cross(DVec3::new(0.3, 0.9, 0.2));
            let across = across / f64::sqrt(across.dot(across));
            for k in 0..n * n {
                let at = |m: usize| (m as f64 + 0.5) / n as f64;
                let d = Furnace::scattered(normal, at(k % n), at(k / n));
                assert!((d.dot(d) - 1.0).abs() < 1e-14);
                let weight = 1.0 / (n * n) as f64;
                mean += d * weight;
                along += d.dot(normal) * d.dot(normal) * weight;
                x += d.dot(across) * d.dot(across) * weight;
            }
            let off = mean - normal * (2.0 / 3.0);
            assert!(off.dot(off) < 1e-8, "{mean}");
            assert!((along - 0.5).abs() < 1e-4 && (x - 0.25).abs() < 1e-4);
        }
    }
}
