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

#[test]
fn sphere_axis_is_the_closed_form() {
    let mirror = e1();
    for kernel in [Kernel::Cone, Kernel::Epanechnikov, Kernel::VonMisesFisher] {
        let share = if kernel == Kernel::Epanechnikov { 1.0 / 3.0 } else { 0.5 };
        let closed = closed::sphere_axis(1.0, 1.3, 0.7);
        // theory/reference/bandwidth-concave-sphere.json, E1-axis.
        assert!((closed[0] - 66.265432098765432).abs() < 1e-11);
        assert!((closed[1] - 64.598765432098765).abs() < 1e-11);
        for (technique, kappa) in [Technique::Camera, Technique::Light].into_iter().zip(closed) {
            let law = sphere_law(&mirror, technique, kernel, [0.0; 2]);
            println!("{law:?}");
        }
    }
    for r in [0.1, 0.5, 0.85, 0.89, 0.9, 0.95, 1.2] {
        println!("{r} {:?}", sphere_law(&mirror, Technique::Merge, Kernel::Disc, [r, 0.0]));
    }
}
