//! Entries with refraction: the closed form against rays of the renderer's own geometry, which shares no code with it.

use glam::DVec3;
use nephroid::entry;
use nephroid::geometry::chains::Chains;
use nephroid::geometry::compiled::{Visitor, visit};
use nephroid::geometry::emission::Emitter;
use nephroid::geometry::light::Light;
use nephroid::geometry::scene::{Overrides, Scene};
use nephroid::geometry::specular::Specular;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Entry;

/// Where a photon of the unit square of emission lands by a chain, and its weight.
fn land<L: Light, S: Chains>(
    scene: &Scene<L, S>,
    chain: usize,
    u: f64,
    v: f64,
) -> Option<[f64; 3]> {
    let targets = scene.surface.targets(&scene.floor.hull());
    let (origin, direction) = scene.light.aimed(&targets).ray(u, v);
    let leg = scene.surface.follow(chain, origin, direction);
    let t = -leg.origin.z / leg.direction.z;
    let at: DVec3 = leg.origin + leg.direction * t;
    (leg.weight > 0.0 && leg.direction.z < 0.0).then_some([at.x, at.y, leg.weight])
}

/// Irradiance at the landing point by this one photon's surroundings: flux per unit square over the Jacobian, by
/// differences of fourth order.
struct OneRoot<'a> {
    entry: &'a Entry,
    chain: usize,
}

impl Visitor for OneRoot<'_> {
    /// Number of compared points and the largest relative difference.
    type Output = (usize, f64);

    fn scene<L: Light, S: Specular>(self, _: Scene<L, S>) -> Self::Output {
        panic!("a kind with chains is expected")
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Self::Output {
        let truth = FloorTruth::new(self.entry).unwrap();
        let targets = scene.surface.targets(&scene.floor.hull());
        let flux = scene.light.aimed(&targets).flux();
        let (mut compared, mut worst) = (0, 0.0_f64);
        for k in 0..900 {
            let (u, v) = (
                (f64::from(k % 30) + 0.5) / 30.0,
                (f64::from(k / 30) + 0.5) / 30.0,
            );
            let h = 1e-4;
            let stencil = |du: f64, dv: f64| land(&scene, self.chain, u + du * h, v + dv * h);
            let difference = |along: &dyn Fn(f64) -> Option<[f64; 3]>| -> Option<[f64; 2]> {
                let (a, b, c, d) = (along(1.0)?, along(-1.0)?, along(2.0)?, along(-2.0)?);
                Some([0, 1].map(|i| (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * h)))
            };
            let (Some([x, y, weight]), Some(by_u), Some(by_v)) = (
                stencil(0.0, 0.0),
                difference(&|s| stencil(s, 0.0)),
                difference(&|s| stencil(0.0, s)),
            ) else {
                continue;
            };
            if !truth.is_on_floor(x, y) {
                continue;
            }
            let determinant = by_u[0] * by_v[1] - by_u[1] * by_v[0];
            let expected = flux * weight / determinant.abs();
            let found = truth.at(x, y)[self.chain].irradiance;
            assert_eq!(found.roots, 1);
            worst = worst.max((found.value / expected - 1.0).abs());
            compared += 1;
        }
        (compared, worst)
    }
}

/// Differences of fourth order with a step of 1e-4 leave less than 1e-8 where the map is as smooth as here.
#[test]
fn one_root_entries_are_what_their_rays_say() {
    for (name, chain, at_least) in [("underwater", 0, 200), ("slab", 0, 200), ("slab", 1, 200)] {
        let entry = entry::load(name).unwrap();
        let one = OneRoot {
            entry: &entry,
            chain,
        };
        let (compared, worst) = visit(&entry, Overrides::default(), one);
        assert!(compared >= at_least, "{name} {chain}: {compared}");
        assert!(worst <= 1e-7, "{name} {chain}: {worst:e}");
    }
}
