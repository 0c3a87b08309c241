//! Forward tracing with plain vectors: what the second routes share, and the closed forms do not.

use libm::sqrt;

/// A point or direction.
pub type V = [f64; 3];

/// a + k b.
pub fn add(a: V, b: V, k: f64) -> V {
    [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]]
}

/// Scalar product.
pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The direction of a vector.
pub fn unit(a: V) -> V {
    let l = sqrt(dot(a, a));
    a.map(|c| c / l)
}

/// Uniform numbers from SplitMix64 (Steele, Lea & Flood 2014): enough to choose test cases.
pub struct Cases(pub u64);

impl Cases {
    /// A number in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let u = ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * u
    }
}

/// Where a ray meets the floor z = 0.
pub fn land((p, d): (V, V)) -> [f64; 2] {
    let q = add(p, d, -p[2] / d[2]);
    [q[0], q[1]]
}

/// |det| of a map of two parameters by central differences.
pub fn jacobian(
    map: impl Fn(f64, f64) -> Option<[f64; 2]>,
    u: f64,
    v: f64,
    h: [f64; 2],
) -> Option<f64> {
    let (a, b) = (map(u + h[0], v)?, map(u - h[0], v)?);
    let (c, d) = (map(u, v + h[1])?, map(u, v - h[1])?);
    let du = [(a[0] - b[0]) / (2.0 * h[0]), (a[1] - b[1]) / (2.0 * h[0])];
    let dv = [(c[0] - d[0]) / (2.0 * h[1]), (c[1] - d[1]) / (2.0 * h[1])];
    Some((du[0] * dv[1] - du[1] * dv[0]).abs())
}
