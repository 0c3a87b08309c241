//! All rays that reach a floor point: isolation in two dimensions.
//!
//! Roots lie within the reach of the point; that square is quartered until of each box, half side r, one of these is proven
//! with F = x(u) - x and J at its centre c, and a bound M of the second derivatives of F:
//!
//! * there is none: a row w of the identity or of adj J has |w·F| > |w J|₁ r + |w| M r², since |u - c|² ≤ 2 r²;
//! * J changes so little on the disc of twice the radius R = √2 r, q = |J⁻¹| 2 R M ≤ 1/4, that u - J⁻¹ F contracts there:
//!   there is none in the box if |J⁻¹ F| > (1 + q) R, and else exactly one in the disc, because |J⁻¹ F|/(1 - q) < 2 R.
//!
//! The disc may reach into other boxes, of which the same root is then found again: a root found earlier that is within the
//! same disc is the same root. Boxes that rounding keeps from either proof are touched by a fold.

use super::Ripples;
use crate::scalar::Scalar;

/// A ray that reaches a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// Where the ray enters the water [m].
    pub u: [S; 2],
    /// det dx/du: negative between folds.
    pub determinant: S,
    /// Fresnel transmittance T.
    pub transmittance: S,
    /// Irradiance of the floor [W/m²].
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the inputs.
    pub conditioning: S,
    /// Rounding cannot tell this root from none.
    pub touching: bool,
}

/// A square of entry points.
#[derive(Clone, Copy)]
struct Square<S> {
    center: [S; 2],
    half: S,
}

/// What is proven of a square.
enum Verdict<S> {
    Empty,
    /// Within the radius around the centre there is exactly one root, near this point.
    One {
        near: [S; 2],
        radius: S,
    },
    Open,
}

fn length<S: Scalar>(v: [S; 2]) -> S {
    v[0].hypot(v[1])
}

fn minus<S: Scalar>(a: [S; 2], b: [S; 2]) -> [S; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

impl<S: Scalar> Ripples<S> {
    /// Every ray that reaches the floor at x.
    pub fn roots(&self, x: [S; 2]) -> Vec<Root<S>> {
        let sixteen = S::from_f64(16.0) * S::EPSILON;
        // Rounding of the bound itself must not cut off a root.
        let reach = self.reach() * (S::ONE + sixteen) + sixteen * (x[0].abs() + x[1].abs());
        let narrowest = S::EPSILON.sqrt() * reach;
        let mut open = vec![Square {
            center: x,
            half: reach,
        }];
        let mut found: Vec<Root<S>> = Vec::new();
        while let Some(square) = open.pop() {
            match self.verdict(x, &square) {
                Verdict::Empty => {}
                Verdict::One { near, radius } => {
                    let known = found
                        .iter()
                        .any(|r| !r.touching && length(minus(r.u, square.center)) <= radius);
                    if !known {
                        found.push(self.root(x, self.polished(x, near), false));
                    }
                }
                Verdict::Open if square.half > narrowest => {
                    let half = S::HALF * square.half;
                    for (i, j) in [
                        (-S::ONE, -S::ONE),
                        (S::ONE, -S::ONE),
                        (-S::ONE, S::ONE),
                        (S::ONE, S::ONE),
                    ] {
                        let [cx, cy] = square.center;
                        open.push(Square {
                            center: [cx + i * half, cy + j * half],
                            half,
                        });
                    }
                }
                Verdict::Open => {
                    // Neighbours that touch the same fold point count once.
                    let many = S::from_f64(1024.0) * narrowest;
                    let known = found
                        .iter()
                        .any(|r| r.touching && length(minus(r.u, square.center)) <= many);
                    if !known {
                        found.push(self.root(x, square.center, true));
                    }
                }
            }
        }
        found
    }

    fn verdict(&self, x: [S; 2], square: &Square<S>) -> Verdict<S> {
        let (c, r) = (square.center, square.half);
        let at = self.surface(c, |s| s);
        let ray = super::refracted(self.index, self.depth, c, &at);
        let f = minus(ray.floor, x);
        let noise = self.noise(x, c);
        let [[j11, j12], [j21, j22]] = ray.jacobian;
        let determinant = ray.determinant();
        let corner = S::TWO.sqrt() * r;
        let near = self.curvature(&at, corner);
        let bulge = near * r.squared();
        let adjugate = [[j22, -j12], [-j21, j11]];
        let excluded = |w: [S; 2], by: S| {
            let value = (w[0] * f[0] + w[1] * f[1]).abs();
            value > by * r + length(w) * (bulge + noise)
        };
        let none = excluded([S::ONE, S::ZERO], j11.abs() + j12.abs())
            || excluded([S::ZERO, S::ONE], j21.abs() + j22.abs())
            || excluded(adjugate[0], determinant.abs())
            || excluded(adjugate[1], determinant.abs());
        if none {
            return Verdict::Empty;
        }
        // |adj J| is the Euclidean norm of its entries at most.
        let norm = length([length(ray.jacobian[0]), length(ray.jacobian[1])]);
        let inverse = norm / determinant.abs();
        let radius = S::TWO * corner;
        let q = inverse * radius * self.curvature(&at, radius);
        if !(q <= S::from_f64(0.25)) {
            return Verdict::Open;
        }
        let step = adjugate.map(|w| (w[0] * f[0] + w[1] * f[1]) / determinant);
        if length(step) > (S::ONE + q) * corner + inverse * noise {
            return Verdict::Empty;
        }
        // Rounding as large as the square proves nothing.
        if !(inverse * noise <= S::from_f64(0.125) * corner) {
            return Verdict::Open;
        }
        Verdict::One {
            near: minus(c, step),
            radius,
        }
    }

    /// Newton's method from a point of the disc on which it contracts.
    fn polished(&self, x: [S; 2], near: [S; 2]) -> [S; 2] {
        let mut u = near;
        let mut last = S::ONE / S::ZERO;
        for _ in 0..64 {
            let ray = self.ray(u);
            let f = minus(ray.floor, x);
            let [[a, b], [c, d]] = ray.jacobian;
            let determinant = ray.determinant();
            let step = [
                (d * f[0] - b * f[1]) / determinant,
                (a * f[1] - c * f[0]) / determinant,
            ];
            let size = length(step);
            // Once steps stop shrinking there is nothing left but rounding.
            if !(size < S::HALF * last) {
                break;
            }
            u = minus(u, step);
            last = size;
        }
        u
    }

    fn root(&self, x: [S; 2], u: [S; 2], touching: bool) -> Root<S> {
        let ray = self.ray(u);
        let determinant = ray.determinant();
        Root {
            u,
            determinant,
            transmittance: ray.transmittance,
            irradiance: self.flux(&ray) / determinant.abs(),
            conditioning: if touching {
                S::ONE / S::ZERO
            } else {
                self.conditioning(x, u)
            },
            touching,
        }
    }
}
