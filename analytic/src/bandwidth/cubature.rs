//! Integrals over convex polygons on the film: the rule of Genz & Malik (1980), degree 7 with an embedded degree 5, on
//! bilinear quadrilaterals (a triangle has two corners at one place); those with the largest errors are halved, across
//! the direction in which the integrand varies most, until the sum is good enough.

use libm::sqrt;

use super::quadrature::Pair;
use crate::pixel::polygon::Polygon;

/// A point of a plane.
type Point = [f64; 2];

/// What the integrand says at a film point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Value {
    /// The two integrands with their errors.
    pub pair: Pair,
    /// Whether the point sees nothing of a border: the kernel's support is whole, or misses the domain.
    pub plain: bool,
}

/// A convex quadrilateral, corners in order: the image of the unit square under (s, t) → (1−s)(1−t) a + s(1−t) b + s t c +
/// (1−s) t d.
#[derive(Clone, Copy, Debug)]
struct Shape([Point; 4]);

#[derive(Clone, Debug)]
struct Piece {
    shape: Shape,
    value: [f64; 2],
    /// Degree 7 minus degree 5.
    difference: [f64; 2],
    /// What is not an error of the rule: that of the integrand, and what the nodes cannot see.
    unseen: [f64; 2],
    /// Direction in which a rectangle is split.
    split: usize,
}

const L2: f64 = 0.358_568_582_800_318_1; // √(9/70)
const L4: f64 = 0.948_683_298_050_513_8; // √(9/10)
const L5: f64 = 0.688_247_201_611_685_3; // √(9/19)

/// Nodes on [-1, 1]², as groups with (weight of degree 7, weight of degree 5); the weights sum to 1.
const GROUPS: [(&[Point], f64, f64); 5] = [
    (&[[0.0, 0.0]], -3816.0 / 19683.0, -971.0 / 729.0),
    (
        &[[-L2, 0.0], [L2, 0.0], [0.0, -L2], [0.0, L2]],
        980.0 / 6561.0,
        245.0 / 486.0,
    ),
    (
        &[[-L4, 0.0], [L4, 0.0], [0.0, -L4], [0.0, L4]],
        1020.0 / 19683.0,
        65.0 / 1458.0,
    ),
    (
        &[[-L4, -L4], [L4, -L4], [-L4, L4], [L4, L4]],
        200.0 / 19683.0,
        25.0 / 729.0,
    ),
    (
        &[[-L5, -L5], [L5, -L5], [-L5, L5], [L5, L5]],
        6859.0 / 78732.0,
        0.0,
    ),
];

/// How close the outermost nodes come to the border of a piece, as a part of its extent.
const UNSEEN: f64 = 0.5 * (1.0 - L4);

/// An integrand on the film and the places near which it may change within a distance too small to be seen.
pub(super) struct Integrand<F, P, B> {
    /// The function.
    pub at: F,
    /// Its size where nothing is cut.
    pub peak: P,
    /// Whether a film point is on the border of the lit set.
    pub on_border: B,
}

impl<F, P, B> Integrand<F, P, B>
where
    F: Fn(f64, f64) -> Value,
    P: Fn(f64, f64) -> [f64; 2],
    B: Fn(f64, f64) -> bool,
{
    /// Integrates over disjoint convex polygons until both errors are below `target(sum)`, with at most `rounds`
    /// rounds of splits; what was reached is in the result.
    pub fn integrate(
        &self,
        polygons: &[Polygon],
        rounds: usize,
        target: impl Fn(&Pair) -> [f64; 2],
    ) -> Pair {
        let mut list: Vec<Piece> = polygons
            .iter()
            .flat_map(shapes)
            .map(|s| self.piece(s))
            .collect();
        for round in 0..=rounds {
            let sum = total(&list);
            let goal = target(&sum).map(|g| g.max(f64::MIN_POSITIVE));
            if round == rounds || (0..2).all(|k| sum.error[k] <= goal[k]) {
                return sum;
            }
            // All that are clearly among the poorest at once.
            let missed = |p: &Piece| {
                (0..2)
                    .map(|k| (p.difference[k].abs() + p.unseen[k]) / goal[k])
                    .fold(0.0, f64::max)
            };
            let worst = list.iter().map(missed).fold(0.0, f64::max);
            for i in 0..list.len() {
                if missed(&list[i]) >= 0.25 * worst {
                    let [left, right] = list[i].halves();
                    list[i] = self.piece(left);
                    list.push(self.piece(right));
                }
            }
        }
        Pair::default()
    }

    fn piece(&self, shape: Shape) -> Piece {
        let (mut fine, mut coarse, mut absolute) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let mut inner = [0.0; 2];
        let mut plain = true;
        let mut axis = [[0.0; 2]; 4];
        let mut center = [0.0; 2];
        for (group, (nodes, w7, w5)) in GROUPS.iter().enumerate() {
            for (n, node) in nodes.iter().enumerate() {
                let ([u, v], area) = shape.at(*node);
                let value = (self.at)(u, v);
                plain &= value.plain;
                for k in 0..2 {
                    let f = area * value.pair.value[k];
                    fine[k] += w7 * f;
                    coarse[k] += w5 * f;
                    absolute[k] += w7.abs() * f.abs();
                    inner[k] += w7.abs() * area * value.pair.error[k];
                    match group {
                        0 => center[k] = f,
                        1 => axis[n / 2][k] += f,
                        2 => axis[2 + n / 2][k] += f,
                        _ => {}
                    }
                }
            }
        }
        let mut unseen = inner;
        if plain && self.touches_border(&shape) {
            // A layer narrower than the distance of the outermost nodes would not be seen: half of the peak there.
            let ([u, v], _) = shape.at([0.0, 0.0]);
            let peak = (self.peak)(u, v);
            for (error, p) in unseen.iter_mut().zip(peak) {
                *error += UNSEEN * shape.area() * p;
            }
        }
        // Fourth differences along the two axes decide where to split.
        let ratio = (L2 / L4) * (L2 / L4);
        let rough = |d: usize| {
            (0..2)
                .map(|k| {
                    let second = axis[d][k] - 2.0 * center[k];
                    let wide = axis[2 + d][k] - 2.0 * center[k];
                    (second - ratio * wide).abs() / absolute[k].max(f64::MIN_POSITIVE)
                })
                .fold(0.0, f64::max)
        };
        let (ru, rv) = (rough(0), rough(1));
        let split = if (ru - rv).abs() <= 0.1 * (ru + rv) {
            shape.longer()
        } else {
            usize::from(rv > ru)
        };
        Piece {
            shape,
            value: fine,
            difference: [fine[0] - coarse[0], fine[1] - coarse[1]],
            unseen,
            split,
        }
    }

    /// Whether an edge of the piece lies on the border of the lit set, which is convex: three of its points do.
    fn touches_border(&self, shape: &Shape) -> bool {
        let Shape(corners) = shape;
        (0..4).any(|k| {
            let (p, q) = (corners[k], corners[(k + 1) % 4]);
            let at = |t: f64| (self.on_border)(p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]));
            p != q && at(0.5) && at(0.0) && at(1.0)
        })
    }
}

/// The sum over disjoint pieces and an estimate of its error.
///
/// A rule's error at a kink oscillates about zero as the kink moves through the piece, so the errors of many pieces
/// cancel unless the kinks lie alike in all of them, and then their signed differences add up: the error is estimated
/// by twice the sum of the signed differences and three times the root of the sum of their squares. (The sum of the absolute differences is
/// some hundred times larger than the error on real images.)
fn total(list: &[Piece]) -> Pair {
    let mut sum = Pair::default();
    for k in 0..2 {
        let (mut signed, mut squares, mut absolute) = (0.0, 0.0, 0.0);
        for p in list {
            let d = p.difference[k];
            sum.value[k] += p.value[k];
            sum.error[k] += p.unseen[k];
            signed += d;
            squares += d * d;
            absolute += p.value[k].abs();
        }
        sum.error[k] +=
            2.0 * f64::abs(signed) + 3.0 * sqrt(squares) + 4.0 * f64::EPSILON * absolute;
    }
    sum
}

impl Piece {
    fn halves(&self) -> [Shape; 2] {
        let Shape([a, b, c, d]) = self.shape;
        let middle = |p: Point, q: Point| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        if self.split == 0 {
            let (m, n) = (middle(a, b), middle(d, c));
            [Shape([a, m, n, d]), Shape([m, b, c, n])]
        } else {
            let (m, n) = (middle(a, d), middle(b, c));
            [Shape([a, b, n, m]), Shape([m, n, c, d])]
        }
    }
}

fn minus(p: Point, q: Point) -> Point {
    [p[0] - q[0], p[1] - q[1]]
}

fn cross(p: Point, q: Point) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

impl Shape {
    /// The point of a node, and the area element: the weights sum to 1.
    fn at(&self, node: Point) -> (Point, f64) {
        let Shape([a, b, c, d]) = *self;
        let (s, t) = (0.5 * (1.0 + node[0]), 0.5 * (1.0 + node[1]));
        let (ab, dc) = (minus(b, a), minus(c, d));
        let (ad, bc) = (minus(d, a), minus(c, b));
        let twist = minus(dc, ab);
        let point = core::array::from_fn(|i| a[i] + s * ab[i] + t * ad[i] + s * t * twist[i]);
        let along = [ab[0] + t * twist[0], ab[1] + t * twist[1]];
        let across = [ad[0] + s * (bc[0] - ad[0]), ad[1] + s * (bc[1] - ad[1])];
        (point, cross(along, across).abs())
    }

    fn area(&self) -> f64 {
        let Shape([a, b, c, d]) = *self;
        0.5 * cross(minus(c, a), minus(d, b)).abs()
    }

    /// The direction in which the shape is longer.
    fn longer(&self) -> usize {
        let Shape([a, b, c, d]) = *self;
        let length = |p: Point| p[0] * p[0] + p[1] * p[1];
        let s = length(minus(b, a)) + length(minus(c, d));
        let t = length(minus(d, a)) + length(minus(c, b));
        usize::from(t > s)
    }
}

/// A convex polygon as quadrilaterals that share its first corner, the last one perhaps a triangle.
fn shapes(polygon: &Polygon) -> Vec<Shape> {
    let c = &polygon.corners;
    (1..c.len().saturating_sub(1))
        .step_by(2)
        .map(|k| {
            // A triangle collapses onto the corner that all pieces share.
            let last = c.get(k + 2).unwrap_or(&c[0]);
            Shape([c[0], c[k], c[k + 1], *last])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(polygon: Polygon, f: impl Fn(f64, f64) -> f64) -> Pair {
        let integrand = Integrand {
            at: |u: f64, v: f64| Value {
                pair: Pair {
                    value: [f(u, v), 1.0],
                    error: [0.0; 2],
                },
                plain: false,
            },
            peak: |_: f64, _: f64| [0.0; 2],
            on_border: |_: f64, _: f64| false,
        };
        integrand.integrate(&[polygon], 40, |s| s.value.map(|v| 1e-6 * v.abs()))
    }

    #[test]
    fn degree_seven_on_a_rectangle_and_six_on_a_triangle() {
        let square = Shape([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        let triangle = Shape([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]);
        let sum = |shape: &Shape, f: &dyn Fn(f64, f64) -> f64| -> f64 {
            GROUPS
                .iter()
                .flat_map(|(nodes, w, _)| nodes.iter().map(move |n| (n, w)))
                .map(|(n, w)| {
                    let ([u, v], area) = shape.at(*n);
                    w * area * f(u, v)
                })
                .sum()
        };
        let got = sum(&square, &|u, v| u * u * u * u * v * v * v);
        assert!((got - 1.0 / 20.0).abs() < 1e-15);
        // ∫ u³ dA = 3! / 5! over the unit triangle.
        let got = sum(&triangle, &|u, _| u * u * u);
        assert!((got - 1.0 / 20.0).abs() < 1e-15);
    }

    #[test]
    fn error_bound_covers_the_error_with_a_kink_and_a_jump() {
        let square = Polygon::rectangle([0.0, 1.0], [0.0, 2.0]);
        let kink = integral(square.clone(), |u, v| (u + v - 0.7).abs());
        // ∫∫ |u + v − c| over [0,1]×[0,2], c < 1: ∫∫(u + v − c) + 2 ∫∫_{u+v<c}(c − u − v) = 3 − 2c + c³/3.
        let exact = 3.0 - 1.4 + 0.343 / 3.0;
        assert!(
            (kink.value[0] - exact).abs() <= kink.error[0],
            "{kink:?} {exact}"
        );
        assert!(kink.error[0] < 1e-5, "{kink:?}");
        let jump = integral(square, |u, v| f64::from(u + 0.3 * v < 0.8));
        // Width 0.8 − 0.3v over v in [0, 2].
        assert!((jump.value[0] - 1.0).abs() <= jump.error[0], "{jump:?}");
        assert!(jump.error[0] < 0.01, "{jump:?}");
    }
}
