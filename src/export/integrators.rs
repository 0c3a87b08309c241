//! Which path classes the renderers' integrators can sample, with a point light or a directional one.
//!
//! Such a light cannot be hit, and neither can a pinhole; a specular interaction cannot be connected to. So a path from the eye needs
//! the light next to the diffuse vertex, a path from the light needs the eye next to it, and only photons that are collected at the
//! diffuse vertex do without both.

use nephroid_analytic::class::PathClass;

use super::Format;

/// What an integrator can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Paths from the eye with next event estimation: L D+ S* E.
    Eye,
    /// Paths from the light, connected to the eye: L S* D+ E.
    Light,
    /// Both, and the connections between them.
    Both,
    /// Everything, photons collected within a radius: biased by it.
    Merging,
}

impl Reach {
    /// Whether paths of a class can be sampled.
    pub const fn samples(self, class: &PathClass) -> bool {
        match self {
            Reach::Eye => class.light.is_empty(),
            Reach::Light => class.eye.is_empty(),
            Reach::Both => class.light.is_empty() || class.eye.is_empty(),
            Reach::Merging => true,
        }
    }

    /// One line for a person.
    pub const fn meaning(self) -> &'static str {
        match self {
            Reach::Eye => "paths from the eye, connected to the light",
            Reach::Light => "paths from the light, connected to the eye",
            Reach::Both => "both, and connections between them",
            Reach::Merging => "photons collected within a radius (biased by it)",
        }
    }
}

/// The integrators of a renderer that are of use here.
pub const fn of(format: Format) -> &'static [(&'static str, Reach)] {
    match format {
        Format::Mitsuba => &[
            ("path", Reach::Eye),
            ("volpath", Reach::Eye),
            ("ptracer", Reach::Light),
        ],
        Format::Pbrt => &[
            ("path", Reach::Eye),
            ("lightpath", Reach::Light),
            ("bdpt", Reach::Both),
            ("mlt", Reach::Both),
            ("sppm", Reach::Merging),
        ],
        Format::Luxcore => &[
            ("PATHCPU", Reach::Eye),
            ("BIDIRCPU", Reach::Both),
            ("BIDIRVMCPU", Reach::Merging),
        ],
    }
}
