//! Films of expectations as sums over a sequence of points: all pixels at once, whatever edges, folds and kernels do.
//!
//! [`super::frame`] covers a picture with tiles and integrates over the kernel at points of each. That is exact where a few
//! pixels are asked for, and slow where all are: every point asks for its own roots and cuts. Here the paths begin at the
//! light ([`super::chart::scatter`]), and each adds to the pixel in which it is seen.
//!
//! The points are the multiples of (φ⁻¹, φ⁻², φ⁻³, φ⁻⁴), φ⁵ = φ + 1, modulo 1 [Roberts 2018, generalizing the golden ratio]:
//! rank-1, extensible, in exact integer arithmetic. Sets that are shifted against each other tell the error.

use core::ops::Range;

use super::Technique;
use super::chart::scatter::Shower;
use super::frame::FrameExpectation;
use super::kernel::Profile;

/// 2⁶⁴ φ⁻ᵏ.
const MULTIPLES: [u64; 4] = [
    0xDB4F_0B91_75AE_2165,
    0xBBE0_5633_03A4_615F,
    0xA0F2_EC75_A1FE_1575,
    0x89E1_8285_7D9E_D688,
];

/// A point of the sequence.
fn point(n: u32, shift: [u64; 4]) -> [f64; 4] {
    core::array::from_fn(|k| {
        let z = MULTIPLES[k]
            .wrapping_mul(u64::from(n))
            .wrapping_add(shift[k]);
        // 53 bits.
        (z >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    })
}

/// The shift of a set: far from those of the others (the multiples of another irrational number).
fn shift(set: u32) -> [u64; 4] {
    const ODD: [u64; 4] = [
        0x9E37_79B9_7F4A_7C15,
        0xD1B5_4A32_D192_ED03,
        0xA24B_AED4_963E_E407,
        0x9FB2_1C65_1E98_DF25,
    ];
    ODD.map(|o| o.wrapping_mul(2 * u64::from(set) + 1))
}

/// Cells along each of the first two numbers.
const CELLS: usize = 24;
/// Points of a pilot.
const PILOT: u32 = 1 << 14;
/// Part of the points that goes everywhere alike.
const ALIKE: f64 = 0.2;

/// Where the paths are that the film sees: the first two numbers of a point are moved there, and its weight falls as much. Whatever
/// the pilot missed is still met.
#[derive(Clone, Debug)]
struct Grid {
    /// Sums of probabilities of the columns up to each, and of the cells of each column.
    columns: Vec<f64>,
    cells: Vec<Vec<f64>>,
}

/// Grids of all parts of a class's light.
#[derive(Clone, Debug)]
pub struct Aim(Vec<Grid>);

/// The interval of ascending sums in which a number is, its place there, and the interval's length.
fn interval(sums: &[f64], z: f64) -> (usize, f64, f64) {
    let k = sums.partition_point(|&s| s <= z).min(sums.len() - 1);
    let start = if k == 0 { 0.0 } else { sums[k - 1] };
    let length = sums[k] - start;
    (k, ((z - start) / length).clamp(0.0, 1.0), length)
}

impl Grid {
    fn new(masses: &[f64]) -> Self {
        let total: f64 = masses.iter().sum();
        let count = masses.len() as f64;
        let share = |mass: f64| match total > 0.0 {
            true => ALIKE / count + (1.0 - ALIKE) * mass / total,
            false => 1.0 / count,
        };
        let sums = |values: Vec<f64>| -> Vec<f64> {
            let total: f64 = values.iter().sum();
            let mut sum = 0.0;
            let add = |v: f64| {
                sum += v / total;
                sum
            };
            let mut sums: Vec<f64> = values.into_iter().map(add).collect();
            if let Some(last) = sums.last_mut() {
                *last = 1.0;
            }
            sums
        };
        let columns: Vec<Vec<f64>> = masses
            .chunks(CELLS)
            .map(|column| column.iter().copied().map(share).collect())
            .collect();
        Grid {
            columns: sums(columns.iter().map(|c| c.iter().sum()).collect()),
            cells: columns.into_iter().map(sums).collect(),
        }
    }

    /// The point, and what its weight is multiplied by.
    fn aim(&self, z: [f64; 4]) -> ([f64; 4], f64) {
        let (i, a, p) = interval(&self.columns, z[0]);
        let (j, b, q) = interval(&self.cells[i], z[1]);
        let cells = CELLS as f64;
        let at = |k: usize, t: f64| (k as f64 + t) / cells;
        (
            [at(i, a), at(j, b), z[2], z[3]],
            1.0 / (p * q * cells * cells),
        )
    }
}

impl FrameExpectation {
    /// Whether [`Self::scatter`] knows the paths of a class: not where kernels are linked or several vertices are passed on the way
    /// to a connection.
    pub fn scatters(&self, class: usize) -> bool {
        self.technique() != Technique::Linked && self.light(class).chains.is_none()
    }

    /// Looks where the paths of a class come from.
    pub fn aim(&self, class: usize) -> Aim {
        let (_, _, bandwidths) = self.estimator();
        let widest = bandwidths.iter().copied().fold(0.0, f64::max);
        let mut grids = Vec::new();
        self.showers(class, widest, |part, shower| {
            let mut masses = vec![0.0; CELLS * CELLS];
            for n in 0..PILOT {
                let z = point(n, shift(SETS * (part + 1) - 1));
                let Some(drop) = shower.drop(z) else { continue };
                let cell = [0, 1].map(|k| (z[k] * CELLS as f64) as usize);
                self.eye(class).sights(drop.x, |sight| {
                    masses[cell[0] * CELLS + cell[1]] +=
                        drop.values[0] * sight.density * sight.weight;
                });
            }
            grids.push(Grid::new(&masses));
        });
        Aim(grids)
    }

    /// Adds the paths of some points of a set to an image of mean and second moment [W m⁻² sr⁻¹] of each pixel, row by row: divided by
    /// the number of points they are an approximation. All bandwidths have the same weight.
    pub fn scatter(
        &self,
        class: usize,
        aim: &Aim,
        set: u32,
        points: Range<u32>,
        image: &mut [[f64; 2]],
    ) {
        let (_, _, bandwidths) = self.estimator();
        let share = 1.0 / bandwidths.len() as f64;
        for &bandwidth in bandwidths {
            self.showers(class, bandwidth, |part, shower| {
                let shift = shift(set + part * SETS);
                for n in points.clone() {
                    let (z, weight) = aim.0[part as usize].aim(point(n, shift));
                    if let Some(drop) = shower.drop(z) {
                        let values = drop.values.map(|v| v * weight * share);
                        self.splash(class, drop.x, values, image);
                    }
                }
            });
        }
    }

    /// The parts of a class's light, at one bandwidth.
    fn showers(&self, class: usize, bandwidth: f64, mut each: impl FnMut(u32, &mut Shower)) {
        let (light, receiver) = (self.light(class), self.receiver());
        let (technique, kernel, _) = self.estimator();
        let angular = technique != Technique::Merge;
        let profile = Profile::new(kernel, angular, &[bandwidth]);
        let caustics = light
            .caustics
            .iter()
            .map(|c| Shower::of_caustic(c, receiver, technique, kernel, bandwidth, &profile));
        let bundles = light
            .bundles
            .iter()
            .map(|b| Shower::of_bundle(b, receiver, light.photons, bandwidth, &profile));
        for (part, mut shower) in (0..).zip(caustics.chain(bundles)) {
            each(part, &mut shower);
        }
    }

    /// Adds what a floor point shows.
    fn splash(&self, class: usize, x: [f64; 2], values: [f64; 2], image: &mut [[f64; 2]]) {
        let width = self.size().0 as usize;
        let bsdf = self.brightness();
        self.eye(class).sights(x, |sight| {
            let scale = sight.weight * bsdf;
            let (i, j) = (sight.film[0] as usize, sight.film[1] as usize);
            if let Some(pixel) = image.get_mut(j * width + i) {
                pixel[0] += values[0] * sight.density * scale;
                pixel[1] += values[1] * sight.density * scale * scale;
            }
        });
    }
}

/// Sets that may be used.
pub const SETS: u32 = 8;

#[cfg(test)]
mod tests {
    use super::*;

    /// φ⁵ = φ + 1.
    #[test]
    fn the_multiples_are_powers_of_one_number() {
        let x = MULTIPLES.map(|m| libm::ldexp(m as f64, -64));
        let mut power = 1.0;
        for x_k in x {
            power *= x[0];
            assert!((x_k - power).abs() < 1e-15, "{x_k}");
        }
        let phi = 1.0 / x[0];
        assert!((phi * phi * phi * phi * phi - phi - 1.0).abs() < 1e-14);
    }
}
