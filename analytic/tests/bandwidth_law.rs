//! The law of small bandwidths against closed forms, and against exact expectations at two small bandwidths.

use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::law::{Law, Place, SmallBandwidth, closed, extrapolated};
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::sphere_mirror::{Light, Side, SphereMirror};
use nephroid_analytic::vector::vec3;

const ANGLES: [Technique; 3] = [Technique::Camera, Technique::Light, Technique::Symmetric];

/// Scene E1 of the theory: a concave cap with the light on its axis.
fn e1() -> SphereMirror<f64> {
    SphereMirror {
        centre: vec3(0.0, 0.0, 0.0),
        radius: 1.0,
        side: Side::Concave,
        cap_axis: vec3(0.0, 0.0, 1.0),
        cap_cos_min: 0.25,
        reflectance: 0.9,
        light: Light::Point {
            position: vec3(0.0, 0.0, 0.3),
            intensity: 1.0,
        },
        receiver_z: -0.3,
    }
}

fn estimator<'a>(technique: Technique, kernel: Kernel, bandwidths: &'a [f64]) -> Estimator<'a> {
    Estimator {
        technique,
        kernel,
        convention: Convention::Exact,
        bandwidths,
    }
}

fn sphere_law(mirror: &SphereMirror<f64>, t: Technique, k: Kernel, x: [f64; 2]) -> Law {
    let law = SmallBandwidth::of_sphere(mirror, t, k).unwrap();
    law.at(x[0], x[1])[0].unwrap()
}

fn sphere_moments(mirror: &SphereMirror<f64>, t: Technique, k: Kernel, x: [f64; 2], b: f64) -> [f64; 2] {
    let e = EntryExpectation::of_sphere(mirror, estimator(t, k, &[b])).unwrap();
    let m = e.unwrap().at(x[0], x[1], 1e-12)[0];
    [m.mean.value, m.second_moment.value]
}

/// The fold of E1 in the receiver's plane.
const FOLD: f64 = 0.127_777_842_698_993_61;

#[test]
fn sphere_axis_is_the_closed_form() {
    let mirror = e1();
    let closed = closed::sphere_axis(1.0, 1.3, 0.7);
    // theory/reference/bandwidth-concave-sphere.json, E1-axis.
    assert!((closed[0] - 66.265_432_098_765_43).abs() < 1e-11);
    assert!((closed[1] - 64.598_765_432_098_77).abs() < 1e-11);
    for (kernel, share) in [
        (Kernel::Cone, 0.5),
        (Kernel::Epanechnikov, 1.0 / 3.0),
        (Kernel::VonMisesFisher, 0.5),
    ] {
        for (technique, kappa) in [Technique::Camera, Technique::Light].into_iter().zip(closed) {
            let law = sphere_law(&mirror, technique, kernel, [0.0; 2]);
            let exact = kappa * share * 250.0 / 9.0;
            assert_eq!((law.place, law.order, law.roots), (Place::Smooth, Some(2.0), 1));
            assert!((law.coefficient / exact - 1.0).abs() < 1e-8, "{technique} {kernel} {law:?}");
            assert!(law.error < 1e-8 * exact);
            assert!((law.limit.unwrap() * 9.0 / 250.0 - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn fold_of_a_sphere() {
    let mirror = e1();
    for (t, k) in [(Technique::Merge, Kernel::Disc), (Technique::Camera, Kernel::Cone), (Technique::Light, Kernel::Epanechnikov), (Technique::Light, Kernel::VonMisesFisher)] {
        let law = sphere_law(&mirror, t, k, [FOLD, 0.0]);
        println!("{:?}", (law.place, law.order, law.coefficient, law.squared, law.reach, law.roots));
        for b in [1e-3, 1e-4, 1e-5, 1e-6] {
            let [m, s] = sphere_moments(&mirror, t, k, [FOLD, 0.0], b);
            println!("{b} {} {}", m / law.mean(b), s / law.second_moment(b));
        }
    }
    for d in [1e-2, 1e-3, 1e-4] {
        for s in [-1.0, 1.0] {
            let law = sphere_law(&mirror, Technique::Camera, Kernel::Cone, [FOLD + s * d, 0.0]);
            println!("{d} {s} {:?}", (law.place, law.limit, law.order, law.coefficient, law.squared, law.reach, law.roots));
            println!("{:?} {:?}",sphere_moments(&mirror, Technique::Camera, Kernel::Cone, [FOLD + s * d, 0.0], law.reach * 0.999),sphere_moments(&mirror, Technique::Camera, Kernel::Cone, [FOLD + s * d, 0.0], law.reach * 1.001));
        }
    }
}
