//! A paraboloid mirror over the floor with the light at its focus.
//!
//! [`Paraboloid`] has the dish below a receiver that faces down: this is that scene in a horizontal mirror, with the vertex
//! in the origin.

use std::sync::Arc;

use super::axial::AxialLight;
use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::direct::FloorLight;
use crate::flux::{Bundle, MARGINS};
use crate::kinds::paraboloid::{Light, Paraboloid};
use crate::scene::{Floor, ParaboloidScene};

#[derive(Debug)]
struct Dish {
    mirror: Paraboloid<f64>,
    direct: AxialLight,
    floor: Floor,
}

pub(super) fn form(scene: &ParaboloidScene) -> impl Form + use<> {
    let (dish, intensity) = (&scene.dish, scene.light.intensity);
    let rim = (dish.outer_radius, dish.rim_z());
    Dish {
        mirror: Paraboloid {
            focal_length: dish.focal_length,
            reflectance: dish.reflectance,
            light: Light::Focus(intensity),
            receiver_z: dish.vertex_z,
            inner_radius: dish.inner_radius,
            outer_radius: dish.outer_radius,
        },
        direct: AxialLight::new(dish.center, dish.focus_z(), intensity, rim),
        floor: scene.floor.clone(),
    }
}

impl Form for Dish {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let [ax, ay] = self.direct.axis;
        vec![
            self.direct.at(x, y),
            PointTruth::new(PathClass::LSDE, self.mirror.caustic(x - ax, y - ay)),
        ]
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let (mirror, [ax, ay]) = (self.mirror, self.direct.axis);
        let (inner, outer) = (mirror.inner_radius, mirror.outer_radius);
        let beam = FloorLight::new(&self.floor, move |x, y| {
            let (x, y) = (x - ax, y - ay);
            let square = x * x + y * y;
            let mut margins = [1.0; MARGINS];
            margins[0] = outer * outer - square;
            if inner > 0.0 {
                margins[1] = square - inner * inner;
            }
            (
                mirror.reflection(x, y).map_or(0.0, |r| r.irradiance),
                margins,
            )
        })
        .with_weight(mirror.reflectance);
        Some(vec![
            vec![self.direct.bundle(&self.floor)],
            vec![Arc::new(beam)],
        ])
    }
}
