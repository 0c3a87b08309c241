//! Reciprocity of the generalised geometry term: light and receiver change places.
//!
//! A specular path from a point light at A to a receiver at B brings the irradiance E = I τ cos θ_B G(A → B),
//! G(A → B) = dΩ_A/dA_B⊥ the solid angle at A per area across the ray at B. A bundle of rays about the path is a linear
//! map of transverse place and optical momentum (n times angle) that conserves their products (étendue: Straubel's
//! theorem). Its block that takes the momentum at A to the place at B is, transposed, that of the way back. So
//!
//! ```text
//! n_A² G(A → B) = n_B² G(B → A),     τ the same both ways,
//! ```
//!
//! for any chain of reflections and refractions, ray by ray. Compared are the irradiances by a form with the light at A
//! and its receiver at B, and by a form with the light at B and the receiver at A, each divided by its receiver's cosine.
//! Where a form's receiver faces up and the light would come from below, the second scene is turned upside down,
//! (x, y, z) → (x, -y, -z).
//!
//! Kinds with parallel light, or with a light that is only at a focus, have no second scene: see [`SECOND_SCENES`].

mod walls;

use libm::sqrt;
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::glass_slab::GlassSlab;
use nephroid_analytic::kinds::planar_mirror::PlanarMirror;
use nephroid_analytic::kinds::rounding_error;
use nephroid_analytic::kinds::sphere_mirror::{Light, Root, Side, SphereMirror};
use nephroid_analytic::vector::{Vec3, vec3};

use crate::varied::{assert_complete, random};

/// Whether light and receiver of a kind can change places, or why not.
const SECOND_SCENES: [(&str, Result<(), &str>); 20] = [
    ("planar-mirror", Ok(())),
    ("flat-interface", Ok(())),
    ("underwater", Ok(())),
    ("glass-slab", Ok(())),
    ("concave-sphere", Ok(())),
    ("convex-sphere", Ok(())),
    ("pillar", Ok(())),
    ("conic-wall", Ok(())),
    ("cylinder-lamp", Ok(())),
    ("planar-chains", Ok(())),
    ("diffuse", Err("no specular surface")),
    ("furnace", Err("no specular surface")),
    ("cylinder-cup", Err("parallel light")),
    ("closed-cup", Err("parallel light")),
    ("glass-pillar", Err("parallel light")),
    ("glass-sphere", Err("parallel light")),
    ("water-waves", Err("parallel light")),
    ("stigmatic-refractors", Err("parallel light")),
    ("paraboloid", Err("the light is at the focus only")),
    ("conic-mirrors", Err("the light is at a focus only")),
];

#[test]
fn every_kind_says_whether_light_and_receiver_can_change_places() {
    assert_complete(SECOND_SCENES.iter().map(|s| s.0));
}

/// Asserts that two values of n² G I τ agree, to the rounding that their conditionings explain; whether these are small.
fn assert_reciprocal(name: &str, there: f64, back: f64, conditioning: f64) -> u32 {
    let bound = rounding_error(there, conditioning);
    assert!(
        (there - back).abs() <= bound,
        "{name}: {there:e} {back:e} ± {bound:e}"
    );
    u32::from(bound <= 1e-9 * there)
}

/// Cosine of the direction from x to s with the vertical.
fn cosine(s: Vec3<f64>, x: Vec3<f64>) -> f64 {
    (s.z - x.z).abs() / (s - x).length()
}

fn upside_down(v: Vec3<f64>) -> Vec3<f64> {
    vec3(v.x, -v.y, -v.z)
}

const NO_TURN: fn(Vec3<f64>) -> Vec3<f64> = |v| v;
const BOTH: [fn(Vec3<f64>) -> Vec3<f64>; 2] = [NO_TURN, upside_down];

#[test]
fn a_plane_mirror_is_reciprocal() {
    let mut compared = 0;
    random(300, |r: [f64; 9]| {
        let (a, b) = (vec3(r[0], r[1], r[2]), vec3(r[3], r[4], r[5]));
        let normal = vec3(r[6], r[7], r[8]).normalized();
        let point = normal * -2.0;
        for turn in BOTH {
            let mirror = |turn: fn(Vec3<f64>) -> Vec3<f64>, light: Vec3<f64>, x: Vec3<f64>| {
                let (m, n) = (turn(point), turn(normal));
                let root =
                    PlanarMirror::new(turn(light), 1.3, 0.7, m, n, None).reflection(turn(x))?;
                let cos = cosine(root.specular_point, turn(x));
                Some((root.irradiance / cos, (root.conditioning + 8.0) / cos))
            };
            if let (Some(there), Some(back)) = (mirror(NO_TURN, a, b), mirror(turn, b, a)) {
                compared += assert_reciprocal("plane", there.0, back.0, there.1 + back.1);
            }
        }
    });
    assert!(compared >= 100, "{compared}");
}

#[test]
fn spheres_are_reciprocal_root_by_root() {
    for side in [Side::Concave, Side::Convex] {
        let (mut compared, mut several) = (0, 0);
        random(600, |r: [f64; 7]| {
            let at = |k: usize| {
                let v = vec3(r[k], r[k + 1], r[k + 2]);
                match side {
                    Side::Concave => v * (0.95 / sqrt(3.0)),
                    Side::Convex => v.normalized() * (1.7 + 0.6 * r[6]),
                }
            };
            let (a, b) = (at(0), at(3));
            let lit = |turn: fn(Vec3<f64>) -> Vec3<f64>, light: Vec3<f64>, x: Vec3<f64>| {
                let x = turn(x);
                let mirror = SphereMirror {
                    centre: vec3(0.0, 0.0, 0.0),
                    radius: 1.0,
                    side,
                    cap_axis: vec3(0.0, 0.0, 1.0),
                    cap_cos_min: -1.0,
                    reflectance: 0.83,
                    light: Light::Point {
                        position: turn(light),
                        intensity: 1.7,
                    },
                    receiver_z: x.z,
                };
                let mut roots: Vec<Root<f64>> = vec![];
                mirror.for_each_lit_root(x, |root| roots.push(root));
                let of = |root: Root<f64>| {
                    let cos = cosine(root.specular_point, x);
                    // A turn upside down is its own inverse.
                    let s = turn(root.specular_point);
                    (s, root.irradiance / cos, (root.conditioning + 8.0) / cos)
                };
                roots.into_iter().map(of).collect::<Vec<_>>()
            };
            let there = lit(NO_TURN, a, b);
            several += u32::from(there.len() > 1);
            let back = BOTH.map(|turn| lit(turn, b, a)).concat();
            for (s, e, c) in there {
                if c > 1e7 {
                    continue;
                }
                // The light comes to A from above or from below: it is lit in one of the two scenes.
                let same = |q: &&(Vec3<f64>, f64, f64)| (q.0 - s).length() < 1e-7;
                let found: Vec<_> = back.iter().filter(same).collect();
                assert_eq!(found.len(), 1, "{side:?} {a:?} {b:?} {s:?}");
                compared += assert_reciprocal("sphere", e, found[0].1, c + found[0].2);
            }
        });
        assert!(compared >= 150, "{side:?} {compared}");
        assert!((several >= 30) == (side == Side::Concave), "{several}");
    }
}

/// Refraction both ways, with n² between, and reflection on either side, inside total reflection too.
#[test]
fn a_water_surface_is_reciprocal() {
    let mut compared = [0; 3];
    random(200, |r: [f64; 7]| {
        let n = 1.5 + 0.4 * r[0];
        for (case, sides) in [[1.0, -1.0], [1.0, 1.0], [-1.0, -1.0]]
            .into_iter()
            .enumerate()
        {
            let at = |k: usize, side: f64| {
                vec3(2.0 * r[k], 2.0 * r[k + 1], side * (0.8 + 0.7 * r[k + 2]))
            };
            let (a, b) = (at(1, sides[0]), at(4, sides[1]));
            let value = |light: Vec3<f64>, x: Vec3<f64>| {
                let water = FlatInterface {
                    surface_z: 0.0,
                    index: n,
                    light,
                    intensity: 1.7,
                    receiver_z: x.z,
                };
                let index = if light.z > 0.0 { 1.0 } else { n };
                let cos = cosine(water.root(x.x, x.y).specular_point, x);
                let e = water.caustic(x.x, x.y);
                (
                    index * index * e.value / cos,
                    (e.conditioning() + 8.0) / cos,
                )
            };
            let (there, back) = (value(a, b), value(b, a));
            compared[case] += assert_reciprocal("water", there.0, back.0, there.1 + back.1);
        }
    });
    assert!(compared.into_iter().all(|n| n >= 190), "{compared:?}");
}

/// The slope in the air is the same above and below the slab: so is the receiver's cosine, both ways. All orders.
#[test]
fn a_slab_is_reciprocal() {
    let mut compared = 0;
    random(60, |r: [f64; 8]| {
        let (bottom, top) = (0.9 + 0.2 * r[0], 1.5 + 0.3 * r[1]);
        let a = vec3(2.0 * r[2], 2.0 * r[3], 2.5 + 0.6 * r[4]);
        let b = vec3(2.0 * r[5], 2.0 * r[6], 0.0);
        let slab = |bottom: f64, top: f64, light: Vec3<f64>, x: Vec3<f64>, order: u32| {
            GlassSlab {
                bottom,
                top,
                index: 1.5 + 0.4 * r[7],
                light,
                intensity: 1.7,
                receiver_z: x.z,
            }
            .caustic(x.x, x.y, order)
        };
        for order in 0..4 {
            let there = slab(bottom, top, a, b, order);
            let back = slab(-top, -bottom, upside_down(b), upside_down(a), order);
            let c = there.conditioning() + back.conditioning();
            compared += assert_reciprocal("slab", there.value, back.value, c);
        }
    });
    assert_eq!(compared, 240);
}
