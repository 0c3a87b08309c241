//! Probes of every kind against the closed form, and against sums over the mirror that share no code with them.

use nephroid::entry;
use nephroid::integrators::Kernel;
use nephroid::integrators::probes::{Distance, Estimator, Sums, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Entry;

/// Catalogue entries with a floor and a specular surface.
const SCENES: [&str; 20] = [
    "mirror-wall",
    "corner",
    "cup",
    "cup-rim",
    "deep-cup",
    "pillar",
    "conic-wall",
    "glass-pillar",
    "glass-column",
    "pool",
    "underwater",
    "ripple-pool",
    "slab",
    "dome",
    "ball",
    "dish",
    "ellipsoid",
    "hyperboloid",
    "lens",
    "glass-ball",
];

/// The point of a grid on the floor at which a class's irradiance is smoothest: its mean over eight neighbours differs least
/// from it, relative to it; and the irradiance.
fn regular_point(truth: &FloorTruth, class: PathClass, part: f64) -> Option<([f64; 2], f64)> {
    let [x0, x1] = truth.range(0);
    let [y0, y1] = truth.range(1);
    let value = |x: f64, y: f64| {
        let at = truth.at(x, y);
        let light = at.iter().find(|l| l.class == class)?;
        (truth.is_on_floor(x, y) && light.is_finite()).then_some(light.irradiance.value)
    };
    let n = 60;
    let step = part * (x1 - x0).min(y1 - y0);
    let mut best: Option<(f64, [f64; 2], f64)> = None;
    for k in 0..n * n {
        let x = x0 + (x1 - x0) * (f64::from(k % n) + 0.437) / f64::from(n);
        let y = y0 + (y1 - y0) * (f64::from(k / n) + 0.391) / f64::from(n);
        let Some(e) = value(x, y).filter(|e| *e > 0.0) else {
            continue;
        };
        let mut rough = 0.0;
        for d in 0..16 {
            let far = if d < 8 { 1.0 } else { 2.0 } * step;
            let (s, c) = libm::sincos(f64::from(d) * core::f64::consts::FRAC_PI_4);
            rough += match value(x + far * c, y + far * s) {
                Some(v) if v > 0.0 => (v / e - 1.0).abs(),
                _ => f64::INFINITY,
            };
        }
        if best.is_none_or(|(least, ..)| rough < least) && rough < f64::INFINITY {
            best = Some((rough, [x, y], e));
        }
    }
    best.map(|(_, p, e)| (p, e))
}

fn aimed(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    distance: Option<Distance>,
    paths: u64,
    bandwidth: f64,
    point: [f64; 2],
) -> (Vec<PathClass>, Vec<Sums>, Vec<f64>) {
    let e = Estimator::new(entry, technique, kernel, distance).unwrap();
    let aim = e.aim(bandwidth, point).unwrap();
    let sums = e.run_aimed(5, 0, paths, bandwidth, point, &aim).unwrap();
    let shares = (0..sums.len()).map(|k| aim.share(k)).collect();
    (e.classes().to_vec(), sums, shares)
}

#[test]
fn explore() {
    for scene in std::env::var("S")
        .map(|s| s.split(",").map(str::to_owned).collect::<Vec<_>>())
        .unwrap_or_default()
    {
        let scene = scene.as_str();
        let entry = entry::load(scene).unwrap();
        let truth = FloorTruth::new(&entry).unwrap();
        let classes: Vec<PathClass> = truth
            .at(0.0, 0.0)
            .iter()
            .map(|l| l.class)
            .filter(|c| c.is_caustic())
            .collect();
        for class in classes {
            let Some((point, e)) = [0.02, 0.005, 0.001]
                .into_iter()
                .find_map(|s| regular_point(&truth, class, s))
            else {
                println!("{scene} {class}: no point");
                continue;
            };
            print!("{scene} {class} {point:?} E {e:.5}");
            for (t, k, b) in [
                (Technique::Camera, Kernel::Cone, 0.01),
                (Technique::Light, Kernel::Cone, 0.01),
                (Technique::Merge, Kernel::Disc, 0.01),
            ] {
                let start = std::time::Instant::now();
                let e1 = Estimator::new(&entry, t, k, None);
                if e1.is_err() {
                    print!(" ERR");
                    continue;
                }
                let (cs, sums, shares) = aimed(&entry, t, k, None, 100_000, b, point);
                let i = cs.iter().position(|c| *c == class).unwrap();
                let s = sums[i];
                print!(
                    " | {} {:.4}±{:.4} hits {:.2} share {:.1e} {:.2}s",
                    t.name(),
                    s.mean() / e,
                    s.standard_error() / e,
                    s.nonzero as f64 / s.paths as f64,
                    shares[i],
                    start.elapsed().as_secs_f64()
                );
            }
            println!();
        }
    }
}
