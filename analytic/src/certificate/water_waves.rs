//! A vertical beam through waves z = H + ζ(x) onto the floor z = 0: all rays to a floor point, counted. Theory block L.
//!
//! Refraction of -z at the slope s, t = d/n + (cos i/n - cos t)N, leans by the tangent τ(s) = s(Q - 1)/(Q + s²),
//! Q = √(n² + (n² - 1)s²): x(u) = u + (H + ζ) τ(ζ'). The derivative dx/du comes with the zeros of x(u) - x, all of which are
//! within (H + Σ|A|) τ(Σ|A k|) of x. Where Σ|A k| τ(Σ|A k|) < 1 no refracted ray meets the surface again.

use crate::certificate::radiometry::{Bundle, Point, transmittance_enclosed};
use crate::certificate::roots::{Jet, isolate};
use crate::certificate::scene::Seen;
use crate::certificate::{Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// Pieces in which the way of a refracted view ray below the surface is followed.
const PIECES: u32 = 256;

/// The waves with beam and floor.
#[derive(Clone, Debug)]
pub struct WaterWaves {
    index: Enclosure,
    depth: Enclosure,
    irradiance: Enclosure,
    /// A, k, p of A cos(kx + p).
    waves: Vec<[Enclosure; 3]>,
    /// Σ|A|.
    height: Enclosure,
    reach: Enclosure,
}

/// Tangent of the refracted ray's lean, and Q.
fn lean<S: Scalar>(n: S, s: S) -> (S, S) {
    let gap = (n - S::ONE) * (n + S::ONE);
    let q = (n.squared() + gap * s.squared()).sqrt();
    (s * (q - S::ONE) / (q + s.squared()), q)
}

impl WaterWaves {
    /// `n`, `mean_depth_H`, `E0`, `waves_A_k_phase`; `None` for waves that may be too steep or reach the floor.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let waves: Vec<_> = (0..)
            .map_while(|i| {
                let entry = |j| p.entry("waves_A_k_phase", &[i, j]);
                Some([entry(0)?, entry(1)?, entry(2)?])
            })
            .collect();
        let (index, depth) = (p.number("n")?, p.number("mean_depth_H")?);
        let total = |f: fn(&[Enclosure; 3]) -> Enclosure| {
            waves.iter().fold(Enclosure::ZERO, |sum, w| sum + f(w))
        };
        let height = total(|[a, _, _]| a.abs());
        let slope = total(|[a, k, _]| (*a * *k).abs());
        let (tau, _) = lean(index, slope);
        let sound = (index - Enclosure::ONE).is_positive()
            && (depth - height).is_positive()
            && (Enclosure::ONE - slope * tau).is_positive();
        let irradiance = p.number("E0")?;
        sound.then(|| WaterWaves {
            index,
            depth,
            irradiance,
            height,
            reach: (depth + height) * tau,
            waves,
        })
    }

    /// ζ and ζ'.
    fn surface(&self, u: Jet) -> (Jet, Jet) {
        let jet = Jet::constant;
        let mut out = (Jet::ZERO, Jet::ZERO);
        for [amplitude, k, phase] in &self.waves {
            let angle = jet(*k) * u + jet(*phase);
            out.0 += jet(*amplitude) * angle.cos();
            out.1 -= jet(*amplitude * *k) * angle.sin();
        }
        out
    }

    /// Where the ray that enters at u lands.
    fn landing(&self, u: Jet) -> Jet {
        let (zeta, slope) = self.surface(u);
        u + (Jet::constant(self.depth) + zeta) * lean(Jet::constant(self.index), slope).0
    }

    /// The refracted light at a floor point; only its x counts.
    pub fn caustic_enclosed(&self, x: Point) -> Bundle {
        let mut bundle = Bundle::default();
        let (from, to) = (x.x - self.reach, x.x + self.reach);
        // A little farther, for still water.
        let room = 1e-3 * self.depth.high();
        let zeros = isolate(from.low() - room, to.high() + room, |u| {
            self.landing(u) - Jet::constant(x.x)
        });
        let one = Enclosure::ONE;
        for u in zeros.simple {
            let stretch = self.landing(Jet::input(u, 0, one)).slopes[0];
            let (_, slope) = self.surface(Jet::constant(u));
            let (_, q) = lean(self.index, slope.value);
            // Both normal components over cos i.
            let t = transmittance_enclosed(one, one, self.index, q);
            bundle.add(self.irradiance * t / stretch.abs(), Lit::Yes);
        }
        for _ in zeros.undecided {
            bundle.total.add_unresolved();
        }
        bundle
    }

    /// The floor point that a camera above the crests sees through the surface.
    pub fn look_enclosed(&self, camera: Point, aim: Point) -> Option<Seen> {
        let (one, n) = (Enclosure::ONE, self.index);
        let ray = aim - camera;
        let down = -ray.z;
        if !down.is_positive() || !(camera.z - self.depth - self.height).is_positive() {
            return None;
        }
        // All places where the ray is on the surface; it meets the first one.
        let above = camera.z - self.depth;
        let (near, far) = ((above - self.height) / down, (above + self.height) / down);
        let jet = Jet::constant;
        let margin = 1e-9 * (1.0 + far.high());
        let zeros = isolate(near.low() - margin, far.high() + margin, |t| {
            let (zeta, _) = self.surface(jet(camera.x) + jet(ray.x) * t);
            jet(above) + jet(ray.z) * t - zeta
        });
        let t = *zeros.simple.first()?;
        if zeros.undecided.iter().any(|z| z.low() <= t.high()) {
            return None;
        }
        let hit = camera + ray * t;
        let (_, slope) = self.surface(jet(hit.x));
        let s = slope.value;
        let d = ray * (one / (ray.x.squared() + ray.y.squared() + ray.z.squared()).sqrt());
        let m = (one + s.squared()).sqrt();
        let cos_in = (s * d.x - d.z) / m;
        let q = (n.squared() - one + cos_in.squared()).sqrt();
        let turn = (cos_in - q) / (n * m);
        let inside = vec3(d.x / n - turn * s, d.y / n, d.z / n + turn);
        let floor = hit - inside * (hit.z / inside.z);
        let t = transmittance_enclosed(one, cos_in, n, q);
        let arrives = Lit::where_positive(cos_in)
            .and(Lit::where_positive(-inside.z))
            .and(self.stays_below(hit, inside));
        Some(Seen {
            weight: t / n.squared(),
            transmittance: Some(t),
            at: vec3(floor.x, floor.y, Enclosure::ZERO),
            arrives,
        })
    }

    /// Whether a ray that starts at the surface certainly does not meet it again before it is below all troughs.
    fn stays_below(&self, hit: Point, inside: Point) -> Lit {
        let jet = Jet::constant;
        // Twice the sum of the amplitudes is the most that it can have to go down.
        let way = Enclosure::TWO * self.height / -inside.z;
        if !way.is_finite() {
            return Lit::Undecided;
        }
        let mut leaving = true;
        for i in 0..PIECES {
            let at = |i: u32| way * (whole_share(i));
            let t = Jet::input(at(i).hull(at(i + 1)), 0, Enclosure::ONE);
            let (zeta, _) = self.surface(jet(hit.x) + jet(inside.x) * t);
            let clearance = jet(self.depth - hit.z) + zeta - jet(inside.z) * t;
            // As long as the clearance has grown from 0 all the way it is positive.
            leaving &= clearance.slopes[0].is_positive();
            if !leaving && !clearance.value.is_positive() {
                return Lit::Undecided;
            }
        }
        Lit::Yes
    }
}

/// The share i/[`PIECES`].
fn whole_share(i: u32) -> Enclosure {
    Enclosure::point(f64::from(i) / f64::from(PIECES))
}
