//! A glass pillar: a solid cylinder of smooth dielectric on the floor. Its top, and the floor under it, absorb.
//!
//! Chain m has m interactions with the side: one reflection outside, or a way in, m - 2 reflections inside and a way out.

use glam::{DVec2, DVec3};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, GlassPillarScene};

use super::chains::{Chains, Leg, Vertex};
use super::dielectric::refract;
use super::pillar::Cylinder;
use super::specular::reflected;

/// The pillar, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct GlassPillar {
    body: Cylinder,
    index: f64,
    classes: &'static [PathClass],
}

impl GlassPillar {
    /// Prepares a validated scene's pillar.
    pub fn new(scene: &GlassPillarScene) -> Self {
        GlassPillar {
            body: Cylinder {
                center: DVec2::from_array(scene.pillar.center),
                radius: scene.pillar.radius,
                height: scene.pillar.height,
            },
            index: scene.pillar.index,
            classes: scene.classes(),
        }
    }

    /// From the side through the glass to the side again; `None` if the ray ends on the floor, or at the top, before.
    fn across(&self, point: DVec3, direction: DVec3) -> Option<(DVec3, DVec3)> {
        let (_, t) = self.body.crossings(point, direction)?;
        let end = point + direction * t;
        let outward = (end.truncate() - self.body.center) / self.body.radius;
        let on_side = (end.z > 0.0) & (end.z < self.body.height);
        on_side.then(|| (end, -outward.extend(0.0)))
    }

    /// The way through the glass with `reflections` inside.
    fn through(&self, point: DVec3, normal: DVec3, d: DVec3, reflections: usize) -> Option<Vertex> {
        let (mut d, reflectance) = refract(d, normal, self.index);
        let mut weight = 1.0 - reflectance;
        let (mut point, mut normal) = self.across(point, d)?;
        for _ in 0..reflections {
            weight *= refract(d, normal, 1.0 / self.index).1;
            d = reflected(d, normal);
            (point, normal) = self.across(point, d)?;
        }
        let (out, reflectance) = refract(d, normal, 1.0 / self.index);
        Some(Vertex {
            point,
            direction: out,
            // Inside, the normal was on the side of the glass.
            normal: -normal,
            weight: weight * (1.0 - reflectance),
        })
    }
}

impl Chains for GlassPillar {
    fn classes(&self) -> &'static [PathClass] {
        self.classes
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
        let d = direction / f64::sqrt(direction.dot(direction));
        match self.strike(chain, origin, d) {
            Some(Vertex {
                point,
                direction,
                weight,
                ..
            }) => Leg {
                origin: point,
                direction,
                weight,
            },
            None => Leg::DARK,
        }
    }

    fn strike(&self, chain: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let (point, normal) = self.body.enter(origin, direction)?;
        if chain == 1 {
            return Some(Vertex {
                point,
                direction: reflected(direction, normal),
                normal,
                weight: refract(direction, normal, self.index).1,
            });
        }
        self.through(point, normal, direction, chain.checked_sub(2)?)
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some(self.body.bounds())
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        self.body.blocks(origin, direction, t_end)
    }

    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            floor.to_vec()
        } else {
            self.body.hull()
        }
    }
}
