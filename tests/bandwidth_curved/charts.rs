//! Spheres, cylinders, water and waves on another chart, at points and bandwidths that no table has: the midpoint rule over the whole
//! surface in parameters of its own, with the samples' definitions of `theory/bandwidth.md` written out. For the kernel that never
//! ends (von Mises–Fisher) and a point whose spot nothing cuts the rule converges faster than any power, which halving its step
//! shows. A cap's rim does cut; there the parameter slows down doubly exponentially, and the rule loses nothing.

use std::f64::consts::PI;

use nephroid_analytic::bandwidth::flatland::FlatlandMirror;
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::pixel::rule::Rule;
use nephroid_analytic::scene::{Entry, Kind};

use super::{at, expectation, load, relative};

type V = [f64; 3];

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn scaled(a: V, s: f64) -> V {
    a.map(|c| c * s)
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

/// The exact continuation of a unit direction at a surface with unit normal `n` against it, and its Fresnel factor: reflected where
/// there is no index, else into a medium of that index relative to this one.
fn continued(d: V, n: V, index: Option<f64>) -> Option<(V, f64)> {
    let c = -dot(d, n);
    let Some(m) = index else {
        return Some(([0, 1, 2].map(|k| d[k] + 2.0 * c * n[k]), 1.0));
    };
    let square = m * m - 1.0 + c * c;
    if !(square > 0.0 && c > 0.0) {
        return None;
    }
    let q = square.sqrt();
    let out = [0, 1, 2].map(|k| (d[k] + (c - q) * n[k]) / m);
    // Amplitudes of both polarisations.
    let (s, p) = ((c - q) / (c + q), (m * m * c - q) / (m * m * c + q));
    Some((out, 1.0 - 0.5 * (s * s + p * p)))
}

/// A surface and its light in the plainest terms.
struct Optics {
    /// Point, unit normal on the light's side, area per parameter area.
    surface: Surface,
    /// Ranges of the parameters.
    range: [[f64; 2]; 2],
    /// Position and intensity, or direction towards the light and irradiance.
    light: Result<(V, f64), (V, f64)>,
    reflectance: f64,
    /// Of the receiver's medium relative to the light's.
    index: Option<f64>,
}

impl Optics {
    /// Means and second moments of `camera`, `light`, `symmetric`, and the mean of `symmetric` from the light's side.
    fn moments(&self, x: [f64; 2], alpha: f64, steps: usize) -> [f64; 7] {
        let k = 4.0 / (alpha * alpha);
        let top = k / (2.0 * PI * (1.0 - libm::exp(-2.0 * k)));
        // Of the angle between unit vectors.
        let phi = |a: V, b: V| {
            let d = sub(a, b);
            top * libm::exp(-0.5 * k * dot(d, d))
        };
        let cell = self.range.map(|[low, high]| (high - low) / steps as f64);
        let mut sums = [0.0; 7];
        for i in 0..steps * steps {
            let u = [0, 1].map(|k| {
                let at = [i % steps, i / steps][k] as f64 + 0.5;
                self.range[k][0] + cell[k] * at
            });
            let (s, n, area) = (self.surface)(u);
            let to_x = sub([x[0], x[1], 0.0], s);
            let r1 = length(to_x);
            let to_x = scaled(to_x, 1.0 / r1);
            let (to_y, strength, photons) = match self.light {
                Ok((y, intensity)) => {
                    let d = sub(y, s);
                    let r2 = length(d);
                    (
                        scaled(d, 1.0 / r2),
                        intensity / (r2 * r2),
                        4.0 * PI * intensity,
                    )
                }
                Err((d, irradiance)) => (d, irradiance, irradiance),
            };
            let side = if self.index.is_some() { -1.0 } else { 1.0 };
            let (c1, c2, cx) = (side * dot(to_x, n), dot(to_y, n), -to_x[2]);
            if !(c1 > 0.0 && c2 > 0.0 && cx > 0.0) {
                continue;
            }
            let weight = strength * cx * area * cell[0] * cell[1] / (r1 * r1);
            let inverse = self.index.map(|m| 1.0 / m);
            let back = continued(scaled(to_x, -1.0), scaled(n, side), inverse);
            let forth = continued(scaled(to_y, -1.0), n, self.index);
            let gain = self.index.map_or(1.0, |m| m * m);
            if let Some((out, t)) = back {
                let f = t * self.reflectance * phi(out, to_y);
                let w = gain * weight * f;
                sums[0] += w * c1;
                sums[1] += w * c1 * PI * gain * strength * f;
                let even = (c1 * c2).sqrt();
                sums[4] += w * even;
                sums[5] += w * even * PI * gain * strength * f * (c2 / c1).sqrt();
            }
            if let Some((out, t)) = forth {
                let f = t * self.reflectance * phi(out, to_x);
                let w = weight * f;
                sums[2] += w * c2;
                sums[3] += w * c2 * photons * f * cx / (r1 * r1);
                // A photon's sample times √(c₁/c₂).
                sums[6] += w * c2 * (c1 / c2).sqrt();
            }
        }
        sums
    }
}

/// A place from a parameter that is no multiple of it.
fn bent(p: f64) -> (f64, f64) {
    (p + 0.1 * p * p * p, 1.0 + 0.3 * p * p)
}

/// From 0 to 1 and how fast, doubly exponentially slow at both ends: what is cut there costs no accuracy.
fn settled(t: f64) -> (f64, f64) {
    let e = libm::exp(-PI * libm::sinh(t));
    (
        1.0 / (1.0 + e),
        PI * libm::cosh(t) * e / ((1.0 + e) * (1.0 + e)),
    )
}

/// Where both ends of it are.
const SETTLED: [f64; 2] = [-3.4, 3.4];

type Surface = Box<dyn Fn([f64; 2]) -> (V, V, f64)>;

/// The part of a sphere within the angle `end` of +z, by colatitude and azimuth.
fn sphere(centre: V, radius: f64, side: f64, end: f64) -> Surface {
    Box::new(move |[t, azimuth]| {
        let (part, slope) = settled(t);
        let (polar, slope) = (end * part, end * slope);
        let sine = libm::sin(polar);
        let out = [
            sine * libm::cos(azimuth),
            sine * libm::sin(azimuth),
            libm::cos(polar),
        ];
        let s = [0, 1, 2].map(|k| centre[k] + radius * out[k]);
        (s, scaled(out, side), radius * radius * sine * slope)
    })
}

fn optics(entry: &Entry) -> Optics {
    // The outside is seen from −x, the inside from the axis.
    let azimuth = |centre: [f64; 2], radius: f64, side: f64, height: f64| {
        // By the tangent of half the angle from −x or x. The light on the outside ends far above the spot, that on the inside
        // is cut by the upper edge.
        let up = if side > 0.0 { bent } else { settled };
        move |[t, h]: [f64; 2]| {
            let k = 1.0 / (1.0 + t * t);
            let n = [-side * (1.0 - t * t) * k, -side * 2.0 * t * k, 0.0];
            let (z, slope) = up(h);
            let s = [
                centre[0] + radius * n[0],
                centre[1] + radius * n[1],
                height * z,
            ];
            (s, scaled(n, side), radius * 2.0 * k * height * slope)
        }
    };
    match entry.kind.clone() {
        Kind::Pillar(s) => Optics {
            surface: Box::new(azimuth(
                s.pillar.center,
                s.pillar.radius,
                1.0,
                s.pillar.height,
            )),
            range: [[-1.2, 1.2], [0.0, 0.9]],
            light: Ok((s.light.position, s.light.intensity)),
            reflectance: s.pillar.reflectance,
            index: None,
        },
        Kind::CylinderCup(s) => {
            let end = libm::tan(0.5 * s.wall.half_arc_degrees.to_radians());
            let elevation = s.light.elevation_degrees.to_radians();
            let towards = [-libm::cos(elevation), 0.0, libm::sin(elevation)];
            Optics {
                surface: Box::new(azimuth([0.0; 2], s.wall.radius, -1.0, s.wall.height)),
                range: [[-end, end], SETTLED],
                light: Err((towards, s.light.irradiance)),
                reflectance: s.wall.reflectance,
                index: None,
            }
        }
        Kind::ConcaveSphere(s) => Optics {
            surface: sphere(
                s.cap.center,
                s.cap.radius,
                -1.0,
                s.cap.half_angle_degrees.to_radians(),
            ),
            range: [SETTLED, [0.0, 2.0 * PI]],
            light: Ok((s.light.position, s.light.intensity)),
            reflectance: s.cap.reflectance,
            index: None,
        },
        Kind::ConvexSphere(s) => Optics {
            surface: sphere(s.ball.center, s.ball.radius, 1.0, PI),
            range: [SETTLED, [0.0, 2.0 * PI]],
            light: Ok((s.light.position, s.light.intensity)),
            reflectance: s.ball.reflectance,
            index: None,
        },
        Kind::FlatInterface(s) => {
            let z = s.water.surface_z;
            let plane = move |[p, q]: [f64; 2]| {
                let ((x, dx), (y, dy)) = (bent(p), bent(q));
                ([x, y, z], [0.0, 0.0, 1.0], dx * dy)
            };
            Optics {
                surface: Box::new(plane),
                range: [[-1.5, 1.5]; 2],
                light: Ok((s.light.position, s.light.intensity)),
                reflectance: 1.0,
                index: Some(s.water.index),
            }
        }
        Kind::WaterWaves(s) => {
            let (mean, waves) = (s.water.surface_z, s.waves.clone());
            let water = move |[p, q]: [f64; 2]| {
                let ((x, dx), (y, dy)) = (bent(p), bent(q));
                let (mut z, mut g) = (mean, [0.0; 2]);
                for w in &waves {
                    let phase = w.wave_vector[0] * x + w.wave_vector[1] * y + w.phase;
                    z += w.amplitude * libm::cos(phase);
                    g = [0, 1].map(|k| g[k] - w.amplitude * w.wave_vector[k] * libm::sin(phase));
                }
                let steep = (1.0 + g[0] * g[0] + g[1] * g[1]).sqrt();
                (
                    [x, y, z],
                    [-g[0] / steep, -g[1] / steep, 1.0 / steep],
                    steep * dx * dy,
                )
            };
            Optics {
                surface: Box::new(water),
                range: [[-0.5, 1.6], [-0.2, 1.9]],
                light: Err(([0.0, 0.0, 1.0], s.light.irradiance)),
                reflectance: 1.0,
                index: Some(s.water.index),
            }
        }
        _ => panic!("another kind"),
    }
}

#[test]
fn spheres_cylinders_and_water_on_another_chart() {
    let mut wrong = Vec::new();
    for (name, x, alpha, steps) in [
        ("dome", [-0.73, -0.34], 1.0, 120),
        ("dome", [-0.73, -0.34], 0.17, 160),
        ("ball", [1.1, 0.9], 0.12, 1200),
        ("pillar", [-0.6, -0.35], 0.045, 1000),
        ("cup", [0.96, 0.136], 0.03, 900),
        ("pool", [0.104, 0.045], 0.03, 700),
        ("ripple-pool", [0.68, 0.96], 0.03, 450),
    ] {
        let entry = load(name);
        let optics = optics(&entry);
        let [coarse, fine] = [steps / 2, steps].map(|n| optics.moments(x, alpha, n));
        let found: Vec<f64> = [Technique::Camera, Technique::Light, Technique::Symmetric]
            .into_iter()
            .flat_map(|t| {
                let e = expectation(&entry, t, Kernel::VonMisesFisher, &[alpha]);
                let m = at(&e, x, 1e-12);
                [m.mean.value, m.second_moment.value]
            })
            .collect();
        // At an interface `symmetric` is the integrand of the camera.
        let is_mirror = optics.index.is_none();
        for (k, &found) in found.iter().enumerate() {
            let own = if is_mirror || k < 4 { k } else { k - 4 };
            let (expected, before) = (fine[own], coarse[own]);
            let (off, half) = (relative(found, expected), relative(before, expected));
            println!("{name} {alpha} {k}: {off:.1e}, half the nodes {half:.1e}");
            // The rule has converged: half the nodes give less than a third of the digits.
            if off >= 1e-10 || half >= 1e-3 {
                wrong.push(format!("{name} {alpha} {k}: {found} {expected} {before}"));
            }
        }
        // The symmetric form is its own adjoint: the same from the light's side, with the light's kernel.
        let adjoint = relative(found[4], fine[6]);
        if is_mirror && adjoint >= 1e-10 {
            wrong.push(format!("{name}: {} {}", found[4], fine[6]));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Flatland at distances and bandwidths that no table has, on the mirror instead of at the receiver's angle: θ + θ' = α ends at the
/// root of m² tan α + m (p + q) = p q tan α.
#[test]
fn flatland_on_the_mirror() {
    let (p, q, strength) = (1.37, 0.41, 2.3);
    let mirror = FlatlandMirror {
        receiver: p,
        light: q,
        strength,
    };
    for b in [1.1, 0.23, 0.017, 4e-5] {
        let t = libm::tan(b);
        let end = 2.0 * p * q * t / (p + q + libm::hypot(p + q, 2.0 * t * (p * q).sqrt()));
        let mut sums = [[0.0; 2]; 3];
        let mut merged = 0.0;
        for (u, weight) in Rule::gauss(60).iter() {
            let m = end * u;
            let (r1, r2) = (libm::hypot(p, m), libm::hypot(q, m));
            let (c1, c2) = (p / r1, q / r2);
            // Both halves of the mirror; dθ = c₁ dm/r₁.
            let element = 2.0 * end * weight * c1 / r1;
            let phi = 0.5 / b;
            for (sum, (cosine, sample)) in sums.iter_mut().zip([
                (c1, 2.0 / r2),
                (c2, 2.0 * PI * c1 / r1),
                ((c1 * c2).sqrt(), 2.0 * (c2 / c1).sqrt() / r2),
            ]) {
                let mean = strength * phi * cosine / r2 * element;
                *sum = [sum[0] + mean, sum[1] + mean * strength * phi * sample];
            }
            // From the light's image.
            let d = p + q;
            merged += weight * strength * d / (d * d + b * b * u * u);
        }
        let merged = [merged, merged * PI * strength / b];
        for (technique, expected) in [
            (Technique::Camera, sums[0]),
            (Technique::Light, sums[1]),
            (Technique::Symmetric, sums[2]),
            (Technique::Merge, merged),
        ] {
            let found = mirror.expectation(technique, b).expect("defined");
            let found = [found.mean.value, found.second_moment.value];
            for k in 0..2 {
                let off = relative(found[k], expected[k]);
                assert!(off < 1e-12, "{technique} {b} {k}: {found:?} {expected:?}");
            }
        }
    }
}
