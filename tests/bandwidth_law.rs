//! Laws of small bandwidth and best bandwidths on the catalogue's scenes, against exact expectations.

use nephroid::entry;
use nephroid_analytic::bandwidth::law::{Law, Place, extrapolated};
use nephroid_analytic::bandwidth::optimum::Study;
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Entry;

fn study(entry: &Entry, technique: Technique, kernel: Kernel) -> Study {
    Study::new(entry, technique, kernel, Convention::Exact, 1.0).unwrap()
}

/// Low-discrepancy floor points.
fn points(entry: &Entry, count: u32) -> Vec<[f64; 2]> {
    let truth = FloorTruth::new(entry).unwrap();
    (1..=count)
        .map(|k| {
            let t = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|g| (f64::from(k) * g).fract());
            [0, 1].map(|i| {
                let [a, b] = truth.range(i);
                a + (b - a) * t[i]
            })
        })
        .collect()
}

#[test]
fn look() {
    for name in ["mirror-wall", "dome", "ball", "pillar", "cup", "cup-rim", "conic-wall", "pool", "underwater", "ripple-pool", "dish", "ellipsoid", "hyperboloid", "lens", "slab", "corner", "deep-cup", "glass-pillar", "glass-ball", "glass-column"] {
        let e = entry::load(name).unwrap();
        for (t, k) in [(Technique::Camera, Kernel::Cone), (Technique::Light, Kernel::Epanechnikov), (Technique::Linked, Kernel::Cone), (Technique::Merge, Kernel::Disc)] {
            let Ok(s) = Study::new(&e, t, k, Convention::Exact, 1.0) else { println!("{name} {t}: none"); continue };
            let start = std::time::Instant::now();
            let (mut none, mut places) = (0, std::collections::BTreeMap::new());
            let mut laws: Vec<(usize, [f64; 2], Law)> = Vec::new();
            for x in points(&e, 30) {
                for (c, law) in s.laws(x[0], x[1]).into_iter().enumerate() {
                    match law {
                        None => none += 1,
                        Some(l) => { *places.entry(l.place.name()).or_insert(0) += 1; laws.push((c, x, l)); }
                    }
                }
            }
            let time = start.elapsed().as_secs_f64() / 30.0;
            let mut worst = (0.0, String::new());
            let start = std::time::Instant::now();
            let mut n = 0;
            for (c, x, l) in laws.iter().filter(|l| l.2.place == Place::Smooth).take(4) {
                let a = 0.1 * l.reach.min(0.3);
                n += 1;
                let m = |b: f64| s.moments(*c, *x, b, 1e-12).unwrap().mean.value;
                let found = extrapolated(m, a, 2.0);
                let noise = 1e-11 * l.limit.unwrap() / (a * a);
                let off = ((found - l.coefficient).abs() - noise).max(0.0) / l.coefficient.abs();
                if off > worst.0 { worst = (off, format!("{x:?} {found} {} {:e} reach {} roots {} limit {:?}", l.coefficient, l.error, l.reach, l.roots, l.limit)); }
            }
            println!("{name} {t}: none {none} {places:?} {:.2} ms, worst {worst:?} {:.1} ms each of {n}", 1e3 * time, 1e3 * start.elapsed().as_secs_f64() / 3.0 / f64::from(n.max(1)));
        }
    }
}
