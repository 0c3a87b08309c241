//! The light of a caustic as a stream of contributions to the floor: what a film of expectations is summed from.
//!
//! At a floor point the kernel is integrated over the paths that end there ([`super::connection`], [`super::merging`]). Over
//! all floor points together it is simpler to begin at the light: a path to the vertex s by two numbers, and a displacement
//! inside the kernel by two more, which tells where on the floor it ends.
//!
//! ```text
//! ∫ E_α(x) h(x) dx = ∫∫ φ w(u, x) h(x) (dx/dω) dω du       at s, dω about the exact direction; dx/dω = r₁²/c_x
//!                  = ∫∫ k(ρ) Φ(u) h(p(u) − ρ) d²ρ du       merging: p the photon's floor point
//! ```
//!
//! The density w is that of [`super::Integrand::node`]. For `camera` at an interface the kernel is on the light's side of s:
//! the displaced direction is refracted, n² c₁ dω₁ = c₂ dω₂.

use core::f64::consts::{PI, TAU};
use std::sync::Arc;

use libm::{log1p, sqrt};

use super::connection::{Caustic, Connection, Interaction, Source, refracted};
use super::link::Receiver;
use super::merging::Merging;
use super::surfaces::frame_of;
use super::{Integrand, Node};
use crate::bandwidth::kernel::{Profile, von_mises_fisher};
use crate::bandwidth::{Kernel, Technique};
use crate::flux::Bundle;
use crate::optics::reflect;
use crate::vector::Vec3;

/// Light on the floor: what mean and second moment of the irradiance are multiplied by, per area, integrated over it.
pub(in crate::bandwidth) struct Drop {
    pub x: [f64; 2],
    /// [W], [W²/m²].
    pub values: [f64; 2],
}

/// A family of paths with a kernel of one bandwidth.
pub(in crate::bandwidth) enum Shower<'a> {
    /// Through one mollified vertex.
    Connected(Box<Connection<'a>>, &'a Caustic, Cap, Technique),
    /// Photons of a vertex, or of a bundle, merged within a radius.
    Merged(Box<dyn Integrand + 'a>, f64),
}

/// A kernel on directions.
#[derive(Clone, Copy)]
pub(in crate::bandwidth) struct Cap {
    kernel: Kernel,
    /// Versine of its end.
    end: f64,
    concentration: f64,
}

impl Cap {
    fn new(kernel: Kernel, alpha: f64) -> Self {
        let half = libm::sin(0.5 * alpha);
        Cap {
            kernel,
            end: 2.0 * half * half,
            concentration: von_mises_fisher(alpha).0,
        }
    }

    /// The versine 1 − cos g of a number in [0, 1), and the solid angle per number: uniform, or as the kernel falls.
    fn versine(&self, z: f64) -> (f64, f64) {
        // Beyond it nothing is left.
        const LAST: f64 = 36.0;
        match self.kernel {
            Kernel::VonMisesFisher => {
                let k = self.concentration;
                let part = -libm::expm1(-f64::min(LAST, 2.0 * k));
                let left = 1.0 - z * part;
                (-log1p(-z * part) / k, TAU * part / (k * left))
            }
            _ => (z * self.end, TAU * self.end),
        }
    }
}

/// A unit direction beside another.
fn beside(axis: Vec3<f64>, versine: f64, turn: f64) -> Vec3<f64> {
    let [e1, e2, axis] = frame_of(axis);
    let sine = sqrt(versine * (2.0 - versine));
    let (s, c) = libm::sincos(TAU * turn);
    axis * (1.0 - versine) + e1 * (sine * c) + e2 * (sine * s)
}

impl<'a> Shower<'a> {
    /// The paths of a caustic; `Linked` has none.
    pub fn of_caustic(
        caustic: &'a Caustic,
        receiver: Receiver,
        technique: Technique,
        kernel: Kernel,
        bandwidth: f64,
        profile: &'a Profile,
    ) -> Self {
        let connection = Connection::new(caustic, [0.0; 2], receiver, technique, profile, None);
        match technique {
            Technique::Merge => Shower::Merged(Box::new(connection), bandwidth),
            _ => Shower::Connected(
                Box::new(connection),
                caustic,
                Cap::new(kernel, bandwidth),
                technique,
            ),
        }
    }

    /// The photons of a bundle.
    pub fn of_bundle(
        bundle: &'a Arc<dyn Bundle>,
        receiver: Receiver,
        photons: f64,
        bandwidth: f64,
        profile: &'a Profile,
    ) -> Self {
        let merging = Merging::new(bundle, receiver, [0.0; 2], profile, photons);
        Shower::Merged(Box::new(merging), bandwidth)
    }

    /// Where the path of four numbers in [0, 1) ends, and what it brings if all numbers are equally likely; `None` where there is
    /// no such path.
    pub fn drop(&mut self, z: [f64; 4]) -> Option<Drop> {
        match self {
            Shower::Connected(connection, caustic, cap, technique) => {
                connected(connection, caustic, *cap, *technique, z)
            }
            Shower::Merged(integrand, radius) => merged(integrand.as_ref(), *radius, z),
        }
    }
}

/// A pair of parameters, and their area.
fn parameters(domain: [[f64; 2]; 2], z: [f64; 4]) -> ([f64; 2], f64) {
    let size = domain.map(|[low, high]| high - low);
    let u = [0, 1].map(|k| domain[k][0] + z[k] * size[k]);
    (u, size[0] * size[1])
}

fn exists(node: &Node) -> bool {
    node.margins.iter().all(|m| *m >= 0.0)
}

fn merged(integrand: &dyn Integrand, radius: f64, z: [f64; 4]) -> Option<Drop> {
    let (u, area) = parameters(integrand.domain(), z);
    let node = integrand.node(u);
    if !exists(&node) {
        return None;
    }
    // About the origin the deflection is the floor point.
    let [px, py, _] = node.deflection;
    let (s, c) = libm::sincos(TAU * z[3]);
    let rho = radius * sqrt(z[2]);
    let ring = ring(integrand, rho);
    let beside = Node {
        deflection: [rho, 0.0, 0.0],
        ..node
    };
    let kernel = integrand.kernel(ring, &beside);
    let measure = area * PI * radius * radius;
    Some(Drop {
        x: [px - rho * c, py - rho * s],
        values: [0, 1].map(|k| node.density[k] * kernel[k] * measure),
    })
}

/// The ring of a length of the deflection.
fn ring<I: Integrand + ?Sized>(integrand: &I, length: f64) -> usize {
    let square = length * length;
    integrand.spans().partition_point(|&edge| edge < square)
}

fn connected(
    connection: &mut Connection,
    caustic: &Caustic,
    cap: Cap,
    technique: Technique,
    z: [f64; 4],
) -> Option<Drop> {
    let (u, area) = parameters(connection.domain(), z);
    let vertex = caustic.surface.vertex(u);
    if vertex.margins.iter().any(|m| !(*m >= 0.0)) {
        return None;
    }
    let (s, n) = (vertex.point, vertex.normal);
    let to_light = match caustic.source {
        Source::Point(y, _) => (y - s).normalized(),
        Source::Beam(d, _) => -d,
    };
    if !(to_light.dot(n) > 0.0) {
        return None;
    }
    let (versine, solid) = cap.versine(z[2]);
    let from_light = technique == Technique::Light;
    let (to_x, jacobian) = match caustic.interaction {
        Interaction::Mirror(_) => (beside(reflect(-to_light, n), versine, z[3]), 1.0),
        Interaction::Interface(index) if from_light => {
            let (out, _, inside) = refracted(-to_light, n, index);
            if !(inside >= 0.0) {
                return None;
            }
            (beside(out, versine, z[3]), 1.0)
        }
        Interaction::Interface(index) => {
            let towards = beside(to_light, versine, z[3]);
            let (out, _, inside) = refracted(-towards, n, index);
            let c2 = towards.dot(n);
            if !(inside >= 0.0 && c2 > 0.0) {
                return None;
            }
            (out, c2 / (index * index * f64::abs(out.dot(n))))
        }
    };
    let (x, t) = connection.ends(s, to_x)?;
    connection.move_to(x);
    let node = connection.node(u);
    if !exists(&node) {
        return None;
    }
    let cx = f64::abs(to_x.z);
    let length = sqrt(node.square());
    let kernel = connection.kernel(ring(connection, length), &node);
    let measure = area * solid * jacobian * t * t / cx;
    Some(Drop {
        x,
        values: [0, 1].map(|k| node.density[k] * kernel[k] * measure),
    })
}
