//! Pixels of planar scenes against routes that do not clip polygons.

use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::pixel::planar::{Eye, Light, PlanarView};
use nephroid_analytic::pixel::polygon::Side;
use nephroid_analytic::quadrature::gauss_legendre;
use nephroid_analytic::scene::{Entry, Floor, RectangleMirror};

use crate::mirror_entry::mirror_entry;

fn mirror_wall() -> Entry {
    let floor = Floor {
        center: [0.0, 0.0],
        half_width: [3.0, 3.0],
        albedo: 0.5,
    };
    let mirror = RectangleMirror {
        center: [0.0, 1.0, 0.625],
        normal: [0.0, -1.0, 0.0],
        edge: [1.0, 0.0, 0.0],
        half_width: 0.75,
        half_height: 0.5,
        reflectance: 1.0,
    };
    let camera = ([0.0, -3.0, 2.0], [0.0, 0.6, 0.3], 45.0);
    mirror_entry([0.25, 0.0, 2.0], 1.0, floor, mirror, camera, 128)
}

/// What a ray of the catalogue's `mirror-wall` sees and which light is there, traced here: radiance of LDE, LSDE, LDSE and
/// LSDSE.
fn radiance(u: f64, v: f64) -> [f64; 4] {
    let length = (3.6_f64 * 3.6 + 1.7 * 1.7).sqrt();
    let (fy, fz) = (3.6 / length, -1.7 / length);
    let half = libm::tan(22.5_f64.to_radians());
    let (a, b) = ((u / 64.0 - 1.0) * half, (1.0 - v / 64.0) * half);
    let d = [a, fy - b * fz, fz + b * fy];
    let light = [0.25, 0.0, 2.0];
    let image = [0.25, 2.0, 2.0];
    let direct = |x: [f64; 2], y: [f64; 3]| {
        let (dx, dy) = (x[0] - y[0], x[1] - y[1]);
        let r2 = dx * dx + dy * dy + y[2] * y[2];
        0.5 / std::f64::consts::PI * y[2] / (r2 * r2.sqrt())
    };
    // Where the segment from a floor point to y crosses the mirror's plane.
    let crosses = |x: [f64; 2], y: [f64; 3]| {
        let t = (1.0 - x[1]) / (y[1] - x[1]);
        let (px, pz) = (x[0] + t * (y[0] - x[0]), t * y[2]);
        t > 0.0 && t < 1.0 && px.abs() <= 0.75 && (0.125..=1.125).contains(&pz)
    };
    let caustic = |x: [f64; 2]| {
        if x[1] < 1.0 && crosses(x, image) {
            direct(x, image)
        } else {
            0.0
        }
    };
    let sun = |x: [f64; 2]| {
        if x[1] > 1.0 && crosses(x, light) {
            0.0
        } else {
            direct(x, light)
        }
    };
    let mut l = [0.0; 4];
    let t = 4.0 / d[1];
    let (mx, mz) = (t * d[0], 2.0 + t * d[2]);
    let mirror = d[1] > 0.0 && mx.abs() <= 0.75 && (0.125..=1.125).contains(&mz);
    if d[2] >= 0.0 {
        return l;
    }
    let s = 2.0 / -d[2];
    let mut x = [s * d[0], -3.0 + s * d[1]];
    if mirror {
        x[1] = 2.0 - x[1];
    }
    if x[0].abs() <= 3.0 && x[1].abs() <= 3.0 {
        let k = if mirror { 2 } else { 0 };
        l[k] = sun(x);
        l[k + 1] = caustic(x);
    }
    l
}

/// Numbers of pixels wholly inside each region, from the corners as traced above. An independent program with another
/// tracer counted 2480 lit by the mirror and 576 lit and seen in it, from points slightly inside the pixel.
#[test]
fn regions_of_mirror_wall_have_the_known_numbers_of_inner_pixels() {
    let view = PlanarView::new(&mirror_wall()).unwrap();
    let pixels = || (0..128).flat_map(|j| (0..128).map(move |i| (i, j)));
    for (class, eye, light, known) in [
        (0, Eye::Direct, Light::Direct, None),
        (1, Eye::Direct, Light::Mirror, Some(2478)),
        (2, Eye::Mirror, Light::Direct, None),
        (3, Eye::Mirror, Light::Mirror, Some(574)),
    ] {
        let region = view.region(eye, light).unwrap();
        let inside = |&(i, j): &(u32, u32)| region.side(i, j) == Side::Inside;
        let corners = |&(i, j): &(u32, u32)| {
            let (u, v) = (f64::from(i), f64::from(j));
            let all = [(u, v), (u + 1.0, v), (u, v + 1.0), (u + 1.0, v + 1.0)];
            all.iter().all(|c| radiance(c.0, c.1)[class] > 0.0)
        };
        let (count, traced) = (
            pixels().filter(inside).count(),
            pixels().filter(corners).count(),
        );
        // A pixel near a corner of a subtracted set may be clipped although it is inside; the converse is an error.
        assert!(
            count <= traced && traced - count <= 4,
            "{eye:?} {light:?} {count} {traced}"
        );
        assert!(
            known.is_none_or(|n| n == count),
            "{eye:?} {light:?} {count}"
        );
    }
}

#[test]
fn pixels_are_the_means_of_traced_radiance() {
    let truth = PixelTruth::new(&mirror_wall()).unwrap();
    let rule = gauss_legendre(5);
    let (mut inner, mut edges) = (0, 0);
    for j in (0..128).step_by(3) {
        let row = truth.row(j, 1e-9);
        for i in (0..128).step_by(2) {
            let at = |x: f64, y: f64| radiance(f64::from(i) + x, f64::from(j) + y);
            let n = 100;
            let corners = [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
            for class in 0..4 {
                let pixel = row[class][i as usize];
                let lit = corners.iter().filter(|l| l[class] > 0.0).count();
                if lit == 4 {
                    let mut sum = 0.0;
                    for (x, wx) in &rule {
                        for (y, wy) in &rule {
                            sum += 0.25 * wx * wy * at(0.5 + 0.5 * x, 0.5 + 0.5 * y)[class];
                        }
                    }
                    let whole = (pixel.value / sum - 1.0).abs() < 1e-12;
                    // The only way to be cut with all corners inside: the corner of a shadow.
                    assert!(
                        whole || pixel.value < 0.05,
                        "{class} ({i}, {j}) {pixel:?} {sum}"
                    );
                    inner += usize::from(whole);
                } else if lit > 0 {
                    let mut sum = 0.0;
                    for k in 0..n * n {
                        let (x, y) = (f64::from(k % n) + 0.5, f64::from(k / n) + 0.5);
                        sum += at(x / f64::from(n), y / f64::from(n))[class];
                    }
                    let mean = sum / f64::from(n * n);
                    let peak = corners.iter().map(|l| l[class]).fold(0.0, f64::max);
                    let close = (pixel.value - mean).abs() < 0.011 * peak;
                    assert!(close, "{class} ({i}, {j}) {pixel:?} {mean}");
                    edges += 1;
                }
            }
        }
    }
    assert!(inner > 1500 && edges > 50, "{inner} {edges}");
}
