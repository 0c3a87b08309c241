//! Scaling, proportionality to the light, and the mirror symmetry of space.

use crate::varied::{assert_same, catalogue, change, is_length, variations};

/// E(kx) of the scene enlarged k times is E(x)/k² under a point light, E(x) under parallel light.
#[test]
fn irradiance_scales_with_the_scene() {
    for (name, entry) in catalogue() {
        let point_light = entry["light"].get("intensity").is_some();
        let mut compared = 0;
        variations(&name, &entry, 12, |varied, truth, [x, y]| {
            for k in [3.7, 0.013] {
                let scaled = change(varied, |table, key, _, v| match key {
                    "wave_vector" => v / k,
                    _ if is_length(table, key) => v * k,
                    _ => v,
                });
                let larger = crate::varied::truth(&scaled).expect("a scaled entry is as valid");
                let factor = if point_light { 1.0 / (k * k) } else { 1.0 };
                let (a, b) = (truth.at(x, y), larger.at(k * x, k * y));
                compared += assert_same(&name, "scaling", &a, &b, factor);
            }
        });
        assert!(compared >= 10, "{name}: {compared}");
    }
}

/// Twice the light is twice the irradiance, to the bit.
#[test]
fn irradiance_is_proportional_to_the_light() {
    for (name, entry) in catalogue() {
        variations(&name, &entry, 6, |varied, truth, [x, y]| {
            let twice = change(varied, |_, key, _, v| match key {
                "intensity" | "irradiance" => 2.0 * v,
                _ => v,
            });
            let brighter = crate::varied::truth(&twice).expect("as valid");
            for (a, b) in truth.at(x, y).iter().zip(brighter.at(x, y)) {
                assert_eq!(
                    2.0 * a.irradiance.value,
                    b.irradiance.value,
                    "{name} {}",
                    a.class
                );
            }
        });
    }
}

/// Kinds whose surfaces are not mapped to themselves by y → -y, other than through keys that are coordinates. For the wedge
/// see `motions`.
const HANDED: [&str; 1] = ["planar-chains"];

/// The scene mirrored at the plane y = 0 has the mirrored irradiance.
#[test]
fn irradiance_has_the_symmetry_of_space() {
    const POINTS: [&str; 9] = [
        "focus",
        "direction",
        "position",
        "center",
        "look_at",
        "normal",
        "edge",
        "up",
        "wave_vector",
    ];
    for (name, entry) in catalogue() {
        if HANDED.contains(&entry["kind"].as_str().unwrap()) {
            continue;
        }
        let mut compared = 0;
        variations(&name, &entry, 12, |varied, truth, [x, y]| {
            let mirrored = change(varied, |_, key, i, v| {
                if POINTS.contains(&key) && i == 1 || key == "azimuth_degrees" {
                    -v
                } else {
                    v
                }
            });
            let other = crate::varied::truth(&mirrored).expect("a mirrored entry is as valid");
            compared += assert_same(&name, "symmetry", &truth.at(x, y), &other.at(x, -y), 1.0);
        });
        assert!(compared >= 5, "{name}: {compared}");
    }
}
