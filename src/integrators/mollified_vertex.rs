//! The mollified vertex next to the light, from both sides: one integrand, two densities.
//!
//! A path L s x … E of which the part x … E is there already; s is on the specular surface. Seen from x at the distance r₁, the
//! exact continuation at s leaves by the angle g beside the light, from which s has the irradiance E_s normal to its direction
//! (I/r₂², or E₀). c_x, c₁ and c₂ are the cosines at x, and at s towards x and the light; w is the reflectance, or n² times the
//! transmittance at the angle on the side of x. The irradiance at x is an integral over the surface, of
//!
//! ```text
//! f(s) = w E_s φ_α(g) c_x c₁ k/r₁²        k = √(c₂/c₁) at a mirror, 1 at an interface
//! ```
//!
//! (technique `symmetric`: the mollified BSDF is R φ/√(c₁c₂) whoever evaluates it; at an interface it is technique `camera`).
//! Per area of the surface, s has the density c_x c₁/(π r₁²) if the camera subpath meets it in a direction drawn by the cosine law,
//! and E_s c₂/Φ if the light subpath does: photons are equally likely over what they are drawn from, and carry Φ together.

use core::f64::consts::PI;

use multiversion::multiversion;

use crate::geometry::tracer::{Rays, ToLight, Tracer, Vertices};
use crate::geometry::turn::sin_cos_of_turns;
use crate::stream::{BLOCK, Lanes, zeros};

use super::camera_paths::select;
use super::defect::Defect;
use super::deviation::Deviation;
use super::fault::Fault;
use super::kernel::AngleKernel;
use super::mis::{Sharing, Side};

/// How far beside a vertex, as a part of the distance, a ray towards it may meet the surface: rounding, and no other vertex.
const SAME_VERTEX: f64 = 1e-6;

/// What all paths of a scene have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    /// n² into a medium of index n, else 1.
    pub(super) gain: f64,
    /// Whether the vertex refracts.
    pub(super) refracts: bool,
    /// Flux Φ of the light that photons are drawn from [W].
    pub(super) flux: f64,
    /// How the two sides share a path; `None` if one of them has all.
    pub(super) sharing: Option<Sharing>,
    pub(super) fault: Option<Fault>,
}

/// Memory for a block of joints.
pub(super) struct Joints {
    rays: Rays,
    met: Vertices,
    pub(super) vertices: Vertices,
    links: ToLight,
    /// Samples of the irradiance at x [W/m²], weighted.
    pub(super) value: Lanes,
    sample: Lanes,
    squared_chord: Lanes,
}

impl Joints {
    pub(super) fn new() -> Self {
        Joints {
            rays: Rays::default(),
            met: Vertices::new(),
            vertices: Vertices::new(),
            links: ToLight::new(),
            value: zeros(),
            sample: zeros(),
            squared_chord: zeros(),
        }
    }

    /// The vertices that the camera subpaths meet from the floor points in directions of two uniforms, connected to the light.
    pub(super) fn meet_from_camera(
        &mut self,
        tracer: &dyn Tracer,
        [x, y]: [&Lanes; 2],
        [u, v]: [&Lanes; 2],
        joint: &Joint,
        kernel: &AngleKernel,
    ) {
        scatter(x, y, u, v, &Defect::new(joint.fault), &mut self.rays);
        tracer.meet(1, &self.rays, &mut self.vertices);
        self.finish(tracer, Side::Camera, joint, kernel);
    }

    /// The vertices that the light subpaths meet, connected to the floor points.
    pub(super) fn meet_from_light(
        &mut self,
        tracer: &dyn Tracer,
        photons: &Rays,
        [x, y]: [&Lanes; 2],
        joint: &Joint,
        kernel: &AngleKernel,
    ) {
        tracer.meet(1, photons, &mut self.met);
        towards(x, y, &self.met, &mut self.rays);
        tracer.meet(1, &self.rays, &mut self.vertices);
        keep_reached(&self.met, &mut self.vertices);
        self.finish(tracer, Side::Light, joint, kernel);
    }

    fn finish(&mut self, tracer: &dyn Tracer, side: Side, joint: &Joint, kernel: &AngleKernel) {
        tracer.to_light(&self.vertices, &mut self.links);
        let Joints {
            rays,
            vertices,
            links,
            value,
            sample,
            squared_chord,
            ..
        } = self;
        weigh(rays, vertices, links, side, joint, sample);
        squared_chord.copy_from_slice(&links.squared_chord);
        let mut list = [0_u16; BLOCK];
        let n = select(&mut list, |i| {
            (sample[i] > 0.0) & (squared_chord[i] < kernel.support)
        });
        value.fill(0.0);
        for &i in &list[..n] {
            let i = usize::from(i);
            value[i] = sample[i] * kernel.density(squared_chord[i]);
        }
    }
}

/// Rays from floor points, by the cosine law.
#[multiversion(targets("x86_64+avx2"))]
fn scatter(x: &Lanes, y: &Lanes, u: &Lanes, v: &Lanes, defect: &Defect, rays: &mut Rays) {
    for i in 0..BLOCK {
        let (sine, cosine) = sin_cos_of_turns(u[i]);
        let (r, z) = defect.scattered(v[i]);
        rays.origin.set(i, glam::DVec3::new(x[i], y[i], 0.0));
        let direction = glam::DVec3::new(r * cosine, r * sine, z);
        rays.direction.set(i, direction);
    }
}

/// Rays from floor points towards vertices, which they reach at 1.
#[multiversion(targets("x86_64+avx2"))]
fn towards(x: &Lanes, y: &Lanes, vertices: &Vertices, rays: &mut Rays) {
    for i in 0..BLOCK {
        let floor = glam::DVec3::new(x[i], y[i], 0.0);
        rays.origin.set(i, floor);
        rays.direction.set(i, vertices.point.get(i) - floor);
    }
}

/// Drops vertices that are not those that the light subpath has met.
#[multiversion(targets("x86_64+avx2"))]
fn keep_reached(met: &Vertices, vertices: &mut Vertices) {
    for i in 0..BLOCK {
        let reached = f64::abs(vertices.t[i] - 1.0) < SAME_VERTEX;
        let same = reached & (met.weight[i] > 0.0);
        vertices.weight[i] = if same { vertices.weight[i] } else { 0.0 };
    }
}

/// Everything but the kernel: the integrand over the side's density, times the side's share.
#[multiversion(targets("x86_64+avx2"))]
fn weigh(
    rays: &Rays,
    vertices: &Vertices,
    links: &ToLight,
    side: Side,
    joint: &Joint,
    sample: &mut Lanes,
) {
    for (i, sample) in sample.iter_mut().enumerate() {
        let direction = rays.direction.get(i);
        let square = direction.dot(direction);
        let distance = vertices.t[i] * vertices.t[i] * square;
        let at_floor = direction.z / f64::sqrt(square);
        let (arrival, departure) = (vertices.arrival[i], links.cosine[i]);
        // The solid angle of the surface per area, seen from the floor point, times the cosine there.
        let projected = at_floor * arrival / distance;
        let camera = projected / PI;
        let light = links.irradiance[i] * departure / joint.flux;
        let form = joint.form(side, arrival, departure);
        let integrand = Defect::new(joint.fault).beside_own_cosine(at_floor)
            * joint.gain
            * vertices.weight[i]
            * links.irradiance[i]
            * form
            * projected;
        let weighed = joint.weighed(side, camera, arrival, distance);
        let (own, share) = match side {
            Side::Camera => (camera, joint.share(side, weighed, light)),
            Side::Light => (light, joint.share(side, light, weighed)),
        };
        let counts = (vertices.weight[i] > 0.0) & (links.irradiance[i] > 0.0);
        *sample = if counts { integrand / own * share } else { 0.0 };
    }
}

impl Joint {
    /// The factor k of the cosines.
    #[inline(always)]
    fn form(&self, side: Side, arrival: f64, departure: f64) -> f64 {
        if self.refracts {
            return 1.0;
        }
        match (self.fault, side) {
            (Some(Fault::SidesDiffer), Side::Camera) => 1.0,
            (Some(Fault::SidesDiffer), Side::Light) => departure / arrival,
            _ => f64::sqrt(departure / arrival),
        }
    }

    /// The weight of a side.
    #[inline(always)]
    fn share(&self, side: Side, own: f64, other: f64) -> f64 {
        match self.sharing {
            Some(sharing) => sharing.weight(side, own, other),
            None => 1.0,
        }
    }

    /// The camera's density as a side's weights have it.
    #[inline(always)]
    fn weighed(&self, side: Side, camera: f64, arrival: f64, distance: f64) -> f64 {
        match (self.fault, side) {
            (Some(Fault::MisMeasuresMixed), Side::Light) | (Some(Fault::MisMeasuresWrong), _) => {
                camera * distance / arrival
            }
            _ => camera,
        }
    }
}
