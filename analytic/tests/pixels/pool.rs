//! Pixels of the pool against Snell's law traced in vectors, a light ray found by bisection and irradiance by a finite
//! difference of the beam's footprint.

use std::f64::consts::PI;

use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::quadrature::gauss_legendre;
use nephroid_analytic::scene::{Camera, Entry, FlatInterfaceScene, Floor, Kind, PointLight, Water};

const LIGHT: [f64; 3] = [0.4, -1.1, 2.3];
const INTENSITY: f64 = 3.7;
const SURFACE: f64 = 1.2;
const INDEX: f64 = 1.4;
const ALBEDO: f64 = 0.65;
const EYE: [f64; 3] = [-0.7, -2.2, 2.1];
const SIZE: u32 = 20;

fn pool() -> Entry {
    Entry {
        name: "pool-under-test".to_owned(),
        title: String::new(),
        kind: Kind::FlatInterface(FlatInterfaceScene {
            light: PointLight {
                position: LIGHT,
                intensity: INTENSITY,
            },
            floor: Floor {
                center: [0.1, 0.05],
                half_width: [0.8, 0.9],
                albedo: ALBEDO,
            },
            water: Water {
                surface_z: SURFACE,
                index: INDEX,
            },
        }),
        camera: Camera {
            position: EYE,
            look_at: [0.0, 0.0, 0.3],
            up: [0.0, 0.0, 1.0],
            field_of_view_degrees: 46.0,
            width: SIZE,
            height: SIZE,
        },
    }
}

/// Unpolarised Fresnel transmittance from the textbook amplitude ratios, incidence in air with that cosine.
fn transmittance(cos_air: f64) -> f64 {
    let sin_water = (1.0 - cos_air * cos_air).sqrt() / INDEX;
    let cos_water = (1.0 - sin_water * sin_water).sqrt();
    let s = (cos_air - INDEX * cos_water) / (cos_air + INDEX * cos_water);
    let p = (INDEX * cos_air - cos_water) / (INDEX * cos_air + cos_water);
    1.0 - 0.5 * (s * s + p * p)
}

/// Plan distance that a light ray of angle θ in air covers down to the floor.
fn landing(theta: f64) -> f64 {
    let below = libm::asin(libm::sin(theta) / INDEX);
    (LIGHT[2] - SURFACE) * libm::tan(theta) + SURFACE * libm::tan(below)
}

/// I T dΩ/dA at plan distance X: dΩ = 2π sin θ dθ lands on dA = 2π X dX.
fn irradiance(x: f64, y: f64) -> f64 {
    let plan = libm::hypot(x - LIGHT[0], y - LIGHT[1]);
    let (mut low, mut high) = (0.0, 0.5 * PI - 1e-9);
    for _ in 0..60 {
        let m = 0.5 * (low + high);
        if landing(m) < plan { low = m } else { high = m }
    }
    let (theta, h) = (0.5 * (low + high), 1e-4);
    let difference = |h: f64| (landing(theta + h) - landing(theta - h)) / (2.0 * h);
    let slope = (4.0 * difference(h) - difference(2.0 * h)) / 3.0;
    INTENSITY * transmittance(libm::cos(theta)) * libm::sin(theta) / (plan * slope)
}

/// Radiance through a film point, and whether the floor is there.
fn radiance(u: f64, v: f64) -> f64 {
    let f = [0.0 - EYE[0], 0.0 - EYE[1], 0.3 - EYE[2]];
    let length = (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]).sqrt();
    let f = f.map(|c| c / length);
    let flat = libm::hypot(f[0], f[1]);
    let r = [f[1] / flat, -f[0] / flat];
    let up = [r[1] * f[2], -r[0] * f[2], r[0] * f[1] - r[1] * f[0]];
    let scale = libm::tan(23.0_f64.to_radians()) * 2.0 / f64::from(SIZE);
    let (a, b) = (scale * (u - 10.0), scale * (v - 10.0));
    let d = [
        f[0] + a * r[0] - b * up[0],
        f[1] + a * r[1] - b * up[1],
        f[2] - b * up[2],
    ];
    if d[2] >= 0.0 {
        return 0.0;
    }
    let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    let d = d.map(|c| c / length);
    let t = (EYE[2] - SURFACE) / -d[2];
    // Snell in vectors: the horizontal part shrinks by the index, the rest is made up vertically.
    let w = [d[0] / INDEX, d[1] / INDEX];
    let down = (1.0 - w[0] * w[0] - w[1] * w[1]).sqrt();
    let s = SURFACE / down;
    let x = EYE[0] + t * d[0] + s * w[0];
    let y = EYE[1] + t * d[1] + s * w[1];
    if (x - 0.1).abs() > 0.8 || (y - 0.05).abs() > 0.9 {
        return 0.0;
    }
    transmittance(-d[2]) / (INDEX * INDEX) * ALBEDO / PI * irradiance(x, y)
}

#[test]
fn pixels_are_the_means_of_traced_radiance() {
    let truth = PixelTruth::new(&pool()).unwrap();
    let rule = gauss_legendre(6);
    let (mut inner, mut border) = (0, 0);
    for j in 0..SIZE {
        let row = truth.row(j, 1e-9);
        for i in 0..SIZE {
            let pixel = row[0][i as usize];
            let at = |x: f64, y: f64| radiance(f64::from(i) + x, f64::from(j) + y);
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
            let lit = corners.iter().filter(|c| at(c.0, c.1) > 0.0).count();
            if lit == 4 {
                let mut sum = 0.0;
                for (x, wx) in &rule {
                    for (y, wy) in &rule {
                        sum += 0.25 * wx * wy * at(0.5 + 0.5 * x, 0.5 + 0.5 * y);
                    }
                }
                assert!(
                    (pixel.value / sum - 1.0).abs() < 1e-9,
                    "({i}, {j}) {pixel:?} {sum}"
                );
                inner += 1;
            } else if lit > 0 {
                // A border: 150² points see an area to about one part in a thousand of the pixel.
                let n = 150;
                let mut sum = 0.0;
                for k in 0..n * n {
                    let (x, y) = (f64::from(k % n) + 0.5, f64::from(k / n) + 0.5);
                    sum += at(x / f64::from(n), y / f64::from(n));
                }
                let mean = sum / f64::from(n * n);
                assert!(
                    (pixel.value - mean).abs() < 5e-4,
                    "({i}, {j}) {pixel:?} {mean}"
                );
                border += 1;
            } else {
                assert!(pixel.value < 0.03, "({i}, {j}) {pixel:?}");
            }
        }
    }
    assert!(inner > 60 && border > 25, "{inner} {border}");
}
