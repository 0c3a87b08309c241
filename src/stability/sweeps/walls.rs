//! The vertical walls that no reference table has: pillar, conic wall and glass pillar, towards each of their dangers.

use core::f64::consts::FRAC_PI_2;

use libm::{asin, atan2, cos, sin, sincos, sqrt};

use super::fold::FOLD;
use super::grazing::GRAZING;
use super::size::{FAR, PURE, SCALE};
use super::{Sweep, caustic, far, graze, near, scale};
use crate::stability::inputs::Inputs;

/// The sweeps.
pub(super) fn sweeps() -> Vec<Sweep> {
    vec![
        caustic("conic-wall", FOLD, near(), next_to_conic_caustic),
        caustic("glass-pillar", FOLD, near(), next_to_glass_caustic),
        caustic("pillar", GRAZING, graze(), grazing_pillar),
        caustic("conic-wall", GRAZING, graze(), grazing_conic),
        caustic("glass-pillar", GRAZING, graze(), |t| {
            let i = FRAC_PI_2 - t;
            glass(1.0, glass_point(1.0, i, 0.5 + cos(i)))
        }),
        caustic(
            "glass-pillar",
            ("grazing refraction", GRAZING.1),
            graze(),
            |t| {
                let i = FRAC_PI_2 - t;
                glass(2.0, glass_point(2.0, i, 0.5 + cos(i)))
            },
        ),
        caustic(
            "conic-wall",
            ("lamp at the focus", "distance to the focus [m]"),
            near(),
            |t| conic([0.6 * t, 0.8 * t], [0.25, -0.125]),
        ),
        caustic(
            "conic-wall",
            ("receiver at the focus", "distance to the other focus [m]"),
            near(),
            // The other focus of e = 1/2, p = 3/4 is at x = -1.
            |t| conic([0.0, 0.0], [-1.0 + 0.6 * t, 0.8 * t]),
        ),
        caustic("pillar", SCALE, scale(), |t| pillar().scaled(t, &PURE)),
        caustic("conic-wall", SCALE, scale(), |t| {
            conic(LAMP, [0.25, -0.125]).scaled(t, &PURE)
        }),
        caustic("glass-pillar", SCALE, scale(), |t| {
            glass(2.0, [1.25, 0.125]).scaled(t, &PURE)
        }),
        caustic("pillar", FAR, far(), |t| {
            pillar().translated(t, &["light", "centre"])
        }),
        caustic("conic-wall", FAR, far(), |t| {
            conic(LAMP, [0.25, -0.125]).translated(t, &["light", "focus"])
        }),
        caustic("glass-pillar", FAR, far(), |t| {
            glass(2.0, [1.25, 0.125]).translated(t, &["centre"])
        }),
    ]
}

fn pillar() -> Inputs {
    let numbers = [("a", 0.5), ("height", 4.0), ("R", 0.875), ("I", 5.0)];
    Inputs::new(&numbers, [0.75, 1.25])
        .with("centre", &[0.0, 0.0])
        .with("light", &[1.25, -0.25, 1.5])
}

/// The ray that meets the pillar at the angle t to its side.
fn grazing_pillar(t: f64) -> Inputs {
    let (lx, ly) = (1.25, -0.25);
    let i = FRAC_PI_2 - t;
    // The triangle of axis, light and side.
    let at_axis = i - asin(0.5 * sin(i) / sqrt(lx * lx + ly * ly));
    let (ny, nx) = sincos(atan2(ly, lx) + at_axis);
    let (px, py) = (0.5 * nx, 0.5 * ny);
    let [x, y] = reflected([px, py], [px - lx, py - ly], [nx, ny], 1.0);
    pillar().at_point([x, y])
}

/// The point at a distance along the ray that comes to `at` along `ray` and is reflected at the normal.
fn reflected(at: [f64; 2], ray: [f64; 2], normal: [f64; 2], distance: f64) -> [f64; 2] {
    let length = sqrt(ray[0] * ray[0] + ray[1] * ray[1]);
    let along =
        (ray[0] * normal[0] + ray[1] * normal[1]) / (normal[0] * normal[0] + normal[1] * normal[1]);
    [0, 1].map(|k| at[k] + (ray[k] - 2.0 * along * normal[k]) * (distance / length))
}

/// Beside the focus of the ellipse.
const LAMP: [f64; 2] = [-0.25, 0.375];

/// A closed ellipse about the focus 0 with the other focus at x = -1.
fn conic(lamp: [f64; 2], x: [f64; 2]) -> Inputs {
    let numbers = [
        ("p", 0.75),
        ("e", 0.5),
        ("height", 4.0),
        ("R", 0.875),
        ("I", 1.0),
    ];
    Inputs::new(&numbers, x)
        .with("focus", &[0.0, 0.0])
        .with("axis", &[1.0, 0.0])
        .with("light", &[lamp[0], lamp[1], 1.5])
}

/// Point and inner normal (of any length) of the ellipse at the angle θ.
fn on_conic(theta: f64) -> ([f64; 2], [f64; 2]) {
    let (s, c) = sincos(theta);
    let r = 0.75 / (1.0 + 0.5 * c);
    ([r * c, r * s], [-(c + 0.5), -s])
}

/// A chord of the ellipse at the angle t to its side, a lamp on it and the point on its reflection: both a third of the
/// chord of the circle of curvature away.
fn grazing_conic(t: f64) -> Inputs {
    let theta = 0.75;
    let ([qx, qy], [nx, ny]) = on_conic(theta);
    let m = sqrt(nx * nx + ny * ny);
    let (nx, ny) = (nx / m, ny / m);
    let delta = 1.0 + 0.5 * cos(theta);
    let curvature = 0.75 * m * m * m / (delta * delta * delta);
    let distance = curvature * sin(t) * (2.0 / 3.0);
    let (s, c) = sincos(t);
    let to = |side: f64| {
        [
            qx + distance * (s * nx + side * c * ny),
            qy + distance * (s * ny - side * c * nx),
        ]
    };
    conic(to(1.0), to(-1.0))
}

/// A point at the distance t from the ellipse's caustic, where the ray by θ = 1 touches it, on the bright side.
fn next_to_conic_caustic(t: f64) -> Inputs {
    let theta = 1.0;
    // Direction of the reflected ray, by way of its point at a unit distance.
    let ray = |theta: f64| {
        let (q, n) = on_conic(theta);
        let end = reflected(q, [q[0] - LAMP[0], q[1] - LAMP[1]], n, 1.0);
        (q, [end[0] - q[0], end[1] - q[1]])
    };
    let (q, n) = on_conic(theta);
    let m2 = n[0] * n[0] + n[1] * n[1];
    let s1 = libm::hypot(LAMP[0] - q[0], LAMP[1] - q[1]);
    let delta = 1.0 + 0.5 * cos(theta);
    let front = (LAMP[0] - q[0]) * n[0] + (LAMP[1] - q[1]) * n[1];
    // W = 0: 1/s1 + 1/s2 = 2/(ρ cos i), ρ cos i = p m² (front/s1)/δ³.
    let focal = 2.0 * delta * delta * delta * s1 / (0.75 * m2 * front);
    let s2 = 1.0 / (focal - 1.0 / s1);
    let (_, d) = ray(theta);
    let at = [q[0] + s2 * d[0], q[1] + s2 * d[1]];
    // How far to the left of the ray its neighbours pass the point: both on the bright side.
    let passing = |theta: f64| {
        let (q, e) = ray(theta);
        let cross = (q[0] - at[0]) * e[1] - (q[1] - at[1]) * e[0];
        let across = -d[1] * e[1] - d[0] * e[0];
        cross / across
    };
    let side = if passing(theta + 1e-3) + passing(theta - 1e-3) > 0.0 {
        t
    } else {
        -t
    };
    conic(LAMP, [at[0] - side * d[1], at[1] + side * d[0]])
}

/// n = 1.375 under a sun of which sine and cosine are decimals.
fn glass(interactions: f64, x: [f64; 2]) -> Inputs {
    let numbers = [
        ("a", 0.5),
        ("height", 4.0),
        ("n", 1.375),
        ("E0", 2.0),
        ("sin_elevation", 0.28),
        ("cos_elevation", 0.96),
        ("interactions", interactions),
    ];
    Inputs::new(&numbers, x).with("centre", &[0.0, 0.0])
}

/// Turn δ of the ray of incidence i, and dδ/di.
fn glass_turn(interactions: f64, i: f64) -> (f64, f64) {
    if interactions == 1.0 {
        return (2.0 * i - core::f64::consts::PI, 2.0);
    }
    let index = sqrt(1.375 * 1.375 - 0.28 * 0.28) / 0.96;
    let r = asin(sin(i) / index);
    (2.0 * (i - r), 2.0 * (1.0 - cos(i) / (index * cos(r))))
}

/// The floor point on the ray of incidence i that is `along` radii from the ray's nearest point to the axis.
fn glass_point(interactions: f64, i: f64, along: f64) -> [f64; 2] {
    let (s, c) = sincos(glass_turn(interactions, i).0);
    let (l, moment) = (0.5 * along, 0.5 * sin(i));
    [l * c + moment * s, moment * c - l * s]
}

/// A point at the distance t from the caustic of two refractions, where the ray of i = 1/2 touches it, on the bright side.
fn next_to_glass_caustic(t: f64) -> Inputs {
    let i = 0.5;
    let (delta, slope) = glass_turn(2.0, i);
    let along = cos(i) / slope;
    let [x, y] = glass_point(2.0, i, along);
    // By how much the ray of incidence i passes the point, on the side of (sin δ, cos δ).
    let passing = |i: f64| {
        let (s, c) = sincos(glass_turn(2.0, i).0);
        0.5 * sin(i) - (x * s + y * c)
    };
    let side = if passing(i + 1e-3) + passing(i - 1e-3) > 0.0 {
        t
    } else {
        -t
    };
    let (s, c) = sincos(delta);
    glass(2.0, [x + side * s, y + side * c])
}
