//! A glass ball in light that comes straight down, and the floor below it.

use core::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use libm::{cos, hypot, sin};

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::{Bundle, MARGINS, Ray};
use crate::kinds::glass_sphere::GlassSphere;
use crate::kinds::singularity::Singularity;
use crate::kinds::{Estimate, rounding_error};
use crate::scene::{Family, Floor, GlassSphereScene};

#[derive(Clone, Debug)]
struct Ball {
    form: GlassSphere<f64>,
    center: [f64; 2],
    floor: Floor,
    classes: &'static [PathClass],
}

pub(super) fn form(scene: &GlassSphereScene) -> impl Form + use<> {
    let [x, y, z] = scene.glass.center;
    Ball {
        form: GlassSphere {
            index: scene.glass.index,
            radius: scene.glass.radius,
            irradiance: scene.light.irradiance,
            receiver_z: z,
            max_incidence: FRAC_PI_2,
        },
        center: [x, y],
        floor: scene.floor.clone(),
        classes: scene.classes(),
    }
}

/// Interactions with the ball of each class; 0 for direct light.
fn interactions(class: &PathClass) -> u32 {
    class.light.len() as u32
}

impl Ball {
    /// Direct light: all but the disc below the ball.
    fn direct(&self, rho: f64, size: f64) -> Estimate<f64> {
        let irradiance = self.form.irradiance;
        let mut sum = Estimate::NONE;
        if rho > self.form.radius {
            sum.add(irradiance, 0.0);
        }
        if f64::abs(rho - self.form.radius) <= rounding_error(size, 0.0) {
            sum.error += irradiance;
        }
        sum
    }
}

impl Form for Ball {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let [cx, cy] = self.center;
        let rho = hypot(x - cx, y - cy);
        let size = x.abs() + y.abs() + cx.abs() + cy.abs() + self.form.radius;
        // The distance is a difference: what it is known to, relative to itself.
        let relative = if rho > 0.0 {
            f64::EPSILON * size / rho
        } else {
            0.0
        };
        self.classes
            .iter()
            .map(|class| match interactions(class) {
                0 => PointTruth::new(*class, self.direct(rho, size)),
                m => PointTruth::new(*class, self.form.caustic(rho, m).displaced(relative)),
            })
            .collect()
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        let [cx, cy] = self.center;
        match interactions(self.classes.get(index)?) {
            0 => None,
            m => self.form.singularity(hypot(x - cx, y - cy), m),
        }
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let layer = |class: &PathClass| -> Vec<Arc<dyn Bundle>> {
            match interactions(class) {
                0 => vec![Arc::new(Sun(self.clone())), Arc::new(Shadow(self.clone()))],
                m => vec![Arc::new(Caustic::new(self, m))],
            }
        };
        Some(self.classes.iter().map(layer).collect())
    }
}

/// The beam without the ball; the parameter is the floor point.
#[derive(Debug)]
struct Sun(Ball);

impl Bundle for Sun {
    fn domain(&self) -> [[f64; 2]; 2] {
        let ([cx, cy], [wx, wy]) = (self.0.floor.center, self.0.floor.half_width);
        [[cx - wx, cx + wx], [cy - wy, cy + wy]]
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        Ray {
            floor: u,
            flux: self.0.form.irradiance,
            margins: [1.0; MARGINS],
        }
    }
}

/// What the ball takes from it, in polar coordinates of the floor.
#[derive(Debug)]
struct Shadow(Ball);

impl Bundle for Shadow {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, self.0.form.radius], [0.0, TAU]]
    }

    fn ray(&self, [rho, azimuth]: [f64; 2]) -> Ray {
        let [cx, cy] = self.0.center;
        Ray {
            floor: [cx + rho * cos(azimuth), cy + rho * sin(azimuth)],
            flux: -rho * self.0.form.irradiance,
            margins: [1.0; MARGINS],
        }
    }
}

/// Rays by incidence angle and azimuth.
#[derive(Debug)]
struct Caustic {
    ball: Ball,
    interactions: u32,
    /// Every floor point is well within this distance of the axis [m]: this limit and the floor's corners do not meet.
    reach: f64,
}

impl Caustic {
    fn new(ball: &Ball, interactions: u32) -> Self {
        let ([cx, cy], [wx, wy]) = (ball.floor.center, ball.floor.half_width);
        let [dx, dy] = [cx - ball.center[0], cy - ball.center[1]];
        Caustic {
            ball: ball.clone(),
            interactions,
            reach: 1.5 * hypot(dx.abs() + wx, dy.abs() + wy),
        }
    }
}

impl Bundle for Caustic {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, FRAC_PI_2], [0.0, TAU]]
    }

    fn ray(&self, [incidence, azimuth]: [f64; 2]) -> Ray {
        let rays = self.ball.form.landing_of(incidence, self.interactions);
        let [cx, cy] = self.ball.center;
        let distance = rays.offset / rays.cosine;
        // |distance| ≤ reach on the way down, without the pole of rays along the floor: both imply a positive cosine.
        let mut margins = [1.0; MARGINS];
        margins[0] = self.reach * rays.cosine - rays.offset;
        margins[1] = self.reach * rays.cosine + rays.offset;
        Ray {
            floor: [cx + distance * cos(azimuth), cy + distance * sin(azimuth)],
            flux: rays.flux,
            margins,
        }
    }

    fn weight(&self, [incidence, _]: [f64; 2]) -> Option<f64> {
        Some(self.ball.form.weight_of(incidence, self.interactions))
    }
}
