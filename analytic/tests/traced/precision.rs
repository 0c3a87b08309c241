//! The error bounds hold: values in `f32` against `f64` at the same (exactly representable) parameters.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::conic_mirrors::{Ellipsoid, Hyperboloid};
use nephroid_analytic::kinds::glass_sphere::GlassSphere;
use nephroid_analytic::kinds::paraboloid::{Light, Paraboloid};
use nephroid_analytic::kinds::stigmatic_refractors::{Front, StigmaticRefractor};
use nephroid_analytic::kinds::water_waves::{WaterWaves, Wave};
use nephroid_analytic::scalar::Scalar;

use crate::tracing::Random;

/// One scene of a kind, from numbers in [0, 1) that `f32` holds exactly.
trait Scene {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S>;
}

/// Compares both precisions at random parameters; prints how much of the bound is used at worst, and its median in units
/// of rounding.
fn check(name: &str, trials: u32, seed: u64, scene: &impl Scene) {
    let mut r = Random(seed);
    let (mut compared, mut worst) = (0, 0.0_f64);
    let mut widths = vec![];
    for _ in 0..trials {
        let p: Vec<f32> = (0..16).map(|_| r.between(0.0, 1.0) as f32).collect();
        let exact: Vec<f64> = p.iter().map(|&v| f64::from(v)).collect();
        let (low, high) = (scene.value(&p), scene.value(&exact));
        let error = f64::from(low.error) + high.error;
        if !(high.value > 0.0) && low.value == 0.0 {
            continue;
        }
        let difference = (f64::from(low.value) - high.value).abs();
        assert!(
            difference <= error || !error.is_finite(),
            "{name} {p:?}: {low:?} {high:?}"
        );
        if error.is_finite() {
            compared += 1;
            worst = worst.max(difference / error);
            widths.push(error / high.value / f64::from(f32::EPSILON));
        }
    }
    widths.sort_by(f64::total_cmp);
    let median = widths[widths.len() / 2];
    println!(
        "{name}: {compared} compared, worst {worst:.3} of the bound, median bound {median:.0} units"
    );
    assert!(compared > trials / 4, "{name} {compared}");
    // Not a bound that nothing could violate.
    assert!(worst > 1e-3 && median < 3e3, "{name} {worst} {median}");
}

/// A parameter from low to high, rounded to `f32` in both precisions.
fn shared<S: Scalar>(t: S, low: f64, high: f64) -> S {
    let single = (low + t.to_f64() * (high - low)) as f32;
    S::from_f64(f64::from(single))
}

struct Dish(bool);
impl Scene for Dish {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S> {
        let light = if self.0 {
            Light::Beam(S::ONE)
        } else {
            Light::Focus(S::ONE)
        };
        Paraboloid {
            focal_length: shared(p[0], 0.5, 2.0),
            reflectance: S::from_f64(0.75),
            light,
            receiver_z: shared(p[1], 0.25, 4.0),
            inner_radius: S::ZERO,
            outer_radius: shared(p[2], 1.0, 4.0),
        }
        .caustic(shared(p[3], -1.0, 1.0), shared(p[4], -1.0, 1.0))
    }
}

struct Ellipse;
impl Scene for Ellipse {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S> {
        Ellipsoid {
            semi_axis: shared(p[0], 0.5, 2.0),
            eccentricity: shared(p[1], 0.0, 0.9375),
            defocus: shared(p[2], -0.5, 0.5),
            intensity: S::ONE,
            reflectance: S::from_f64(0.75),
        }
        .caustic(shared(p[3], -0.5, 0.5), shared(p[4], -0.5, 0.5))
    }
}

struct Hyperbola;
impl Scene for Hyperbola {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S> {
        Hyperboloid {
            semi_axis: shared(p[0], 0.5, 2.0),
            eccentricity: shared(p[1], 1.0625, 3.0),
            receiver_z: shared(p[2], -0.5, 2.0),
            intensity: S::ONE,
            reflectance: S::from_f64(0.75),
        }
        .caustic(shared(p[3], -1.0, 1.0), shared(p[4], -1.0, 1.0))
    }
}

struct Lens(bool);
impl Scene for Lens {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S> {
        let n = shared(p[0], 1.125, 2.0);
        let front = if self.0 {
            let d = shared(p[1], 1.0, 3.0);
            // Rounded once, in the wider precision, for both.
            let c = d.to_f64() * (1.0 + (n.to_f64() - 1.0) * (0.2 + 0.6 * p[5].to_f64()));
            Front::Oval {
                light_z: d,
                optical_length: S::from_f64(f64::from(c as f32)),
                intensity: S::ONE,
            }
        } else {
            Front::Ellipsoid {
                semi_axis: shared(p[1], 0.5, 2.0),
                irradiance: S::ONE,
            }
        };
        StigmaticRefractor {
            index: n,
            front,
            defocus: shared(p[2], -0.25, 0.5),
        }
        .caustic(shared(p[3], -0.125, 0.125), shared(p[4], -0.125, 0.125))
    }
}

fn ball<S: Scalar>(p: &[S]) -> GlassSphere<S> {
    let side = if p[4] > S::HALF { S::ONE } else { -S::ONE };
    GlassSphere {
        index: shared(p[0], 1.125, 2.25),
        radius: S::ONE,
        irradiance: S::ONE,
        receiver_z: side * shared(p[1], 1.0, 4.0),
        max_incidence: shared(p[2], 1.0, 1.5),
    }
}

struct Ball(u32);
impl Scene for Ball {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S> {
        ball(p).caustic(shared(p[3], 0.0, 1.5), self.0)
    }
}

/// Two waves, if they are flat enough.
fn waves<S: Scalar>(p: &[S]) -> Option<WaterWaves<S>> {
    let wave = |j: usize| Wave {
        amplitude: shared(p[j], 0.0, 0.03125),
        wave_number: shared(p[j + 1], 2.0, 10.0),
        phase: shared(p[j + 2], -1.0, 1.0),
    };
    let depth = shared(p[1], 1.0, 3.0);
    WaterWaves::new(
        shared(p[0], 1.25, 1.5),
        depth,
        S::ONE,
        vec![wave(3), wave(6)],
    )
    .ok()
}

struct Waves;
impl Scene for Waves {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S> {
        waves(p).map_or(Estimate::NONE, |w| w.caustic(shared(p[2], -1.0, 1.0)))
    }
}

/// 2^-k.
fn power_of_half(k: u32) -> f64 {
    (0..k).fold(1.0, |p, _| p * 0.5)
}

#[test]
fn bounds_hold_in_single_precision() {
    check("dish, beam", 20_000, 21, &Dish(true));
    check("dish, focus", 20_000, 22, &Dish(false));
    check("ellipsoid", 20_000, 23, &Ellipse);
    check("hyperboloid", 20_000, 24, &Hyperbola);
    check("stigmatic ellipsoid", 20_000, 25, &Lens(false));
    check("oval", 20_000, 26, &Lens(true));
    check("sphere, outside", 3000, 27, &Ball(1));
    check("sphere, two refractions", 3000, 28, &Ball(2));
    check("sphere, internal reflection", 3000, 29, &Ball(3));
    check("waves", 3000, 30, &Waves);
}

/// Towards a fold, where two roots become one and none, down to the last bit of single precision.
#[test]
fn bounds_hold_at_folds_in_single_precision() {
    let mut r = Random(31);
    let mut infinite = 0;
    let mut compare = |what: &str, low: Estimate<f32>, high: Estimate<f64>| {
        let error = f64::from(low.error) + high.error;
        let difference = (f64::from(low.value) - high.value).abs();
        infinite += u32::from(!error.is_finite());
        assert!(
            difference <= error || !error.is_finite(),
            "{what}: {low:?} {high:?}"
        );
    };
    for trial in 0..120 {
        let p: Vec<f32> = (0..16).map(|_| r.between(0.0, 1.0) as f32).collect();
        let exact: Vec<f64> = p.iter().map(|&v| f64::from(v)).collect();
        let m = 2 + trial % 3;
        let (low, high) = (ball::<f32>(&p), ball::<f64>(&exact));
        let mut folds = vec![];
        high.for_each_fold(m, |f| folds.push(f.radius));
        for fold in folds.iter().filter(|f| **f > 1e-3 && **f < 20.0) {
            for k in 6..26_u32 {
                for side in [-1.0, 1.0] {
                    let rho = (fold * (1.0 + side * power_of_half(k))) as f32;
                    let what = format!("sphere {p:?} m = {m} fold {fold} rho {rho}");
                    compare(&what, low.caustic(rho, m), high.caustic(f64::from(rho), m));
                }
            }
        }
        let (Some(low), Some(high)) = (waves::<f32>(&p), waves::<f64>(&exact)) else {
            continue;
        };
        let mut folds = vec![];
        high.for_each_fold(-1.0, 1.0, |f| folds.push(f.x));
        for fold in folds {
            for k in 6..26_u32 {
                for side in [-1.0, 1.0] {
                    let x = (fold + side * power_of_half(k)) as f32;
                    let what = format!("waves {p:?} fold {fold} x {x}");
                    compare(&what, low.caustic(x), high.caustic(f64::from(x)));
                }
            }
        }
    }
    assert!(infinite > 10, "{infinite}");
}
