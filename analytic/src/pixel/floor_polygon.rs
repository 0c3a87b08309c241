//! A pixel's footprint on a horizontal plane: a convex polygon, cut by lines and by vertical planes through the pinhole.
//!
//! The film's area element on the plane a height H below the pinhole is
//!
//! ```text
//! du dv = H / (p² depth³) dA,      depth = (x - pinhole)·forward,   p the pixel's size at depth 1,
//! ```
//!
//! and depth is linear along any straight line, so that the film area of a piece of a line family has a closed form:
//!
//! ```text
//! parallel lines   ∫ dτ / depth³   = (τ₁ - τ₀)(D₀ + D₁) / (2 D₀² D₁²)
//! a fan at the     ∫ r dr / depth³ = (r₁ - r₀)(r₁/D₁ + r₀/D₀) / (2 D₀ D₁)
//! nadir
//! ```
//!
//! with D₀, D₁ the depths at the ends. Both are free of cancellation.

use crate::camera::Film;
use crate::pixel::polygon::Polygon;
use crate::vector::Vec3;

/// The pinhole above a horizontal plane.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// Foot of the pinhole on the plane.
    pub nadir: [f64; 2],
    /// Height of the pinhole above the plane.
    pub height: f64,
    /// The unit viewing direction.
    pub forward: Vec3<f64>,
    /// H / p².
    scale: f64,
}

impl Projection {
    /// The plane at height `z`, which must be below the pinhole.
    pub fn new(film: &Film, z: f64) -> Self {
        let height = film.position.z - z;
        Projection {
            nadir: [film.position.x, film.position.y],
            height,
            forward: film.forward,
            scale: height / film.du.length_squared(),
        }
    }

    /// Depth of a point of the plane.
    #[inline(always)]
    pub fn depth(&self, x: [f64; 2]) -> f64 {
        (x[0] - self.nadir[0]) * self.forward.x + (x[1] - self.nadir[1]) * self.forward.y
            - self.height * self.forward.z
    }

    /// Film area per plane area at a point of given depth.
    #[inline(always)]
    pub fn density(&self, depth: f64) -> f64 {
        self.scale / (depth * depth * depth)
    }

    /// ∫ density dτ along a straight line between two points `length` apart.
    #[inline(always)]
    pub fn along(&self, length: f64, depths: [f64; 2]) -> f64 {
        let product = depths[0] * depths[1];
        self.scale * length * (depths[0] + depths[1]) / (2.0 * product * product)
    }

    /// ∫ density r dr from r₀ to r₁ in the direction of the unit vector `e` from the nadir.
    #[inline(always)]
    pub fn fan(&self, e: [f64; 2], r0: f64, r1: f64) -> f64 {
        let slope = e[0] * self.forward.x + e[1] * self.forward.y;
        let base = -self.height * self.forward.z;
        let (d0, d1) = (base + slope * r0, base + slope * r1);
        self.scale * (r1 - r0) * (r1 / d1 + r0 / d0) / (2.0 * d0 * d1)
    }
}

/// An edge of a polygon: points inside have `n·x ≥ k`.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Inward unit normal.
    pub normal: [f64; 2],
    /// Offset.
    pub offset: f64,
}

/// A convex polygon on the plane.
#[derive(Clone, Debug, Default)]
pub struct FloorPolygon {
    /// Corners in order.
    pub corners: Vec<[f64; 2]>,
    /// Edges; those of no length are left out.
    pub edges: Vec<Edge>,
    /// Mean of the corners.
    pub center: [f64; 2],
    /// Largest distance of a corner from `center`.
    pub radius: f64,
}

impl FloorPolygon {
    /// The footprint of a film polygon under a map that keeps straight lines straight; `None` if it is empty.
    pub fn new(film: &Polygon, map: impl Fn(f64, f64) -> [f64; 2]) -> Option<Self> {
        let corners: Vec<_> = film.corners.iter().map(|c| map(c[0], c[1])).collect();
        let n = corners.len();
        if n < 3 || !corners.iter().flatten().all(|c| c.is_finite()) {
            return None;
        }
        let mean = |k: usize| corners.iter().map(|c| c[k]).sum::<f64>() / n as f64;
        let center = [mean(0), mean(1)];
        let mut edges = Vec::with_capacity(n);
        for (k, p) in corners.iter().enumerate() {
            let q = corners[(k + 1) % n];
            let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
            let length = libm::hypot(dx, dy);
            if !(length > 0.0) {
                continue;
            }
            let normal = [-dy / length, dx / length];
            let side = normal[0] * (center[0] - p[0]) + normal[1] * (center[1] - p[1]);
            let normal = if side < 0.0 {
                normal.map(|c| -c)
            } else {
                normal
            };
            let offset = normal[0] * p[0] + normal[1] * p[1];
            edges.push(Edge { normal, offset });
        }
        let distance = |c: &[f64; 2]| libm::hypot(c[0] - center[0], c[1] - center[1]);
        let radius = corners.iter().map(distance).fold(0.0, f64::max);
        Some(FloorPolygon {
            corners,
            edges,
            center,
            radius,
        })
    }

    /// The part of the segment `from + τ along`, τ in [low, high], inside the polygon, with the labels of the edges that
    /// cut it (`u8::MAX` where none does).
    #[inline]
    pub fn clip(
        &self,
        from: [f64; 2],
        along: [f64; 2],
        low: f64,
        high: f64,
    ) -> Option<([f64; 2], [u8; 2])> {
        clip(&self.edges, from, along, low, high)
    }

    /// Whether a point is within `margin` of the polygon's circle.
    pub fn is_near(&self, x: [f64; 2], margin: f64) -> bool {
        libm::hypot(x[0] - self.center[0], x[1] - self.center[1]) <= self.radius + margin
    }
}

/// As [`FloorPolygon::clip`], for any list of edges.
#[inline]
pub fn clip(
    edges: &[Edge],
    from: [f64; 2],
    along: [f64; 2],
    mut low: f64,
    mut high: f64,
) -> Option<([f64; 2], [u8; 2])> {
    let mut labels = [u8::MAX; 2];
    for (label, e) in (0..).zip(edges) {
        let start = e.normal[0] * from[0] + e.normal[1] * from[1] - e.offset;
        let slope = e.normal[0] * along[0] + e.normal[1] * along[1];
        if slope == 0.0 {
            if start < 0.0 {
                return None;
            }
            continue;
        }
        let t = -start / slope;
        if slope > 0.0 {
            if t > low {
                (low, labels[0]) = (t, label);
            }
        } else if t < high {
            (high, labels[1]) = (t, label);
        }
    }
    (high > low).then_some(([low, high], labels))
}
