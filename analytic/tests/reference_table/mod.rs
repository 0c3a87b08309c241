//! Readers of the committed tables, in any precision.

use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{Beam, CylinderCup, Light, Wall};
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::planar_mirror::PlanarMirror;
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::{Vec3, vec3};
use serde_json::Value;

/// A decimal.
pub fn number<S: Scalar>(value: &Value) -> S {
    S::from_decimal(value.as_str().expect("a decimal")).expect("a decimal")
}

/// Three decimals.
pub fn vector<S: Scalar>(value: &Value) -> Vec3<S> {
    vec3(number(&value[0]), number(&value[1]), number(&value[2]))
}

/// The configurations of a table.
pub fn configurations(text: &str) -> Vec<Value> {
    let file: Value = serde_json::from_str(text).expect("JSON");
    file["configurations"].as_array().expect("an array").clone()
}

/// A cup under the sun or a lamp.
pub fn cup<S: Scalar>(p: &Value) -> CylinderCup<S> {
    let light = if p.get("light").is_some() {
        let at = vector(&p["light"]);
        Light::Point(Lamp {
            x: at.x,
            y: at.y,
            height: at.z,
            intensity: number(&p["I"]),
        })
    } else {
        Light::Beam(Beam {
            irradiance: number(&p["E0"]),
            sin_elevation: number(&p["sin_elevation"]),
            cos_elevation: number(&p["cos_elevation"]),
        })
    };
    CylinderCup {
        wall: Wall {
            radius: number(&p["a"]),
            height: (p["wall_height"] != "unbounded").then(|| number(&p["wall_height"])),
            cos_half_arc: (p["wall"] == "half").then_some(S::ZERO),
        },
        reflectance: number(&p["R"]),
        light,
    }
}

/// An unbounded plane mirror.
pub fn mirror<S: Scalar>(p: &Value) -> PlanarMirror<S> {
    PlanarMirror::new(
        vector(&p["light"]),
        number(&p["I"]),
        number(&p["R"]),
        vector(&p["mirror_point"]),
        vector(&p["mirror_normal"]).normalized(),
        None,
    )
}

/// A water surface.
pub fn water<S: Scalar>(p: &Value) -> FlatInterface<S> {
    FlatInterface {
        surface_z: number(&p["surface_z"]),
        index: number(&p["n"]),
        light: vector(&p["light"]),
        intensity: number(&p["I"]),
        receiver_z: p.get("Z").map_or(S::ZERO, number),
    }
}
