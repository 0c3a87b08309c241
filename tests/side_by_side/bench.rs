//! `nephroid bench`: errors that do not depend on the machine, and laws that they must obey.

use nephroid::bench::{Subject, plot, run};
use nephroid::entry;
use nephroid::integrators::{Settings, by_name};
use nephroid_analytic::class::PathClass;

/// The error of an unbiased method halves with twice the paths, and is the same when run again; the picture is well formed. The
/// variance of 16 384 pixels and 8 replicates is known to about 1 %: 10 % is beyond ten standard errors.
#[test]
fn errors_are_reproducible_and_fall_as_they_should() {
    let mut entry = entry::load("mirror-wall").unwrap();
    (entry.camera.width, entry.camera.height) = (48, 48);
    let subject = Subject::new(entry);
    let lt = by_name("lt", &Settings::default()).unwrap();
    let result = run(&subject, lt.as_ref(), 3).unwrap();
    let again = run(&subject, lt.as_ref(), 3).unwrap();
    assert_eq!(result.crossed, 0);
    assert!(result.mpaths_per_cpu_s > 0.0);
    let classes: Vec<PathClass> = result.classes.iter().map(|c| c.class).collect();
    assert_eq!(classes, [PathClass::LDE, PathClass::LSDE]);
    for (class, other) in result.classes.iter().zip(&again.classes) {
        assert_eq!(class.curves.len(), 1);
        let checkpoints = &class.curves[0].checkpoints;
        assert_eq!(checkpoints, &other.curves[0].checkpoints);
        for pair in checkpoints.windows(2) {
            let ratio = pair[0].error / pair[1].error;
            assert!((ratio / 2.0 - 1.0).abs() < 0.1, "{ratio}");
            assert!((pair[0].variance / pair[0].error - 1.0).abs() < 0.1);
        }
        assert!(class.reached.seconds().unwrap() > 0.0);
    }
    let svg = plot::svg(&[result, again]);
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
    // Two panels, two curves each.
    assert_eq!(svg.matches("stroke-width=\"1.8\"").count(), 4);
    // Nothing to run: no class is sampled.
    let pool = Subject::new(entry::load("floor").unwrap());
    assert!(run(&pool, lt.as_ref(), 3).is_some());
}
