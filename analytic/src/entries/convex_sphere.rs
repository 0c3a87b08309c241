//! A mirror ball over the floor, outside the frame.

use std::sync::Arc;

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::direct::FloorLight;
use crate::flux::{Bundle, MARGINS};
use crate::kinds::diffuse;
use crate::kinds::sphere_mirror::{Light, Side, SphereMirror};
use crate::scene::{ConvexSphereScene, Floor};
use crate::vector::{Vec3, vec3};

#[derive(Debug)]
struct Ball {
    mirror: SphereMirror<f64>,
    light: Vec3<f64>,
    intensity: f64,
    floor: Floor,
}

pub(super) fn form(scene: &ConvexSphereScene) -> impl Form + use<> {
    let ball = &scene.ball;
    let (light, intensity) = (Vec3::from_f64(scene.light.position), scene.light.intensity);
    Ball {
        mirror: SphereMirror {
            centre: Vec3::from_f64(ball.center),
            radius: ball.radius,
            side: Side::Convex,
            cap_axis: vec3(0.0, 0.0, 1.0),
            cap_cos_min: -1.0,
            reflectance: ball.reflectance,
            light: Light::Point {
                position: light,
                intensity,
            },
            receiver_z: 0.0,
        },
        light,
        intensity,
        floor: scene.floor.clone(),
    }
}

/// Positive where the line from the light to (x, y, 0) passes the ball: |d|² (|w|² - a²) - (d·w)², with d and w the way
/// from the light to the point and to the centre. Both nappes of the cone are excluded, but only one meets the floor.
fn clearance(light: Vec3<f64>, centre: Vec3<f64>, radius: f64, x: f64, y: f64) -> f64 {
    let (d, w) = (vec3(x, y, 0.0) - light, centre - light);
    let along = d.dot(w);
    d.length_squared() * (w.length_squared() - radius * radius) - along * along
}

impl Form for Ball {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let point = vec3(x, y, 0.0);
        vec![
            PointTruth::new(PathClass::LDE, self.mirror.direct(point)),
            PointTruth::new(PathClass::LSDE, self.mirror.caustic(point)),
        ]
    }

    /// Both irradiances are smooth functions of the floor point up to the edge of the same shadow, where the reflected one
    /// goes to zero in proportion to the distance.
    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let (mirror, light, intensity) = (self.mirror, self.light, self.intensity);
        let margins = move |x: f64, y: f64| {
            let mut margins = [1.0; MARGINS];
            margins[0] = clearance(light, mirror.centre, mirror.radius, x, y);
            margins
        };
        let direct = FloorLight::new(&self.floor, move |x, y| {
            let e = diffuse::direct(light, intensity, vec3(x, y, 0.0));
            (e.value, margins(x, y))
        });
        let reflected = FloorLight::new(&self.floor, move |x, y| {
            let mut sum = 0.0;
            mirror.for_each_lit_root(vec3(x, y, 0.0), |root| sum += root.irradiance);
            (sum, margins(x, y))
        })
        .with_weight(mirror.reflectance);
        Some(vec![vec![Arc::new(direct)], vec![Arc::new(reflected)]])
    }
}
