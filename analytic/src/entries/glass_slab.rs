//! A glass slab over the floor, seen from below the slab.

use std::sync::Arc;

use super::{Form, PointTruth};
use crate::flux::{Bundle, MARGINS, Ray};
use crate::kinds::glass_slab::GlassSlab;
use crate::kinds::power;
use crate::scene::{Family, Floor, GlassSlabScene};
use crate::vector::Vec3;

#[derive(Debug)]
struct Slab {
    form: GlassSlab<f64>,
    scene: GlassSlabScene,
}

pub(super) fn form(scene: &GlassSlabScene) -> impl Form + use<> {
    Slab {
        form: GlassSlab {
            bottom: scene.slab.bottom,
            top: scene.slab.top,
            index: scene.slab.index,
            light: Vec3::from_f64(scene.light.position),
            intensity: scene.light.intensity,
            receiver_z: 0.0,
        },
        scene: scene.clone(),
    }
}

impl Form for Slab {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        (0..)
            .zip(self.scene.classes())
            .map(|(order, &class)| PointTruth::new(class, self.form.caustic(x, y, order)))
            .collect()
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let layer = |order| -> Vec<Arc<dyn Bundle>> {
            vec![Arc::new(OrderBundle {
                form: self.form,
                floor: self.scene.floor.clone(),
                order,
            })]
        };
        let orders = 0..self.scene.classes().len() as u32;
        Some(orders.map(layer).collect())
    }
}

/// One order as a bundle whose parameter is the floor point itself: the irradiance is smooth.
#[derive(Debug)]
struct OrderBundle {
    form: GlassSlab<f64>,
    floor: Floor,
    order: u32,
}

impl Bundle for OrderBundle {
    fn domain(&self) -> [[f64; 2]; 2] {
        let ([cx, cy], [wx, wy]) = (self.floor.center, self.floor.half_width);
        [[cx - wx, cx + wx], [cy - wy, cy + wy]]
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        Ray {
            floor: u,
            flux: self.form.root(u[0], u[1], self.order).irradiance,
            margins: [1.0; MARGINS],
        }
    }

    fn weight(&self, u: [f64; 2]) -> Option<f64> {
        let root = self.form.root(u[0], u[1], self.order);
        let inside = power(root.reflectance, 2 * self.order);
        Some(root.transmittance * root.transmittance * inside)
    }
}
