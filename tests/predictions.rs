//! Regularized estimators at probes against their exact expectation at finite bandwidth: two programs that share no code.
//! `examples/predictions.rs` does the same at more bandwidths, to half a percent.
//!
//! Each comparison has a false-alarm probability below 1e-6 (4.9 standard errors of about 2.6·10⁵ aimed samples); a bias of the mean of
//! 2 % is caught with near certainty, and the bias of the bandwidth itself is several times that on most lines.

use nephroid::entry;
use nephroid::integrators::Kernel as Shape;
use nephroid::integrators::probes::{Estimator as Sampler, Technique as Side};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{Convention, Technique};
use nephroid_analytic::entries::FloorTruth;

#[test]
fn means_and_second_moments_are_as_predicted() {
    let mut biased = 0;
    for (name, x) in [
        ("mirror-wall", [0.3, 0.12]),
        ("cup", [0.96, 0.136]),
        ("pillar", [-0.812, -0.978]),
        ("pool", [0.104, 0.045]),
        ("dome", [-1.2, -0.41]),
        ("ripple-pool", [0.17, 0.064]),
    ] {
        let scene = entry::load(name).expect("a catalogue entry");
        let light = FloorTruth::new(&scene).expect("a floor").at(x[0], x[1]);
        for (technique, side, shape) in [
            (Technique::Camera, Side::Camera, Shape::Cone),
            (Technique::Merge, Side::Merge, Shape::Disc),
        ] {
            for bandwidth in [0.3, 0.1] {
                let sampler = Sampler::new(&scene, side, shape, None).expect("an estimator");
                let estimator = Estimator {
                    technique,
                    kernel: technique.default_kernel(),
                    convention: Convention::Exact,
                    bandwidths: &[bandwidth],
                };
                let exact = EntryExpectation::new(&scene, estimator, 1.0).expect("an expectation");
                let m = exact.at(x[0], x[1], 1e-6)[0];
                let aim = sampler.aim(bandwidth, x).expect("an aim");
                let sums = sampler
                    .run_aimed(7, 0, 1 << 18, bandwidth, x, &aim)
                    .expect("samples")
                    .swap_remove(0);
                let place = format!("{name} {technique} {bandwidth}");
                let (mean, error) = (m.mean.value, sums.standard_error());
                let off = f64::abs(sums.mean() - mean);
                assert!(
                    error < 0.004 * mean,
                    "{place}: too few samples, {error} of {mean}"
                );
                assert!(
                    off <= 4.9 * error + m.mean.error,
                    "{place}: {} {mean} ± {error}",
                    sums.mean()
                );
                // Second moments of photons of parallel light depend on the beam that is sampled.
                if technique == Technique::Camera {
                    let second = sums.second_moment() / aim.share(0) / m.second_moment.value;
                    assert!(f64::abs(second - 1.0) < 0.05, "{place}: {second}");
                }
                let limit = light
                    .iter()
                    .find(|t| t.class == exact.classes()[0])
                    .map_or(0.0, |t| t.irradiance.value);
                biased += usize::from(f64::abs(limit - mean) > 0.01 * mean);
            }
        }
    }
    assert!(
        biased >= 10,
        "only {biased} expectations differ from the limit by more than 1 %"
    );
}
