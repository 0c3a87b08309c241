//! The light of an entry as families of paths about a floor point, each with its offset from a perfect path.

use crate::bandwidth::chart::connection::{Caustic, Connection};
use crate::bandwidth::chart::link::{Case, Link, Receiver};
use crate::bandwidth::chart::merging::Merging;
use crate::bandwidth::chart::{Integrand, MARGINS, scenes};
use crate::bandwidth::kernel::Profile;
use crate::bandwidth::light::{self, Class};
use crate::bandwidth::{Convention, Kernel, Technique, check};
use crate::kinds::flat_interface::FlatInterface;
use crate::kinds::sphere_mirror::SphereMirror;
use crate::scene::{Entry, InvalidParameter};

/// A technique on an entry.
#[derive(Clone, Debug)]
pub(in crate::bandwidth) struct Family {
    pub classes: Vec<Class>,
    pub receiver: Receiver,
    pub technique: Technique,
    pub kernel: Kernel,
    pub convention: Convention,
    profile: Profile,
}

/// Margins of a path, those of the parameters' rectangle included.
pub(super) const LIMITS: usize = MARGINS + 4;

/// What the law needs of one path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// Offset from a perfect path, in the units of the bandwidth to leading order: a chord on the unit sphere [rad], the way on the
    /// floor [m], or a chord times the linked distance [m]. Its length C becomes the kernel's argument C + curvature C³/24.
    pub offset: [f64; 3],
    /// What multiplies the kernel, and its square, per parameter area.
    pub density: [f64; 2],
    /// Curvature of the space of offsets: 1 on the sphere, 0 on the floor, 1/d² if linked.
    pub curvature: f64,
    /// The path exists where all are ≥ 0.
    pub margins: [f64; LIMITS],
}

impl Sample {
    pub fn exists(&self) -> bool {
        self.margins.iter().all(|m| *m >= 0.0) && self.square().is_finite()
    }

    pub fn square(&self) -> f64 {
        self.offset.iter().map(|c| c * c).sum()
    }
}

/// Paths of one class about one floor point.
pub(super) enum Map<'a> {
    Connected(Connection<'a>),
    Linked(Connection<'a>, Box<Connection<'a>>),
    Merged(Connection<'a>),
    /// With whether the weights of its rays are known.
    Bundled(Merging<'a>, bool),
}

impl Map<'_> {
    pub fn domain(&self) -> [[f64; 2]; 2] {
        match self {
            Map::Connected(c) | Map::Linked(c, _) | Map::Merged(c) => c.domain(),
            Map::Bundled(m, _) => m.domain(),
        }
    }

    /// The linked distance of a path [m]; infinite where nothing is linked.
    pub fn linked_distance(&self, u: [f64; 2]) -> f64 {
        match self {
            Map::Linked(_, distances) => distances.node(u).distance,
            _ => f64::INFINITY,
        }
    }

    /// The chord of the deflection, and what multiplies the kernel and its square; `None` where there is no path.
    pub fn connection(&self, u: [f64; 2]) -> Option<(f64, [f64; 2])> {
        let Map::Linked(c, distances) = self else {
            return None;
        };
        let node = c.node(u);
        // The exact ray lands on the floor as well.
        let exists = |m: &[f64; MARGINS]| m.iter().all(|m| *m >= 0.0);
        let lands = exists(&node.margins) && exists(&distances.node(u).margins);
        lands.then(|| (libm::sqrt(node.square()), node.density))
    }

    /// The path of a pair of parameters, which may be outside the rectangle where the surface has a continuation.
    pub fn at(&self, u: [f64; 2]) -> Sample {
        let node = match self {
            Map::Connected(c) | Map::Linked(c, _) | Map::Merged(c) => c.node(u),
            Map::Bundled(m, _) => m.node(u),
        };
        let mut margins = [1.0; LIMITS];
        margins[..MARGINS].copy_from_slice(&node.margins);
        for (k, [low, high]) in self.domain().into_iter().enumerate() {
            margins[MARGINS + 2 * k] = (u[k] - low) / (high - low);
            margins[MARGINS + 2 * k + 1] = (high - u[k]) / (high - low);
        }
        let (mut offset, mut density, mut curvature) = (node.deflection, node.density, 1.0);
        match self {
            Map::Connected(_) => {}
            Map::Merged(_) => curvature = 0.0,
            Map::Bundled(_, weighted) => {
                curvature = 0.0;
                if !weighted {
                    density[1] = f64::NAN;
                }
            }
            Map::Linked(_, distances) => {
                // φ = d² f(dg/r)/r² to leading order.
                let d = distances.node(u).distance;
                offset = offset.map(|c| c * d);
                density = [density[0] * d * d, density[1] * d * d * d * d];
                curvature = 1.0 / (d * d);
            }
        }
        Sample {
            offset,
            density,
            curvature,
            margins,
        }
    }
}

impl Family {
    /// # Errors
    /// What [`Entry::validate`] finds, and a kind or kernel that does not fit.
    pub fn of_entry(
        entry: &Entry,
        technique: Technique,
        kernel: Kernel,
        convention: Convention,
        beam_area: f64,
    ) -> Result<Self, InvalidParameter> {
        entry.validate()?;
        check(technique, kernel, &[WIDTH])?;
        let (receiver, classes) = light::of_entry(entry, technique, beam_area)?;
        // Chains have no law.
        if classes.iter().any(|c| c.chains.is_some()) {
            return Err(light::unknown(&entry.kind, technique));
        }
        Ok(Self::of(classes, receiver, technique, kernel, convention))
    }

    fn of(
        classes: Vec<Class>,
        receiver: Receiver,
        technique: Technique,
        kernel: Kernel,
        convention: Convention,
    ) -> Self {
        Family {
            classes,
            receiver,
            technique,
            kernel,
            convention,
            profile: Profile::new(kernel, technique.bandwidth_is_angle(), &[WIDTH]),
        }
    }

    /// The light of a spherical mirror on an unbounded receiver.
    pub fn of_sphere(
        mirror: &SphereMirror<f64>,
        technique: Technique,
        kernel: Kernel,
    ) -> Option<Self> {
        Self::unbounded(scenes::sphere(mirror), mirror.receiver_z, technique, kernel)
    }

    /// The light that a flat interface refracts onto an unbounded receiver.
    pub fn of_interface(
        form: &FlatInterface<f64>,
        technique: Technique,
        kernel: Kernel,
    ) -> Option<Self> {
        Self::unbounded(
            vec![scenes::interface(form)?],
            form.receiver_z,
            technique,
            kernel,
        )
    }

    fn unbounded(
        caustics: Vec<Caustic>,
        z: f64,
        technique: Technique,
        kernel: Kernel,
    ) -> Option<Self> {
        check(technique, kernel, &[WIDTH]).ok()?;
        let (receiver, class) = light::unbounded(caustics, z);
        Some(Self::of(
            vec![class],
            receiver,
            technique,
            kernel,
            Convention::Exact,
        ))
    }

    /// The paths of a class about a floor point.
    pub(super) fn maps<'a>(&'a self, class: &'a Class, x: [f64; 2]) -> Vec<Map<'a>> {
        let connect = |caustic, technique, link| {
            Connection::new(caustic, x, self.receiver, technique, &self.profile, link)
        };
        let connected = class.caustics.iter().map(|caustic| match self.technique {
            Technique::Merge => Map::Merged(connect(caustic, Technique::Merge, None)),
            Technique::Linked => {
                let link = Link {
                    convention: self.convention,
                    radius: WIDTH,
                    kernel: self.kernel,
                    case: Case::LANDS,
                };
                Map::Linked(
                    connect(caustic, Technique::Light, None),
                    Box::new(connect(caustic, Technique::Linked, Some(link))),
                )
            }
            technique => Map::Connected(connect(caustic, technique, None)),
        });
        let merged = class.bundles.iter().map(|bundle| {
            let m = Merging::new(bundle, self.receiver, x, &self.profile, class.photons);
            let weighted = m.is_weighted();
            Map::Bundled(m, weighted)
        });
        connected.chain(merged).collect()
    }
}

/// Any bandwidth: what the law needs of a path does not depend on it.
const WIDTH: f64 = 1e-3;
