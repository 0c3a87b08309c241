//! Certificates where they are hard: on folds and edges, in the regime of many roots, and as a bound of series; counted against
//! plain sampling, which shares nothing with them.

use std::collections::BTreeMap;

use nephroid_analytic::certificate::Lit;
use nephroid_analytic::certificate::cylinder_cup::CylinderCup;
use nephroid_analytic::certificate::glass_slab::GlassSlab;
use nephroid_analytic::certificate::planar_chains::Corridor;
use nephroid_analytic::certificate::planar_mirror::PlanarMirror;
use nephroid_analytic::certificate::radiometry::Point;
use nephroid_analytic::certificate::roots::{Jet, full_turn};
use nephroid_analytic::certificate::scene::Scene;
use nephroid_analytic::certificate::source::Source;
use nephroid_analytic::certificate::sphere_mirror::SphereMirror;
use nephroid_analytic::enclosure::Enclosure;
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::vec3;

/// Parameters written as `key: texts`; one text is a number, several are an array.
struct Parameters(BTreeMap<&'static str, Vec<String>>);

impl Parameters {
    fn new(text: &[(&'static str, &str)]) -> Self {
        let split = |v: &str| v.split_whitespace().map(str::to_owned).collect();
        Parameters(text.iter().map(|(k, v)| (*k, split(v))).collect())
    }
}

impl Source for Parameters {
    fn text(&self, key: &str, indices: &[usize]) -> Option<String> {
        let texts = self.0.get(key)?;
        match indices {
            [] if texts.len() == 1 => texts.first().cloned(),
            [i] if texts.len() > 1 => texts.get(*i).cloned(),
            _ => None,
        }
    }
}

fn at(x: f64, y: f64) -> Point {
    vec3(Enclosure::point(x), Enclosure::point(y), Enclosure::ZERO)
}

fn cup() -> CylinderCup {
    let p = Parameters::new(&[
        ("a", "1"),
        ("R", "0.9"),
        ("E0", "2"),
        ("sin_elevation", "0.6"),
        ("cos_elevation", "0.8"),
        ("wall", "half"),
        ("wall_height", "1.2"),
        ("max_bounces", "1"),
    ]);
    CylinderCup::read(&p).expect("a cup")
}

#[test]
fn a_cusp_is_undecided_and_unbounded() {
    // The cusp of the nephroid: three rays are one.
    let bundle = cup().caustic_enclosed(at(0.5, 0.0), 1);
    assert!(bundle.total.undecided && !bundle.total.is_proven());
    assert!(bundle.total.value.high() == f64::INFINITY, "{bundle:?}");
    // Next to it, 1e-6 away on the axis: one ray before it, three behind it.
    for (x, rays) in [(0.5 - 1e-6, 1), (0.5 + 1e-6, 3)] {
        let bundle = cup().caustic_enclosed(at(x, 0.0), 1);
        assert!(bundle.total.is_proven(), "{x} {bundle:?}");
        assert_eq!(bundle.total.roots, rays, "{x} {bundle:?}");
    }
}

#[test]
fn the_axis_of_the_cup_is_elementary() {
    // The ray φ = 0 alone: E0 R sin e · a/|2x - a|.
    for x in [0.125, 0.25, 0.375] {
        let bundle = cup().caustic_enclosed(at(x, 0.0), 1);
        let exact =
            Enclosure::from_decimal("1.08").expect("a decimal") / Enclosure::point(1.0 - 2.0 * x);
        assert!(bundle.total.is_proven() && bundle.total.roots == 1);
        assert!(bundle.total.value.intersection(exact).is_some());
    }
}

#[test]
fn the_edge_of_a_mirror_is_both() {
    let p = Parameters::new(&[
        ("light", "0 0 1"),
        ("I", "5"),
        ("R", "0.5"),
        ("mirror_point", "0 0 2"),
        ("mirror_normal", "0 0 -1"),
        ("extent.edge", "1 0 0"),
        ("extent.half_width", "0.1"),
        ("extent.half_height", "1"),
    ]);
    let mirror = PlanarMirror::read(&p).expect("a mirror");
    // The image is at z = 3: the light comes by the mirror's edge x = 0.1 to x = 0.3.
    let edge = vec3(
        Enclosure::from_decimal("0.3").expect("a decimal"),
        Enclosure::ZERO,
        Enclosure::ZERO,
    );
    let bundle = mirror.caustic_enclosed(edge);
    let e = 2.5 * 3.0 / (9.09_f64 * 9.09_f64.sqrt());
    assert!(bundle.total.undecided, "{bundle:?}");
    assert!(bundle.total.value.contains(0.0) && bundle.total.value.contains(e));
    for (x, lit) in [(0.299_999_9, 1), (0.300_000_1, 0)] {
        let bundle = mirror.caustic_enclosed(at(x, 0.0));
        assert!(
            bundle.total.is_proven() && bundle.total.roots == lit,
            "{bundle:?}"
        );
    }
}

fn sphere(light: [f64; 3]) -> SphereMirror {
    let [x, y, z] = light;
    let light = format!("{x} {y} {z}");
    let p = Parameters::new(&[
        ("sphere_centre", "0 0 0"),
        ("a", "1"),
        ("R", "0.9"),
        ("I", "1"),
        ("z_receiver", "-0.8"),
        ("light", &light),
    ]);
    SphereMirror::read(&p, true).expect("a sphere")
}

/// Number of reflections above the receiver, from sign changes of the angles' difference on a fine walk around the circle.
fn sampled(s: [f64; 3], b: [f64; 3]) -> u32 {
    let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let length = |u: [f64; 3]| dot(u, u).sqrt();
    let combine = |u: [f64; 3], p: f64, v: [f64; 3], q: f64| [0, 1, 2].map(|i| p * u[i] + q * v[i]);
    let e1 = s.map(|c| c / length(s));
    let off = combine(b, 1.0, e1, -dot(b, e1));
    let e2 = off.map(|c| c / length(off));
    let steps = 40_000;
    let walk = |k: i32| {
        let phi = 2.0 * core::f64::consts::PI * (f64::from(k) + 0.37) / f64::from(steps);
        let (c, s_phi) = (libm::cos(phi), libm::sin(phi));
        let n = combine(e1, c, e2, s_phi);
        let tangent = combine(e1, -s_phi, e2, c);
        let slope = |end: [f64; 3]| {
            let leg = combine(end, 1.0, n, -1.0);
            dot(leg, tangent) / length(leg)
        };
        // Equal angles on both sides of the normal: the sum of both tangential components vanishes.
        (slope(s) + slope(b), n[2] > -0.8)
    };
    let mut count = 0;
    for k in 0..steps {
        let ((before, above), (after, _)) = (walk(k), walk(k + 1));
        if (before > 0.0) != (after > 0.0) && above {
            count += 1;
        }
    }
    count
}

#[test]
fn reflections_in_a_sphere_are_counted() {
    // Light and receiver inside the sphere: legs cannot meet it before their ends, so that the count is that of the circle.
    let mut seen = [0; 5];
    for i in 0..7i32 {
        for j in 0..7i32 {
            let light = [
                -0.45 + 0.14 * f64::from(i),
                0.11,
                -0.72 + 0.23 * f64::from(j),
            ];
            let mirror = sphere(light);
            for (x, y) in [(0.31, 0.13), (-0.45, 0.2), (0.07, -0.35)] {
                let bundle = mirror.caustic_enclosed(at(x, y));
                assert!(bundle.total.is_proven(), "{light:?} {x} {y} {bundle:?}");
                let count = sampled(light, [x, y, -0.8]);
                assert_eq!(bundle.total.roots, count, "{light:?} {x} {y} {bundle:?}");
                seen[count as usize] += 1;
            }
        }
    }
    // The zero behind the receiver, as seen from the centre, is below it: of four zeros three are lit.
    assert!(seen[1] > 20 && seen[3] > 20, "{seen:?}");
}

#[test]
fn four_zeros_on_the_circle() {
    let mut seen = [0; 5];
    for i in 0..9i32 {
        for j in 0..9i32 {
            let s = 0.05 + 0.1 * f64::from(i);
            let (x, y) = (-0.83 + 0.2 * f64::from(j), 0.07);
            let number = |v: f64| Jet::constant(Enclosure::point(v));
            let zeros = full_turn(|phi| {
                let twice = phi + phi;
                number(s * y) * twice.cos() - number(s * x) * twice.sin() - number(y) * phi.cos()
                    + number(s + x) * phi.sin()
            });
            let zeros = zeros.expect("a start");
            assert!(zeros.undecided.is_empty(), "{s} {x} {zeros:?}");
            let g = |k: i32| {
                let phi = 2.0 * core::f64::consts::PI * (f64::from(k) + 0.37) / 20_000.0;
                s * y * libm::cos(2.0 * phi) - s * x * libm::sin(2.0 * phi) - y * libm::cos(phi)
                    + (s + x) * libm::sin(phi)
            };
            let count = (0..20_000)
                .filter(|&k| (g(k) > 0.0) != (g(k + 1) > 0.0))
                .count();
            assert_eq!(zeros.simple.len(), count, "{s} {x} {zeros:?}");
            seen[count] += 1;
        }
    }
    assert!(seen[2] > 10 && seen[4] > 10, "{seen:?}");
}

#[test]
fn tails_enclose_the_rest_of_a_series() {
    let p = Parameters::new(&[
        ("slab_z", "0.7 1"),
        ("n", "1.5"),
        ("light", "0 0 1.5"),
        ("I", "5"),
    ]);
    let slab = GlassSlab::read(&p).expect("a slab");
    for x in [0.0, 1.0, 30.0] {
        let all = slab.orders_from_enclosed(at(x, 0.5), 0);
        assert!(all.is_proven(), "{x} {all:?}");
        let rest = slab.orders_from_enclosed(at(x, 0.5), 3);
        let mut sum = rest.value;
        for k in 0..3 {
            sum += slab.caustic_enclosed(at(x, 0.5), k).total.value;
        }
        assert!(sum.intersection(all.value).is_some(), "{x} {sum:?} {all:?}");
        assert!(all.value.relative_width() < 1e-11, "{x} {all:?}");
    }
    // A corridor that absorbs nothing converges like 1/K²: the bound says so.
    for (reflectance, widest) in [("0.9", 1e-12), ("0.99", 1e-12), ("1", 1e-7)] {
        let p = Parameters::new(&[
            ("W", "1.5"),
            ("light", "0.4 0 0.9"),
            ("I", "5"),
            ("R", reflectance),
            ("orders_listed", "6"),
        ]);
        let corridor = Corridor::read(&p).expect("a corridor");
        let all = corridor.all_orders_enclosed(at(0.7, 0.2));
        assert!(all.value.relative_width() < widest, "{reflectance} {all:?}");
        let listed: f64 = (1..=6)
            .map(|k| corridor.caustic_enclosed(at(0.7, 0.2), k).total.value.low())
            .sum();
        assert!(all.value.high() > listed);
    }
}

#[test]
fn what_cannot_be_decided_is_not_certified() {
    // A light within rounding of the surface, a scene without its parameters.
    let interface = |light_z: &str, n: &str| {
        let light = format!("0 0 {light_z}");
        let p = Parameters::new(&[
            ("surface_z", "0.1"),
            ("n", n),
            ("I", "5"),
            ("light", &light),
        ]);
        Scene::read("flat-interface", &p)
    };
    assert!(interface("0.1", "1.333").is_none());
    assert!(interface("1.8", "1.333").is_some());
    let point = Parameters::new(&[("x", "0.5 0 0")]);
    assert!(Scene::read("no-such-scene", &point).is_none());
    assert!(Scene::read("paraboloid", &point).is_none());
}

#[test]
fn three_values() {
    use Lit::{No, Undecided, Yes};
    assert_eq!(
        [Yes.and(Undecided), No.and(Undecided), Yes.and(Yes)],
        [Undecided, No, Yes]
    );
    assert_eq!(
        [Yes.or(Undecided), No.or(Undecided), No.or(No)],
        [Yes, Undecided, No]
    );
    let wide = Enclosure::new(-1.0, 1.0);
    assert_eq!(
        [Lit::where_positive(wide), Lit::where_not_negative(wide)],
        [Undecided; 2]
    );
    assert_eq!(Lit::where_positive(Enclosure::ZERO), No);
    assert_eq!(Lit::where_not_negative(Enclosure::ZERO), Yes);
}
