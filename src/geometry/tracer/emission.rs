//! Photons of any light, by blocks.

use multiversion::multiversion;

use super::super::emission::{Beam, Cap, Cone, Emitter};
use super::Rays;
use crate::stream::{BLOCK, Lanes};

/// What photons are to cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// Everything that can reach the floor or the specular surface, and little else.
    Scene,
    /// With the density of the tables of expectations for a chain: the whole sphere of a point light, or the cross-section of
    /// a directional beam that covers what the chain meets first.
    Table(usize),
    /// What a chain meets first on its way to the floor (where none is seen through a surface: to its part in the frame), and
    /// little else.
    Chain(usize),
}

/// Photons of equal flux.
#[derive(Clone, Copy, Debug)]
pub enum Emission {
    /// From a point, within a band of heights.
    Cap(Cap),
    /// From a point, about an axis.
    Cone(Cone),
    /// Over a cross-section of parallel light.
    Beam(Beam),
}

/// What photons are equally likely over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// Directions from a point [sr].
    SolidAngle(f64),
    /// A cross-section of parallel light, perpendicular to it [m²].
    CrossSection(f64),
}

impl Emission {
    /// What photons are equally likely over.
    pub fn extent(&self) -> Extent {
        match self {
            Emission::Cap(e) => Extent::SolidAngle(e.solid_angle()),
            Emission::Cone(e) => Extent::SolidAngle(e.solid_angle()),
            Emission::Beam(e) => Extent::CrossSection(e.cross_section()),
        }
    }

    /// Flux of all the light that is drawn from [W]: each of N photons stands for 1/N of it.
    pub fn flux(&self) -> f64 {
        match self {
            Emission::Cap(e) => e.flux(),
            Emission::Cone(e) => e.flux(),
            Emission::Beam(e) => e.flux(),
        }
    }

    /// The rays of pairs of uniforms. Directions are unit vectors.
    pub fn rays(&self, u: &Lanes, v: &Lanes, rays: &mut Rays) {
        match self {
            Emission::Cap(e) => draw(e, u, v, rays),
            Emission::Cone(e) => draw(e, u, v, rays),
            Emission::Beam(e) => draw(e, u, v, rays),
        }
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn draw<E: Emitter>(emitter: &E, u: &Lanes, v: &Lanes, rays: &mut Rays) {
    for i in 0..BLOCK {
        let (origin, direction) = emitter.ray(u[i], v[i]);
        rays.origin.set(i, origin);
        rays.direction.set(i, direction);
    }
}

impl From<Cap> for Emission {
    fn from(e: Cap) -> Self {
        Emission::Cap(e)
    }
}

impl From<Cone> for Emission {
    fn from(e: Cone) -> Self {
        Emission::Cone(e)
    }
}

impl From<Beam> for Emission {
    fn from(e: Beam) -> Self {
        Emission::Beam(e)
    }
}
