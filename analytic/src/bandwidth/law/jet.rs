//! Derivatives of a family of paths up to the third order, by central differences of nine points along both axes.

use super::family::Map;

/// Weights of the derivatives of order 0 to 3 at −4 … 4, exact for polynomials of degree 8 (the third: 8).
const WEIGHTS: [[f64; 9]; 4] = [
    [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [
        1.0 / 280.0,
        -4.0 / 105.0,
        0.2,
        -0.8,
        0.0,
        0.8,
        -0.2,
        4.0 / 105.0,
        -1.0 / 280.0,
    ],
    [
        -1.0 / 560.0,
        8.0 / 315.0,
        -0.2,
        1.6,
        -205.0 / 72.0,
        1.6,
        -0.2,
        8.0 / 315.0,
        -1.0 / 560.0,
    ],
    [
        -7.0 / 240.0,
        0.3,
        -169.0 / 120.0,
        61.0 / 30.0,
        0.0,
        -61.0 / 30.0,
        169.0 / 120.0,
        -0.3,
        7.0 / 240.0,
    ],
];

pub(super) type Vector = [f64; 3];

pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Offset (three components) and mean density with their derivatives ∂₁ⁱ∂₂ʲ, i + j ≤ 3, by unit steps of `size`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    derivatives: [[[f64; 4]; 4]; 4],
    /// Curvature of the space of offsets.
    pub curvature: f64,
}

impl Jet {
    /// About `u` with steps `h` of `size` along both axes.
    pub fn new(map: &Map<'_>, u: [f64; 2], size: [f64; 2], h: f64) -> Jet {
        let mut values = [[[0.0; 4]; 9]; 9];
        let mut curvature = 0.0;
        for (l, row) in values.iter_mut().enumerate() {
            for (k, value) in row.iter_mut().enumerate() {
                let at = [k as f64 - 4.0, l as f64 - 4.0];
                let s = map.at([0, 1].map(|i| u[i] + h * at[i] * size[i]));
                *value = [s.offset[0], s.offset[1], s.offset[2], s.density[0]];
                if k == 4 && l == 4 {
                    curvature = s.curvature;
                }
            }
        }
        let mut derivatives = [[[0.0; 4]; 4]; 4];
        for i in 0..4 {
            for j in 0..4 - i {
                let scale = 1.0 / libm::pow(h, (i + j) as f64);
                for (l, row) in values.iter().enumerate() {
                    for (k, value) in row.iter().enumerate() {
                        let w = WEIGHTS[i][k] * WEIGHTS[j][l] * scale;
                        if w != 0.0 {
                            for (c, v) in value.iter().enumerate() {
                                derivatives[i][j][c] += w * v;
                            }
                        }
                    }
                }
            }
        }
        Jet {
            derivatives,
            curvature,
        }
    }

    pub fn is_finite(&self) -> bool {
        self.derivatives
            .iter()
            .flatten()
            .flatten()
            .all(|v| v.is_finite())
    }

    /// The value and the first derivatives of the offset.
    pub fn offset(&self) -> Vector {
        self.component(0, 0)
    }

    fn component(&self, i: usize, j: usize) -> Vector {
        let d = &self.derivatives[i][j];
        [d[0], d[1], d[2]]
    }

    /// Columns of the Jacobian.
    pub fn jacobian(&self) -> [Vector; 2] {
        [self.component(1, 0), self.component(0, 1)]
    }

    /// Second derivative of the offset along two directions.
    pub fn second(&self, a: [f64; 2], b: [f64; 2]) -> Vector {
        let (xx, xy, yy) = (
            self.component(2, 0),
            self.component(1, 1),
            self.component(0, 2),
        );
        core::array::from_fn(|c| {
            a[0] * b[0] * xx[c] + (a[0] * b[1] + a[1] * b[0]) * xy[c] + a[1] * b[1] * yy[c]
        })
    }

    /// Terms of the expansion along a direction: offset = Σ termₖ tᵏ.
    pub fn terms(&self, e: [f64; 2]) -> [Vector; 4] {
        let [p, q] = self.jacobian();
        let third = |c: usize| {
            let d = |i: usize, j: usize| self.derivatives[i][j][c];
            let [a, b] = e;
            a * a * a * d(3, 0)
                + 3.0 * a * a * b * d(2, 1)
                + 3.0 * a * b * b * d(1, 2)
                + b * b * b * d(0, 3)
        };
        let second = self.second(e, e);
        [
            self.offset(),
            core::array::from_fn(|c| e[0] * p[c] + e[1] * q[c]),
            second.map(|v| 0.5 * v),
            core::array::from_fn(|c| third(c) / 6.0),
        ]
    }

    /// Density, and the two next terms of its expansion along a direction.
    pub fn density(&self, e: [f64; 2]) -> [f64; 3] {
        let d = |i: usize, j: usize| self.derivatives[i][j][3];
        [
            d(0, 0),
            e[0] * d(1, 0) + e[1] * d(0, 1),
            0.5 * (e[0] * e[0] * d(2, 0) + 2.0 * e[0] * e[1] * d(1, 1) + e[1] * e[1] * d(0, 2)),
        ]
    }

    /// JᵀJ: xx, xy, yy.
    pub fn metric(&self) -> [f64; 3] {
        let [p, q] = self.jacobian();
        [dot(&p, &p), dot(&p, &q), dot(&q, &q)]
    }

    /// Singular values, the larger first, with their directions in the parameters.
    pub fn singular(&self) -> [(f64, [f64; 2]); 2] {
        let [a, b, c] = self.metric();
        let half = 0.5 * libm::atan2(2.0 * b, a - c);
        let (sin, cos) = libm::sincos(half);
        let along = |e: [f64; 2]| {
            let t = self.terms(e)[1];
            (libm::sqrt(dot(&t, &t)), e)
        };
        [along([cos, sin]), along([-sin, cos])]
    }
}
