//! The flux engine on light without singularities, against exact polygons.

use std::sync::Arc;

use nephroid_analytic::camera::Bounded;
use nephroid_analytic::flux::direct::FloorLight;
use nephroid_analytic::flux::{Bundle, FluxImage, MARGINS, Ray};
use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::scene::{
    Camera, DiffuseScene, Entry, Floor, Kind, PlanarMirrorScene, PointLight, RectangleMirror,
};

fn camera(size: u32) -> Camera {
    Camera {
        position: [0.0, -3.0, 2.0],
        look_at: [0.0, 0.6, 0.3],
        up: [0.0, 0.0, 1.0],
        field_of_view_degrees: 45.0,
        width: size,
        height: size,
    }
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

/// The largest difference from a layer of the polygon code, in units of the largest pixel.
fn worst(image: &[Vec<Bounded>], truth: &PixelTruth, layer: usize) -> (f64, f64) {
    let (mut difference, mut largest, mut excess) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (j, row) in image.iter().enumerate() {
        let exact = truth.row(j as u32, 1e-13);
        for (p, q) in row.iter().zip(&exact[layer]) {
            let d = (p.value - q.value).abs();
            difference = difference.max(d);
            largest = largest.max(q.value);
            excess = excess.max(d - p.error - q.error);
        }
    }
    (difference / largest, excess / largest)
}

const LIGHT: [f64; 3] = [0.25, 0.0, 2.0];

#[test]
fn direct_light_agrees_with_polygons() {
    let floor = Floor {
        center: [0.2, -0.3],
        half_width: [1.7, 1.1],
        albedo: 0.5,
    };
    let entry = Entry {
        name: "floor".to_owned(),
        title: String::new(),
        kind: Kind::Diffuse(DiffuseScene {
            light: PointLight {
                position: LIGHT,
                intensity: 2.3,
            },
            floor: floor.clone(),
        }),
        camera: camera(64),
    };
    let light = FloorLight::new(&floor, |x, y| {
        let (dx, dy, h) = (x - LIGHT[0], y - LIGHT[1], LIGHT[2]);
        let r2 = dx * dx + dy * dy + h * h;
        (2.3 * h / (r2 * r2.sqrt()), [1.0; MARGINS])
    });
    let image = FluxImage::new(&camera(64), &floor, vec![vec![Arc::new(light)]]);
    let truth = PixelTruth::new(&entry).unwrap();
    let (difference, excess) = worst(&rows(&image, 64, 1e-11), &truth, 0);
    assert!(
        difference < 1e-10 && excess < 1e-12,
        "{difference:e} {excess:e}"
    );
}

/// Light by the wall y = 1: parameters are the mirror point (x, z).
#[derive(Debug)]
struct Wall;

impl Bundle for Wall {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-0.75, 0.75], [0.125, 1.125]]
    }

    fn ray(&self, [x, z]: [f64; 2]) -> Ray {
        let d = [x - LIGHT[0], 1.0 - LIGHT[1], z - LIGHT[2]];
        let r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        // From the mirror point on, with the y component turned round, down to the floor.
        let t = z / -d[2];
        Ray {
            floor: [x + t * d[0], 1.0 - t * d[1]],
            flux: d[1] / (r2 * r2.sqrt()),
            margins: [1.0; MARGINS],
        }
    }
}

#[test]
fn mirrored_light_agrees_with_polygons() {
    let floor = Floor {
        center: [0.0, 0.0],
        half_width: [3.0, 3.0],
        albedo: 0.5,
    };
    let entry = Entry {
        name: "mirror-wall".to_owned(),
        title: String::new(),
        kind: Kind::PlanarMirror(PlanarMirrorScene {
            light: PointLight {
                position: LIGHT,
                intensity: 1.0,
            },
            floor: floor.clone(),
            mirror: RectangleMirror {
                center: [0.0, 1.0, 0.625],
                normal: [0.0, -1.0, 0.0],
                edge: [1.0, 0.0, 0.0],
                half_width: 0.75,
                half_height: 0.5,
                reflectance: 1.0,
            },
        }),
        camera: camera(64),
    };
    let image = FluxImage::new(&camera(64), &floor, vec![vec![Arc::new(Wall)]]);
    let truth = PixelTruth::new(&entry).unwrap();
    let (difference, excess) = worst(&rows(&image, 64, 1e-11), &truth, 1);
    assert!(
        difference < 1e-10 && excess < 1e-12,
        "{difference:e} {excess:e}"
    );
}
