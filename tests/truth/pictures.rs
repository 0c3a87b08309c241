//! The catalogue's pictures: exact in every pixel, wherever pixels are cut; the same bits for any number of threads; and
//! without what no radiance can stand for (the light itself, seen directly or by specular surfaces).

use nephroid::entry;
use nephroid::geometry::chains::Chains;
use nephroid::geometry::compiled::{Visitor, visit};
use nephroid::geometry::floor::Floor;
use nephroid::geometry::furnace::Furnace;
use nephroid::geometry::light::Light;
use nephroid::geometry::scene::{Overrides, Scene};
use nephroid::geometry::specular::Specular;
use nephroid::truth;
use nephroid_analytic::camera::Film;
use nephroid_analytic::scene::{
    CylinderCupScene, DiffuseScene, Entry, FlatInterfaceScene, Kind, PlanarMirrorScene,
};
use nephroid_analytic::vector::{Vec3, vec3};

/// A coarse image is the block mean of a fine one: pixels cut in different places must add up, within the error bounds.
/// A missed edge, fold or jump shows here.
#[test]
fn a_coarse_pixel_is_the_mean_of_the_fine_pixels_in_it() {
    const N: usize = 26;
    for name in entry::names() {
        let mut scene = entry::load(name).unwrap();
        let mut at_size = |size: usize, tolerance| {
            (scene.camera.width, scene.camera.height) = (size as u32, size as u32);
            truth::image(&scene, tolerance)
        };
        let (coarse, fine) = (at_size(N, 1e-8), at_size(3 * N, 1e-7));
        for (c, class) in coarse.classes.iter().enumerate() {
            let largest = coarse.layers[c].iter().fold(0.0_f64, |a, &b| a.max(b));
            assert!(largest > 0.0, "{name} {class} is empty");
            for p in 0..N * N {
                let (i, j) = (p % N, p / N);
                let block = (0..9).map(|k| (3 * j + k / 3) * 3 * N + 3 * i + k % 3);
                let mean = |layer: &[f64]| block.clone().map(|q| layer[q]).sum::<f64>() / 9.0;
                let difference = (coarse.layers[c][p] - mean(&fine.layers[c])).abs();
                let bound = coarse.errors[c][p] + mean(&fine.errors[c]);
                let shown = (coarse.layers[c][p], mean(&fine.layers[c]));
                assert!(
                    difference <= bound + 1e-13 * largest,
                    "{name} {class} ({i}, {j}): {shown:?} ± {bound:e}"
                );
                assert!(
                    difference <= 1e-8 * largest,
                    "{name} {class} ({i}, {j}): {shown:?}"
                );
            }
        }
    }
}

#[test]
fn default_tolerance_bounds_hold_and_are_small() {
    for name in entry::names() {
        let scene = entry::load(name).unwrap();
        let image = truth::image(&scene, truth::DEFAULT_TOLERANCE);
        for (class, mean) in image.classes.iter().zip(image.class_means()) {
            assert!(
                mean.value > 0.0 && mean.error <= 1e-6 * mean.value,
                "{name} {class} {mean:?}"
            );
        }
    }
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    for name in entry::names() {
        let mut scene = entry::load(name).unwrap();
        // Narrower than the entry's own frame: a wider one may show what validation refuses.
        (scene.camera.width, scene.camera.height) = (21, 33);
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| truth::image(&scene, 1e-6))
        };
        let one = with(1);
        for threads in [2, 7] {
            assert_eq!(one, with(threads), "{name}");
        }
    }
}

/// Whether a point, or what comes from a direction far away, falls into the frame.
fn in_frame(scene: &Entry, point: Vec3<f64>) -> bool {
    let film = Film::new(&scene.camera);
    let (w, h) = (
        f64::from(scene.camera.width),
        f64::from(scene.camera.height),
    );
    film.project(point)
        .is_some_and(|(u, v)| (0.0..=w).contains(&u) && (0.0..=h).contains(&v))
}

/// L S* E is a delta on the image: no radiance stands for it, so no picture may have one.
#[test]
fn no_light_is_in_a_frame_directly_or_by_a_specular_surface() {
    let mut checked = 0;
    for name in entry::names() {
        let scene = entry::load(name).unwrap();
        let eye = Vec3::from_f64(scene.camera.position);
        let mut seen = Vec::new();
        match &scene.kind {
            Kind::Diffuse(DiffuseScene { light, .. }) => seen.push(Vec3::from_f64(light.position)),
            Kind::PlanarMirror(PlanarMirrorScene { light, mirror, .. }) => {
                let y = Vec3::from_f64(light.position);
                let n = Vec3::from_f64(mirror.normal).normalized();
                let height = (y - Vec3::from_f64(mirror.center)).dot(n);
                seen.extend([y, y - n * (2.0 * height)]);
            }
            Kind::CylinderCup(CylinderCupScene { light, .. }) => {
                // The sun itself. By the wall it cannot be seen: that needs a ray that goes up after a reflection that
                // keeps its slope, and every ray to the wall goes down from a pinhole above it.
                let e = light.elevation_degrees.to_radians();
                seen.push(eye + vec3(-libm::cos(e), 0.0, libm::sin(e)));
            }
            Kind::FlatInterface(FlatInterfaceScene { light, water, .. }) => {
                let y = Vec3::from_f64(light.position);
                seen.extend([y, vec3(y.x, y.y, 2.0 * water.surface_z - y.z)]);
            }
            // Seen directly, with no specular surface in the frame.
            _ => seen.push(visit(&scene, Overrides::default(), NothingInTheWay(name))),
        }
        for point in seen {
            assert!(!in_frame(&scene, point), "{name} {point:?}");
            checked += 1;
        }
    }
    assert_eq!(checked, 6 + entry::names().count() - 4);
}

/// Checks that the camera sees the floor plane, or nothing, along every ray; gives a point in the direction of the light.
struct NothingInTheWay(&'static str);

impl Visitor for NothingInTheWay {
    type Output = Vec3<f64>;

    fn scene<L: Light, S: Specular>(self, _: Scene<L, S>) -> Vec3<f64> {
        panic!("kinds with surfaces in the frame have checks of their own")
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Vec3<f64> {
        const N: usize = 200;
        let (eye, (columns, rows)) = (scene.camera.position, scene.camera.size());
        for k in 0..N * N {
            let at = |n: usize, size: f64| size * n as f64 / (N - 1) as f64;
            let d = scene.camera.direction(at(k % N, columns), at(k / N, rows));
            let t = Floor::meet(eye, d).min(1e6);
            assert!(!scene.surface.blocks(eye, d, t), "{}: {d}", self.0);
        }
        let towards = eye + scene.light.towards(eye).0;
        vec3(towards.x, towards.y, towards.z)
    }

    fn furnace(self, scene: Furnace) -> Vec3<f64> {
        let p = scene.light.position;
        vec3(p.x, p.y, p.z)
    }
}

/// LDSSE would belong to the closure otherwise. Rays are continued in space until they meet the circle again.
#[test]
fn no_ray_of_the_cups_camera_meets_the_wall_twice() {
    let scene = entry::load("cup").unwrap();
    let Kind::CylinderCup(CylinderCupScene { wall, .. }) = &scene.kind else {
        panic!("the cup is a cup");
    };
    let film = Film::new(&scene.camera);
    let (a, end) = (
        wall.radius,
        wall.radius * libm::cos(wall.half_arc_degrees.to_radians()),
    );
    // Where a ray leaves the circle, and where that is.
    let leave = |p: Vec3<f64>, d: Vec3<f64>| {
        let (dd, pd) = (d.x * d.x + d.y * d.y, p.x * d.x + p.y * d.y);
        let rest = pd * pd - dd * (p.x * p.x + p.y * p.y - a * a);
        (rest > 0.0).then(|| p + d * ((rest.sqrt() - pd) / dd))
    };
    let on_wall = |q: &Vec3<f64>| q.x >= end && q.z >= 0.0 && q.z <= wall.height;
    let mut met = 0;
    for k in 0..400 * 400 {
        let at = |n: i32| f64::from(scene.camera.width) * (f64::from(n) + 0.5) / 400.0;
        let d = film.direction(at(k % 400), at(k / 400));
        if let Some(q) = leave(film.position, d).filter(on_wall) {
            met += 1;
            let n = vec3(q.x / a, q.y / a, 0.0);
            let r = d - n * (2.0 * d.dot(n));
            let again = leave(q + r * 1e-9, r).filter(on_wall);
            assert!(again.is_none(), "{q:?} {again:?}");
        }
    }
    assert!(met > 10_000, "{met}");
}
