//! Definitions of the samples at mirrors, by midpoint sums over the mirror: a spherical cap that a path can cross again, a
//! convex cylinder, and an arc in parallel light.

use core::f64::consts::{PI, TAU};

use nephroid::entry;
use nephroid::integrators::Kernel;
use nephroid::integrators::probes::{Distance, Estimator, Technique};
use nephroid_analytic::scene::{
    ConcaveSphereScene, CylinderCupScene, Entry, Floor, Kind, PillarScene,
};

use super::sums::{
    Moments, V, along, angle, compare, cone, dot, epanechnikov, length, mirrored, sub,
};

/// A point of a mirror: position, unit normal of its front, area.
type Element = (V, V, f64);

/// A mirror in the plainest terms.
struct Mirror {
    /// Its elements, for a fineness.
    elements: Box<dyn Fn(usize) -> Vec<Element>>,
    /// Parameter at which the ray from a point of the mirror to its front meets it again, infinite if it does not.
    again: Box<dyn Fn(V, V) -> f64>,
    /// Position and intensity, or direction towards the light and irradiance.
    light: Result<(V, f64), (V, f64)>,
    reflectance: f64,
    floor: Floor,
    /// Diagonal of the box of floor, mirror and light.
    diagonal: f64,
}

impl Mirror {
    /// Mean and second moment of a technique for a kernel φ(g, α) at a floor point.
    fn moments(
        &self,
        n: usize,
        x: V,
        technique: Technique,
        distance: Option<Distance>,
        bandwidth: f64,
        phi: fn(f64, f64) -> f64,
        // Of the light that photons are drawn from.
        flux: f64,
    ) -> Moments {
        let mut sums = [0.0; 2];
        for (s, normal, area) in (self.elements)(n) {
            let to_x = sub(x, s);
            let (to_y, r2, normal_irradiance) = match self.light {
                Ok((y, intensity)) => {
                    let d = sub(y, s);
                    (d, length(d), intensity / dot(d, d))
                }
                Err((towards, irradiance)) => (towards, f64::INFINITY, irradiance),
            };
            let r1 = length(to_x);
            let (c1, c2) = (dot(to_x, normal) / r1, dot(to_y, normal) / length(to_y));
            if !(c1 > 0.0 && c2 > 0.0) {
                continue;
            }
            let far = if r2 < f64::INFINITY {
                1.0
            } else {
                f64::INFINITY
            };
            if (self.again)(s, to_x) < 1.0 || (self.again)(s, to_y) < far {
                continue;
            }
            // The same angle on either side.
            let exact = match technique {
                Technique::Light => mirrored(along([0.0; 3], to_y, -1.0), normal),
                _ => mirrored(along([0.0; 3], to_x, -1.0), normal),
            };
            let g = match technique {
                Technique::Light => angle(exact, to_x),
                _ => angle(exact, to_y),
            };
            let alpha = match distance {
                None => bandwidth,
                Some(Distance::Receiver) => libm::atan(bandwidth / r1),
                Some(Distance::Light) => libm::atan(bandwidth / r2),
                Some(Distance::Exact) => libm::atan(bandwidth / self.exact(s, exact)),
            };
            let phi = phi(g, alpha);
            let cos_x = -to_x[2] / r1;
            let irradiance = self.reflectance * phi * normal_irradiance;
            // Sample, and density of the path per area of the mirror.
            let (sample, density) = match technique {
                Technique::Camera => (PI * irradiance, cos_x * c1 / (PI * r1 * r1)),
                Technique::Symmetric => (
                    PI * irradiance * (c2 / c1).sqrt(),
                    cos_x * c1 / (PI * r1 * r1),
                ),
                Technique::Light => (
                    flux * self.reflectance * phi * cos_x / (r1 * r1),
                    normal_irradiance * c2 / flux,
                ),
                Technique::Merge => panic!("not a technique of this test"),
            };
            sums[0] += sample * density * area;
            sums[1] += sample * sample * density * area;
        }
        sums
    }

    /// Distance along the exact ray to what it meets first.
    fn exact(&self, s: V, d: V) -> f64 {
        let t = -s[2] / d[2];
        let p = along(s, d, t);
        let inside = |k: usize| (p[k] - self.floor.center[k]).abs() <= self.floor.half_width[k];
        let floor = if t > 0.0 && inside(0) && inside(1) {
            t
        } else {
            f64::INFINITY
        };
        let t = floor.min((self.again)(s, d));
        if t < f64::INFINITY {
            t * length(d)
        } else {
            self.diagonal
        }
    }

    fn check(
        &self,
        entry: &Entry,
        fineness: [usize; 2],
        paths: u64,
        point: [f64; 2],
        cases: &[(Technique, Option<Distance>, f64)],
        catches: f64,
    ) {
        for &(technique, distance, bandwidth) in cases {
            // Where the angle depends on the vertex the edge of a cone costs the sums too much of their accuracy.
            let kernels = [
                (Kernel::Epanechnikov, epanechnikov as fn(f64, f64) -> f64),
                (Kernel::Cone, cone),
            ];
            let count = if distance.is_none() { 2 } else { 1 };
            for (kernel, phi) in kernels.into_iter().take(count) {
                let estimator = Estimator::new(entry, technique, kernel, distance).unwrap();
                let flux = estimator.flux(bandwidth, point).unwrap();
                let flux = flux.map_or(f64::NAN, |f| f[0]);
                let x = [point[0], point[1], 0.0];
                let sums =
                    fineness.map(|n| self.moments(n, x, technique, distance, bandwidth, phi, flux));
                let name = technique.name();
                let what = format!("{} {name} {distance:?} {kernel}", entry.name);
                let caught = compare(&what, &estimator, paths, bandwidth, point, sums);
                assert!(caught < catches, "{what}: {caught}");
            }
        }
    }
}

fn diagonal(points: &[V]) -> f64 {
    let extent = |k: usize| {
        let of = points.iter().map(|p| p[k]);
        of.clone().fold(f64::MIN, f64::max) - of.fold(f64::MAX, f64::min)
    };
    length([extent(0), extent(1), extent(2)])
}

fn corners(floor: &Floor) -> [V; 2] {
    let at = |sign: f64, k: usize| floor.center[k] + sign * floor.half_width[k];
    [-1.0, 1.0].map(|s| [at(s, 0), at(s, 1), 0.0])
}

const UNLINKED: [(Technique, Option<Distance>, f64); 3] = [
    (Technique::Camera, None, 0.3),
    (Technique::Symmetric, None, 0.3),
    (Technique::Light, None, 0.3),
];

/// The three conventions on both sides, at a radius that gives about the same angle.
fn linked(radius: f64) -> Vec<(Technique, Option<Distance>, f64)> {
    let of =
        |t| [Distance::Exact, Distance::Receiver, Distance::Light].map(|d| (t, Some(d), radius));
    [of(Technique::Camera), of(Technique::Light)].concat()
}

fn dome() -> (Entry, Mirror) {
    let entry = entry::load("dome").unwrap();
    let Kind::ConcaveSphere(ConcaveSphereScene { light, floor, cap }) = entry.kind.clone() else {
        panic!("dome is a concave sphere");
    };
    let (c, a) = (cap.center, cap.radius);
    let half = cap.half_angle_degrees.to_radians();
    let rim = c[2] + a * libm::cos(half);
    let wide = a * libm::sin(half);
    let mut points = corners(&floor).to_vec();
    points.extend([
        light.position,
        [c[0] - wide, c[1] - wide, rim],
        [c[0] + wide, c[1] + wide, c[2] + a],
    ]);
    let elements = move |n: usize| {
        let (rows, columns) = (n, 4 * n);
        let area = a * a * (1.0 - libm::cos(half)) * TAU / (rows * columns) as f64;
        let at = |k: usize| {
            let z = 1.0 - (1.0 - libm::cos(half)) * ((k / columns) as f64 + 0.5) / rows as f64;
            let phi = TAU * ((k % columns) as f64 + 0.5) / columns as f64;
            let r = (1.0 - z * z).sqrt();
            let out = [r * libm::cos(phi), r * libm::sin(phi), z];
            (along(c, out, a), along([0.0; 3], out, -1.0), area)
        };
        (0..rows * columns).map(at).collect()
    };
    let again = move |s: V, d: V| {
        // |s + t d - c| = a.
        let t = -2.0 * dot(sub(s, c), d) / dot(d, d);
        if t > 0.0 && s[2] + t * d[2] >= rim {
            t
        } else {
            f64::INFINITY
        }
    };
    let mirror = Mirror {
        elements: Box::new(elements),
        again: Box::new(again),
        light: Ok((light.position, light.intensity)),
        reflectance: cap.reflectance,
        floor,
        diagonal: diagonal(&points),
    };
    (entry, mirror)
}

/// Every assertion would catch a bias of 3 % in the mean and in the second moment.
#[test]
fn samples_at_a_cap_have_the_moments_of_their_definition() {
    let (entry, mirror) = dome();
    let point = [-0.9, -0.44];
    mirror.check(&entry, [200, 320], 10_000, point, &UNLINKED, 0.03);
    mirror.check(&entry, [200, 320], 10_000, point, &linked(0.3), 0.03);
}

#[test]
fn samples_at_a_pillar_have_the_moments_of_their_definition() {
    let entry = entry::load("pillar").unwrap();
    let Kind::Pillar(PillarScene {
        light,
        floor,
        pillar,
    }) = entry.kind.clone()
    else {
        panic!("pillar is a pillar");
    };
    let ([cx, cy], a, h) = (pillar.center, pillar.radius, pillar.height);
    let mut points = corners(&floor).to_vec();
    points.extend([light.position, [cx - a, cy - a, 0.0], [cx + a, cy + a, h]]);
    let elements = move |n: usize| {
        let (rows, columns) = (n, 4 * n);
        let area = TAU * a * h / (rows * columns) as f64;
        let at = |k: usize| {
            let z = h * ((k / columns) as f64 + 0.5) / rows as f64;
            let phi = TAU * ((k % columns) as f64 + 0.5) / columns as f64;
            let out = [libm::cos(phi), libm::sin(phi), 0.0];
            (along([cx, cy, z], out, a), out, area)
        };
        (0..rows * columns).map(at).collect()
    };
    let mirror = Mirror {
        elements: Box::new(elements),
        again: Box::new(|_, _| f64::INFINITY),
        light: Ok((light.position, light.intensity)),
        reflectance: pillar.reflectance,
        floor,
        diagonal: diagonal(&points),
    };
    let point = [-0.99, -1.2];
    mirror.check(&entry, [150, 240], 10_000, point, &UNLINKED, 0.03);
    mirror.check(&entry, [150, 240], 10_000, point, &linked(0.6)[..3], 0.03);
}

#[test]
fn samples_at_an_arc_in_the_sun_have_the_moments_of_their_definition() {
    let entry = entry::load("cup").unwrap();
    let Kind::CylinderCup(CylinderCupScene { light, floor, wall }) = entry.kind.clone() else {
        panic!("cup is a cylinder cup");
    };
    let elevation = light.elevation_degrees.to_radians();
    let towards = [-libm::cos(elevation), 0.0, libm::sin(elevation)];
    let (a, h, half) = (wall.radius, wall.height, wall.half_arc_degrees.to_radians());
    let elements = move |n: usize| {
        let (rows, columns) = (n, 4 * n);
        let area = 2.0 * half * a * h / (rows * columns) as f64;
        let at = |k: usize| {
            let z = h * ((k / columns) as f64 + 0.5) / rows as f64;
            let phi = half * (2.0 * ((k % columns) as f64 + 0.5) / columns as f64 - 1.0);
            let out = [libm::cos(phi), libm::sin(phi), 0.0];
            (
                along([0.0, 0.0, z], out, a),
                along([0.0; 3], out, -1.0),
                area,
            )
        };
        (0..rows * columns).map(at).collect()
    };
    let again = move |s: V, d: V| {
        let plan = [d[0], d[1], 0.0];
        let t = -2.0 * dot(s, plan) / dot(plan, plan);
        let p = along(s, d, t);
        let stands = p[2] >= 0.0 && p[2] <= h && libm::atan2(p[1], p[0]).abs() <= half;
        if t > 0.0 && stands { t } else { f64::INFINITY }
    };
    let mut points = corners(&floor).to_vec();
    let wide = a * libm::sin(half);
    points.extend([[a * libm::cos(half), -wide, 0.0], [a, wide, h]]);
    let mirror = Mirror {
        elements: Box::new(elements),
        again: Box::new(again),
        light: Err((towards, light.irradiance)),
        reflectance: wall.reflectance,
        floor,
        diagonal: diagonal(&points),
    };
    let point = [0.29, 0.044];
    mirror.check(&entry, [150, 240], 10_000, point, &UNLINKED, 0.03);
    let linked: Vec<_> = linked(0.3)
        .into_iter()
        .filter(|(_, d, _)| *d != Some(Distance::Light))
        .collect();
    mirror.check(&entry, [150, 240], 10_000, point, &linked, 0.03);
}
