//! The flux engine across a fold and a cusp: the caustic of the cup against the code that integrates along the light's own
//! straight lines.

use std::sync::Arc;

use nephroid_analytic::camera::Bounded;
use nephroid_analytic::flux::{Bundle, FluxImage, MARGINS, Ray};
use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::scene::{ArcWall, Camera, DirectionalLight, Entry, Floor, Kind};

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
        kind: Kind::CylinderCup {
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
        },
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
        entry.kind.floor(),
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
    let start = std::time::Instant::now();
    let flux = image(size);
    println!("new {:?}", start.elapsed());
    let truth = PixelTruth::new(&cup(size)).unwrap();
    for tolerance in [1e-4, 1e-6, 1e-9] {
        let start = std::time::Instant::now();
        let image = rows(&flux, size, tolerance);
        println!("rows {:?}", start.elapsed());
        let mut errors: Vec<(f64, f64, f64, f64, u32, u32)> = Vec::new();
        let (mut sum, mut count) = (0.0, 0.0);
        for j in 0..size {
            let exact = truth.row(j, 1e-12);
            for i in 0..size {
                let (p, q) = (image[j as usize][i as usize], exact[1][i as usize]);
                errors.push(((p.value - q.value).abs(), p.value, p.error, q.error, i, j));
                sum += q.value;
                count += f64::from(u8::from(q.value > 0.0));
            }
        }
        errors.sort_by(|a, b| b.0.total_cmp(&a.0));
        println!("{tolerance} typical {}", sum / count);
        for e in &errors[..4] {
            println!("{e:?}");
        }
    }
}
