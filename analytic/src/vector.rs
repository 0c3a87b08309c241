//! Three-dimensional vectors over any [`Scalar`].

use core::ops::{Add, Mul, Neg, Sub};

use crate::scalar::Scalar;

/// A point [m] or direction in space; z points up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec3<S> {
    /// First coordinate.
    pub x: S,
    /// Second coordinate.
    pub y: S,
    /// Third coordinate, upwards.
    pub z: S,
}

/// Shorthand for [`Vec3`].
#[inline(always)]
pub const fn vec3<S>(x: S, y: S, z: S) -> Vec3<S> {
    Vec3 { x, y, z }
}

impl<S: Scalar> Vec3<S> {
    /// The nearest vector to three `f64` coordinates.
    #[inline(always)]
    pub fn from_f64(v: [f64; 3]) -> Self {
        vec3(S::from_f64(v[0]), S::from_f64(v[1]), S::from_f64(v[2]))
    }

    /// The coordinates as `f64`.
    #[inline(always)]
    pub fn to_f64(self) -> [f64; 3] {
        [self.x.to_f64(), self.y.to_f64(), self.z.to_f64()]
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> S {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        vec3(
            self.y * o.z - self.z * o.y,
            self.z * o.x - self.x * o.z,
            self.x * o.y - self.y * o.x,
        )
    }

    /// Squared length.
    #[inline(always)]
    pub fn length_squared(self) -> S {
        self.dot(self)
    }

    /// Length.
    #[inline(always)]
    pub fn length(self) -> S {
        self.length_squared().sqrt()
    }

    /// The vector divided by its length; NaN for the zero vector.
    #[inline(always)]
    pub fn normalized(self) -> Self {
        self * (S::ONE / self.length())
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        vec3(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        vec3(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl<S: Scalar> Mul<S> for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: S) -> Self {
        vec3(self.x * k, self.y * k, self.z * k)
    }
}

impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        vec3(-self.x, -self.y, -self.z)
    }
}
