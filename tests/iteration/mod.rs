//! One iteration of an integrator, from a fixed address of its random numbers.

use nephroid::film::Film;
use nephroid::integrators::Integrator;
use nephroid_analytic::scene::Entry;

/// A film for all of an entry's classes.
pub fn empty(entry: &Entry) -> Film {
    Film::new(
        entry.camera.width,
        entry.camera.height,
        entry.kind.classes(),
    )
}

/// The film of iteration 3 of seed 7.
pub fn one_iteration(
    integrator: &dyn Integrator,
    entry: &Entry,
    paths: u64,
    bandwidth: f64,
) -> Film {
    let mut film = empty(entry);
    integrator
        .prepare(entry)
        .iterate(7, 3, paths, bandwidth, &mut film);
    film
}
