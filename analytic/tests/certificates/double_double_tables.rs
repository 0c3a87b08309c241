//! The closed forms in double-double against the committed tables: thirty digits of every irradiance at every point. What
//! they share with the `f64` instance is the formula; a formula that is only nearly right cannot pass here.

use nephroid_analytic::double_double::DoubleDouble;
use nephroid_analytic::kinds::conic_mirrors::{Ellipsoid, Hyperboloid};
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::glass_pillar::GlassPillar;
use nephroid_analytic::kinds::glass_slab::GlassSlab;
use nephroid_analytic::kinds::glass_sphere::GlassSphere;
use nephroid_analytic::kinds::paraboloid::{Light as DishLight, Paraboloid};
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::kinds::planar_chains::{Corridor, Wedge};
use nephroid_analytic::kinds::sphere_mirror::{Light, Side, SphereMirror};
use nephroid_analytic::kinds::stigmatic_refractors::{Front, StigmaticRefractor};
use nephroid_analytic::kinds::water_waves::{WaterWaves, Wave};
use nephroid_analytic::kinds::{Estimate, diffuse};
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::Vec3;
use serde_json::Value;

use crate::reference_table::{configurations, number, vector};

type D = DoubleDouble;

/// Direct and caustic irradiance at a point; no direct one where the table has none.
type Form = Box<dyn Fn(Vec3<D>) -> (Option<Estimate<D>>, Estimate<D>)>;

fn sum(parts: impl Iterator<Item = Estimate<D>>) -> Estimate<D> {
    parts.fold(Estimate::NONE, |a, b| Estimate {
        value: a.value + b.value,
        error: a.error + b.error,
        roots: a.roots + b.roots,
    })
}

fn mirror(p: &Value) -> Form {
    let mirror = crate::reference_table::mirror::<D>(p);
    Box::new(move |x| (Some(mirror.direct(x)), mirror.caustic(x)))
}

fn floor(p: &Value) -> Form {
    let (light, intensity) = (vector(&p["light"]), number(&p["I"]));
    Box::new(move |x| (None, diffuse::direct(light, intensity, x)))
}

fn chains(p: &Value) -> Form {
    let (intensity, reflectance) = (number(&p["I"]), number(&p["R"]));
    if let Some(m) = p["m"].as_u64() {
        let m = m as u32;
        let polar = vector(&p["light_polar"]);
        let wedge = Wedge {
            m,
            radius: polar.x,
            angle: polar.y,
            height: polar.z,
            intensity,
            reflectance,
        };
        Box::new(move |x| {
            let caustic = sum((1..=m).map(|k| wedge.caustic(x.x, x.y, k)));
            (Some(wedge.direct(x.x, x.y)), caustic)
        })
    } else {
        let corridor = Corridor {
            width: number(&p["W"]),
            light: vector(&p["light"]),
            intensity,
            reflectance,
        };
        Box::new(move |x| {
            let caustic = sum((1..=6).map(|k| corridor.caustic(x.x, x.y, k)));
            (Some(corridor.direct(x.x, x.y)), caustic)
        })
    }
}

fn dish(p: &Value) -> Form {
    let focus = p.get("light").is_some();
    let dish = Paraboloid {
        focal_length: number(&p["f"]),
        reflectance: number(&p["R"]),
        light: if focus {
            DishLight::Focus(number(&p["I"]))
        } else {
            DishLight::Beam(number(&p["E0"]))
        },
        receiver_z: number(&p[if focus { "zr" } else { "c" }]),
        inner_radius: if focus { D::ZERO } else { number(&p["r0"]) },
        outer_radius: number(&p[if focus { "mirror_radius" } else { "r1" }]),
    };
    Box::new(move |x| (None, dish.caustic(x.x, x.y)))
}

fn conic(p: &Value) -> Form {
    let (eccentricity, intensity, reflectance) =
        (number(&p["e"]), number(&p["I"]), number(&p["R"]));
    if p.get("a").is_some() {
        let mirror = Ellipsoid {
            semi_axis: number(&p["a"]),
            eccentricity,
            defocus: number(&p["delta"]),
            intensity,
            reflectance,
        };
        Box::new(move |x| (Some(mirror.direct(x.x, x.y)), mirror.caustic(x.x, x.y)))
    } else {
        let mirror = Hyperboloid {
            semi_axis: number(&p["A"]),
            eccentricity,
            receiver_z: number(&p["zr"]),
            intensity,
            reflectance,
        };
        Box::new(move |x| (None, mirror.caustic(x.x, x.y)))
    }
}

fn stigmatic(p: &Value) -> Form {
    let front = if p.get("a").is_some() {
        Front::Ellipsoid {
            semi_axis: number(&p["a"]),
            irradiance: number(&p["E0"]),
        }
    } else {
        Front::Oval {
            light_z: number(&p["D"]),
            optical_length: number(&p["C"]),
            intensity: number(&p["I"]),
        }
    };
    let glass = StigmaticRefractor {
        index: number(&p["n"]),
        front,
        defocus: number(&p["delta"]),
    };
    Box::new(move |x| (None, glass.caustic(x.x, x.y)))
}

fn interface(p: &Value) -> Form {
    let water = crate::reference_table::water::<D>(p);
    Box::new(move |x| (Some(water.direct(x.x, x.y)), water.caustic(x.x, x.y)))
}

fn slab(p: &Value) -> Form {
    let slab = GlassSlab {
        bottom: number(&p["slab_z"][0]),
        top: number(&p["slab_z"][1]),
        index: number(&p["n"]),
        light: vector(&p["light"]),
        intensity: number(&p["I"]),
        receiver_z: D::ZERO,
    };
    Box::new(move |x| (None, sum((0..5).map(|k| slab.caustic(x.x, x.y, k)))))
}

fn sphere(p: &Value) -> Form {
    let point = p.get("light").is_some();
    let sphere = SphereMirror {
        centre: vector(&p["sphere_centre"]),
        radius: number(&p["a"]),
        side: if p["side"] == "concave" {
            Side::Concave
        } else {
            Side::Convex
        },
        cap_axis: vector(&p["cap_axis"]),
        cap_cos_min: number(&p["cap_cos_min"]),
        reflectance: number(&p["R"]),
        light: if point {
            Light::Point {
                position: vector(&p["light"]),
                intensity: number(&p["I"]),
            }
        } else {
            Light::Beam {
                direction: vector(&p["light_direction"]).normalized(),
                irradiance: number(&p["E0"]),
            }
        },
        receiver_z: number(&p["z_receiver"]),
    };
    Box::new(move |x| (point.then(|| sphere.direct(x)), sphere.caustic(x)))
}

fn ball(p: &Value) -> Form {
    let ball = GlassSphere {
        index: number(&p["n"]),
        radius: number(&p["a"]),
        irradiance: number(&p["E0"]),
        receiver_z: number(&p["receiver_z"]),
        max_incidence: number(&p["i_max"]),
    };
    let interactions = if ball.receiver_z > D::ZERO { 2 } else { 3 };
    Box::new(move |x| (None, ball.caustic(x.x.hypot(x.y), interactions)))
}

fn cup(p: &Value) -> Form {
    let cup = crate::reference_table::cup::<D>(p);
    let bounces = p["max_bounces"].as_u64().expect("bounces") as u32;
    Box::new(move |x| {
        let caustic = sum((1..=bounces).map(|k| cup.caustic(x.x, x.y, k)));
        (Some(cup.direct(x.x, x.y)), caustic)
    })
}

fn waves(p: &Value) -> Form {
    let waves = p["waves_A_k_phase"].as_array().expect("waves").iter();
    let waves = waves.map(|w| Wave {
        amplitude: number(&w[0]),
        wave_number: number(&w[1]),
        phase: number(&w[2]),
    });
    let water = WaterWaves::new(
        number(&p["n"]),
        number(&p["mean_depth_H"]),
        number(&p["E0"]),
        waves.collect(),
    );
    let water = water.expect("waves");
    Box::new(move |x| (None, water.caustic(x.x)))
}

fn pillar(p: &Value) -> Form {
    let pillar = Pillar {
        x: number(&p["center"][0]),
        y: number(&p["center"][1]),
        radius: number(&p["a"]),
        height: number(&p["H"]),
        reflectance: number(&p["R"]),
        light: vector(&p["light"]),
        intensity: number(&p["I"]),
    };
    Box::new(move |x| (Some(pillar.direct(x.x, x.y)), pillar.caustic(x.x, x.y)))
}

fn conic_wall(p: &Value) -> Form {
    let axis: (D, D) = (number(&p["axis"][0]), number(&p["axis"][1]));
    let length = axis.0.hypot(axis.1);
    let wall = ConicWall {
        x: number(&p["focus"][0]),
        y: number(&p["focus"][1]),
        axis: (axis.0 / length, axis.1 / length),
        parameter: number(&p["p"]),
        eccentricity: number(&p["e"]),
        half_arc: (p["half_arc"] != "closed").then(|| number(&p["half_arc"])),
        height: number(&p["H"]),
        reflectance: number(&p["R"]),
        light: vector(&p["light"]),
        intensity: number(&p["I"]),
    };
    Box::new(move |x| (Some(wall.direct(x.x, x.y)), wall.caustic(x.x, x.y)))
}

fn glass_pillar(p: &Value) -> Form {
    let pillar = GlassPillar {
        x: number(&p["center"][0]),
        y: number(&p["center"][1]),
        radius: number(&p["a"]),
        height: number(&p["H"]),
        index: number(&p["n"]),
        irradiance: number(&p["E0"]),
        sin_elevation: number(&p["sin_elevation"]),
        cos_elevation: number(&p["cos_elevation"]),
    };
    let most = p["max_interactions"].as_u64().expect("interactions") as u32;
    Box::new(move |x| {
        let caustic = sum((1..=most).map(|m| pillar.caustic(x.x, x.y, m)));
        (Some(pillar.direct(x.x, x.y)), caustic)
    })
}

/// Every point of a table: within the error bound, which is 2^-104 times the conditioning, and to 1e-30 where the
/// conditioning is below 100.
fn check(text: &str, form: fn(&Value) -> Form, points: u32) {
    let (mut seen, mut worst) = (0, (0.0, String::new()));
    for c in configurations(text) {
        let p = &c["parameters"];
        let plane = p.get("x_line").is_some() || p.get("albedo2").is_some();
        if plane {
            continue;
        }
        let form = form(p);
        for point in c["points"].as_array().expect("points") {
            let id = point["id"].as_str().expect("id");
            let (direct, caustic) = form(vector(&point["x"]));
            let mut compare = |estimate: Estimate<D>, key: &str| {
                let expected = number(&point[key]);
                let difference = (estimate.value - expected).abs();
                // The table is rounded in its 34th digit.
                let room = D::from_f64(1e-33) * expected.abs();
                assert!(
                    difference <= estimate.error + room,
                    "{id} {key}: {estimate:?} {expected:?}"
                );
                if expected > D::ZERO {
                    let relative = (difference / expected).high;
                    assert!(
                        relative < 1e-30 || estimate.conditioning().high > 100.0,
                        "{id} {relative:e}"
                    );
                    if estimate.conditioning().high < 100.0 && relative > worst.0 {
                        worst = (relative, id.to_owned());
                    }
                }
            };
            if let Some(direct) = direct.filter(|_| point.get("E_direct").is_some()) {
                compare(direct, "E_direct");
            }
            compare(caustic, "E_caustic");
            seen += 1;
        }
    }
    println!("worst {worst:?}");
    assert_eq!(seen, points);
}

macro_rules! tables {
    ($($test:ident $file:literal $form:ident $points:literal;)*) => {
        $(
            #[test]
            fn $test() {
                let text = include_str!(concat!("../../../golden/reference/", $file, ".json"));
                check(text, $form, $points);
            }
        )*
    };
}

tables! {
    diffuse_table "diffuse" floor 8;
    planar_mirror_table "planar-mirror" mirror 34;
    planar_chains_table "planar-chains" chains 24;
    paraboloid_table "paraboloid" dish 25;
    conic_mirrors_table "conic-mirrors" conic 24;
    stigmatic_refractors_table "stigmatic-refractors" stigmatic 24;
    flat_interface_table "flat-interface" interface 37;
    glass_slab_table "glass-slab" slab 12;
    concave_sphere_table "concave-sphere" sphere 45;
    convex_sphere_table "convex-sphere" sphere 19;
    glass_sphere_table "glass-sphere" ball 26;
    cylinder_cup_table "cylinder-cup" cup 64;
    water_waves_table "water-waves" waves 26;
    pillar_table "pillar" pillar 21;
    conic_wall_table "conic-wall" conic_wall 56;
    glass_pillar_table "glass-pillar" glass_pillar 31;
}
