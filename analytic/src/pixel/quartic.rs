//! All real roots of a trigonometric polynomial of degree two on an arc |φ| < π, as roots of a quartic in t = tan(φ/2).
//!
//! A light line of the cup passes through a point, or its end point crosses a straight line, where
//!
//! ```text
//! A sin 2φ + B cos 2φ + C sin φ + D cos φ + F = 0.
//! ```
//!
//! Multiplied by (1 + t²)² this is a quartic. Its roots are isolated by the roots of its derivative, which are isolated by
//! those of the second derivative, and so on; each is then bracketed on a monotone piece and polished by Newton's method.
//! Two roots closer than about 1e-8 may be missed together: what lies between them is as small.

/// At most this many roots are kept: more than any equation here has.
const CAPACITY: usize = 40;

/// A short list of numbers without allocation.
#[derive(Clone, Copy, Debug)]
pub struct Few {
    items: [(f64, u8); CAPACITY],
    len: usize,
}

impl Default for Few {
    fn default() -> Self {
        Few {
            items: [(0.0, 0); CAPACITY],
            len: 0,
        }
    }
}

impl Few {
    /// Appends a number with a label; one too many is dropped.
    pub fn push(&mut self, value: f64, label: u8) {
        if let Some(item) = self.items.get_mut(self.len) {
            *item = (value, label);
            self.len += 1;
        }
    }

    /// The numbers with their labels.
    pub fn as_slice(&self) -> &[(f64, u8)] {
        &self.items[..self.len]
    }

    /// Sorts by value and joins neighbours that rounding cannot tell apart; the smaller label stays.
    pub fn sort(&mut self) {
        const CLOSE: f64 = 1e-13;
        self.items[..self.len].sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut kept = 0;
        for k in 1..self.len {
            let (value, label) = self.items[k];
            if value - self.items[kept].0 <= CLOSE {
                self.items[kept].1 = self.items[kept].1.min(label);
            } else {
                kept += 1;
                self.items[kept] = (value, label);
            }
        }
        self.len = self.len.min(kept + 1);
    }
}

/// `A sin 2φ + B cos 2φ + C sin φ + D cos φ + F`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trigonometric {
    /// Coefficient of sin 2φ.
    pub sin2: f64,
    /// Coefficient of cos 2φ.
    pub cos2: f64,
    /// Coefficient of sin φ.
    pub sin1: f64,
    /// Coefficient of cos φ.
    pub cos1: f64,
    /// Constant.
    pub constant: f64,
}

impl Trigonometric {
    /// The quartic in t = tan(φ/2): this times (1 + t²)², ascending powers.
    fn quartic(&self) -> [f64; 5] {
        let Trigonometric {
            sin2: a,
            cos2: b,
            sin1: c,
            cos1: d,
            constant: f,
        } = *self;
        [
            b + d + f,
            4.0 * a + 2.0 * c,
            2.0 * f - 6.0 * b,
            2.0 * c - 4.0 * a,
            b - d + f,
        ]
    }

    /// Appends all roots t in (-limit, limit), with a label.
    pub fn roots(&self, limit: f64, label: u8, out: &mut Few) {
        let q = self.quartic();
        let (roots, count) = match sign_changes(&q, limit) {
            0 => return,
            1 => {
                let slope = [q[1], 2.0 * q[2], 3.0 * q[3], 4.0 * q[4]];
                let falling = value(&q, -limit) > 0.0;
                let root = bracketed(&q, &slope, -limit, limit, falling);
                ([root, 0.0, 0.0, 0.0, 0.0], 1)
            }
            _ => roots_between(&q, -limit, limit),
        };
        roots[..count].iter().for_each(|&t| out.push(t, label));
    }
}

fn value(p: &[f64], x: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, &c| sum * x + c)
}

/// Sign changes of the Bernstein coefficients on [-limit, limit]. Descartes' rule: none means no root inside, one means
/// one root.
fn sign_changes(q: &[f64; 5], limit: f64) -> usize {
    // Coefficients of 1, x, x², x³, x⁴ on [-1, 1] in Bernstein's basis of degree 4.
    const BERNSTEIN: [[f64; 5]; 5] = [
        [1.0, -1.0, 1.0, -1.0, 1.0],
        [1.0, -0.5, 0.0, 0.5, -1.0],
        [1.0, 0.0, -1.0 / 3.0, 0.0, 1.0],
        [1.0, 0.5, 0.0, -0.5, -1.0],
        [1.0, 1.0, 1.0, 1.0, 1.0],
    ];
    let mut scaled = *q;
    let mut power = 1.0;
    for c in &mut scaled {
        *c *= power;
        power *= limit;
    }
    let mut changes = 0;
    let mut last = 0.0;
    for row in BERNSTEIN {
        let mut b = 0.0;
        for (m, c) in row.iter().zip(&scaled) {
            b += m * c;
        }
        if b * last < 0.0 {
            changes += 1;
        }
        if b != 0.0 {
            last = b.signum();
        }
    }
    changes
}

/// All roots of a quartic in the open interval, ascending.
fn roots_between(quartic: &[f64; 5], low: f64, high: f64) -> ([f64; 5], usize) {
    // derivatives[k] is the (4 - k)-th derivative: degree k.
    let mut derivatives = [[0.0; 5]; 5];
    derivatives[4] = *quartic;
    for degree in (1..4).rev() {
        for k in 0..=degree {
            derivatives[degree][k] = (k + 1) as f64 * derivatives[degree + 1][k + 1];
        }
    }
    let (mut cuts, mut count) = ([0.0; 5], 0);
    for degree in 1..=4 {
        let p = &derivatives[degree][..=degree];
        let slope = &derivatives[degree - 1][..degree];
        let (mut found, mut n) = ([0.0; 5], 0);
        let (mut left, mut at_left) = (low, value(p, low));
        let (inner, last) = (&cuts[..count], [high]);
        for (k, &right) in inner.iter().chain(&last).enumerate() {
            let at_right = value(p, right);
            if (at_left < 0.0 && at_right > 0.0) || (at_left > 0.0 && at_right < 0.0) {
                found[n] = bracketed(p, slope, left, right, at_left > 0.0);
                n += 1;
            } else if at_right == 0.0 && k < count && n < 5 {
                found[n] = right;
                n += 1;
            }
            (left, at_left) = (right, at_right);
        }
        (cuts, count) = (found, n);
    }
    (cuts, count)
}

/// Newton's method kept inside a shrinking bracket of a monotone piece.
fn bracketed(p: &[f64], slope: &[f64], mut low: f64, mut high: f64, falling: bool) -> f64 {
    let mut x = 0.5 * (low + high);
    for _ in 0..80 {
        let f = value(p, x);
        if (f > 0.0) == falling {
            low = x;
        } else {
            high = x;
        }
        // The slope has no factor of the degree missing: derivatives are kept unscaled.
        let step = f / value(slope, x);
        let mut next = x - step;
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
        }
        if (next - x).abs() <= 1e-16 * (1.0 + x.abs()) || next == low || next == high {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::{atan, cos, sin};

    #[test]
    fn every_sign_change_on_a_dense_grid_has_its_root() {
        // Coefficients from a Weyl sequence; a root lost shows as a sign change without one.
        let weyl = |k: u32, alpha: f64| 2.0 * ((f64::from(k) * alpha) % 1.0) - 1.0;
        for k in 1..4000 {
            let p = Trigonometric {
                sin2: weyl(k, 0.618_033_988_749_895),
                cos2: weyl(k, 0.754_877_666_246_693),
                sin1: weyl(k, 0.569_840_290_998_053),
                cos1: weyl(k, 0.819_172_513_396_164),
                constant: weyl(k, 0.671_043_606_703_789),
            };
            let f = |phi: f64| {
                p.sin2 * sin(2.0 * phi)
                    + p.cos2 * cos(2.0 * phi)
                    + p.sin1 * sin(phi)
                    + p.cos1 * cos(phi)
                    + p.constant
            };
            let mut roots = Few::default();
            p.roots(0.577, 0, &mut roots);
            let limit = 2.0 * atan(0.577);
            let n = 600;
            let grid = |i: i32| limit * (2.0 * f64::from(i) / f64::from(n) - 1.0);
            let changes = (0..n)
                .filter(|&i| (f(grid(i)) > 0.0) != (f(grid(i + 1)) > 0.0))
                .count();
            assert!(roots.as_slice().len() >= changes, "{p:?}");
            for &(t, _) in roots.as_slice() {
                assert!(f(2.0 * atan(t)).abs() < 1e-14, "{p:?} {t}");
            }
        }
    }
}
