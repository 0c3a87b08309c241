//! Names for a constant factor.

use core::f64::consts::PI;

use libm::{cos, sin, tan};
use nephroid_analytic::scene::Entry;

/// A factor with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// How it is written.
    pub name: String,
    /// Its value.
    pub value: f64,
}

/// Factors that renderers gain or lose: pure numbers, the scene's own constants, and what normalisations of a kernel of
/// bandwidth α come to where there is one.
pub fn candidates(entry: &Entry, bandwidth: Option<f64>) -> Vec<Named> {
    let mut list = Vec::new();
    let mut add = |name: &str, value: f64| {
        if value > 0.0 && value.is_finite() && (value - 1.0).abs() > 1e-6 {
            let name = name.to_owned();
            list.push(Named { name, value });
        }
    };
    for (name, value) in [
        ("2", 2.0),
        ("1/2", 0.5),
        ("π", PI),
        ("1/π", 1.0 / PI),
        ("4π", 4.0 * PI),
        ("1/(4π)", 0.25 / PI),
        ("2π", 2.0 * PI),
        ("1/(2π)", 0.5 / PI),
        ("4", 4.0),
        ("1/4", 0.25),
        ("3/4", 0.75),
    ] {
        add(name, value);
    }
    for (symbol, value) in own_constants(entry) {
        add(symbol, value);
        add(&format!("1/{symbol}"), 1.0 / value);
        if symbol == "n" {
            add("n²", value * value);
            add("1/n²", 1.0 / (value * value));
        }
    }
    let side = 2.0 * tan(0.5 * entry.camera.field_of_view_degrees.to_radians())
        / f64::from(entry.camera.height);
    add("the side of a pixel", side);
    add("1/(the side of a pixel)", 1.0 / side);
    if let Some(a) = bandwidth {
        add("the bandwidth", a);
        add("1/bandwidth", 1.0 / a);
        let cap = 2.0 * (1.0 - cos(a));
        add("2π(1 - cos α)/(πα²)", cap / (a * a));
        add("2π(1 - cos α)/(π tan² α)", cap / (tan(a) * tan(a)));
        let quarter = sin(0.25 * a) / sin(0.5 * a);
        add(
            "(1 - cos(α/2))/(1 - cos α), half angle and full angle",
            quarter * quarter,
        );
    }
    list
}

/// The scene's constants that multiply light, by the names they have in formulas.
fn own_constants(entry: &Entry) -> Vec<(&'static str, f64)> {
    const SYMBOLS: [(&str, &str); 5] = [
        ("albedo", "ρ"),
        ("reflectance", "R"),
        ("intensity", "I"),
        ("irradiance", "E₀"),
        ("index", "n"),
    ];
    fn walk(value: &serde_json::Value, found: &mut Vec<(&'static str, f64)>) {
        let Some(map) = value.as_object() else {
            return;
        };
        for (key, value) in map {
            let symbol = SYMBOLS.iter().find(|(k, _)| k == key);
            match (symbol, value.as_f64()) {
                (Some(&(_, symbol)), Some(v)) => found.push((symbol, v)),
                _ => walk(value, found),
            }
        }
    }
    let mut found = Vec::new();
    if let Ok(value) = serde_json::to_value(&entry.kind) {
        walk(&value, &mut found);
    }
    found
}

/// Factors that come from what is met on the way, by its mean.
pub fn of_weight(mean: f64) -> Vec<Named> {
    let named = |name: &str, value: f64| Named {
        name: name.to_owned(),
        value,
    };
    vec![
        named("T, the mean reflectance or transmittance on the way", mean),
        named(
            "1/T, of the mean reflectance or transmittance on the way",
            1.0 / mean,
        ),
        named(
            "(1 - T)/T, of the mean reflectance or transmittance on the way",
            (1.0 - mean) / mean,
        ),
    ]
}

/// The names of a factor that is known to ± `error`, the nearest first; at most three.
pub fn names(candidates: &[Named], factor: f64, error: f64) -> Vec<String> {
    // Within three standard errors, or a relative 0.2 % that a truth's own bound may take.
    let mut near: Vec<_> = candidates
        .iter()
        .map(|c| ((c.value - factor).abs(), c))
        .filter(|(off, c)| *off <= f64::max(3.0 * error, 0.002 * c.value))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter()
        .take(3)
        .map(|(_, c)| c.name.clone())
        .collect()
}
