//! Regions of the film in planar scenes (kinds `diffuse` and `planar-mirror`), as convex sets.
//!
//! The camera's ray is linear in film coordinates, so "the floor point is left of this line", "the mirror point is inside
//! this edge" and "the segment to the (virtual) light crosses the mirror inside this edge" become linear inequalities in
//! (u, v) once multiplied by a denominator whose sign is fixed by another linear inequality. With q the pinhole, or its
//! image in the mirror, and d the (mirrored) ray direction, d_z < 0:
//!
//! ```text
//! floor point     x = q - q_z d / d_z                               linear-fractional in (u, v)
//! g·x + k ≥ 0     ⇔  (g·q + k)(-d_z) + q_z g·d ≥ 0                  for g_z = 0
//! mirror point    s = p + d h_p / (-d·n),  d·n < 0                  h = height above the mirror's plane
//! crossing        of the segment from y (height h_y) to x (height h_x), at y + (x - y) h_y / (h_y - h_x)
//! ```
//!
//! A shadow needs a floor point behind the mirror (h_x < 0, the light being in front); the caustic needs one in front
//! and takes the virtual light y - 2 h_y n, of height -h_y.

use crate::camera::{Bounded, Film};
use crate::pixel::polygon::{ConvexSet, HalfPlane, Ladder, Polygon, Side};
use crate::scene::{
    DiffuseScene, Entry, Floor, Kind, PlanarMirrorScene, PointLight, RectangleMirror,
};
use crate::vector::{Vec3, vec3};

/// How the eye sees the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Eye {
    /// Directly, where the mirror is not in front of it.
    Direct,
    /// In the mirror.
    Mirror,
}

/// How light reaches the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// It does not matter: no clip on the light's side.
    Any,
    /// From the light itself: outside the mirror's shadow.
    Direct,
    /// By the mirror: inside the lit polygon.
    Mirror,
}

/// A film region: a convex set minus others.
#[derive(Clone, Debug, Default)]
pub struct Region {
    /// The region is inside this set.
    pub inside: ConvexSet,
    /// And outside each of these.
    pub outside: Vec<ConvexSet>,
}

impl Region {
    /// The part of pixel (i, j) in the region as disjoint convex polygons.
    pub fn in_pixel(&self, i: u32, j: u32) -> Vec<Polygon> {
        let square = match self.inside.side(i, j) {
            Side::Outside => return Vec::new(),
            Side::Inside => Polygon::pixel(i, j),
            Side::Across => Polygon::pixel(i, j).intersection(&self.inside),
        };
        let mut pieces = if square.is_empty() {
            Vec::new()
        } else {
            vec![square]
        };
        for set in &self.outside {
            match set.side(i, j) {
                Side::Outside => {}
                Side::Inside => return Vec::new(),
                Side::Across => {
                    let whole = core::mem::take(&mut pieces);
                    whole.iter().for_each(|p| p.difference(set, &mut pieces));
                }
            }
        }
        pieces
    }

    /// Where pixel (i, j) lies; `Across` means that its polygons must be asked.
    pub fn side(&self, i: u32, j: u32) -> Side {
        let mut side = self.inside.side(i, j);
        for set in &self.outside {
            match set.side(i, j) {
                _ if side == Side::Outside => return side,
                Side::Inside => return Side::Outside,
                Side::Across => side = Side::Across,
                Side::Outside => {}
            }
        }
        side
    }
}

/// The mirror's plane and rectangle with unit vectors.
#[derive(Clone, Copy, Debug)]
struct Frame {
    center: Vec3<f64>,
    normal: Vec3<f64>,
    /// The rectangle's axes and half extents.
    axes: [(Vec3<f64>, f64); 2],
}

impl Frame {
    fn new(mirror: &RectangleMirror) -> Self {
        let normal = Vec3::from_f64(mirror.normal).normalized();
        let edge = Vec3::from_f64(mirror.edge).normalized();
        Frame {
            center: Vec3::from_f64(mirror.center),
            normal,
            axes: [
                (edge, mirror.half_width),
                (normal.cross(edge), mirror.half_height),
            ],
        }
    }

    fn height(&self, p: Vec3<f64>) -> f64 {
        (p - self.center).dot(self.normal)
    }

    fn reflected_point(&self, p: Vec3<f64>) -> Vec3<f64> {
        p - self.normal * (2.0 * self.height(p))
    }

    fn reflected_direction(&self, d: Vec3<f64>) -> Vec3<f64> {
        d - self.normal * (2.0 * d.dot(self.normal))
    }
}

/// The rays of one way of seeing: from `origin` along `corner + u du + v dv`.
#[derive(Clone, Copy, Debug)]
pub struct Rays {
    origin: Vec3<f64>,
    corner: Vec3<f64>,
    du: Vec3<f64>,
    dv: Vec3<f64>,
}

impl Rays {
    /// The camera's own rays, with heights counted from the plane at `z`: [`Rays::floor_point`] is on that plane.
    pub(super) fn new(film: &Film, z: f64) -> Self {
        Rays {
            origin: film.position - vec3(0.0, 0.0, z),
            corner: film.corner,
            du: film.du,
            dv: film.dv,
        }
    }

    /// The point where the ray through (u, v) meets the plane z = 0. Only meaningful inside the region of the same
    /// [`Eye`], where the ray goes down.
    #[inline(always)]
    pub fn floor_point(&self, u: f64, v: f64) -> Vec3<f64> {
        let d = self.corner + self.du * u + self.dv * v;
        let t = self.origin.z / -d.z;
        vec3(self.origin.x + d.x * t, self.origin.y + d.y * t, 0.0)
    }

    /// `direction · g`.
    fn along(&self, g: Vec3<f64>) -> HalfPlane {
        HalfPlane {
            a: self.du.dot(g),
            b: self.dv.dot(g),
            c: self.corner.dot(g),
        }
    }

    /// `g·x + k ≥ 0` at the floor point x, for rays that go down.
    fn floor_constraint(&self, g: Vec3<f64>, k: f64) -> HalfPlane {
        let flat = vec3(g.x, g.y, 0.0);
        let value = flat.dot(self.origin) + k;
        self.along(flat * self.origin.z - vec3(0.0, 0.0, value))
    }
}

/// The planar scene as its camera sees it.
#[derive(Clone, Debug)]
pub struct PlanarView {
    direct: Rays,
    mirrored: Option<Rays>,
    regions: Vec<((Eye, Light), Region)>,
    ladder: Ladder,
}

impl PlanarView {
    /// Prepares an entry that has passed [`Entry::validate`]; `None` if its kind is not planar.
    pub fn new(entry: &Entry) -> Option<Self> {
        let film = Film::new(&entry.camera);
        match &entry.kind {
            Kind::Diffuse(DiffuseScene { light, floor }) => {
                Some(Self::build(&film, floor, light, None))
            }
            Kind::PlanarMirror(PlanarMirrorScene {
                light,
                floor,
                mirror,
            }) => Some(Self::build(&film, floor, light, Some(mirror))),
            _ => None,
        }
    }

    fn build(
        film: &Film,
        floor: &Floor,
        light: &PointLight,
        mirror: Option<&RectangleMirror>,
    ) -> Self {
        let light = Vec3::from_f64(light.position);
        let direct = Rays::new(film, 0.0);
        let frame = mirror.map(Frame::new);
        let mirrored = frame.map(|m| Rays {
            origin: m.reflected_point(film.position),
            corner: m.reflected_direction(film.corner),
            du: m.reflected_direction(film.du),
            dv: m.reflected_direction(film.dv),
        });
        let mut regions = Vec::new();
        let seen = frame.map(|m| mirror_silhouette(&direct, &m));
        let occluders: Vec<ConvexSet> = seen.iter().cloned().collect();
        let base = |rays: &Rays, occluders: &[ConvexSet]| Region {
            inside: floor_rectangle(rays, floor),
            outside: occluders.to_vec(),
        };

        // The floor seen directly: minus the mirror in front of it, minus the mirror's shadow.
        let any = base(&direct, &occluders);
        let mut lit = any.clone();
        lit.outside
            .extend(frame.map(|m| crossing(&direct, &m, light, false)));
        regions.push(((Eye::Direct, Light::Direct), lit));
        if let (Some(m), Some(rays), Some(seen)) = (frame, mirrored, seen) {
            let image = m.reflected_point(light);
            let caustic = |rays: &Rays, region: &Region| {
                let mut region = region.clone();
                let clip = crossing(rays, &m, image, true);
                region.inside.half_planes.extend(clip.half_planes);
                region
            };
            regions.push(((Eye::Direct, Light::Mirror), caustic(&direct, &any)));
            // The floor seen in the mirror: it is in front of the mirror, where there is no shadow.
            let mut through = base(&rays, &[]);
            through.inside.half_planes.extend(seen.half_planes);
            regions.push(((Eye::Mirror, Light::Mirror), caustic(&rays, &through)));
            regions.push(((Eye::Mirror, Light::Direct), through.clone()));
            regions.push(((Eye::Mirror, Light::Any), through));
        }
        regions.push(((Eye::Direct, Light::Any), any));
        PlanarView {
            direct,
            mirrored,
            regions,
            ladder: Ladder::default(),
        }
    }

    /// The region of a pair, if the scene has one.
    pub fn region(&self, eye: Eye, light: Light) -> Option<&Region> {
        let found = self.regions.iter().find(|(key, _)| *key == (eye, light));
        found.map(|(_, region)| region)
    }

    /// The map from the film to the floor.
    pub fn rays(&self, eye: Eye) -> Option<&Rays> {
        match eye {
            Eye::Direct => Some(&self.direct),
            Eye::Mirror => self.mirrored.as_ref(),
        }
    }

    /// ∫ f(floor point) du dv over the part of pixel (i, j) in the region: the mean over the pixel of a function that is
    /// zero outside. `f` must be analytic on the region; it is refined until `relative` times the value, or `absolute`.
    pub fn integrate(
        &self,
        eye: Eye,
        light: Light,
        (i, j): (u32, u32),
        relative: f64,
        absolute: f64,
        f: impl Fn(Vec3<f64>) -> f64,
    ) -> Bounded {
        let (Some(region), Some(rays)) = (self.region(eye, light), self.rays(eye)) else {
            return Bounded::default();
        };
        let mut sum = Bounded::default();
        let side = region.side(i, j);
        if side == Side::Outside {
            return sum;
        }
        for piece in region.in_pixel(i, j) {
            let part =
                self.ladder.integrate(
                    &piece,
                    relative,
                    absolute,
                    &|u, v| f(rays.floor_point(u, v)),
                );
            sum.value += part.value;
            sum.error += part.error;
        }
        if side == Side::Across {
            // An edge is known to about EDGE pixels: the area that can be on the wrong side.
            let [u, v] = [f64::from(i) + 0.5, f64::from(j) + 0.5];
            let peak = f(rays.floor_point(u, v)).abs();
            sum.error += EDGE
                * if peak.is_finite() {
                    peak
                } else {
                    sum.value.abs()
                };
        }
        sum
    }
}

/// Rounding of the position of an edge on the film [pixels].
const EDGE: f64 = 1e-12;

/// Rays that go down and meet the floor's rectangle.
pub(super) fn floor_rectangle(rays: &Rays, floor: &Floor) -> ConvexSet {
    let mut half_planes = vec![rays.along(vec3(0.0, 0.0, -1.0))];
    let axes = [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)];
    for (k, axis) in axes.into_iter().enumerate() {
        let (center, half) = (floor.center[k], floor.half_width[k]);
        half_planes.push(rays.floor_constraint(axis, half - center));
        half_planes.push(rays.floor_constraint(-axis, half + center));
    }
    ConvexSet { half_planes }
}

/// Rays that meet the mirror's front (the camera is in front of it).
fn mirror_silhouette(rays: &Rays, m: &Frame) -> ConvexSet {
    let height = m.height(rays.origin);
    let mut half_planes = vec![rays.along(-m.normal)];
    for (axis, half) in m.axes {
        // ±(s - c)·axis ≤ half with s = p + d h_p / (-d·n).
        let offset = (rays.origin - m.center).dot(axis);
        for sign in [1.0, -1.0] {
            let g = axis * (-sign * height) - m.normal * (half - sign * offset);
            half_planes.push(rays.along(g));
        }
    }
    ConvexSet { half_planes }
}

/// Floor points in front of (or behind) the mirror for which the segment to `y`, a point on the other side, crosses the
/// rectangle.
fn crossing(rays: &Rays, m: &Frame, y: Vec3<f64>, in_front: bool) -> ConvexSet {
    // With σ = 1 in front and -1 behind: σ h_x > 0, -σ h_y > 0, and the crossing is at y + (x - y) h_y / (h_y - h_x).
    let sigma = if in_front { 1.0 } else { -1.0 };
    let n = m.normal;
    let (h_y, h_0) = (m.height(y), -m.center.dot(n));
    let mut half_planes = vec![rays.floor_constraint(n * sigma, sigma * h_0)];
    for (axis, half) in m.axes {
        let from = (y - m.center).dot(axis);
        for sign in [1.0, -1.0] {
            // Σ = σ (h_x - h_y) > 0:  half Σ - sign (from Σ + σ (-h_y) (x - y)·axis) ≥ 0, and Σ is linear in x.
            let rest = half - sign * from;
            let g = n * (sigma * rest) + axis * (sign * sigma * h_y);
            let k = sigma * rest * (h_0 - h_y) - sign * sigma * h_y * y.dot(axis);
            half_planes.push(rays.floor_constraint(g, k));
        }
    }
    ConvexSet { half_planes }
}
