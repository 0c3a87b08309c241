//! A vertical circular mirror wall on a floor: the coffee cup.
//!
//! The wall is the cylinder of radius a about the z axis, from the floor z = 0 up to a height, over an arc |φ| ≤ half
//! arc or all around; it reflects on its inner side, absorbs on its outer side and occludes from both. The light is a
//! beam along +x that comes down at elevation ε, or a point light inside the circle or on the wall. A vertical wall
//! keeps the vertical component of a direction, so that the plan view is a two-dimensional problem (theory §0.3) and no
//! light returns from floor to floor.
//!
//! Roots are rays of the light that reach a floor point after k bounces; see [`beam`] and [`point_light`] for the
//! formulas. `for_each_root` finds the rays of the whole circle, `for_each_lit_root` those that this wall reflects.
//!
//! Rules for what is lit, all in the order of the light: a closed wall lets the beam in over its rim only (first hit at
//! height z is lit iff z + 2a cos φ tan ε ≥ height); the first hit must be below the rim; every hit must be on the arc;
//! the last leg ends where it would meet the arc again, and goes on outside the circle where it would not.

pub mod beam;
pub mod beam_bundle;
pub mod bundle;
mod circle;
pub mod eye;
pub mod flatland;
pub mod fold;
pub mod point_light;

use libm::cos;

use crate::kinds::{Estimate, rounding_error};
use crate::scalar::Scalar;
use crate::scene::{ArcWall, ClosedWall, CylinderLampScene, DirectionalLight};
use crate::vector::{Vec3, vec3};

pub use beam::Beam;

/// The most bounces that are counted.
pub const MAX_BOUNCES: u32 = 64;

/// The wall: reflecting inside, absorbing outside.
#[derive(Clone, Copy, Debug)]
pub struct Wall<S> {
    /// Radius a [m].
    pub radius: S,
    /// Height of the rim [m]; `None` for a wall without end.
    pub height: Option<S>,
    /// Cosine of the half arc: the wall covers the angles φ with cos φ ≥ this. `None` for a closed wall.
    pub cos_half_arc: Option<S>,
}

impl<S: Scalar> Wall<S> {
    /// Whether the wall stands at the angle with this cosine.
    #[inline(always)]
    pub fn covers(&self, cos_phi: S) -> bool {
        self.cos_half_arc.is_none_or(|limit| cos_phi >= limit)
    }

    /// Whether the wall reaches up to height z (≥ 0).
    #[inline(always)]
    pub fn reaches(&self, z: S) -> bool {
        self.height.is_none_or(|height| z <= height)
    }
}

/// What lights the cup.
#[derive(Clone, Copy, Debug)]
pub enum Light<S> {
    /// Parallel light along +x.
    Beam(Beam<S>),
    /// A point light inside the circle or on the wall, above the floor.
    Point(point_light::Lamp<S>),
}

/// A cup with its light.
#[derive(Clone, Copy, Debug)]
pub struct CylinderCup<S> {
    /// The wall.
    pub wall: Wall<S>,
    /// Specular reflectance R of the wall.
    pub reflectance: S,
    /// The light.
    pub light: Light<S>,
}

/// A ray from the light that reaches a floor point after reflection at the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// cos φ of the first hit a e^{iφ}.
    pub cos_phi: S,
    /// sin φ of the first hit.
    pub sin_phi: S,
    /// cos θ of the plan direction of the last leg.
    pub cos_theta: S,
    /// sin θ of the plan direction of the last leg.
    pub sin_theta: S,
    /// cos i of the incidence angle in plan, the same at every bounce.
    pub cos_incidence: S,
    /// Plan length τ of the last leg [m].
    pub tau: S,
    /// Plan length from the first hit (beam) or from the light (point light) to the floor point [m].
    pub length: S,
    /// Height of the first hit [m].
    pub wall_z: S,
    /// Spread J of neighbouring rays at the point [m]; zero on the caustic, and of opposite sign on its two sides.
    pub spread: S,
    /// Irradiance of the floor [W/m²].
    pub irradiance: S,
    /// Rounding cannot tell this root from none: the point is on a fold, and the irradiance has no bound.
    pub touching: bool,
}

impl<S: Scalar> Root<S> {
    /// Angle φ of the first hit, in (-π, π].
    pub fn phi(&self) -> S {
        self.sin_phi.atan2(self.cos_phi)
    }
}

impl CylinderCup<f64> {
    /// The cup of a catalogue entry.
    pub fn from_entry(light: &DirectionalLight, wall: &ArcWall) -> Self {
        CylinderCup {
            wall: Wall {
                radius: wall.radius,
                height: Some(wall.height),
                cos_half_arc: Some(cos(wall.half_arc_degrees.to_radians())),
            },
            reflectance: wall.reflectance,
            light: Light::Beam(Beam::of(light)),
        }
    }

    /// The closed cup of a catalogue entry.
    pub fn closed(light: &DirectionalLight, wall: &ClosedWall) -> Self {
        CylinderCup {
            wall: Wall {
                radius: wall.radius,
                height: Some(wall.height),
                cos_half_arc: None,
            },
            reflectance: wall.reflectance,
            light: Light::Beam(Beam::of(light)),
        }
    }
}

impl CylinderCup<f64> {
    /// The wall of a catalogue entry with a light inside its circle or on it.
    pub fn with_lamp(scene: &CylinderLampScene) -> Self {
        let (light, wall) = (&scene.light, &scene.wall);
        let [x, y, height] = light.position(wall.radius);
        let half_arc = wall.half_arc_degrees;
        CylinderCup {
            wall: Wall {
                radius: wall.radius,
                height: Some(wall.height),
                cos_half_arc: (half_arc < 180.0).then(|| cos(half_arc.to_radians())),
            },
            reflectance: wall.reflectance,
            light: Light::Point(point_light::Lamp {
                x,
                y,
                height,
                intensity: light.intensity,
            }),
        }
    }
}

impl<S: Scalar> CylinderCup<S> {
    /// Visits every ray that reaches the floor point (x, y) [m] after `bounces` ≥ 1 reflections at the whole circle, of
    /// any height. No allocation; for one bounce of a beam below a microsecond.
    #[inline]
    pub fn for_each_root(&self, x: S, y: S, bounces: u32, visit: impl FnMut(Root<S>)) {
        match &self.light {
            Light::Beam(beam) => self.for_each_beam_root(beam, x, y, bounces, visit),
            Light::Point(lamp) => self.for_each_lamp_root(lamp, x, y, bounces, visit),
        }
    }

    /// Visits the rays of [`Self::for_each_root`] that this wall, with its arc and its height, reflects.
    #[inline]
    pub fn for_each_lit_root(&self, x: S, y: S, bounces: u32, mut visit: impl FnMut(Root<S>)) {
        self.for_each_root(x, y, bounces, |root| {
            if self.is_lit(&root, bounces) {
                visit(root);
            }
        });
    }

    /// Whether the wall, with its arc and its height, makes the reflections of a root.
    #[inline]
    pub fn is_lit(&self, root: &Root<S>, bounces: u32) -> bool {
        let chord = S::TWO * self.wall.radius * root.cos_incidence;
        if !self.wall.reaches(root.wall_z) || !self.wall.covers(root.cos_phi) {
            return false;
        }
        if let Some(beam) = self.beam() {
            // The ray comes in at the angle π - φ: over the rim, if there is a wall.
            let over_rim = match self.wall.height {
                Some(height) => root.wall_z + chord * beam.slope() >= height,
                None => false,
            };
            if self.wall.covers(-root.cos_phi) && !over_rim {
                return false;
            }
        }
        if self.wall.cos_half_arc.is_none() {
            return root.tau <= chord;
        }
        if bounces == 1 && root.tau <= chord {
            return true;
        }
        // Each chord turns the position by π - 2i; the last one ends at hit number bounces + 1.
        let phi = root.phi();
        let turn = self.chord_turn(root);
        let on_arc = |hit: u32| {
            let angle = phi + turn * S::from_f64(f64::from(hit - 1));
            self.wall.covers(angle.cos())
        };
        (2..=bounces).all(on_arc) && (root.tau <= chord || !on_arc(bounces + 1))
    }

    /// Where the ray of a root with `bounces` reflections meets the wall for the n-th time, 1 ≤ n ≤ `bounces` [m].
    pub fn hit(&self, root: &Root<S>, bounces: u32, n: u32) -> Vec3<S> {
        let count = |n: u32| S::from_f64(f64::from(n));
        let chord = S::TWO * self.wall.radius * root.cos_incidence;
        let after = |n: u32| root.tau + count(bounces - n.min(bounces)) * chord;
        let phi = root.phi() + self.chord_turn(root) * count(n.max(1) - 1);
        // The ray comes down evenly to z = 0.
        let z = root.wall_z * after(n) / after(1);
        let a = self.wall.radius;
        vec3(a * phi.cos(), a * phi.sin(), z)
    }

    /// By how much the position angle changes along a chord.
    #[inline]
    fn chord_turn(&self, root: &Root<S>) -> S {
        match &self.light {
            Light::Beam(_) => S::TWO * root.phi() + S::PI,
            Light::Point(lamp) => lamp.chord_turn(&self.wall, root),
        }
    }

    /// Upper bound of the relative change of a root's irradiance per relative change of the lengths it comes from.
    pub fn conditioning(&self, x: S, y: S, bounces: u32, root: &Root<S>) -> S {
        match &self.light {
            Light::Beam(_) => self.beam_conditioning(x, y, bounces, root),
            Light::Point(lamp) => self.lamp_conditioning(lamp, x, y, bounces, root),
        }
    }

    /// Irradiance of the floor point (x, y) by light with exactly `bounces` reflections [W/m²].
    pub fn caustic(&self, x: S, y: S, bounces: u32) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        self.for_each_root(x, y, bounces, |root| {
            let conditioning = self.conditioning(x, y, bounces, &root);
            let lit = self.is_lit(&root, bounces);
            if lit {
                sum.add(root.irradiance, conditioning);
            }
            if root.touching && lit {
                sum.error = S::ONE / S::ZERO;
            } else if self.is_marginal(&root, bounces, conditioning) {
                // A shadow edge within rounding: the root may be there or not.
                sum.error += root.irradiance;
            }
        });
        if let Light::Point(lamp) = &self.light
            && lamp.is_on(&self.wall)
            && lamp.x.hypot(lamp.y) != self.wall.radius
            && self.wall.covers(lamp.x / self.wall.radius)
            && self.wall.reaches(lamp.height)
        {
            // A light next to the wall, and not on it, sends as much light again by way of the wall behind it, if there is
            // a wall.
            sum.error += beam::power(self.reflectance, bounces) * self.direct(x, y).value;
        }
        // At the foot of the wall rounding decides whether the point is in front of it.
        let a = self.wall.radius;
        let r = x.hypot(y);
        if (r - a).abs() <= rounding_error(a, S::ZERO) && self.wall.covers(x / r) {
            sum.error = S::ONE / S::ZERO;
        }
        sum
    }

    /// Whether rounding decides on [`Self::is_lit`].
    fn is_marginal(&self, root: &Root<S>, bounces: u32, conditioning: S) -> bool {
        let lit = self.is_lit(root, bounces);
        let margin = rounding_error(S::ONE, conditioning);
        [-margin, margin].into_iter().any(|shift| {
            let higher = Root {
                wall_z: root.wall_z + shift * (self.wall.radius + root.wall_z),
                ..*root
            };
            let turned = Root {
                cos_phi: root.cos_phi + shift,
                ..*root
            };
            self.is_lit(&higher, bounces) != lit || self.is_lit(&turned, bounces) != lit
        })
    }

    /// Direct irradiance of the floor point (x, y), in the shadow of the wall or not [W/m²].
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        match &self.light {
            Light::Beam(beam) => {
                let mut sum = Estimate::NONE;
                let e = beam.irradiance * beam.sin_elevation;
                let dark = self.shades_beam(beam, x, y);
                if !dark {
                    sum.add(e, S::ZERO);
                }
                let margin = rounding_error(self.wall.radius.max(x.hypot(y)), S::ZERO);
                let other = [-margin, margin].into_iter().any(|d| {
                    self.shades_beam(beam, x + d, y) != dark
                        || self.shades_beam(beam, x, y + d) != dark
                });
                if other {
                    sum.error += e;
                }
                sum
            }
            Light::Point(lamp) => self.direct_from_lamp(lamp, x, y),
        }
    }

    /// Whether the wall stands between the floor point and the sun.
    #[inline]
    pub fn shades_beam(&self, beam: &Beam<S>, x: S, y: S) -> bool {
        let a = self.wall.radius;
        if !(y.abs() < a) {
            return false;
        }
        let half = ((a - y) * (a + y)).sqrt();
        [half, -half].into_iter().any(|wall_x| {
            wall_x < x
                && self.wall.covers(wall_x / a)
                && self.wall.reaches((x - wall_x) * beam.slope())
        })
    }

    /// Whether (x, y) is inside the circle.
    #[inline(always)]
    pub fn is_inside(&self, position: Vec3<S>) -> bool {
        position.x.squared() + position.y.squared() < self.wall.radius.squared()
    }
}
