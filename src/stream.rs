//! Counter-based random numbers: Philox 4x32-10, addressed by (seed, iteration, path, dimension block).
//!
//! [Salmon, Moraes, Dror & Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3"]. The 128-bit counter is
//! (path mod 2³², path / 2³², iteration, dimension block), the key is the 64-bit seed. One evaluation gives two uniforms
//! of 53 bits. There is no state, so any path can be drawn on any thread in any order.

use core::array;

/// Paths are drawn in blocks of this many, one loop per stage.
pub const BLOCK: usize = 256;

/// One number for each path of a block.
pub type Lanes = [f64; BLOCK];

/// Which pair of random numbers of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Film position of a camera path.
    Film = 0,
    /// Emission from the light.
    Emission = 1,
    /// Direction at the diffuse vertex of a camera path.
    Direction = 2,
    /// Direction at the second diffuse vertex of a path.
    SecondDirection = 3,
    /// Direction at the third.
    ThirdDirection = 4,
    /// Direction at the first diffuse vertex of a light subpath, where a path has two subpaths.
    LightDirection = 5,
    /// Direction at its second.
    SecondLightDirection = 6,
    /// Direction at its third.
    ThirdLightDirection = 7,
}

/// The dimension block of the first of a path's trials; those before it are for [`Dimension`].
const FIRST_TRIAL: u64 = 1 << 16;
/// Trials that one key has counters for.
const TRIALS: u64 = (1 << 32) - FIRST_TRIAL;

const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
const ROUNDS: usize = 10;

/// Philox 4x32-10.
#[inline(always)]
pub fn philox(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    let [mut c0, mut c1, mut c2, mut c3] = counter;
    let [mut k0, mut k1] = key;
    for _ in 0..ROUNDS {
        let p0 = u64::from(c0) * u64::from(MULTIPLIERS[0]);
        let p1 = u64::from(c2) * u64::from(MULTIPLIERS[1]);
        (c0, c1, c2, c3) = (
            (p1 >> 32) as u32 ^ c1 ^ k0,
            p1 as u32,
            (p0 >> 32) as u32 ^ c3 ^ k1,
            p0 as u32,
        );
        k0 = k0.wrapping_add(WEYL[0]);
        k1 = k1.wrapping_add(WEYL[1]);
    }
    [c0, c1, c2, c3]
}

/// A uniform number in [0, 1), a multiple of 2⁻⁵³, from 64 random bits: exact, and without an integer conversion, which
/// vector units lack.
#[inline(always)]
pub fn uniform(high: u32, low: u32) -> f64 {
    const TWO_52: u64 = 0x4330_0000_0000_0000;
    let whole = |bits: u32| f64::from_bits(TWO_52 | u64::from(bits)) - 4_503_599_627_370_496.0;
    whole(high) * (1.0 / 4_294_967_296.0) + whole(low >> 11) * (1.0 / 9_007_199_254_740_992.0)
}

/// The streams of one iteration.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    key: [u32; 2],
    iteration: u32,
}

impl Stream {
    /// The streams addressed by a seed and an iteration.
    pub fn new(seed: u64, iteration: u32) -> Self {
        Stream {
            key: [seed as u32, (seed >> 32) as u32],
            iteration,
        }
    }

    /// Two uniforms in [0, 1) of 53 bits for one of a path's trials, of which there is no end: 2³² beyond the first 2³² take
    /// another key, and so on.
    pub fn trial(&self, path: u64, trial: u64) -> (f64, f64) {
        let dimension = (FIRST_TRIAL + trial % TRIALS) as u32;
        let counter = [path as u32, (path >> 32) as u32, self.iteration, dimension];
        let key = [self.key[0], self.key[1] ^ ((trial / TRIALS) as u32)];
        let [a, b, c, d] = philox(counter, key);
        (uniform(a, b), uniform(c, d))
    }

    /// Two uniforms in [0, 1) of 53 bits for each of the paths `first ..`. `first` is a multiple of [`BLOCK`].
    #[inline(always)]
    pub fn pairs(&self, first: u64, dimension: Dimension, u: &mut Lanes, v: &mut Lanes) {
        let (low, high) = (first as u32, (first >> 32) as u32);
        for (i, (u, v)) in u.iter_mut().zip(v.iter_mut()).enumerate() {
            // No carry into the high word: the first path of a block is a multiple of the block's size.
            let counter = [low | i as u32, high, self.iteration, dimension as u32];
            let [a, b, c, d] = philox(counter, self.key);
            *u = uniform(a, b);
            *v = uniform(c, d);
        }
    }
}

/// Zero in every lane.
pub fn zeros() -> Lanes {
    array::from_fn(|_| 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published known answers, `kat_vectors` of the Random123 distribution.
    #[test]
    fn philox_gives_the_published_answers() {
        assert_eq!(
            philox([0; 4], [0; 2]),
            [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]
        );
        assert_eq!(
            philox([u32::MAX; 4], [u32::MAX; 2]),
            [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]
        );
        assert_eq!(
            philox(
                [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344],
                [0xa409_3822, 0x299f_31d0]
            ),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn uniforms_are_in_the_half_open_interval_and_exact() {
        assert_eq!(uniform(0, 0), 0.0);
        assert_eq!(uniform(u32::MAX, u32::MAX), 1.0 - f64::EPSILON / 2.0);
        assert_eq!(uniform(0, 1 << 11), f64::EPSILON / 2.0);
        assert_eq!(uniform(1 << 31, 0), 0.5);
        assert_eq!(uniform(0, (1 << 11) - 1), 0.0);
    }

    #[test]
    fn a_block_is_the_paths_one_by_one() {
        let stream = Stream::new(0x0123_4567_89ab_cdef, 77);
        let first = (5_u64 << 32) + 512;
        let (mut u, mut v) = (zeros(), zeros());
        stream.pairs(first, Dimension::Direction, &mut u, &mut v);
        for i in [0_usize, 1, 100, 255] {
            let [a, b, c, d] = philox([512 + i as u32, 5, 77, 2], [0x89ab_cdef, 0x0123_4567]);
            assert_eq!((u[i], v[i]), (uniform(a, b), uniform(c, d)));
        }
    }

    /// Means, variances and correlations of a million pairs, neighbours in every address word: 12 figures, each within
    /// 6 standard errors (false alarm 12 × 2e-9).
    #[test]
    fn neighbouring_streams_are_uniform_and_uncorrelated() {
        let n = 4096 * BLOCK;
        let (mut u, mut v) = (zeros(), zeros());
        let (mut p, mut q) = (zeros(), zeros());
        type Other = (u64, u32, u64, Dimension);
        let others: [Other; 4] = [
            (1, 0, 0, Dimension::Film),
            (0, 1, 0, Dimension::Film),
            (0, 0, 1 << 32, Dimension::Film),
            (0, 0, 0, Dimension::Emission),
        ];
        for (seed, iteration, offset, dimension) in others {
            let (mut mean, mut square, mut product) = (0.0, 0.0, 0.0);
            for block in 0..4096_u64 {
                let first = block * BLOCK as u64;
                Stream::new(0, 0).pairs(first, Dimension::Film, &mut u, &mut v);
                Stream::new(seed, iteration).pairs(first + offset, dimension, &mut p, &mut q);
                for i in 0..BLOCK {
                    mean += p[i] - 0.5;
                    square += (p[i] - 0.5) * (p[i] - 0.5) - 1.0 / 12.0;
                    product += (u[i] - 0.5) * (p[i] - 0.5) + (v[i] - 0.5) * (q[i] - 0.5);
                }
            }
            let z = |sum: f64, variance: f64| (sum / f64::sqrt(variance * n as f64)).abs();
            assert!(z(mean, 1.0 / 12.0) < 6.0);
            assert!(z(square, 1.0 / 180.0) < 6.0);
            assert!(z(product, 2.0 / 144.0) < 6.0);
        }
    }
}
