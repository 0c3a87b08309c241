//! Coordinates about the specular root, in which deflections are explicit.
//!
//! Reflect the light: y' is its image, and the segment from x to y' meets the mirror's plane at the specular root s*, at
//! distance a from x and b from y'. The deflection at a mirror point s is g = π − ∠(x, s, y'). With w the unit vector
//! from x to y', θ the angle of incidence, and s = s* + ρ(e₁ cos ω + e₂ sin ω + κ w), where e₁ ⊥ w lies in the plane of
//! incidence, e₂ = w × e₁ and κ = tan θ cos ω keeps s on the mirror:
//!
//! ```text
//! r₁² = (a + κρ)² + ρ²,   r₂² = (b − κρ)² + ρ²,
//! g = atan(ρ/(a + κρ)) + atan(ρ/(b − κρ)):   tan g = N/D,  N = ρ(a + b),  D = ab + κρ(b − a) − ρ²(1 + κ²)
//! ρ(g) = 2ab sin g / (B + S),   B = (a + b) cos g − κ(b − a) sin g,   S² = B² + 4ab(1 + κ²) sin² g
//! dρ/dg = r₁ r₂ / S,            dA = ρ dρ dω / cos θ
//! ```
//!
//! dρ/dg > 0 always: along every radial line from s* the deflection grows from 0 to π, also near grazing incidence
//! (geometrically: the points that see the segment x y' under at least a given angle form, in each half-plane about it, the
//! segment of a disc, which is convex and contains s* on its border). So g itself is the radial coordinate, the kernel ends at a
//! constant, and nothing has to be searched. Derived here.

use libm::{atan2, sincos, sqrt};

use super::Technique;
use super::clip::Domain;
use super::polar::Chart;
use super::setting::PlanarSetting;
use crate::vector::{Vec3, vec3};

const PI: f64 = core::f64::consts::PI;

/// The unfolded picture for one receiver point in front of the mirror.
#[derive(Clone, Debug)]
pub(super) struct Unfolded {
    /// |x − s*|.
    pub a: f64,
    /// |y' − s*|.
    pub b: f64,
    /// cos θ, θ the angle of incidence at s*.
    pub cos_theta: f64,
    /// tan θ.
    pub tan_theta: f64,
    /// Height of x above the mirror.
    pub p: f64,
    /// Height of y above the mirror.
    pub q: f64,
    /// The specular root.
    pub root: Vec3<f64>,
    frame: [Vec3<f64>; 3],
    /// Height of s* above the receiver's plane, and its derivatives along e₁, e₂ and w.
    pub height: [f64; 4],
    /// R I.
    strength: f64,
    technique: Technique,
    /// The mirror above the receiver's plane.
    pub domain: Domain,
}

/// One azimuth: sine, cosine and what is constant along the radial line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Azimuth {
    /// κ.
    pub kappa: f64,
    /// Change of the height above the receiver's plane with ρ.
    pub slope: f64,
}

impl Unfolded {
    /// `None` if x is not in front of the mirror: nothing arrives there.
    pub fn new(setting: &PlanarSetting, x: Vec3<f64>, technique: Technique) -> Option<Self> {
        let (p, q) = (
            setting.mirror_height(x),
            setting.mirror_height(setting.light),
        );
        if !(p > 0.0 && q > 0.0) {
            return None;
        }
        let axis = setting.image() - x;
        let length = axis.length();
        let w = axis * (1.0 / length);
        let n = setting.mirror_normal;
        let cos_theta = (p + q) / length;
        let a = p * length / (p + q);
        let b = q * length / (p + q);
        // The part of the normal across the ray; its length is sin θ.
        let across = n - w * n.dot(w);
        let sin_theta = across.length();
        let e1 = if sin_theta > 1e-12 {
            let e = across * (1.0 / sin_theta);
            (e - w * e.dot(w)).normalized()
        } else {
            let least = if w.x.abs() < 0.6 {
                vec3(1.0, 0.0, 0.0)
            } else {
                vec3(0.0, 1.0, 0.0)
            };
            (least - w * least.dot(w)).normalized()
        };
        let e2 = w.cross(e1);
        let root = x + w * a;
        let m = setting.receiver_normal;
        let tan_theta = sin_theta / cos_theta;
        let height = [(root - x).dot(m), m.dot(e1), m.dot(e2), m.dot(w)];
        let mut unfolded = Unfolded {
            a,
            b,
            cos_theta,
            tan_theta,
            p,
            q,
            root,
            frame: [e1, e2, w],
            height,
            strength: setting.strength,
            technique,
            domain: Domain::default(),
        };
        unfolded.cut(-m, -m.dot(x));
        for e in &setting.mirror_edges {
            unfolded.cut(e.normal, e.offset);
        }
        Some(unfolded)
    }

    /// The trace of a half-space in the mirror's plane: (n, h) with n·ξ ≤ h in the coordinates (ρ cos ω, ρ sin ω).
    pub fn trace(&self, normal: Vec3<f64>, offset: f64) -> ([f64; 2], f64) {
        let [e1, e2, w] = self.frame;
        let n = [
            normal.dot(e1) + self.tan_theta * normal.dot(w),
            normal.dot(e2),
        ];
        (n, offset - normal.dot(self.root))
    }

    fn cut(&mut self, normal: Vec3<f64>, offset: f64) {
        let (n, h) = self.trace(normal, offset);
        self.domain.cut(n, h);
    }

    /// N and D of tan g = N/D.
    #[inline(always)]
    pub fn tangent(&self, z: &Azimuth, rho: f64) -> (f64, f64) {
        let (a, b, k) = (self.a, self.b, z.kappa);
        (
            rho * (a + b),
            a * b + k * rho * (b - a) - rho * rho * (1.0 + k * k),
        )
    }

    /// S of the deflection g.
    #[inline(always)]
    pub fn spread(&self, z: &Azimuth, sin_g: f64, cos_g: f64) -> (f64, f64) {
        let (a, b, k) = (self.a, self.b, z.kappa);
        let half = (a + b) * cos_g - k * (b - a) * sin_g;
        let s = sqrt(half * half + 4.0 * a * b * (1.0 + k * k) * sin_g * sin_g);
        (half, s)
    }

    /// ρ(g).
    #[inline(always)]
    pub fn radius(&self, z: &Azimuth, sin_g: f64, half: f64, s: f64) -> f64 {
        if half >= 0.0 {
            2.0 * self.a * self.b * sin_g / (half + s)
        } else {
            (s - half) / (2.0 * (1.0 + z.kappa * z.kappa) * sin_g)
        }
    }

    /// The value of one sample at s*, without the kernel.
    pub fn sample_at_root(&self) -> f64 {
        let z = Azimuth {
            kappa: 0.0,
            slope: 0.0,
        };
        self.weight(&z, 0.0, self.a + self.b).1
    }

    /// The mean's density per dω dg without the kernel, and the value of one sample without the kernel.
    #[inline(always)]
    pub fn weight(&self, z: &Azimuth, rho: f64, s: f64) -> (f64, f64) {
        let (t, u) = (self.a + z.kappa * rho, self.b - z.kappa * rho);
        let (r1s, r2s) = (t * t + rho * rho, u * u + rho * rho);
        let (r1, r2) = (sqrt(r1s), sqrt(r2s));
        let h = (self.height[0] + z.slope * rho).max(0.0);
        let common = self.strength * h * rho / (s * self.cos_theta);
        match self.technique {
            Technique::Camera => (common * self.p / (r1s * r1 * r2), PI * self.strength / r2s),
            Technique::Symmetric => (
                common * sqrt(self.p * self.q / (r1 * r2)) / (r1s * r2),
                PI * self.strength * sqrt(self.q * r1 / (self.p * r2)) / r2s,
            ),
            Technique::Light | Technique::Linked | Technique::Merge => (
                common * self.q / (r1s * r2s),
                4.0 * PI * self.strength * h / (r1s * r1),
            ),
        }
    }
}

impl Chart for Unfolded {
    type Line = Azimuth;

    #[inline(always)]
    fn line(&self, c: f64, s: f64) -> Azimuth {
        let [_, h1, h2, hw] = self.height;
        let kappa = self.tan_theta * c;
        Azimuth {
            kappa,
            slope: h1 * c + h2 * s + hw * kappa,
        }
    }

    fn level(&self, z: &Azimuth, rho: f64) -> f64 {
        if rho == f64::INFINITY {
            return PI;
        }
        let (n, d) = self.tangent(z, rho);
        atan2(n, d)
    }

    #[inline(always)]
    fn density(&self, z: &Azimuth, g: f64) -> [f64; 2] {
        let (sin_g, cos_g) = sincos(g);
        let (half, s) = self.spread(z, sin_g, cos_g);
        let (w, f) = self.weight(z, self.radius(z, sin_g, half, s), s);
        [w, w * f]
    }

    /// With κ(b − a) at its largest and 1 + κ² at its smallest, ρ(g) is largest.
    fn farthest(&self, g: f64) -> f64 {
        let (sin_g, cos_g) = sincos(g);
        let (a, b) = (self.a, self.b);
        let half = (a + b) * cos_g - self.tan_theta * (b - a).abs() * sin_g;
        let s = sqrt(half * half + 4.0 * a * b * sin_g * sin_g);
        if half >= 0.0 {
            2.0 * a * b * sin_g / (half + s)
        } else {
            (s - half) / (2.0 * sin_g)
        }
    }

    fn domain(&self) -> &Domain {
        &self.domain
    }
}
