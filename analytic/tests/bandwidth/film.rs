//! Pixels and film regions at finite bandwidth, against a plain supersampling of a coarse image.

use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Expectation, Kernel, PlanarSetting, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{
    DiffuseScene, Entry, FlatInterfaceScene, Floor, Kind, PlanarMirrorScene, RectangleMirror,
};
use nephroid_analytic::vector::{Vec3, vec3};

use crate::mirror_entry::mirror_entry;

const PI: f64 = core::f64::consts::PI;

/// A mirror over a small floor, generic constants, the mirror low enough that light lands close to it.
fn entry(size: u32) -> Entry {
    let floor = Floor {
        center: [0.1, 0.0],
        half_width: [1.3, 1.6],
        albedo: 0.6,
    };
    let mirror = RectangleMirror {
        center: [0.0, 1.0, 0.55],
        normal: [0.1, -1.0, 0.0],
        edge: [1.0, 0.1, 0.0],
        half_width: 0.75,
        half_height: 0.4,
        reflectance: 0.85,
    };
    let camera = ([0.2, -2.6, 1.9], [0.0, 0.5, 0.3], 44.0);
    mirror_entry([0.25, 0.1, 1.7], 2.9, floor, mirror, camera, size)
}

/// The floor point that the eye sees through film point (u, v) in [0, 1]², for (direct, mirrored): at most one is there.
fn look(e: &Entry, u: f64, v: f64) -> [Option<Vec3<f64>>; 2] {
    let Kind::PlanarMirror(PlanarMirrorScene { floor, mirror, .. }) = &e.kind else {
        unreachable!()
    };
    let p = Vec3::from_f64(e.camera.position);
    let forward = (Vec3::from_f64(e.camera.look_at) - p).normalized();
    let right = forward.cross(vec3(0.0, 0.0, 1.0)).normalized();
    let up = right.cross(forward);
    let half = libm::tan(0.5 * e.camera.field_of_view_degrees * PI / 180.0);
    let d = forward + right * (half * (2.0 * u - 1.0)) + up * (half * (1.0 - 2.0 * v));
    let on_floor = |p: Vec3<f64>, d: Vec3<f64>| {
        let t = -p.z / d.z;
        let x = p + d * t;
        let inside = (x.x - floor.center[0]).abs() <= floor.half_width[0]
            && (x.y - floor.center[1]).abs() <= floor.half_width[1];
        (t > 0.0 && inside).then_some((t, x))
    };
    let n = Vec3::from_f64(mirror.normal).normalized();
    let a = Vec3::from_f64(mirror.edge).normalized();
    let b = n.cross(a);
    let c = Vec3::from_f64(mirror.center);
    let t = (c - p).dot(n) / d.dot(n);
    let s = p + d * t - c;
    let floor_hit = on_floor(p, d);
    let hits_mirror = t > 0.0
        && s.dot(a).abs() <= mirror.half_width
        && s.dot(b).abs() <= mirror.half_height
        && floor_hit.is_none_or(|(tf, _)| t < tf);
    if hits_mirror {
        let reflected = d - n * (2.0 * d.dot(n));
        [None, on_floor(s + c, reflected).map(|h| h.1)]
    } else {
        [floor_hit.map(|h| h.1), None]
    }
}

#[test]
fn pixels_agree_with_supersampling_and_add_up_to_the_region() {
    let cases = [
        (Technique::Camera, Kernel::Cone, 0.25),
        (Technique::Light, Kernel::Epanechnikov, 0.4),
        (Technique::Symmetric, Kernel::VonMisesFisher, 0.1),
        (Technique::Merge, Kernel::Disc, 0.2),
        (Technique::Linked, Kernel::Cone, 0.2),
    ];
    for (t, k, b) in cases {
        let slow = t == Technique::Linked || k == Kernel::VonMisesFisher;
        let size = if slow { 4 } else { 8 };
        let e = entry(size);
        let film = FilmExpectation::new(&e, t, k, &[b]).unwrap();
        assert_eq!(film.classes(), [PathClass::LSDE, PathClass::LSDSE]);
        let setting = PlanarSetting::of_entry(&e).unwrap().unwrap();
        let probe = Expectation::new(setting, t, k, &[b]).unwrap();
        let brightness = [0.6 / PI, 0.85 * 0.6 / PI];
        let n = if slow { 14 } else { 24 };
        let (mut rows, mut grid) = ([[0.0; 2]; 2], [[0.0; 2]; 2]);
        let mut bound = [[0.0; 2]; 2];
        let bright = probe.at([0.1, 0.3, 0.0], 1e-4);
        let mut brightest =
            brightness.map(|l| [l * bright.mean.value, l * l * bright.second_moment.value]);
        for j in 0..size {
            let row = film.row(j, 1e-3);
            for i in 0..size {
                let (mut sums, mut peaks) = ([[0.0; 2]; 2], [[0.0_f64; 2]; 2]);
                for k in 0..n * n {
                    // The R2 sequence: no row of samples runs along an edge.
                    let at = |i: u32, step: f64| {
                        let t = (f64::from(k) + 0.5) * step;
                        (f64::from(i) + t - t.floor()) / f64::from(size)
                    };
                    let seen = look(&e, at(i, 0.754877666246693), at(j, 0.569840290998053));
                    for c in 0..2 {
                        if let Some(x) = seen[c] {
                            let m = probe.at(vec3(x.x, x.y, 0.0).to_f64(), 1e-4);
                            let l = brightness[c];
                            let values = [l * m.mean.value, l * l * m.second_moment.value];
                            for o in 0..2 {
                                sums[c][o] += values[o];
                                peaks[c][o] = peaks[c][o].max(values[o]);
                                brightest[c][o] = brightest[c][o].max(values[o]);
                            }
                        }
                    }
                }
                for c in 0..2 {
                    let m = row[c][i as usize];
                    for (o, m) in [m.mean, m.second_moment].into_iter().enumerate() {
                        rows[c][o] += m.value;
                        bound[c][o] += m.error;
                        grid[c][o] += sums[c][o] / f64::from(n * n);
                        // A sample on the wrong side of an edge weighs n^(-2); an edge passes about n of them.
                        let (sum, n) = (sums[c][o] / f64::from(n * n), f64::from(n));
                        let off = (m.value - sum).abs();
                        let limit = 1.5 / n * peaks[c][o] + 2.0 / (n * n) * brightest[c][o];
                        assert!(off <= limit, "{t} ({i}, {j}) {c} {o}: {off:e} {m:?}");
                    }
                }
            }
        }
        let targets: Vec<[f64; 2]> = rows.iter().map(|r| r.map(|v| 1e-3 * v)).collect();
        let region = film.strip(0..size, &targets, 1e-3);
        for c in 0..2 {
            for (o, m) in [region[c].mean, region[c].second_moment]
                .into_iter()
                .enumerate()
            {
                let off = (m.value - rows[c][o]).abs();
                assert!(off <= m.error + bound[c][o], "{t} {c} {o}: {off:e} {m:?}");
                let off = (grid[c][o] / rows[c][o] - 1.0).abs();
                assert!(off < 0.2 / f64::from(n), "{t} {c} {o}: {off:e}");
            }
        }
    }
}

#[test]
fn a_small_bandwidth_image_is_the_closed_form() {
    // E = R I h/|y' − x|³ on the lit part: the mean over the image of a fine supersampling, against a narrow kernel.
    let e = entry(16);
    let setting = PlanarSetting::of_entry(&e).unwrap().unwrap();
    let image = setting.image();
    let n = 700;
    let mut truth = [0.0; 2];
    for k in 0..n * n {
        let at = |k: u32| (f64::from(k) + 0.5) / f64::from(n);
        for (c, x) in look(&e, at(k % n), at(k / n)).into_iter().enumerate() {
            let Some(x) = x else { continue };
            let h = setting.mirror_height(x);
            let s = x + (image - x) * (h / (h - setting.mirror_height(image)));
            let lit = h > 0.0
                && setting
                    .mirror_edges
                    .iter()
                    .all(|m| m.normal.dot(s) <= m.offset);
            if lit {
                let d = (image - x).length();
                truth[c] += setting.strength * image.z / (d * d * d) / f64::from(n * n);
            }
        }
    }
    for (t, b) in [
        (Technique::Merge, 1e-3),
        (Technique::Camera, 1e-3),
        (Technique::Light, 1e-2),
    ] {
        let film = FilmExpectation::new(&e, t, t.default_kernel(), &[b]).unwrap();
        let first = film.strip(0..16, &[[f64::INFINITY; 2]; 2], 1e-3);
        let targets: Vec<[f64; 2]> = first
            .iter()
            .map(|m| [5e-4 * m.mean.value, 1.0 * m.second_moment.value])
            .collect();
        for (c, m) in film.strip(0..16, &targets, 1e-4).iter().enumerate() {
            let expected = truth[c] * 0.6 / PI * [1.0, 0.85][c] * 256.0;
            let off = (m.mean.value / expected - 1.0).abs();
            assert!(off < 1.5e-3, "{t} {c}: {off:e} {m:?} {expected}");
            assert!(m.mean.error <= 6e-4 * m.mean.value, "{t} {c} {m:?}");
        }
    }
}

#[test]
fn a_floor_has_no_regularized_class_and_other_kinds_are_refused() {
    let mut e = entry(4);
    let Kind::PlanarMirror(PlanarMirrorScene { light, floor, .. }) = e.kind.clone() else {
        unreachable!()
    };
    e.kind = Kind::Diffuse(DiffuseScene {
        light: light.clone(),
        floor: floor.clone(),
    });
    let film = FilmExpectation::new(&e, Technique::Merge, Kernel::Disc, &[0.1]).unwrap();
    assert!(film.classes().is_empty() && film.row(0, 1e-6).is_empty());
    e.kind = Kind::FlatInterface(FlatInterfaceScene {
        light,
        floor,
        water: nephroid_analytic::scene::Water {
            surface_z: 0.5,
            index: 1.3,
        },
    });
    let refused = FilmExpectation::new(&e, Technique::Camera, Kernel::Cone, &[0.1]);
    assert_eq!(refused.unwrap_err().key, "kind");
}
