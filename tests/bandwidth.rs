//! Finite bandwidth from outside: the reference table through `evaluate`, and class means of whole images.

use nephroid::expectation::class_means;
use nephroid::{entry, evaluate};
use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::class::PathClass;

const TABLE: &str = include_str!("../golden/reference/bandwidth-planar-mirror.json");

#[test]
fn evaluate_meets_the_reference_table() {
    let report = evaluate::evaluate("table", TABLE).unwrap();
    let (mut means, mut seconds) = (0, 0);
    for placed in report.rows() {
        let Some(difference) = placed.row.relative_difference else {
            continue;
        };
        // Down to the last digit written: 10 digits for the two-component `linked` entries, 12 for `symmetric`.
        assert!(placed.row.passes(1e-12), "{placed:?}");
        if placed.row.key.ends_with(".E") {
            means += 1;
            assert!(difference <= 1e-9, "{placed:?}");
        } else {
            seconds += 1;
            assert!(difference <= 1e-6, "{placed:?}");
        }
    }
    assert_eq!((means, seconds), (368, 356));
}

#[test]
fn evaluate_notices_a_wrong_value_and_refuses_what_it_cannot_read() {
    let wrong = TABLE.replacen("0.57418061540191223", "0.57418061541191223", 1);
    assert_ne!(wrong, TABLE);
    let report = evaluate::evaluate("table", &wrong).unwrap();
    assert!(report.rows().any(|p| !p.row.passes(1e-12)));
    for (from, to) in [
        ("\"camera\",", "\"camera-side\","),
        ("\"kernel\": \"cone\"", "\"kernel\": \"disc\""),
        ("\"0.30000000000000000000\"", "\"-0.3\""),
        ("\"0.30000000000000000000\"", "\"nan\""),
    ] {
        let broken = TABLE.replacen(from, to, 1);
        assert_ne!(broken, TABLE, "{from}");
        assert!(evaluate::evaluate("table", &broken).is_err(), "{to}");
    }
}

#[test]
fn whole_image_means_are_the_sum_of_the_pixels() {
    let mut mirror_wall = entry::load("mirror-wall").unwrap();
    (mirror_wall.camera.width, mirror_wall.camera.height) = (32, 32);
    for (technique, kernel) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Merge, Kernel::Disc),
    ] {
        let schedule = [0.2, 0.15];
        let means = class_means(&mirror_wall, technique, kernel, &schedule, 1e-4).unwrap();
        let film = FilmExpectation::new(&mirror_wall, technique, kernel, &schedule).unwrap();
        let mut sums = [[0.0; 4]; 2];
        for j in 0..32 {
            for (sum, row) in sums.iter_mut().zip(film.row(j, 1e-3)) {
                for m in row {
                    let parts = [m.mean, m.second_moment];
                    for (k, b) in parts.into_iter().enumerate() {
                        sum[2 * k] += b.value / 1024.0;
                        sum[2 * k + 1] += b.error / 1024.0;
                    }
                }
            }
        }
        let classes = [PathClass::LSDE, PathClass::LSDSE];
        for ((class, m), (expected, sum)) in means.iter().zip(classes.iter().zip(sums)) {
            assert_eq!(class, expected);
            for (k, b) in [m.mean, m.second_moment].into_iter().enumerate() {
                let off = (b.value - sum[2 * k]).abs();
                assert!(
                    off <= b.error + sum[2 * k + 1],
                    "{technique} {class} {off:e} {b:?}"
                );
                assert!(b.error <= 1e-4 * b.value, "{technique} {class} {b:?}");
            }
        }
    }
}

#[test]
fn class_means_have_the_same_bits_for_any_number_of_threads() {
    let mut mirror_wall = entry::load("mirror-wall").unwrap();
    (mirror_wall.camera.width, mirror_wall.camera.height) = (24, 24);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            class_means(&mirror_wall, Technique::Camera, Kernel::Cone, &[0.2], 1e-3).unwrap()
        })
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(7));
    let floor = entry::load("floor").unwrap();
    let none = class_means(&floor, Technique::Merge, Kernel::Disc, &[0.2], 1e-3).unwrap();
    assert!(none.is_empty());
    let cup = entry::load("cup").unwrap();
    assert!(class_means(&cup, Technique::Merge, Kernel::Disc, &[0.2], 1e-3).is_err());
}
