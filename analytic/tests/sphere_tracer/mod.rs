//! A ray tracer for one spherical mirror that shares nothing with the closed form, and random mirrors.

use nephroid_analytic::kinds::sphere_mirror::{Light, Root, Side, SphereMirror};
use nephroid_analytic::vector::{Vec3, vec3};

/// SplitMix64: enough for choosing test cases.
pub struct Cases(pub u64);

impl Cases {
    pub fn next(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * (z >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn vector(&mut self, size: f64) -> Vec3<f64> {
        vec3(
            self.next(-size, size),
            self.next(-size, size),
            self.next(-size, size),
        )
    }

    pub fn direction(&mut self) -> Vec3<f64> {
        loop {
            let v = self.vector(1.0);
            if v.length() > 0.1 && v.length() < 1.0 {
                return v.normalized();
            }
        }
    }

    pub fn mirror(&mut self, side: Side, beam: bool) -> SphereMirror<f64> {
        let centre = self.vector(0.3);
        let radius = self.next(0.7, 1.4);
        let light = if beam {
            let direction = self.direction();
            Light::Beam {
                direction,
                irradiance: self.next(1.0, 3.0),
            }
        } else {
            let reach = match side {
                Side::Concave => self.next(0.05, 1.8),
                Side::Convex => self.next(1.05, 3.0),
            };
            Light::Point {
                position: centre + self.direction() * (reach * radius),
                intensity: self.next(1.0, 5.0),
            }
        };
        SphereMirror {
            centre,
            radius,
            side,
            cap_axis: self.direction(),
            cap_cos_min: self.next(-0.9, 0.7),
            reflectance: self.next(0.5, 1.0),
            light,
            receiver_z: centre.z - self.next(-0.6, 1.6) * radius,
        }
    }

    pub fn receiver_point(&mut self, m: &SphereMirror<f64>) -> Vec3<f64> {
        let (x, y) = (self.next(-1.5, 1.5), self.next(-1.5, 1.5));
        vec3(m.centre.x + x, m.centre.y + y, m.receiver_z)
    }
}

/// Where a ray first meets the cap, and the outward normal there.
fn first_hit(m: &SphereMirror<f64>, o: Vec3<f64>, d: Vec3<f64>) -> Option<(f64, Vec3<f64>)> {
    let oc = o - m.centre;
    let (b, c) = (oc.dot(d), oc.dot(oc) - m.radius * m.radius);
    let disc = b * b - c;
    if disc <= 0.0 {
        return None;
    }
    [-b - disc.sqrt(), -b + disc.sqrt()]
        .into_iter()
        .filter(|&t| t > 1e-9)
        .map(|t| (t, (oc + d * t) * (1.0 / m.radius)))
        .find(|(_, n)| n.dot(m.cap_axis) >= m.cap_cos_min)
}

/// A ray of the light after one reflection at the mirror's front: mirror point and receiver point.
pub fn trace(m: &SphereMirror<f64>, o: Vec3<f64>, d: Vec3<f64>) -> Option<(Vec3<f64>, Vec3<f64>)> {
    let (t, n) = first_hit(m, o, d)?;
    let front = match m.side {
        Side::Concave => d.dot(n) > 0.0,
        Side::Convex => d.dot(n) < 0.0,
    };
    let (s, v) = (o + d * t, d - n * (2.0 * d.dot(n)));
    if !front || v.z >= 0.0 || s.z <= m.receiver_z {
        return None;
    }
    let rest = (m.receiver_z - s.z) / v.z;
    if first_hit(m, s, v).is_some_and(|(again, _)| again < rest) {
        return None;
    }
    let x = s + v * rest;
    Some((s, vec3(x.x, x.y, m.receiver_z)))
}

pub fn frame(d: Vec3<f64>) -> (Vec3<f64>, Vec3<f64>) {
    let pole = if d.x.abs() < 0.6 {
        vec3(1.0, 0.0, 0.0)
    } else {
        vec3(0.0, 1.0, 0.0)
    };
    let e = pole.cross(d).normalized();
    (e, d.cross(e))
}

/// The ray with offsets (u, v) from the one that meets `s`: a flux of `density` per du dv.
pub fn ray(m: &SphereMirror<f64>, s: Vec3<f64>, u: f64, v: f64) -> (Vec3<f64>, Vec3<f64>, f64) {
    match m.light {
        Light::Point {
            position,
            intensity,
        } => {
            let d = (s - position).normalized();
            let (e, f) = frame(d);
            let k = 1.0 + u * u + v * v;
            let to = (d + e * u + f * v) * (1.0 / k.sqrt());
            (position, to, intensity / (k * k.sqrt()))
        }
        Light::Beam {
            direction,
            irradiance,
        } => {
            let (e, f) = frame(direction);
            let start = s - direction * 20.0 + e * u + f * v;
            (start, direction, irradiance)
        }
    }
}

/// The roots that light a receiver point.
pub fn lit_roots(m: &SphereMirror<f64>, x: Vec3<f64>) -> Vec<Root<f64>> {
    let mut roots = vec![];
    m.for_each_lit_root(x, |root| roots.push(root));
    roots
}
