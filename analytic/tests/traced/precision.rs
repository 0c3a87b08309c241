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

/// How often the bound was used up to which part, and how much larger than the difference it is at worst.
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

fn between<S: Scalar>(t: S, low: f64, high: f64) -> S {
    // Sixteenths: the bounds are exact, and both precisions see the same rounding of the parameter or none.
    S::from_f64(low) + t * S::from_f64(high - low)
}

/// The parameter as the `f32` that both precisions start from.
fn shared<S: Scalar>(t: S, low: f64, high: f64) -> S {
    let single = between(t.to_f64() as f32, low, high);
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

struct Ball(u32);
impl Scene for Ball {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S> {
        let side = if p[4] > S::HALF { S::ONE } else { -S::ONE };
        GlassSphere {
            index: shared(p[0], 1.125, 2.25),
            radius: S::ONE,
            irradiance: S::ONE,
            receiver_z: side * shared(p[1], 1.0, 4.0),
            max_incidence: shared(p[2], 1.0, 1.5),
        }
        .caustic(shared(p[3], 0.0, 1.5), self.0)
    }
}

struct Waves;
impl Scene for Waves {
    fn value<S: Scalar>(&self, p: &[S]) -> Estimate<S> {
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
        .map_or(Estimate::NONE, |w| w.caustic(shared(p[2], -1.0, 1.0)))
    }
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
