//! Vertex connection and merging: full merging against its own expectation, selective merging against connection and merging.

use nephroid::integrators::vcm::Merging;
use nephroid::integrators::{Fault, Run, Settings, by_name};
use nephroid::regions::Regions;
use nephroid::{connected_and_merged, entry, expectation, film::Film, truth};
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::class::PathClass;

use crate::{class_means, of};

/// A radius at which connections and merges share, and one that is wide.
#[test]
fn full_merging_has_the_weighted_expectation() {
    for name in ["mirror-wall", "floor"] {
        let scene = entry::load(name).unwrap();
        let exact = truth::image(&scene, 1e-5);
        let regions = Regions::image(scene.camera.width, scene.camera.height);
        for r in [0.02, 0.2] {
            let found = class_means("vcm", &Settings::default(), &scene, 1, 40_000, r);
            let expected = connected_and_merged::area_means(
                &scene,
                Kernel::Disc,
                &[r],
                1e-4,
                &regions,
                &exact,
            )
            .unwrap();
            for (class, areas) in expected {
                let what = format!("{name} vcm {r} {class}");
                of(&found, class).check(&what, areas[0].value, areas[0].error, 0.05);
            }
            if name == "mirror-wall" {
                let merged =
                    expectation::class_means(&scene, Technique::Merge, Kernel::Disc, &[r], 1e-4)
                        .unwrap();
                let (class, m) = &merged[1];
                assert_eq!(*class, PathClass::LSDSE);
                let what = format!("vcm {r} {class}");
                of(&found, *class).check(&what, m.mean.value, m.mean.error, 0.2);
            }
        }
    }
}

#[test]
fn selective_merging_changes_no_bit_of_what_connections_sample() {
    let mut scene = entry::load("mirror-wall").unwrap();
    (scene.camera.width, scene.camera.height) = (40, 30);
    let film = |merging: Merging, r: f64| {
        let settings = Settings {
            merging,
            ..Settings::default()
        };
        let prepared = by_name("vcm", &settings).unwrap().prepare(&scene);
        let mut film = Film::new(40, 30, scene.kind.classes());
        Run::of(prepared.as_ref()).iterate(3, 0, 40_000, r, &mut film);
        film
    };
    let none = film(Merging::None, 0.2);
    for r in [0.2, 0.05] {
        let selective = film(Merging::Selective, r);
        for (k, class) in scene.kind.classes().iter().enumerate() {
            let same = selective.layers[k] == none.layers[k];
            let merged = *class == PathClass::LSDSE;
            assert_eq!(same, !merged, "{class}");
            let any = none.layers[k].iter().any(|v| *v > 0.0);
            assert_eq!(any, !merged, "{class}");
        }
    }
}

/// LSDSE is merging alone in expectation; what connections sample is the closed form, also where light takes chains.
#[test]
fn selective_merging_has_the_means_of_its_parts() {
    let settings = Settings {
        merging: Merging::Selective,
        ..Settings::default()
    };
    for name in ["mirror-wall", "dome", "glass-pillar", "slab"] {
        let scene = entry::load(name).unwrap();
        let exact = truth::image(&scene, 1e-4);
        let found = class_means("vcm", &settings, &scene, 1, 30_000, 0.2);
        for (class, m) in scene.kind.classes().iter().zip(exact.class_means()) {
            if !class.light.is_empty() && !class.eye.is_empty() {
                continue;
            }
            // Faint classes get too few paths here.
            if m.value < 2e-2 * exact.class_means().iter().map(|m| m.value).sum::<f64>() {
                continue;
            }
            let what = format!("{name} vcm selective {class}");
            of(&found, *class).check(&what, m.value, m.error, 0.1);
        }
        if name == "mirror-wall" {
            let m = expectation::class_means(&scene, Technique::Merge, Kernel::Disc, &[0.2], 1e-4);
            let (class, m) = m.unwrap()[1];
            of(&found, class).check("vcm selective LSDSE", m.mean.value, m.mean.error, 0.15);
        }
    }
}

/// What the test above is worth: faults of the weights are far outside of what it allows.
#[test]
fn faults_of_the_weights_are_noticed() {
    let scene = entry::load("mirror-wall").unwrap();
    let exact = truth::image(&scene, 1e-5);
    let regions = Regions::image(scene.camera.width, scene.camera.height);
    let r = 0.02;
    let expected =
        connected_and_merged::area_means(&scene, Kernel::Disc, &[r], 1e-4, &regions, &exact)
            .unwrap();
    for fault in [
        Fault::MergingWeightByRadius,
        Fault::ConnectedAndMerged,
        Fault::BidirectionalWeightOnMerges,
        Fault::MergesByNominalCount,
    ] {
        let settings = Settings {
            fault: Some(fault),
            ..Settings::default()
        };
        let found = class_means("vcm", &settings, &scene, 1, 20_000, r);
        let worst = expected
            .iter()
            .map(|(class, areas)| of(&found, *class).t(areas[0].value).abs())
            .fold(0.0, f64::max);
        assert!(worst > 20.0, "{fault:?}: {worst}");
    }
}
