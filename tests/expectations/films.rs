//! Finite bandwidth from outside: the reference table through `evaluate`, and class means of whole images.

use nephroid::expectation::{area_moments, class_means};
use nephroid::regions::Regions;
use nephroid::{entry, evaluate};
use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::class::PathClass;

const TABLE: &str = include_str!("../../golden/reference/bandwidth-planar-mirror.json");

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

/// The image, its tiles, and a mask of which neighbouring rows do not fit into rectangles: the means over each are those of its pixels.
#[test]
fn means_over_areas_are_those_of_their_pixels() {
    const SIDE: u32 = 32;
    let mut mirror_wall = entry::load("mirror-wall").unwrap();
    (mirror_wall.camera.width, mirror_wall.camera.height) = (SIDE, SIDE);
    let ragged: Vec<bool> = (0..SIDE * SIDE)
        .map(|k| k % SIDE > 10 + (k / SIDE) % 3 || k / SIDE == 20)
        .collect();
    for (technique, kernel) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Merge, Kernel::Disc),
    ] {
        let schedule = [0.2, 0.15];
        let film = FilmExpectation::new(&mirror_wall, technique, kernel, &schedule).unwrap();
        // Per class and moment: values and bounds of the pixels.
        let mut pixels = vec![vec![[Vec::new(), Vec::new()]; 2]; 2];
        for j in 0..SIDE {
            for (class, row) in pixels.iter_mut().zip(film.row(j, 1e-3)) {
                for m in row {
                    for (moment, b) in class.iter_mut().zip([m.mean, m.second_moment]) {
                        moment[0].push(b.value);
                        moment[1].push(b.error);
                    }
                }
            }
        }
        let classes = [PathClass::LSDE, PathClass::LSDSE];
        for regions in [
            Regions::quadtree(SIDE, SIDE),
            Regions::mask(SIDE, SIDE, &ragged).unwrap(),
        ] {
            let moments = |tolerance: [f64; 2]| {
                let (wall, schedule) = (&mirror_wall, &schedule);
                area_moments(wall, technique, kernel, schedule, tolerance, &regions).unwrap()
            };
            let found = moments([1e-4; 2]);
            assert_eq!(found.iter().map(|f| f.0).collect::<Vec<_>>(), classes);
            let first_only = moments([1e-4, f64::INFINITY]);
            for (c, (class, areas)) in found.iter().enumerate() {
                let sums = |moment: usize, what: usize| regions.reduce(&pixels[c][moment][what]);
                for (a, m) in areas.iter().enumerate() {
                    for (k, b) in [m.mean, m.second_moment].into_iter().enumerate() {
                        let count = regions.pixels()[a] as f64;
                        let [value, bound] = [0, 1].map(|what| sums(k, what)[a].0 / count);
                        let off = (b.value - value).abs();
                        let where_ = &regions.areas()[a];
                        assert!(
                            off <= b.error + bound,
                            "{technique} {class} {where_} {off:e} {b:?}"
                        );
                    }
                    // What is not asked for does not change what is.
                    let off = (first_only[c].1[a].mean.value - m.mean.value).abs();
                    assert!(off <= first_only[c].1[a].mean.error + m.mean.error);
                }
                for b in [areas[0].mean, areas[0].second_moment] {
                    assert!(b.error <= 1e-4 * b.value, "{technique} {class} {b:?}");
                }
                let b = first_only[c].1[0].mean;
                assert!(b.error <= 1e-4 * b.value, "{technique} {class} {b:?}");
            }
        }
        let means = class_means(&mirror_wall, technique, kernel, &schedule, 1e-4).unwrap();
        for ((class, m), pixels) in means.iter().zip(&pixels) {
            let mean = pixels[0][0].iter().sum::<f64>() / f64::from(SIDE * SIDE);
            assert!(
                (m.mean.value / mean - 1.0).abs() < 2e-3,
                "{technique} {class}"
            );
        }
    }
}

#[test]
fn a_long_schedule_is_the_average_of_its_bandwidths() {
    let mut mirror_wall = entry::load("mirror-wall").unwrap();
    (mirror_wall.camera.width, mirror_wall.camera.height) = (16, 16);
    for (technique, kernel, n, tolerance) in [
        (Technique::Merge, Kernel::Disc, 8_i32, 1e-3),
        (Technique::Camera, Kernel::Cone, 8, 1e-3),
    ] {
        // From 0.4 down to 0.13: what some eight hundred iterations of a progressive radius reach.
        let schedule: Vec<f64> = (1..=n)
            .map(|i| 0.4 * libm::pow(f64::from(i), -0.55))
            .collect();
        let run = |b: &[f64]| class_means(&mirror_wall, technique, kernel, b, tolerance).unwrap();
        let together = run(&schedule);
        let single: Vec<_> = schedule.iter().map(|b| run(&[*b])).collect();
        for (c, (class, m)) in together.iter().enumerate() {
            for (k, got) in [m.mean, m.second_moment].into_iter().enumerate() {
                let (mut sum, mut bound) = (0.0, 0.0);
                for one in &single {
                    let b = [one[c].1.mean, one[c].1.second_moment][k];
                    sum += b.value / f64::from(n);
                    bound += b.error / f64::from(n);
                }
                let off = (got.value - sum).abs();
                assert!(
                    off <= got.error + bound,
                    "{technique} {class} {k} {off:e} {got:?}"
                );
                assert!(
                    got.error <= 10.0 * tolerance * sum,
                    "{technique} {class} {k} {got:?}"
                );
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
    let furnace = entry::load("furnace").unwrap();
    assert!(class_means(&furnace, Technique::Merge, Kernel::Disc, &[0.2], 1e-3).is_err());
}
