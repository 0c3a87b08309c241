//! What a bundle says that its rays have lost, against the same light at mirrors that reflect everything, Snell's law by
//! bisection, Fresnel's sine and tangent laws, and the flux of an aperture.

use nephroid_analytic::entries;
use nephroid_analytic::scene::Kind;

const PI: f64 = core::f64::consts::PI;

/// Scenes with one reflectance R.
const MIRRORS: &[&str] = &[
    r#"{"kind": "cylinder-lamp", "light": {"azimuth_degrees": 174.0, "height": 1.37, "intensity": 4.3}, "floor": {"center": [0.15, 0.05], "half_width": [2.2, 2.3], "albedo": 0.64}, "wall": {"radius": 1.15, "height": 0.61, "half_arc_degrees": 125.0, "reflectance": R}}"#,
    r#"{"kind": "pillar", "light": {"position": [-1.3, 0.55, 1.25], "intensity": 5.3}, "floor": {"center": [0.1, -0.6], "half_width": [2.4, 2.7], "albedo": 0.62}, "pillar": {"center": [0.15, 0.45], "radius": 0.78, "height": 0.83, "reflectance": R}}"#,
    r#"{"kind": "conic-wall", "light": {"position": [-0.95, -0.45, 2.05], "intensity": 4.7}, "floor": {"center": [0.1, -0.1], "half_width": [1.9, 1.8], "albedo": 0.58}, "wall": {"focus": [0.15, -0.1], "direction": [1.6, 1.2], "parameter": 0.9, "eccentricity": 0.55, "half_arc_degrees": 80.0, "height": 0.86, "reflectance": R}}"#,
    r#"{"kind": "concave-sphere", "light": {"position": [0.45, 0.2, 1.42], "intensity": 0.23}, "floor": {"center": [-0.3, -0.1], "half_width": [2.4, 2.2], "albedo": 0.65}, "cap": {"center": [0.0, 0.0, 0.9], "radius": 1.6, "half_angle_degrees": 50.0, "reflectance": R}}"#,
    r#"{"kind": "convex-sphere", "light": {"position": [0.6, 0.25, 2.05], "intensity": 5.3}, "floor": {"center": [0.3, 0.1], "half_width": [2.3, 2.1], "albedo": 0.7}, "ball": {"center": [0.0, 0.03, 0.85], "radius": 0.45, "reflectance": R}}"#,
    r#"{"kind": "paraboloid", "light": {"intensity": 2.9}, "floor": {"center": [0.2, 0.0], "half_width": [2.5, 2.3], "albedo": 0.6}, "dish": {"center": [0.3, 0.15], "vertex_z": 1.6, "focal_length": 0.45, "inner_radius": 0.17, "outer_radius": 0.85, "reflectance": R}}"#,
    r#"{"kind": "conic-mirrors", "light": {"intensity": 1.3}, "floor": {"center": [0.3, 0.1], "half_width": [2.8, 2.7], "albedo": 0.7}, "conic": {"center": [0.1, 0.05], "semi_axis": 1.3, "eccentricity": 0.6, "image_z": 0.14, "rim_z": 0.95, "reflectance": R}}"#,
    r#"{"kind": "conic-mirrors", "light": {"intensity": 7.4}, "floor": {"center": [0.1, 0.0], "half_width": [2.4, 2.2], "albedo": 0.6}, "conic": {"center": [0.15, -0.05], "semi_axis": 0.13, "eccentricity": 3.2, "image_z": 2.3, "rim_z": 2.021, "reflectance": R}}"#,
    r#"{"kind": "closed-cup", "light": {"elevation_degrees": 22.0, "irradiance": 3.4}, "floor": {"center": [-0.47, 0.01], "half_width": [0.345, 0.342], "albedo": 0.66}, "wall": {"radius": 1.12, "height": 1.556, "reflectance": R}}"#,
    r#"{"kind": "planar-chains", "light": {"position": [1.6, 0.85, 1.35], "intensity": 4.4}, "floor": {"center": [2.8, 0.72], "half_width": [1.35, 0.57], "albedo": 0.66}, "wedge": {"divisor": 4, "reflectance": R}}"#,
];

fn kind(text: &str) -> Kind {
    serde_json::from_str(text).expect("a kind")
}

/// Fresnel's reflectance for the sine of the incidence in air, by angles.
fn reflectance(sine: f64, n: f64) -> f64 {
    let (i, t) = (libm::asin(sine), libm::asin(sine / n));
    let s = libm::sin(i - t) / libm::sin(i + t);
    let p = libm::tan(i - t) / libm::tan(i + t);
    0.5 * (s * s + p * p)
}

/// Parameters inside a domain.
fn inside(domain: [[f64; 2]; 2]) -> impl Iterator<Item = [f64; 2]> {
    let at = [0.07, 0.31, 0.37, 0.46, 0.58, 0.65, 0.93];
    at.into_iter().flat_map(move |a| {
        at.into_iter().map(move |b| {
            let [x, y] = domain;
            [x[0] + a * (x[1] - x[0]), y[0] + b * (y[1] - y[0])]
        })
    })
}

#[test]
fn mirrors_take_what_they_say() {
    for text in MIRRORS {
        let with = |r: &str| {
            entries::form(&kind(&text.replace("R}", &format!("{r}}}"))))
                .bundles()
                .expect("bundles")
        };
        let (part, all) = (with("0.7"), with("1.0"));
        let mut seen = 0;
        for (a, b) in part.iter().flatten().zip(all.iter().flatten()) {
            for u in inside(a.domain()) {
                let (x, y) = (a.ray(u), b.ray(u));
                let exists = x.margins.iter().all(|m| *m >= 0.0) && x.flux != 0.0;
                let reflected = exists && x.flux != y.flux;
                if !reflected {
                    continue;
                }
                seen += 1;
                let weight = a.weight(u).expect("a weight");
                let ratio = x.flux / y.flux;
                assert!(
                    (weight / ratio - 1.0).abs() < 1e-13,
                    "{text} {u:?} {weight}"
                );
                assert_eq!(b.weight(u), Some(1.0));
            }
        }
        assert!(seen >= 4, "{text} {seen}");
    }
}

#[test]
fn flat_water_transmits_by_fresnels_laws() {
    let (h, d, n) = (0.5, 1.6, 1.333);
    let form = entries::form(&kind(
        r#"{"kind": "underwater", "light": {"position": [0.35, 0.25, 2.1], "intensity": 7.5},
            "floor": {"half_width": [1.9, 1.7], "albedo": 0.65}, "water": {"surface_z": 1.6, "index": 1.333}}"#,
    ));
    let bundles = form.bundles().expect("bundles");
    for u in inside(bundles[0][0].domain()) {
        let plan = libm::hypot(u[0] - 0.35, u[1] - 0.25);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let p: f64 = 0.5 * (low + high);
            let reach = h * libm::tan(libm::asin(p)) + d * libm::tan(libm::asin(p / n));
            if reach < plan { low = p } else { high = p }
        }
        let weight = bundles[0][0].weight(u).expect("a weight");
        assert!((weight - 1.0 + reflectance(low, n)).abs() < 1e-13, "{u:?}");
    }
}

#[test]
fn ripples_transmit_by_fresnels_laws() {
    let form = entries::form(&kind(
        r#"{"kind": "water-waves", "light": {"irradiance": 0.72}, "floor": {"half_width": [1.7, 1.6], "albedo": 0.65},
            "water": {"surface_z": 1.85, "index": 1.333},
            "waves": [{"amplitude": 0.0185, "wave_vector": [11.0, 2.3], "phase": 0.4},
                      {"amplitude": 0.011, "wave_vector": [-5.2, 8.6], "phase": 1.9}]}"#,
    ));
    let bundles = form.bundles().expect("bundles");
    for u in inside(bundles[0][0].domain()) {
        let slope = |k: usize| {
            -0.0185 * [11.0, 2.3][k] * libm::sin(11.0 * u[0] + 2.3 * u[1] + 0.4)
                - 0.011 * [-5.2, 8.6][k] * libm::sin(-5.2 * u[0] + 8.6 * u[1] + 1.9)
        };
        let sine = libm::sin(libm::atan(libm::hypot(slope(0), slope(1))));
        let weight = bundles[0][0].weight(u).expect("a weight");
        assert!(
            (weight - 1.0 + reflectance(sine, 1.333)).abs() < 1e-13,
            "{u:?}"
        );
        let flux = bundles[0][0].ray(u).flux;
        assert!((flux - 0.72 * weight).abs() < 1e-15);
    }
}

/// ∫∫ flux/weight by the midpoint rule.
fn unattenuated(bundle: &dyn nephroid_analytic::flux::Bundle, steps: u32) -> f64 {
    let [[a, b], [c, d]] = bundle.domain();
    let area = (b - a) * (d - c) / f64::from(steps);
    (0..steps)
        .map(|k| {
            let u = [
                a + (b - a) * (f64::from(k) + 0.5) / f64::from(steps),
                0.5 * (c + d),
            ];
            bundle.ray(u).flux / bundle.weight(u).expect("a weight") * area
        })
        .sum()
}

/// All parametrisations here are uniform in the second parameter.
#[test]
fn glass_takes_the_flux_of_its_aperture() {
    let lens = entries::form(&kind(
        r#"{"kind": "stigmatic-refractors", "light": {"irradiance": 0.62}, "floor": {"half_width": [1.3, 1.2], "albedo": 0.6},
            "lens": {"center": [0.12, 0.08], "defocus": 0.63, "semi_axis": 0.9, "index": 1.52, "half_angle_degrees": 42.0}}"#,
    ));
    let (e, t) = (1.0 / 1.52, 42.0_f64.to_radians());
    let rim = 0.9 * (1.0 - e * e) / (1.0 - e * libm::cos(t)) * libm::sin(t);
    let found = unattenuated(lens.bundles().expect("bundles")[0][0].as_ref(), 4000);
    assert!(
        (found / (0.62 * PI * rim * rim) - 1.0).abs() < 1e-6,
        "{found}"
    );

    let ball = entries::form(&kind(
        r#"{"kind": "glass-sphere", "light": {"irradiance": 0.37}, "floor": {"half_width": [1.35, 1.25], "albedo": 0.65},
            "glass": {"center": [0.1, 0.15, 1.2], "radius": 0.8, "index": 1.36}}"#,
    ));
    for bundle in &ball.bundles().expect("bundles")[1..] {
        let found = unattenuated(bundle[0].as_ref(), 4000);
        assert!((found / (0.37 * PI * 0.64) - 1.0).abs() < 1e-6, "{found}");
    }

    let pillar = entries::form(&kind(
        r#"{"kind": "glass-pillar", "light": {"elevation_degrees": 25.0, "irradiance": 3.3},
            "floor": {"center": [0.65, 0.6], "half_width": [1.7, 1.6], "albedo": 0.57},
            "pillar": {"center": [-0.3, 0.15], "radius": 0.62, "height": 1.1, "index": 1.47}}"#,
    ));
    let face = 2.0 * 0.62 * 1.1 * libm::cos(25.0_f64.to_radians());
    for bundle in &pillar.bundles().expect("bundles")[1..] {
        let found = unattenuated(bundle[0].as_ref(), 4000);
        assert!((found / (3.3 * face) - 1.0).abs() < 1e-6, "{found}");
    }
}
