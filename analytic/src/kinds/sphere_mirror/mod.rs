//! A spherical mirror over a horizontal receiver that faces up: a concave cap or a convex ball.
//!
//! The mirror is the part n · axis ≥ `cap_cos_min` of the sphere with centre c and radius a, n the outward normal. A
//! mirror point reflects the light to x if it solves Alhazen's problem ([`circle`]) in the plane of c, light and x, with
//! both legs on the reflecting side. With r1, r2 the lengths of the legs, i the incidence angle, and σ = 1 for a concave,
//! -1 for a convex mirror,
//!
//! ```text
//! E = I R cos θ_x/|J_t J_s|,    J_t = r1 + r2 - 2σ r1 r2/(a cos i),    J_s = r1 + r2 - 2σ r1 r2 cos i/a,
//! ```
//!
//! and for parallel light E = E0 R cos θ_x/|(1 - 2σ r2/(a cos i))(1 - 2σ r2 cos i/a)| (theory §0.2, blocks E and F). In
//! units of a, g' = ∓ cos i J_t at a root, and |s × b| = sin i |J_s| (derived here): the second form loses nothing next to
//! the axis through c and light, where J_s = 0 and a whole ring of rays meets.
//!
//! What blocks is the mirror itself, from both sides: a leg that meets the cap a second time carries no light. Receiver,
//! light and camera block nothing; the receiver takes light from above only.
//!
//! **Accuracy**: `Root::conditioning` times a few units of rounding. It grows like the inverse of the distance to the fold
//! J_t = 0 and to the axis.

mod circle;
mod conditioning;
mod eye;
mod fold;
mod visibility;

pub use eye::Seen;
pub use fold::SphereCaustic;

use crate::kinds::Estimate;
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};
use circle::Alhazen;
use conditioning::Lengths;

/// The reflecting side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Reflects inside.
    Concave,
    /// Reflects outside.
    Convex,
}

/// What lights the mirror.
#[derive(Clone, Copy, Debug)]
pub enum Light<S> {
    /// An isotropic point light.
    Point {
        /// Position [m].
        position: Vec3<S>,
        /// Radiant intensity I [W/sr].
        intensity: S,
    },
    /// Parallel light.
    Beam {
        /// Unit direction of propagation.
        direction: Vec3<S>,
        /// Irradiance on a plane perpendicular to it, E0 [W/m²].
        irradiance: S,
    },
}

/// A spherical mirror with its light and receiver.
#[derive(Clone, Copy, Debug)]
pub struct SphereMirror<S> {
    /// Centre c [m].
    pub centre: Vec3<S>,
    /// Radius a [m].
    pub radius: S,
    /// The reflecting side.
    pub side: Side,
    /// Unit vector from the centre to the middle of the cap.
    pub cap_axis: Vec3<S>,
    /// Cosine of the cap's half-angle, -1 for the whole sphere.
    pub cap_cos_min: S,
    /// Specular reflectance R.
    pub reflectance: S,
    /// The light.
    pub light: Light<S>,
    /// Height of the receiver [m].
    pub receiver_z: S,
}

/// A mirror point that reflects the light to a receiver point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// The mirror point [m].
    pub specular_point: Vec3<S>,
    /// J_t in the plane of incidence [m], without unit for parallel light; zero on the fold.
    pub tangential: S,
    /// J_s across it, likewise; zero on the axis through centre and light.
    pub sagittal: S,
    /// Irradiance of the receiver [W/m²].
    pub irradiance: S,
    /// Upper bound of the relative change of the irradiance per relative change of the coordinates.
    pub conditioning: S,
    /// By how much all conditions of light and visibility are met, in units of the radius; negative: dark.
    pub margin: S,
    /// What rounding can change in `margin`.
    pub uncertainty: S,
    /// Rounding cannot tell this root from none: the point is on a fold, and the irradiance has no bound.
    pub touching: bool,
}

/// Lengths in units of the radius, relative to the centre.
#[derive(Clone, Copy, Debug)]
struct Setting<S> {
    /// The light, or the unit vector towards a light at infinity.
    source: Vec3<S>,
    far: bool,
    /// The receiver point.
    receiver: Vec3<S>,
}

impl<S: Scalar> SphereMirror<S> {
    fn scaled(&self, point: Vec3<S>) -> Vec3<S> {
        (point - self.centre) * (S::ONE / self.radius)
    }

    fn setting(&self, x: Vec3<S>) -> Setting<S> {
        let (source, far) = match self.light {
            Light::Point { position, .. } => (self.scaled(position), false),
            Light::Beam { direction, .. } => (-direction, true),
        };
        Setting {
            source,
            far,
            receiver: self.scaled(x),
        }
    }

    /// σ: 1 for a concave mirror, -1 for a convex one.
    fn sign(&self) -> S {
        match self.side {
            Side::Concave => S::ONE,
            Side::Convex => -S::ONE,
        }
    }

    /// Size of the coordinates that all lengths are differences of [m].
    pub fn scale(&self, x: Vec3<S>) -> S {
        let light = match self.light {
            Light::Point { position, .. } => position.length(),
            Light::Beam { .. } => S::ZERO,
        };
        self.centre.length() + self.radius + x.length() + light
    }

    /// Visits every mirror point of the whole sphere that reflects the light to `x` [m] above it and with both legs on the
    /// reflecting side; `Root::margin` says whether the cap is there and nothing is in the way.
    pub fn for_each_root(&self, x: Vec3<S>, mut visit: impl FnMut(Root<S>)) {
        let setting = self.setting(x);
        let Setting {
            source,
            far,
            receiver,
        } = setting;
        let (from_source, from_receiver) = (source.length(), receiver.length());
        let (base, reach) = if from_source > S::ZERO {
            (source, from_source)
        } else {
            (receiver, from_receiver)
        };
        if !(reach > S::ZERO) {
            return;
        }
        let e1 = base * (S::ONE / reach);
        let side = e1.cross(receiver);
        let across = side.length();
        let e2 = if across > S::EPSILON * S::from_f64(4.0) * from_receiver {
            side.cross(e1).normalized()
        } else {
            self.any_plane(e1)
        };
        let b = (receiver.dot(e1), across);
        let s = (from_source, S::ZERO);
        Alhazen::new(s, b, far).for_each_root(|(cosine, sine), touching| {
            let normal = e1 * cosine + e2 * sine;
            if let Some(root) = self.root(x, &setting, (cosine, sine), (s, b), (e1, normal)) {
                visit(Root { touching, ..root });
            }
        });
    }

    /// A unit vector perpendicular to `e1`, towards the middle of the cap as far as possible: where a whole ring of mirror
    /// points reflects to one receiver point, this plane holds the points of the ring nearest to that middle.
    fn any_plane(&self, e1: Vec3<S>) -> Vec3<S> {
        let off = |axis: Vec3<S>| axis - e1 * axis.dot(e1);
        let mut best = off(self.cap_axis);
        if !(best.length() > S::from_f64(1e-6)) {
            let x_is_closer = e1.x.abs() > e1.y.abs();
            best = off(if x_is_closer {
                vec3(S::ZERO, S::ONE, S::ZERO)
            } else {
                vec3(S::ONE, S::ZERO, S::ZERO)
            });
        }
        // A short difference is not yet perpendicular to rounding.
        off(best.normalized()).normalized()
    }

    /// The root at a mirror point that solves the plane problem; `None` if a leg is on the other side.
    fn root(
        &self,
        x: Vec3<S>,
        setting: &Setting<S>,
        (cosine, sine): (S, S),
        (s, b): ((S, S), (S, S)),
        (e1, normal): (Vec3<S>, Vec3<S>),
    ) -> Option<Root<S>> {
        let sigma = self.sign();
        let noise = S::EPSILON * S::from_f64(16.0);
        let to_receiver = (b.0 - cosine, b.1 - sine);
        let r2 = to_receiver.0.hypot(to_receiver.1);
        let toward = |v: (S, S)| -sigma * (v.0 * cosine + v.1 * sine);
        // A source at infinity: all lengths of the first leg are divided out.
        let (r1, first, sum, product) = if setting.far {
            (S::ONE / S::ZERO, toward(s), S::ONE, r2)
        } else {
            let to_source = (s.0 - cosine, s.1 - sine);
            let r1 = to_source.0.hypot(to_source.1);
            (r1, toward(to_source) / r1, r1 + r2, r1 * r2)
        };
        let second = toward(to_receiver) / r2;
        if !(first > S::ZERO && second > S::ZERO && r1 > noise && r2 > noise) {
            return None;
        }
        let cos_i = S::HALF * (first + second);
        let sin_i = (to_receiver.1 * cosine - to_receiver.0 * sine).abs() / r2;
        let tangential = sum - S::TWO * sigma * product / cos_i;
        let cross = (s.0 * b.1 - s.1 * b.0).abs() / sin_i;
        let plain = sum - S::TWO * sigma * product * cos_i;
        let sagittal = if sin_i > S::from_f64(0.125) {
            if plain < S::ZERO { -cross } else { cross }
        } else {
            plain
        };
        let height = normal.z - (self.receiver_z - self.centre.z) / self.radius;
        if !(height > S::ZERO) {
            return None;
        }
        let (strength, unit) = match self.light {
            Light::Point { intensity, .. } => (intensity / self.radius.squared(), self.radius),
            Light::Beam { irradiance, .. } => (irradiance, S::ONE),
        };
        let irradiance =
            strength * self.reflectance * height / (r2 * (tangential * sagittal).abs());
        let lengths = Lengths {
            r1,
            r2,
            sum,
            product,
            cos_i,
            sin_i,
            tangential,
            sagittal,
            height,
        };
        let size = self.scale(x) / self.radius;
        // Rounding moves the mirror point in the plane, at a fold by its square root, and turns it about the axis through
        // centre and light, next to that axis all around. Of the latter the cap notices only what is off that axis.
        let unit_noise = noise * size;
        let along = (unit_noise * lengths.moved()).min(noise.sqrt() * S::TWO);
        let around = (unit_noise * lengths.reach() / sagittal.abs()).min(S::TWO);
        let tilt = self.cap_axis.cross(e1).length() + e1.x.hypot(e1.y);
        Some(Root {
            specular_point: self.centre + normal * self.radius,
            tangential: tangential * unit,
            sagittal: sagittal * unit,
            irradiance,
            conditioning: S::ONE + size * lengths.conditioning(sigma),
            margin: self.margin(setting, normal, height),
            uncertainty: unit_noise + (along + around * tilt) * S::from_f64(3.0),
            touching: false,
        })
    }

    /// Irradiance at the receiver point `x` by one reflection (LSDE) [W/m²]; without a bound if light and point are both at
    /// the centre.
    pub fn caustic(&self, x: Vec3<S>) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let setting = self.setting(x);
        if setting.receiver.length() == S::ZERO && setting.source.length() == S::ZERO {
            // Every mirror point reflects the centre to itself.
            sum.error = S::ONE / S::ZERO;
        }
        self.for_each_root(x, |root| {
            let marginal = root.margin.abs() <= root.uncertainty;
            let lit = root.margin >= S::ZERO;
            if lit {
                sum.add(root.irradiance, root.conditioning);
            }
            if root.touching && (lit || marginal) {
                sum.error = S::ONE / S::ZERO;
            } else if marginal {
                // A shadow edge within rounding: the root may be there or not.
                sum.error += root.irradiance;
            }
        });
        sum
    }

    /// Visits the roots that light `x`.
    pub fn for_each_lit_root(&self, x: Vec3<S>, mut visit: impl FnMut(Root<S>)) {
        self.for_each_root(x, |root| {
            if root.margin >= S::ZERO {
                visit(root);
            }
        });
    }
}
