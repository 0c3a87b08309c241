//! Selected bandwidths against exact hit probabilities and exact optima.

use libm::log;
use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::selection::{PILOTS, Selection, Selector, accumulate_selected};
use nephroid::integrators::{Settings, by_name};
use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::optimum::{Study, fixed};
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};
use nephroid_analytic::class::PathClass;

use crate::close_up;

const POINT: [f64; 2] = [0.3, 0.12];

/// Paths of the preview's run miss with the probability that was asked for: N p is -ln ε to 10 %, of which 3 % are the pilots' noise (some thousand hits)
/// at one standard deviation.
#[test]
fn a_preview_misses_as_often_as_it_may() {
    let scene = close_up(&entry::load("mirror-wall").unwrap(), POINT, 1.0, 1);
    let prepared = by_name("pt-reg", &Settings::default())
        .unwrap()
        .prepare(&scene);
    let mut film = Film::new(1, 1, scene.kind.classes());
    let layer = film.layer_of(PathClass::LSDE).unwrap();
    let (miss, paths) = (1e-3, 200_000);
    let selection = Selection::Preview { miss };
    let mut selector = Selector::new(selection, 0.2, 2.0, paths, 1, vec![layer]);
    let used = accumulate_selected(prepared.as_ref(), &mut selector, 5, paths, 20_000, &mut film);
    assert_eq!(used[0], 0.2);
    let chosen = selector.bandwidth();
    let exact =
        FilmExpectation::new(&scene, Technique::Camera, Kernel::Cone, &[chosen]).unwrap();
    let point = exact.at(PathClass::LSDE, 0.5, 0.5, 1e-6).unwrap();
    let p = point.hit_probability.unwrap().value;
    let ratio = paths as f64 * p / -log(miss);
    println!("preview {chosen:.3e} rad: N p is {ratio:.3} of what is needed");
    assert!((ratio - 1.0).abs() < 0.1);
}

/// The estimated optimum costs at most a fifth more than the exact one (exact bias and variance at both).
#[test]
fn an_estimated_optimum_is_near_the_exact_one() {
    let scene = close_up(&entry::load("mirror-wall").unwrap(), POINT, 1.0, 4);
    let study = Study::new(
        &scene,
        Technique::Merge,
        Kernel::Disc,
        Convention::Exact,
        1.0,
    )
    .unwrap();
    let curve = study.curve(0, POINT).unwrap();
    let prepared = by_name("pm", &Settings::default()).unwrap().prepare(&scene);
    let paths = 3_000_000;
    let best = fixed(&[&curve], paths as f64).unwrap();
    for seed in 0..3 {
        let mut film = Film::new(4, 4, scene.kind.classes());
        let layer = film.layer_of(PathClass::LSDE).unwrap();
        let mut selector =
            Selector::new(Selection::Optimum, 1.0, 2.0, paths, 16, vec![layer]);
        let used =
            accumulate_selected(prepared.as_ref(), &mut selector, seed, paths, 100_000, &mut film);
        let pilots = PILOTS as usize;
        assert!(used[..pilots].iter().all(|b| *b == 1.0 || *b == 0.5));
        let chosen = selector.bandwidth();
        let e = curve.at(chosen);
        let error = (e.bias * e.bias + e.variance / paths as f64).sqrt();
        println!(
            "seed {seed}: {chosen:.3} m for {:.3} m, error {:.3} times the least",
            best.bandwidth,
            error / best.rmse
        );
        assert!(error < 1.2 * best.rmse);
    }
}
