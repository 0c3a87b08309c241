//! The image of the cup: direct light and the caustic on the floor, and both again in the wall.
//!
//! Constant radiance (LDE, LDSE) is an area on the film ([`area`]); the caustic (LSDE) is integrated along the light's
//! own straight lines on the floor, where it has no fold ([`caustic`]); the reflected caustic (LSDSE) slice by slice
//! ([`reflected`]).

mod area;
mod caustic;
mod reflected;

use core::f64::consts::PI;

use libm::{cos, hypot, sin, tan};

use crate::camera::{Bounded, Film};
use crate::pixel::fan::Fan;
use crate::pixel::floor_polygon::{Edge, FloorPolygon, Projection};
use crate::pixel::line::Line;
use crate::pixel::planar::{Rays, floor_rectangle};
use crate::pixel::polygon::{ConvexSet, HalfPlane, Polygon, Side};
use crate::scene::{CylinderCupScene, Entry, Floor, Kind};

/// The cup as its camera sees it.
#[derive(Clone, Debug)]
pub struct CupImage {
    /// Radius a.
    radius: f64,
    /// Arc end (x, |y|): a cos Φ, a sin Φ.
    arc_end: [f64; 2],
    /// tan(Φ/2): the wall is |t| ≤ this with t = tan(φ/2).
    limit: f64,
    /// Longest horizontal leg of the light after the wall, height / tan ε: also the length of the shadow.
    reach: f64,
    /// The wall hides, and shows in it, plan distances from r to `enlargement` r behind a wall point at r.
    enlargement: f64,
    /// Radiance of the directly lit floor, E₀ sin ε ρ/π.
    direct: f64,
    /// Reflectance R.
    reflectance: f64,
    projection: Projection,
    rays: Rays,
    /// The floor's rectangle, on the film and on the floor.
    floor_on_film: ConvexSet,
    floor_edges: [Edge; 4],
    /// Film points whose unreflected rays meet the floor plane no further away than anything seen in the wall.
    reach_on_film: ConvexSet,
    /// Film position of the point under the pinhole, if it is in front of it.
    nadir_on_film: Option<(f64, f64)>,
    line: Line,
}

impl CupImage {
    /// Prepares a validated entry; `None` for another kind.
    pub fn new(entry: &Entry) -> Option<Self> {
        let Kind::CylinderCup(CylinderCupScene { light, floor, wall }) = &entry.kind else {
            return None;
        };
        let film = Film::new(&entry.camera);
        let elevation = light.elevation_degrees.to_radians();
        let arc = wall.half_arc_degrees.to_radians();
        let a = wall.radius;
        let rays = Rays::new(&film, 0.0);
        let projection = Projection::new(&film, 0.0);
        let enlargement = projection.height / (projection.height - wall.height);
        let [cx, cy] = projection.nadir;
        let far = 1.01 * enlargement * (hypot(cx, cy) + a);
        let square = Floor {
            center: projection.nadir,
            half_width: [far, far],
            albedo: floor.albedo,
        };
        let edge = |normal: [f64; 2], k: usize| Edge {
            normal,
            offset: (normal[0] + normal[1]) * floor.center[k] - floor.half_width[k],
        };
        Some(CupImage {
            radius: a,
            arc_end: [a * cos(arc), a * sin(arc)],
            limit: tan(0.5 * arc),
            reach: wall.height / tan(elevation),
            enlargement,
            direct: light.irradiance * sin(elevation) * floor.albedo / PI,
            reflectance: wall.reflectance,
            projection,
            rays,
            floor_on_film: floor_rectangle(&rays, floor),
            floor_edges: [
                edge([1.0, 0.0], 0),
                edge([-1.0, 0.0], 0),
                edge([0.0, 1.0], 1),
                edge([0.0, -1.0], 1),
            ],
            reach_on_film: floor_rectangle(&rays, &square),
            nadir_on_film: film.project(film.position - crate::vector::vec3(0.0, 0.0, 1.0)),
            line: Line::default(),
        })
    }

    /// Row `j`, `[class][column]`, in the order of [`Kind::classes`].
    pub fn row(&self, j: u32, tolerance: f64, row: &mut [Vec<Bounded>]) {
        let [lde, lsde, ldse, lsdse] = row else {
            return;
        };
        let once = tolerance * self.direct;
        for i in 0..lde.len() as u32 {
            let k = i as usize;
            if let Some(footprint) = self.footprint(&self.floor_on_film, i, j) {
                lde[k] = self.lit_floor(&footprint, i, j, once);
                lsde[k] = self.caustic(&footprint, once * self.reflectance);
            }
            if let Some(footprint) = self.footprint(&self.reach_on_film, i, j)
                && self.may_show_wall(&footprint)
            {
                for piece in self.pieces(&self.reach_on_film, i, j) {
                    let mut fan = Fan::new(self.projection.nadir, &piece);
                    self.add_wall_breaks(&piece, &mut fan);
                    let breaks = self.wall_breaks(&piece, &fan);
                    let direct = self.floor_in_wall(&piece, &fan, &breaks, once * self.reflectance);
                    let caustic = self.reflected_caustic(
                        &piece,
                        &fan,
                        &breaks,
                        once * self.reflectance * self.reflectance,
                    );
                    for (sum, part) in [(&mut ldse[k], direct), (&mut lsdse[k], caustic)] {
                        sum.value += part.value;
                        sum.error += part.error;
                    }
                }
            }
        }
    }

    /// Footprint of a pixel's part in a set of film points whose rays meet the floor plane.
    fn footprint(&self, set: &ConvexSet, i: u32, j: u32) -> Option<FloorPolygon> {
        let film = match set.side(i, j) {
            Side::Outside => return None,
            Side::Inside => Polygon::pixel(i, j),
            Side::Across => Polygon::pixel(i, j).intersection(set),
        };
        self.on_floor(&film)
    }

    fn on_floor(&self, film: &Polygon) -> Option<FloorPolygon> {
        FloorPolygon::new(film, |u, v| {
            let x = self.rays.floor_point(u, v);
            [x.x, x.y]
        })
    }

    /// As [`Self::footprint`], cut in two where the point under the pinhole is inside.
    fn pieces(&self, set: &ConvexSet, i: u32, j: u32) -> Vec<FloorPolygon> {
        let film = Polygon::pixel(i, j).intersection(set);
        let inside = |&(u, v): &(f64, f64)| {
            let (i, j) = (f64::from(i), f64::from(j));
            u > i && u < i + 1.0 && v > j && v < j + 1.0
        };
        let Some((_, v)) = self.nadir_on_film.filter(inside) else {
            return self.on_floor(&film).into_iter().collect();
        };
        let half = |b: f64| {
            let cut = HalfPlane {
                a: 0.0,
                b,
                c: -b * v,
            };
            self.on_floor(&film.clipped(&cut))
        };
        [half(1.0), half(-1.0)].into_iter().flatten().collect()
    }

    /// Plan distance at which the ray from the pinhole in the direction of the unit vector `e` leaves the circle, with the
    /// point, if it leaves through the wall.
    #[inline]
    fn wall_point(&self, e: [f64; 2]) -> Option<(f64, [f64; 2])> {
        let [cx, cy] = self.projection.nadir;
        let across = cx * e[1] - cy * e[0];
        let rest = (self.radius - across) * (self.radius + across);
        if !(rest > 0.0) {
            return None;
        }
        let r = rest.sqrt() - (cx * e[0] + cy * e[1]);
        let w = [cx + r * e[0], cy + r * e[1]];
        (r > 0.0 && w[0] >= self.arc_end[0]).then_some((r, w))
    }
}
