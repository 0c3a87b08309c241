//! Convex polygons on the film: clipping by half-planes, differences of convex sets, Gauss quadrature.
//!
//! Where every discontinuity of the integrand is a straight film line, clipping the pixel by those lines and integrating
//! the smooth pieces is exact: no edge is guessed, none is missed. A difference A \ B is cut into disjoint convex pieces
//! by B's half-planes one after another, so nothing is subtracted and nothing cancels.
//!
//! **Accuracy**: corners to a few units in the last place of the half-planes' values.

use crate::camera::Bounded;
use crate::pixel::rule::Rule;

/// The points (u, v) with `a u + b v + c ≥ 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// Coefficient of u.
    pub a: f64,
    /// Coefficient of v.
    pub b: f64,
    /// Constant.
    pub c: f64,
}

impl HalfPlane {
    /// The linear function at a point.
    #[inline(always)]
    pub fn at(&self, u: f64, v: f64) -> f64 {
        self.a * u + self.b * v + self.c
    }

    /// The complement (which shares the border).
    pub fn reversed(&self) -> Self {
        HalfPlane {
            a: -self.a,
            b: -self.b,
            c: -self.c,
        }
    }
}

/// Where a pixel lies with respect to a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Every point of the pixel belongs to the set.
    Inside,
    /// No inner point of the pixel belongs to the set.
    Outside,
    /// Undecided by the pixel's corners: clip.
    Across,
}

/// An intersection of half-planes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConvexSet {
    /// The half-planes; none means the whole film plane.
    pub half_planes: Vec<HalfPlane>,
}

impl ConvexSet {
    /// Where the pixel [i, i+1] × [j, j+1] lies. `Across` may be returned for a pixel that is outside.
    pub fn side(&self, i: u32, j: u32) -> Side {
        let (u, v) = (f64::from(i), f64::from(j));
        let mut side = Side::Inside;
        for h in &self.half_planes {
            let low = h.at(u, v) + h.a.min(0.0) + h.b.min(0.0);
            let high = h.at(u, v) + h.a.max(0.0) + h.b.max(0.0);
            if high <= 0.0 {
                return Side::Outside;
            }
            if low < 0.0 {
                side = Side::Across;
            }
        }
        side
    }

    /// Whether a point belongs to the set.
    pub fn contains(&self, u: f64, v: f64) -> bool {
        self.half_planes.iter().all(|h| h.at(u, v) >= 0.0)
    }
}

/// A convex polygon on the film, corners in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// The corners (u, v).
    pub corners: Vec<[f64; 2]>,
}

impl Polygon {
    /// The rectangle [u0, u1] × [v0, v1].
    pub fn rectangle(u: [f64; 2], v: [f64; 2]) -> Self {
        Polygon {
            corners: vec![[u[0], v[0]], [u[1], v[0]], [u[1], v[1]], [u[0], v[1]]],
        }
    }

    /// Pixel (i, j).
    pub fn pixel(i: u32, j: u32) -> Self {
        let (u, v) = (f64::from(i), f64::from(j));
        Self::rectangle([u, u + 1.0], [v, v + 1.0])
    }

    /// Whether nothing is left.
    pub fn is_empty(&self) -> bool {
        self.corners.len() < 3
    }

    /// The part inside a half-plane (Sutherland–Hodgman).
    pub fn clipped(&self, h: &HalfPlane) -> Self {
        let n = self.corners.len();
        let mut corners = Vec::with_capacity(n + 1);
        for k in 0..n {
            let (p, q) = (self.corners[k], self.corners[(k + 1) % n]);
            let (dp, dq) = (h.at(p[0], p[1]), h.at(q[0], q[1]));
            if dp >= 0.0 {
                corners.push(p);
            }
            if (dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0) {
                let t = dp / (dp - dq);
                corners.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
            }
        }
        if corners.len() < 3 {
            corners.clear();
        }
        Polygon { corners }
    }

    /// The part inside a convex set.
    pub fn intersection(&self, set: &ConvexSet) -> Self {
        let mut polygon = self.clone();
        for h in &set.half_planes {
            if polygon.is_empty() {
                break;
            }
            polygon = polygon.clipped(h);
        }
        polygon
    }

    /// Appends the part outside a convex set, as disjoint convex polygons: the k-th piece is inside the first k - 1
    /// half-planes and outside the k-th.
    pub fn difference(&self, set: &ConvexSet, pieces: &mut Vec<Polygon>) {
        let mut rest = self.clone();
        for h in &set.half_planes {
            if rest.is_empty() {
                return;
            }
            let outside = rest.clipped(&h.reversed());
            if !outside.is_empty() {
                pieces.push(outside);
                rest = rest.clipped(h);
            }
        }
    }

    /// Area, not negative.
    pub fn area(&self) -> f64 {
        self.triangles().map(|(_, area)| area).sum()
    }

    /// The fan of triangles from the first corner, with their areas.
    fn triangles(&self) -> impl Iterator<Item = ([[f64; 2]; 3], f64)> + '_ {
        (2..self.corners.len()).map(|k| {
            let t = [self.corners[0], self.corners[k - 1], self.corners[k]];
            let cross = (t[1][0] - t[0][0]) * (t[2][1] - t[0][1])
                - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]);
            (t, 0.5 * cross.abs())
        })
    }

    /// ∫ f du dv: a tensor rule on a rectangle, collapsed (Duffy) rules on the fan of triangles otherwise. Exact for
    /// polynomials of degree 2n - 2 (n the number of the rule's nodes).
    pub fn integrate(&self, rule: &Rule, f: &impl Fn(f64, f64) -> f64) -> f64 {
        let c = &self.corners;
        let upright = c.len() == 4
            && c[0][1] == c[1][1]
            && c[1][0] == c[2][0]
            && c[2][1] == c[3][1]
            && c[3][0] == c[0][0];
        if upright {
            let (du, dv) = (c[1][0] - c[0][0], c[2][1] - c[1][1]);
            let mut sum = 0.0;
            for (s, ws) in rule.iter() {
                let v = c[0][1] + s * dv;
                let mut line = 0.0;
                for (t, wt) in rule.iter() {
                    line += wt * f(c[0][0] + t * du, v);
                }
                sum += ws * line;
            }
            return sum * (du * dv).abs();
        }
        let mut total = 0.0;
        for (t, area) in self.triangles() {
            let mut sum = 0.0;
            for (r, wr) in rule.iter() {
                let mut line = 0.0;
                for (s, ws) in rule.iter() {
                    let (b, c) = (r * (1.0 - s), r * s);
                    let u = t[0][0] + b * (t[1][0] - t[0][0]) + c * (t[2][0] - t[0][0]);
                    let v = t[0][1] + b * (t[1][1] - t[0][1]) + c * (t[2][1] - t[0][1]);
                    line += ws * f(u, v);
                }
                sum += wr * r * line;
            }
            total += 2.0 * area * sum;
        }
        total
    }

    /// Four convex pieces: cuts through the middle of the bounding box.
    fn quarters(&self) -> Vec<Polygon> {
        let range = |axis: usize| {
            let at =
                |f: fn(f64, f64) -> f64, start| self.corners.iter().map(|c| c[axis]).fold(start, f);
            0.5 * (at(f64::min, f64::INFINITY) + at(f64::max, f64::NEG_INFINITY))
        };
        let (u, v) = (range(0), range(1));
        let mut pieces = Vec::with_capacity(4);
        for su in [-1.0, 1.0] {
            let half = self.clipped(&HalfPlane {
                a: su,
                b: 0.0,
                c: -su * u,
            });
            for sv in [-1.0, 1.0] {
                let piece = half.clipped(&HalfPlane {
                    a: 0.0,
                    b: sv,
                    c: -sv * v,
                });
                if !piece.is_empty() {
                    pieces.push(piece);
                }
            }
        }
        pieces
    }
}

/// Rules of increasing order, for integrands that are analytic on each polygon.
#[derive(Clone, Debug)]
pub struct Ladder {
    rules: Vec<Rule>,
}

impl Default for Ladder {
    fn default() -> Self {
        Ladder {
            rules: [2, 3, 4, 6, 9, 13].map(Rule::gauss).into(),
        }
    }
}

/// How often a polygon is quartered when the highest order does not suffice.
const DEEPEST: u32 = 12;

impl Ladder {
    /// ∫ f du dv over a polygon to an absolute tolerance plus `relative` times the value.
    ///
    /// The order is raised until neighbours agree; if none do, the polygon is quartered. The error returned is the
    /// difference of the last two orders or, should these agree by chance, a tenth of the one before, plus rounding.
    pub fn integrate(
        &self,
        polygon: &Polygon,
        relative: f64,
        absolute: f64,
        f: &impl Fn(f64, f64) -> f64,
    ) -> Bounded {
        self.descend(polygon, relative, absolute, DEEPEST, f)
    }

    fn descend(
        &self,
        polygon: &Polygon,
        relative: f64,
        absolute: f64,
        depth: u32,
        f: &impl Fn(f64, f64) -> f64,
    ) -> Bounded {
        if polygon.is_empty() {
            return Bounded::default();
        }
        let mut before = polygon.integrate(&self.rules[0], f);
        let mut error = f64::INFINITY;
        let mut last = f64::INFINITY;
        for rule in &self.rules[1..] {
            let value = polygon.integrate(rule, f);
            let difference = (value - before).abs();
            error = difference.max(0.1 * last);
            (before, last) = (value, difference);
            let rounding = 16.0 * f64::EPSILON * value.abs();
            if error <= (relative * value.abs() + absolute).max(rounding) {
                return Bounded {
                    value,
                    error: error + rounding,
                };
            }
        }
        if depth == 0 {
            return Bounded {
                value: before,
                error,
            };
        }
        let mut sum = Bounded::default();
        for piece in polygon.quarters() {
            let part = self.descend(&piece, relative, 0.25 * absolute, depth - 1, f);
            sum.value += part.value;
            sum.error += part.error;
        }
        sum
    }
}
