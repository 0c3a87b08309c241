//! Pixels of the entries with vertical walls, by conservation of flux along rays, against the mean of the irradiance at
//! points, which finds the rays by roots: no code in common but the camera.

use crate::gauss;

use nephroid::{entry, truth};
use nephroid_analytic::camera::Film;
use nephroid_analytic::entries::{FloorTruth, PointTruth};

/// A floor point with its light.
type Seen = ([f64; 2], Vec<PointTruth>);

/// The light at the floor point seen at a film point; nothing beside the floor.
fn seen(film: &Film, truth: &FloorTruth, u: f64, v: f64) -> Option<Seen> {
    let d = film.direction(u, v);
    let t = film.position.z / -d.z;
    let (x, y) = (film.position.x + d.x * t, film.position.y + d.y * t);
    truth.is_on_floor(x, y).then(|| ([x, y], truth.at(x, y)))
}

/// Whether a class is smooth over a pixel: as many rays arrive at all points of a fine grid, its border included, and its
/// caustic is far: from 1.5 pixels on, the rule's error next to a square root is below 1e-9.
fn smooth(truth: &FloorTruth, grid: &[Seen], class: usize, pixel: f64) -> bool {
    let roots = grid[0].1[class].irradiance.roots;
    let far = |[x, y]: [f64; 2]| {
        truth
            .singularity(x, y, class)
            .is_none_or(|s| s.distance > 1.5 * pixel)
    };
    grid.iter()
        .all(|(at, p)| p[class].irradiance.roots == roots && far(*at))
}

/// One pixel in 5 × 4 of each picture. A lost or doubled ray, a wrong area element or a wrong weight would show at 1e-6.
#[test]
fn smooth_pixels_are_means_of_point_values() {
    for name in [
        "pillar",
        "conic-wall",
        "glass-pillar",
        "glass-column",
        "corner",
        "cup-rim",
        "deep-cup",
    ] {
        let mut scene = entry::load(name).unwrap();
        (scene.camera.width, scene.camera.height) = (70, 70);
        let image = truth::image(&scene, 1e-9);
        let (film, floor) = (Film::new(&scene.camera), FloorTruth::new(&scene).unwrap());
        let pixel = scene.camera.position[2] * film.du.length();
        let mut lit = vec![0; image.classes.len()];
        for (i, j) in (0..70)
            .step_by(5)
            .flat_map(|j| (0..70).step_by(4).map(move |i| (i, j)))
        {
            let at = |s: f64, t: f64| seen(&film, &floor, i as f64 + s, j as f64 + t);
            let grid: Option<Vec<_>> = (0..49)
                .map(|k| at(f64::from(k % 7) / 6.0, f64::from(k / 7) / 6.0))
                .collect();
            let Some(grid) = grid else { continue };
            let mut mean = vec![0.0; image.classes.len()];
            for &(s, p) in gauss::rule(6) {
                for &(t, q) in gauss::rule(6) {
                    for (mean, point) in mean.iter_mut().zip(at(s, t).unwrap().1) {
                        *mean += p * q * point.irradiance.value;
                    }
                }
            }
            for (c, class) in image.classes.iter().enumerate() {
                if !smooth(&floor, &grid, c, pixel) {
                    continue;
                }
                let expected = mean[c] * floor.albedo() / std::f64::consts::PI;
                let found = image.layers[c][j * 70 + i];
                let largest = image.layers[c].iter().fold(0.0_f64, |a, &b| a.max(b));
                assert!(
                    (found - expected).abs() <= 1e-6 * expected + 1e-11 * largest,
                    "{name} {class} ({i}, {j}): {found:e} for {expected:e}"
                );
                lit[c] += usize::from(expected > 0.0);
            }
        }
        assert!(lit.iter().all(|&n| n > 0), "{name}: {lit:?}");
    }
}
