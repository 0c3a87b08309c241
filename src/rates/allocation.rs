//! How paths are shared among bandwidths so that the exponent is known best.
//!
//! With relative noise δᵢ of the bias at one path, the slope of ln|bias| from bandwidths i and j with nᵢ ∝ δᵢ, nⱼ ∝ δⱼ paths has the
//! standard error (δᵢ + δⱼ)/(|ln bᵢ/bⱼ| √N), which no other design for a slope undercuts (c-optimality [Elfving 1952]). The best
//! pair gets most of the paths; the rest shows the others.

use libm::{fabs, log};

/// The part that all bandwidths share equally.
const SHARED: f64 = 0.25;

/// The part of the paths of each bandwidth. `noise` is the standard deviation of one path over |bias|.
pub fn shares(bandwidths: &[f64], noise: &[f64]) -> Vec<f64> {
    let count = bandwidths.len();
    let equal = 1.0 / count.max(1) as f64;
    let mut best: Option<(f64, usize, usize)> = None;
    for i in 0..count {
        for j in 0..i {
            let error = (noise[i] + noise[j]) / fabs(log(bandwidths[i] / bandwidths[j]));
            if error.is_finite() && best.is_none_or(|(e, ..)| error < e) {
                best = Some((error, i, j));
            }
        }
    }
    let Some((_, i, j)) = best else {
        return vec![equal; count];
    };
    let mut shares = vec![SHARED * equal; count];
    for k in [i, j] {
        shares[k] += (1.0 - SHARED) * noise[k] / (noise[i] + noise[j]);
    }
    shares
}
