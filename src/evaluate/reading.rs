//! Reading reference files: every number with the place it stands at, so that an error can name it.
//!
//! Numbers are decimal strings or JSON numbers. `null` counts as absent.

use nephroid_analytic::vector::{Vec3, vec3};
use serde_json::{Map, Value};

use crate::error::Error;

/// The largest absolute value of any number in a file.
pub const LARGEST: f64 = 1e9;
/// The smallest value of what must be positive.
pub const SMALLEST: f64 = 1e-9;

/// A JSON object and where it stands.
#[derive(Clone, Copy)]
pub struct Object<'a> {
    file: &'a str,
    configuration: Option<&'a str>,
    item: Option<&'a str>,
    map: &'a Map<String, Value>,
}

/// A short picture of a value for a message.
fn shown(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= 60 {
        text
    } else {
        text.chars().take(57).chain("...".chars()).collect()
    }
}

/// What an array of `N` numbers may be.
fn array_of<const N: usize>() -> String {
    format!("an array of {N} finite numbers from -{LARGEST} to {LARGEST}")
}

impl<'a> Object<'a> {
    /// The top of a file.
    ///
    /// # Errors
    /// [`Error::Content`] if it is not an object.
    pub fn top(file: &'a str, value: &'a Value) -> Result<Self, Error> {
        let map = value.as_object().ok_or_else(|| Error::Content {
            file: file.to_owned(),
            message: format!("the file holds {}", shown(value)),
            help: "allowed: a JSON object with the keys schema, scene and configurations".into(),
        })?;
        Ok(Object {
            file,
            configuration: None,
            item: None,
            map,
        })
    }

    /// An error at one key of this object.
    pub fn error(&self, key: &str, found: &str, allowed: &str) -> Error {
        let mut place = String::new();
        if let Some(id) = self.configuration {
            place += &format!("configuration `{id}`, ");
        }
        if let Some(id) = self.item {
            place += &format!("point `{id}`, ");
        }
        Error::Content {
            file: self.file.to_owned(),
            message: format!("{place}key `{key}`: found {found}"),
            help: format!("allowed: {allowed}"),
        }
    }

    /// The value of a key; `None` if it is missing or `null`.
    pub fn get(&self, key: &str) -> Option<&'a Value> {
        self.map.get(key).filter(|v| !v.is_null())
    }

    /// Whether a key is there.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// All keys.
    pub fn keys(&self) -> impl Iterator<Item = &'a str> {
        self.map.keys().map(String::as_str)
    }

    fn required(&self, key: &str, allowed: &str) -> Result<&'a Value, Error> {
        self.get(key)
            .ok_or_else(|| self.error(key, "nothing", allowed))
    }

    /// A string.
    ///
    /// # Errors
    /// [`Error::Content`] if it is missing or not a string.
    pub fn text(&self, key: &str) -> Result<&'a str, Error> {
        let value = self.required(key, "a string")?;
        value
            .as_str()
            .ok_or_else(|| self.error(key, &shown(value), "a string"))
    }

    /// An object below this one.
    ///
    /// # Errors
    /// [`Error::Content`] if it is missing or not an object.
    pub fn object(&self, key: &str) -> Result<Object<'a>, Error> {
        let value = self.required(key, "an object")?;
        let map = value
            .as_object()
            .ok_or_else(|| self.error(key, &shown(value), "an object"))?;
        Ok(Object { map, ..*self })
    }

    /// The objects of an array; empty if the key is missing.
    ///
    /// # Errors
    /// [`Error::Content`] if it is not an array of objects.
    pub fn objects(&self, key: &str) -> Result<Vec<Object<'a>>, Error> {
        let Some(value) = self.get(key) else {
            return Ok(vec![]);
        };
        let array = value
            .as_array()
            .ok_or_else(|| self.error(key, &shown(value), "an array of objects"))?;
        array
            .iter()
            .enumerate()
            .map(|(i, v)| {
                let map = v
                    .as_object()
                    .ok_or_else(|| self.error(&format!("{key}[{i}]"), &shown(v), "an object"))?;
                Ok(Object { map, ..*self })
            })
            .collect()
    }

    /// As [`Self::objects`], for an array that must be there.
    ///
    /// # Errors
    /// [`Error::Content`] if it is missing or not an array of objects.
    pub fn required_objects(&self, key: &str) -> Result<Vec<Object<'a>>, Error> {
        self.required(key, "an array of objects")?;
        self.objects(key)
    }

    /// This object as a configuration, named by its `id`.
    ///
    /// # Errors
    /// [`Error::Content`] without an `id`.
    pub fn as_configuration(self) -> Result<Self, Error> {
        Ok(Object {
            configuration: Some(self.text("id")?),
            ..self
        })
    }

    /// This object as a point or a view, named by its `id`.
    ///
    /// # Errors
    /// [`Error::Content`] without an `id`.
    pub fn as_item(self) -> Result<Self, Error> {
        Ok(Object {
            item: Some(self.text("id")?),
            ..self
        })
    }

    /// A finite number, as JSON number or decimal string.
    fn finite(&self, key: &str, value: &Value, allowed: &str) -> Result<f64, Error> {
        let number = match value {
            Value::Number(n) => n.as_f64(),
            Value::String(s) => s.trim().parse().ok(),
            _ => None,
        };
        match number {
            Some(x) if x.is_finite() => Ok(x),
            _ => Err(self.error(key, &shown(value), allowed)),
        }
    }

    /// An expected value: any finite number; `None` if it is missing or `null`.
    ///
    /// # Errors
    /// [`Error::Content`] if it is not a finite number.
    pub fn expected(&self, key: &str) -> Result<Option<f64>, Error> {
        self.get(key)
            .map(|v| self.finite(key, v, "a finite number, or null"))
            .transpose()
    }

    /// A number within [low, high].
    ///
    /// # Errors
    /// [`Error::Content`] if it is missing, not a number or out of range.
    pub fn number(&self, key: &str, low: f64, high: f64) -> Result<f64, Error> {
        let allowed = format!("a finite number from {low} to {high}");
        let value = self.required(key, &allowed)?;
        let x = self.finite(key, value, &allowed)?;
        if x >= low && x <= high {
            Ok(x)
        } else {
            Err(self.error(key, &shown(value), &allowed))
        }
    }

    /// A positive length or strength.
    ///
    /// # Errors
    /// As [`Self::number`].
    pub fn positive(&self, key: &str) -> Result<f64, Error> {
        self.number(key, SMALLEST, LARGEST)
    }

    /// An albedo or reflectance in [0, 1].
    ///
    /// # Errors
    /// As [`Self::number`].
    pub fn fraction(&self, key: &str) -> Result<f64, Error> {
        self.number(key, 0.0, 1.0)
    }

    /// A whole number within [low, high].
    ///
    /// # Errors
    /// As [`Self::number`].
    pub fn whole(&self, key: &str, low: u32, high: u32) -> Result<u32, Error> {
        let allowed = format!("a whole number from {low} to {high}");
        let value = self.required(key, &allowed)?;
        let x = self.finite(key, value, &allowed)?;
        if x >= f64::from(low) && x <= f64::from(high) && x.fract() == 0.0 {
            Ok(x as u32)
        } else {
            Err(self.error(key, &shown(value), &allowed))
        }
    }

    /// An array of `N` numbers, each within ± [`LARGEST`].
    ///
    /// # Errors
    /// [`Error::Content`] if it is missing, of another length or holds something else.
    pub fn numbers<const N: usize>(&self, key: &str) -> Result<[f64; N], Error> {
        let value = self.required(key, &array_of::<N>())?;
        self.numbers_of(key, value)
    }

    /// An array of arrays of `N` numbers each.
    ///
    /// # Errors
    /// [`Error::Content`] if it is missing or holds something else.
    pub fn rows<const N: usize>(&self, key: &str) -> Result<Vec<[f64; N]>, Error> {
        let allowed = format!("an array, each row {}", array_of::<N>());
        let value = self.required(key, &allowed)?;
        let array = value
            .as_array()
            .ok_or_else(|| self.error(key, &shown(value), &allowed))?;
        array
            .iter()
            .enumerate()
            .map(|(i, row)| self.numbers_of(&format!("{key}[{i}]"), row))
            .collect()
    }

    fn numbers_of<const N: usize>(&self, key: &str, value: &Value) -> Result<[f64; N], Error> {
        let allowed = array_of::<N>();
        let array = value
            .as_array()
            .filter(|a| a.len() == N)
            .ok_or_else(|| self.error(key, &shown(value), &allowed))?;
        let mut out = [0.0; N];
        for (i, (o, v)) in out.iter_mut().zip(array).enumerate() {
            let place = format!("{key}[{i}]");
            *o = self.finite(&place, v, &allowed)?;
            if !(f64::abs(*o) <= LARGEST) {
                return Err(self.error(&place, &shown(v), &allowed));
            }
        }
        Ok(out)
    }

    /// A point or direction in space.
    ///
    /// # Errors
    /// As [`Self::numbers`].
    pub fn vector(&self, key: &str) -> Result<Vec3<f64>, Error> {
        let [x, y, z] = self.numbers(key)?;
        Ok(vec3(x, y, z))
    }

    /// A unit vector along a direction of any length.
    ///
    /// # Errors
    /// As [`Self::numbers`], and for a vector shorter than 1e-9.
    pub fn direction(&self, key: &str) -> Result<Vec3<f64>, Error> {
        let v = self.vector(key)?;
        if v.length() >= SMALLEST {
            Ok(v.normalized())
        } else {
            Err(self.error(
                key,
                "a vector of no length",
                "a vector of length 1e-9 or more",
            ))
        }
    }

    /// A receiver point, which must lie in the plane z = `plane`.
    ///
    /// # Errors
    /// As [`Self::numbers`], and for a point off the plane.
    pub fn receiver(&self, plane: f64) -> Result<Vec3<f64>, Error> {
        let x = self.vector("x")?;
        if f64::abs(x.z - plane) <= 1e-9 * (1.0 + f64::abs(plane)) {
            Ok(vec3(x.x, x.y, plane))
        } else {
            let allowed = format!("a point of the receiver, z = {plane}");
            Err(self.error("x[2]", &x.z.to_string(), &allowed))
        }
    }

    /// The ray of a view: from `camera` through `aim`, or through `first_hit` where there is no `aim`.
    ///
    /// # Errors
    /// As [`Self::numbers`], and if both points are the same.
    pub fn ray(&self) -> Result<(Vec3<f64>, Vec3<f64>), Error> {
        let camera = self.vector("camera")?;
        let key = if self.has("aim") { "aim" } else { "first_hit" };
        let aim = self.vector(key)?;
        if (aim - camera).length() >= SMALLEST {
            Ok((camera, aim))
        } else {
            Err(self.error(key, "the position of the camera", "another point"))
        }
    }
}
