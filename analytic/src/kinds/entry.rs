//! Truth at a floor point of a catalogue entry, per path class that is seen directly there.
//!
//! Classes that end at the floor without a specular surface on the eye's side: `LDE` and `LSDE`. The water of a
//! `flat-interface` entry is entered before the floor is seen; its floor carries `LSDE` alone.

use crate::class::PathClass;
use crate::kinds::Estimate;
use crate::kinds::cylinder_cup::CylinderCup;
use crate::kinds::diffuse;
use crate::kinds::flat_interface::FlatInterface;
use crate::kinds::planar_mirror::PlanarMirror;
use crate::scene::{Entry, Floor, Kind};
use crate::vector::{Vec3, vec3};

/// The light of one path class at a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointTruth {
    /// The class.
    pub class: PathClass,
    /// Irradiance of the floor, with error bound and number of roots [W/m²].
    pub irradiance: Estimate<f64>,
    /// Distance to the nearest fold of the class's caustic [m]; `None` where there is none.
    pub singularity: Option<f64>,
}

/// The closed form of an entry's floor, made ready for many points.
#[derive(Clone, Debug)]
pub struct FloorTruth {
    form: Form,
    floor: Floor,
}

#[derive(Clone, Debug)]
enum Form {
    Diffuse { light: Vec3<f64>, intensity: f64 },
    PlanarMirror(PlanarMirror<f64>),
    CylinderCup(CylinderCup<f64>),
    FlatInterface(FlatInterface<f64>),
}

impl FloorTruth {
    /// The closed form of an entry that has passed [`Entry::validate`].
    pub fn new(entry: &Entry) -> Self {
        let form = match &entry.kind {
            Kind::Diffuse { light, .. } => Form::Diffuse {
                light: Vec3::from_f64(light.position),
                intensity: light.intensity,
            },
            Kind::PlanarMirror { light, mirror, .. } => {
                Form::PlanarMirror(PlanarMirror::from_entry(light, mirror))
            }
            Kind::CylinderCup { light, wall, .. } => {
                Form::CylinderCup(CylinderCup::from_entry(light, wall))
            }
            Kind::FlatInterface { light, water, .. } => {
                Form::FlatInterface(FlatInterface::from_entry(light, water))
            }
        };
        FloorTruth {
            form,
            floor: entry.kind.floor().clone(),
        }
    }

    /// Albedo ρ of the floor: radiance is ρ E/π.
    pub fn albedo(&self) -> f64 {
        self.floor.albedo
    }

    /// Whether (x, y) is on the clipped floor.
    pub fn is_on_floor(&self, x: f64, y: f64) -> bool {
        let [cx, cy] = self.floor.center;
        let [wx, wy] = self.floor.half_width;
        f64::abs(x - cx) <= wx && f64::abs(y - cy) <= wy
    }

    /// The light at the floor point (x, y, 0), per class.
    pub fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let point = vec3(x, y, 0.0);
        let truth = |class, irradiance, singularity| PointTruth {
            class,
            irradiance,
            singularity,
        };
        match &self.form {
            Form::Diffuse { light, intensity } => {
                let direct = diffuse::direct(*light, *intensity, point);
                vec![truth(PathClass::LDE, direct, None)]
            }
            Form::PlanarMirror(mirror) => vec![
                truth(PathClass::LDE, mirror.direct(point), None),
                truth(PathClass::LSDE, mirror.caustic(point), None),
            ],
            Form::CylinderCup(cup) => vec![
                truth(PathClass::LDE, cup.direct(x, y), None),
                truth(
                    PathClass::LSDE,
                    cup.caustic(x, y, 1),
                    cup.distance_to_fold(x, y, 1),
                ),
            ],
            Form::FlatInterface(water) => {
                vec![truth(PathClass::LSDE, water.caustic(x, y), None)]
            }
        }
    }
}
