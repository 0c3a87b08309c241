//! A vertical beam through ripples in several directions: all rays to a floor point, counted in two dimensions.
//!
//! The ray refracted at u lands at x(u) = u + (H + ζ) κ g, g = grad ζ, κ = (Q - 1)/(Q + |g|²), Q = √(n² + (n² - 1)|g|²):
//! the lean of [`crate::certificate::water_waves`] along the gradient. All zeros of f(u) = x(u) - x are within
//! (H + Σ|A|) τ(Σ|A||k|) of x. That square is cut into boxes X, with three tests on each (R. E. Moore, R. B. Kearfott & M. J.
//! Cloud, Introduction to Interval Analysis, SIAM 2009, §8.2):
//!
//! * no zero: 0 is not in f(X), nor in f(m) + f'(X)(X - m);
//! * no zero: Krawczyk's K(X) = m - Y f(m) + (1 - Y f'(X))(X - m), Y an inverse of f'(m), does not meet X;
//! * exactly one zero in the box X⁺ a little larger than X: K(X⁺) is inside of it.
//!
//! Zeros found from neighbouring boxes are the same where one lies in the box in which the other is the only one. A box that
//! is still unknown when rounding ends it is a fold, and the sum is undecided. E = Σ E0 T/|det f'|.

use crate::certificate::Lit;
use crate::certificate::radiometry::{Bundle, transmittance_enclosed};
use crate::certificate::source::Source;
use crate::enclosure::Enclosure;
use crate::gradient::Gradient;
use crate::scalar::Scalar;

type Jet = Gradient<Enclosure, 2>;
type Box2 = [Enclosure; 2];

/// One wave: A, k, p of A cos(k·u + p).
type Wave = (Enclosure, Box2, Enclosure);

/// The rippled water with beam and floor.
#[derive(Clone, Debug)]
pub struct Ripples {
    index: Enclosure,
    depth: Enclosure,
    irradiance: Enclosure,
    waves: Vec<Wave>,
    /// No ray lands farther than this from where it enters, in plan.
    reach: f64,
}

/// The most boxes that are looked at for one point; the rest is undecided.
const MOST_BOXES: u32 = 200_000;

/// No box is narrower than this times the size of the search.
const NARROWEST: f64 = 1e-10;

/// A zero, and a box in which there is no other one.
struct Zero {
    at: Box2,
    alone: Box2,
}

fn inside(inner: &Box2, outer: &Box2) -> bool {
    (0..2).all(|k| outer[k].low() < inner[k].low() && inner[k].high() < outer[k].high())
}

fn meeting(a: &Box2, b: &Box2) -> Option<Box2> {
    Some([a[0].intersection(b[0])?, a[1].intersection(b[1])?])
}

impl Ripples {
    /// `water.surface_z`, `water.index`, `light.irradiance` and, for i = 0, 1, ..., `waves.i.amplitude`,
    /// `waves.i.wave_vector`, `waves.i.phase`; `None` for waves that may be too steep or reach the floor.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let mut waves: Vec<Wave> = vec![];
        while let Some(amplitude) = p.number(&format!("waves.{}.amplitude", waves.len())) {
            let key = |name: &str| format!("waves.{}.{name}", waves.len());
            let k = key("wave_vector");
            let vector = [p.entry(&k, &[0])?, p.entry(&k, &[1])?];
            waves.push((amplitude, vector, p.number(&key("phase"))?));
        }
        let (index, depth) = (p.number("water.index")?, p.number("water.surface_z")?);
        let (mut height, mut slope) = (Enclosure::ZERO, Enclosure::ZERO);
        for (a, k, _) in &waves {
            height += a.abs();
            slope += a.abs() * (k[0].squared() + k[1].squared()).sqrt();
        }
        let q = (index.squared() + (index.squared() - Enclosure::ONE) * slope.squared()).sqrt();
        let tau = slope * (q - Enclosure::ONE) / (q + slope.squared());
        let sound = (index - Enclosure::ONE).is_positive()
            && (depth - height).is_positive()
            && (Enclosure::ONE - slope * tau).is_positive();
        sound.then_some(Ripples {
            index,
            depth,
            irradiance: p.number("light.irradiance")?,
            waves,
            reach: ((depth + height) * tau).high(),
        })
    }

    /// Where the ray that enters at u lands, and Q.
    fn landing<S: Scalar>(&self, lift: impl Fn(Enclosure) -> S, u: [S; 2]) -> ([S; 2], S) {
        let (mut height, mut g) = (lift(self.depth), [S::ZERO; 2]);
        for (amplitude, k, phase) in &self.waves {
            let (kx, ky) = (lift(k[0]), lift(k[1]));
            let angle = kx * u[0] + ky * u[1] + lift(*phase);
            height += lift(*amplitude) * angle.cos();
            let steep = lift(*amplitude) * angle.sin();
            g[0] -= kx * steep;
            g[1] -= ky * steep;
        }
        let (n, w) = (lift(self.index), g[0].squared() + g[1].squared());
        let q = (n.squared() + (n - S::ONE) * (n + S::ONE) * w).sqrt();
        let lean = height * (q - S::ONE) / (q + w);
        ([u[0] + lean * g[0], u[1] + lean * g[1]], q)
    }

    /// f and f' over a box.
    fn over(&self, x: &Box2, at: &Box2) -> (Box2, [Box2; 2]) {
        let input = |k: usize| Jet::input(at[k], k, Enclosure::ONE);
        let (landed, _) = self.landing(Jet::constant, [input(0), input(1)]);
        let value = [landed[0].value - x[0], landed[1].value - x[1]];
        (value, [landed[0].slopes, landed[1].slopes])
    }

    /// f at a point.
    fn value(&self, x: &Box2, at: &Box2) -> Box2 {
        let (landed, _) = self.landing(|v| v, *at);
        [landed[0] - x[0], landed[1] - x[1]]
    }

    /// K(X), and the place that the mean value form leaves of X: `None` if it has no zero.
    fn krawczyk(&self, x: &Box2, at: &Box2) -> Option<Option<Box2>> {
        let (value, slope) = self.over(x, at);
        if !(value[0].may_vanish() && value[1].may_vanish()) {
            return None;
        }
        let middle = at.map(|c| Enclosure::point(c.middle()));
        let there = self.value(x, &middle);
        let off = [at[0] - middle[0], at[1] - middle[1]];
        for k in 0..2 {
            if !(there[k] + slope[k][0] * off[0] + slope[k][1] * off[1]).may_vanish() {
                return None;
            }
        }
        // Any Y will do: that of the middle of f'(X).
        let m = slope.map(|row| row.map(Enclosure::middle));
        let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        if !(f64::abs(determinant) > 1e-12) || !determinant.is_finite() {
            return Some(None);
        }
        let y = [
            [m[1][1] / determinant, -m[0][1] / determinant],
            [-m[1][0] / determinant, m[0][0] / determinant],
        ]
        .map(|row| row.map(Enclosure::point));
        let one = |same: bool| {
            if same {
                Enclosure::ONE
            } else {
                Enclosure::ZERO
            }
        };
        let image = |i: usize| {
            let rest = |j: usize| one(i == j) - (y[i][0] * slope[0][j] + y[i][1] * slope[1][j]);
            middle[i] - (y[i][0] * there[0] + y[i][1] * there[1])
                + rest(0) * off[0]
                + rest(1) * off[1]
        };
        Some(Some([image(0), image(1)]))
    }

    /// All light at the floor point (x, y).
    pub fn caustic_enclosed(&self, x: Enclosure, y: Enclosure) -> Bundle {
        let mut bundle = Bundle::default();
        let x = [x, y];
        let around = |c: Enclosure| {
            let room = 1e-9 * (1.0 + self.reach + c.high().abs());
            Enclosure::new(c.low() - self.reach - room, c.high() + self.reach + room)
        };
        let (zeros, unresolved) = self.isolate(&x, [around(x[0]), around(x[1])]);
        for zero in &zeros {
            let (_, slope) = self.over(&x, &zero.at);
            let determinant = slope[0][0] * slope[1][1] - slope[0][1] * slope[1][0];
            let (_, q) = self.landing(|v| v, zero.at);
            let one = Enclosure::ONE;
            // Both normal components over cos i.
            let t = transmittance_enclosed(one, one, self.index, q);
            bundle.add(self.irradiance * t / determinant.abs(), Lit::Yes);
        }
        if unresolved {
            bundle.total.add_unresolved();
        }
        bundle
    }

    /// All zeros in a box, and whether any part of it is undecided.
    fn isolate(&self, x: &Box2, whole: Box2) -> (Vec<Zero>, bool) {
        let mut zeros: Vec<Zero> = vec![];
        let mut left = vec![whole];
        let (mut boxes, mut unresolved) = (0, false);
        let narrowest = NARROWEST * (1.0 + self.reach);
        while let Some(part) = left.pop() {
            boxes += 1;
            let widths = part.map(|c| c.high() - c.low());
            let width = widths[0].max(widths[1]);
            let room = 0.06 * width;
            let larger = part.map(|c| Enclosure::new(c.low() - room, c.high() + room));
            match self.krawczyk(x, &larger) {
                None => continue,
                Some(Some(image)) => {
                    if inside(&image, &larger) {
                        match self.keep(x, &mut zeros, image, larger) {
                            Some(()) => {}
                            None => unresolved = true,
                        }
                        continue;
                    }
                    if meeting(&image, &part).is_none() {
                        continue;
                    }
                }
                Some(None) => {}
            }
            if width <= narrowest || boxes >= MOST_BOXES {
                unresolved = true;
                continue;
            }
            let k = usize::from(widths[1] > widths[0]);
            let cut = part[k].low() + 0.4871 * widths[k];
            for half in [
                Enclosure::new(part[k].low(), cut),
                Enclosure::new(cut, part[k].high()),
            ] {
                let mut next = part;
                next[k] = half;
                left.push(next);
            }
        }
        (zeros, unresolved)
    }

    /// Narrows a zero and keeps it, unless it is one that is known; `None` if that cannot be told.
    fn keep(&self, x: &Box2, zeros: &mut Vec<Zero>, image: Box2, alone: Box2) -> Option<()> {
        let mut at = image;
        for _ in 0..40 {
            let narrower = self.krawczyk(x, &at)??;
            let Some(next) = meeting(&narrower, &at) else {
                break;
            };
            let gain = (0..2).any(|k| next[k].width() < 0.9 * at[k].width());
            at = next;
            if !gain {
                break;
            }
        }
        for known in zeros.iter() {
            if meeting(&known.at, &at).is_none() {
                continue;
            }
            let same = inside(&at, &known.alone) || inside(&known.at, &alone);
            return same.then_some(());
        }
        zeros.push(Zero { at, alone });
        Some(())
    }
}
