//! Certificates of the vertical walls against their closed forms on varied parameters: each value within its bound of the
//! enclosure, the same number of rays, narrow intervals away from singularities. There are no tables for these kinds.

use nephroid_analytic::certificate::{Certified, conic_wall, glass_pillar, pillar};
use nephroid_analytic::enclosure::Enclosure;
use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::glass_pillar::GlassPillar;
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::vec3;

/// Evenly spread numbers in [0, 1].
struct Spread(u64);

impl Spread {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 11) as f64 / 9_007_199_254_740_992.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

#[derive(Debug, Default)]
struct Tally {
    values: u32,
    proven: u32,
    /// Points by their number of rays.
    rays: [u32; 8],
    widest: f64,
}

impl Tally {
    fn check(&mut self, what: &str, f64_value: Estimate<f64>, certified: Certified) {
        self.values += 1;
        let bound = f64_value.error;
        assert!(
            f64_value.value - bound <= certified.value.high()
                && certified.value.low() <= f64_value.value + bound,
            "{what}: {f64_value:?} {certified:?}"
        );
        if !certified.is_proven() {
            return;
        }
        self.proven += 1;
        // A shadow's edge within rounding of the closed form makes its bound as large as a ray.
        if bound < 1e-3 * f64_value.value || f64_value.value == 0.0 && bound == 0.0 {
            assert_eq!(
                certified.roots, f64_value.roots,
                "{what}: {f64_value:?} {certified:?}"
            );
            self.rays[certified.roots as usize] += 1;
        }
        if f64_value.value > 0.0 && f64_value.conditioning() < 100.0 {
            self.widest = self.widest.max(certified.value.relative_width());
        }
    }
}

fn point(value: f64) -> Enclosure {
    Enclosure::point(value)
}

fn pillar_of<S: Scalar>(p: [f64; 9]) -> Pillar<S> {
    let [x, y, radius, height, reflectance, lx, ly, lz, intensity] = p.map(S::from_f64);
    Pillar {
        x,
        y,
        radius,
        height,
        reflectance,
        light: vec3(lx, ly, lz),
        intensity,
    }
}

#[test]
fn reflecting_pillars() {
    let (mut spread, mut caustic, mut direct) = (Spread(5), Tally::default(), Tally::default());
    for trial in 0..12 {
        let s = &mut spread;
        let p = [
            s.between(-0.3, 0.3),
            s.between(-0.3, 0.3),
            s.between(0.2, 0.6),
            s.between(0.5, 1.5),
            s.between(0.5, 1.0),
            s.between(-2.0, -1.0),
            s.between(-1.0, 1.0),
            s.between(0.5, 2.5),
            s.between(0.5, 5.0),
        ];
        let (form, proof) = (pillar_of::<f64>(p), pillar_of::<Enclosure>(p));
        for _ in 0..60 {
            let (x, y) = (s.between(-2.0, 2.0), s.between(-2.0, 2.0));
            let what = format!("{trial} {p:?} ({x}, {y})");
            let bundle = pillar::caustic_enclosed(&proof, point(x), point(y));
            caustic.check(&what, form.caustic(x, y), bundle.total);
            direct.check(
                &format!("direct {what}"),
                form.direct(x, y),
                pillar::direct_enclosed(&proof, point(x), point(y)),
            );
        }
    }
    println!("{caustic:?} {direct:?}");
    assert!(caustic.proven == caustic.values && direct.proven == direct.values);
    assert!(caustic.rays[0] > 50 && caustic.rays[1] > 200 && direct.rays[0] > 20);
    assert!(caustic.widest < 1e-11 && direct.widest < 1e-13);
}

fn glass_of<S: Scalar>(p: [f64; 7], sin_elevation: f64) -> GlassPillar<S> {
    let [x, y, radius, height, index, irradiance, cos_elevation] = p.map(S::from_f64);
    GlassPillar {
        x,
        y,
        radius,
        height,
        index,
        irradiance,
        sin_elevation: S::from_f64(sin_elevation),
        cos_elevation,
    }
}

#[test]
fn glass_pillars() {
    let (mut spread, mut caustic, mut direct) = (Spread(6), Tally::default(), Tally::default());
    for trial in 0..10 {
        let s = &mut spread;
        let elevation = s.between(0.2, 1.0);
        let p = [
            s.between(-0.3, 0.3),
            s.between(-0.3, 0.3),
            s.between(0.2, 0.6),
            s.between(0.8, 3.0),
            s.between(1.2, 1.8),
            s.between(0.5, 5.0),
            libm::cos(elevation),
        ];
        let sine = libm::sin(elevation);
        let (form, proof) = (glass_of::<f64>(p, sine), glass_of::<Enclosure>(p, sine));
        for _ in 0..60 {
            let (x, y) = (s.between(-2.0, 2.0), s.between(-1.0, 1.0));
            for interactions in 1..=4 {
                let what = format!("{trial} {p:?} m = {interactions} ({x}, {y})");
                let bundle =
                    glass_pillar::caustic_enclosed(&proof, point(x), point(y), interactions);
                caustic.check(&what, form.caustic(x, y, interactions), bundle.total);
            }
            direct.check(
                &format!("direct {trial} {p:?} ({x}, {y})"),
                form.direct(x, y),
                glass_pillar::direct_enclosed(&proof, point(x), point(y)),
            );
        }
    }
    println!("{caustic:?} {direct:?}");
    assert!(caustic.proven == caustic.values && direct.proven == direct.values);
    assert!(caustic.rays[0] > 200 && caustic.rays[1] > 200 && caustic.rays[3] > 5);
    assert!(caustic.widest < 1e-11 && direct.rays[0] > 20);
}

fn wall_of<S: Scalar>(p: [f64; 12], half_arc: Option<f64>) -> ConicWall<S> {
    let [
        x,
        y,
        c,
        s,
        parameter,
        eccentricity,
        height,
        reflectance,
        lx,
        ly,
        lz,
        intensity,
    ] = p.map(S::from_f64);
    ConicWall {
        x,
        y,
        axis: (c, s),
        parameter,
        eccentricity,
        half_arc: half_arc.map(S::from_f64),
        height,
        reflectance,
        light: vec3(lx, ly, lz),
        intensity,
    }
}

#[test]
fn conic_walls() {
    let (mut spread, mut caustic, mut direct) = (Spread(7), Tally::default(), Tally::default());
    for trial in 0..24 {
        let s = &mut spread;
        // Ellipses, parabolas, hyperbolas; a closed ellipse; light off the focus and in it.
        let e = [0.3, 0.55, 1.0, 1.4][trial % 4];
        let half_arc = match trial % 8 {
            0 => None,
            1 => Some(2.5),
            3 | 7 => Some(1.2),
            _ => Some(1.4),
        };
        let turn = s.between(0.0, 6.0);
        let (x, y) = (s.between(-0.2, 0.2), s.between(-0.2, 0.2));
        // In the focus for every third: there x and y are what the wall has, to the bit.
        let (lx, ly) = if trial % 3 == 0 {
            (x, y)
        } else {
            (x + s.between(-0.2, 0.2), y + s.between(-0.2, 0.2))
        };
        let p = [
            x,
            y,
            libm::cos(turn),
            libm::sin(turn),
            s.between(0.7, 1.1),
            e,
            s.between(1.0, 3.0),
            s.between(0.5, 1.0),
            lx,
            ly,
            s.between(0.8, 2.5),
            s.between(0.5, 5.0),
        ];
        let (form, proof) = (
            wall_of::<f64>(p, half_arc),
            wall_of::<Enclosure>(p, half_arc),
        );
        for _ in 0..60 {
            let (x, y) = (s.between(-1.6, 1.6), s.between(-1.6, 1.6));
            let what = format!("{trial} {p:?} ({x}, {y})");
            let bundle = conic_wall::caustic_enclosed(&proof, point(x), point(y));
            caustic.check(&what, form.caustic(x, y), bundle.total);
            direct.check(
                &format!("direct {what}"),
                form.direct(x, y),
                conic_wall::direct_enclosed(&proof, point(x), point(y)),
            );
        }
    }
    println!("{caustic:?} {direct:?}");
    assert!(caustic.proven == caustic.values, "{caustic:?}");
    assert!(direct.proven == direct.values, "{direct:?}");
    assert!(caustic.rays[0] > 100 && caustic.rays[1] > 200 && caustic.rays[2] > 30);
    assert!(caustic.widest < 1e-11 && direct.rays[0] > 50, "{caustic:?}");
}
