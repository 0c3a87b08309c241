//! A concave spherical cap over the floor, seen from below its rim.

use std::sync::{Arc, OnceLock};

use libm::{cos, tan};

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::direct::FloorLight;
use crate::flux::{Bundle, MARGINS, Ray};
use crate::kinds::diffuse;
use crate::kinds::singularity::Singularity;
use crate::kinds::sphere_mirror::{Light, Side, SphereCaustic, SphereMirror};
use crate::scene::{ConcaveSphereScene, Floor};
use crate::vector::{Vec3, vec3};

#[derive(Debug)]
struct Cap {
    mirror: SphereMirror<f64>,
    light: Vec3<f64>,
    intensity: f64,
    half_angle: f64,
    floor: Floor,
    /// Made at the first question for a singularity.
    folds: OnceLock<SphereCaustic>,
}

pub(super) fn form(scene: &ConcaveSphereScene) -> impl Form + use<> {
    let cap = &scene.cap;
    let half_angle = cap.half_angle_degrees.to_radians();
    let (light, intensity) = (Vec3::from_f64(scene.light.position), scene.light.intensity);
    Cap {
        mirror: SphereMirror {
            centre: Vec3::from_f64(cap.center),
            radius: cap.radius,
            side: Side::Concave,
            cap_axis: vec3(0.0, 0.0, 1.0),
            cap_cos_min: cos(half_angle),
            reflectance: cap.reflectance,
            light: Light::Point {
                position: light,
                intensity,
            },
            receiver_z: 0.0,
        },
        light,
        intensity,
        half_angle,
        floor: scene.floor.clone(),
        folds: OnceLock::new(),
    }
}

impl Form for Cap {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let point = vec3(x, y, 0.0);
        vec![
            PointTruth::new(
                PathClass::LDE,
                diffuse::direct(self.light, self.intensity, point),
            ),
            PointTruth::new(PathClass::LSDE, self.mirror.caustic(point)),
        ]
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        let folds = self.folds.get_or_init(|| SphereCaustic::new(&self.mirror));
        (index == 1).then(|| folds.nearest(vec3(x, y, 0.0)))?
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let (light, intensity) = (self.light, self.intensity);
        let direct = FloorLight::new(&self.floor, move |x, y| {
            let e = diffuse::direct(light, intensity, vec3(x, y, 0.0));
            (e.value, [1.0; MARGINS])
        });
        let reflected = CapBundle {
            centre: self.mirror.centre,
            radius: self.mirror.radius,
            light,
            intensity,
            reflectance: self.mirror.reflectance,
            rim: tan(0.5 * self.half_angle),
            cos_rim: self.mirror.cap_cos_min,
        };
        Some(vec![vec![Arc::new(direct)], vec![Arc::new(reflected)]])
    }
}

/// The light that the cap reflects, by the mirror point: its outward normal in stereographic projection from -z, so that
/// everything is algebraic and the pole is a point like any other.
#[derive(Debug)]
struct CapBundle {
    centre: Vec3<f64>,
    radius: f64,
    light: Vec3<f64>,
    /// I [W/sr].
    intensity: f64,
    /// R.
    reflectance: f64,
    /// Stereographic radius of the rim, tan of half its angle.
    rim: f64,
    cos_rim: f64,
}

impl Bundle for CapBundle {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-self.rim, self.rim]; 2]
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let square = u[0] * u[0] + u[1] * u[1];
        let k = 1.0 / (1.0 + square);
        let normal = vec3(2.0 * u[0] * k, 2.0 * u[1] * k, (1.0 - square) * k);
        let point = self.centre + normal * self.radius;
        let leg = point - self.light;
        let r1 = leg.length();
        let travel = leg * (1.0 / r1);
        let cosine = travel.dot(normal);
        let reflected = travel - normal * (2.0 * cosine);
        // Both the incident and the reflected ray meet the sphere again after this length.
        let chord = 2.0 * self.radius * cosine;
        let off_cap = |p: Vec3<f64>| self.cos_rim - (p.z - self.centre.z) / self.radius;
        let outside = (self.light - self.centre).length() > self.radius;
        let mut margins = [1.0; MARGINS];
        margins[0] = self.rim * self.rim - square;
        margins[1] = cosine;
        margins[2] = -reflected.z;
        margins[3] = off_cap(point + reflected * chord);
        if outside {
            margins[4] = off_cap(point - travel * chord);
        }
        let t = point.z / -reflected.z;
        let area = self.radius * 2.0 * k;
        Ray {
            floor: [point.x + reflected.x * t, point.y + reflected.y * t],
            flux: self.intensity * self.reflectance * cosine / (r1 * r1) * area * area,
            margins,
        }
    }

    fn weight(&self, _: [f64; 2]) -> Option<f64> {
        Some(self.reflectance)
    }
}
