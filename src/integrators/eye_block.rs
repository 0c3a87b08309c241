//! A block of camera paths up to the floor, in a scene behind [`Tracer`].
//!
//! A path that sees the floor straight belongs to the classes L … D E, one that sees it through the specular surface to L … D S E.

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use super::camera_paths::add;
use super::defect::Defect;
use super::deviation::Deviation;
use crate::film::Film;
use crate::geometry::tracer::{Landings, Rays, Tracer, film_rays, tracer};
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

/// A scene, with the classes that its chains make.
pub(super) struct Traced {
    pub(super) tracer: Box<dyn Tracer>,
    /// For each chain of light: the class if the floor is seen straight, and if it is seen through the surface.
    pub(super) classes: Vec<[Option<PathClass>; 2]>,
}

impl Traced {
    /// `None` for a scene without a floor.
    pub(super) fn new(entry: &Entry, defect: Defect) -> Option<Self> {
        let tracer = tracer(entry, defect.overrides())?;
        let of_scene = entry.kind.classes();
        let classes = tracer.chains().iter().map(|chain| {
            let with = |through: bool| {
                let fits = |c: &&PathClass| {
                    c.light == chain.light && c.diffuse == 1 && c.eye.is_empty() != through
                };
                of_scene.iter().find(fits).copied()
            };
            [with(false), with(true)]
        });
        let classes = classes.collect();
        Some(Traced { tracer, classes })
    }

    /// The chain without a specular interaction.
    pub(super) fn direct(&self) -> Option<usize> {
        let chains = self.tracer.chains();
        chains.iter().position(|c| c.light.is_empty())
    }

    /// The beam of a chain.
    pub(super) fn beam(&self, chain: usize) -> usize {
        if self.tracer.beams() == 1 { 0 } else { chain }
    }

    /// Layers of the film, chain by chain, seen straight and through the surface.
    pub(super) fn layers(&self, film: &Film) -> Vec<[Option<usize>; 2]> {
        let layer = |c: Option<PathClass>| c.and_then(|c| film.layer_of(c));
        self.classes.iter().map(|c| c.map(layer)).collect()
    }

    /// The same, whether they are read or not.
    pub(super) fn all_layers(&self, film: &Film) -> Vec<[Option<usize>; 2]> {
        let layer = |c: Option<PathClass>| c.and_then(|c| film.position_of(c));
        self.classes.iter().map(|c| c.map(layer)).collect()
    }
}

/// Where a block of camera paths is.
pub(super) struct EyeBlock {
    /// Film position, in pixels from the top left corner.
    pub(super) column: Lanes,
    pub(super) row: Lanes,
    /// Pixels times throughput: times the radiance that leaves the floor point it is a contribution to the film. 0 where
    /// no floor is seen.
    pub(super) weight: Lanes,
    /// The floor points, and in `chain` whether they are seen through the surface.
    pub(super) landings: Landings,
    /// Irradiance normal to the direction of the light that comes straight, and the cosine.
    pub(super) irradiance: Lanes,
    pub(super) cosine: Lanes,
    rays: Rays,
}

impl EyeBlock {
    pub(super) fn new() -> Self {
        EyeBlock {
            column: zeros(),
            row: zeros(),
            weight: zeros(),
            landings: Landings::new(),
            irradiance: zeros(),
            cosine: zeros(),
            rays: Rays::default(),
        }
    }

    /// Draws the paths `first ..`, of which `live` count, and follows them to the floor.
    pub(super) fn draw(
        &mut self,
        traced: &Traced,
        defect: &Defect,
        stream: &Stream,
        first: u64,
        live: usize,
    ) {
        let outline = traced.tracer.outline();
        let camera = &outline.camera;
        let (columns, rows) = camera.size();
        stream.pairs(first, Dimension::Film, &mut self.column, &mut self.row);
        defect.numbers(Dimension::Film, &mut self.column, &mut self.row);
        for i in 0..BLOCK {
            self.column[i] *= columns;
            self.row[i] *= rows;
        }
        film_rays(camera, &self.column, &self.row, &mut self.rays);
        traced.tracer.see(&self.rays, &mut self.landings);
        let (pixels, through) = (camera.pixels(), outline.radiance_scale);
        for i in 0..live {
            let seen_through = self.landings.chain[i] > 0.5;
            let scale = pixels * if seen_through { through } else { 1.0 };
            let (column, row, kept) = defect.placed(camera, self.column[i], self.row[i]);
            self.column[i] = column;
            self.row[i] = row;
            self.weight[i] = self.landings.weight[i]
                * scale
                * kept
                * defect.at_sensor(self.rays.direction.get(i));
        }
        self.weight[live..].fill(0.0);
    }

    /// Asks for the light that reaches the floor points straight.
    pub(super) fn light(&mut self, traced: &Traced) {
        let (x, y) = (&self.landings.x, &self.landings.y);
        traced
            .tracer
            .lit(x, y, &mut self.irradiance, &mut self.cosine);
    }

    /// 1 where the floor is seen through the surface, else 0: a position in a pair of layers.
    pub(super) fn through(&self, i: usize) -> usize {
        usize::from(self.landings.chain[i] > 0.5)
    }

    /// Adds next event estimation of the direct light to the film, each contribution times `share` of its path.
    pub(super) fn next_event(
        &self,
        traced: &Traced,
        defect: &Defect,
        layers: &[[Option<usize>; 2]],
        share: impl Fn(usize) -> f64,
        film: &mut Film,
    ) {
        let Some(direct) = traced.direct() else {
            return;
        };
        let bsdf = traced.tracer.outline().floor.bsdf;
        let scale = traced.classes[direct].map(|c| bsdf * c.map_or(0.0, |c| defect.class_scale(c)));
        for i in 0..BLOCK {
            let eye = self.through(i);
            let Some(layer) = layers[direct][eye] else {
                continue;
            };
            let irradiance =
                self.irradiance[i] * self.cosine[i] * defect.beside_own_cosine(self.cosine[i]);
            let value = self.weight[i] * scale[eye] * irradiance;
            if value > 0.0 {
                let value = value * share(i);
                if value > 0.0 {
                    add(film, layer, self.column[i], self.row[i], value);
                    film.nonzero[layer] += 1;
                }
            }
        }
    }
}
