//! Glass slab and mirror chains against ray tracers of their own: vector refraction and reflection, Jacobians by finite
//! differences, counts of rays by dense search. No image, no ray parameter equation.

use nephroid_analytic::kinds::glass_slab::GlassSlab;
use nephroid_analytic::kinds::planar_chains::{Corridor, Wedge};
use nephroid_analytic::vector::{Vec3, vec3};

/// SplitMix64: enough for choosing test cases.
struct Cases(u64);

impl Cases {
    fn next(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * (z >> 11) as f64 / (1u64 << 53) as f64
    }

    fn slab(&mut self) -> GlassSlab<f64> {
        let bottom = self.next(0.0, 1.0);
        let top = bottom + self.next(0.05, 1.0);
        GlassSlab {
            bottom,
            top,
            index: if self.next(0.0, 1.0) < 0.2 {
                self.next(0.6, 0.95)
            } else {
                self.next(1.05, 4.5)
            },
            light: vec3(
                self.next(-1.0, 1.0),
                self.next(-1.0, 1.0),
                top + self.next(0.05, 1.5),
            ),
            intensity: self.next(1.0, 5.0),
            receiver_z: bottom - self.next(0.0, 1.0),
        }
    }
}

/// Refraction of a unit vector that comes down, by Snell's law for its horizontal part; with the transmittance by angles.
fn refract(d: Vec3<f64>, n1: f64, n2: f64) -> Option<(Vec3<f64>, f64)> {
    let (h, v) = (d * (n1 / n2), libm::hypot(d.x, d.y));
    let sine = v * n1 / n2;
    if sine >= 1.0 {
        return None;
    }
    let (i, t) = (libm::asin(v), libm::asin(sine));
    let f = if i < 1e-4 {
        libm::pow((n1 - n2) / (n1 + n2), 2.0)
    } else {
        let s = libm::sin(i - t) / libm::sin(i + t);
        let p = libm::tan(i - t) / libm::tan(i + t);
        0.5 * (s * s + p * p)
    };
    Some((vec3(h.x, h.y, -libm::cos(t)), 1.0 - f))
}

/// Follows a ray from the light through the slab with `order` pairs of internal reflections: landing point and weight.
fn through_slab(slab: &GlassSlab<f64>, d: Vec3<f64>, order: u32) -> Option<(Vec3<f64>, f64)> {
    let (inside, t1) = refract(d, 1.0, slab.index)?;
    let (mut p, mut v) = (slab.light, d);
    let mut go = |v: Vec3<f64>, z: f64| {
        p = p + v * ((z - p.z) / v.z);
        p
    };
    go(v, slab.top);
    v = inside;
    go(v, slab.bottom);
    let mut weight = t1;
    for _ in 0..order {
        v = vec3(v.x, v.y, -v.z);
        go(v, slab.top);
        v = vec3(v.x, v.y, -v.z);
        go(v, slab.bottom);
        weight *= (1.0 - t1) * (1.0 - t1);
    }
    let (out, t2) = refract(v, slab.index, 1.0)?;
    Some((go(out, slab.receiver_z), weight * t2))
}

#[test]
fn slab_orders_are_traced_bundles() {
    let mut cases = Cases(1);
    let mut compared = 0;
    while compared < 2000 {
        let slab = cases.slab();
        let order = cases.next(0.0, 6.0) as u32;
        let (theta, phi) = (cases.next(0.05, 1.4), cases.next(0.0, 6.2));
        let direction = |a: f64, b: f64| {
            // Offsets on a plane at unit distance below the light: dΩ = cos³ du dv.
            let t = libm::tan(theta);
            vec3(t * libm::cos(phi) + a, t * libm::sin(phi) + b, -1.0).normalized()
        };
        let land = |a: f64, b: f64| through_slab(&slab, direction(a, b), order).map(|(x, _)| x);
        // Smaller steps towards the critical angle of a slab that is rarer than the air.
        let room = (slab.index - libm::sin(theta)).clamp(0.02, 1.0);
        let h = 1e-3 * libm::cos(theta) * room;
        let slope = |a: f64, b: f64| {
            let near = land(a * h, b * h)? - land(-a * h, -b * h)?;
            let far = land(2.0 * a * h, 2.0 * b * h)? - land(-2.0 * a * h, -2.0 * b * h)?;
            Some((near * 8.0 - far) * (1.0 / (12.0 * h)))
        };
        let (Some((x, weight)), Some(p), Some(q)) = (
            through_slab(&slab, direction(0.0, 0.0), order),
            slope(1.0, 0.0),
            slope(0.0, 1.0),
        ) else {
            continue;
        };
        let cosine = libm::cos(theta);
        let density = slab.intensity * cosine * cosine * cosine;
        let expected = density * weight / (p.x * q.y - p.y * q.x).abs();
        let root = slab.root(x.x, x.y, order);
        let sine = libm::sin(theta);
        let room = 1e-14 * (1.0 + root.conditioning);
        assert!(
            (root.ray_parameter - sine).abs() <= room,
            "{slab:?} {order}"
        );
        let difference = (root.irradiance - expected).abs();
        let room = 1e-7 + 1e-13 * root.conditioning;
        assert!(
            difference <= room * expected,
            "{slab:?} {order} {root:?} {expected}"
        );
        compared += 1;
    }
}

/// The whole series against a plain sum of many orders, with the tail inside the bound; and a view against the tracer.
#[test]
fn slab_series_and_views() {
    let mut cases = Cases(2);
    for _ in 0..200 {
        let slab = cases.slab();
        let (x, y) = (cases.next(-4.0, 4.0), cases.next(-4.0, 4.0));
        let first = cases.next(0.0, 4.0) as u32;
        let series = slab.all_orders_from(x, y, first);
        let plain: f64 = (first..first + 4000)
            .rev()
            .map(|k| slab.root(x, y, k).irradiance)
            .sum();
        let room = series.error + 1e-13 * plain;
        assert!(
            (series.value - plain).abs() <= room,
            "{slab:?} {series:?} {plain}"
        );
        assert!(
            (series.value - plain).abs() <= 1e-12 * plain,
            "{slab:?} {series:?} {plain}"
        );
        // The camera's ray is a ray of light backwards: trace it from a light in its place.
        let camera = vec3(x, y, slab.top + cases.next(0.1, 2.0));
        let aim = camera + vec3(cases.next(-1.0, 1.0), cases.next(-1.0, 1.0), -0.7);
        let at_camera = GlassSlab {
            light: camera,
            ..slab
        };
        match (
            slab.look(camera, aim),
            through_slab(&at_camera, (aim - camera).normalized(), 0),
        ) {
            (None, None) => {}
            (Some(seen), Some((point, weight))) => {
                assert!((seen.receiver - point).length() <= seen.error + 1e-12);
                assert!((seen.weight - weight).abs() <= 1e-12 * (1.0 + seen.conditioning));
            }
            other => panic!("{slab:?} {camera:?} {aim:?} {other:?}"),
        }
    }
}

/// A mirror in plan: its end and the unit direction it runs along from there.
type HalfLine = ((f64, f64), (f64, f64));

/// Walks a ray from the floor point through mirrors in plan; reports, leg by
/// leg, on which side the light passes and whether it is ahead on the leg.
fn legs(
    (mut p, mut d): ((f64, f64), (f64, f64)),
    mirrors: &[HalfLine],
    light: (f64, f64),
    bounces: u32,
) -> Vec<(f64, bool)> {
    let mut out = vec![];
    let mut last = usize::MAX;
    for _ in 0..=bounces {
        let mut hit: Option<(f64, usize)> = None;
        for (k, (o, e)) in mirrors.iter().enumerate() {
            // p + t d = o + s e, s > 0.
            let det = d.0 * -e.1 + d.1 * e.0;
            let (bx, by) = (o.0 - p.0, o.1 - p.1);
            let t = (bx * -e.1 + by * e.0) / det;
            let s = (d.0 * by - d.1 * bx) / det;
            if k != last && t > 0.0 && s > 0.0 && hit.is_none_or(|(h, _)| t < h) {
                hit = Some((t, k));
            }
        }
        let to = (light.0 - p.0, light.1 - p.1);
        let along = to.0 * d.0 + to.1 * d.1;
        let ahead = along > 0.0 && hit.is_none_or(|(t, _)| along < t);
        out.push((d.0 * to.1 - d.1 * to.0, ahead));
        let Some((t, k)) = hit else { break };
        p = (p.0 + t * d.0, p.1 + t * d.1);
        let e = mirrors[k].1;
        let dot = 2.0 * (d.0 * e.0 + d.1 * e.1);
        d = (dot * e.0 - d.0, dot * e.1 - d.1);
        last = k;
    }
    out
}

/// Counts the rays from (x, y) that pass the light after 0, 1, ... `bounces` reflections: sign changes of the offset over
/// dense directions.
fn rays_to_light(
    p: (f64, f64),
    mirrors: &[HalfLine],
    light: (f64, f64),
    bounces: u32,
) -> Vec<usize> {
    let steps = 60_000;
    let turn = 2.0 * core::f64::consts::PI / f64::from(steps);
    let cast = |k: f64| {
        let a = k * turn + 1e-4;
        legs((p, (libm::cos(a), libm::sin(a))), mirrors, light, bounces)
    };
    let mut counts = vec![0; bounces as usize + 1];
    let mut last = cast(0.0);
    for k in 1..=steps {
        let next = cast(f64::from(k));
        for (j, (a, b)) in last.iter().zip(&next).enumerate() {
            // Across an edge of the wedge the path changes, and the offset jumps: only small steps are crossings.
            let small = (a.0 - b.0).abs() < 0.05;
            counts[j] += usize::from((a.0 < 0.0) != (b.0 < 0.0) && (a.1 || b.1) && small);
        }
        last = next;
    }
    counts
}

#[test]
fn wedges_show_every_image_exactly_once() {
    let mut cases = Cases(3);
    for m in 1..=7 {
        for _ in 0..3 {
            let opening = core::f64::consts::PI / f64::from(m);
            let wedge = Wedge {
                m,
                radius: cases.next(0.3, 1.5),
                angle: opening * cases.next(0.1, 0.9),
                height: cases.next(0.2, 1.5),
                intensity: 3.0,
                reflectance: 0.8,
            };
            let (r, t) = (cases.next(0.3, 1.5), opening * cases.next(0.1, 0.9));
            let (x, y) = (r * libm::cos(t), r * libm::sin(t));
            let light = (
                wedge.radius * libm::cos(wedge.angle),
                wedge.radius * libm::sin(wedge.angle),
            );
            let mirrors = [
                ((0.0, 0.0), (1.0, 0.0)),
                ((0.0, 0.0), (libm::cos(opening), libm::sin(opening))),
            ];
            let counts = rays_to_light((x, y), &mirrors, light, m + 2);
            for (k, count) in (0..).zip(&counts) {
                let expected = if k == 0 {
                    1
                } else {
                    wedge.caustic(x, y, k).roots
                };
                assert_eq!(
                    *count, expected as usize,
                    "{wedge:?} {x} {y} {k} {counts:?}"
                );
            }
            // Each image, shot at directly, must pass the light after its number of bounces.
            for k in 1..=m {
                for image in wedge.images(x, y, k).into_iter().flatten() {
                    let at = (
                        wedge.radius * libm::cos(image.place),
                        wedge.radius * libm::sin(image.place),
                    );
                    let length = libm::hypot(at.0 - x, at.1 - y);
                    let d = ((at.0 - x) / length, (at.1 - y) / length);
                    let walked = legs(((x, y), d), &mirrors, light, k);
                    let (offset, ahead) = walked[k as usize];
                    assert!(offset.abs() < 1e-12 && ahead, "{wedge:?} {k}");
                    let distance = libm::hypot(length, wedge.height);
                    let e = libm::pow(0.8, f64::from(k)) * 3.0 * wedge.height
                        / libm::pow(distance, 3.0);
                    assert!((image.irradiance - e).abs() < 1e-12 * e);
                }
            }
        }
    }
}

#[test]
fn corridors_show_two_images_of_each_number() {
    let mut cases = Cases(4);
    for _ in 0..6 {
        let width = cases.next(0.5, 2.0);
        let corridor = Corridor {
            width,
            light: vec3(width * cases.next(0.1, 0.9), cases.next(-0.5, 0.5), 0.7),
            intensity: 2.0,
            reflectance: 0.9,
        };
        let (x, y) = (width * cases.next(0.1, 0.9), cases.next(-0.5, 0.5));
        // Long enough for all directions but those along the mirrors.
        let mirrors = [((0.0, -1e6), (0.0, 1.0)), ((width, -1e6), (0.0, 1.0))];
        let light = (corridor.light.x, corridor.light.y);
        let counts = rays_to_light((x, y), &mirrors, light, 4);
        assert_eq!(counts, [1, 2, 2, 2, 2], "{corridor:?} {x} {y}");
        for k in 1..=4 {
            assert_eq!(corridor.caustic(x, y, k).roots, 2);
        }
    }
}

/// The unbounded series against a plain sum, also with perfect mirrors, where the rest is what the error bound says.
#[test]
fn corridor_series() {
    let mut cases = Cases(5);
    for reflectance in [0.0, 0.3, 0.9, 0.99, 0.9999, 1.0] {
        let corridor = Corridor {
            width: 1.3,
            light: vec3(0.4, 0.2, 0.8),
            intensity: 2.0,
            reflectance,
        };
        let (x, y) = (cases.next(0.0, 1.3), cases.next(-2.0, 2.0));
        let series = corridor.all_orders(x, y);
        let mut plain = 0.0;
        let last = 3_000_000;
        for k in (1..=last).rev() {
            let k_f = f64::from(k);
            for at in if k % 2 == 0 {
                [k_f * 1.3 + 0.4, 0.4 - k_f * 1.3]
            } else {
                [(k_f + 1.0) * 1.3 - 0.4, -(k_f - 1.0) * 1.3 - 0.4]
            } {
                let d2 = (at - x) * (at - x) + (y - 0.2) * (y - 0.2) + 0.64;
                plain += libm::pow(reflectance, k_f) * 1.6 / (d2 * d2.sqrt());
            }
        }
        let room = series.error + 1e-12 * plain;
        assert!(
            (series.value - plain).abs() <= room,
            "{reflectance} {series:?} {plain}"
        );
        assert!(
            series.error <= 2e-11 * series.value,
            "{reflectance} {series:?}"
        );
    }
}

/// f32 formulas stay within their own error bound of the f64 ones.
#[test]
fn f32_stays_within_its_bound() {
    let mut cases = Cases(6);
    for _ in 0..2000 {
        let s = cases.slab();
        let light = vec3(s.light.x as f32, s.light.y as f32, s.light.z as f32);
        let low = GlassSlab {
            bottom: s.bottom as f32,
            top: s.top as f32,
            index: s.index as f32,
            light,
            intensity: s.intensity as f32,
            receiver_z: s.receiver_z as f32,
        };
        let wide = |v: f32| f64::from(v);
        let high = GlassSlab {
            bottom: wide(low.bottom),
            top: wide(low.top),
            index: wide(low.index),
            light: vec3(wide(light.x), wide(light.y), wide(light.z)),
            intensity: wide(low.intensity),
            receiver_z: wide(low.receiver_z),
        };
        let (x, y) = (cases.next(-4.0, 4.0) as f32, cases.next(-4.0, 4.0) as f32);
        for k in 0..4 {
            let (a, b) = (low.caustic(x, y, k), high.caustic(wide(x), wide(y), k));
            let difference = (wide(a.value) - b.value).abs();
            assert!(difference <= wide(a.error), "{low:?} {k} {a:?} {b:?}");
        }
        let m = 1 + cases.next(0.0, 9.0) as u32;
        let opening = core::f64::consts::PI / f64::from(m);
        let low = Wedge {
            m,
            radius: cases.next(0.1, 2.0) as f32,
            angle: (opening * cases.next(0.05, 0.95)) as f32,
            height: cases.next(0.1, 2.0) as f32,
            intensity: 3.0,
            reflectance: cases.next(0.1, 1.0) as f32,
        };
        let high = Wedge {
            m,
            radius: wide(low.radius),
            angle: wide(low.angle),
            height: wide(low.height),
            intensity: 3.0,
            reflectance: wide(low.reflectance),
        };
        for k in 1..=m {
            let (a, b) = (low.caustic(x, y, k), high.caustic(wide(x), wide(y), k));
            let difference = (wide(a.value) - b.value).abs();
            assert!(difference <= wide(a.error), "{low:?} {k} {a:?} {b:?}");
        }
    }
}
