//! A mirror in two: the light of the whole is the light of the halves, root by root.
//!
//! Where no light meets the mirror twice, each ray of the whole belongs to exactly one half. What kinds can say a half of
//! their mirror in their own parameters is in [`MIRRORS`].

use libm::{cos, sin, sqrt};
use nephroid::entry;
use nephroid_analytic::entries::PointTruth;
use nephroid_analytic::kinds::sphere_mirror::{Light, Side, SphereMirror};
use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::vector::{Vec3, vec3};
use toml::Table;

use crate::varied::{
    assert_complete, catalogue, free_variations, get, get_vector, is_clear, look_down_at, random,
    set, truth,
};

/// Kinds, and how their mirror is split, or why it is not.
const MIRRORS: [(&str, Result<&str, &str>); 20] = [
    ("planar-mirror", Ok("two rectangles")),
    (
        "cylinder-lamp",
        Ok("two arcs, each turned to +x with the lamp"),
    ),
    (
        "conic-wall",
        Ok("two arcs of a circle: the axis of another conic cannot turn"),
    ),
    ("paraboloid", Ok("two rings")),
    ("concave-sphere", Ok("two hemispheres, by the form itself")),
    ("convex-sphere", Ok("two hemispheres, by the form itself")),
    ("diffuse", Err("no mirror")),
    ("furnace", Err("no mirror")),
    ("flat-interface", Err("an unbounded surface")),
    ("underwater", Err("an unbounded surface")),
    ("glass-slab", Err("an unbounded surface")),
    ("water-waves", Err("an unbounded surface")),
    (
        "planar-chains",
        Err("unbounded mirrors, and light that meets both"),
    ),
    (
        "pillar",
        Err("a whole circle from the floor up: its parts are no data of the kind"),
    ),
    (
        "glass-pillar",
        Err("light that goes in and out by any two parts of the side"),
    ),
    (
        "glass-sphere",
        Err("light that goes in and out by any two parts of the sphere"),
    ),
    (
        "stigmatic-refractors",
        Err("an aperture about the axis: the ring around a smaller one is no data of the kind"),
    ),
    (
        "conic-mirrors",
        Err("a cap above or below a rim: the ring around a smaller one is no data of the kind"),
    ),
    (
        "cylinder-cup",
        Err("an arc about +x, the beam's direction: it has no half that is"),
    ),
    (
        "closed-cup",
        Err("light that meets any two parts of the wall"),
    ),
];

#[test]
fn every_kind_says_how_its_mirror_is_split() {
    assert_complete(MIRRORS.iter().map(|m| m.0));
}

fn named(name: &str) -> Table {
    catalogue().into_iter().find(|(n, _)| n == name).unwrap().1
}

/// One class at one point.
fn class(light: &[PointTruth], name: &str) -> PointTruth {
    *light.iter().find(|p| p.class.to_string() == name).unwrap()
}

/// Asserts that whole + rest = first + second, in light and in rays; how many of the two halves shine, if the point is clear.
fn assert_sum(
    name: &str,
    whole: PointTruth,
    rest: Option<PointTruth>,
    halves: [PointTruth; 2],
) -> [u32; 2] {
    let [a, b] = halves;
    let all = [Some(whole), rest, Some(a), Some(b)];
    if !all.iter().flatten().all(is_clear) {
        return [0, 0];
    }
    let rest = rest.map_or((0.0, 0), |r| (r.irradiance.value, r.irradiance.roots));
    let (left, right) = (
        whole.irradiance.value + rest.0,
        a.irradiance.value + b.irradiance.value,
    );
    let bound: f64 = all.iter().flatten().map(|p| p.irradiance.error).sum();
    assert!(
        (left - right).abs() <= bound + 4e-15 * left,
        "{name}: {left:e} {right:e} ± {bound:e}"
    );
    assert_eq!(
        whole.irradiance.roots + rest.1,
        a.irradiance.roots + b.irradiance.roots,
        "{name}"
    );
    [a.irradiance.roots, b.irradiance.roots]
}

/// The two parts of a rectangle, cut along one of its edges.
fn rectangles(entry: &Table, share: f64, across: bool) -> [Table; 2] {
    let [n, e]: [Vec3<f64>; 2] =
        ["normal", "edge"].map(|k| Vec3::from_f64(get_vector(entry, "mirror", k)).normalized());
    let (direction, key) = if across {
        (n.cross(e), "half_height")
    } else {
        (e, "half_width")
    };
    let half = get(entry, "mirror", key);
    let center = Vec3::from_f64(get_vector(entry, "mirror", "center"));
    [(share, -1.0), (1.0 - share, 1.0)].map(|(share, side)| {
        let mut part = entry.clone();
        let c = center + direction * (side * half * (1.0 - share));
        set(&mut part, "mirror", "center", c.to_f64().to_vec());
        set(&mut part, "mirror", key, half * share);
        part
    })
}

#[test]
fn two_rectangles_reflect_and_hide_what_one_does() {
    let mut seen = [0; 2];
    let mut hidden = 0;
    free_variations(
        "mirror-wall",
        &named("mirror-wall"),
        60,
        |varied, whole, [x, y], r| {
            let parts = rectangles(varied, 0.5 + 0.4 * r[0], r[1] > 0.0);
            let [whole, a, b] = [
                whole.at(x, y),
                truth(&parts[0]).unwrap().at(x, y),
                truth(&parts[1]).unwrap().at(x, y),
            ];
            let both = |name: &str| [class(&a, name), class(&b, name)];
            let lit = assert_sum("LSDE", class(&whole, "LSDE"), None, both("LSDE"));
            (0..2).for_each(|k| seen[k] += lit[k]);
            // A ray that the whole stops is stopped by one half, and passes the other.
            let free = both("LDE")
                .into_iter()
                .max_by(|p, q| p.irradiance.value.total_cmp(&q.irradiance.value));
            let passed = assert_sum("LDE", class(&whole, "LDE"), free, both("LDE"));
            hidden += u32::from(passed[0] + passed[1] == 1);
        },
    );
    assert!(
        seen[0] >= 4 && seen[1] >= 4 && hidden >= 2,
        "{seen:?} {hidden}"
    );
}

/// Each floor point in front of the mirror is lit by one half at most, and the mirror's removed half hides none of them.
#[test]
fn images_of_reflected_light_add_up_too() {
    let mut whole = named("mirror-wall");
    for (key, size) in [("width", 24), ("height", 24)] {
        set(&mut whole, "camera", key, size);
    }
    let layer = |entry: &Table| {
        let entry = entry::from_toml("part.toml", &entry.to_string()).unwrap();
        let truth = PixelTruth::new(&entry).unwrap();
        let k = truth
            .classes()
            .iter()
            .position(|c| c.to_string() == "LSDE")
            .unwrap();
        (0..24)
            .flat_map(|j| truth.row(j, 1e-9).swap_remove(k))
            .collect::<Vec<_>>()
    };
    let all = layer(&whole);
    let brightest = all.iter().map(|p| p.value).fold(0.0, f64::max);
    let total: f64 = all.iter().map(|p| p.value).sum();
    for (share, across) in [(0.37, false), (0.61, true)] {
        let [a, b] = rectangles(&whole, share, across).each_ref().map(layer);
        for (k, w) in all.iter().enumerate() {
            let (sum, bound) = (a[k].value + b[k].value, a[k].error + b[k].error + w.error);
            assert!(
                (w.value - sum).abs() <= bound + 1e-14 * brightest,
                "{k}: {w:?} {sum:e}"
            );
        }
        for part in [a, b] {
            let part: f64 = part.iter().map(|p| p.value).sum();
            assert!(part > 0.05 * total && part < 0.95 * total, "{part} {total}");
        }
    }
}

/// A circular wall over the arc |φ| ≤ b as the arcs [-b, m] and [m, b], each turned about the axis until its middle is at
/// φ = 0, the lamp and the point with it. Inside the circle nothing stands between the wall and the point.
#[test]
fn two_arcs_under_a_lamp_reflect_what_one_does() {
    let mut entry = named("cup-rim");
    look_down_at(&mut entry, [0.01, 0.012]);
    for inset in [0.0, 0.31] {
        set(&mut entry, "light", "inset", inset);
        let mut seen = [0; 2];
        free_variations("cup-rim", &entry, 40, |varied, whole, _, r| {
            let (radius, b) = (
                get(varied, "wall", "radius"),
                get(varied, "wall", "half_arc_degrees"),
            );
            let (x, y) = inside(radius, r);
            let m = 0.6 * b * r[2];
            let halves = [(-b, m), (m, b)].map(|(from, to)| {
                let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
                let mut part = varied.clone();
                set(&mut part, "wall", "half_arc_degrees", half);
                let azimuth = get(varied, "light", "azimuth_degrees") - middle;
                set(
                    &mut part,
                    "light",
                    "azimuth_degrees",
                    azimuth - 360.0 * libm::round(azimuth / 360.0),
                );
                let (u, v) = turned(x, y, -middle);
                class(&truth(&part).unwrap().at(u, v), "LSDE")
            });
            let lit = assert_sum("arcs", class(&whole.at(x, y), "LSDE"), None, halves);
            (0..2).for_each(|k| seen[k] += lit[k]);
        });
        assert!(seen[0] >= 20 && seen[1] >= 20, "{inset} {seen:?}");
    }
}

/// As above for the conic wall: a conic of eccentricity 0 is a circle, whose axis may be any.
#[test]
fn two_arcs_of_a_conic_wall_reflect_what_one_does() {
    let mut entry = named("conic-wall");
    let focus: [f64; 2] = get_vector(&entry, "wall", "focus");
    look_down_at(&mut entry, focus);
    for (table, key, value) in [
        ("wall", "eccentricity", 0.0),
        ("wall", "height", 0.27),
        ("wall", "half_arc_degrees", 130.0),
    ] {
        set(&mut entry, table, key, value);
    }
    set(
        &mut entry,
        "light",
        "position",
        vec![focus[0] - 0.41, focus[1] + 0.17, 2.05],
    );
    let mut seen = [0; 2];
    free_variations("conic-wall", &entry, 150, |varied, whole, _, r| {
        let (p, b) = (
            get(varied, "wall", "parameter"),
            get(varied, "wall", "half_arc_degrees"),
        );
        let center: [f64; 2] = get_vector(varied, "wall", "focus");
        let (x, y) = inside(p, r);
        let (x, y) = (center[0] + x, center[1] + y);
        let m = 0.6 * b * r[2];
        let halves = [(-b, m), (m, b)].map(|(from, to)| {
            let mut part = varied.clone();
            set(&mut part, "wall", "half_arc_degrees", 0.5 * (to - from));
            let [c, s]: [f64; 2] = get_vector(varied, "wall", "direction");
            let (c, s) = turned(c, s, 0.5 * (from + to));
            set(&mut part, "wall", "direction", vec![c, s]);
            class(&truth(&part).unwrap().at(x, y), "LSDE")
        });
        let lit = assert_sum("arcs", class(&whole.at(x, y), "LSDE"), None, halves);
        (0..2).for_each(|k| seen[k] += lit[k]);
    });
    assert!(seen[0] >= 20 && seen[1] >= 20, "{seen:?}");
}

fn inside(radius: f64, r: [f64; 4]) -> (f64, f64) {
    let (distance, angle) = (
        0.97 * radius * sqrt(r[0].abs()),
        core::f64::consts::PI * r[1],
    );
    (distance * cos(angle), distance * sin(angle))
}

fn turned(x: f64, y: f64, degrees: f64) -> (f64, f64) {
    let (s, c) = libm::sincos(degrees.to_radians());
    (c * x - s * y, s * x + c * y)
}

#[test]
fn two_rings_of_a_dish_reflect_what_one_does() {
    let mut seen = [0; 2];
    free_variations("dish", &named("dish"), 40, |varied, whole, [x, y], r| {
        let (inner, outer) = (
            get(varied, "dish", "inner_radius"),
            get(varied, "dish", "outer_radius"),
        );
        let cut = inner + (0.5 + 0.4 * r[0]) * (outer - inner);
        let halves = [("outer_radius", cut), ("inner_radius", cut)].map(|(key, value)| {
            let mut part = varied.clone();
            set(&mut part, "dish", key, value);
            class(&truth(&part).unwrap().at(x, y), "LSDE")
        });
        let lit = assert_sum("rings", class(&whole.at(x, y), "LSDE"), None, halves);
        (0..2).for_each(|k| seen[k] += lit[k]);
    });
    assert!(seen[0] >= 4 && seen[1] >= 4, "{seen:?}");
}

/// A whole sphere as its halves on both sides of any plane through its centre. Inside, chords meet no other part of it;
/// outside, reflected light meets none.
#[test]
fn two_hemispheres_reflect_what_a_sphere_does() {
    for (side, reach) in [(Side::Concave, [0.9, 0.9]), (Side::Convex, [3.0, 2.2])] {
        let mut seen = [0; 2];
        random(400, |r: [f64; 10]| {
            let at = |k: usize, reach: f64| {
                let v = vec3(r[k], r[k + 1], r[k + 2]);
                match side {
                    Side::Concave => v * (reach / sqrt(3.0)),
                    Side::Convex => v.normalized() * (1.05 + (reach - 1.05) * r[9].abs()),
                }
            };
            let (light, x) = (at(0, reach[0]), at(3, reach[1]));
            let axis = vec3(r[6], r[7], r[8]).normalized();
            let part = |cap_axis: Vec3<f64>, cap_cos_min: f64| {
                SphereMirror {
                    centre: vec3(0.0, 0.0, 0.0),
                    radius: 1.0,
                    side,
                    cap_axis,
                    cap_cos_min,
                    reflectance: 0.83,
                    light: Light::Point {
                        position: light,
                        intensity: 1.7,
                    },
                    receiver_z: x.z,
                }
                .caustic(x)
            };
            let class = nephroid_analytic::class::PathClass::LSDE;
            let [whole, a, b] = [(axis, -1.0), (axis, 0.0), (-axis, 0.0)]
                .map(|(axis, cos)| PointTruth::new(class, part(axis, cos)));
            let lit = assert_sum("hemispheres", whole, None, [a, b]);
            (0..2).for_each(|k| seen[k] += lit[k]);
        });
        assert!(seen[0] >= 30 && seen[1] >= 30, "{side:?} {seen:?}");
    }
}
