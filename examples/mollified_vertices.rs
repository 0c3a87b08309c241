//! What it costs to mollify another vertex of LSDSE: variance of a path at equal α on `mirror-wall`, and its exponent.
//!
//! A path L s₁ x s₂ E has one specular vertex next to the light, which is also the one next to the diffuse vertex on the light's
//! side, and one next to the eye. Compared, with the symmetric value R φ/√(cc') at a mollified vertex:
//!
//! - s₁, from the camera's side, from the light's, and both by the balance heuristic (what `bdpt-reg` does);
//! - s₂: a photon that lands in x is connected to the camera subpath that met the mirror;
//! - both: light and camera subpath meet the mirror, x is drawn uniformly on the floor, and connected to either (d = 4).
//!
//! The figure is the mean radiance of the class over the image, of which one path gives one sample. All tend to the same limit;
//! their expectations at an α differ, which is why the variance is divided by the limit's square.
//!
//! `cargo run --release --example mollified_vertices`

use core::f64::consts::PI;

use glam::DVec3;
use nephroid::entry;
use nephroid::film::Film;
use nephroid::geometry::scene::{Overrides, unit};
use nephroid::geometry::tracer::{
    Aim, Landings, Rays, Tracer, Vertices, film_rays, tracer, uniforms,
};
use nephroid::integrators::kernel::AngleKernel;
use nephroid::integrators::{Kernel, Settings, Side, by_name};
use nephroid::stream::{BLOCK, Dimension, Lanes, Stream, zeros};
use nephroid::truth;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

const ALPHAS: [f64; 5] = [0.4, 0.28, 0.2, 0.14, 0.1];
const BLOCKS: u32 = 20_000;

/// Mean and variance of a path's sample.
type Moments = [f64; 2];

/// `bdpt-reg`, with one side or both: blocks are sums of independent paths.
fn next_to_light(entry: &Entry, side: Option<Side>, alpha: f64) -> Moments {
    let settings = Settings {
        side,
        ..Settings::default()
    };
    let integrator = by_name("bdpt-reg", &settings).expect("a method");
    let prepared = integrator.prepare(entry);
    let camera = &entry.camera;
    let mut film = Film::new(camera.width, camera.height, entry.kind.classes());
    let layer = film.layer_of(PathClass::LSDSE).expect("a class");
    let (mut sum, mut square) = (0.0, 0.0);
    for iteration in 0..BLOCKS {
        film.clear();
        prepared.iterate(1, iteration, BLOCK as u64, alpha, &mut film);
        let mean = film.class_means()[layer];
        sum += mean;
        square += mean * mean;
    }
    let n = f64::from(BLOCKS);
    let mean = sum / n;
    [mean, (square / n - mean * mean) * BLOCK as f64]
}

/// The mollified connection of a mirror vertex, which a subpath met, to a floor point: the kernel times √(c/c') of the cosines
/// towards the point and where the subpath came from, the cosine at the point, and the inverse square.
fn connection(vertices: &Vertices, i: usize, point: DVec3, kernel: &AngleKernel) -> f64 {
    let way = point - vertices.point.get(i);
    let direction = unit(way);
    let chord = vertices.exact.get(i) - direction;
    let square = chord.dot(chord);
    let cosine = vertices.normal.get(i).dot(direction);
    if !(vertices.weight[i] > 0.0 && cosine > 0.0 && square < kernel.support) {
        return 0.0;
    }
    let form = (cosine / vertices.arrival[i]).sqrt();
    vertices.weight[i] * kernel.density(square) * form * -direction.z / way.dot(way)
}

/// The vertex next to the eye alone, or both.
fn next_to_eye(tracer: &dyn Tracer, both: bool, half: [f64; 2], alpha: f64) -> Moments {
    let outline = tracer.outline();
    let camera = &outline.camera;
    let kernel = AngleKernel::new(Kernel::Cone, alpha, None);
    let emission = tracer.emission(Aim::Chain(1));
    let (columns, rows) = camera.size();
    let area = 4.0 * half[0] * half[1];
    let mut lanes: [Lanes; 4] = core::array::from_fn(|_| zeros());
    let [u, v, a, b] = &mut lanes;
    let (mut photons, mut rays) = (Rays::default(), Rays::default());
    let (mut lit, mut seen) = (Vertices::new(), Vertices::new());
    let mut landings = Landings::new();
    let (mut sum, mut square) = (0.0, 0.0);
    for iteration in 0..BLOCKS {
        let stream = Stream::new(2, iteration);
        uniforms(&stream, 0, Dimension::Film, u, v);
        u.iter_mut().for_each(|u| *u *= columns);
        v.iter_mut().for_each(|v| *v *= rows);
        film_rays(camera, u, v, &mut rays);
        tracer.meet(1, &rays, &mut seen);
        uniforms(&stream, 0, Dimension::Emission, u, v);
        emission.rays(u, v, &mut photons);
        tracer.meet(1, &photons, &mut lit);
        tracer.land(0, &photons, &mut landings);
        uniforms(&stream, 0, Dimension::Direction, a, b);
        for i in 0..BLOCK {
            let (point, flux) = if both {
                let at = |u: f64, half: f64| half * (2.0 * u - 1.0);
                let point = DVec3::new(at(a[i], half[0]), at(b[i], half[1]), 0.0);
                (point, connection(&lit, i, point, &kernel) * area)
            } else if landings.chain[i] > 0.5 {
                (
                    DVec3::new(landings.x[i], landings.y[i], 0.0),
                    landings.weight[i],
                )
            } else {
                continue;
            };
            if flux > 0.0 {
                let leaving = emission.flux() * flux * outline.floor.bsdf;
                // The mean over the image of P times a radiance in one of P pixels.
                let sample = leaving * connection(&seen, i, point, &kernel);
                sum += sample;
                square += sample * sample;
            }
        }
    }
    let n = f64::from(BLOCKS) * BLOCK as f64;
    let mean = sum / n;
    [mean, square / n - mean * mean]
}

/// Slope of log variance against log α.
fn exponent(variances: &[f64]) -> f64 {
    let n = ALPHAS.len() as f64;
    let x: Vec<f64> = ALPHAS.iter().map(|&a| libm::log(a)).collect();
    let y: Vec<f64> = variances.iter().map(|&v| libm::log(v)).collect();
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let covariance: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    covariance / x.iter().map(|x| (x - mx) * (x - mx)).sum::<f64>()
}

fn main() {
    let mut entry = entry::load("mirror-wall").expect("a catalogue entry");
    (entry.camera.width, entry.camera.height) = (16, 16);
    let tracer = tracer(&entry, Overrides::default()).expect("a floor");
    let floor = entry.kind.floor().expect("a floor");
    assert!(floor.center == [0.0, 0.0] && PI * tracer.outline().floor.bsdf == floor.albedo);
    let half = floor.half_width;
    let at = entry
        .kind
        .classes()
        .iter()
        .position(|&c| c == PathClass::LSDSE);
    let limit = truth::image(&entry, 1e-5).class_means()[at.expect("a class")].value;
    println!(
        "mirror-wall LSDSE, {} paths each: mean / limit, variance of a path / limit²",
        256 * BLOCKS
    );
    println!(
        "| mollified | {} | exponent |",
        ALPHAS.map(|a| format!("α = {a}")).join(" | ")
    );
    println!("| --- | {} ---: |", "---: | ".repeat(ALPHAS.len()));
    type Way<'a> = (&'a str, &'a dyn Fn(f64) -> Moments);
    let ways: [Way; 5] = [
        ("next to the light, both sides", &|a| {
            next_to_light(&entry, None, a)
        }),
        ("next to the light, camera's side", &|a| {
            next_to_light(&entry, Some(Side::Camera), a)
        }),
        ("next to the light, light's side", &|a| {
            next_to_light(&entry, Some(Side::Light), a)
        }),
        ("next to the eye", &|a| {
            next_to_eye(&*tracer, false, half, a)
        }),
        ("both", &|a| next_to_eye(&*tracer, true, half, a)),
    ];
    for (name, of) in ways {
        let moments: Vec<Moments> = ALPHAS.iter().map(|&a| of(a)).collect();
        let cells: Vec<_> = moments
            .iter()
            .map(|[mean, variance]| {
                format!("{:.3}, {:.0}", mean / limit, variance / (limit * limit))
            })
            .collect();
        let variances: Vec<f64> = moments.iter().map(|m| m[1]).collect();
        println!(
            "| {name} | {} | {:.2} |",
            cells.join(" | "),
            exponent(&variances)
        );
    }
}
