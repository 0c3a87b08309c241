//! The ranges in which the closed forms hold, checked before anything is computed.

use libm::{hypot, sqrt};

use crate::scene::{
    Camera, DirectionalLight, Entry, Floor, InvalidParameter, PointLight, RectangleMirror,
    VerticalLight, Water,
};

/// Nothing, or the first parameter that is out of range.
pub(super) type Checked = Result<(), InvalidParameter>;

/// Lengths and strengths beyond this are refused: they overflow when squared a few times.
pub(super) const LARGEST: f64 = 1e9;
/// Lengths and strengths below this are refused for the same reason.
pub(super) const SMALLEST: f64 = 1e-9;

/// The error for a key.
pub(super) fn invalid(
    key: &str,
    found: impl core::fmt::Display,
    allowed: &str,
) -> InvalidParameter {
    InvalidParameter {
        key: key.to_owned(),
        found: found.to_string(),
        allowed: allowed.to_owned(),
    }
}

/// `value` in [low, high].
pub(super) fn within(key: &str, value: f64, low: f64, high: f64) -> Checked {
    if value >= low && value <= high {
        Ok(())
    } else {
        Err(invalid(
            key,
            value,
            &format!("a finite number from {low} to {high}"),
        ))
    }
}

/// `value` in (low, high].
pub(super) fn above(key: &str, value: f64, low: f64, high: f64) -> Checked {
    if value > low && value <= high {
        Ok(())
    } else {
        Err(invalid(
            key,
            value,
            &format!("a finite number greater than {low}, at most {high}"),
        ))
    }
}

/// A length or strength that does not overflow when squared a few times.
pub(super) fn positive(key: &str, value: f64) -> Checked {
    within(key, value, SMALLEST, LARGEST)
}

/// Coordinates of a point [m].
pub(super) fn coordinates(key: &str, v: &[f64]) -> Checked {
    v.iter()
        .try_for_each(|&c| within(key, c, -LARGEST, LARGEST))
}

/// A direction of any length.
pub(super) fn direction(key: &str, v: &[f64; 3]) -> Checked {
    coordinates(key, v)?;
    let length = hypot(hypot(v[0], v[1]), v[2]);
    if length >= SMALLEST {
        Ok(())
    } else {
        Err(invalid(
            key,
            format!("{v:?}"),
            "a vector of length 1e-9 or more",
        ))
    }
}

impl Entry {
    /// Checks every parameter against the range in which the closed forms and the closure hold.
    ///
    /// # Errors
    /// The first parameter that is out of range, with its key and what is allowed.
    pub fn validate(&self) -> Checked {
        let name_is_plain = !self.name.is_empty()
            && self.name.len() <= 64
            && self
                .name
                .bytes()
                .all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-');
        if !name_is_plain {
            return Err(invalid(
                "name",
                format!("{:?}", self.name),
                "1 to 64 lower-case letters, digits and hyphens",
            ));
        }
        self.camera.validate()?;
        if let Some(floor) = self.kind.floor() {
            floor.validate()?;
        }
        self.kind.family().validate(&self.camera)
    }
}

impl PointLight {
    pub(super) fn validate(&self, floor_z: f64) -> Checked {
        coordinates("light.position", &self.position)?;
        if !(self.position[2] > floor_z) {
            return Err(invalid(
                "light.position",
                format!("{:?}", self.position),
                &format!("z greater than {floor_z}"),
            ));
        }
        positive("light.intensity", self.intensity)
    }
}

impl DirectionalLight {
    pub(super) fn validate(&self) -> Checked {
        within("light.elevation_degrees", self.elevation_degrees, 1.0, 85.0)?;
        positive("light.irradiance", self.irradiance)
    }
}

impl VerticalLight {
    pub(super) fn validate(&self) -> Checked {
        positive("light.irradiance", self.irradiance)
    }
}

impl Floor {
    pub(super) fn validate(&self) -> Checked {
        coordinates("floor.center", &self.center)?;
        self.half_width
            .iter()
            .try_for_each(|&w| positive("floor.half_width", w))?;
        above("floor.albedo", self.albedo, 0.0, 1.0)
    }
}

impl RectangleMirror {
    pub(super) fn validate(&self) -> Checked {
        coordinates("mirror.center", &self.center)?;
        direction("mirror.normal", &self.normal)?;
        direction("mirror.edge", &self.edge)?;
        let dot: f64 = self.normal.iter().zip(&self.edge).map(|(a, b)| a * b).sum();
        let length = |v: &[f64; 3]| sqrt(v.iter().map(|c| c * c).sum());
        if !(dot.abs() <= 1e-12 * length(&self.normal) * length(&self.edge)) {
            return Err(invalid(
                "mirror.edge",
                format!("{:?}", self.edge),
                "a direction perpendicular to mirror.normal, to 1e-12",
            ));
        }
        positive("mirror.half_width", self.half_width)?;
        positive("mirror.half_height", self.half_height)?;
        // The lowest corner must not be below the floor: what is below it does not exist for the closed form.
        let unit = |v: &[f64; 3]| v.map(|c| c / length(v));
        let (n, e) = (unit(&self.normal), unit(&self.edge));
        let other_z = n[0] * e[1] - n[1] * e[0];
        let lowest =
            self.center[2] - e[2].abs() * self.half_width - other_z.abs() * self.half_height;
        if !(lowest >= -1e-12) {
            return Err(invalid(
                "mirror.center",
                format!("{:?}", self.center),
                "a mirror with no point below z = 0",
            ));
        }
        above("mirror.reflectance", self.reflectance, 0.0, 1.0)
    }

    pub(super) fn check_in_front(&self, key: &str, point: &[f64; 3]) -> Checked {
        let side: f64 = (0..3)
            .map(|i| (point[i] - self.center[i]) * self.normal[i])
            .sum();
        if side > 0.0 {
            Ok(())
        } else {
            Err(invalid(
                key,
                format!("{point:?}"),
                "a point in front of the mirror",
            ))
        }
    }
}

impl Water {
    pub(super) fn validate(&self) -> Checked {
        positive("water.surface_z", self.surface_z)?;
        above("water.index", self.index, 1.0, 10.0)
    }
}

impl Camera {
    pub(super) fn validate(&self) -> Checked {
        coordinates("camera.position", &self.position)?;
        coordinates("camera.look_at", &self.look_at)?;
        direction("camera.up", &self.up)?;
        within(
            "camera.field_of_view_degrees",
            self.field_of_view_degrees,
            0.1,
            150.0,
        )?;
        for (key, value) in [("camera.width", self.width), ("camera.height", self.height)] {
            if !(1..=8192).contains(&value) {
                return Err(invalid(key, value, "a whole number from 1 to 8192"));
            }
        }
        if !(self.position[2] > 0.0) {
            return Err(invalid(
                "camera.position",
                format!("{:?}", self.position),
                "z greater than 0",
            ));
        }
        let f: [f64; 3] = core::array::from_fn(|i| self.look_at[i] - self.position[i]);
        let u = self.up;
        let c = [
            f[1] * u[2] - f[2] * u[1],
            f[2] * u[0] - f[0] * u[2],
            f[0] * u[1] - f[1] * u[0],
        ];
        let length = |v: [f64; 3]| sqrt(v.iter().map(|c| c * c).sum());
        if length(f) > 0.0 && length(c) > 1e-9 * length(f) * length(u) {
            Ok(())
        } else {
            Err(invalid(
                "camera.look_at",
                format!("{:?}", self.look_at),
                "a point other than camera.position, in a direction other than camera.up",
            ))
        }
    }
}
