//! The flux engine across a fold and a cusp: the caustic of the cup against the code that integrates along the light's own
//! straight lines.

use std::f64::consts::PI;
use std::sync::Arc;

use nephroid_analytic::camera::{Bounded, Film};
use nephroid_analytic::flux::{Bundle, FluxImage, MARGINS, Ray};
use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::quadrature::gauss_legendre;
use nephroid_analytic::scene::{
    ArcWall, Camera, CylinderCupScene, DirectionalLight, Entry, Floor, Kind,
};
use nephroid_analytic::vector::vec3;

const RADIUS: f64 = 1.2;
const HEIGHT: f64 = 0.53;
const ARC: f64 = 60.0;
const REFLECTANCE: f64 = 0.9;
const ELEVATION: f64 = 24.0;
const IRRADIANCE: f64 = 1.1;

fn cup(size: u32) -> Entry {
    Entry {
        name: "cup".to_owned(),
        title: String::new(),
        kind: Kind::CylinderCup(CylinderCupScene {
            light: DirectionalLight {
                elevation_degrees: ELEVATION,
                irradiance: IRRADIANCE,
            },
            floor: Floor {
                center: [0.6, 0.0],
                half_width: [3.6, 3.4],
                albedo: 0.6,
            },
            wall: ArcWall {
                radius: RADIUS,
                height: HEIGHT,
                half_arc_degrees: ARC,
                reflectance: REFLECTANCE,
            },
        }),
        camera: Camera {
            position: [-1.9, -0.9, 2.7],
            look_at: [0.76, -0.02, 0.13],
            up: [0.0, 0.0, 1.0],
            field_of_view_degrees: 37.0,
            width: size,
            height: size,
        },
    }
}

/// Parameters: the azimuth and the height of the point on the wall.
#[derive(Debug)]
struct Caustic;

impl Bundle for Caustic {
    fn domain(&self) -> [[f64; 2]; 2] {
        let arc = ARC.to_radians();
        [[-arc, arc], [0.0, HEIGHT]]
    }

    fn ray(&self, [phi, z]: [f64; 2]) -> Ray {
        let (s, c) = libm::sincos(phi);
        let tan = libm::tan(ELEVATION.to_radians());
        let leg = z / tan;
        // Along +x before, along -(cos 2φ, sin 2φ) after.
        let (s2, c2) = libm::sincos(2.0 * phi);
        let mut margins = [1.0; MARGINS];
        margins[0] = 2.0 * RADIUS * c - leg;
        let beam = IRRADIANCE * libm::cos(ELEVATION.to_radians());
        Ray {
            floor: [RADIUS * c - leg * c2, RADIUS * s - leg * s2],
            flux: REFLECTANCE * beam * RADIUS * c,
            margins,
        }
    }
}

fn image(size: u32) -> FluxImage {
    let entry = cup(size);
    FluxImage::new(
        &entry.camera,
        entry.kind.floor().expect("a floor"),
        vec![vec![Arc::new(Caustic)]],
    )
}

fn rows(image: &FluxImage, size: u32, tolerance: f64) -> Vec<Vec<Bounded>> {
    (0..size)
        .map(|j| {
            let mut row = vec![vec![Bounded::default(); size as usize]];
            image.row(j, tolerance, &mut row);
            row.remove(0)
        })
        .collect()
}

#[test]
fn caustic_agrees_with_the_exact_cup() {
    let size = 64;
    let flux = image(size);
    let truth = PixelTruth::new(&cup(size)).unwrap();
    let exact: Vec<Bounded> = (0..size)
        .flat_map(|j| truth.row(j, 1e-12).remove(1))
        .collect();
    let lit = exact.iter().filter(|p| p.value > 0.0).count() as f64;
    let typical = exact.iter().map(|p| p.value).sum::<f64>() / lit;
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9] {
        let image = rows(&flux, size, tolerance).concat();
        for (k, (p, q)) in image.iter().zip(&exact).enumerate() {
            // Relative to the larger of the pixel and the typical pixel: the pixels of fold and cusp as well.
            let difference = (p.value - q.value).abs();
            let allowed = tolerance * typical.max(q.value);
            assert!(difference <= allowed, "{tolerance} {k} {p:?} {q:?}");
            assert!(
                difference <= p.error + q.error,
                "{tolerance} {k} {p:?} {q:?}"
            );
        }
    }
}

#[test]
fn the_sum_over_pixels_is_the_flux_into_the_frame() {
    // The frame as one pixel, cut in other places, and the flux in the light's own coordinates: everything is in the frame.
    let total = |size: u32| {
        let image = rows(&image(size), size, 1e-10).concat();
        image.iter().map(|p| p.value).sum::<f64>() / f64::from(size * size)
    };
    let entry = cup(1);
    let film = Film::new(&entry.camera);
    let rule = gauss_legendre(40);
    let [[a, b], [c, d]] = Caustic.domain();
    let mut sum = 0.0;
    for (x, wx) in &rule {
        for (y, wy) in &rule {
            let ray = Caustic.ray([0.5 * (a + b + x * (b - a)), 0.5 * (c + d + y * (d - c))]);
            let to = vec3(ray.floor[0], ray.floor[1], 0.0) - film.position;
            let depth = to.dot(film.forward);
            let density = film.position.z / (depth * depth * depth * film.dv.length_squared());
            sum += wx * wy * 0.25 * (b - a) * (d - c) * ray.flux * density * 0.6 / PI;
        }
    }
    for size in [1, 7, 48] {
        let difference = (total(size) / sum - 1.0).abs();
        assert!(difference < 1e-11, "{size} {difference:e}");
    }
}
