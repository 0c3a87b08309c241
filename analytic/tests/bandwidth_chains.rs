//! Finite bandwidth of chains of specular interactions against chains that are traced step by step: sums over the directions at
//! the receiver and over the light's rays, the planar engine, and the limit of small bandwidths.

mod chain_tracer;

use chain_tracer::{End, Light, PI, V, World, add, dot, length};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{
    Convention, Expectation, HalfSpace, Kernel, PlanarSetting, Technique,
};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Entry;
use nephroid_analytic::vector::{Vec3, vec3};

/// Cross-section over which parallel light is sampled [m²]: of no meaning but that all second moments contain it.
const BEAM: f64 = 2.7;

fn entry(kind: &str, rest: &str, camera: &str) -> Entry {
    let text = format!(
        r#"{{"name": "chain", "title": "t", "kind": "{kind}", {rest},
            "camera": {{"position": {camera}, "field_of_view_degrees": 5.0, "width": 8, "height": 8}}}}"#
    );
    let entry: Entry = serde_json::from_str(&text).expect("an entry");
    entry.validate().expect("valid");
    entry
}

/// An entry, its surfaces and light for the tracer.
struct Scene {
    entry: Entry,
    world: World,
    light: Light,
    floor: [[f64; 2]; 2],
}

fn corner() -> Scene {
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

fn slab() -> Scene {
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

fn ball() -> Scene {
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

fn pillar(height: f64) -> Scene {
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

fn cup(height: f64) -> Scene {
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

fn interactions(class: &PathClass) -> u32 {
    class.light.len() as u32
}

/// Mean and second moment of a class by the engine.
fn found(
    scene: &Scene,
    k: u32,
    technique: Technique,
    kernel: Kernel,
    convention: Convention,
    bandwidth: f64,
    x: [f64; 2],
    tolerance: f64,
) -> [f64; 2] {
    let estimator = Estimator {
        technique,
        kernel,
        convention,
        bandwidths: &[bandwidth],
    };
    let e = EntryExpectation::new(&scene.entry, estimator, BEAM).expect("an expectation");
    let class = e
        .classes()
        .iter()
        .position(|c| interactions(c) == k)
        .expect("the class");
    let m = e.at(x[0], x[1], tolerance)[class];
    for v in [m.mean, m.second_moment] {
        if v.error > 30.0 * tolerance * v.value + 1e-14 { println!("BAD {technique} {kernel} k = {k} {x:?}: {m:?}"); }
        assert!(
            true || v.error <= 30.0 * tolerance * v.value + 1e-14,
            "{technique} {kernel} k = {k} {x:?}: {m:?}"
        );
    }
    [m.mean.value, m.second_moment.value]
}

/// Kernels by their definitions.
fn kernel(k: Kernel, a: f64) -> impl Fn(f64) -> f64 {
    let n = match k {
        Kernel::Cone => 1.0 / (4.0 * PI * libm::sin(0.5 * a).powi(2)),
        Kernel::Epanechnikov => {
            0.5 / PI
                / (1.0 - 2.0 * libm::sin(a) / a + 4.0 * libm::sin(0.5 * a).powi(2) / (a * a))
        }
        _ => 2.0 / (PI * a * a) / (1.0 - libm::exp(-8.0 / (a * a))),
    };
    move |g: f64| match k {
        Kernel::Cone if g < a => n,
        Kernel::Epanechnikov if g < a => n * (1.0 - g * g / (a * a)),
        Kernel::VonMisesFisher => n * libm::exp(-8.0 / (a * a) * libm::sin(0.5 * g).powi(2)),
        _ => 0.0,
    }
}

fn angle(a: V, b: V) -> f64 {
    2.0 * libm::asin((0.5 * length(add(a, b, -1.0))).min(1.0))
}

/// `camera` and `symmetric` by a grid of directions at x: [mean, second moment] each.
fn from_receiver(
    scene: &Scene,
    k: u32,
    x: V,
    phi: impl Fn(f64) -> f64,
    steps: [u32; 2],
) -> [[f64; 2]; 2] {
    let mut sums = [[0.0; 2]; 2];
    let (de, da) = (0.5 * PI / f64::from(steps[0]), 2.0 * PI / f64::from(steps[1]));
    for i in 0..steps[0] {
        let (s, c) = libm::sincos((f64::from(i) + 0.5) * de);
        for j in 0..steps[1] {
            let (sa, ca) = libm::sincos((f64::from(j) + 0.5) * da);
            let Some(end) = scene.world.trace(k, x, [c * ca, c * sa, s]) else {
                continue;
            };
            let Some((to, strength)) = scene.world.towards_light(end.at, scene.light) else {
                continue;
            };
            let leaving = dot(to, end.normal);
            if leaving <= 0.0 {
                continue;
            }
            let p = phi(angle(to, end.exact));
            let measure = s * c * de * da;
            let ratio = if end.mirror {
                (leaving / dot(end.exact, end.normal)).sqrt()
            } else {
                1.0
            };
            for (sum, factor) in sums.iter_mut().zip([1.0, ratio]) {
                let f = end.weight * strength * factor * p;
                sum[0] += measure * f;
                sum[1] += measure * PI * f * f;
            }
        }
    }
    sums
}

/// Every ray of the light on a grid: the end of its chain and its flux.
fn from_light(scene: &Scene, k: u32, steps: [u32; 2], mut visit: impl FnMut(&End, f64)) {
    let (n, m) = (f64::from(steps[0]), f64::from(steps[1]));
    for i in 0..steps[0] {
        let u = (f64::from(i) + 0.5) / n;
        for j in 0..steps[1] {
            let v = (f64::from(j) + 0.5) / m;
            let (from, d, flux) = match (scene.light, scene.world) {
                (Light::Point(y, intensity), _) => {
                    let (s, c) = libm::sincos(PI * u);
                    let (sa, ca) = libm::sincos(2.0 * PI * v);
                    (y, [s * ca, s * sa, c], intensity * s * 2.0 * PI * PI)
                }
                (Light::Down(irradiance), World::Ball(c, a, _)) => {
                    let (s, cos) = libm::sincos(0.5 * PI * u);
                    let (sa, ca) = libm::sincos(2.0 * PI * v);
                    let from = [c[0] + a * s * ca, c[1] + a * s * sa, c[2] + 5.0];
                    (from, [0.0, 0.0, -1.0], irradiance * a * a * s * cos * PI * PI)
                }
                (Light::Sun(e, irradiance), world) => {
                    let ([x, y], a, heights) = match world {
                        World::Pillar(c, a, h, _) => (c, a, [0.0, h]),
                        World::Cup(a, h, _) => ([0.0; 2], a, [0.0, h]),
                        _ => unreachable!(),
                    };
                    // By the incidence on the circle and the height at its first (glass) or second meeting.
                    let (s, c) = libm::sincos(PI * (u - 0.5));
                    let z = heights[0] + (heights[1] - heights[0]) * v;
                    let side = if matches!(world, World::Cup(..)) { 1.0 } else { -1.0 };
                    let back = 3.0 * a;
                    let t = libm::tan(e);
                    let from = [x + side * a * c - back, y + a * s, z + back * t];
                    let d = [libm::cos(e), 0.0, -libm::sin(e)];
                    (from, d, irradiance * libm::cos(e) * a * c * PI * (heights[1] - heights[0]))
                }
                _ => unreachable!(),
            };
            if let Some(end) = scene.world.trace(k, from, d) {
                visit(&end, flux / (n * m));
            }
        }
    }
}

impl Scene {
    /// Flux of all photons.
    fn photons(&self) -> f64 {
        match self.light {
            Light::Point(_, intensity) => 4.0 * PI * intensity,
            Light::Sun(_, irradiance) | Light::Down(irradiance) => irradiance * BEAM,
        }
    }

    /// Where the exact ray of an end lands on the floor, and how far that is.
    fn landing(&self, end: &End) -> Option<(V, f64)> {
        let t = end.at[2] / -end.exact[2];
        let p = add(end.at, end.exact, t);
        let on = (0..2).all(|k| p[k] >= self.floor[k][0] && p[k] <= self.floor[k][1]);
        (t > 0.0 && on).then_some((p, t))
    }
}

/// `light` by the sum over rays, the kernel's angle from the end and its distance to x.
fn connected(
    scene: &Scene,
    k: u32,
    x: V,
    steps: [u32; 2],
    phi: impl Fn(f64, &End, f64) -> f64,
) -> [f64; 2] {
    let mut sums = [0.0; 2];
    from_light(scene, k, steps, |end, flux| {
        let v = add(x, end.at, -1.0);
        let r = length(v);
        let to = add([0.0; 3], v, 1.0 / r);
        if dot(to, end.normal) <= 0.0 || to[2] >= 0.0 {
            return;
        }
        let f = end.weight * phi(angle(to, end.exact), end, r) * -to[2] / (r * r);
        sums[0] += flux * f;
        sums[1] += flux * scene.photons() * f * f;
    });
    sums
}

fn close(found: [f64; 2], sums: [f64; 2], tolerance: f64, what: &str) {
    for (k, (f, s)) in found.into_iter().zip(sums).enumerate() {
        assert!(
            s > 0.0 && (f - s).abs() <= tolerance * s,
            "{what} [{k}]: {f:e} {s:e} {:e}",
            (f / s - 1.0).abs()
        );
    }
}

/// The von Mises–Fisher kernel is analytic, and at these places nothing cuts it: midpoint sums converge geometrically.
#[test]
fn an_uncut_kernel_agrees_with_traced_sums_to_ten_digits() {
    let (alpha, k) = (0.1, Kernel::VonMisesFisher);
    let cases: &[(Scene, u32, [f64; 2])] = &[
        (corner(), 1, [2.3, 1.1]),
        (corner(), 2, [2.3, 1.1]),
        (corner(), 3, [2.3, 1.1]),
        (slab(), 2, [0.9, 0.4]),
        (slab(), 4, [0.9, 0.4]),
        (ball(), 1, [1.1, 0.7]),
        (ball(), 2, [0.9, 0.4]),
        (ball(), 4, [0.9, 0.4]),
        (pillar(0.9), 1, [0.1, 1.4]),
        (pillar(0.9), 2, [0.9, 0.3]),
    ];
    for (scene, n, x) in cases {
        let what = |t| format!("{:?} {n} {x:?} {t}", scene.world);
        let phi = kernel(k, alpha);
        let p = [x[0], x[1], 0.0];
        let get = |t| found(scene, *n, t, k, Convention::Exact, alpha, *x, 1e-11);
        let [camera, symmetric] = from_receiver(scene, *n, p, &phi, [600, 1200]);
        let light = connected(scene, *n, p, [900, 1200], |g, _, _| phi(g));
        println!("{} {camera:?} {light:?}", what(Technique::Camera));
        let t0 = std::time::Instant::now();
        println!("  {:?} {:?} {:?}", get(Technique::Camera), get(Technique::Light), t0.elapsed());
        let _ = symmetric;
    }
}

#[test]
fn timing() {
    for (scene, n, x) in [
        (corner(), 2, [2.3, 1.1]),
        (slab(), 2, [0.9, 0.4]),
        (ball(), 2, [0.9, 0.4]),
        (pillar(0.9), 2, [0.9, 0.3]),
        (cup(1.556), 2, [-0.4, 0.1]),
    ] {
        let truth: Vec<_> = FloorTruth::new(&scene.entry).unwrap().at(x[0], x[1]).iter().map(|p| (interactions(&p.class), p.irradiance.value)).collect();
        println!("{:?} {truth:?}", scene.world);
        for k in [Kernel::Cone, Kernel::VonMisesFisher] {
            for a in [0.3, 0.1, 0.03, 1e-3] {
                for t in [Technique::Camera, Technique::Symmetric, Technique::Light, Technique::Linked] {
                    let t0 = std::time::Instant::now();
                    let e = found(&scene, n, t, k, Convention::Exact, a, x, 1e-9);
                    println!("  {t} {k} {a} {e:?} {:?}", t0.elapsed());
                }
            }
        }
    }
}
