//! Films bit by bit: the same on any number of threads, in any build, and at any bandwidth where nothing is regularized.

use nephroid::entry;
use nephroid::film::{Film, Layers};
use nephroid::integrators::accumulate::accumulate;
use nephroid::integrators::{Kernel, Settings, all, by_name};
use nephroid_analytic::scene::Entry;

use crate::iteration::{empty, one_iteration};

/// Scenes of this test alone, so that golden bits do not change with the catalogue's pictures.
const SCENES: [(&str, &str); 4] = [
    ("floor", include_str!("../scenes/floor.toml")),
    ("mirror-wall", include_str!("../scenes/mirror-wall.toml")),
    ("cup", include_str!("../scenes/cup.toml")),
    ("pool", include_str!("../scenes/pool.toml")),
];

fn load(scene: &str, width: u32, height: u32) -> Entry {
    let (_, text) = SCENES.iter().find(|(name, _)| *name == scene).unwrap();
    let mut entry = entry::from_toml(scene, text).unwrap();
    (entry.camera.width, entry.camera.height) = (width, height);
    entry
}

/// FNV-1a over the bits of everything in a film.
fn fingerprint(film: &Film) -> u64 {
    let values = film.layers.iter().flatten().map(|v| v.to_bits());
    let counts = film.nonzero.iter().copied().chain([film.paths]);
    values
        .chain(counts)
        .flat_map(u64::to_le_bytes)
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        })
}

/// The same bits as in `golden/films.txt`, which was written by a release build and holds for an unoptimised one: the
/// same test passes with `--release` and with `CARGO_PROFILE_TEST_OPT_LEVEL=0`.
#[test]
fn films_have_the_golden_bits() {
    let mut lines = String::new();
    for (scene, _) in SCENES {
        let entry = load(scene, 31, 23);
        for integrator in all() {
            for kernel in [None, Some(Kernel::Epanechnikov)] {
                let settings = Settings {
                    kernel,
                    fault: None,
                    ..Settings::default()
                };
                let integrator = by_name(integrator.name(), &settings).unwrap();
                let film = one_iteration(integrator.as_ref(), &entry, 20_000, 0.2);
                let kernel = kernel.map_or("default".to_owned(), |k| k.to_string());
                let name = integrator.name();
                lines += &format!("{scene} {name} {kernel} {:016x}\n", fingerprint(&film));
            }
        }
    }
    let golden = include_str!("../../golden/films.txt");
    assert!(lines == golden, "the films now have these bits:\n{lines}");
}

#[test]
fn threads_change_no_bit() {
    let entry = load("mirror-wall", 40, 30);
    for name in ["pt-reg", "lt", "ppm"] {
        let integrator = by_name(name, &Settings::default()).unwrap();
        let prepared = integrator.prepare(&entry);
        let schedule = integrator.schedule(0.2);
        let film_with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let mut film = empty(&entry);
            // 12 iterations, the last one shorter.
            pool.install(|| {
                accumulate(
                    prepared.as_ref(),
                    &schedule,
                    11,
                    115_000,
                    10_000,
                    &mut film,
                    |_| {},
                );
            });
            film
        };
        let one = film_with(1);
        assert_eq!(one.paths, 115_000);
        for threads in [2, 7] {
            assert!(one == film_with(threads), "{name}, {threads} threads");
        }
        // The same by hand: iterations in order, each at its bandwidth.
        let mut sum = empty(&entry);
        for iteration in 0..12 {
            let mut film = empty(&entry);
            let paths = if iteration < 11 { 10_000 } else { 5_000 };
            prepared.iterate(
                11,
                iteration,
                paths,
                schedule.bandwidth(iteration),
                &mut film,
            );
            sum.add(&film);
        }
        assert!(one == sum, "{name}");
    }
}

#[test]
fn seeds_and_iterations_are_different_streams() {
    let entry = load("floor", 8, 8);
    let prepared = by_name("pt", &Settings::default()).unwrap().prepare(&entry);
    let film = |seed, iteration| {
        let mut film = empty(&entry);
        prepared.iterate(seed, iteration, 1000, 0.0, &mut film);
        film
    };
    let first = film(1, 0);
    assert!(first == film(1, 0));
    for other in [film(2, 0), film(1, 1), film(1 + (1 << 32), 0)] {
        assert!(first.layers != other.layers);
    }
}

#[test]
fn without_a_specular_surface_no_bandwidth_changes_a_bit() {
    let entry = load("floor", 64, 48);
    let reference = one_iteration(
        by_name("pt", &Settings::default()).unwrap().as_ref(),
        &entry,
        50_000,
        0.0,
    );
    assert!(reference.nonzero[0] > 10_000);
    for name in ["pt-reg", "pm", "ppm"] {
        let integrator = by_name(name, &Settings::default()).unwrap();
        for bandwidth in [1e-6, 0.01, 0.2, 3.0] {
            let film = one_iteration(integrator.as_ref(), &entry, 50_000, bandwidth);
            assert!(film == reference, "{name} at {bandwidth}");
        }
    }
}

/// A layer that nobody reads may stay empty, and the others do not know: so a test of a rare class skips the paths of the rest.
#[test]
fn layers_that_are_not_read_change_no_bit_of_the_others() {
    let mut skipped = 0;
    for name in ["mirror-wall", "cup", "corner", "deep-cup"] {
        let mut entry = entry::load(name).unwrap();
        (entry.camera.width, entry.camera.height) = (31, 23);
        for integrator in all() {
            if integrator.supports(&entry).is_err() {
                continue;
            }
            let prepared = integrator.prepare(&entry);
            let draw = |film: Film| {
                let mut film = film;
                prepared.iterate(7, 3, 3000, 0.3, &mut film);
                film
            };
            let whole = draw(empty(&entry));
            for kept in 0..whole.layers.len() {
                let unread: Layers = (0..whole.layers.len()).filter(|&l| l != kept).collect();
                let film = draw(empty(&entry).without(unread));
                let integrator = integrator.name();
                assert!(
                    film.layers[kept] == whole.layers[kept]
                        && film.nonzero[kept] == whole.nonzero[kept]
                        && film.paths == whole.paths,
                    "{name} {integrator} {kept}"
                );
                skipped += film.nonzero.iter().filter(|&&n| n == 0).count();
            }
        }
    }
    assert!(skipped > 100, "nothing is ever left out: {skipped}");
}
