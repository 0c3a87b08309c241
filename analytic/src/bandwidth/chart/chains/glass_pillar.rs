//! Chains of a vertical glass cylinder in parallel light.
//!
//! In plan a ray of the elevation e is refracted at the index n' = √(n² − sin² e)/cos e, whichever way it goes
//! ([`crate::kinds::glass_pillar`]), and turns as in a glass ball's meridian: w' = w (−1)^m e^{−2ii} e^{2(m−1)ir}, last
//! normal w' e^{ii}. Along every chord 2a cos r it goes up or down by tan e · 2a cos r/n'. A receiver point at the plan distance d from
//! the axis has rays with sin ψ = (a/d) sin i, and a plan length d cos ψ − a cos i outside. The top absorbs: all of the path
//! is below it. What leaves the side meets nothing, the cylinder being convex.

use core::f64::consts::FRAC_PI_2;

use libm::{asin, atan, atan2, cos, hypot, sin, sincos, sqrt};

use crate::bandwidth::chart::chain::{Chain, OWN, Subpath, Subpaths};
use crate::kinds::power;
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::scene::GlassCylinder;
use crate::vector::{Vec3, vec3};

/// Light after a number of interactions with the side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pillar {
    center: [f64; 2],
    radius: f64,
    height: f64,
    index: f64,
    interactions: u32,
    /// Its elevation, and the azimuth of its travel [rad].
    elevation: f64,
    azimuth: f64,
    irradiance: f64,
}

impl Pillar {
    pub fn new(
        glass: &GlassCylinder,
        (beam, irradiance): (Vec3<f64>, f64),
        interactions: u32,
    ) -> Self {
        Pillar {
            center: glass.center,
            radius: glass.radius,
            height: glass.height,
            index: glass.index,
            interactions,
            elevation: atan2(-beam.z, hypot(beam.x, beam.y)),
            azimuth: atan2(beam.y, beam.x),
            irradiance,
        }
    }

    /// What becomes of a ray with the incidence `i` and the azimuth `w` in plan, and the elevation `e` (cosine, sine).
    fn through(&self, i: f64, w: f64, (ce, se): (f64, f64)) -> Through {
        let (m, n) = (self.interactions, self.index);
        let (sine, cosine) = sincos(i);
        let bent = sqrt((n - se) * (n + se));
        // n' = bent/cos e.
        let r = asin(sine * ce / bent);
        let chords = f64::from(m - 1);
        let turned = w - 2.0 * i + 2.0 * chords * r + f64::from(m) * core::f64::consts::PI;
        let outer = ce * cosine;
        let inner = sqrt((n - 1.0) * (n + 1.0) + outer * outer);
        let f = fresnel_reflectance(1.0, outer, n, inner);
        let weight = if m == 1 {
            f
        } else {
            let t = fresnel_transmittance(1.0, outer, n, inner);
            t * t * power(f, m - 2)
        };
        Through {
            turned,
            normal: vec3(cos(turned + i), sin(turned + i), 0.0),
            // tan e/n' times the chords.
            rise: se / bent * chords * 2.0 * self.radius * cos(r),
            weight,
        }
    }

    fn at(&self, normal: Vec3<f64>, z: f64) -> Vec3<f64> {
        let a = self.radius;
        vec3(
            self.center[0] + a * normal.x,
            self.center[1] + a * normal.y,
            z,
        )
    }
}

struct Through {
    /// Azimuth of the plan direction afterwards [rad].
    turned: f64,
    /// Outward normal where the ray leaves.
    normal: Vec3<f64>,
    /// Change of height inside [m].
    rise: f64,
    weight: f64,
}

impl Chain for Pillar {
    fn receiver_paths<'a>(&'a self, x: Vec3<f64>) -> Option<Box<dyn Subpaths + 'a>> {
        let (dx, dy) = (self.center[0] - x.x, self.center[1] - x.y);
        let distance = hypot(dx, dy);
        (distance > self.radius).then(|| {
            Box::new(FromReceiver {
                pillar: self,
                distance,
                azimuth: atan2(dy, dx),
                base: x.z,
            }) as Box<dyn Subpaths>
        })
    }

    fn light_paths<'a>(&'a self) -> Box<dyn Subpaths + 'a> {
        Box::new(FromLight(self))
    }

    /// As for the ball.
    fn is_mirror(&self) -> bool {
        false
    }
}

/// Paths from a floor point by incidence and elevation.
#[derive(Debug)]
struct FromReceiver<'a> {
    pillar: &'a Pillar,
    /// d.
    distance: f64,
    /// Of the axis.
    azimuth: f64,
    /// Height of the floor [m].
    base: f64,
}

impl Subpaths for FromReceiver<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        let nearest = self.distance - self.pillar.radius;
        let highest = atan((self.pillar.height - self.base) / nearest);
        [[-FRAC_PI_2, FRAC_PI_2], [0.0, highest]]
    }

    fn path(&self, [i, e]: [f64; 2]) -> Subpath {
        let pillar = self.pillar;
        let (se, ce) = sincos(e);
        let ratio = pillar.radius / self.distance;
        let lateral = ratio * sin(i);
        let ahead = sqrt((1.0 - lateral) * (1.0 + lateral));
        let t = pillar.through(i, self.azimuth + asin(lateral), (ce, se));
        let plan = self.distance * ahead - pillar.radius * cos(i);
        let z = self.base + plan * se / ce + t.rise;
        let mut margins = [1.0; OWN];
        margins[0] = pillar.height - z;
        Subpath {
            vertex: pillar.at(t.normal, z),
            normal: t.normal,
            exact: vec3(ce * cos(t.turned), ce * sin(t.turned), se),
            // dψ = (a/d) cos i/cos ψ di.
            measure: se * ce * ratio * cos(i) / ahead,
            weight: t.weight,
            length: 0.0,
            sheet: 1.0,
            margins,
        }
    }
}

/// Rays of the beam by incidence and by the height where they leave: near the floor a linked kernel is as narrow as that is low.
#[derive(Debug)]
struct FromLight<'a>(&'a Pillar);

impl Subpaths for FromLight<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [0.0, self.0.height]]
    }

    fn is_above_floor(&self) -> bool {
        true
    }

    fn path(&self, [i, z]: [f64; 2]) -> Subpath {
        let pillar = self.0;
        let (se, ce) = sincos(pillar.elevation);
        let t = pillar.through(i, pillar.azimuth, (ce, se));
        let mut margins = [1.0; OWN];
        margins[0] = pillar.height - t.rise - z;
        Subpath {
            vertex: pillar.at(t.normal, z),
            normal: t.normal,
            exact: vec3(ce * cos(t.turned), ce * sin(t.turned), -se),
            measure: pillar.irradiance * ce * pillar.radius * cos(i),
            weight: t.weight,
            length: 0.0,
            sheet: 1.0,
            margins,
        }
    }
}
