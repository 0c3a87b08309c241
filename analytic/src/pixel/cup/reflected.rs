//! The reflected caustic: the floor's caustic seen in the wall.
//!
//! In a vertical plane through the pinhole the floor points seen in the wall lie on a straight line (wall point w, direction
//! d, normal m). The caustic's irradiance along that line has folds, but as an integral over the light's lines φ it has
//! none: line φ crosses it at one point, and
//!
//! ```text
//! ∫ E g ds = ∫ E₀ R sin ε a cos φ g(s(φ)) / |m·e^{2iφ}| dφ
//! ```
//!
//! over the φ whose crossing lies on the visible part and within the light's reach. The ends of those intervals are roots
//! of trigonometric polynomials. The outer integral over the azimuth is analytic except where a fold, the end of the
//! light's reach or an end of the arc crosses the border of what is seen, and where the line touches a fold.

use libm::{atan2, cos, exp, log, sin};

use crate::camera::Bounded;
use crate::pixel::cup::CupImage;
use crate::pixel::cup::area::WallSlice;
use crate::pixel::cup::caustic::angles;
use crate::pixel::events::{Probe, first_false, search};
use crate::pixel::fan::{Break, Fan, Singularity, integrate_between, sort};
use crate::pixel::floor_polygon::FloorPolygon;
use crate::pixel::quartic::Few;

/// Functions whose sign changes on the border of what is seen are events: four at either end.
const FUNCTIONS: usize = 8;
/// Rounding of an angle, and of the sine of one.
const ROUNDING: f64 = 4e-16;
impl CupImage {
    /// Zero on the nephroid (x² + y² - a²/4)³ = 108 (a/4)⁴ y².
    fn nephroid(&self, [x, y]: [f64; 2]) -> f64 {
        let (x, y) = (x / self.radius, y / self.radius);
        let d = x * x + y * y - 0.25;
        d * d * d - 0.421_875 * y * y
    }

    /// Zero on the ends of the light's segments a e^{iφ} - b e^{2iφ}: with x shifted by b they are (a - 2b cos φ) e^{iφ}, a
    /// limaçon.
    fn end_curve(&self, [x, y]: [f64; 2]) -> f64 {
        let b = self.reach / self.radius;
        let (x, y) = (x / self.radius - b, y / self.radius);
        let r2 = x * x + y * y;
        let s = r2 + 2.0 * b * x;
        s * s - r2
    }

    /// Zero on the light's line from an end of the arc.
    fn end_line(&self, [x, y]: [f64; 2], t: f64) -> f64 {
        let ([_, s], [c2, s2], _) = angles(t);
        (y * c2 - x * s2) / self.radius + s
    }

    fn probe(&self, piece: &FloorPolygon, fan: &Fan, azimuth: f64) -> Option<Probe<FUNCTIONS>> {
        let s = self.wall_slice(piece, fan.direction(azimuth))?;
        let mut values = [0.0; FUNCTIONS];
        for (k, tau) in s.range.into_iter().enumerate() {
            let x = s.point(tau);
            values[4 * k] = self.nephroid(x);
            values[4 * k + 1] = self.end_curve(x);
            values[4 * k + 2] = self.end_line(x, self.limit);
            values[4 * k + 3] = self.end_line(x, -self.limit);
        }
        Some(Probe {
            labels: s.labels,
            values,
        })
    }

    /// The fan's break points, and those where what cuts the slice changes or where the caustic's curves cross the border
    /// of what is seen.
    pub(super) fn wall_breaks(&self, piece: &FloorPolygon, fan: &Fan) -> Vec<Break> {
        let basic = fan.sorted();
        let mut breaks = basic.clone();
        let at_end = [
            Singularity::Root,
            Singularity::Kink,
            Singularity::Kink,
            Singularity::Kink,
        ];
        let kinds: [Singularity; FUNCTIONS] = core::array::from_fn(|k| at_end[k % 4]);
        for pair in basic.windows(2) {
            let range = (pair[0].azimuth, pair[1].azimuth);
            search(range, kinds, |x| self.probe(piece, fan, x), &mut breaks);
        }
        sort(&mut breaks);
        breaks
    }

    /// Radiance × film area of the caustic seen in the wall.
    pub(super) fn reflected_caustic(
        &self,
        piece: &FloorPolygon,
        fan: &Fan,
        breaks: &[Break],
        tolerance: f64,
    ) -> Bounded {
        let share = tolerance / breaks.len() as f64;
        let mut sum = Bounded::default();
        for pair in breaks.windows(2) {
            let part = self.between(piece, fan, pair[0], pair[1], share, 6);
            sum.value += part.value;
            sum.error += part.error;
        }
        sum
    }

    /// One interval of azimuths; split where the structure of the slices changes.
    fn between(
        &self,
        piece: &FloorPolygon,
        fan: &Fan,
        a: Break,
        b: Break,
        tolerance: f64,
        splits: u32,
    ) -> Bounded {
        let length = b.azimuth - a.azimuth;
        if !(length > 0.0) {
            return Bounded::default();
        }
        let structure = |azimuth: f64| {
            let slice = self.wall_slice(piece, fan.direction(azimuth));
            slice.map_or(0, |s| self.events(&s).1)
        };
        if splits > 0 {
            let at = [1e-6, 0.5, 1.0 - 1e-6].map(|x| a.azimuth + length * x);
            for pair in at.windows(2) {
                let left = structure(pair[0]);
                if left != structure(pair[1]) {
                    let azimuth = first_false(pair[0], pair[1], |x| structure(x) == left);
                    let middle = Break {
                        azimuth,
                        kind: Singularity::Logarithm,
                    };
                    let half = 0.5 * tolerance;
                    let left = self.between(piece, fan, a, middle, half, splits - 1);
                    let right = self.between(piece, fan, middle, b, half, splits - 1);
                    return Bounded {
                        value: left.value + right.value,
                        error: left.error + right.error,
                    };
                }
            }
        }
        let inner = 0.1 * tolerance / length;
        let mut slice = |azimuth: f64| {
            let e = fan.direction(azimuth);
            self.wall_slice(piece, e)
                .map_or(Bounded::default(), |s| self.flux(&s, e, inner))
        };
        integrate_between(&self.line, a, b, tolerance, &mut slice)
    }

    /// All t at which the set of light lines that cross the visible part of a slice may change, and a number that stands
    /// for the structure: which events bound the intervals that do.
    fn events(&self, slice: &WallSlice) -> (Few, u64) {
        let d = slice.along;
        let m = [-d[1], d[0]];
        let k = m[0] * slice.wall[0] + m[1] * slice.wall[1];
        let mut cuts = Few::default();
        cuts.push(-self.limit, 1);
        cuts.push(self.limit, 1);
        for (x, label) in [
            (slice.point(slice.range[0]), 2),
            (slice.point(slice.range[1]), 3),
        ] {
            self.lines_through(x).roots(self.limit, label, &mut cuts);
        }
        self.ends_on(m, k).roots(self.limit, 4, &mut cuts);
        // Where the slice's line meets the circle: at the wall point itself, and at the other end of the chord.
        let chord = -2.0 * (slice.wall[0] * d[0] + slice.wall[1] * d[1]);
        let other = slice.point(chord);
        // e^{2iφ} = ±d: half angles with positive cosine.
        let half = [
            (0.5 * (1.0 + d[0])).max(0.0).sqrt(),
            (0.5 * (1.0 - d[0])).max(0.0).sqrt(),
        ];
        let sign = if d[1] < 0.0 { -1.0 } else { 1.0 };
        for (t, label) in [
            (slice.wall[1] / (self.radius + slice.wall[0]), 5),
            (other[1] / (self.radius + other[0]), 5),
            (sign * half[1] / (1.0 + half[0]), 6),
            (-sign * half[0] / (1.0 + half[1]), 6),
        ] {
            if t.abs() < self.limit {
                cuts.push(t, label);
            }
        }
        cuts.sort();
        let mut structure = 7;
        for pair in cuts.as_slice().windows(2) {
            if self.crosses(slice, 0.5 * (pair[0].0 + pair[1].0)) {
                for label in [pair[0].1, pair[1].1] {
                    structure = (structure * 8 + u64::from(label)) % 1_000_000_007;
                }
            }
        }
        (cuts, structure)
    }

    /// Where light line t crosses the slice's line: 1/|m·e^{2iφ}|, plan distance s and the light's τ.
    #[inline]
    fn crossing(&self, slice: &WallSlice, t: f64) -> (f64, f64, f64) {
        let ([c, s], [c2, s2], _) = angles(t);
        let d = slice.along;
        let from = [
            self.radius * c - slice.wall[0],
            self.radius * s - slice.wall[1],
        ];
        // Both from cross products: from + wall - τ e₂ = wall + s d.
        let sine = d[0] * s2 - d[1] * c2;
        let tau = (d[0] * from[1] - d[1] * from[0]) / sine;
        let along = (from[0] * s2 - from[1] * c2) / sine;
        (1.0 / sine.abs(), along, tau)
    }

    fn crosses(&self, slice: &WallSlice, t: f64) -> bool {
        let (_, s, tau) = self.crossing(slice, t);
        s > slice.range[0] && s < slice.range[1] && tau > 0.0 && tau < self.reach
    }

    /// Caustic radiance × film area per azimuth.
    fn flux(&self, slice: &WallSlice, e: [f64; 2], tolerance: f64) -> Bounded {
        let (cuts, _) = self.events(slice);
        let strength = self.direct * self.reflectance * self.reflectance * self.radius;
        let nadir = self.projection.nadir;
        // cos φ, and the film's weight where line φ crosses.
        let weight = |c: f64, along: f64| {
            let r = slice.foot + along;
            let depth = self
                .projection
                .depth([nadir[0] + r * e[0], nadir[1] + r * e[1]]);
            strength * c * r * self.projection.density(depth)
        };
        let mut sum = Bounded::default();
        for pair in cuts.as_slice().windows(2) {
            let (low, high) = (pair[0].0, pair[1].0);
            if !self.crosses(slice, 0.5 * (low + high)) {
                continue;
            }
            let (steep, along, _) = self.crossing(slice, low);
            let (steeper, further, _) = self.crossing(slice, high);
            // The ends themselves are known to rounding.
            sum.error +=
                ROUNDING * (steep * weight(1.0, along) + steeper * weight(1.0, further)).abs();
            let part = if steep.max(steeper) < 2.0 * steep.min(steeper) {
                let mut integrand = |t: f64| {
                    let ([c, _], _, dphi) = angles(t);
                    let (inverse, along, _) = self.crossing(slice, t);
                    let value = dphi * inverse * weight(c, along);
                    Bounded {
                        value,
                        error: ROUNDING * inverse * value.abs(),
                    }
                };
                self.line.integrate(low, high, tolerance, &mut integrand)
            } else {
                self.near_parallel(slice, [low, high], tolerance, weight)
            };
            sum.value += part.value;
            sum.error += part.error;
        }
        sum
    }

    /// The same near the φ₀ whose line is parallel to the slice's: 1/|sin 2(φ - φ₀)| is the derivative of ½ ln |tan(φ - φ₀)|,
    /// which becomes the variable.
    fn near_parallel(
        &self,
        slice: &WallSlice,
        [low, high]: [f64; 2],
        tolerance: f64,
        weight: impl Fn(f64, f64) -> f64,
    ) -> Bounded {
        let d = slice.along;
        let phi0 = 0.5 * atan2(d[1], d[0]);
        let (c0, s0) = (cos(phi0), sin(phi0));
        let tangent = |t: f64| {
            let ([c, s], _, _) = angles(t);
            (s * c0 - c * s0) / (c * c0 + s * s0)
        };
        let ends = [tangent(low), tangent(high)];
        let side = (ends[0] + ends[1]).signum();
        let [y0, y1] = ends.map(|x| 0.5 * log(x.abs()));
        if !(y0.is_finite() && y1.is_finite()) {
            return Bounded::default();
        }
        let mut integrand = |y: f64| {
            let tan = side * exp(2.0 * y);
            let cx = 1.0 / (1.0 + tan * tan).sqrt();
            let sx = tan * cx;
            let (c, s) = (c0 * cx - s0 * sx, s0 * cx + c0 * sx);
            // φ and φ + π are the same line of directions, but not the same wall point.
            let (c, s) = if c < 0.0 { (-c, -s) } else { (c, s) };
            let (inverse, along, _) = self.crossing(slice, s / (1.0 + c));
            let value = weight(c, along);
            Bounded {
                value,
                error: ROUNDING * inverse * value.abs(),
            }
        };
        self.line
            .integrate(y0.min(y1), y0.max(y1), tolerance, &mut integrand)
    }
}

impl WallSlice {
    /// The floor point at plan distance `s` from the wall.
    fn point(&self, s: f64) -> [f64; 2] {
        [
            self.wall[0] + s * self.along[0],
            self.wall[1] + s * self.along[1],
        ]
    }
}
