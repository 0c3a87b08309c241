//! The scenes that are swept: one per kind, in numbers that binary fractions hold.

use super::super::inputs::Inputs;

pub(super) fn floor() -> Inputs {
    Inputs::new(&[("I", 5.0)], [0.75, -0.5]).with("light", &[0.25, -0.125, 1.5])
}

pub(super) fn mirror() -> Inputs {
    Inputs::new(&[("I", 5.0), ("R", 0.875)], [0.75, -0.5])
        .with("light", &[0.25, -0.125, 1.25])
        .with("mirror_point", &[1.5, 0.0, 0.0])
        .with("mirror_normal", &[-1.0, 0.0, 0.0])
}

/// The wedge's light in polar coordinates about its edge: scaled by hand.
pub(super) fn wedge(scale: f64) -> Inputs {
    Inputs::new(
        &[("m", 3.0), ("I", 5.0), ("R", 0.875)],
        [0.5 * scale, 0.25 * scale],
    )
    .with("light_polar", &[scale, 0.375, 0.875 * scale])
}

pub(super) fn interface() -> Inputs {
    let numbers = [("n", 1.333), ("I", 5.0), ("surface_z", 1.0)];
    Inputs::new(&numbers, [0.75, -0.5]).with("light", &[0.25, -0.125, 1.75])
}

pub(super) fn slab() -> Inputs {
    Inputs::new(&[("n", 1.5), ("I", 5.0)], [0.75, -0.5])
        .with("light", &[0.25, -0.125, 1.5])
        .with("slab_z", &[0.625, 1.0])
}

pub(super) fn dome(light_z: f64, x: f64) -> Inputs {
    let numbers = [
        ("a", 1.0),
        ("R", 0.875),
        ("I", 1.0),
        ("z_receiver", -0.25),
        ("cap_cos_min", 0.25),
    ];
    Inputs::new(&numbers, [x, 0.125])
        .with("sphere_centre", &[0.0, 0.0, 0.0])
        .with("light", &[0.0, 0.0, light_z])
        .with("cap_axis", &[0.0, 0.0, 1.0])
}

pub(super) fn ball(x: f64) -> Inputs {
    let numbers = [
        ("a", 0.5),
        ("R", 0.875),
        ("I", 5.0),
        ("z_receiver", 0.0),
        ("cap_cos_min", -1.0),
    ];
    Inputs::new(&numbers, [x, 0.25])
        .with("sphere_centre", &[0.0, 0.0, 0.75])
        .with("light", &[1.25, 0.25, 2.0])
        .with("cap_axis", &[0.0, 0.0, 1.0])
}

pub(super) fn cup(x: [f64; 2]) -> Inputs {
    let numbers = [
        ("a", 1.0),
        ("cos_elevation", 0.8),
        ("sin_elevation", 0.6),
        ("E0", 2.0),
        ("R", 0.875),
        ("wall_height", 1.25),
        ("max_bounces", 1.0),
    ];
    Inputs::new(&numbers, x).say("wall", "half")
}

pub(super) fn lamp(light: [f64; 3], x: [f64; 2]) -> Inputs {
    Inputs::new(
        &[("a", 1.0), ("I", 1.0), ("R", 0.875), ("max_bounces", 1.0)],
        x,
    )
    .with("light", &light)
    .say("wall", "full")
    .say("wall_height", "unbounded")
}

pub(super) fn dish(c: f64) -> Inputs {
    // At the height c the beam from the ring r = 1.25 of the mirror.
    let x = 1.25 * (c - 1.0).abs() / (1.0 - 1.25 * 1.25 / 4.0);
    let numbers = [
        ("f", 1.0),
        ("E0", 2.0),
        ("R", 0.875),
        ("c", c),
        ("r0", 1.0),
        ("r1", 1.625),
    ];
    Inputs::new(&numbers, [0.6 * x, 0.8 * x])
}

pub(super) fn ellipsoid(delta: f64) -> Inputs {
    let numbers = [
        ("a", 1.0),
        ("e", 0.625),
        ("delta", delta),
        ("I", 1.0),
        ("R", 0.875),
    ];
    Inputs::new(&numbers, [0.25 * delta, 0.125 * delta]).with("light", &[0.0, 0.0, -0.625])
}

pub(super) fn hyperboloid() -> Inputs {
    let numbers = [
        ("A", 0.5),
        ("e", 1.75),
        ("zr", 0.625),
        ("I", 1.0),
        ("R", 0.875),
    ];
    Inputs::new(&numbers, [0.25, 0.125]).with("light", &[0.0, 0.0, 0.875])
}

pub(super) fn oval(delta: f64) -> Inputs {
    let numbers = [
        ("n", 1.5),
        ("D", 2.0),
        ("C", 2.375),
        ("delta", delta),
        ("I", 1.0),
    ];
    Inputs::new(&numbers, [0.0625 * delta, 0.03125 * delta])
}

/// A plane between the sphere and its paraxial focus.
pub(super) fn glass(x: f64) -> Inputs {
    let numbers = [("n", 1.5), ("a", 1.0), ("E0", 1.0), ("receiver_z", 1.25)];
    Inputs::new(&numbers, [0.6 * x, 0.8 * x])
}

pub(super) fn waves(x: f64) -> Inputs {
    Inputs::new(
        &[("n", 1.333), ("mean_depth_H", 3.0), ("E0", 1.0)],
        [x, 0.0],
    )
    .with("waves_A_k_phase", &[0.0625, 6.0, 0.0])
}
