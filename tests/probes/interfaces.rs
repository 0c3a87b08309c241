//! Definitions of the samples at an interface, by midpoint sums over the water: the kernel's medium, the transmittance's
//! angle, and the n² of the radiance, on both sides.

use core::f64::consts::PI;

use nephroid::entry;
use nephroid::integrators::Kernel;
use nephroid::integrators::probes::{Estimator, Technique};
use nephroid_analytic::scene::{Kind, UnderwaterScene};

use super::sums::{Moments, V, angle, compare, dot, epanechnikov, length, sub};

/// Refraction at a horizontal surface from a medium of index `n1` into one of index `n2`, and the transmittance; `None` at
/// total reflection.
fn refracted(d: V, n1: f64, n2: f64) -> Option<(V, f64)> {
    let r = length(d);
    let sine = (d[0] * d[0] + d[1] * d[1]).sqrt() / r;
    let (i, t) = (libm::asin(sine), n1 / n2 * sine);
    if t >= 1.0 {
        return None;
    }
    let t = libm::asin(t);
    // Fresnel by angles: r_s = -sin(i - t)/sin(i + t), r_p = tan(i - t)/tan(i + t).
    let reflectance = if i < 1e-6 {
        (n1 - n2) * (n1 - n2) / ((n1 + n2) * (n1 + n2))
    } else {
        let s = libm::sin(i - t) / libm::sin(i + t);
        let p = libm::tan(i - t) / libm::tan(i + t);
        0.5 * (s * s + p * p)
    };
    let scale = n1 / n2 / r;
    let z = libm::cos(t).copysign(d[2]);
    Some(([d[0] * scale, d[1] * scale, z], 1.0 - reflectance))
}

/// Would catch a bias of 3 %: n² is 77 %, the angle taken in the other medium 40 %.
#[test]
fn samples_at_water_have_the_moments_of_their_definition() {
    let entry = entry::load("underwater").unwrap();
    let Kind::Underwater(UnderwaterScene { light, water, .. }) = entry.kind.clone() else {
        panic!("underwater is underwater");
    };
    let (y, intensity) = (light.position, light.intensity);
    let (height, n) = (water.surface_z, water.index);
    let point = [0.9, -0.35];
    let x = [point[0], point[1], 0.0];
    let alpha = 0.25;
    let moments = |technique: Technique, grid: usize| -> Moments {
        // The surface is unbounded; the kernel is not.
        let half = 3.0;
        let area = (2.0 * half / grid as f64) * (2.0 * half / grid as f64);
        let mut sums = [0.0; 2];
        for k in 0..grid * grid {
            let at = |k: usize| half * (2.0 * (k as f64 + 0.5) / grid as f64 - 1.0);
            let s = [x[0] + at(k % grid), x[1] + at(k / grid), height];
            let (to_x, to_y) = (sub(x, s), sub(y, s));
            let (r1, r2) = (length(to_x), length(to_y));
            let (c1, c2) = (-to_x[2] / r1, to_y[2] / r2);
            let (sample, density) = if technique == Technique::Light {
                let Some((exact, t)) = refracted(sub(s, y), 1.0, n) else {
                    continue;
                };
                let phi = epanechnikov(angle(exact, to_x), alpha);
                let sample = 4.0 * PI * intensity * t * phi * c1 / (r1 * r1);
                (sample, c2 / (4.0 * PI * r2 * r2))
            } else {
                let Some((exact, t)) = refracted(sub(s, x), n, 1.0) else {
                    continue;
                };
                let phi = epanechnikov(angle(exact, to_y), alpha);
                let sample = PI * n * n * t * intensity * phi / dot(to_y, to_y);
                (sample, c1 * c1 / (PI * r1 * r1))
            };
            sums[0] += sample * density * area;
            sums[1] += sample * sample * density * area;
        }
        sums
    };
    for technique in [Technique::Camera, Technique::Symmetric, Technique::Light] {
        let estimator = Estimator::new(&entry, technique, Kernel::Epanechnikov, None).unwrap();
        let sums = [500, 800].map(|grid| moments(technique, grid));
        let what = format!("underwater {}", technique.name());
        let caught = compare(&what, &estimator, 10_000, alpha, point, sums);
        assert!(caught < 0.03, "{what}: {caught}");
    }
}
