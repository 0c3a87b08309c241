//! Vertical walls from the parameters of a reference table: pillars, conic walls, glass pillars.

use crate::certificate::source::Source;
use crate::enclosure::Enclosure;
use crate::kinds::conic_wall::ConicWall;
use crate::kinds::glass_pillar::GlassPillar;
use crate::kinds::pillar::Pillar;
use crate::scalar::Scalar;

/// A glass pillar with the number of its listed classes.
#[derive(Clone, Copy, Debug)]
pub struct GlassColumn {
    /// The pillar in its beam.
    pub pillar: GlassPillar<Enclosure>,
    /// The most interactions that are listed.
    pub orders: u32,
}

/// `center`, `a`, `H`, `R`, `light`, `I`.
pub fn pillar(p: &dyn Source) -> Option<Pillar<Enclosure>> {
    Some(Pillar {
        x: p.entry("center", &[0])?,
        y: p.entry("center", &[1])?,
        radius: p.number("a")?,
        height: p.number("H")?,
        reflectance: p.number("R")?,
        light: p.point("light")?,
        intensity: p.number("I")?,
    })
}

/// `focus`, `axis`, `p`, `e`, `half_arc` (a number or `closed`), `H`, `R`, `light`, `I`.
pub fn conic_wall(p: &dyn Source) -> Option<ConicWall<Enclosure>> {
    let (x, y) = (p.entry("axis", &[0])?, p.entry("axis", &[1])?);
    let length = (x.squared() + y.squared()).sqrt();
    let closed = p.text("half_arc", &[]).is_some_and(|t| t == "closed");
    Some(ConicWall {
        x: p.entry("focus", &[0])?,
        y: p.entry("focus", &[1])?,
        axis: (x / length, y / length),
        parameter: p.number("p")?,
        eccentricity: p.number("e")?,
        half_arc: if closed {
            None
        } else {
            Some(p.number("half_arc")?)
        },
        height: p.number("H")?,
        reflectance: p.number("R")?,
        light: p.point("light")?,
        intensity: p.number("I")?,
    })
}

impl GlassColumn {
    /// `center`, `a`, `H`, `n`, `E0`, `sin_elevation`, `cos_elevation`, `max_interactions`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        Some(GlassColumn {
            pillar: GlassPillar {
                x: p.entry("center", &[0])?,
                y: p.entry("center", &[1])?,
                radius: p.number("a")?,
                height: p.number("H")?,
                index: p.number("n")?,
                irradiance: p.number("E0")?,
                sin_elevation: p.number("sin_elevation")?,
                cos_elevation: p.number("cos_elevation")?,
            },
            orders: p.whole("max_interactions")?,
        })
    }
}
