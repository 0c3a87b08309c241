//! The light-side kernel with a bandwidth linked to a radius: α(s) = atan(r/d(s)), d the distance from s along the exact
//! reflected ray to the receiver.
//!
//! With H and h the heights of y' and s above the receiver's plane, d = r₂ h/(H − h) while 0 < h < H, and the support is
//!
//! ```text
//! g < α  ⇔  d tan g < r  ⇔  r₂ h N < r (H − h) D,   D > 0      (N, D of tan g: module `unfold`)
//! ```
//!
//! Along a radial line r₂² and D are quadratic, h linear and N a multiple of ρ, so the squares of both sides differ by a
//! polynomial of degree 6. Its roots are isolated in Bernstein form; none is missed. There can be several: where the mirror
//! meets the receiver's plane d → 0 and α → π/2, and the support has a second component there.
//!
//! Where the exact ray leaves the scene, d is the scene's diagonal; in a scene with an unbounded surface such a ray
//! contributes nothing.

use libm::{atan, sincos, sqrt};

use super::Kernel;
use super::clip::Domain;
use super::kernel::{epanechnikov_height, escalate, gauss, von_mises_fisher};
use super::polar::{Chart, SPLITS};
use super::quadrature::{Ends, ORDERS, Pair, adaptive, bracketed_root};
use super::setting::PlanarSetting;
use super::unfold::{Azimuth, Unfolded};
use crate::pixel::rule::Rule;
use crate::vector::Vec3;

const PI: f64 = core::f64::consts::PI;

/// One part of a radial line on which the integrand is smooth.
#[derive(Clone, Copy, Debug)]
struct Segment {
    from: f64,
    to: f64,
    escapes: bool,
}

/// The linked expectation at one receiver point for one radius.
pub(super) struct Linked<'a> {
    unfolded: &'a Unfolded,
    /// The mirror points of which the exact ray lands on the receiver.
    hits: Domain,
    /// H.
    image_height: f64,
    escape: Option<f64>,
    radius: f64,
    kernel: Kernel,
    rules: &'a [Rule],
}

impl<'a> Linked<'a> {
    pub fn new(
        setting: &PlanarSetting,
        x: Vec3<f64>,
        unfolded: &'a Unfolded,
        kernel: Kernel,
        radius: f64,
        rules: &'a [Rule],
    ) -> Self {
        let (m, image) = (setting.receiver_normal, setting.image());
        let big = (image - x).dot(m);
        let mut hits = Domain::default();
        let mut cut = |normal: Vec3<f64>, offset: f64| {
            let (n, h) = unfolded.trace(normal, offset);
            hits.cut(n, h);
        };
        cut(m, m.dot(x) + big);
        // The landing point z = y' + (s − y') H/(H − h) is inside N·z ≤ o:  H N·(s − y') ≤ (o − N·y')(H − h).
        for e in &setting.receiver_edges {
            let u = e.offset - e.normal.dot(image);
            cut(
                e.normal * big + m * u,
                big * e.normal.dot(image) + u * (big + m.dot(x)),
            );
        }
        if !(big > 0.0) {
            hits.cut([0.0, 0.0], -1.0);
        }
        Linked {
            unfolded,
            hits,
            image_height: big,
            escape: setting.escape_distance,
            radius,
            kernel,
            rules,
        }
    }

    /// Mean and second moment, to `tolerance × max(|value|, floor)`.
    pub fn integrate(&self, tolerance: f64, floor: [f64; 2]) -> Pair {
        let mut breaks: Vec<(f64, f64)> = self.unfolded.domain.pieces();
        let both = self.unfolded.domain.and(&self.hits);
        let inner: Vec<f64> = both.pieces().iter().flat_map(|p| [p.0, p.1]).collect();
        let mut pieces = Vec::new();
        for (a, b) in breaks.drain(..) {
            let mut cuts = vec![a, b];
            for w in &inner {
                for turn in [-2.0 * PI, 0.0, 2.0 * PI] {
                    if w + turn > a + 1e-13 && w + turn < b - 1e-13 {
                        cuts.push(w + turn);
                    }
                }
            }
            cuts.sort_by(f64::total_cmp);
            for c in cuts.windows(2) {
                self.broken_where_support_changes(c[0], c[1], &mut pieces);
            }
        }
        let mut radial = |w: f64| self.radial(w, 0.1 * tolerance);
        adaptive(&pieces, tolerance, floor, SPLITS, &mut radial)
    }

    /// Breaks [a, b] where the number of parts of the support changes: there a part begins with zero length, like a square
    /// root.
    fn broken_where_support_changes(&self, a: f64, b: f64, pieces: &mut Vec<(f64, f64, Ends)>) {
        if !(b - a > 1e-14) {
            return;
        }
        const SAMPLES: usize = 12;
        let at = |k: usize| {
            let edge = 1e-9 * (b - a);
            (a + (b - a) * k as f64 / SAMPLES as f64).clamp(a + edge, b - edge)
        };
        let mut cuts = vec![a];
        let mut before = self.signature(at(0));
        for k in 1..=SAMPLES {
            let now = self.signature(at(k));
            if now != before {
                let (mut low, mut high) = (at(k - 1), at(k));
                while high - low > 1e-15 * (1.0 + low.abs()) {
                    let mid = 0.5 * (low + high);
                    if !(mid > low && mid < high) {
                        break;
                    }
                    if self.signature(mid) == before {
                        low = mid;
                    } else {
                        high = mid;
                    }
                }
                cuts.push(0.5 * (low + high));
                before = now;
            }
        }
        cuts.push(b);
        pieces.extend(
            cuts.windows(2)
                .filter(|w| w[1] > w[0])
                .map(|w| (w[0], w[1], Ends::SquareRoot)),
        );
    }

    /// How many parts the support has along a radial line, and how it meets the domain's ends.
    fn signature(&self, w: f64) -> (usize, bool, bool) {
        let (s, c) = sincos(w);
        let segments = self.segments(c, s);
        let ends = self.unfolded.domain.interval(c, s);
        let touches = |at: Option<f64>, end: Option<f64>| at.is_some() && at == end;
        (
            segments.len(),
            touches(segments.first().map(|s| s.from), ends.map(|e| e.0)),
            touches(segments.last().map(|s| s.to), ends.map(|e| e.1)),
        )
    }

    fn segments(&self, c: f64, s: f64) -> Vec<Segment> {
        let mut segments = Vec::new();
        let Some((low, high)) = self.unfolded.domain.interval(c, s) else {
            return segments;
        };
        let z = self.unfolded.line(c, s);
        let hit = self
            .hits
            .interval(c, s)
            .map(|(a, b)| (a.max(low), b.min(high)))
            .filter(|(a, b)| a < b);
        let Some((from, to)) = hit else {
            self.escaping(&z, low, high, &mut segments);
            return segments;
        };
        self.escaping(&z, low, from, &mut segments);
        self.hitting(&z, from, to, &mut segments);
        self.escaping(&z, to, high, &mut segments);
        segments
    }

    fn escaping(&self, z: &Azimuth, from: f64, to: f64, segments: &mut Vec<Segment>) {
        let Some(distance) = self.escape.filter(|_| from < to) else {
            return;
        };
        let end = if self.kernel == Kernel::VonMisesFisher {
            to
        } else {
            let (sin_a, cos_a) = sincos(atan(self.radius / distance));
            let (half, s) = self.unfolded.spread(z, sin_a, cos_a);
            to.min(self.unfolded.radius(z, sin_a, half, s))
        };
        if from < end {
            segments.push(Segment {
                from,
                to: end,
                escapes: true,
            });
        }
    }

    /// r₂ h N − r (H − h) D: negative inside the support.
    fn outside(&self, z: &Azimuth, rho: f64, radius: f64) -> f64 {
        let u = self.unfolded;
        let (n, d) = u.tangent(z, rho);
        let h = u.height[0] + z.slope * rho;
        let t = u.b - z.kappa * rho;
        sqrt(t * t + rho * rho) * h * n - radius * (self.image_height - h) * d
    }

    fn hitting(&self, z: &Azimuth, from: f64, to: f64, segments: &mut Vec<Segment>) {
        let (half, s) = self.unfolded.spread(z, 1.0, 0.0);
        let right_angle = self.unfolded.radius(z, 1.0, half, s);
        let mut push = |a: f64, b: f64| {
            segments.push(Segment {
                from: a,
                to: b,
                escapes: false,
            });
        };
        let end = to.min(right_angle);
        if self.kernel == Kernel::VonMisesFisher {
            // No end of the support, but a scale: cut at multiples of it, so that each part is smooth.
            let mut cuts = vec![from];
            if from < end {
                for multiple in [0.5, 1.0, 2.0, 4.0, 8.0] {
                    self.roots(z, from, end, multiple * self.radius, &mut cuts);
                }
                cuts.push(end);
            }
            cuts.push(to);
            cuts.sort_by(f64::total_cmp);
            cuts.dedup();
            cuts.windows(2).for_each(|w| push(w[0], w[1]));
            return;
        }
        if !(from < end) {
            return;
        }
        let mut cuts = vec![from];
        self.roots(z, from, end, self.radius, &mut cuts);
        cuts.push(end);
        cuts.sort_by(f64::total_cmp);
        for w in cuts.windows(2) {
            if w[0] < w[1] && self.outside(z, 0.5 * (w[0] + w[1]), self.radius) < 0.0 {
                push(w[0], w[1]);
            }
        }
    }

    /// Appends all radii in (from, to) at which d tan g equals `radius`.
    fn roots(&self, z: &Azimuth, from: f64, to: f64, radius: f64, out: &mut Vec<f64>) {
        let u = self.unfolded;
        let length = to - from;
        // Polynomials in t, ρ = from + length t.
        let linear = |c0: f64, c1: f64| [c0 + c1 * from, c1 * length, 0.0];
        let quadratic = |c0: f64, c1: f64, c2: f64| {
            [
                c0 + from * (c1 + c2 * from),
                length * (c1 + 2.0 * c2 * from),
                c2 * length * length,
            ]
        };
        let k = z.kappa;
        let h = linear(u.height[0], z.slope);
        let missing = linear(self.image_height - u.height[0], -z.slope);
        let n = linear(0.0, u.a + u.b);
        let d = quadratic(u.a * u.b, k * (u.b - u.a), -(1.0 + k * k));
        let r2 = quadratic(u.b * u.b, -2.0 * u.b * k, 1.0 + k * k);
        let hn = product(&h, &n);
        let left = product(&r2, &product(&hn, &hn));
        let md = product(&missing, &d);
        let right = product(&md, &md);
        // Coefficient i of t weighs C(j, i)/C(6, i) in Bernstein coefficient j.
        let mut bernstein = [0.0; 7];
        for (i, l) in left.iter().enumerate() {
            let c = l - radius * radius * right.get(i).copied().unwrap_or(0.0);
            let mut ratio = 1.0;
            for j in i..7 {
                // C(j, i)/C(6, i), from its value 1 at j = 6 downwards.
                let k = 6 + i - j;
                bernstein[k] += ratio * c;
                ratio *= (k - i) as f64 / k.max(1) as f64;
            }
        }
        isolate(&bernstein, 0.0, 1.0, 0, &mut |t0, t1| {
            let (p, q) = (from + length * t0, from + length * t1);
            let mut f = |rho: f64| self.outside(z, rho, radius);
            let (fp, fq) = (f(p), f(q));
            if (fp > 0.0) != (fq > 0.0) {
                out.push(bracketed_root(p, q, fp, fq, &mut f));
            }
        });
    }

    fn radial(&self, w: f64, tolerance: f64) -> Pair {
        let (s, c) = sincos(w);
        let z = self.unfolded.line(c, s);
        let mut sum = Pair::default();
        let mut start = 1;
        for segment in self.segments(c, s) {
            let from = self.unfolded.level(&z, segment.from);
            let to = self.unfolded.level(&z, segment.to);
            self.part(
                &z,
                segment.escapes,
                from,
                to,
                tolerance,
                &mut start,
                16,
                &mut sum,
            );
        }
        sum
    }

    fn part(
        &self,
        z: &Azimuth,
        escapes: bool,
        from: f64,
        to: f64,
        tolerance: f64,
        start: &mut usize,
        depth: u32,
        sum: &mut Pair,
    ) {
        let mut density = |g: f64| self.density(z, escapes, g);
        let found = escalate(start, tolerance, sum, [0.0; 2], |order| {
            gauss(&self.rules[order], from, to, &mut density)
        });
        match found {
            Some(r) => sum.add(&r),
            None if depth > 0 => {
                let mid = 0.5 * (from + to);
                self.part(z, escapes, from, mid, tolerance, start, depth - 1, sum);
                self.part(z, escapes, mid, to, tolerance, start, depth - 1, sum);
            }
            None => {
                let (value, error) = gauss(&self.rules[ORDERS.len() - 1], from, to, &mut density);
                sum.add(&Pair { value, error });
            }
        }
    }

    fn density(&self, z: &Azimuth, escapes: bool, g: f64) -> [f64; 2] {
        let u = self.unfolded;
        let (sin_g, cos_g) = sincos(g);
        let (half, s) = u.spread(z, sin_g, cos_g);
        let rho = u.radius(z, sin_g, half, s);
        let (w, f) = u.weight(z, rho, s);
        let distance = match self.escape {
            Some(d) if escapes => d,
            _ => {
                let h = (u.height[0] + z.slope * rho).max(0.0);
                let t = u.b - z.kappa * rho;
                sqrt(t * t + rho * rho) * h / (self.image_height - h)
            }
        };
        let phi = self.kernel_at(g, distance);
        [phi * w, phi * phi * w * f]
    }

    fn kernel_at(&self, g: f64, d: f64) -> f64 {
        let r = self.radius;
        match self.kernel {
            Kernel::Epanechnikov => {
                let alpha = libm::atan2(r, d);
                let t = g / alpha;
                (epanechnikov_height(alpha) * (1.0 - t * t)).max(0.0)
            }
            Kernel::VonMisesFisher => {
                let (k, n) = von_mises_fisher(libm::atan2(r, d));
                let s = libm::sin(0.5 * g);
                n * libm::exp(-2.0 * k * s * s)
            }
            _ => {
                // 1 − cos α = r²/(q(q + d)) with q = √(d² + r²): no cancellation.
                let q = libm::hypot(d, r);
                q * (q + d) / (2.0 * PI * r * r)
            }
        }
    }
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut p = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            p[i + j] += x * y;
        }
    }
    p
}

/// Calls `found` with brackets of the simple roots in (0, 1) of a polynomial in Bernstein form: one change of sign among
/// the coefficients is one root, none is none, more are split (de Casteljau).
fn isolate(b: &[f64; 7], t0: f64, t1: f64, depth: u32, found: &mut impl FnMut(f64, f64)) {
    let mut changes = 0;
    let mut last = 0.0;
    for &c in b {
        if c != 0.0 {
            if last * c < 0.0 || (last < 0.0) != (c < 0.0) && last != 0.0 {
                changes += 1;
            }
            last = c;
        }
    }
    if changes == 0 {
        return;
    }
    if changes == 1 {
        found(t0, t1);
        return;
    }
    if depth == 48 {
        return;
    }
    let (mut left, mut right, mut work) = ([0.0; 7], [0.0; 7], *b);
    for level in 0..7 {
        left[level] = work[0];
        right[6 - level] = work[6 - level];
        for i in 0..6 - level {
            work[i] = 0.5 * (work[i] + work[i + 1]);
        }
    }
    let mid = 0.5 * (t0 + t1);
    isolate(&left, t0, mid, depth + 1, found);
    isolate(&right, mid, t1, depth + 1, found);
}
