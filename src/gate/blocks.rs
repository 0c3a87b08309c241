//! One image without a variance: is it off by more than any noise that it could have, as far as the image itself tells?
//!
//! With x the image and T the truth, g = Σ x / Σ T. What is left after the best factor, e = x - g T, is taken for noise, all
//! of it: real noise, and whatever else is wrong. Sums of e over blocks of pixels give the standard error of g, if noise is not
//! shared over more than a block; that is not known, so blocks of several sizes are tried, and the largest p-value counts.
//! Noise that the whole image shares (the normalisation of a Markov chain) is beyond what one image can tell, and therefore
//! one image is never called equivalent.

use crate::judge::distributions::student_survival;

/// Sides of the blocks, in parts of the image.
const PARTS: [usize; 3] = [16, 8, 4];
/// Fewest blocks with light.
const FEWEST: usize = 8;

/// What one image says about the factor between it and the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factor {
    /// The factor.
    pub factor: f64,
    /// Its standard error, the largest of all sizes of blocks.
    pub error: f64,
    /// p-value of "the factor is 1", the largest.
    pub p: f64,
}

/// Compares an image with what it should be; `None` if the truth has too little light to tell.
pub fn factor(image: &[f64], truth: &[f64], width: usize) -> Option<Factor> {
    let height = truth.len() / width.max(1);
    let (seen, total) = (image.iter().sum::<f64>(), truth.iter().sum::<f64>());
    if !(total > 0.0) {
        return None;
    }
    let factor = seen / total;
    let mut found: Option<Factor> = None;
    for parts in PARTS.into_iter().filter(|&p| p <= width.min(height)) {
        let mut sums = vec![[0.0; 2]; parts * parts];
        for (i, (x, t)) in image.iter().zip(truth).enumerate() {
            let block = (i / width) * parts / height * parts + (i % width) * parts / width;
            sums[block][0] += x - factor * t;
            sums[block][1] += t;
        }
        let lit = sums.iter().filter(|s| s[1] > 0.0).count();
        if lit < FEWEST {
            continue;
        }
        let n = lit as f64;
        let squares: f64 = sums.iter().map(|s| s[0] * s[0]).sum();
        let error = libm::sqrt(squares * n / (n - 1.0)) / total;
        let t = (factor - 1.0).abs() / error;
        let p = (2.0 * student_survival(t, n - 1.0)).min(1.0);
        let worst = found.get_or_insert(Factor { factor, error, p });
        worst.error = worst.error.max(error);
        worst.p = worst.p.max(p);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{philox, uniform};

    /// A hundred right images with noise that four by four pixels share: no p-value below 1e-4 (one in a hundred such
    /// tests has one); and one that is 10 % too bright is found.
    #[test]
    fn noise_that_pixels_share_is_noise() {
        let (width, truth) = (64, vec![1.0; 64 * 64]);
        let image = |run: u32, gain: f64| -> Vec<f64> {
            let pixel = |i: u32| {
                let [a, b, ..] = philox([(i / 64 / 4) * 16 + i % 64 / 4, run, 0, 0], [11, 12]);
                gain * (0.5 + uniform(a, b))
            };
            (0..64 * 64).map(pixel).collect()
        };
        for run in 0..100 {
            let found = factor(&image(run, 1.0), &truth, width).unwrap();
            assert!(found.p > 1e-4, "{run}: {found:?}");
        }
        assert!(factor(&image(7, 1.2), &truth, width).unwrap().p < 1e-3);
        assert_eq!(factor(&truth, &vec![0.0; 64 * 64], width), None);
    }
}
