//! What the study sweeps: for every kind the dangers that it has.

use libm::{asin, cos, sin, sqrt, tan};

use super::inputs::Inputs;

/// A path through the parameters of a kind, towards a danger.
pub struct Sweep {
    /// The kind, as the reference tables call it.
    pub kind: &'static str,
    /// What is approached.
    pub danger: &'static str,
    /// What the parameter t is, with its unit.
    pub parameter: &'static str,
    /// The values of t.
    pub values: Vec<f64>,
    /// The numbers at t.
    pub at: fn(f64) -> Inputs,
}

/// 10^first, 10^(first - 1), … 10^last.
fn decades(first: i32, last: i32) -> Vec<f64> {
    let step = if last < first { -1 } else { 1 };
    (0..=(last - first).abs())
        .map(|k| libm::pow(10.0, f64::from(first + step * k)))
        .collect()
}

const PURE: [&str; 13] = [
    "I",
    "R",
    "E0",
    "n",
    "m",
    "e",
    "albedo",
    "max_bounces",
    "cap_cos_min",
    "mirror_normal",
    "sin_elevation",
    "cos_elevation",
    "cap_axis",
];

fn floor() -> Inputs {
    Inputs::new(&[("I", 5.0)], [0.75, -0.5]).with("light", &[0.25, -0.125, 1.5])
}

fn mirror() -> Inputs {
    Inputs::new(&[("I", 5.0), ("R", 0.875)], [0.75, -0.5])
        .with("light", &[0.25, -0.125, 1.25])
        .with("mirror_point", &[1.5, 0.0, 0.0])
        .with("mirror_normal", &[-1.0, 0.0, 0.0])
}

/// The wedge's light in polar coordinates about its edge: scaled by hand.
fn wedge(scale: f64) -> Inputs {
    Inputs::new(
        &[("m", 3.0), ("I", 5.0), ("R", 0.875)],
        [0.5 * scale, 0.25 * scale],
    )
    .with("light_polar", &[scale, 0.375, 0.875 * scale])
}

fn interface() -> Inputs {
    let numbers = [("n", 1.333), ("I", 5.0), ("surface_z", 1.0)];
    Inputs::new(&numbers, [0.75, -0.5]).with("light", &[0.25, -0.125, 1.75])
}

fn slab() -> Inputs {
    Inputs::new(&[("n", 1.5), ("I", 5.0)], [0.75, -0.5])
        .with("light", &[0.25, -0.125, 1.5])
        .with("slab_z", &[0.625, 1.0])
}

fn dome(light_z: f64, x: f64) -> Inputs {
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

fn ball(x: f64) -> Inputs {
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

fn cup(x: [f64; 2]) -> Inputs {
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

fn lamp(light: [f64; 3], x: [f64; 2]) -> Inputs {
    Inputs::new(
        &[("a", 1.0), ("I", 1.0), ("R", 0.875), ("max_bounces", 1.0)],
        x,
    )
    .with("light", &light)
    .say("wall", "full")
    .say("wall_height", "unbounded")
}

fn dish(c: f64) -> Inputs {
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

fn ellipsoid(delta: f64) -> Inputs {
    let numbers = [
        ("a", 1.0),
        ("e", 0.625),
        ("delta", delta),
        ("I", 1.0),
        ("R", 0.875),
    ];
    Inputs::new(&numbers, [0.25 * delta, 0.125 * delta]).with("light", &[0.0, 0.0, -0.625])
}

fn hyperboloid() -> Inputs {
    let numbers = [
        ("A", 0.5),
        ("e", 1.75),
        ("zr", 0.625),
        ("I", 1.0),
        ("R", 0.875),
    ];
    Inputs::new(&numbers, [0.25, 0.125]).with("light", &[0.0, 0.0, 0.875])
}

fn oval(delta: f64) -> Inputs {
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
fn glass(x: f64) -> Inputs {
    let numbers = [("n", 1.5), ("a", 1.0), ("E0", 1.0), ("receiver_z", 1.25)];
    Inputs::new(&numbers, [0.6 * x, 0.8 * x])
}

/// Signed distance from the axis at which the ray of incidence i meets the plane.
fn glass_landing(i: f64) -> f64 {
    let r = asin(sin(i) / 1.5);
    let e = 2.0 * r - i;
    sin(e) - (1.25 - cos(e)) * tan(2.0 * (i - r))
}

/// The largest distance from the axis, where the rays turn back: the fold ring. An interval search finds the place of a
/// maximum to half the digits only, but its value to all.
fn glass_fold() -> f64 {
    let (mut low, mut high) = (0.05, 1.2);
    for _ in 0..200 {
        let (a, b) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        if glass_landing(a) > glass_landing(b) {
            high = b;
        } else {
            low = a;
        }
    }
    glass_landing(0.5 * (low + high)).abs()
}

fn waves(x: f64) -> Inputs {
    Inputs::new(
        &[("n", 1.333), ("mean_depth_H", 3.0), ("E0", 1.0)],
        [x, 0.0],
    )
    .with("waves_A_k_phase", &[0.0625, 6.0, 0.0])
}

fn waves_landing(u: f64) -> f64 {
    let slope = -0.0625 * 6.0 * sin(6.0 * u);
    let i = libm::atan(slope);
    let deviation = i - asin(sin(i) / 1.333);
    u + (3.0 + 0.0625 * cos(6.0 * u)) * tan(deviation)
}

/// The first maximum of the landing point: a fold.
fn waves_fold() -> f64 {
    let (mut low, mut high) = (-0.5, 0.0);
    for _ in 0..200 {
        let (a, b) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        if waves_landing(a) > waves_landing(b) {
            high = b;
        } else {
            low = a;
        }
    }
    waves_landing(0.5 * (low + high))
}

/// A point at distance t from the nephroid, on its bright side, where the ray of φ = 1/2 touches it.
fn next_to_nephroid(t: f64) -> [f64; 2] {
    let phi = 0.5;
    let tau = 0.5 * cos(phi);
    let (x, y) = (
        cos(phi) - tau * cos(2.0 * phi),
        sin(phi) - tau * sin(2.0 * phi),
    );
    [x + t * sin(2.0 * phi), y - t * cos(2.0 * phi)]
}

/// All sweeps.
pub fn all() -> Vec<Sweep> {
    let mut all = Vec::new();
    let mut add = |kind, danger, parameter, values: Vec<f64>, at: fn(f64) -> Inputs| {
        all.push(Sweep {
            kind,
            danger,
            parameter,
            values,
            at,
        });
    };
    const FOLD: (&str, &str) = ("fold", "distance to the fold [m]");
    const GRAZING: (&str, &str) = ("grazing incidence", "angle to the surface [rad]");
    const SCALE: (&str, &str) = ("scale", "factor of all lengths");
    const FAR: (&str, &str) = ("translation", "offset along x and y [m]");
    let (near, graze) = (|| decades(-1, -12), || decades(-1, -8));
    let (scale, far) = (|| decades(-6, 6), || decades(0, 4));

    add("cylinder-cup", FOLD.0, FOLD.1, near(), |t| {
        cup(next_to_nephroid(t))
    });
    add("concave-sphere", FOLD.0, FOLD.1, near(), |t| {
        // The fold ring of this dome, from the meridian's turning point.
        let ring = dome_fold();
        let r = ring - t;
        dome(0.3, 0.0)
            .with("z_receiver", &[-0.3])
            .at_point([0.6 * r, 0.8 * r])
    });
    add("glass-sphere", FOLD.0, FOLD.1, near(), |t| {
        glass(glass_fold() - t)
    });
    add("water-waves", FOLD.0, FOLD.1, near(), |t| {
        waves(waves_fold() - t)
    });

    add("diffuse", GRAZING.0, GRAZING.1, graze(), |t| {
        floor().at_point([0.25 + 1.5 / t, -0.125])
    });
    add("planar-mirror", GRAZING.0, GRAZING.1, graze(), |t| {
        Inputs::new(&[("I", 5.0), ("R", 0.875)], [1.5 - 0.5 * t, -2.5])
            .with("light", &[1.5 - 0.5 * t, -0.125, 1.25])
            .with("mirror_point", &[1.5, 0.0, 0.0])
            .with("mirror_normal", &[-1.0, 0.0, 0.0])
    });
    add("flat-interface", GRAZING.0, GRAZING.1, graze(), |t| {
        interface().at_point([0.25 + 0.75 / t, -0.125])
    });
    add("glass-slab", GRAZING.0, GRAZING.1, graze(), |t| {
        slab().at_point([0.25 + 1.125 / t, -0.125])
    });
    add("convex-sphere", GRAZING.0, GRAZING.1, graze(), |t| {
        // In the plane of centre and light: the ray that meets the ball at the angle t to its surface.
        let (lx, lz) = (1.25, 1.25);
        let distance = sqrt(lx * lx + lz * lz);
        let i = core::f64::consts::FRAC_PI_2 - t;
        let polar = i - asin(0.5 * sin(i) / distance);
        let up = libm::atan2(lz, lx) - polar;
        let (nx, nz) = (cos(up), sin(up));
        let (px, pz) = (0.5 * nx, 0.75 + 0.5 * nz);
        let (dx, dz) = (px - lx, pz - 0.75 - lz);
        let along = dx * nx + dz * nz;
        let (rx, rz) = (dx - 2.0 * along * nx, dz - 2.0 * along * nz);
        let x = px - rx * (pz / rz);
        ball(0.0).at_point([x, 0.0]).with("light", &[lx, 0.0, 2.0])
    });
    add("cylinder-cup", GRAZING.0, GRAZING.1, graze(), |t| {
        // The ray that meets the wall at the angle t, half way along its chord.
        let phi = core::f64::consts::FRAC_PI_2 - t;
        let tau = cos(phi);
        cup([
            cos(phi) - tau * cos(2.0 * phi),
            sin(phi) - tau * sin(2.0 * phi),
        ])
    });
    add("glass-sphere", GRAZING.0, GRAZING.1, graze(), |t| {
        let i = core::f64::consts::FRAC_PI_2 - t;
        glass(glass_landing(i).abs())
    });

    add(
        "concave-sphere",
        "light at the centre",
        "distance to the centre [m]",
        near(),
        |t| dome(t, 0.25),
    );
    add(
        "concave-sphere",
        "receiver on the axis",
        "distance to the axis [m]",
        near(),
        |t| dome(0.3125, 0.0).at_point([0.6 * t, 0.8 * t]),
    );
    add(
        "cylinder-cup",
        "lamp at the rim",
        "distance to the wall [m]",
        near(),
        |t| lamp([t - 1.0, 0.0, 0.75], [0.3125, 0.125]),
    );
    add(
        "cylinder-cup",
        "lamp at the centre",
        "distance to the axis [m]",
        near(),
        |t| lamp([t, 0.0, 0.75], [0.3125, 0.125]),
    );
    add(
        "paraboloid",
        "receiver at the focus",
        "height over the focus [m]",
        near(),
        |t| dish(1.0 + t),
    );
    add(
        "conic-mirrors",
        "receiver at the focus",
        "height over the focus [m]",
        near(),
        ellipsoid,
    );
    add(
        "stigmatic-refractors",
        "receiver at the focus",
        "depth behind the focus [m]",
        near(),
        oval,
    );
    add(
        "glass-sphere",
        "receiver on the axis",
        "distance to the axis [m]",
        near(),
        glass,
    );

    add("diffuse", SCALE.0, SCALE.1, scale(), |t| {
        floor().scaled(t, &PURE)
    });
    add("planar-mirror", SCALE.0, SCALE.1, scale(), |t| {
        mirror().scaled(t, &PURE)
    });
    add("planar-chains", SCALE.0, SCALE.1, scale(), wedge);
    add("flat-interface", SCALE.0, SCALE.1, scale(), |t| {
        interface().scaled(t, &PURE)
    });
    add("glass-slab", SCALE.0, SCALE.1, scale(), |t| {
        slab().scaled(t, &PURE)
    });
    add("concave-sphere", SCALE.0, SCALE.1, scale(), |t| {
        dome(0.3125, 0.0625).scaled(t, &PURE)
    });
    add("convex-sphere", SCALE.0, SCALE.1, scale(), |t| {
        ball(1.0).scaled(t, &PURE)
    });
    add("cylinder-cup", SCALE.0, SCALE.1, scale(), |t| {
        cup([0.5, 0.25]).scaled(t, &PURE)
    });
    add("paraboloid", SCALE.0, SCALE.1, scale(), |t| {
        dish(1.25).scaled(t, &PURE)
    });
    add("conic-mirrors", SCALE.0, SCALE.1, scale(), |t| {
        hyperboloid().scaled(t, &PURE)
    });
    add("stigmatic-refractors", SCALE.0, SCALE.1, scale(), |t| {
        oval(0.25).scaled(t, &PURE)
    });
    add("glass-sphere", SCALE.0, SCALE.1, scale(), |t| {
        glass(0.0625).scaled(t, &PURE)
    });
    add("water-waves", SCALE.0, SCALE.1, scale(), |t| {
        waves(0.0625).scaled(t, &PURE)
    });

    add("diffuse", FAR.0, FAR.1, far(), |t| {
        floor().translated(t, &["light"])
    });
    add("planar-mirror", FAR.0, FAR.1, far(), |t| {
        mirror().translated(t, &["light", "mirror_point"])
    });
    add("flat-interface", FAR.0, FAR.1, far(), |t| {
        interface().translated(t, &["light"])
    });
    add("glass-slab", FAR.0, FAR.1, far(), |t| {
        slab().translated(t, &["light"])
    });
    add("concave-sphere", FAR.0, FAR.1, far(), |t| {
        dome(0.3125, 0.0625).translated(t, &["light", "sphere_centre"])
    });
    add("convex-sphere", FAR.0, FAR.1, far(), |t| {
        ball(1.0).translated(t, &["light", "sphere_centre"])
    });
    all
}

/// Radius of the dome's fold ring: the turning point of the landing radius of rays that leave the light on the axis.
fn dome_fold() -> f64 {
    // The ray to the mirror point (sin ψ, cos ψ) of the unit circle from (0, 0.3), on to z = -0.3.
    let landing = |psi: f64| {
        let (s, c) = (sin(psi), cos(psi));
        let (dx, dz) = (s, c - 0.3);
        let along = dx * s + dz * c;
        let (rx, rz) = (dx - 2.0 * along * s, dz - 2.0 * along * c);
        s + rx * ((-0.3 - c) / rz)
    };
    let (mut low, mut high) = (0.05, 1.0);
    for _ in 0..200 {
        let (a, b) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        if landing(a).abs() > landing(b).abs() {
            high = b;
        } else {
            low = a;
        }
    }
    landing(0.5 * (low + high)).abs()
}
