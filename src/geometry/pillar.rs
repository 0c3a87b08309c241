//! A mirror pillar: a solid cylinder about a vertical axis, on the floor. Its side reflects, its top absorbs.

use glam::{DVec2, DVec3};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::PillarScene;

use super::chains::{Chains, Leg, Vertex};
use super::specular::reflected;

/// A solid cylinder from z = 0 up.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// Axis in plan [m].
    pub center: DVec2,
    /// Radius [m].
    pub radius: f64,
    /// Height of the top [m].
    pub height: f64,
}

impl Cylinder {
    /// Ray parameters at which a line enters and leaves the unbounded cylinder; `None` if it misses it.
    pub fn crossings(&self, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let (o, d) = (origin.truncate() - self.center, direction.truncate());
        let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - self.radius * self.radius);
        if a == 0.0 {
            return (c < 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let discriminant = b * b - a * c;
        if !(discriminant > 0.0) {
            return None;
        }
        // The root in which nothing cancels, then the other from their product c/a.
        let q = -(b + f64::copysign(f64::sqrt(discriminant), b));
        let (s, t) = (q / a, c / q);
        Some((s.min(t), s.max(t)))
    }

    /// Whether the ray comes through the solid, 0 < t < `t_end`.
    pub fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let Some((enter, leave)) = self.crossings(origin, direction) else {
            return false;
        };
        let (enter, leave) = (enter.max(0.0), leave.min(t_end));
        // Between the two it is lowest at one of them.
        let z = |t: f64| {
            if direction.z == 0.0 {
                origin.z
            } else {
                origin.z + direction.z * t
            }
        };
        let (low, high) = (z(enter).min(z(leave)), z(enter).max(z(leave)));
        (enter < leave) & (low < self.height) & (high > 0.0)
    }

    /// Low and high corner of the circumscribed box.
    pub fn bounds(&self) -> [DVec3; 2] {
        let half = DVec2::splat(self.radius);
        [
            (self.center - half).extend(0.0),
            (self.center + half).extend(self.height),
        ]
    }

    /// The points of the circumscribed box.
    pub fn hull(&self) -> Vec<DVec3> {
        let r = self.radius;
        let mut corners = Vec::with_capacity(8);
        for x in [-r, r] {
            for y in [-r, r] {
                let p = self.center + DVec2::new(x, y);
                corners.extend([0.0, self.height].map(|z| p.extend(z)));
            }
        }
        corners
    }

    /// Where a ray from outside meets the side, and the outer unit normal there; `None` if it misses, or comes over the
    /// top or below the floor.
    pub fn enter(&self, origin: DVec3, direction: DVec3) -> Option<(DVec3, DVec3)> {
        let (t, _) = self.crossings(origin, direction)?;
        let point = origin + direction * t;
        let on_side = (t > 0.0) & (point.z > 0.0) & (point.z < self.height);
        on_side.then(|| {
            let normal = (point.truncate() - self.center) / self.radius;
            (point, normal.extend(0.0))
        })
    }
}

/// The pillar, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Pillar {
    body: Cylinder,
    reflectance: f64,
}

impl Pillar {
    /// Prepares a validated scene's pillar; `reflectance` replaces its own.
    pub fn new(scene: &PillarScene, reflectance: f64) -> Self {
        Pillar {
            body: Cylinder {
                center: DVec2::from_array(scene.pillar.center),
                radius: scene.pillar.radius,
                height: scene.pillar.height,
            },
            reflectance,
        }
    }
}

impl Chains for Pillar {
    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LDE, PathClass::LSDE]
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        if chain == 0 {
            let to_floor = -origin.z / direction.z;
            let free = (direction.z < 0.0) && !self.body.blocks(origin, direction, to_floor);
            return Leg {
                origin,
                direction,
                weight: f64::from(u8::from(free)),
            };
        }
        match self.body.enter(origin, direction) {
            Some((origin, normal)) => Leg {
                origin,
                direction: reflected(direction, normal),
                weight: self.reflectance,
            },
            None => Leg::DARK,
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        self.body.blocks(origin, direction, t_end)
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let (point, normal) = self.body.enter(origin, direction)?;
        Some(Vertex {
            point,
            direction: reflected(direction, normal),
            normal,
            weight: self.reflectance,
        })
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some(self.body.bounds())
    }

    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            floor.to_vec()
        } else {
            self.body.hull()
        }
    }
}
