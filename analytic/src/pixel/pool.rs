//! The image of the pool: the floor under flat water, lit and seen through its surface (LSDSE).
//!
//! A camera ray refracts at the surface in its own vertical plane, so that in a slice the floor point's plan distance R is a
//! monotone function of the plan distance r at which the ray meets the surface. Irradiance and radiance are smooth, so
//! pixels inside the floor take a tensor Gauss rule. Only the floor's rectangle is an edge, and its image on the film is
//! curved: pixels that it crosses are swept by slices, which it cuts at r(R), the specular point of floor point R.
//!
//! ```text
//! L = T/n² · ρ/π · E          basic radiance is conserved [theory/scenes.md, 0.4]
//! ```

use core::f64::consts::PI;

use crate::camera::{Bounded, Film};
use crate::kinds::flat_interface::FlatInterface;
use crate::pixel::events::{Probe, search};
use crate::pixel::fan::{Fan, Singularity, integrate_between, sort};
use crate::pixel::floor_polygon::{Edge, FloorPolygon, Projection, clip};
use crate::pixel::line::Line;
use crate::pixel::planar::{Rays, floor_rectangle};
use crate::pixel::polygon::{ConvexSet, HalfPlane, Ladder, Polygon};
use crate::scene::{Entry, FlatInterfaceScene, Floor, Kind};
use crate::vector::{Vec3, vec3};

/// The pool as its camera sees it.
#[derive(Clone, Debug)]
pub struct PoolImage {
    film: Film,
    light: FlatInterface<f64>,
    /// The camera in the light's place: its specular points are where the floor is seen.
    eye: FlatInterface<f64>,
    /// ρ/π.
    reflection: f64,
    /// The plane of the surface.
    projection: Projection,
    rays: Rays,
    floor_edges: [Edge; 4],
    /// Film points whose rays meet the surface no further away than anything seen of the floor.
    reach_on_film: ConvexSet,
    nadir_on_film: Option<(f64, f64)>,
    line: Line,
    ladder: Ladder,
}

/// What a vertical plane through the pinhole shows of the floor.
struct WaterSlice {
    /// Plan distances on the surface, cut by the footprint and by the floor's borders; equal if no floor is seen.
    range: [f64; 2],
    /// Floor points at the footprint's ends, whether on the floor or not.
    ends: [[f64; 2]; 2],
    labels: [u8; 2],
}

impl PoolImage {
    /// Prepares a validated entry; `None` for another kind.
    pub fn new(entry: &Entry) -> Option<Self> {
        let Kind::FlatInterface(FlatInterfaceScene {
            light,
            floor,
            water,
        }) = &entry.kind
        else {
            return None;
        };
        let film = Film::new(&entry.camera);
        let rays = Rays::new(&film, water.surface_z);
        let projection = Projection::new(&film, water.surface_z);
        // Refraction is towards the vertical: what is seen of the floor is seen between it and the nadir.
        let (mut center, mut half_width) = ([0.0; 2], [0.0; 2]);
        for k in 0..2 {
            let low = (floor.center[k] - floor.half_width[k]).min(projection.nadir[k]);
            let high = (floor.center[k] + floor.half_width[k]).max(projection.nadir[k]);
            center[k] = 0.5 * (low + high);
            half_width[k] = 0.505 * (high - low);
        }
        let reach = Floor {
            center,
            half_width,
            albedo: floor.albedo,
        };
        let edge = |normal: [f64; 2], k: usize| Edge {
            normal,
            offset: (normal[0] + normal[1]) * floor.center[k] - floor.half_width[k],
        };
        let through = FlatInterface::from_entry(light, water);
        Some(PoolImage {
            eye: FlatInterface {
                light: film.position,
                ..through
            },
            light: through,
            reflection: floor.albedo / PI,
            projection,
            rays,
            floor_edges: [
                edge([1.0, 0.0], 0),
                edge([-1.0, 0.0], 0),
                edge([0.0, 1.0], 1),
                edge([0.0, -1.0], 1),
            ],
            reach_on_film: floor_rectangle(&rays, &reach),
            nadir_on_film: film.project(film.position - vec3(0.0, 0.0, 1.0)),
            film,
            line: Line::default(),
            ladder: Ladder::default(),
        })
    }

    /// Row `j`, `[class][column]`.
    pub fn row(&self, j: u32, tolerance: f64, row: &mut [Vec<Bounded>]) {
        let [layer] = row else {
            return;
        };
        let scale = self.scale();
        for (i, out) in (0..).zip(layer) {
            *out = self.pixel(i, j, tolerance, tolerance * scale);
        }
    }

    /// Radiance of a typical point: under the light, seen along the normal.
    fn scale(&self) -> f64 {
        let light = self.light.light;
        let n = self.light.index;
        self.reflection * self.light.root(light.x, light.y).irradiance / (n * n)
    }

    fn pixel(&self, i: u32, j: u32, relative: f64, absolute: f64) -> Bounded {
        let film = Polygon::pixel(i, j).intersection(&self.reach_on_film);
        let corners: Vec<[f64; 2]> = film
            .corners
            .iter()
            .map(|c| self.seen(self.film.direction(c[0], c[1])).0)
            .collect();
        if corners.is_empty() {
            return Bounded::default();
        }
        // The footprint is nearly the corners' polygon: a margin of its own size is far more than it can bulge when it is
        // small compared with the depth; larger ones are always swept.
        let size = corners
            .iter()
            .map(|c| libm::hypot(c[0] - corners[0][0], c[1] - corners[0][1]))
            .fold(0.0, f64::max);
        let small = size < 0.2 * self.light.surface_z.min(self.projection.height);
        let room = |e: &Edge| {
            corners
                .iter()
                .map(|c| e.normal[0] * c[0] + e.normal[1] * c[1] - e.offset)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), d| {
                    (a.min(d), b.max(d))
                })
        };
        if small && self.floor_edges.iter().any(|e| room(e).1 < -size) {
            return Bounded::default();
        }
        if small && self.floor_edges.iter().all(|e| room(e).0 > size) {
            let radiance = |u: f64, v: f64| self.radiance(self.film.direction(u, v));
            return self.ladder.integrate(&film, relative, absolute, &radiance);
        }
        let mut sum = Bounded::default();
        for piece in self.pieces(&film) {
            let part = self.swept(&piece, absolute);
            sum.value += part.value;
            sum.error += part.error;
        }
        sum
    }

    /// The floor point that a ray sees, and T/n².
    fn seen(&self, direction: Vec3<f64>) -> ([f64; 2], f64) {
        let camera = self.film.position;
        match self.light.look(camera, camera + direction) {
            Some(seen) => ([seen.receiver.x, seen.receiver.y], seen.weight),
            None => ([f64::NAN; 2], 0.0),
        }
    }

    fn radiance(&self, direction: Vec3<f64>) -> f64 {
        let (x, weight) = self.seen(direction);
        weight * self.reflection * self.light.root(x[0], x[1]).irradiance
    }

    /// Direction to a point of the surface.
    fn towards(&self, e: [f64; 2], r: f64) -> Vec3<f64> {
        vec3(r * e[0], r * e[1], -self.projection.height)
    }

    /// Footprints on the surface, cut in two where the point under the pinhole is inside.
    fn pieces(&self, film: &Polygon) -> Vec<FloorPolygon> {
        let map = |u: f64, v: f64| {
            let x = self.rays.floor_point(u, v);
            [x.x, x.y]
        };
        let Some((_, v)) = self.nadir_on_film else {
            return FloorPolygon::new(film, map).into_iter().collect();
        };
        [1.0, -1.0]
            .into_iter()
            .filter_map(|b| {
                let cut = HalfPlane {
                    a: 0.0,
                    b,
                    c: -b * v,
                };
                FloorPolygon::new(&film.clipped(&cut), map)
            })
            .collect()
    }

    fn slice(&self, piece: &FloorPolygon, e: [f64; 2]) -> Option<WaterSlice> {
        let nadir = self.projection.nadir;
        let ([low, high], labels) = piece.clip(nadir, e, 0.0, f64::INFINITY)?;
        let ends = [low, high].map(|r| self.seen(self.towards(e, r)).0);
        let plan = |x: [f64; 2]| (x[0] - nadir[0]) * e[0] + (x[1] - nadir[1]) * e[1];
        let cut = clip(&self.floor_edges, nadir, e, plan(ends[0]), plan(ends[1]));
        let Some((floor, cuts)) = cut else {
            return Some(WaterSlice {
                range: [low; 2],
                ends,
                labels: [u8::MAX - 1; 2],
            });
        };
        let mut range = [low, high];
        for k in 0..2 {
            if cuts[k] != u8::MAX {
                let x = [nadir[0] + floor[k] * e[0], nadir[1] + floor[k] * e[1]];
                let hit = self.eye.root(x[0], x[1]).specular_point;
                range[k] = plan([hit.x, hit.y]);
            }
        }
        let label = |k: usize| match cuts[k] {
            u8::MAX => labels[k],
            other => 100 + other,
        };
        Some(WaterSlice {
            range,
            ends,
            labels: [label(0), label(1)],
        })
    }

    /// A footprint swept by slices.
    fn swept(&self, piece: &FloorPolygon, tolerance: f64) -> Bounded {
        let mut fan = Fan::new(self.projection.nadir, piece);
        let [low_x, high_x] = [self.floor_edges[0].offset, -self.floor_edges[1].offset];
        let [low_y, high_y] = [self.floor_edges[2].offset, -self.floor_edges[3].offset];
        let corners = [
            [low_x, low_y],
            [low_x, high_y],
            [high_x, low_y],
            [high_x, high_y],
        ];
        fan.add(&corners, Singularity::Kink);
        let basic = fan.sorted();
        let mut breaks = basic.clone();
        for pair in basic.windows(2) {
            let probe = |azimuth: f64| {
                let e = fan.direction(azimuth);
                let s = self.slice(piece, e)?;
                let side = |x: [f64; 2], k: usize| {
                    let edge = &self.floor_edges[k];
                    edge.normal[0] * x[0] + edge.normal[1] * x[1] - edge.offset
                };
                let values = core::array::from_fn(|k| side(s.ends[k / 4], k % 4));
                Some(Probe::<8> {
                    labels: s.labels,
                    values,
                })
            };
            let range = (pair[0].azimuth, pair[1].azimuth);
            search(range, [Singularity::Kink; 8], probe, &mut breaks);
        }
        sort(&mut breaks);
        let share = tolerance / breaks.len() as f64;
        let mut sum = Bounded::default();
        for pair in breaks.windows(2) {
            let inner = 0.1 * share / (pair[1].azimuth - pair[0].azimuth);
            let mut slice = |azimuth: f64| {
                let e = fan.direction(azimuth);
                let Some(s) = self.slice(piece, e) else {
                    return Bounded::default();
                };
                let mut radiance = |r: f64| {
                    let nadir = self.projection.nadir;
                    let depth = self
                        .projection
                        .depth([nadir[0] + r * e[0], nadir[1] + r * e[1]]);
                    let value = self.radiance(self.towards(e, r));
                    Bounded {
                        value: value * r * self.projection.density(depth),
                        error: 0.0,
                    }
                };
                (self.line).integrate(s.range[0], s.range[1], inner, &mut radiance)
            };
            let part = integrate_between(&self.line, pair[0], pair[1], share, &mut slice);
            sum.value += part.value;
            sum.error += part.error;
        }
        sum
    }
}
