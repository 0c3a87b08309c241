//! Camera paths up to the first diffuse vertex, and next event estimation there: what `pt`, `pt-reg`, `pm` and `ppm`
//! share.
//!
//! The film position is uniform over the whole film; the pixel that contains it gets the contribution (box filter). A
//! path adds P (number of pixels) times its radiance.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use crate::film::Film;
use crate::geometry::light::Light;
use crate::geometry::scene::Scene;
use crate::geometry::specular::Specular;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::deviation::Deviation;

/// The classes in which a camera path's contribution can end: seen directly, or through the specular surface.
pub(super) type ClassPair = [PathClass; 2];

/// Light that reaches the floor directly.
pub(super) const DIRECT: ClassPair = [PathClass::LDE, PathClass::LDSE];
/// Light that reaches the floor through the specular surface.
pub(super) const CAUSTIC: ClassPair = [PathClass::LSDE, PathClass::LSDSE];

/// A block of camera paths at their first diffuse vertex.
pub(super) struct CameraPaths {
    column: Lanes,
    row: Lanes,
    /// The vertex on the floor [m].
    pub(super) x: Lanes,
    pub(super) y: Lanes,
    /// P times what radiance leaving the vertex is multiplied by on its way to the film; 0 where there is no vertex.
    pub(super) weight: Lanes,
    /// 1 where the vertex is seen through the specular surface, else 0.
    pub(super) via: Lanes,
}

impl CameraPaths {
    pub(super) fn new() -> Self {
        CameraPaths {
            column: zeros(),
            row: zeros(),
            x: zeros(),
            y: zeros(),
            weight: zeros(),
            via: zeros(),
        }
    }

    /// Draws the paths `first ..`; those beyond the first `live` have no vertex.
    #[inline(always)]
    pub(super) fn draw<L: Light, S: Specular, D: Deviation>(
        &mut self,
        scene: &Scene<L, S>,
        defect: &D,
        stream: &Stream,
        first: u64,
        live: usize,
    ) {
        stream.pairs(first, Dimension::Film, &mut self.column, &mut self.row);
        defect.numbers(Dimension::Film, &mut self.column, &mut self.row);
        let (columns, rows) = scene.camera.size();
        let pixels = scene.camera.pixels();
        let through = scene.surface.radiance_scale();
        for i in 0..BLOCK {
            let (u, v) = (self.column[i] * columns, self.row[i] * rows);
            let direction = scene.camera.direction(u, v);
            let landing = scene.landing(scene.camera.position, direction);
            let (column, row, scale) = defect.placed(&scene.camera, u, v);
            self.column[i] = column;
            self.row[i] = row;
            self.x[i] = landing.x;
            self.y[i] = landing.y;
            self.weight[i] = landing.weight * pixels * if landing.via { through } else { 1.0 };
            self.weight[i] *= scale * defect.at_sensor(direction);
            self.via[i] = if landing.via { 1.0 } else { 0.0 };
        }
        self.weight[live..].fill(0.0);
    }

    /// Contributions of the light that reaches the vertices directly, into `value`.
    #[inline(always)]
    pub(super) fn next_event<L: Light, S: Specular, D: Deviation>(
        &self,
        scene: &Scene<L, S>,
        defect: &D,
        value: &mut Lanes,
    ) {
        let scale = DIRECT.map(|class| scene.floor.bsdf * defect.class_scale(class));
        for (i, value) in value.iter_mut().enumerate() {
            let vertex = DVec3::new(self.x[i], self.y[i], 0.0);
            let (towards, t_end) = scene.light.towards(vertex);
            let cosine = towards.z / f64::sqrt(towards.dot(towards));
            let irradiance =
                defect.falloff(scene.light.normal_irradiance(towards), towards) * cosine;
            let scale = if self.via[i] > 0.5 {
                scale[1]
            } else {
                scale[0]
            };
            let radiance = scale * irradiance * defect.beside_own_cosine(cosine);
            let free = defect.lit(!scene.surface.blocks(vertex, towards, t_end));
            *value = if free { self.weight[i] * radiance } else { 0.0 };
        }
    }

    /// Adds the positive contributions to the film, in path order.
    #[inline(always)]
    pub(super) fn splat(&self, film: &mut Film, classes: ClassPair, value: &Lanes) {
        let mut list = [0_u16; BLOCK];
        for (k, class) in classes.into_iter().enumerate() {
            let Some(layer) = film.layer_of(class) else {
                continue;
            };
            let wanted = k as f64;
            let n = select(&mut list, |i| (value[i] > 0.0) & (self.via[i] == wanted));
            for &i in &list[..n] {
                let i = usize::from(i);
                add(film, layer, self.column[i], self.row[i], value[i]);
            }
            film.nonzero[layer] += n as u64;
        }
    }
}

/// Writes the paths for which `wanted` holds to the list, in order and without a branch; returns their number.
#[inline(always)]
pub(super) fn select(list: &mut [u16; BLOCK], wanted: impl Fn(usize) -> bool) -> usize {
    let mut n = 0;
    for i in 0..BLOCK {
        list[n] = i as u16;
        n += usize::from(wanted(i));
    }
    n
}

/// Adds a contribution to the pixel that contains the film position.
#[inline(always)]
pub(super) fn add(film: &mut Film, layer: usize, column: f64, row: f64, value: f64) {
    // The conversion rounds towards zero and saturates; the film position is never negative.
    let (width, height) = (film.width as usize, film.height as usize);
    let column = (column as usize).min(width - 1);
    let row = (row as usize).min(height - 1);
    film.layers[layer][row * width + column] += value;
}
