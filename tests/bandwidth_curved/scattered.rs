//! Films that are summed from the light's side ([`nephroid_analytic::bandwidth::scatter`]) against films and points from the eye's.

use nephroid_analytic::bandwidth::entry::Estimator;
use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::frame::FrameExpectation;
use nephroid_analytic::bandwidth::scatter::SETS;
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};

use super::load;

fn estimator(technique: Technique, kernel: Kernel, bandwidths: &[f64]) -> Estimator<'_> {
    Estimator {
        technique,
        kernel,
        convention: Convention::Exact,
        bandwidths,
    }
}

/// The sum over all pixels of mean and second moment, and how far it may be off: 4.5 standard errors over the sets.
fn sums(frame: &FrameExpectation, class: usize, points: u32) -> [[f64; 2]; 2] {
    let pixels = frame.size().0 as usize * frame.size().1 as usize;
    let aim = frame.aim(class);
    let sets: Vec<[f64; 2]> = (0..SETS)
        .map(|set| {
            let mut image = vec![[0.0; 2]; pixels];
            frame.scatter(class, &aim, set, 0..points, &mut image);
            [0, 1].map(|k| image.iter().map(|p| p[k]).sum::<f64>() / f64::from(points))
        })
        .collect();
    let count = f64::from(SETS);
    [0, 1].map(|k| {
        let mean = sets.iter().map(|s| s[k]).sum::<f64>() / count;
        let squares: f64 = sets.iter().map(|s| (s[k] - mean) * (s[k] - mean)).sum();
        [mean, 4.5 * (squares / (count * (count - 1.0))).sqrt()]
    })
}

/// The plane mirror, seen directly and in itself, against polygons cut along its edges and integrated in polar coordinates: no line of
/// code in common but the kernels.
#[test]
fn the_plane_mirror() {
    let mut scene = load("mirror-wall");
    (scene.camera.width, scene.camera.height) = (16, 16);
    for (technique, kernel) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Camera, Kernel::VonMisesFisher),
        (Technique::Light, Kernel::Epanechnikov),
        (Technique::Symmetric, Kernel::Cone),
        (Technique::Merge, Kernel::Disc),
        (Technique::Merge, Kernel::Epanechnikov),
    ] {
        let bandwidths = [0.25];
        let frame = FrameExpectation::new(&scene, estimator(technique, kernel, &bandwidths), 1.0)
            .expect("a frame");
        let film = FilmExpectation::new(&scene, technique, kernel, &bandwidths).expect("a film");
        let unlimited = [[f64::INFINITY; 2]; 2];
        let exact = film.region(0..16, 0..16, &unlimited, 1e-4);
        for (class, exact) in exact.iter().enumerate() {
            let found = sums(&frame, class, 1 << 17);
            for (k, exact) in [exact.mean, exact.second_moment].into_iter().enumerate() {
                let [value, error] = found[k];
                let off = (value - exact.value).abs();
                assert!(
                    off <= error + exact.error && error < 4e-3 * exact.value,
                    "{technique} {kernel} {class} {k}: {value} ± {error}, {exact:?}"
                );
            }
        }
    }
}

/// Curved surfaces, flat water and photons of bundles: the brightest pixel of 8 × 8 against an interpolant of its points, each of
/// which is integrated over the kernel about it. What this catches: a Jacobian, a cosine, a weight or an inverse of the eye's way
/// that is wrong by 6 % (seen in a mirror or through water, 14 %). Nothing here is random: it passes or it does not.
#[test]
fn pixels_of_curved_scenes() {
    for (name, technique) in [
        ("pool", Technique::Camera),
        ("pool", Technique::Light),
        ("underwater", Technique::Camera),
        ("pillar", Technique::Symmetric),
        ("dome", Technique::Camera),
        ("glass-ball", Technique::Merge),
    ] {
        let mut scene = load(name);
        (scene.camera.width, scene.camera.height) = (8, 8);
        let kernel = technique.default_kernel();
        let frame = FrameExpectation::new(&scene, estimator(technique, kernel, &[0.25]), 1.0)
            .expect("a frame");
        let mut compared = 0;
        for (class, label) in frame.classes().into_iter().enumerate() {
            // Three interactions are a millionth of the light.
            if !frame.scatters(class) || label.light.len() > 2 {
                continue;
            }
            let points = 1 << 15;
            let aim = frame.aim(class);
            let sets: Vec<Vec<[f64; 2]>> = (0..SETS)
                .map(|set| {
                    let mut image = vec![[0.0; 2]; 64];
                    frame.scatter(class, &aim, set, 0..points, &mut image);
                    image
                })
                .collect();
            let count = f64::from(SETS);
            let pixel = |p: usize, k: usize| {
                let of = |s: &Vec<[f64; 2]>| s[p][k] / f64::from(points);
                let mean = sets.iter().map(of).sum::<f64>() / count;
                let squares: f64 = sets.iter().map(|s| (of(s) - mean) * (of(s) - mean)).sum();
                [mean, 4.5 * (squares / (count * (count - 1.0))).sqrt()]
            };
            let brightest = (0..64)
                .max_by(|&a, &b| pixel(a, 0)[0].total_cmp(&pixel(b, 0)[0]))
                .expect("a pixel");
            let (i, j) = (brightest as u32 % 8, brightest as u32 / 8);
            let exact = frame.region(class, i..i + 1, j..j + 1, 1e-2, [0.0, f64::INFINITY]);
            let allowed = if label.eye.is_empty() { 0.06 } else { 0.14 };
            for (k, exact) in [exact.mean, exact.second_moment].into_iter().enumerate() {
                let [value, error] = pixel(brightest, k);
                let off = (value - exact.value).abs();
                assert!(
                    off <= error + exact.error && error < allowed * value,
                    "{name} {technique} {label} {k}: {value} ± {error}, {exact:?}"
                );
            }
            compared += 1;
        }
        assert!(compared > 0, "{name}");
    }
}

/// As the radius shrinks, merging becomes the truth: whole images against closed forms integrated over pixels, which know nothing of
/// kernels and follow the eye's way in the other direction. A way of the eye that is not found (two merge at a fold) is light that is
/// missing here.
#[test]
fn a_small_radius_is_the_truth() {
    for name in [
        "mirror-wall",
        "pool",
        "cup",
        "pillar",
        "conic-wall",
        "glass-pillar",
        "corner",
        "dome",
        "ball",
        "dish",
        "hyperboloid",
        "underwater",
        "glass-ball",
        "lens",
        "slab",
        "cup-rim",
    ] {
        let mut scene = load(name);
        (scene.camera.width, scene.camera.height) = (16, 16);
        let technique = Technique::Merge;
        let frame = FrameExpectation::new(&scene, estimator(technique, Kernel::Disc, &[1e-3]), 1.0)
            .expect("a frame");
        let image = nephroid::truth::image(&scene, 1e-5);
        let classes = scene.kind.classes();
        for (class, label) in frame.classes().into_iter().enumerate() {
            if !frame.scatters(class) {
                continue;
            }
            let layer = classes.iter().position(|c| *c == label).expect("a class");
            let exact: f64 = image.layers[layer].iter().sum();
            let [[value, error], _] = sums(&frame, class, 1 << 15);
            let off = (value - exact).abs();
            // The eye's fold in the cup's wall makes the sum converge slowly.
            let sharp = if label.eye.is_empty() { 5e-3 } else { 0.02 };
            assert!(
                off <= error + 1e-3 * exact && error < sharp * exact,
                "{name} {label}: {value} ± {error}, {exact}"
            );
        }
    }
}
