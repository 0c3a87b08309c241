//! Folds: roots come and go in pairs.

use nephroid_analytic::entries::PointTruth;
use nephroid_analytic::kinds::singularity::SingularityKind;

use crate::varied::{catalogue, truth};

/// Two roots appear or vanish together across a fold. Across a shadow edge, which is no singularity, it may be one.
#[test]
fn the_number_of_roots_changes_by_two_across_a_fold() {
    let mut folds = 0;
    for (name, entry) in catalogue() {
        let truth = truth(&entry).unwrap();
        let at = |s: f64, t: f64| {
            let point = |axis: usize, s: f64| {
                let [low, high] = truth.range(axis);
                low + (high - low) * s
            };
            (point(0, s), point(1, t))
        };
        let lines = [0.137, 0.291, 0.418, 0.503, 0.632, 0.779];
        for (t, across) in lines.into_iter().flat_map(|t| [(t, false), (t, true)]) {
            let place = |s: f64| if across { at(t, s) } else { at(s, t) };
            let along = |s: f64| {
                let (x, y) = place(s);
                truth.at(x, y)
            };
            let steps = 96;
            for k in 0..steps {
                let (a, b) = (
                    f64::from(k) / f64::from(steps),
                    f64::from(k + 1) / f64::from(steps),
                );
                let (first, last) = (along(a), along(b));
                for c in 0..first.len() {
                    let roots = |p: &[PointTruth]| p[c].irradiance.roots;
                    if roots(&first) == roots(&last) {
                        continue;
                    }
                    // Bisection to a change between neighbours 1e-9 apart.
                    let (mut low, mut high) = (a, b);
                    for _ in 0..24 {
                        let middle = 0.5 * (low + high);
                        if roots(&along(middle)) == roots(&first) {
                            low = middle;
                        } else {
                            high = middle;
                        }
                    }
                    let (p, q) = (along(low)[c], along(high)[c]);
                    let near = [low, high]
                        .into_iter()
                        .filter_map(|s| {
                            let (x, y) = place(s);
                            truth.singularity(x, y, c)
                        })
                        .any(|s| s.kind == SingularityKind::Fold && s.distance < 1e-6);
                    let change = p.irradiance.roots.abs_diff(q.irradiance.roots);
                    if near {
                        folds += 1;
                        assert_eq!(change, 2, "{name} {} {p:?} {q:?}", p.class);
                    } else {
                        // A shadow edge takes whole branches with it; the irradiance stays finite.
                        let larger = p.irradiance.value.max(q.irradiance.value);
                        assert!(larger.is_finite() && larger < 1e4, "{name} {p:?} {q:?}");
                    }
                }
            }
        }
    }
    assert!(folds >= 3, "{folds}");
}
