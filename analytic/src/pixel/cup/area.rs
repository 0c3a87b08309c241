//! Film areas of the cup's curved regions: the lit floor seen directly, and the floor seen in the wall.
//!
//! Their borders are conics on the film (the wall's base and rim, the shadow's border) and straight lines. In a vertical
//! plane through the pinhole they are intervals of the horizontal distance with explicit ends, and the film area of an
//! interval has a closed form. What remains is an integral over the azimuth between explicit break points.
//!
//! The pinhole sees the wall point at plan distance r and height z along the ray to the floor point at r h/(h - z), h the
//! pinhole's height; so the wall hides plan distances from r to r h/(h - height), and a ray reflected by the wall to a
//! floor point s further on has the film position of the unreflected floor point at r + s.

use crate::camera::Bounded;
use crate::pixel::cup::CupImage;
use crate::pixel::fan::{Break, Fan, Singularity, circle_crossings, integrate_between};
use crate::pixel::floor_polygon::{FloorPolygon, clip};

impl CupImage {
    /// The circle of the rim as seen on the floor plane: the base, enlarged from the point under the pinhole.
    fn rim(&self) -> ([f64; 2], f64) {
        let k = self.enlargement;
        (
            self.projection.nadir.map(|c| (1.0 - k) * c),
            k * self.radius,
        )
    }

    fn enlarged(&self, x: [f64; 2]) -> [f64; 2] {
        let c = self.projection.nadir;
        let k = self.enlargement;
        [c[0] + k * (x[0] - c[0]), c[1] + k * (x[1] - c[1])]
    }

    fn arc_ends(&self) -> [[f64; 2]; 2] {
        let [x, y] = self.arc_end;
        [[x, y], [x, -y]]
    }

    /// Whether a floor point is in the wall's shadow: behind it, by less than the reach.
    fn in_shadow(&self, [x, y]: [f64; 2]) -> bool {
        let rest = (self.radius - y) * (self.radius + y);
        if !(y.abs() < self.arc_end[1] && rest > 0.0) {
            return false;
        }
        let behind = x - rest.sqrt();
        behind > 0.0 && behind < self.reach
    }

    /// Whether the wall hides the floor point at plan distance r in direction e.
    fn hidden(&self, e: [f64; 2], r: f64) -> bool {
        self.wall_point(e)
            .is_some_and(|(w, _)| r > w && r < self.enlargement * w)
    }

    /// Whether any border of the lit, visible floor may pass through a footprint.
    fn may_be_cut(&self, p: &FloorPolygon) -> bool {
        let margin = p.radius * (1.0 + 1e-9);
        let (rim, rim_radius) = self.rim();
        let circles = [
            ([0.0, 0.0], self.radius),
            ([self.reach, 0.0], self.radius),
            (rim, rim_radius),
        ];
        let near_circle = circles.iter().any(|(c, r)| {
            let d = libm::hypot(p.center[0] - c[0], p.center[1] - c[1]);
            (d - r).abs() <= margin
        });
        let near_side = (p.center[1].abs() - self.arc_end[1]).abs() <= margin;
        // The wall's vertical ends are lines through the point under the pinhole.
        let [cx, cy] = self.projection.nadir;
        let near_end = self.arc_ends().iter().any(|end| {
            let (dx, dy) = (end[0] - cx, end[1] - cy);
            let distance = dx * (p.center[1] - cy) - dy * (p.center[0] - cx);
            distance.abs() <= margin * libm::hypot(dx, dy)
        });
        near_circle || near_side || near_end
    }

    /// Radiance × film area of the lit floor seen directly, in pixel (i, j) with that footprint.
    pub(super) fn lit_floor(
        &self,
        footprint: &FloorPolygon,
        i: u32,
        j: u32,
        tolerance: f64,
    ) -> Bounded {
        if !self.may_be_cut(footprint) {
            let [cx, cy] = self.projection.nadir;
            let x = footprint.center;
            let (dx, dy) = (x[0] - cx, x[1] - cy);
            let r = libm::hypot(dx, dy);
            if self.in_shadow(x) || (r > 0.0 && self.hidden([dx / r, dy / r], r)) {
                return Bounded::default();
            }
            let film = crate::pixel::polygon::Polygon::pixel(i, j);
            let area = match self.floor_on_film.side(i, j) {
                crate::pixel::polygon::Side::Inside => 1.0,
                _ => film.intersection(&self.floor_on_film).area(),
            };
            let value = self.direct * area;
            return Bounded {
                value,
                error: 1e-13 * value,
            };
        }
        let mut sum = Bounded::default();
        for piece in self.pieces(&self.floor_on_film, i, j) {
            let mut fan = Fan::new(self.projection.nadir, &piece);
            self.add_wall_breaks(&piece, &mut fan);
            self.add_shadow_breaks(&piece, &mut fan);
            let breaks = fan.sorted();
            for pair in breaks.windows(2) {
                let mut area = |azimuth: f64| self.lit_slice(&piece, fan.direction(azimuth));
                let part = integrate_between(
                    &self.line,
                    pair[0],
                    pair[1],
                    tolerance / self.direct,
                    &mut area,
                );
                sum.value += self.direct * part.value;
                sum.error += self.direct * (part.error + 1e-15);
            }
        }
        sum
    }

    /// Film area per azimuth of the lit, visible floor.
    fn lit_slice(&self, piece: &FloorPolygon, e: [f64; 2]) -> Bounded {
        let nadir = self.projection.nadir;
        let Some(([low, high], _)) = piece.clip(nadir, e, 0.0, f64::INFINITY) else {
            return Bounded::default();
        };
        let mut cuts = [high; 10];
        let mut count = 0;
        let mut cut = |r: f64| {
            if r > low && r < high {
                cuts[count] = r;
                count += 1;
            }
        };
        if let Some((r, _)) = self.wall_point(e) {
            cut(r);
            cut(self.enlargement * r);
        }
        for (center, sign) in [(0.0, 1.0), (self.reach, 1.0), (self.reach, -1.0)] {
            let from = [nadir[0] - center, nadir[1]];
            let across = from[0] * e[1] - from[1] * e[0];
            let rest = (self.radius - across) * (self.radius + across);
            if rest > 0.0 {
                cut(sign * rest.sqrt() - (from[0] * e[0] + from[1] * e[1]));
            }
        }
        if e[1] != 0.0 {
            cut((self.arc_end[1] - nadir[1]) / e[1]);
            cut((-self.arc_end[1] - nadir[1]) / e[1]);
        }
        let cuts = &mut cuts[..=count];
        cuts.sort_unstable_by(f64::total_cmp);
        let mut from = low;
        let mut area = 0.0;
        for &to in cuts.iter() {
            let r = 0.5 * (from + to);
            let x = [nadir[0] + r * e[0], nadir[1] + r * e[1]];
            if !self.in_shadow(x) && !self.hidden(e, r) {
                area += self.projection.fan(e, from, to);
            }
            from = to;
        }
        Bounded {
            value: area,
            error: 0.0,
        }
    }

    /// Whether a footprint on the unreflected floor plane may show the wall.
    pub(super) fn may_show_wall(&self, p: &FloorPolygon) -> bool {
        let margin = p.radius * (1.0 + 1e-9);
        let (rim, rim_radius) = self.rim();
        let distance = |c: [f64; 2]| libm::hypot(p.center[0] - c[0], p.center[1] - c[1]);
        // Seen wall lies outside the base circle, inside the rim's, and beyond the chord between the arc's ends.
        distance([0.0, 0.0]) >= self.radius - margin
            && distance(rim) <= rim_radius + margin
            && p.center[0] >= self.arc_end[0].min(self.enlarged(self.arc_end)[0]) - margin
    }

    /// Break points of the wall's outline.
    pub(super) fn add_wall_breaks(&self, piece: &FloorPolygon, fan: &mut Fan) {
        let mut points = self.arc_ends().to_vec();
        let (rim, rim_radius) = self.rim();
        circle_crossings([0.0, 0.0], self.radius, piece, &mut points);
        circle_crossings(rim, rim_radius, piece, &mut points);
        fan.add(&points, Singularity::Kink);
    }

    /// Break points of the shadow's outline, and of its crossings with the wall's.
    fn add_shadow_breaks(&self, piece: &FloorPolygon, fan: &mut Fan) {
        let [x, y] = self.arc_end;
        let mut points = vec![[x + self.reach, y], [x + self.reach, -y]];
        circle_crossings([self.reach, 0.0], self.radius, piece, &mut points);
        let (rim, rim_radius) = self.rim();
        for side in [y, -y] {
            for e in &piece.edges {
                if e.normal[0] != 0.0 {
                    points.push([(e.offset - e.normal[1] * side) / e.normal[0], side]);
                }
            }
            let rest = (rim_radius - (side - rim[1])) * (rim_radius + (side - rim[1]));
            if rest > 0.0 {
                points.push([rim[0] + rest.sqrt(), side]);
                points.push([rim[0] - rest.sqrt(), side]);
            }
        }
        // The shadow's far border and the rim: two circles.
        let (dx, dy) = (rim[0] - self.reach, rim[1]);
        let d2 = dx * dx + dy * dy;
        let along = (d2 + self.radius * self.radius - rim_radius * rim_radius) / (2.0 * d2);
        let rest = self.radius * self.radius / d2 - along * along;
        if rest > 0.0 {
            for half in [rest.sqrt(), -rest.sqrt()] {
                points.push([self.reach + along * dx - half * dy, along * dy + half * dx]);
            }
        }
        fan.add(&points, Singularity::Kink);
        // Slices that touch the shadow's far border.
        let from = [
            self.projection.nadir[0] - self.reach,
            self.projection.nadir[1],
        ];
        let distance2 = from[0] * from[0] + from[1] * from[1];
        let k = self.radius * self.radius / distance2;
        if k < 1.0 {
            let half = (k * (1.0 - k)).sqrt();
            let touch = |sign: f64| {
                [
                    self.reach + k * from[0] - sign * half * from[1],
                    k * from[1] + sign * half * from[0],
                ]
            };
            fan.add(&[touch(1.0), touch(-1.0)], Singularity::Root);
        }
    }

    /// The unreflected plan distances [r₀, r₁] of the floor seen in the wall, in a slice: cut by the footprint, the rim and
    /// the floor's borders; with the wall point, the reflected direction and the labels of what cuts.
    pub(super) fn wall_slice(&self, piece: &FloorPolygon, e: [f64; 2]) -> Option<WallSlice> {
        let (foot, wall) = self.wall_point(e)?;
        let ([low, high], labels) =
            piece.clip(self.projection.nadir, e, foot, self.enlargement * foot)?;
        let n = [wall[0] / self.radius, wall[1] / self.radius];
        let twice = 2.0 * (e[0] * n[0] + e[1] * n[1]);
        let along = [e[0] - twice * n[0], e[1] - twice * n[1]];
        let (range, floor_labels) = clip(&self.floor_edges, wall, along, low - foot, high - foot)?;
        let label = |k: usize| match floor_labels[k] {
            u8::MAX => labels[k],
            other => 100 + other,
        };
        Some(WallSlice {
            foot,
            wall,
            along,
            range,
            labels: [label(0), label(1)],
        })
    }

    /// Radiance × film area of the directly lit floor seen in the wall.
    pub(super) fn floor_in_wall(
        &self,
        piece: &FloorPolygon,
        fan: &Fan,
        breaks: &[Break],
        tolerance: f64,
    ) -> Bounded {
        let radiance = self.direct * self.reflectance;
        let mut sum = Bounded::default();
        for pair in breaks.windows(2) {
            let mut area = |azimuth: f64| {
                let e = fan.direction(azimuth);
                let value = self.wall_slice(piece, e).map_or(0.0, |s| {
                    let [s0, s1] = s.range;
                    self.projection.fan(e, s.foot + s0, s.foot + s1)
                });
                Bounded { value, error: 0.0 }
            };
            let part = integrate_between(
                &self.line,
                pair[0],
                pair[1],
                tolerance / radiance,
                &mut area,
            );
            sum.value += radiance * part.value;
            sum.error += radiance * (part.error + 1e-15);
        }
        sum
    }
}

/// What a vertical plane through the pinhole shows of the floor in the wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct WallSlice {
    /// Plan distance from the pinhole to the wall.
    pub foot: f64,
    /// The wall point in the plan.
    pub wall: [f64; 2],
    /// Reflected plan direction.
    pub along: [f64; 2],
    /// Plan distances from the wall point.
    pub range: [f64; 2],
    /// What cuts the range at either end.
    pub labels: [u8; 2],
}
