//! Radiance of planar scenes over pixels: smooth irradiance on clipped polygons.

use crate::camera::Bounded;
use crate::pixel::planar::{Eye, Light, PlanarView};
use crate::scene::{DiffuseScene, Entry, Kind, PlanarMirrorScene};
use crate::vector::Vec3;

/// One layer: where it is, and the (virtual) light it sees.
#[derive(Clone, Copy, Debug)]
struct Layer {
    eye: Eye,
    light: Light,
    source: Vec3<f64>,
    /// ρ/π, intensity and reflectances.
    weight: f64,
}

/// The exact image of a planar scene.
#[derive(Clone, Debug)]
pub struct PlanarImage {
    view: PlanarView,
    layers: Vec<Layer>,
}

impl PlanarImage {
    /// Prepares a validated entry; `None` if its kind is not planar.
    pub fn new(entry: &Entry) -> Option<Self> {
        let view = PlanarView::new(entry)?;
        let layer = |eye, light, source, weight| Layer {
            eye,
            light,
            source,
            weight,
        };
        let layers = match &entry.kind {
            Kind::PlanarMirror(PlanarMirrorScene {
                light,
                floor,
                mirror,
            }) => {
                let source = Vec3::from_f64(light.position);
                let normal = Vec3::from_f64(mirror.normal).normalized();
                let height = (source - Vec3::from_f64(mirror.center)).dot(normal);
                let image = source - normal * (2.0 * height);
                let once = light.intensity * floor.albedo / core::f64::consts::PI;
                let r = mirror.reflectance;
                vec![
                    layer(Eye::Direct, Light::Direct, source, once),
                    layer(Eye::Direct, Light::Mirror, image, once * r),
                    layer(Eye::Mirror, Light::Direct, source, once * r),
                    layer(Eye::Mirror, Light::Mirror, image, once * r * r),
                ]
            }
            Kind::Diffuse(DiffuseScene { light, floor }) => vec![layer(
                Eye::Direct,
                Light::Direct,
                Vec3::from_f64(light.position),
                light.intensity * floor.albedo / core::f64::consts::PI,
            )],
            _ => return None,
        };
        Some(PlanarImage { view, layers })
    }

    /// Row `j`, `[class][column]`.
    pub fn row(&self, j: u32, tolerance: f64, row: &mut [Vec<Bounded>]) {
        for (layer, out) in self.layers.iter().zip(row) {
            let radiance = |x: Vec3<f64>| {
                // E = I cos θ / D² with cos θ = h / D.
                let to = layer.source - x;
                let d2 = to.length_squared();
                layer.weight * to.z / (d2 * d2.sqrt())
            };
            for (i, out) in (0..).zip(out) {
                let (eye, light) = (layer.eye, layer.light);
                *out = (self.view).integrate(eye, light, (i, j), tolerance, 0.0, radiance);
            }
        }
    }
}
