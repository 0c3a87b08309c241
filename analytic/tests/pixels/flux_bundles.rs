//! The flux engine on bundles made to be difficult: foci, folds, parametrisations with a pole, square roots at a border with
//! NaN beyond it, rays to infinity, shadows. Each is compared with a closed form or with another parametrisation of the same
//! light.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use nephroid_analytic::camera::Bounded;
use nephroid_analytic::flux::direct::FloorLight;
use nephroid_analytic::flux::{Bundle, FluxImage, MARGINS, Ray};
use nephroid_analytic::scene::{Camera, Floor};

/// Straight down from this height: the film's area per floor area is constant.
const HEIGHT: f64 = 3.0;
const ALBEDO: f64 = 0.6;

fn down(size: u32) -> Camera {
    Camera {
        position: [0.03, -0.02, HEIGHT],
        look_at: [0.03, -0.02, 0.0],
        up: [0.0, 1.0, 0.0],
        field_of_view_degrees: 50.0,
        width: size,
        height: size,
    }
}

fn floor() -> Floor {
    Floor {
        center: [0.0, 0.0],
        half_width: [1.2, 1.1],
        albedo: ALBEDO,
    }
}

/// Radiance of a pixel per flux on it.
fn radiance_per_flux(size: u32) -> f64 {
    let side = 2.0 * HEIGHT * libm::tan(25.0_f64.to_radians()) / f64::from(size);
    ALBEDO / PI / (side * side)
}

/// A bundle from a closure.
struct Of<F>([[f64; 2]; 2], F);

impl<F> std::fmt::Debug for Of<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl<F: Fn(f64, f64) -> ([f64; 2], f64, f64) + Send + Sync> Bundle for Of<F> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.0
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let (floor, flux, margin) = (self.1)(u[0], u[1]);
        let mut margins = [1.0; MARGINS];
        margins[3] = margin;
        Ray {
            floor,
            flux,
            margins,
        }
    }
}

const SQUARE: [[f64; 2]; 2] = [[-1.0, 1.0]; 2];

fn one(bundle: impl Bundle + 'static) -> Vec<Arc<dyn Bundle>> {
    vec![Arc::new(bundle)]
}

fn pixels(camera: &Camera, layer: Vec<Arc<dyn Bundle>>, tolerance: f64) -> Vec<Bounded> {
    let image = FluxImage::new(camera, &floor(), vec![layer]);
    let mut all = Vec::new();
    for j in 0..camera.height {
        let mut row = vec![vec![Bounded::default(); camera.width as usize]];
        image.row(j, tolerance, &mut row);
        all.append(&mut row[0]);
    }
    all
}

fn sum(pixels: &[Bounded]) -> f64 {
    pixels.iter().map(|p| p.value).sum()
}

/// Largest difference, in units of the mean, and largest difference beyond the errors.
fn compare(a: &[Bounded], b: &[Bounded]) -> (f64, f64) {
    let mean = sum(b) / b.len() as f64;
    let mut worst = (0.0_f64, f64::NEG_INFINITY);
    for (p, q) in a.iter().zip(b) {
        let d = (p.value - q.value).abs();
        worst.0 = worst.0.max(d / mean);
        worst.1 = worst.1.max((d - p.error - q.error) / mean);
    }
    worst
}

/// A lens with spherical aberration in front of its focus: a ring fold, and a whole circle that lands in one point.
fn aberrated(u: f64, v: f64) -> ([f64; 2], f64, f64) {
    let r2 = u * u + v * v;
    let k = 0.35 - 0.9 * r2;
    ([0.1 + k * u, k * v], 1.0 + 0.3 * u, 1.0 - r2)
}

fn aberrated_polar(r: f64, phi: f64) -> ([f64; 2], f64, f64) {
    let (s, c) = libm::sincos(phi);
    let (floor, flux, _) = aberrated(r * c, r * s);
    (floor, flux * r, 1.0)
}

#[test]
fn two_parametrisations_of_folds_and_a_ring_to_one_point() {
    let camera = down(32);
    let a = pixels(&camera, one(Of(SQUARE, aberrated)), 1e-9);
    let b = pixels(
        &camera,
        one(Of([[0.0, 1.0], [0.3, 0.3 + TAU]], aberrated_polar)),
        1e-9,
    );
    let (difference, excess) = compare(&a, &b);
    assert!(
        difference < 1e-7 && excess < 1e-12,
        "{difference:e} {excess:e}"
    );
    assert!((sum(&a) / (PI * radiance_per_flux(32)) - 1.0).abs() < 1e-10);
}

#[test]
fn coarse_pixels_are_means_of_fine_ones() {
    let coarse = pixels(&down(16), one(Of(SQUARE, aberrated)), 1e-9);
    let fine = pixels(&down(32), one(Of(SQUARE, aberrated)), 1e-9);
    let means: Vec<Bounded> = (0..256)
        .map(|k| {
            let (i, j) = (2 * (k % 16), 2 * (k / 16));
            let four = [
                j * 32 + i,
                j * 32 + i + 1,
                (j + 1) * 32 + i,
                (j + 1) * 32 + i + 1,
            ];
            Bounded {
                value: four.iter().map(|&k| 0.25 * fine[k].value).sum(),
                error: four.iter().map(|&k| 0.25 * fine[k].error).sum(),
            }
        })
        .collect();
    let (difference, excess) = compare(&coarse, &means);
    assert!(
        difference < 1e-8 && excess < 1e-12,
        "{difference:e} {excess:e}"
    );
    let whole = pixels(&down(1), one(Of(SQUARE, aberrated)), 1e-9);
    assert!((whole[0].value / (sum(&coarse) / 256.0) - 1.0).abs() < 1e-10);
}

#[test]
fn all_rays_to_one_point() {
    for (x, allowed) in [(0.011, 1), (0.03, 2)] {
        // The second focus is on a pixel's edge: half, whole or nothing of it is right, but nothing is lost.
        let focus = move |u: f64, v: f64| ([x, 0.2], 1.0 + u * u * v * v, 1.0);
        let all = pixels(&down(32), one(Of(SQUARE, focus)), 1e-6);
        let lit = all.iter().filter(|p| p.value > 0.0).count();
        let total = (4.0 + 4.0 / 9.0) * radiance_per_flux(32);
        assert!(lit >= 1 && lit <= allowed, "{lit}");
        assert!((sum(&all) / total - 1.0).abs() < 1e-12);
        assert!(
            all.iter()
                .all(|p| p.value.is_finite() && p.error.is_finite())
        );
    }
}

#[test]
fn a_focus_that_is_almost_one() {
    // A defocus of a millionth of a pixel, on an edge and off it.
    for x in [0.011, 0.03] {
        let focus =
            move |u: f64, v: f64| ([x + 1e-7 * u, 0.2 + 1e-7 * (v + 0.3 * u * u)], 1.0, 1.0);
        let all = pixels(&down(32), one(Of(SQUARE, focus)), 1e-6);
        let total = 4.0 * radiance_per_flux(32);
        assert!((sum(&all) / total - 1.0).abs() < 1e-8);
    }
}

#[test]
fn square_root_at_a_border_and_nothing_beyond_it() {
    // Flux and place end like a square root; √ of a negative number is NaN.
    let bundle = |u: f64, v: f64| {
        let m = 1.0 - u * u - v * v;
        let w = m.sqrt();
        ([u * (0.5 + 0.3 * w), v * (0.6 - 0.2 * w)], w, m)
    };
    let all = pixels(&down(32), one(Of(SQUARE, bundle)), 1e-8);
    let total = TAU / 3.0 * radiance_per_flux(32);
    let error: f64 = all.iter().map(|p| p.error).sum();
    assert!((sum(&all) / total - 1.0).abs() < 1e-9);
    assert!(error / total < 1e-5);
    // The same light by (cos of the polar angle, azimuth), where nothing is singular.
    let smooth = |w: f64, phi: f64| {
        let r = (1.0 - w * w).max(0.0).sqrt();
        let (s, c) = libm::sincos(phi);
        (
            [r * c * (0.5 + 0.3 * w), r * s * (0.6 - 0.2 * w)],
            w * w,
            1.0,
        )
    };
    let other = pixels(&down(32), one(Of([[0.0, 1.0], [0.0, TAU]], smooth)), 1e-8);
    let (difference, excess) = compare(&all, &other);
    assert!(
        difference < 1e-6 && excess < 1e-9,
        "{difference:e} {excess:e}"
    );
}

/// The second condition is not a number where the first is violated.
#[derive(Debug)]
struct Dependent;

impl Bundle for Dependent {
    fn domain(&self) -> [[f64; 2]; 2] {
        SQUARE
    }

    fn ray(&self, [u, v]: [f64; 2]) -> Ray {
        let m = 1.0 - u * u - v * v;
        let w = m.sqrt();
        let mut margins = [1.0; MARGINS];
        (margins[0], margins[5]) = (w - 0.3, m);
        Ray {
            floor: [0.5 * u, 0.5 * v + 0.1 * w],
            flux: w,
            margins,
        }
    }
}

#[test]
fn a_condition_on_what_another_lets_pass() {
    let all = pixels(&down(32), one(Dependent), 1e-8);
    let total = TAU / 3.0 * (1.0 - 0.027) * radiance_per_flux(32);
    let error: f64 = all.iter().map(|p| p.error).sum();
    assert!(
        (sum(&all) / total - 1.0).abs() < 1e-10,
        "{:e}",
        sum(&all) / total - 1.0
    );
    assert!(error < 1e-6 * total, "{error:e}");
}

#[test]
fn what_cannot_be_resolved_is_in_the_error() {
    // An edge that no margin announces.
    let step = |u: f64, v: f64| ([u, v], f64::from(u8::from(u + 0.3 * v < 0.1)), 1.0);
    let all = pixels(&down(32), one(Of(SQUARE, step)), 1e-6);
    let total = 2.2 * radiance_per_flux(32);
    let error: f64 = all.iter().map(|p| p.error).sum();
    let difference = (sum(&all) - total).abs();
    assert!(
        difference <= error && error < 0.05 * total,
        "{difference:e} {error:e} {total}"
    );
}

#[test]
fn rays_to_infinity() {
    // A point light by directions, up to beyond the horizon, against its irradiance.
    let h = 0.7;
    let direction = move |theta: f64, phi: f64| {
        let (s, c) = libm::sincos(theta);
        let (y, x) = libm::sincos(phi);
        let r = if c < -0.3 { f64::NAN } else { h * s / c };
        ([0.2 + r * x, r * y], s, c)
    };
    let camera = Camera {
        position: [0.3, -2.4, 1.1],
        look_at: [0.1, 0.0, 0.2],
        up: [0.0, 0.0, 1.0],
        field_of_view_degrees: 60.0,
        width: 32,
        height: 32,
    };
    let a = pixels(&camera, one(Of([[0.0, 2.2], [-PI, PI]], direction)), 1e-9);
    let irradiance = move |x: f64, y: f64| {
        let r2 = (x - 0.2) * (x - 0.2) + y * y + h * h;
        (h / (r2 * r2.sqrt()), [1.0; MARGINS])
    };
    let b = pixels(&camera, one(FloorLight::new(&floor(), irradiance)), 1e-9);
    let (difference, excess) = compare(&a, &b);
    assert!(
        difference < 1e-9 && excess < 1e-12,
        "{difference:e} {excess:e}"
    );
}

#[test]
fn shadows_subtract() {
    let irradiance = |x: f64, y: f64| (1.0 + 0.3 * x * y, [1.0; MARGINS]);
    let light = FloorLight::new(&floor(), irradiance);
    // The shadow is the rectangle [-0.41, 0.33] × [-0.2, 0.57], by points of an occluder at half the height.
    let shadow = Of([[-0.205, 0.165], [-0.1, 0.285]], move |u: f64, v: f64| {
        let (x, y) = (2.0 * u, 2.0 * v);
        ([x, y], -4.0 * irradiance(x, y).0, 1.0)
    });
    let whole: Vec<Arc<dyn Bundle>> = vec![Arc::new(light), Arc::new(shadow)];
    let a = pixels(&down(32), whole, 1e-9);
    let part = |x: [f64; 2], y: [f64; 2]| -> Arc<dyn Bundle> {
        Arc::new(Of([x, y], move |x: f64, y: f64| {
            ([x, y], irradiance(x, y).0, 1.0)
        }))
    };
    let four = vec![
        part([-1.2, -0.41], [-1.1, 1.1]),
        part([0.33, 1.2], [-1.1, 1.1]),
        part([-0.41, 0.33], [-1.1, -0.2]),
        part([-0.41, 0.33], [0.57, 1.1]),
    ];
    let b = pixels(&down(32), four, 1e-9);
    let (difference, excess) = compare(&a, &b);
    assert!(
        difference < 1e-9 && excess < 1e-12,
        "{difference:e} {excess:e}"
    );
    let dark = a.iter().filter(|p| p.value.abs() < 1e-12).count();
    assert!(dark > 40, "{dark}");
}

/// Light through waves: a network of folds and cusps.
fn waves(x: f64, y: f64) -> ([f64; 2], f64) {
    let (s, c) = libm::sincos(5.0 * x + 0.5);
    let (s2, c2) = libm::sincos(3.0 * x - 6.0 * y);
    let z = 0.9 + 0.05 * s + 0.04 * s2;
    let (zx, zy) = (0.25 * c + 0.12 * c2, -0.24 * c2);
    (
        [x - z * zx / (1.0 + zx * zx).sqrt(), y - z * zy],
        1.0 + 0.2 * x,
    )
}

fn straight(camera: &Camera, tolerance: f64) -> Vec<Bounded> {
    let bundle = |x: f64, y: f64| {
        let (floor, flux) = waves(x, y);
        (floor, flux, 1.0)
    };
    pixels(
        camera,
        one(Of([[-0.9, 0.8], [-0.7, 0.75]], bundle)),
        tolerance,
    )
}

/// The same rays by sheared parameters, so that their rectangle is cut out by margins, with corners.
#[derive(Debug)]
struct Sheared;

impl Bundle for Sheared {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.3, 1.4], [-1.2, 1.3]]
    }

    fn ray(&self, [p, q]: [f64; 2]) -> Ray {
        let (x, y) = (p + 0.37 * q, q - 0.21 * p);
        let (floor, flux) = waves(x, y);
        let mut margins = [1.0; MARGINS];
        margins[..4].copy_from_slice(&[x + 0.9, 0.8 - x, y + 0.7, 0.75 - y]);
        Ray {
            floor,
            flux: flux * (1.0 + 0.37 * 0.21),
            margins,
        }
    }
}

#[test]
fn two_parametrisations_of_a_network_of_caustics() {
    let camera = down(48);
    let a = straight(&camera, 1e-9);
    let b = pixels(&camera, one(Sheared), 1e-9);
    let (difference, excess) = compare(&a, &b);
    assert!(
        difference < 1e-9 && excess < 1e-12,
        "{difference:e} {excess:e}"
    );
    let mean = sum(&a) / a.len() as f64;
    for tolerance in [1e-3, 1e-5, 1e-7] {
        let rough = straight(&camera, tolerance);
        let (difference, excess) = compare(&rough, &b);
        let worst = rough.iter().map(|p| p.error).fold(0.0, f64::max) / mean;
        assert!(
            difference < tolerance && excess < 1e-12,
            "{difference:e} {excess:e}"
        );
        // The estimate is worth something, too.
        assert!(worst < 10.0 * tolerance, "{worst:e}");
    }
}
