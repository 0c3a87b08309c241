//! Irradiance evaluations per CPU-second of every closed form, one thread, f64, value and error bound:
//! `cargo bench --bench evaluations -- [KIND]...`.
//!
//! 4096 points of a Kronecker sequence over a patch of the receiver that is lit, again and again; the median of seven
//! runs.

use std::hint::black_box;
use std::time::Instant;

use libm::{cos, hypot, sin};
use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::conic_mirrors::{Ellipsoid, Hyperboloid};
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::cylinder_cup::{Beam, CylinderCup, Light, Wall, point_light::Lamp};
use nephroid_analytic::kinds::diffuse;
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::glass_pillar::GlassPillar;
use nephroid_analytic::kinds::glass_slab::GlassSlab;
use nephroid_analytic::kinds::glass_sphere::GlassSphere;
use nephroid_analytic::kinds::paraboloid::{self, Paraboloid};
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::kinds::planar_chains::Wedge;
use nephroid_analytic::kinds::planar_mirror::PlanarMirror;
use nephroid_analytic::kinds::sphere_mirror::{self, Side, SphereMirror};
use nephroid_analytic::kinds::stigmatic_refractors::{Front, StigmaticRefractor};
use nephroid_analytic::kinds::water_waves::{WaterWaves, Wave};
use nephroid_analytic::vector::vec3;

const POINTS: usize = 4096;
const RUNS: usize = 7;
/// Seconds of a run, about.
const RUN: f64 = 0.08;

/// A form to be measured: its name, what it does, and its irradiance at a point.
type Form = (
    &'static str,
    &'static str,
    Box<dyn Fn(f64, f64) -> Estimate<f64>>,
);

fn explicit() -> Vec<Form> {
    let light = vec3(0.25, -0.125, 1.25);
    let mirror = PlanarMirror::new(
        light,
        5.0,
        0.9,
        vec3(1.5, 0.0, 0.0),
        vec3(-1.0, 0.0, 0.0),
        None,
    );
    let wedge = Wedge {
        m: 4,
        radius: 1.0,
        angle: 0.375,
        height: 0.9,
        intensity: 5.0,
        reflectance: 0.9,
    };
    let dish = Paraboloid {
        focal_length: 1.0,
        reflectance: 0.9,
        light: paraboloid::Light::Focus(5.0),
        receiver_z: 3.0,
        inner_radius: 0.0,
        outer_radius: 3.0,
    };
    let ellipsoid = Ellipsoid {
        semi_axis: 1.0,
        eccentricity: 0.6,
        defocus: 0.4,
        intensity: 1.0,
        reflectance: 0.9,
    };
    let hyperboloid = Hyperboloid {
        semi_axis: 0.5,
        eccentricity: 1.8,
        receiver_z: 0.6,
        intensity: 1.0,
        reflectance: 0.9,
    };
    vec![
        (
            "diffuse",
            "explicit",
            Box::new(move |x, y| diffuse::direct(light, 5.0, vec3(x, y, 0.0))),
        ),
        (
            "planar-mirror",
            "explicit",
            Box::new(move |x, y| mirror.caustic(vec3(x, y, 0.0))),
        ),
        (
            "planar-chains",
            "explicit, two images",
            Box::new(move |x, y| wedge.caustic(0.6 + 0.3 * x, 0.2 + 0.2 * y, 1)),
        ),
        (
            "paraboloid",
            "explicit",
            Box::new(move |x, y| dish.caustic(x, y)),
        ),
        (
            "ellipsoid",
            "explicit",
            Box::new(move |x, y| ellipsoid.caustic(0.2 * x, 0.2 * y)),
        ),
        (
            "hyperboloid",
            "explicit",
            Box::new(move |x, y| hyperboloid.caustic(0.3 * x, 0.3 * y)),
        ),
    ]
}

fn rooted() -> Vec<Form> {
    let water = FlatInterface {
        surface_z: 1.0,
        index: 1.333,
        light: vec3(0.25, -0.125, 1.75),
        intensity: 5.0,
        receiver_z: 0.0,
    };
    let slab = GlassSlab {
        bottom: 0.7,
        top: 1.0,
        index: 1.5,
        light: vec3(0.25, -0.125, 1.5),
        intensity: 5.0,
        receiver_z: 0.0,
    };
    let wall = Wall {
        radius: 1.0,
        height: Some(1.2),
        cos_half_arc: Some(0.0),
    };
    let beam = CylinderCup {
        wall,
        reflectance: 0.9,
        light: Light::Beam(Beam {
            irradiance: 2.0,
            sin_elevation: 0.6,
            cos_elevation: 0.8,
        }),
    };
    let lamp = CylinderCup {
        wall: Wall {
            height: None,
            cos_half_arc: None,
            ..wall
        },
        light: Light::Point(Lamp {
            x: -0.4,
            y: 0.1,
            height: 0.8,
            intensity: 1.0,
        }),
        ..beam
    };
    let rim = CylinderCup {
        light: Light::Point(Lamp {
            x: -0.6,
            y: 0.8,
            height: 0.8,
            intensity: 1.0,
        }),
        ..lamp
    };
    let deep = CylinderCup {
        wall: Wall {
            cos_half_arc: None,
            ..wall
        },
        ..beam
    };
    let sphere = |side, z: f64| SphereMirror {
        centre: vec3(0.0, 0.0, z),
        radius: 1.0,
        side,
        cap_axis: vec3(0.0, 0.0, 1.0),
        cap_cos_min: if side == Side::Concave { 0.25 } else { -1.0 },
        reflectance: 0.9,
        light: sphere_mirror::Light::Point {
            position: vec3(0.1, 0.05, z + if side == Side::Concave { 0.3 } else { 2.5 }),
            intensity: 1.0,
        },
        receiver_z: z - if side == Side::Concave { 0.3 } else { 1.5 },
    };
    let (dome, ball) = (sphere(Side::Concave, 0.3), sphere(Side::Convex, 1.5));
    let oval = StigmaticRefractor {
        index: 1.5,
        front: Front::Oval {
            light_z: 2.0,
            optical_length: 2.35,
            intensity: 1.0,
        },
        defocus: 0.2,
    };
    let glass = GlassSphere {
        index: 1.5,
        radius: 1.0,
        irradiance: 1.0,
        receiver_z: 1.2,
        max_incidence: 1.4,
    };
    let bow = GlassSphere {
        index: 1.333,
        receiver_z: -3.0,
        max_incidence: core::f64::consts::FRAC_PI_2,
        ..glass
    };
    let wave = Wave {
        amplitude: 0.05,
        wave_number: core::f64::consts::TAU,
        phase: 0.0,
    };
    let mut forms: Vec<Form> = vec![
        (
            "flat-interface",
            "one root",
            Box::new(move |x, y| water.caustic(x, y)),
        ),
        (
            "glass-slab",
            "one root",
            Box::new(move |x, y| slab.caustic(x, y, 0)),
        ),
        (
            "cylinder-cup",
            "beam, one bounce, all roots",
            Box::new(move |x, y| beam.caustic(0.6 + 0.3 * x, 0.4 * y, 1)),
        ),
        (
            "cylinder-cup",
            "lamp, one bounce, all roots",
            Box::new(move |x, y| lamp.caustic(0.6 * x, 0.6 * y, 1)),
        ),
        (
            "cylinder-cup",
            "rim lamp, one bounce, all",
            Box::new(move |x, y| rim.caustic(0.6 * x, 0.6 * y, 1)),
        ),
        (
            "cylinder-cup",
            "beam, two bounces, all roots",
            Box::new(move |x, y| deep.caustic(0.6 * x, 0.6 * y, 2)),
        ),
        (
            "concave-sphere",
            "Alhazen, all roots",
            Box::new(move |x, y| dome.caustic(vec3(0.2 * x, 0.2 * y, 0.0))),
        ),
        (
            "convex-sphere",
            "Alhazen, all roots",
            Box::new(move |x, y| ball.caustic(vec3(3.0 + x, y, 0.0))),
        ),
        (
            "stigmatic-refractors",
            "one root",
            Box::new(move |x, y| oval.caustic(0.01 * x, 0.01 * y)),
        ),
        (
            "glass-sphere",
            "two refractions, all roots",
            Box::new(move |x, y| glass.caustic(0.1 * hypot(x, y), 2)),
        ),
        (
            "glass-sphere",
            "one inside, all roots",
            Box::new(move |x, y| bow.caustic(5.0 * hypot(x, y), 3)),
        ),
    ];
    forms.extend(walls());
    if let Ok(waves) = WaterWaves::new(1.333, 3.0, 1.0, vec![wave]) {
        forms.push((
            "water-waves",
            "one wave, all roots",
            Box::new(move |x, _| waves.caustic(0.5 * x)),
        ));
    }
    forms
}

/// Vertical walls and pillars.
fn walls() -> Vec<Form> {
    let pillar = Pillar {
        x: 0.1,
        y: -0.2,
        radius: 0.35,
        height: 2.0,
        reflectance: 0.9,
        light: vec3(-1.1, 0.4, 1.3),
        intensity: 5.0,
    };
    let wall = |eccentricity, light| ConicWall {
        x: 0.1,
        y: -0.2,
        axis: (0.8, 0.6),
        parameter: 0.9,
        eccentricity,
        half_arc: Some(1.9),
        height: 0.7,
        reflectance: 0.9,
        light,
        intensity: 5.0,
    };
    let ellipse = wall(0.45, vec3(-0.1, 0.05, 1.3));
    let parabola = wall(1.0, vec3(0.1, -0.2, 1.3));
    let glass = GlassPillar {
        x: 0.1,
        y: -0.2,
        radius: 0.35,
        height: 2.0,
        index: 1.5,
        irradiance: 2.0,
        sin_elevation: 0.6,
        cos_elevation: 0.8,
    };
    // Behind the pillar for transmitted light, around it for reflected light.
    let (near, far) = (0.1, 0.6);
    vec![
        (
            "pillar",
            "one root",
            Box::new(move |x, y| pillar.caustic(x, y)),
        ),
        (
            "conic-wall",
            "ellipse, all roots",
            Box::new(move |x, y| ellipse.caustic(0.6 * x, 0.6 * y)),
        ),
        (
            "conic-wall",
            "parabola, light at the focus",
            Box::new(move |x, y| parabola.caustic(0.6 * x, 0.6 * y)),
        ),
        (
            "glass-pillar",
            "reflected, one root",
            Box::new(move |x, y| glass.caustic(x, y, 1)),
        ),
        (
            "glass-pillar",
            "two refractions, all roots",
            Box::new(move |x, y| glass.caustic(near + far * (1.5 + x), near + far * y, 2)),
        ),
        (
            "glass-pillar",
            "one inside, all roots",
            Box::new(move |x, y| glass.caustic(1.5 * x, 1.5 * y, 3)),
        ),
    ]
}

fn main() {
    let only: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    let points: Vec<[f64; 2]> = (0..POINTS)
        .map(|k| {
            // A Kronecker sequence in polar coordinates of the unit disc.
            let part = |step: f64| (k as f64 * step).fract();
            let (r, angle) = (
                part(0.754_877_666_246_692_8).sqrt(),
                part(0.569_840_290_998_053_3) * core::f64::consts::TAU,
            );
            [r * cos(angle), r * sin(angle)]
        })
        .collect();
    println!(
        "million evaluations (value and error bound) per second, one thread, median of {RUNS}"
    );
    for (kind, what, form) in explicit().into_iter().chain(rooted()) {
        if !only.is_empty() && !only.iter().any(|name| name == kind) {
            continue;
        }
        let pass = || {
            let start = Instant::now();
            let sum: f64 = points.iter().map(|p| form(p[0], p[1]).value).sum();
            black_box(sum);
            start.elapsed().as_secs_f64()
        };
        let repeats = (RUN / pass().max(1e-6)).ceil().max(1.0);
        let mut rates: Vec<f64> = (0..RUNS)
            .map(|_| {
                let seconds: f64 = (0..repeats as usize).map(|_| pass()).sum();
                repeats * POINTS as f64 / seconds * 1e-6
            })
            .collect();
        rates.sort_by(f64::total_cmp);
        println!("{kind:<21} {what:<28} {:8.2}", rates[RUNS / 2]);
    }
}
