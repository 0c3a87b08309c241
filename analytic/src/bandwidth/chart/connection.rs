//! Connections through one mollified vertex: `camera`, `light`, `symmetric` and `linked` on any mirror or interface.
//!
//! Receiver x, vertex s, light y (or parallel light), r₁ = |s − x|, r₂ = |s − y|, c_x, c₁, c₂ the cosines at x, and at s
//! towards x and towards the light; dA the area of the surface:
//!
//! ```text
//! camera     E = ∫ φ n² T I c_x c₁/(r₁² r₂²) dA    f = π n² T I/r₂²         kernel at the direction to the light
//! light      E = ∫ φ T I c_x c₂/(r₁² r₂²) dA       f = 4π T I c_x/r₁²       kernel at the direction to the receiver
//! symmetric  E = ∫ φ R I c_x √(c₁c₂)/(r₁² r₂²) dA  f = π R I √(c₂/c₁)/r₂²   (at an interface: camera)
//! ```
//!
//! n the index of the receiver's medium relative to the light's, T the Fresnel factor at the side from which the path comes;
//! for a mirror n = 1 and T = R. Parallel light: I/r₂² becomes E₀, and photons are uniform over a cross-section: 4πI becomes
//! its flux. `linked` is `light`, or `camera`, with α = atan(r/d). Source: `theory/bandwidth.md` sections 2 and 4.

use core::f64::consts::PI;
use std::sync::Arc;

use libm::{asin, sqrt};

use super::link::{Link, Receiver, set_landing};
use super::surfaces::{Legs, Surface, Vertex};
use super::{Integrand, MARGINS, Node};
use crate::bandwidth::Technique;
use crate::bandwidth::kernel::Profile;
use crate::optics::{fresnel_transmittance, reflect};
use crate::vector::{Vec3, vec3};

/// Where the light comes from.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) enum Source {
    /// Position [m] and radiant intensity [W/sr].
    Point(Vec3<f64>, f64),
    /// Direction of travel (unit) and irradiance across it [W/m²].
    Beam(Vec3<f64>, f64),
}

/// What the surface does.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) enum Interaction {
    /// Reflects this part.
    Mirror(f64),
    /// Refracts; the index on the receiver's side relative to the light's.
    Interface(f64),
}

/// Light that reaches the floor through one specular vertex.
#[derive(Clone, Debug)]
pub(in crate::bandwidth) struct Caustic {
    pub source: Source,
    pub surface: Arc<dyn Surface>,
    pub interaction: Interaction,
    /// Flux of all photons [W]: 4πI, or what a beam carries through the cross-section over which it is sampled.
    pub photons: f64,
}

/// A caustic at a floor point.
pub(in crate::bandwidth) struct Connection<'a> {
    caustic: &'a Caustic,
    x: Vec3<f64>,
    receiver: Receiver,
    technique: Technique,
    profile: &'a Profile,
    edges: Vec<f64>,
    spans: Vec<f64>,
    plane: Option<Plane>,
    link: Option<Link>,
}

/// Distances on the floor as levels q/(q + S²), q the squared distance and S the size of the scene: unlike q itself they are
/// smooth where a ray turns away from the floor.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    square: f64,
    pub edges: Vec<f64>,
    pub spans: Vec<f64>,
}

impl Plane {
    pub fn new(profile: &Profile, size: f64) -> Self {
        let spans: Vec<f64> = profile.levels().iter().map(|r| r * r).collect();
        let square = size * size + spans.last().copied().unwrap_or(0.0);
        Plane {
            square,
            edges: spans.iter().map(|q| q / (q + square)).collect(),
            spans,
        }
    }

    pub fn level(&self, [dx, dy]: [f64; 2]) -> (f64, [f64; 3]) {
        let q = dx * dx + dy * dy;
        (1.0 / (1.0 + self.square / q), [dx, dy, 0.0])
    }
}

/// Squared chord of an angle: 4 sin²(g/2).
pub(super) fn squared_chord(g: f64) -> f64 {
    let s = libm::sin(0.5 * g);
    4.0 * s * s
}

impl<'a> Connection<'a> {
    pub fn new(
        caustic: &'a Caustic,
        x: [f64; 2],
        receiver: Receiver,
        technique: Technique,
        profile: &'a Profile,
        link: Option<Link>,
    ) -> Self {
        let plane = (technique == Technique::Merge).then(|| Plane::new(profile, receiver.scale()));
        let spans = match (&link, &plane) {
            (_, Some(plane)) => plane.spans.clone(),
            (Some(l), _) => vec![l.reach()],
            _ => profile.levels().iter().map(|&g| squared_chord(g)).collect(),
        };
        let edges = match (&link, &plane) {
            (_, Some(plane)) => plane.edges.clone(),
            (Some(l), _) => vec![l.reach() * l.radius * l.radius],
            _ => spans.clone(),
        };
        Connection {
            caustic,
            x: vec3(x[0], x[1], receiver.z),
            receiver,
            technique,
            profile,
            edges,
            spans,
            plane,
            link,
        }
    }

    /// Where a ray from a vertex meets the receiver's plane, and how far that is.
    pub(super) fn ends(&self, s: Vec3<f64>, direction: Vec3<f64>) -> Option<([f64; 2], f64)> {
        let t = (self.receiver.z - s.z) / direction.z;
        let x = [s.x + direction.x * t, s.y + direction.y * t];
        (t > 0.0 && t < f64::INFINITY).then_some((x, t))
    }

    /// Moves the receiver point.
    pub(super) fn move_to(&mut self, x: [f64; 2]) {
        (self.x.x, self.x.y) = (x[0], x[1]);
    }

    /// Whether the path is built from the camera.
    fn is_from_camera(&self) -> bool {
        matches!(self.technique, Technique::Camera | Technique::Symmetric)
    }
}

/// The exact continuation of a unit direction `d` that meets a surface with unit normal `n` on the side of −d; `index` is that
/// of the other medium relative to this one. Direction, Fresnel factor, and a margin that is negative beyond the critical angle.
pub(super) fn refracted(d: Vec3<f64>, n: Vec3<f64>, index: f64) -> (Vec3<f64>, f64, f64) {
    let c = -d.dot(n);
    let q2 = index * index - (1.0 - c) * (1.0 + c);
    let q = sqrt(q2);
    // The tangential part of the wave vector is kept, its normal part is q.
    let out = (d + n * (c - q)) * (1.0 / index);
    (out, fresnel_transmittance(1.0, c, index, q), q2)
}

impl Integrand for Connection<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.caustic.surface.domain()
    }

    fn edges(&self) -> &[f64] {
        &self.edges
    }

    fn spans(&self) -> &[f64] {
        &self.spans
    }

    fn rounding(&self) -> f64 {
        let size = match (&self.link, self.technique) {
            (Some(l), _) => 1.0 + 10.0 / l.radius,
            (None, Technique::Merge) => (1.0 + self.x.length()) / self.profile.end,
            _ => 1.0 / sqrt(self.spans.last().copied().unwrap_or(1.0)),
        };
        8.0 * f64::EPSILON * (1.0 + size)
    }

    /// At the foot of a wall that stands on the floor the exact ray is down at once, and a linked kernel opens to a half-space within
    /// heights of about the radius: halved heights, down to where it is open. Far below that for points that are nearly a right angle
    /// off the exact ray: tips of the support that lie along the foot are seen only in cells as low as they are, and what is missed
    /// goes like the square of the last height (3e-5 of the foot's share with a 30th of the radius).
    fn layers(&self) -> Vec<f64> {
        const AZIMUTHS: u32 = 16;
        const MOST: u32 = 48;
        // Of the radius.
        const LEAST: f64 = 1.0 / 256.0;
        let Some(link) = self.link.filter(|_| !self.is_from_camera()) else {
            return Vec::new();
        };
        let [[first, last], [low, high]] = self.domain();
        // The longest way to the floor from a height.
        let longest = |height: f64| {
            (0..AZIMUTHS)
                .map(|k| (f64::from(k) + 0.5) / f64::from(AZIMUTHS))
                .map(|t| self.node([first + t * (last - first), height]).distance)
                .filter(|d| d.is_finite())
                .fold(0.0, |a, d| f64::max(a, f64::abs(d)))
        };
        if longest(low) > 1e-9 * self.receiver.scale() {
            return Vec::new();
        }
        let mut layers: Vec<f64> = (1..=MOST)
            .map(|k| low + (high - low) * libm::ldexp(1.0, -(k as i32)))
            .take_while(|h| longest(*h) > LEAST * link.radius)
            .collect();
        layers.reverse();
        layers
    }

    fn node(&self, u: [f64; 2]) -> Node {
        let Caustic {
            source,
            surface,
            interaction,
            photons,
        } = self.caustic;
        let Vertex {
            point: s,
            normal,
            area,
            margins: own,
        } = surface.vertex(u);
        let to_x = self.x - s;
        let r1 = to_x.length();
        let to_x = to_x * (1.0 / r1);
        let (to_light, r2, strength) = match source {
            Source::Point(y, intensity) => {
                let v = *y - s;
                let r2 = v.length();
                (v * (1.0 / r2), r2, intensity / (r2 * r2))
            }
            Source::Beam(d, irradiance) => (-*d, f64::INFINITY, *irradiance),
        };
        // The normal points to the light's side.
        let c2 = to_light.dot(normal);
        let side = match interaction {
            Interaction::Mirror(_) => 1.0,
            Interaction::Interface(_) => -1.0,
        };
        let c1 = side * to_x.dot(normal);
        let cx = if s.z > self.x.z { -to_x.z } else { to_x.z };
        let common = strength * cx * area / (r1 * r1);

        let mut margins = [1.0; MARGINS];
        margins[..3].copy_from_slice(&own);
        margins[3] = c2;
        margins[4] = c1;
        margins[5] = cx;
        let legs = Legs {
            to_light,
            r2,
            to_x,
            r1,
        };
        let [near, far] = surface.free(&s, &normal, &legs);
        margins[6] = near;
        margins[7] = far;

        // The exact continuation of the light, where it is asked for.
        let exact = |margins: &mut [f64; MARGINS]| match interaction {
            Interaction::Mirror(r) => (reflect(-to_light, normal), *r),
            Interaction::Interface(index) => {
                let (out, t, inside) = refracted(-to_light, normal, *index);
                margins[8] = inside;
                (out, t)
            }
        };
        if let Some(plane) = &self.plane {
            // A photon needs no connection: only the light's leg and its own to the floor.
            let (out, scale) = exact(&mut margins);
            let (p, t, landing) = self.receiver.landing(&s, &out);
            margins[4] = 1.0;
            margins[5] = 1.0;
            set_landing(&mut margins, &landing);
            let legs = Legs {
                to_x: out,
                r1: t,
                ..legs
            };
            [margins[6], margins[7]] = surface.free(&s, &normal, &legs);
            let (level, deflection) = plane.level([p[0] - self.x.x, p[1] - self.x.y]);
            let flux = strength * c2 * area * scale;
            return Node {
                level,
                least: f64::NAN,
                deflection,
                density: [flux, flux * photons * scale],
                distance: 0.0,
                margins,
            };
        }
        let (difference, density, continued) = if self.is_from_camera() {
            let (out, scale) = match interaction {
                Interaction::Mirror(r) => (reflect(-to_x, normal), *r),
                Interaction::Interface(index) => {
                    let (out, t, inside) = refracted(-to_x, -normal, 1.0 / index);
                    margins[8] = inside;
                    (out, t * index * index)
                }
            };
            let (mut cosine, mut sample) = (c1, PI * scale * strength);
            if self.technique == Technique::Symmetric && side > 0.0 {
                cosine = sqrt(c1 * c2);
                sample *= sqrt(c2 / c1);
            }
            let w = common * scale * cosine;
            (out - to_light, [w, w * sample], out)
        } else {
            let (out, scale) = exact(&mut margins);
            let w = common * scale * c2;
            let sample = photons * scale * cx / (r1 * r1);
            (out - to_x, [w, w * sample], out)
        };
        let mut level = difference.length_squared();
        // Across the normal the exact direction is n times the incident one, also beyond the critical angle.
        let least = match (interaction, self.is_from_camera()) {
            (Interaction::Interface(index), true) if self.link.is_none() => {
                let d = to_x * *index + to_light;
                let across = d - normal * d.dot(normal);
                across.length_squared()
            }
            _ => f64::NAN,
        };
        let (mut deflection, mut distance) = (difference, 0.0);
        if let Some(link) = &self.link {
            let again = || surface.again(&s, &normal, &continued);
            let (legs, m) = ([r1, r2], &mut margins);
            distance = link.distance(&self.receiver, &s, &continued, legs, again, m);
            (level, deflection) = link.scaled(difference, distance);
        }
        Node {
            level,
            least,
            deflection: deflection.to_f64(),
            density,
            distance,
            margins,
        }
    }

    fn kernel(&self, ring: usize, node: &Node) -> [f64; 2] {
        let Some(link) = &self.link else {
            let length = sqrt(node.square());
            let g = if self.plane.is_some() {
                length
            } else {
                2.0 * asin((0.5 * length).min(1.0))
            };
            return self.profile.in_ring(ring, g);
        };
        link.kernel_at(node)
    }
}
