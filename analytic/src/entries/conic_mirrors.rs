//! A conic of revolution over the floor with the light at one focus.
//!
//! [`Ellipsoid`] and [`Hyperboloid`] have the mirror below a receiver that faces down, and the origin in the centre: this is
//! that scene in a horizontal mirror.

use std::sync::Arc;

use super::axial::AxialLight;
use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::direct::FloorLight;
use crate::flux::{Bundle, MARGINS, Ray};
use crate::kinds::conic_mirrors::{Ellipsoid, Hyperboloid, Root};
use crate::kinds::singularity::Singularity;
use crate::kinds::{Estimate, rounding_error};
use crate::scene::{Conic, ConicMirrorsScene, Floor};

#[derive(Clone, Copy, Debug)]
enum Shape {
    Ellipsoid(Ellipsoid<f64>),
    Hyperboloid(Hyperboloid<f64>),
}

impl Shape {
    fn reflection(&self, x: f64, y: f64) -> Option<Root<f64>> {
        match self {
            Shape::Ellipsoid(m) => m.reflection(x, y),
            Shape::Hyperboloid(m) => m.reflection(x, y),
        }
    }
}

#[derive(Debug)]
struct Mirror {
    shape: Shape,
    direct: AxialLight,
    conic: Conic,
    floor: Floor,
}

pub(super) fn form(scene: &ConicMirrorsScene) -> impl Form + use<> {
    let (conic, intensity) = (&scene.conic, scene.light.intensity);
    let (semi_axis, eccentricity) = (conic.semi_axis, conic.eccentricity);
    let reflectance = conic.reflectance;
    Mirror {
        shape: if conic.is_ellipsoid() {
            Shape::Ellipsoid(Ellipsoid {
                semi_axis,
                eccentricity,
                defocus: conic.image_z,
                intensity,
                reflectance,
            })
        } else {
            Shape::Hyperboloid(Hyperboloid {
                semi_axis,
                eccentricity,
                receiver_z: conic.center_z(),
                intensity,
                reflectance,
            })
        },
        direct: AxialLight::new(
            conic.center,
            conic.light_z(),
            intensity,
            (conic.rim_radius(), conic.rim_z),
        ),
        conic: conic.clone(),
        floor: scene.floor.clone(),
    }
}

impl Mirror {
    /// The light of the root at (x, y), relative to the axis, where its mirror point is inside the rim.
    fn caustic(&self, x: f64, y: f64) -> Estimate<f64> {
        let Some(root) = self.shape.reflection(x, y) else {
            return Estimate::NONE;
        };
        let z = self.conic.center_z() - root.specular_point.z;
        let inside = if self.conic.is_ellipsoid() {
            z - self.conic.rim_z
        } else {
            self.conic.rim_z - z
        };
        let mut sum = Estimate::NONE;
        if inside >= 0.0 {
            sum.add(root.irradiance, root.conditioning);
        }
        // Rounding decides on the edge of the disc.
        let size = self.conic.semi_axis + self.conic.rim_z;
        if inside.abs() <= rounding_error(size, root.conditioning) {
            sum.error += root.irradiance;
        }
        sum
    }
}

impl Form for Mirror {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let (rx, ry) = (x - self.conic.center[0], y - self.conic.center[1]);
        vec![
            self.direct.at(x, y),
            PointTruth::new(PathClass::LSDE, self.caustic(rx, ry)),
        ]
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        let (rx, ry) = (x - self.conic.center[0], y - self.conic.center[1]);
        match &self.shape {
            Shape::Ellipsoid(m) if index == 1 => m.singularity(rx, ry),
            _ => None,
        }
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let (conic, shape) = (&self.conic, self.shape);
        // Slope of the ray by the rim, measured from the vertical; infinite if it does not go down.
        let drop = match shape {
            Shape::Ellipsoid(_) => conic.rim_z - conic.image_z,
            Shape::Hyperboloid(_) => conic.image_z - conic.rim_z,
        };
        let slope = if drop > 0.0 {
            conic.rim_radius() / drop
        } else {
            f64::INFINITY
        };
        let reflected: Arc<dyn Bundle> = match shape {
            Shape::Ellipsoid(mirror) => Arc::new(FocusBundle {
                unit: Ellipsoid {
                    defocus: 1.0,
                    ..mirror
                },
                drop: conic.image_z,
                axis: conic.center,
                slope,
            }),
            Shape::Hyperboloid(mirror) => {
                let ([ax, ay], lit) = (conic.center, slope * conic.image_z);
                let light = FloorLight::new(&self.floor, move |x, y| {
                    let (x, y) = (x - ax, y - ay);
                    let mut margins = [1.0; MARGINS];
                    if lit < f64::INFINITY {
                        margins[0] = lit * lit - (x * x + y * y);
                    }
                    let root = mirror.reflection(x, y);
                    (root.map_or(0.0, |r| r.irradiance), margins)
                });
                Arc::new(light.with_weight(mirror.reflectance))
            }
        };
        Some(vec![vec![self.direct.bundle(&self.floor)], vec![reflected]])
    }
}

/// The light that comes from an ellipsoid, by the slope of the ray in the focus: smooth however near the floor is, and the
/// same flux at every distance, so that nothing is special about a floor in the focus.
#[derive(Debug)]
struct FocusBundle {
    /// The mirror, with a receiver 1 m from the focus.
    unit: Ellipsoid<f64>,
    /// From the floor up to the focus [m].
    drop: f64,
    axis: [f64; 2],
    /// The largest slope.
    slope: f64,
}

impl Bundle for FocusBundle {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-self.slope, self.slope]; 2]
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let root = self.unit.reflection(u[0], u[1]);
        let mut margins = [1.0; MARGINS];
        margins[0] = self.slope * self.slope - (u[0] * u[0] + u[1] * u[1]);
        Ray {
            floor: [0, 1].map(|k| self.axis[k] + u[k] * self.drop),
            flux: root.map_or(0.0, |r| r.irradiance),
            margins,
        }
    }

    fn weight(&self, _: [f64; 2]) -> Option<f64> {
        Some(self.unit.reflectance)
    }
}
