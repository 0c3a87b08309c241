//! A minimal path tracer with path space regularization [Kaplanyan & Dachsbacher 2013]: the only change to an ordinary one
//! is the evaluation of the specular BRDF, in the lines marked `+`. tests/side_by_side/minimal.rs holds it to the oracle.
//! `cargo run --release --example minimal_regularized_pt > wall.pgm` makes a picture.

#![allow(missing_docs, clippy::disallowed_methods)]

use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

#[derive(Clone, Copy, Debug)]
pub struct V(pub f64, pub f64, pub f64);

impl Add for V {
    type Output = V;
    fn add(self, o: V) -> V {
        V(self.0 + o.0, self.1 + o.1, self.2 + o.2)
    }
}

impl Sub for V {
    type Output = V;
    fn sub(self, o: V) -> V {
        self + o * -1.0
    }
}

impl Mul<f64> for V {
    type Output = V;
    fn mul(self, k: f64) -> V {
        V(self.0 * k, self.1 * k, self.2 * k)
    }
}

impl V {
    fn dot(self, o: V) -> f64 {
        self.0 * o.0 + self.1 * o.1 + self.2 * o.2
    }
    fn unit(self) -> V {
        self * (1.0 / self.dot(self).sqrt())
    }
}

/// The scene: a point light, a diffuse floor z = 0, and a mirror on the wall y = 1 whose front looks towards -y.
pub const LIGHT: V = V(0.25, 0.0, 2.0);
pub const INTENSITY: f64 = 1.0;
pub const ALBEDO: f64 = 0.5;
pub const REFLECTANCE: f64 = 1.0;

#[derive(Clone, Copy, PartialEq)]
#[rustfmt::skip]
enum Material { Diffuse, Specular }

/// The first surface on a ray: distance, material, normal.
fn intersect(o: V, d: V) -> Option<(f64, Material, V)> {
    let far = |t: f64| if t > 1e-9 { t } else { f64::INFINITY };
    let (floor, wall) = (far(-o.2 / d.2), far((1.0 - o.1) / d.1));
    let (f, w) = (o + d * floor, o + d * wall);
    let floor = if f.0.abs() <= 3.0 && f.1.abs() <= 3.0 {
        floor
    } else {
        f64::INFINITY
    };
    let on_mirror = w.0.abs() <= 0.75 && (w.2 - 0.625).abs() <= 0.5;
    let wall = if on_mirror { wall } else { f64::INFINITY };
    let floor_first = (floor, Material::Diffuse, V(0.0, 0.0, 1.0));
    let first = if wall < floor {
        (wall, Material::Specular, V(0.0, -1.0, 0.0))
    } else {
        floor_first
    };
    (first.0 < f64::INFINITY && first.2.dot(d) < 0.0).then_some(first)
}

/// xorshift64*: uniform in [0, 1).
pub struct Random(pub u64);
impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The value of the specular BRDF times the cosine, in a direction `l`: a delta about `mirrored`, which no connection meets.
fn specular(mirrored: V, l: V, alpha: f64) -> f64 {
    // + The delta becomes a cone, normalised on the sphere: the cosine cancels as the delta's does.
    if mirrored.dot(l) < alpha.cos() {
        return 0.0;
    }
    REFLECTANCE / (2.0 * PI * (1.0 - alpha.cos()))
    // + Without regularization this function is `0.0`.
}

/// Radiance along a ray, with next event estimation at every vertex.
pub fn radiance(mut o: V, mut d: V, alpha: f64, random: &mut Random) -> f64 {
    let (mut sum, mut weight, mut diffuse) = (0.0, 1.0, 0);
    while let Some((t, material, normal)) = intersect(o, d) {
        o = o + d * t;
        let mirrored = d - normal * (2.0 * d.dot(normal));
        let (l, distance) = ((LIGHT - o).unit(), (LIGHT - o).dot(LIGHT - o).sqrt());
        let brdf_cosine = match material {
            Material::Diffuse => ALBEDO / PI * normal.dot(l).max(0.0),
            // + Only where the path is irregular, behind a diffuse vertex: not the light's own image in the mirror.
            Material::Specular if diffuse > 0 => specular(mirrored, l, alpha),
            Material::Specular => 0.0,
        };
        let hidden = intersect(o, l).is_some_and(|(t, ..)| t < distance);
        if brdf_cosine > 0.0 && normal.dot(l) > 0.0 && !hidden {
            sum += weight * brdf_cosine * INTENSITY / (distance * distance);
        }
        // Sampling is as ever: exact reflection, or the cosine law.
        d = match material {
            Material::Specular => mirrored,
            Material::Diffuse => {
                let (turn, square) = (2.0 * PI * random.next(), random.next());
                let r = square.sqrt();
                V(r * turn.cos(), r * turn.sin(), (1.0 - square).sqrt())
            }
        };
        weight *= if material == Material::Diffuse {
            ALBEDO
        } else {
            REFLECTANCE
        };
        diffuse += usize::from(material == Material::Diffuse);
    }
    sum
}

#[allow(dead_code)]
fn main() {
    const SIZE: i32 = 96;
    let mut random = Random(1);
    println!("P2 {SIZE} {SIZE} 255");
    for row in 0..SIZE {
        for column in 0..SIZE {
            let mut mean = 0.0;
            for n in 1..=64 {
                // The bandwidth shrinks with the samples: 0.3 n^(-1/6) is consistent.
                let alpha = 0.3 * f64::from(n).powf(-1.0 / 6.0);
                let place = |pixel: i32, u: f64| (f64::from(pixel) + u) / f64::from(SIZE) - 0.5;
                let (u, v) = (place(column, random.next()), place(row, random.next()));
                let d = V(0.83 * u, 0.9 - 0.35 * v, -0.43 - 0.75 * v).unit();
                mean += radiance(V(0.0, -3.0, 2.0), d, alpha, &mut random) / 64.0;
            }
            println!("{}", (255.0 * (12.0 * mean).min(1.0).powf(0.45)) as u8);
        }
    }
}
