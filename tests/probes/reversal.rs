//! Tracing back and tracing forward are each other's inverse on every kind, and meet surfaces within their boxes.

use glam::DVec3;
use nephroid::entry;
use nephroid::geometry::chains::Chains;
use nephroid::geometry::compiled::{Visitor, visit};
use nephroid::geometry::furnace::Furnace;
use nephroid::geometry::light::Light;
use nephroid::geometry::once::Once;
use nephroid::geometry::scene::{Overrides, Scene};
use nephroid::geometry::specular::Specular;

/// Numbers of rays that were reversed, per caustic chain.
struct Reverse<'a>(&'a str);

impl Visitor for Reverse<'_> {
    type Output = Vec<u32>;

    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Vec<u32> {
        self.chains(Scene {
            light: scene.light,
            surface: Once(scene.surface),
            floor: scene.floor,
            camera: scene.camera,
        })
    }

    /// A ray from the floor, traced back and a little way on, then followed from there as light: it comes to the same floor point,
    /// by the same reflectances and transmittances.
    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Vec<u32> {
        let (surface, corners) = (&scene.surface, scene.floor.hull());
        let [low, high] = [corners[0], corners[3]];
        let classes = surface.classes();
        let caustic = |&chain: &usize| classes[chain].is_caustic();
        let check = |chain: usize| {
            let mut reversed = 0;
            for k in 0..40_000_u32 {
                // A lattice in four dimensions.
                let at = |step: f64| {
                    let v = f64::from(k) * step;
                    v - f64::floor(v)
                };
                let x = DVec3::new(
                    low.x + (high.x - low.x) * at(0.856_674_883_854_502_9),
                    low.y + (high.y - low.y) * at(0.733_891_856_627_126),
                    0.0,
                );
                let (s, c) = libm::sincos(core::f64::consts::TAU * at(0.628_706_738_871_094_5));
                let square = at(0.538_597_257_223_612_6);
                let r = f64::sqrt(square);
                let direction = DVec3::new(r * c, r * s, f64::sqrt(1.0 - square));
                let Some(back) = surface.trace_back(chain, x, direction) else {
                    continue;
                };
                assert!((back.direction.length() - 1.0).abs() < 1e-12);
                assert!((back.normal.length() - 1.0).abs() < 1e-12);
                let cosine = back.direction.dot(back.normal);
                assert!(cosine > 0.0 && back.weight > 0.0 && back.weight <= 1.0);
                if let Some([low, high]) = surface.bounds() {
                    let wide = DVec3::splat(1e-9);
                    assert_eq!(back.point.clamp(low - wide, high + wide), back.point);
                }
                // Grazing rays amplify rounding; rippled water is entered from above.
                let steep = self.0 != "ripple-pool" || back.direction.z > 0.8;
                if cosine < 0.05 || direction.z < 0.05 || back.weight < 1e-6 || !steep {
                    continue;
                }
                let length = surface.again(&back, back.direction).min(1.0);
                let start = back.point + back.direction * (0.5 * length);
                let Some(forward) = surface.strike(chain, start, -back.direction) else {
                    panic!("{} {chain}: no way back from {start} to {x}", self.0);
                };
                let to_x = x - forward.point;
                let miss = to_x - forward.direction * to_x.dot(forward.direction);
                assert!(miss.length() < 1e-6, "{} {chain}: {miss}", self.0);
                let off = forward.weight / back.weight - 1.0;
                assert!(off.abs() < 1e-6, "{} {chain}: {off}", self.0);
                reversed += 1;
            }
            reversed
        };
        (0..classes.len()).filter(caustic).map(check).collect()
    }

    fn furnace(self, _: Furnace) -> Vec<u32> {
        Vec::new()
    }
}

#[test]
fn light_comes_back_the_way_that_was_traced() {
    let mut chains = 0;
    for name in entry::names() {
        let entry = entry::load(name).unwrap();
        let reversed = visit(&entry, Overrides::default(), Reverse(name));
        println!("{name}: {reversed:?}");
        assert!(reversed.iter().all(|&n| n >= 20), "{name}: {reversed:?}");
        chains += reversed.len();
    }
    assert!(chains >= 34);
}
