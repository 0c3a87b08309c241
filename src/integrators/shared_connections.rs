//! Connections of a block of subpaths over a floor, and the weights of those that two techniques share.

use glam::DVec3;
use multiversion::multiversion;

use crate::geometry::pinhole::Pinhole;
use crate::geometry::tracer::Landings;
use crate::stream::{BLOCK, Lanes};

use super::defect::Defect;
use super::deviation::Deviation;
use super::mis::{Sharing, Side};

/// From uniforms to film positions.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn to_film(camera: &Pinhole, column: &mut Lanes, row: &mut Lanes) {
    let (columns, rows) = camera.size();
    for i in 0..BLOCK {
        column[i] *= columns;
        row[i] *= rows;
    }
}

/// Contributions of direct light to camera subpaths.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn connect_to_light(
    camera: &Pinhole,
    sharing: &Sharing,
    defect: &Defect,
    flux: f64,
    scale: [f64; 2],
    eye: &Landings,
    [irradiance, cosine]: [&Lanes; 2],
    value: &mut Lanes,
) {
    let pixels = camera.pixels();
    for i in 0..BLOCK {
        let arriving = irradiance[i] * cosine[i];
        let (_, _, density) = camera.project_floor(DVec3::new(eye.x[i], eye.y[i], 0.0));
        let own = density / pixels;
        let other = arriving / flux;
        let through = eye.chain[i] > 0.5;
        let weight = sharing.weight(Side::Camera, own, other);
        let weight = if through {
            sharing.alone(own, other)
        } else {
            weight
        };
        let scale = if through { scale[1] } else { scale[0] };
        let radiance = scale * arriving * defect.beside_own_cosine(cosine[i]);
        let sees = eye.weight[i] > 0.0;
        value[i] = if sees {
            eye.weight[i] * radiance * weight
        } else {
            0.0
        };
    }
}

/// Film positions of where light subpaths end, and pixels per area there: 0 where they do not, or where the pinhole does not
/// see it.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn project(
    camera: &Pinhole,
    light: &Landings,
    free: &Lanes,
    column: &mut Lanes,
    row: &mut Lanes,
    density: &mut Lanes,
) {
    for i in 0..BLOCK {
        let (u, v, pixels) = camera.project_floor(DVec3::new(light.x[i], light.y[i], 0.0));
        let counts = (free[i] > 0.5) & (light.weight[i] > 0.0);
        column[i] = u;
        row[i] = v;
        density[i] = if counts { pixels } else { 0.0 };
    }
}

/// Contributions of light subpaths. Where next event estimation shares the paths, `shared` is the flux of direct light.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn connect_to_pinhole(
    camera: &Pinhole,
    sharing: &Sharing,
    defect: &Defect,
    shared: Option<f64>,
    scale: f64,
    light: &Landings,
    [irradiance, cosine]: [&Lanes; 2],
    density: &Lanes,
    value: &mut Lanes,
) {
    let pixels = sharing.pixels_from_light(camera.pixels());
    for i in 0..BLOCK {
        let radiance = scale * light.weight[i] * defect.beside_cosine(light.cosine[i]);
        let weight = match shared {
            Some(flux) => {
                let own = irradiance[i] * cosine[i] / flux;
                sharing.weight(Side::Light, own, density[i] / pixels)
            }
            None => 1.0,
        };
        let counts = density[i] > 0.0;
        value[i] = if counts {
            radiance * density[i] * weight
        } else {
            0.0
        };
    }
}

/// From samples of the irradiance at the camera subpaths' ends to contributions.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn radiance(eye: &Landings, scale: [f64; 2], irradiance: &Lanes, value: &mut Lanes) {
    for i in 0..BLOCK {
        let scale = if eye.chain[i] > 0.5 {
            scale[1]
        } else {
            scale[0]
        };
        value[i] = eye.weight[i] * scale * irradiance[i];
    }
}
