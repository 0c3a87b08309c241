//! Connections through the last of several specular vertices: all others are exact, and only the one next to the connection
//! is mollified.
//!
//! A subpath is built from one end, along exact reflections and refractions, up to the vertex s at which it meets the kernel; it
//! is a function of two parameters u. W is the product of the weights of all its vertices, s included; θ the angle at the
//! receiver point x.
//!
//! ```text
//! camera     from x, towards the light    E = ∫ φ W S cos θ dω          f = π W S
//! symmetric  a mirror at s                E = ∫ φ W S √(c₂/c₁) cos θ dω f = π W S √(c₂/c₁)   (at an interface: camera)
//! light      from the light, towards x    E = ∫ φ W c_x/r₁² dΦ          f = Φ W c_x/r₁²
//! ```
//!
//! S = I/r₂² with r₂ = |s − y|, for parallel light E₀; dω the solid angle at x and dΦ the light's flux; c₁ the cosine at s of
//! the path from the receiver, c₂ of that from the light; Φ the flux of all photons. With one vertex and dω = c₁ dA/r₁²,
//! dΦ = I c₂ dA/r₂² these are the forms of [`super::connection`]. Here receiver and light are in the same medium, so that the n²
//! of the radiance cancel on the way. `linked` is `light` with α = atan(r/d): d along the exact ray from s straight to the
//! floor (one that is not on the floor then escapes, also where the next surface would stop it), to x, or along the
//! path to the light. From the camera it is `camera`: d along the exact ray to what it meets first, or straight to x or to the light.

use core::f64::consts::PI;
use core::fmt::Debug;

use libm::{asin, sqrt};

use super::connection::{Source, squared_chord};
use super::link::{Again, Link, Receiver};
use super::{Integrand, MARGINS, Node};
use crate::bandwidth::Technique;
use crate::bandwidth::kernel::Profile;
use crate::vector::{Vec3, vec3};

/// Number of margins of a subpath.
pub(in crate::bandwidth) const OWN: usize = 4;

/// A path up to its mollified vertex.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Subpath {
    /// The mollified vertex s [m].
    pub vertex: Vec3<f64>,
    /// Its unit normal on the side to which the path goes on.
    pub normal: Vec3<f64>,
    /// Unit direction in which it goes on exactly.
    pub exact: Vec3<f64>,
    /// cos θ dω at the receiver, or the light's flux [W], per parameter area.
    pub measure: f64,
    /// Product of the weights of all vertices.
    pub weight: f64,
    /// Length of the path [m], where it starts in a point and is linked by it.
    pub length: f64,
    /// 1, or −1 where the vertex has gone through infinity: with it, the direction and the cosine of the connection stay smooth, and
    /// the cosine tells that the path does not exist.
    pub sheet: f64,
    /// The subpath exists, and nothing stops the connection, where all are ≥ 0; smooth, with a change of sign. What the cosines of
    /// the connection tell at s and at the floor is not among them: two margins with one zero cannot be told apart.
    pub margins: [f64; OWN],
}

/// Subpaths by two parameters.
pub(in crate::bandwidth) trait Subpaths: Debug {
    /// Rectangle of the parameters.
    fn domain(&self) -> [[f64; 2]; 2];
    /// The path of a pair of parameters; where a margin is negative, everything else may be NaN.
    fn path(&self, u: [f64; 2]) -> Subpath;
    /// Cells along both axes on which nothing is hidden between nine samples.
    fn cells(&self) -> [u32; 2] {
        [4, 4]
    }
    /// Where the exact ray of a path meets the surface of its vertex again.
    fn again(&self, _path: &Subpath) -> Option<Again> {
        None
    }
    /// Whether no vertex of the domain is below the floor: then its border is no margin as well.
    fn is_above_floor(&self) -> bool {
        false
    }
}

/// A sequence of specular vertices between a light and the floor.
pub(in crate::bandwidth) trait Chain: Debug + Send + Sync {
    /// Subpaths from a receiver point, mollified at the vertex next to the light. `None` where no light can arrive.
    fn receiver_paths<'a>(&'a self, x: Vec3<f64>) -> Option<Box<dyn Subpaths + 'a>>;
    /// Subpaths from the light, mollified at the vertex next to the receiver.
    fn light_paths<'a>(&'a self) -> Box<dyn Subpaths + 'a>;
    /// Whether the mollified vertex is on a mirror: only there two cosines make the symmetric form.
    fn is_mirror(&self) -> bool;
    /// Number of conditions under which an exact ray towards the light meets a surface again; 0 if it never does.
    fn again_conditions(&self) -> usize {
        0
    }
}

/// The light of a chain at a floor point.
pub(in crate::bandwidth) struct Chained<'a> {
    subpaths: Box<dyn Subpaths + 'a>,
    source: Source,
    x: Vec3<f64>,
    receiver: Receiver,
    /// Whether the path is built from the camera.
    from_camera: bool,
    symmetric: bool,
    photons: f64,
    profile: &'a Profile,
    edges: Vec<f64>,
    spans: Vec<f64>,
    link: Option<Link>,
}

impl<'a> Chained<'a> {
    /// A technique other than merging; `None` where no light can arrive.
    pub fn new(
        chain: &'a dyn Chain,
        (source, photons): (Source, f64),
        x: [f64; 2],
        receiver: Receiver,
        technique: Technique,
        profile: &'a Profile,
        link: Option<Link>,
    ) -> Option<Self> {
        let x = vec3(x[0], x[1], receiver.z);
        let from_camera = matches!(technique, Technique::Camera | Technique::Symmetric);
        // Where no path from the receiver can begin, none can end.
        let receiver_paths = chain.receiver_paths(x)?;
        let spans = match &link {
            Some(l) => vec![l.reach()],
            None => profile.levels().iter().map(|&g| squared_chord(g)).collect(),
        };
        let edges = match &link {
            Some(l) => vec![l.reach() * l.radius * l.radius],
            None => spans.clone(),
        };
        Some(Chained {
            subpaths: if from_camera {
                receiver_paths
            } else {
                chain.light_paths()
            },
            source,
            x,
            receiver,
            from_camera,
            symmetric: technique == Technique::Symmetric && chain.is_mirror(),
            photons,
            profile,
            edges,
            spans,
            link,
        })
    }
}

impl Integrand for Chained<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.subpaths.domain()
    }

    fn edges(&self) -> &[f64] {
        &self.edges
    }

    fn spans(&self) -> &[f64] {
        &self.spans
    }

    fn rounding(&self) -> f64 {
        let size = match &self.link {
            Some(l) => 10.0 / l.radius,
            None => 1.0 / sqrt(self.spans.last().copied().unwrap_or(1.0)),
        };
        8.0 * f64::EPSILON * (1.0 + size)
    }

    fn coarse(&self) -> [u32; 2] {
        self.subpaths.cells()
    }

    fn node(&self, u: [f64; 2]) -> Node {
        let path = self.subpaths.path(u);
        let mut margins = [1.0; MARGINS];
        margins[..OWN].copy_from_slice(&path.margins);
        let (target, strength) = match self.source {
            _ if !self.from_camera => (Some(self.x), 1.0),
            Source::Point(y, intensity) => (Some(y), intensity),
            Source::Beam(_, irradiance) => (None, irradiance),
        };
        let (towards, distance) = match (target, self.source) {
            (None, Source::Beam(d, _)) => (-d, 1.0),
            (target, _) => {
                let v = target.unwrap_or(self.x) - path.vertex;
                let r = v.length();
                (v * (path.sheet / r), r)
            }
        };
        let leaving = towards.dot(path.normal);
        margins[OWN] = leaving;
        let mut sample = path.weight * strength / (distance * distance);
        let mean = if self.from_camera {
            if self.symmetric {
                sample *= sqrt(leaving / path.exact.dot(path.normal));
            }
            let mean = sample * path.measure;
            sample *= PI;
            mean
        } else {
            // The floor faces up.
            let cosine = -towards.z;
            if !self.subpaths.is_above_floor() {
                margins[OWN + 1] = cosine;
            }
            sample *= cosine;
            let mean = sample * path.measure;
            sample *= self.photons;
            mean
        };
        let difference = path.exact - towards;
        let mut node = Node {
            level: difference.length_squared(),
            least: f64::NAN,
            deflection: difference.to_f64(),
            density: [mean, mean * sample],
            distance: 0.0,
            margins,
        };
        if let Some(link) = &self.link {
            let lengths = if self.from_camera {
                [(self.x - path.vertex).length(), distance]
            } else {
                [distance, path.length]
            };
            node.distance = link.distance(
                &self.receiver,
                &path.vertex,
                &path.exact,
                lengths,
                || self.subpaths.again(&path),
                &mut node.margins,
            );
            let (level, deflection) = link.scaled(difference, node.distance);
            node.level = level;
            node.deflection = deflection.to_f64();
        }
        node
    }

    fn kernel(&self, ring: usize, node: &Node) -> [f64; 2] {
        match &self.link {
            Some(link) => link.kernel_at(node),
            None => {
                let chord = sqrt(node.square());
                self.profile
                    .in_ring(ring, 2.0 * asin((0.5 * chord).min(1.0)))
            }
        }
    }
}
