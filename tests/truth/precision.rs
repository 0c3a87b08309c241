//! How exact every kind and quantity is, next to what is allowed: the closed forms in double precision against the committed
//! 30-digit tables, and the width of the intervals that provably contain the truth.
//!
//! A kind or a quantity without a row here fails, a kind of the catalogue without a row too. The vertical walls of the
//! catalogue are measured on a grid as well, against the middle of the certified interval.

use std::collections::BTreeMap;

use crate::consistency::{assert_consistent, relative_width, table, tables};
use nephroid::entry;
use nephroid::evaluate::evaluate_certified;
use nephroid_analytic::certificate::{Certified, conic_wall, glass_pillar, pillar};
use nephroid_analytic::enclosure::Enclosure;
use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::glass_pillar::GlassPillar;
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::scene::Kind;
use nephroid_analytic::vector::Vec3;

/// Scene, quantity, largest allowed relative error of the `f64` formula away from singularities, largest allowed relative
/// width of the enclosure there. Both are four times what was measured when the row was written, rounded up to 1, 2 or 5, and
/// 1e-15 at least; what is asked of all kinds is 1e-12 and 1e-11.
type Allowed = (&'static str, &'static str, f64, f64);

const ALLOWED: &[Allowed] = &[
    ("concave-sphere", "E_caustic", 1e-14, 2e-12),
    ("concave-sphere", "E_direct", 5e-15, 5e-13),
    ("concave-sphere", "L", 1e-14, 2e-12),
    ("concave-sphere", "class E", 1e-14, 1e-12),
    ("concave-sphere", "root E", 1e-14, 1e-12),
    ("concave-sphere", "specular_weight", 1e-15, 1e-15),
    ("conic-mirrors", "E_caustic", 5e-15, 2e-13),
    ("conic-mirrors", "E_direct", 2e-15, 1e-14),
    ("conic-mirrors", "L", 5e-15, 2e-13),
    ("conic-mirrors", "class E", 5e-15, 2e-13),
    ("conic-mirrors", "root E", 5e-15, 2e-13),
    ("conic-wall", "E_caustic", 2e-14, 1e-11),
    ("conic-wall", "E_direct", 2e-15, 1e-14),
    ("conic-wall", "L", 2e-14, 1e-11),
    ("conic-wall", "class E", 2e-14, 1e-11),
    ("conic-wall", "root E", 2e-14, 1e-11),
    ("convex-sphere", "E_caustic", 1e-14, 2e-12),
    ("convex-sphere", "E_direct", 2e-15, 5e-13),
    ("convex-sphere", "L", 1e-14, 2e-12),
    ("convex-sphere", "class E", 1e-14, 1e-12),
    ("convex-sphere", "root E", 1e-14, 1e-12),
    ("convex-sphere", "specular_weight", 1e-15, 1e-15),
    ("cylinder-cup", "E_caustic", 1e-14, 1e-12),
    ("cylinder-cup", "E_direct", 2e-15, 1e-14),
    ("cylinder-cup", "L", 1e-14, 1e-12),
    ("cylinder-cup", "class E", 1e-14, 5e-13),
    ("cylinder-cup", "fluence_caustic", 5e-15, 5e-13),
    ("cylinder-cup", "root E", 2e-14, 1e-12),
    ("cylinder-cup", "root fluence", 5e-15, 1e-12),
    ("cylinder-cup", "specular_weight", 1e-15, 1e-15),
    ("diffuse", "E_bounce1", 1e-15, 2e-15),
    ("diffuse", "E_caustic", 2e-15, 1e-14),
    ("diffuse", "E_direct", 1e-15, 1e-14),
    ("diffuse", "E_indirect_total", 1e-15, 5e-15),
    ("diffuse", "E_total", 1e-15, 1e-14),
    ("diffuse", "L", 2e-15, 1e-14),
    ("diffuse", "class E", 2e-15, 1e-14),
    ("diffuse", "root E", 2e-15, 1e-14),
    ("flat-interface", "E_caustic", 5e-15, 2e-13),
    ("flat-interface", "E_direct", 2e-15, 1e-14),
    ("flat-interface", "L", 5e-15, 2e-13),
    ("flat-interface", "T", 1e-15, 5e-14),
    ("flat-interface", "class E", 5e-15, 2e-13),
    ("flat-interface", "root E", 5e-15, 2e-13),
    ("flat-interface", "specular_weight", 1e-15, 5e-14),
    ("glass-pillar", "E_caustic", 1e-14, 2e-12),
    ("glass-pillar", "E_direct", 1e-15, 2e-15),
    ("glass-pillar", "L", 5e-15, 2e-12),
    ("glass-pillar", "class E", 1e-13, 2e-12),
    ("glass-pillar", "root E", 1e-13, 5e-12),
    ("glass-slab", "E_caustic", 5e-15, 2e-13),
    ("glass-slab", "E_caustic_all_orders", 5e-15, 2e-13),
    ("glass-slab", "E_tail", 2e-14, 1e-12),
    ("glass-slab", "L", 5e-15, 2e-13),
    ("glass-slab", "class E", 2e-14, 1e-12),
    ("glass-slab", "root E", 2e-14, 1e-12),
    ("glass-slab", "specular_weight", 1e-15, 5e-14),
    ("glass-sphere", "E_caustic", 1e-14, 5e-12),
    ("glass-sphere", "L", 1e-14, 5e-12),
    ("glass-sphere", "class E", 1e-14, 5e-12),
    ("glass-sphere", "root E", 2e-14, 5e-12),
    ("paraboloid", "E_caustic", 5e-15, 5e-14),
    ("paraboloid", "L", 5e-15, 5e-14),
    ("paraboloid", "class E", 5e-15, 5e-14),
    ("paraboloid", "root E", 5e-15, 5e-14),
    ("pillar", "E_caustic", 5e-14, 1e-12),
    ("pillar", "E_direct", 2e-15, 1e-14),
    ("pillar", "L", 5e-14, 1e-12),
    ("pillar", "class E", 5e-14, 1e-12),
    ("pillar", "root E", 5e-14, 1e-12),
    ("planar-chains", "E_caustic", 2e-15, 5e-14),
    ("planar-chains", "E_caustic_all_orders", 2e-15, 5e-13),
    ("planar-chains", "E_direct", 2e-15, 2e-14),
    ("planar-chains", "L", 2e-15, 5e-14),
    ("planar-chains", "class E", 5e-15, 5e-14),
    ("planar-chains", "root E", 5e-15, 5e-14),
    ("planar-mirror", "E_caustic", 2e-15, 5e-14),
    ("planar-mirror", "E_direct", 2e-15, 1e-13),
    ("planar-mirror", "L", 5e-15, 1e-13),
    ("planar-mirror", "class E", 2e-15, 5e-14),
    ("planar-mirror", "root E", 2e-15, 5e-14),
    ("planar-mirror", "specular_weight", 1e-15, 1e-15),
    ("stigmatic-refractors", "E_caustic", 1e-14, 5e-12),
    ("stigmatic-refractors", "L", 1e-14, 5e-12),
    ("stigmatic-refractors", "class E", 1e-14, 5e-12),
    ("stigmatic-refractors", "root E", 1e-14, 5e-12),
    ("water-waves", "E_caustic", 1e-14, 5e-13),
    ("water-waves", "L", 1e-14, 5e-13),
    ("water-waves", "T", 1e-15, 5e-14),
    ("water-waves", "class E", 1e-14, 1e-13),
    ("water-waves", "root E", 1e-14, 2e-13),
    ("water-waves", "specular_weight", 1e-15, 5e-14),
];

/// Near a singularity an enclosure may be this many times as wide as the error bound of the closed form, which is the
/// conditioning times the rounding of the inputs: an interval adds the margins of eight units in the last place of every sine
/// and cosine in the equation whose zero it is, with one sign.
const NEAR: f64 = 20.0;

/// The quantity of a key: `E_caustic`, `class E`, `root E`, `L`.
fn quantity(key: &str) -> &str {
    if key.starts_with('L') {
        "L"
    } else if key.starts_with("E_tail") {
        "E_tail"
    } else if key.starts_with("paths") && !key.contains(".roots.") {
        "class E"
    } else if key.contains("roots.") && key.ends_with(".E") {
        "root E"
    } else if key.contains("roots.") {
        "root fluence"
    } else {
        key
    }
}

#[test]
fn every_kind_and_quantity() {
    let mut measured: BTreeMap<(String, String), (f64, f64)> = BTreeMap::new();
    let mut near: f64 = 0.0;
    for name in tables() {
        let report = evaluate_certified(&name, &table(&name).to_string()).expect("a good file");
        assert_consistent(&name, &report);
        for placed in report.rows() {
            let row = placed.row;
            let Some(expected) = row.expected else {
                continue;
            };
            let certificate = row.certificate.expect("a certificate");
            assert!(certificate.certified, "{name} {placed:?}");
            // The expected value was rounded to a double.
            let ulp = f64::EPSILON * f64::abs(expected);
            assert!(
                certificate.low <= expected + ulp && expected - ulp <= certificate.high,
                "{name} {placed:?}"
            );
            if row.near_singularity {
                near = near.max((certificate.high - certificate.low) / row.error_bound);
            }
            if row.near_singularity || expected == 0.0 {
                continue;
            }
            let worst = measured
                .entry((name.clone(), quantity(&row.key).to_owned()))
                .or_default();
            worst.0 = worst
                .0
                .max(row.relative_difference.unwrap_or(f64::INFINITY));
            worst.1 = worst.1.max(relative_width(row));
        }
    }
    println!("near singularities: enclosures up to {near:.2} error bounds wide");
    assert!(near <= NEAR, "{near}");
    let mut wrong = vec![];
    for ((scene, quantity), (error, width)) in &measured {
        let allowed = ALLOWED
            .iter()
            .find(|(s, q, ..)| s == scene && q == quantity);
        let ok = allowed.is_some_and(|(_, _, e, w)| error <= e && width <= w);
        let line = format!(
            "    (\"{scene}\", \"{quantity}\", {error:.1e}, {width:.1e}), allowed {allowed:?}"
        );
        println!("{line}");
        if !ok {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for (scene, quantity, ..) in ALLOWED {
        let key = ((*scene).to_owned(), (*quantity).to_owned());
        assert!(measured.contains_key(&key), "nothing measured for {key:?}");
    }
}

/// As [`ALLOWED`] on a grid of floor points of the vertical walls, on their catalogue entry or, for the glass pillar, one of its own.
const WALLS: &[Allowed] = &[
    ("pillar", "E_direct", 5e-15, 1e-14),
    ("pillar", "E_caustic", 5e-14, 5e-13),
    ("conic-wall", "E_direct", 5e-15, 1e-14),
    ("conic-wall", "E_caustic", 2e-14, 1e-11),
    ("glass-pillar", "E_direct", 1e-15, 1e-15),
    ("glass-pillar", "class E", 5e-14, 5e-12),
];

/// Catalogue kinds that are other scenes of a table's kind.
const SAME: &[(&str, &str)] = &[
    ("closed-cup", "cylinder-cup"),
    ("cylinder-lamp", "cylinder-cup"),
    ("furnace", "diffuse"),
    ("underwater", "flat-interface"),
];

fn pillar_of<S: Scalar>() -> Pillar<S> {
    let scene = entry::load("pillar").expect("the entry");
    let Kind::Pillar(scene) = &scene.kind else {
        panic!("another kind");
    };
    let number = S::from_f64;
    Pillar {
        x: number(scene.pillar.center[0]),
        y: number(scene.pillar.center[1]),
        radius: number(scene.pillar.radius),
        height: number(scene.pillar.height),
        reflectance: number(scene.pillar.reflectance),
        light: Vec3::from_f64(scene.light.position),
        intensity: number(scene.light.intensity),
    }
}

fn wall_of<S: Scalar>() -> ConicWall<S> {
    let scene = entry::load("conic-wall").expect("the entry");
    let Kind::ConicWall(scene) = &scene.kind else {
        panic!("another kind");
    };
    let (number, wall) = (S::from_f64, &scene.wall);
    let (c, s) = wall.axis();
    ConicWall {
        x: number(wall.focus[0]),
        y: number(wall.focus[1]),
        axis: (number(c), number(s)),
        parameter: number(wall.parameter),
        eccentricity: number(wall.eccentricity),
        half_arc: wall.half_arc().map(number),
        height: number(wall.height),
        reflectance: number(wall.reflectance),
        light: Vec3::from_f64(scene.light.position),
        intensity: number(scene.light.intensity),
    }
}

fn glass_of<S: Scalar>() -> GlassPillar<S> {
    let number = S::from_f64;
    GlassPillar {
        x: number(0.125),
        y: number(-0.25),
        radius: number(0.375),
        height: number(1.5),
        index: number(1.5),
        irradiance: number(2.0),
        sin_elevation: number(0.6),
        cos_elevation: number(0.8),
    }
}

#[test]
fn vertical_walls_on_a_grid() {
    let mut measured: BTreeMap<(&str, &str), (f64, f64)> = BTreeMap::new();
    let mut add = |kind, quantity, value: Estimate<f64>, certified: Certified| {
        assert!(
            certified.is_proven(),
            "{kind} {quantity} {value:?} {certified:?}"
        );
        assert_eq!(certified.roots, value.roots, "{kind} {quantity} {value:?}");
        if value.value == 0.0 || value.conditioning() > 100.0 {
            return;
        }
        let middle = certified.value.middle();
        let worst = measured.entry((kind, quantity)).or_default();
        worst.0 = worst.0.max((value.value - middle).abs() / middle);
        worst.1 = worst.1.max(certified.value.relative_width());
    };
    let (form, proof) = (pillar_of::<f64>(), pillar_of::<Enclosure>());
    let (wall, wall_proof) = (wall_of::<f64>(), wall_of::<Enclosure>());
    let (glass, glass_proof) = (glass_of::<f64>(), glass_of::<Enclosure>());
    for i in -10..=10i32 {
        for j in -10..=10i32 {
            let (x, y) = (0.158 * f64::from(i) + 0.01, 0.164 * f64::from(j) - 0.02);
            let (px, py) = (Enclosure::point(x), Enclosure::point(y));
            let caustic = pillar::caustic_enclosed(&proof, px, py).total;
            add("pillar", "E_caustic", form.caustic(x, y), caustic);
            let direct = pillar::direct_enclosed(&proof, px, py);
            add("pillar", "E_direct", form.direct(x, y), direct);
            let caustic = conic_wall::caustic_enclosed(&wall_proof, px, py).total;
            add("conic-wall", "E_caustic", wall.caustic(x, y), caustic);
            let direct = conic_wall::direct_enclosed(&wall_proof, px, py);
            add("conic-wall", "E_direct", wall.direct(x, y), direct);
            for m in 1..=4 {
                let caustic = glass_pillar::caustic_enclosed(&glass_proof, px, py, m).total;
                add("glass-pillar", "class E", glass.caustic(x, y, m), caustic);
            }
            let direct = glass_pillar::direct_enclosed(&glass_proof, px, py);
            add("glass-pillar", "E_direct", glass.direct(x, y), direct);
        }
    }
    let mut good = true;
    for ((kind, quantity), (error, width)) in &measured {
        let allowed = WALLS.iter().find(|(k, q, ..)| k == kind && q == quantity);
        println!("    (\"{kind}\", \"{quantity}\", {error:.1e}, {width:.1e}), allowed {allowed:?}");
        good &= allowed.is_some_and(|(_, _, e, w)| error <= e && width <= w);
    }
    assert!(good, "{measured:?}");
    assert_eq!(measured.len(), WALLS.len());
}

#[test]
fn every_kind_of_the_catalogue_has_a_row() {
    for name in entry::names() {
        let entry = entry::load(name).expect("an entry");
        let kind = entry.kind.name();
        let kind = SAME
            .iter()
            .find(|(k, _)| *k == kind)
            .map_or(kind, |(_, t)| t);
        let rows = ALLOWED.iter().chain(WALLS);
        assert!(rows.into_iter().any(|(k, ..)| *k == kind), "{name}: {kind}");
    }
}
