//! Mirrors of revolution over a floor: flux against solid angles, pixels against point values, and what is refused.

use crate::gauss;

use std::f64::consts::PI;

use nephroid::{entry, truth};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::{FloorTruth, State};
use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::scene::Entry;
use toml::{Table, Value};

fn load(name: &str, changes: &[(&str, &str, Value)]) -> Result<Entry, String> {
    let text = std::fs::read_to_string(format!("scenes/{name}.toml")).unwrap();
    let mut table: Table = text.parse().unwrap();
    for (section, key, value) in changes {
        table[*section]
            .as_table_mut()
            .unwrap()
            .insert((*key).to_owned(), value.clone());
    }
    entry::from_toml("changed.toml", &table.to_string()).map_err(|e| {
        let help = miette::Diagnostic::help(&e).map(|h| h.to_string());
        format!("{e} | {}", help.unwrap_or_default())
    })
}

fn list(values: &[f64]) -> Value {
    Value::Array(values.iter().map(|&v| Value::Float(v)).collect())
}

/// Flux that each class lands on the floor, from the image of a camera that looks straight down from (x, y, z) over a
/// square of the floor: every pixel sees the same area.
fn fluxes(
    name: &str,
    changes: &[(&str, &str, Value)],
    [x, y, z]: [f64; 3],
    field_of_view: f64,
) -> Vec<f64> {
    let pixels = 24;
    let mut all = changes.to_vec();
    all.extend([
        ("camera", "position", list(&[x, y, z])),
        ("camera", "look_at", list(&[x, y, 0.0])),
        ("camera", "up", list(&[0.2, 0.9, 0.0])),
        (
            "camera",
            "field_of_view_degrees",
            Value::Float(field_of_view),
        ),
        ("camera", "width", Value::Integer(pixels)),
        ("camera", "height", Value::Integer(pixels)),
    ]);
    let scene = load(name, &all).unwrap();
    let image = truth::image(&scene, 1e-9);
    let side = 2.0 * z * libm::tan(0.5 * field_of_view.to_radians());
    let albedo = scene.kind.floor().unwrap().albedo;
    let means = image.class_means();
    for mean in &means {
        assert!(mean.error <= 1e-7 * mean.value, "{name} {mean:?}");
    }
    let flux = |mean: f64| mean * side * side * PI / albedo;
    means.iter().map(|m| flux(m.value)).collect()
}

fn assert_close(what: &str, found: f64, expected: f64, tolerance: f64) {
    let off = (found / expected - 1.0).abs();
    assert!(off <= tolerance, "{what}: {found} for {expected} ({off:e})");
}

/// A mirror about an axis takes the light of a point on it within the angle of its rim: I R 2π (1 - cos α), all of which
/// lands on the floor. A hole takes the same with its own angle.
#[test]
fn the_flux_on_the_floor_is_that_of_the_mirrors_solid_angle() {
    let cone = |z: f64, r: f64| 2.0 * PI * (1.0 - z / libm::hypot(z, r));
    let parameter = |name: &str, table: &str, key: &str| {
        let text = std::fs::read_to_string(format!("scenes/{name}.toml")).unwrap();
        let table = text.parse::<Table>().unwrap()[table].clone();
        table[key].as_float().unwrap()
    };

    // Heights over the focus of the points of z = v - r²/(4f): f - r²/(4f).
    let d = |key| parameter("dish", "dish", key);
    let above = |r: f64| d("focal_length") - r * r / (4.0 * d("focal_length"));
    let solid = cone(above(d("outer_radius")), d("outer_radius"))
        - cone(above(d("inner_radius")), d("inner_radius"));
    let expected = parameter("dish", "light", "intensity") * d("reflectance") * solid;
    let found = fluxes("dish", &[], [0.3, 0.1, 1.15], 88.0)[1];
    assert_close("dish", found, expected, 1e-7);

    for (name, camera, angle, image_z) in [
        ("ellipsoid", [0.1, 0.0, 0.6], 50.0, 0.14),
        ("ellipsoid", [0.1, 0.0, 0.6], 50.0, 0.003),
        ("ellipsoid", [0.1, 0.0, 0.6], 50.0, -0.11),
        // All light in one point: flux without an irradiance.
        ("ellipsoid", [0.104, 0.003, 0.6], 50.0, 0.0),
        ("hyperboloid", [0.1, 0.0, 1.4], 90.0, 2.3),
    ] {
        let c = |key| parameter(name, "conic", key);
        // By the definition of a conic: the distances of a point on it from the foci have the sum, or the difference, 2a.
        // Then r² = r1² - (z - z1)², with r2 = e times the distance from the directrix of its focus.
        let (a, e) = (c("semi_axis"), c("eccentricity"));
        let sign = if e < 1.0 { 1.0 } else { -1.0 };
        let light_z = image_z + sign * 2.0 * a * e;
        let middle = 0.5 * (light_z + image_z);
        // The rim keeps its place on the mirror.
        let rim_z = c("rim_z") + image_z - c("image_z");
        let r1 = (a - e * sign * (rim_z - middle)).abs();
        let up = rim_z - light_z;
        let solid = 2.0 * PI * (1.0 - up / r1);
        let expected = parameter(name, "light", "intensity") * c("reflectance") * solid;
        let changes = [
            ("conic", "image_z", Value::Float(image_z)),
            ("conic", "rim_z", Value::Float(rim_z)),
        ];
        let found = fluxes(name, &changes, camera, angle)[1];
        assert_close(&format!("{name} {image_z}"), found, expected, 1e-7);
    }

    // On the axis of the cap the same holds, although the light lands all over a caustic.
    let s = |key| parameter("dome", "cap", key);
    let half_angle = s("half_angle_degrees").to_radians();
    let (rim_r, rim_z) = (
        s("radius") * libm::sin(half_angle),
        0.9 + s("radius") * libm::cos(half_angle),
    );
    for light_z in [1.3, 1.55] {
        let expected = parameter("dome", "light", "intensity")
            * s("reflectance")
            * cone(rim_z - light_z, rim_r);
        let changes = [("light", "position", list(&[0.0, 0.0, light_z]))];
        let found = fluxes("dome", &changes, [0.07, -0.04, 1.2], 120.0)[1];
        assert_close(&format!("dome {light_z}"), found, expected, 1e-7);
    }
}

/// What the ball takes from the floor's direct light is I times its solid angle, 2π (1 - √(1 - a²/D²)).
#[test]
fn the_balls_shadow_is_its_solid_angle() {
    let light = [0.3, 0.1, 3.1];
    let changes = [
        ("light", "position", list(&light)),
        ("ball", "center", list(&[0.0, 0.0, 1.6])),
        ("ball", "radius", Value::Float(0.31)),
        ("floor", "center", list(&[0.0, 0.0])),
        ("floor", "half_width", list(&[2.0, 2.0])),
    ];
    let camera = [-0.3, -0.1, 1.1];
    let lit = fluxes("ball", &changes, camera, 100.0)[0];
    // The same square without a ball: the square's solid angle at the light, corner by corner.
    let half = camera[2] * libm::tan(50.0_f64.to_radians());
    // The camera is turned by its up vector.
    let (s, c) = {
        let length = libm::hypot(0.2, 0.9);
        (0.2 / length, 0.9 / length)
    };
    let (dx, dy) = (camera[0] - light[0], camera[1] - light[1]);
    let (x, y) = (c * dx - s * dy, s * dx + c * dy);
    let corner = |x: f64, y: f64| {
        libm::atan(x * y / (light[2] * libm::sqrt(x * x + y * y + light[2] * light[2])))
    };
    let free = corner(x + half, y + half) - corner(x - half, y + half) - corner(x + half, y - half)
        + corner(x - half, y - half);
    let d2 = 0.3 * 0.3 + 0.1 * 0.1 + 1.5 * 1.5;
    let ball = 2.0 * PI * (1.0 - libm::sqrt(1.0 - 0.31 * 0.31 / d2));
    assert_close("ball", lit, 5.3 * (free - ball), 1e-7);
}

/// In pixels that no edge and no fold crosses the mean is that of 4 × 4 point values of the closed form, to the accuracy
/// of Gauss's rule, which its 3 × 3 points tell.
#[test]
fn smooth_pixels_are_the_means_of_point_values() {
    for name in ["dome", "ball", "dish", "ellipsoid", "hyperboloid"] {
        let scene = entry::load(name).unwrap();
        let film = nephroid_analytic::camera::Film::new(&scene.camera);
        let closed = FloorTruth::new(&scene).unwrap();
        let image = truth::image(&scene, 1e-9);
        let scale = closed.albedo() / PI;
        let classes = image.classes.len();
        let mut compared = vec![0; classes];
        // All over the frame, and once more in its middle.
        for k in 0..72_usize {
            let (i, j) = if k < 36 {
                (11 + 21 * (k % 6), 9 + 21 * (k / 6))
            } else {
                (53 + 4 * (k % 6), 57 + 3 * (k / 6 - 6))
            };
            let mean = |rule: &[(f64, f64)]| {
                let mut sum = vec![0.0; classes];
                for &(s, ws) in rule {
                    for &(t, wt) in rule {
                        let d = film.direction(i as f64 + s, j as f64 + t);
                        let p = film.position + d * (-film.position.z / d.z);
                        if closed.is_on_floor(p.x, p.y) {
                            for (sum, at) in sum.iter_mut().zip(closed.at(p.x, p.y)) {
                                *sum += scale * ws * wt * at.irradiance.value;
                            }
                        }
                    }
                }
                sum
            };
            let (three, four) = (mean(gauss::rule(3)), mean(gauss::rule(4)));
            for c in 0..classes {
                let found = image.layers[c][j * image.width as usize + i];
                let spread = (three[c] - four[c]).abs();
                if four[c] > 0.0 && spread <= 1e-7 * four[c] {
                    let off = (found - four[c]).abs();
                    assert!(
                        off <= 1e-8 * four[c] + 0.1 * spread,
                        "{name} {} ({i}, {j}): {found} for {}",
                        image.classes[c],
                        four[c]
                    );
                    compared[c] += 1;
                }
            }
        }
        assert!(compared.iter().all(|&n| n >= 4), "{name}: {compared:?}");
    }
}

#[test]
fn a_floor_in_the_focus_is_reported_as_degenerate() {
    let changes = [("conic", "image_z", Value::Float(0.0))];
    let scene = load("ellipsoid", &changes).unwrap();
    let closed = FloorTruth::new(&scene).unwrap();
    let caustic = |x: f64, y: f64| closed.at(x, y)[1];
    let focus = caustic(0.1, 0.05);
    assert_eq!(focus.class, PathClass::LSDE);
    assert_eq!(closed.state(0.1, 0.05, 1, &focus), State::Degenerate);
    let beside = caustic(0.1, 0.06);
    assert_eq!(beside.irradiance.value, 0.0);
    let singularity = closed.singularity(0.1, 0.06, 1).unwrap();
    assert_eq!(singularity.kind, SingularityKind::PointFocus);
    assert!((singularity.distance - 0.01).abs() < 1e-15);
}

#[test]
fn what_breaks_the_closed_form_or_the_picture_is_refused() {
    let point = |x, y, z| list(&[x, y, z]);
    let refusals: [(&str, &str, &str, Value, &str); 15] = [
        (
            "dome",
            "light",
            "position",
            point(0.4, 0.2, 2.1),
            "below the rim",
        ),
        (
            "dome",
            "camera",
            "position",
            point(-1.5, -1.6, 2.2),
            "camera lower than",
        ),
        (
            "dome",
            "camera",
            "look_at",
            point(-0.6, -0.3, 1.6),
            "below the horizon",
        ),
        (
            "dome",
            "cap",
            "half_angle_degrees",
            Value::Float(91.0),
            "90",
        ),
        (
            "dome",
            "cap",
            "center",
            point(0.0, 0.0, -1.2),
            "above z = 0",
        ),
        (
            "ball",
            "ball",
            "center",
            point(0.0, 0.0, 0.4),
            "above the floor",
        ),
        (
            "ball",
            "light",
            "position",
            point(0.9, 0.3, 1.2),
            "greater than 1.3",
        ),
        (
            "ball",
            "camera",
            "look_at",
            point(0.1, 0.0, 0.6),
            "beside the ball",
        ),
        (
            "dish",
            "dish",
            "outer_radius",
            Value::Float(1.8),
            "rim is above the floor",
        ),
        (
            "dish",
            "dish",
            "focal_length",
            Value::Float(1.7),
            "focus is above the floor",
        ),
        (
            "ellipsoid",
            "conic",
            "rim_z",
            Value::Float(0.1),
            "greater than 0.14",
        ),
        (
            "ellipsoid",
            "conic",
            "eccentricity",
            Value::Float(1.0),
            "ellipsoid",
        ),
        (
            "hyperboloid",
            "conic",
            "rim_z",
            Value::Float(1.9),
            "greater than",
        ),
        (
            "hyperboloid",
            "conic",
            "image_z",
            Value::Float(0.8),
            "light above the floor",
        ),
        (
            "furnace",
            "light",
            "position",
            point(0.3, -0.2, 3.6),
            "inside the wall",
        ),
    ];
    for (name, table, key, value, words) in refusals {
        let message = load(name, &[(table, key, value)]).unwrap_err();
        assert!(
            message.contains(words) && message.contains(&format!("{table}.{key}")),
            "{name} {table}.{key}: {message}"
        );
    }
}
