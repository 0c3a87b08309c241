//! The formulas in single precision against double: they agree to the single-precision error bound, which must therefore
//! be honest, also near folds, cusps and shadow edges.

use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{Beam, CylinderCup, Light, Wall};
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::planar_mirror::{PlanarMirror, Rectangle};
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::Vec3;

/// How often each outcome was seen.
#[derive(Default, Debug)]
struct Tally {
    compared: u32,
    unbounded: u32,
    /// Largest difference over bound.
    tightest: f64,
}

impl Tally {
    fn check(&mut self, what: &str, single: Estimate<f32>, double: Estimate<f64>) {
        let bound = f64::from(single.error) + double.error;
        if !bound.is_finite() {
            self.unbounded += 1;
            return;
        }
        let difference = (f64::from(single.value) - double.value).abs();
        assert!(difference <= bound, "{what}: {single:?} {double:?}");
        self.compared += 1;
        if bound > 0.0 && double.roots > 0 {
            self.tightest = self.tightest.max(difference / bound);
        }
    }
}

fn cup<S: Scalar>(bounces: u32, point: bool, arc: bool) -> CylinderCup<S> {
    let s = S::from_f64;
    CylinderCup {
        wall: Wall {
            radius: s(1.25),
            height: Some(s(0.5 + 0.375 * f64::from(bounces))),
            cos_half_arc: arc.then(|| s(0.25)),
        },
        reflectance: s(0.875),
        light: if point {
            Light::Point(Lamp {
                x: s(-0.75),
                y: s(0.25),
                height: s(0.875),
                intensity: s(2.0),
            })
        } else {
            Light::Beam(Beam {
                irradiance: s(2.5),
                sin_elevation: s(0.28125),
                cos_elevation: s(0.96875),
            })
        },
    }
}

#[test]
fn cup_in_single_precision() {
    let mut tally = Tally::default();
    for bounces in 1..=3 {
        for (point, arc) in [(false, true), (false, false), (true, false)] {
            let (single, double) = (
                cup::<f32>(bounces, point, arc),
                cup::<f64>(bounces, point, arc),
            );
            for i in -40..=40i16 {
                for j in -40..=40i16 {
                    // Exact in both precisions; includes the axis, the cusp and points outside.
                    let (x, y) = (f32::from(i) / 32.0, f32::from(j) / 32.0);
                    let what = format!("k={bounces} point={point} arc={arc} ({x}, {y})");
                    tally.check(
                        &what,
                        single.caustic(x, y, bounces),
                        double.caustic(x.into(), y.into(), bounces),
                    );
                    tally.check(
                        &what,
                        single.direct(x, y),
                        double.direct(x.into(), y.into()),
                    );
                }
            }
        }
    }
    println!("{tally:?}");
    assert!(
        tally.compared > 100_000 && tally.unbounded < 200,
        "{tally:?}"
    );
    // A bound a million times too wide would hold as well: it must be met to within a factor of 1000.
    assert!(tally.tightest > 1e-3, "{tally:?}");
}

fn water<S: Scalar>(light: f64, receiver: f64) -> FlatInterface<S> {
    FlatInterface {
        surface_z: S::from_f64(1.125),
        index: S::from_f64(1.375),
        light: Vec3::from_f64([0.25, -0.5, light]),
        intensity: S::from_f64(6.5),
        receiver_z: S::from_f64(receiver),
    }
}

#[test]
fn water_in_single_precision() {
    let mut tally = Tally::default();
    for (light, receiver) in [(1.875, 0.0), (0.75, 0.0), (0.75, 1.75), (1.5, 2.5)] {
        let (single, double) = (water::<f32>(light, receiver), water::<f64>(light, receiver));
        for i in -60..=60i16 {
            for j in -60..=60i16 {
                let (x, y) = (f32::from(i) / 16.0, f32::from(j) / 16.0);
                let what = format!("light {light} receiver {receiver} ({x}, {y})");
                let (dx, dy) = (f64::from(x), f64::from(y));
                tally.check(&what, single.caustic(x, y), double.caustic(dx, dy));
                tally.check(&what, single.direct(x, y), double.direct(dx, dy));
            }
        }
    }
    println!("{tally:?}");
    assert!(
        tally.compared > 100_000 && tally.tightest > 1e-3,
        "{tally:?}"
    );
}

fn mirror<S: Scalar>(tilted: bool) -> PlanarMirror<S> {
    let v = |x: [f64; 3]| Vec3::<S>::from_f64(x);
    let normal = if tilted {
        v([-0.8, 0.0, -0.6])
    } else {
        v([0.0, -1.0, 0.0])
    };
    let edge = if tilted {
        v([0.0, 1.0, 0.0])
    } else {
        v([1.0, 0.0, 0.0])
    };
    let point = if tilted {
        v([1.0, 0.25, 0.75])
    } else {
        v([0.0, 1.0, 0.625])
    };
    PlanarMirror::new(
        v([0.25, 0.125, 2.0]),
        S::from_f64(1.5),
        S::from_f64(0.875),
        point,
        normal,
        Some(Rectangle {
            edge,
            other: normal.cross(edge),
            half_width: S::from_f64(0.75),
            half_height: S::from_f64(0.5),
        }),
    )
}

#[test]
fn mirror_in_single_precision() {
    let mut tally = Tally::default();
    for tilted in [false, true] {
        let (single, double) = (mirror::<f32>(tilted), mirror::<f64>(tilted));
        for i in -60..=60i16 {
            for j in -60..=60i16 {
                let at = [f64::from(i) / 16.0, f64::from(j) / 16.0, 0.0];
                let what = format!("tilted {tilted} {at:?}");
                let (s, d) = (Vec3::from_f64(at), Vec3::from_f64(at));
                tally.check(&what, single.caustic(s), double.caustic(d));
                tally.check(&what, single.direct(s), double.direct(d));
            }
        }
    }
    println!("{tally:?}");
    assert!(
        tally.compared > 50_000 && tally.tightest > 1e-3,
        "{tally:?}"
    );
}
