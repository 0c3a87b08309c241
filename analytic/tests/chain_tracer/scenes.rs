//! Scenes as entries and, apart, as what the tracer needs.

use nephroid_analytic::scene::Entry;

use super::{Light, World};

/// Cross-section over which parallel light is sampled [m²]: of no meaning but that all second moments contain it.
pub const BEAM: f64 = 2.7;

pub fn entry(kind: &str, rest: &str, camera: &str) -> Entry {
    let text = format!(
        r#"{{"name": "chain", "title": "t", "kind": "{kind}", {rest},
            "camera": {{"position": {camera}, "field_of_view_degrees": 5.0, "width": 8, "height": 8}}}}"#
    );
    let entry: Entry = serde_json::from_str(&text).expect("an entry");
    entry.validate().expect("valid");
    entry
}

/// An entry, its surfaces and light for the tracer.
pub struct Scene {
    pub entry: Entry,
    pub world: World,
    pub light: Light,
    pub floor: [[f64; 2]; 2],
}

pub fn corner() -> Scene {
    Scene {
        entry: entry(
            "planar-chains",
            r#""light": {"position": [1.6, 0.85, 1.35], "intensity": 4.4},
               "floor": {"center": [2.8, 1.3], "half_width": [1.3, 1.1], "albedo": 0.66},
               "wedge": {"divisor": 3, "reflectance": 0.84}"#,
            r#"[2.9, 1.35, 2.8], "look_at": [2.8, 1.3, 0.0]"#,
        ),
        world: World::Wedge(3, 0.84),
        light: Light::Point([1.6, 0.85, 1.35], 4.4),
        floor: [[1.5, 4.1], [0.2, 2.4]],
    }
}

pub fn slab() -> Scene {
    Scene {
        entry: entry(
            "glass-slab",
            r#""light": {"position": [0.4, -0.3, 2.6], "intensity": 6.5},
               "floor": {"half_width": [2.4, 2.2], "albedo": 0.65},
               "slab": {"bottom": 1.5, "top": 1.85, "index": 1.52}"#,
            r#"[-1.9, -2.5, 1.4], "look_at": [0.05, 0.02, 0.0]"#,
        ),
        world: World::Slab(1.5, 1.85, 1.52),
        light: Light::Point([0.4, -0.3, 2.6], 6.5),
        floor: [[-2.4, 2.4], [-2.2, 2.2]],
    }
}

pub fn ball() -> Scene {
    Scene {
        entry: entry(
            "glass-sphere",
            r#""light": {"irradiance": 0.37},
               "floor": {"half_width": [1.35, 1.25], "albedo": 0.65},
               "glass": {"center": [0.1, 0.15, 1.2], "radius": 0.8, "index": 1.36}"#,
            r#"[0.93, -0.68, 0.22], "look_at": [0.93, -0.6, 0.0]"#,
        ),
        world: World::Ball([0.1, 0.15, 1.2], 0.8, 1.36),
        light: Light::Down(0.37),
        floor: [[-1.35, 1.35], [-1.25, 1.25]],
    }
}

pub fn pillar(height: f64) -> Scene {
    Scene {
        entry: entry(
            "glass-pillar",
            &format!(
                r#""light": {{"elevation_degrees": 25.0, "irradiance": 3.3}},
                   "floor": {{"center": [0.65, 0.6], "half_width": [1.7, 1.6], "albedo": 0.57}},
                   "pillar": {{"center": [-0.3, 0.15], "radius": 0.62, "height": {height}, "index": 1.47}}"#
            ),
            r#"[1.68, 1.20, 3.4], "look_at": [1.5, 1.2, 0.0]"#,
        ),
        world: World::Pillar([-0.3, 0.15], 0.62, height, 1.47),
        light: Light::Sun(25.0_f64.to_radians(), 3.3),
        floor: [[-1.05, 2.35], [-1.0, 2.2]],
    }
}

pub fn cup(height: f64) -> Scene {
    Scene {
        entry: entry(
            "closed-cup",
            &format!(
                r#""light": {{"elevation_degrees": 22.0, "irradiance": 3.4}},
                   "floor": {{"center": [-0.17, 0.01], "half_width": [0.645, 0.542], "albedo": 0.66}},
                   "wall": {{"radius": 1.12, "height": {height}, "reflectance": 0.89}}"#
            ),
            r#"[-0.14, -0.02, 5.2], "look_at": [-0.17, 0.01, 0.0], "up": [0.0, 1.0, 0.0]"#,
        ),
        world: World::Cup(1.12, height, 0.89),
        light: Light::Sun(22.0_f64.to_radians(), 3.4),
        floor: [[-0.815, 0.475], [-0.532, 0.552]],
    }
}
