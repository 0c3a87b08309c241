//! Waves against traced light: number of roots by a dense scan, flux density by differences, views by refraction in space.

use nephroid_analytic::kinds::water_waves::{Refused, WaterWaves, Wave};
use nephroid_analytic::vector::Vec3;

use crate::tracing::{Random, V, add, determinant, meet, normal, refract, to_plane, unit};

struct Water {
    n: f64,
    depth: f64,
    waves: Vec<Wave<f64>>,
}

impl Water {
    fn random(r: &mut Random) -> Self {
        let count = 1 + (r.between(0.0, 4.0) as usize);
        let waves = (0..count)
            .map(|_| {
                let wave_number = r.between(1.0, 20.0);
                Wave {
                    amplitude: r.between(0.0, 0.25) / wave_number,
                    wave_number,
                    phase: r.between(-3.0, 3.0),
                }
            })
            .collect();
        Water {
            n: r.between(1.1, 1.8),
            depth: r.between(1.5, 12.0),
            waves,
        }
    }

    fn closed_form(&self) -> WaterWaves<f64> {
        WaterWaves::new(self.n, self.depth, 1.3, self.waves.clone()).expect("flat enough")
    }

    fn height(&self, p: V) -> f64 {
        let term = |w: &Wave<f64>| w.amplitude * libm::cos(w.wave_number * p[0] + w.phase);
        p[2] - self.depth - self.waves.iter().map(term).sum::<f64>()
    }

    fn normal(&self, at: V) -> V {
        // The slope by hand: differences would limit the accuracy of the landing point.
        let term = |w: &Wave<f64>| {
            w.amplitude * w.wave_number * libm::sin(w.wave_number * at[0] + w.phase)
        };
        let exact = unit([self.waves.iter().map(term).sum(), 0.0, 1.0]);
        let rough = normal(|p| self.height(p), at);
        assert!((0..3).all(|k| (exact[k] - rough[k]).abs() < 1e-5));
        exact
    }

    fn trace(&self, u: f64, v: f64) -> Option<(V, f64)> {
        let z = -self.height([u, v, 0.0]);
        let (d, t) = refract([0.0, 0.0, -1.0], self.normal([u, v, z]), self.n);
        to_plane([u, v, z], d, 0.0).map(|p| (p, t))
    }

    fn count(&self, x: f64, reach: f64) -> usize {
        let rays = 20_000;
        let at = |k: i32| x + reach * (f64::from(k) + 0.37) / f64::from(rays);
        let landing = |k: i32| self.trace(at(k), 0.0).map_or(0.0, |(p, _)| p[0] - x);
        let signs: Vec<bool> = (-rays..=rays).map(|k| landing(k) < 0.0).collect();
        signs.windows(2).filter(|w| w[0] != w[1]).count()
    }
}

#[test]
fn all_rays_are_found_and_carry_the_traced_flux() {
    let mut r = Random(7);
    let (mut seen, mut most) = (0, 0);
    for _ in 0..60 {
        let water = Water::random(&mut r);
        let form = water.closed_form();
        let x = r.between(-2.0, 2.0);
        let nearest = form.singularity(x);
        let mut roots = vec![];
        form.for_each_root(x, |root| roots.push(root));
        assert_eq!(roots.len() % 2, 1);
        if nearest.is_none_or(|s| s.distance > 1e-5) {
            let count = water.count(x, form.reach() * 1.01);
            assert_eq!(roots.len(), count, "{:?} {x} {nearest:?}", water.waves);
        }
        most = most.max(roots.len());
        for root in &roots {
            let (landed, weight) = water.trace(root.u, 0.0).expect("it lands");
            assert!((landed[0] - x).abs() <= 1e-15 * (10.0 + root.conditioning));
            if root.conditioning > 1e3 {
                continue;
            }
            seen += 1;
            let map = |u: f64, v: f64| water.trace(root.u + u, v).map(|(p, _)| p);
            let area = determinant(map, 2e-5).expect("a map");
            let traced = 1.3 * weight / area;
            let difference = (traced / root.irradiance - 1.0).abs();
            assert!(difference < 1e-6, "{root:?} {traced:e} {difference:e}");
        }
    }
    assert!(seen > 100 && most >= 5, "{seen} {most}");
}

#[test]
fn folds_are_where_the_number_of_rays_changes() {
    let mut r = Random(8);
    let mut seen = 0;
    for _ in 0..12 {
        let form = Water::random(&mut r).closed_form();
        let mut folds = vec![];
        form.for_each_fold(-3.0, 3.0, |f| folds.push(f));
        for fold in folds.iter().filter(|f| f.u.abs() < 2.0) {
            let d = 1e-7;
            let count = |x: f64| i64::from(form.caustic(x).roots);
            let change = count(fold.x + d) - count(fold.x - d);
            let alone = folds.iter().filter(|f| (f.x - fold.x).abs() < 1e-5).count() == 1;
            if alone {
                seen += 1;
                assert_eq!(change.abs(), 2, "{fold:?}");
                let distance = form.singularity(fold.x + d).map(|s| s.distance);
                assert!(distance.is_some_and(|s| s <= 1.0001 * d), "{distance:?}");
            }
        }
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn views_are_refracted_rays() {
    let mut r = Random(9);
    let mut seen = 0;
    for _ in 0..40 {
        let water = Water::random(&mut r);
        let form = water.closed_form();
        let camera = [
            r.between(-1.0, 1.0),
            r.between(-1.0, 1.0),
            water.depth + r.between(1.0, 2.0),
        ];
        let aim = [r.between(-1.0, 1.0), r.between(-1.0, 1.0), water.depth];
        let d = unit(add(aim, camera, -1.0));
        let answer = form.look(Vec3::from_f64(camera), Vec3::from_f64(aim));
        let hit = meet(|p| water.height(p), camera, d, 0.0, 9.0).expect("a hit");
        let (inside, t) = refract(d, water.normal(hit), water.n);
        let floor = to_plane(hit, inside, 0.0).expect("the floor");
        let answer = answer.expect("seen");
        seen += 1;
        let off = (answer.floor - Vec3::from_f64(floor)).length();
        assert!(off <= answer.error + 1e-13, "{off:e} {:e}", answer.error);
        assert!(answer.error < 1e-10, "{:e}", answer.error);
        assert!((answer.weight - t / (water.n * water.n)).abs() < 1e-13);
    }
    assert!(seen > 30, "{seen}");
}

#[test]
fn what_has_no_closed_form_is_refused() {
    let wave = |amplitude: f64, wave_number: f64| {
        vec![Wave {
            amplitude,
            wave_number,
            phase: 0.0,
        }]
    };
    let new = |n: f64, h: f64, w: Vec<Wave<f64>>| WaterWaves::new(n, h, 1.0, w).err();
    assert_eq!(new(1.0, 1.0, wave(0.1, 1.0)), Some(Refused::Index));
    assert_eq!(new(1.3, 1.0, wave(1.0, 1.0)), Some(Refused::Depth));
    assert_eq!(new(1.333, 1.0, wave(0.5, 8.0)), Some(Refused::Steep));
    let many = Some(Refused::TooManyWavelengths);
    assert_eq!(new(1.333, 1.0, wave(1e-5, 1e4)), None);
    assert_eq!(new(1.333, 1e5, wave(1e-5, 1e5)), many);
    // Flat water: one ray, straight down.
    let flat = WaterWaves::new(1.5, 2.0, 1.0, vec![]).expect("flat");
    assert!((flat.caustic(0.3).value - 0.96_f64).abs() < 1e-15);
    assert!(flat.singularity(0.3).is_none());
}
