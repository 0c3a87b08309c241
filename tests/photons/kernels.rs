//! Every kernel on a distance: mean of the image, mean and second moment at points, against the truth's own kernels.

use nephroid::integrators::probes::{Estimator as Sampler, Technique as Side};
use nephroid::integrators::{Kernel as Shape, Settings};
use nephroid::{entry, expectation};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};

use crate::{Replicates, class_means, of};

const KERNELS: [(Shape, Kernel); 4] = [
    (Shape::Disc, Kernel::Disc),
    (Shape::Epanechnikov, Kernel::Epanechnikov),
    (Shape::Biweight, Kernel::Biweight),
    (Shape::Cone, Kernel::Cone),
];

/// Kernels differ by a tenth or more in their second moments.
#[test]
fn mean_and_second_moment_at_a_point() {
    let scene = entry::load("mirror-wall").unwrap();
    let x = [0.3, 0.12];
    for (shape, kernel) in KERNELS {
        for r in [0.3, 0.05] {
            let sampler = Sampler::new(&scene, Side::Merge, shape, None).unwrap();
            let estimator = Estimator {
                technique: Technique::Merge,
                kernel,
                convention: Convention::Exact,
                bandwidths: &[r],
            };
            let exact = EntryExpectation::new(&scene, estimator, 1.0).unwrap();
            let m = exact.at(x[0], x[1], 1e-8)[0];
            let aim = sampler.aim(r, x).unwrap();
            let (mut means, mut seconds) = (vec![], vec![]);
            for seed in 0..32 {
                let sums = sampler
                    .run_aimed(seed, 0, 1 << 12, r, x, &aim)
                    .unwrap()
                    .swap_remove(0);
                means.push(sums.mean());
                seconds.push(sums.second_moment() / aim.share(0));
            }
            let what = format!("{shape} {r}");
            Replicates(means).check(&what, m.mean.value, m.mean.error, 0.03);
            let second = m.second_moment;
            Replicates(seconds).check(
                &format!("{what} second moment"),
                second.value,
                second.error,
                0.05,
            );
        }
    }
}

#[test]
fn means_of_the_image() {
    let scene = entry::load("mirror-wall").unwrap();
    for (shape, kernel) in &KERNELS[1..] {
        let settings = Settings {
            kernel: Some(*shape),
            ..Settings::default()
        };
        let found = class_means("pm", &settings, &scene, 1, 60_000, 0.4);
        let merge = Technique::Merge;
        for (class, m) in expectation::class_means(&scene, merge, *kernel, &[0.4], 1e-4).unwrap() {
            let what = format!("pm {shape} {class}");
            of(&found, class).check(&what, m.mean.value, m.mean.error, 0.06);
        }
    }
}
