//! Full paths, built from either side: their weights sum to 1.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use super::bidirectional::{Bidirectional, Block};
use super::kernel::{AngleKernel, Kernel};
use super::mis::{Heuristic, Sharing};
use super::mollified_vertex::{Joint, Joints};
use super::settings::Settings;
use super::shared_connections::{connect_to_light, connect_to_pinhole, project};
use crate::entry;
use crate::geometry::scene::{Overrides, unit};
use crate::geometry::tracer::{Aim, Rays, Tracer, tracer};
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

/// Direct light at the floor points that a block of camera subpaths sees, and the same full paths from the light: photons
/// sent exactly there. The weights of each sum to 1.
#[test]
fn weights_of_direct_light_from_either_side_sum_to_one() {
    for name in ["floor", "mirror-wall", "cup", "dome", "corner"] {
        let entry = entry::load(name).unwrap();
        let bdpt = Bidirectional::new(
            tracer(&entry, Overrides::default()).unwrap(),
            entry.kind.classes(),
            true,
            Settings::default(),
        );
        let outline = bdpt.tracer.outline();
        let direct = bdpt
            .tracer
            .chains()
            .iter()
            .position(|&c| c == PathClass::LDE)
            .unwrap();
        let index = bdpt
            .beams
            .iter()
            .position(|b| b.classes[direct].is_some())
            .unwrap();
        let mut block = Block::new();
        let mut complete = 0;
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let sharing = Sharing {
                heuristic,
                fault: None,
            };
            bdpt.eye_subpaths(&Stream::new(3, 1), 0, BLOCK, &mut block);
            let Block {
                eye,
                rays,
                photons,
                light,
                irradiance,
                cosine,
                free,
                value,
                ..
            } = &mut block;
            bdpt.tracer.lit(&eye.x, &eye.y, irradiance, cosine);
            // A path through a surface has no second technique: the weight 1.
            let mut from_eye = [zeros(), zeros()];
            let straight = eye.chain;
            for (through, values) in [1.0, 0.0].into_iter().zip(&mut from_eye) {
                eye.chain = [through; BLOCK];
                connect_to_light(
                    &outline.camera,
                    &sharing,
                    &bdpt.defect,
                    bdpt.direct_flux,
                    [1.0; 2],
                    eye,
                    [irradiance, cosine],
                    values,
                );
            }
            bdpt.beams[index]
                .emission
                .rays(&[0.5; BLOCK], &[0.5; BLOCK], photons);
            for i in 0..BLOCK {
                let point = DVec3::new(eye.x[i], eye.y[i], 0.0);
                if let Some(position) = outline.light {
                    photons.direction.set(i, unit(point - position));
                } else {
                    let travel = photons.direction.get(i);
                    let height = photons.origin.z[i];
                    photons.origin.set(i, point + travel * (height / travel.z));
                }
            }
            bdpt.tracer.land(index, photons, light);
            bdpt.tracer.seen(&light.x, &light.y, free);
            let [column, row, density] =
                [&mut rays.origin.x, &mut rays.origin.y, &mut rays.origin.z];
            project(&outline.camera, light, free, column, row, density);
            bdpt.tracer.lit(&light.x, &light.y, irradiance, cosine);
            let mut from_light = [zeros(), zeros()];
            for (shared, values) in [None, Some(bdpt.direct_flux)]
                .into_iter()
                .zip(&mut from_light)
            {
                connect_to_pinhole(
                    &outline.camera,
                    &sharing,
                    &bdpt.defect,
                    shared,
                    1.0,
                    light,
                    [irradiance, cosine],
                    density,
                    values,
                );
            }
            for i in 0..BLOCK {
                if !(from_eye[0][i] > 0.0 && straight[i] == 0.0) {
                    continue;
                }
                complete += 1;
                let weights = [
                    from_eye[1][i] / from_eye[0][i],
                    from_light[1][i] / from_light[0][i],
                ];
                let sum = weights[0] + weights[1];
                assert!((sum - 1.0).abs() < 1e-12, "{name} {heuristic}: {weights:?}");
            }
            value.fill(0.0);
        }
        assert!(complete > 100, "{name}: {complete}");
    }
}

/// Floor points and directions of a block, on a lattice over the part of the floor next to the origin.
fn points(x: &mut Lanes, y: &mut Lanes, half: [f64; 2]) {
    let at = |i: usize, step: f64| {
        let v = (i as f64 + 0.5) * step;
        v - f64::floor(v)
    };
    for i in 0..BLOCK {
        x[i] = half[0] * (2.0 * at(i, 0.618_033_988_749_894_8) - 1.0);
        y[i] = half[1] * (2.0 * at(i, 0.414_213_562_373_095_1) - 1.0);
    }
}

/// A full path, built by the camera's technique, is built once more by the light's: a photon sent exactly to its specular
/// vertex. Their weights sum to 1, and the contributions divided by the weights differ by the ratio of the densities.
#[test]
fn weights_of_a_full_path_from_either_side_sum_to_one() {
    for (name, half) in [
        ("mirror-wall", [1.5, 1.5]),
        ("cup", [0.8, 0.8]),
        ("pool", [1.0, 1.0]),
    ] {
        let entry = entry::load(name).unwrap();
        let tracer = tracer(&entry, Overrides::default()).unwrap();
        let outline = tracer.outline().clone();
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let kernel = AngleKernel::new(Kernel::Cone, 0.9, None);
            let joint = |shared: bool| Joint {
                gain: outline.radiance_gain,
                refracts: outline.refracts,
                flux: tracer.emission(Aim::Scene).flux(),
                sharing: shared.then_some(Sharing {
                    heuristic,
                    fault: None,
                }),
                fault: None,
            };
            let (mut x, mut y) = (zeros(), zeros());
            points(&mut x, &mut y, half);
            let (mut u, mut v) = (zeros(), zeros());
            let mut joints = Joints::new();
            let mut complete = 0;
            for k in 0..40 {
                let stream = Stream::new(5, k);
                stream.pairs(0, Dimension::Direction, &mut u, &mut v);
                let floor = [&x, &y];
                let mut camera = [zeros(), zeros()];
                for (shared, value) in [false, true].into_iter().zip(&mut camera) {
                    joints.meet_from_camera(&*tracer, floor, [&u, &v], &joint(shared), &kernel);
                    *value = joints.value;
                }
                // Photons from the light to the same vertices, from just before them.
                let mut photons = Rays::default();
                for i in 0..BLOCK {
                    let point = joints.vertices.point.get(i);
                    let towards = match outline.light {
                        Some(light) => light - point,
                        None => -unit(tracer_travel(&*tracer)) * 0.01,
                    };
                    photons.origin.set(i, point + towards);
                    photons.direction.set(i, -towards);
                }
                let mut light = [zeros(), zeros()];
                for (shared, value) in [false, true].into_iter().zip(&mut light) {
                    joints.meet_from_light(&*tracer, &photons, floor, &joint(shared), &kernel);
                    *value = joints.value;
                }
                for i in 0..BLOCK {
                    if !(camera[0][i] > 0.0) {
                        continue;
                    }
                    complete += 1;
                    let weights = [camera[1][i] / camera[0][i], light[1][i] / light[0][i]];
                    let sum = weights[0] + weights[1];
                    assert!((sum - 1.0).abs() < 1e-12, "{name} {heuristic}: {weights:?}");
                    if heuristic == Heuristic::Balance {
                        let (a, b) = (camera[1][i], light[1][i]);
                        assert!((a / b - 1.0).abs() < 1e-9, "{name}: {a} {b}");
                    }
                }
            }
            assert!(complete > 300, "{name}: {complete}");
        }
    }
}

/// The direction of parallel light.
fn tracer_travel(tracer: &dyn Tracer) -> glam::DVec3 {
    let mut rays = Rays::default();
    let (u, v) = (zeros(), zeros());
    tracer.emission(Aim::Scene).rays(&u, &v, &mut rays);
    rays.direction.get(0)
}
