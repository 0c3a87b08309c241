//! A scene compiled for rays, and the one step that all methods share: where a ray reaches the floor, with at most one
//! specular interaction on the way.

use glam::DVec3;

use super::floor::Floor;
use super::light::Light;
use super::pinhole::Pinhole;
use super::specular::Specular;

/// A scene with its light and specular surface known at compile time.
#[derive(Clone, Copy, Debug)]
pub struct Scene<L, S> {
    /// The light.
    pub light: L,
    /// The specular surface.
    pub surface: S,
    /// The receiver.
    pub floor: Floor,
    /// The camera.
    pub camera: Pinhole,
}

/// From a scene's own constant to the one that a deliberately wrong integrator takes for it.
pub type Mistaken = Option<fn(f64) -> f64>;

/// Replacements of scene constants, for deliberately wrong integrators. The default replaces nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overrides {
    /// Intensity or irradiance of the light.
    pub light: Mistaken,
    /// Albedo of the floor or the wall.
    pub albedo: Mistaken,
    /// Reflectance of the mirror.
    pub reflectance: Mistaken,
    /// Index of the water.
    pub index: Mistaken,
    /// From the index of the water to the a and b of a + b T, which is taken for the transmittance T.
    pub transmittance: Option<fn(f64) -> [f64; 2]>,
}

/// What is taken for a constant.
pub(super) fn taken_for(own: f64, mistaken: Mistaken) -> f64 {
    mistaken.map_or(own, |f| f(own))
}

/// Where a ray reaches the floor.
#[derive(Clone, Copy, Debug)]
pub struct Landing {
    /// The point, z = 0 [m].
    pub x: f64,
    /// Second coordinate of the point [m].
    pub y: f64,
    /// Cosine of the angle of arrival.
    pub cosine: f64,
    /// Reflectance or transmittance on the way (1 for a straight ray); 0 where the ray does not reach the floor.
    pub weight: f64,
    /// Whether there was a specular interaction on the way.
    pub via: bool,
}

impl<L, S> Scene<L, S> {
    /// Corners of a rectangle of the floor that contains all of it that is in the frame.
    pub fn seen_floor(&self) -> Vec<DVec3> {
        let mut corners = self.floor.hull();
        let (columns, rows) = self.camera.size();
        let eye = self.camera.position;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (u, v) in [(0.0, 0.0), (columns, 0.0), (0.0, rows), (columns, rows)] {
            let direction = self.camera.direction(u, v);
            let t = Floor::meet(eye, direction);
            if !(t < f64::INFINITY) {
                // The horizon is in the frame.
                return corners;
            }
            let point = eye + direction * t;
            (low, high) = (low.min(point), high.max(point));
        }
        for corner in &mut corners {
            // Rounding at the frame's border: a margin far above it.
            let margin = 1e-9 * (high - low);
            corner.x = corner.x.min(high.x + margin.x).max(low.x - margin.x);
            corner.y = corner.y.min(high.y + margin.y).max(low.y - margin.y);
        }
        corners
    }
}

impl<L: Light, S: Specular> Scene<L, S> {
    /// Follows a ray to the floor, through at most one specular interaction.
    #[inline(always)]
    pub fn landing(&self, origin: DVec3, direction: DVec3) -> Landing {
        let meeting = self.surface.meet(origin, direction);
        let straight = Floor::meet(origin, direction);
        let via = meeting.t < straight;
        let (o, d, weight) = if via {
            (meeting.point, meeting.direction, meeting.weight)
        } else {
            (origin, direction, 1.0)
        };
        let t = if via { Floor::meet(o, d) } else { straight };
        let (x, y) = (o.x + d.x * t, o.y + d.y * t);
        let reaches = (t < f64::INFINITY) & self.floor.contains(x, y);
        Landing {
            x: if reaches { x } else { 0.0 },
            y: if reaches { y } else { 0.0 },
            cosine: -d.z / f64::sqrt(d.dot(d)),
            weight: if reaches { weight } else { 0.0 },
            via,
        }
    }
}

/// The unit vector along `v`. (glam's own goes through a software square root.)
pub fn unit(v: DVec3) -> DVec3 {
    v / f64::sqrt(v.dot(v))
}
