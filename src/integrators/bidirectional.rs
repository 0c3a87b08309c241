//! Bidirectional path tracing over a floor: one light subpath and one camera subpath per path.
//!
//! The techniques (s, t) of each class are those of `sampleable.rs`. Over a floor there is one diffuse vertex x, and
//!
//! - LDE has two: (1, 2), next event estimation at the x that the camera subpath ends in, and (2, 1), the light subpath's x connected to
//!   the pinhole. Per area of the floor, x has the density q/P of the P pixels, q of them per area, and E_n cos θ/Φ.
//! - L D S+ E has (1, t) alone, and L S+ D E has (s, 1) alone: exact, with weight 1.
//! - L S D S E has none. With the vertex next to the light mollified it has (1, 4) and (2, 3); see `mollified_vertex.rs`.
//!   The light subpath of the latter is connected to the camera subpath with the same number.

use nephroid_analytic::class::PathClass;

use crate::film::Film;
use crate::geometry::tracer::{
    Aim, Emission, Landings, Outline, Rays, Tracer, film_rays, uniforms,
};
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::Prepared;
use super::camera_paths::{CAUSTIC, DIRECT, add, select};
use super::defect::Defect;
use super::deviation::Deviation;
use super::fault::Fault;
use super::kernel::{AngleKernel, Kernel};
use super::mis::{Sharing, Side};
use super::mollified_vertex::{Joint, Joints};
use super::sampleable::{Family, mollified_vertex, possible};
use super::settings::Settings;
use super::shared_connections::{connect_to_light, connect_to_pinhole, project, radiance, to_film};

/// Photons of one beam.
pub(super) struct Beam {
    pub(super) emission: Emission,
    /// Per chain of the tracer: the class, if paths of this beam can be connected to the pinhole.
    pub(super) classes: Vec<Option<PathClass>>,
}

/// Bidirectional path tracing of a scene with a floor.
pub(super) struct Bidirectional {
    pub(super) tracer: Box<dyn Tracer>,
    pub(super) beams: Vec<Beam>,
    /// Flux of the photons of direct light [W].
    pub(super) direct_flux: f64,
    /// Whether the camera can see a floor that the light reaches straight.
    has_direct: bool,
    /// What is mollified: the classes seen directly and through the surface, by (class, is sampled).
    mollified: [bool; 2],
    kernel: Kernel,
    settings: Settings,
    pub(super) defect: Defect,
}

impl Bidirectional {
    /// Compiles the scene: which classes exist, with which techniques, and which must be mollified if that is allowed.
    pub(super) fn new(
        tracer: Box<dyn Tracer>,
        classes: &[PathClass],
        regularize: bool,
        settings: Settings,
    ) -> Self {
        let defect = Defect::new(settings.fault);
        let family = Family::Bidirectional;
        let everything = settings.fault == Some(Fault::RegularRegularized);
        let mollified = CAUSTIC.map(|class| {
            let must = mollified_vertex(class, family).is_some();
            let wrongly = everything && class == PathClass::LSDE;
            regularize && classes.contains(&class) && (must || wrongly)
        });
        let traced = |class: PathClass| {
            let light_tracing = possible(class, Family::LightTracing, None);
            let wrongly = mollified[0] && class == PathClass::LSDE;
            classes.contains(&class) && !light_tracing.is_empty() && !wrongly
        };
        let chains = tracer.chains();
        let mut beams: Vec<Beam> = (0..tracer.beams())
            .map(|beam| {
                let single = tracer.beams() == 1;
                let takes = |&(chain, _): &(usize, &PathClass)| single || chain == beam;
                let class = |(chain, &class): (usize, &PathClass)| {
                    (takes(&(chain, &class)) && traced(class)).then_some(class)
                };
                Beam {
                    emission: tracer.emission(tracer.aim(beam)),
                    classes: chains.iter().enumerate().map(class).collect(),
                }
            })
            .collect();
        if defect.unaimed() {
            beams
                .iter_mut()
                .for_each(|b| b.emission = tracer.emission(Aim::Table(0)));
        }
        let direct = |b: &&Beam| b.classes.contains(&Some(PathClass::LDE));
        let direct_flux = beams.iter().find(direct).map_or(0.0, |b| b.emission.flux());
        Bidirectional {
            has_direct: DIRECT.iter().any(|class| classes.contains(class)),
            tracer,
            beams,
            direct_flux,
            mollified,
            kernel: settings.kernel.unwrap_or(Kernel::Cone),
            settings,
            defect,
        }
    }

    fn sharing(&self) -> Sharing {
        Sharing {
            heuristic: self.settings.heuristic,
            fault: self.settings.fault,
        }
    }

    /// How the mollified vertex is made, from the one side or the other; `None` if only the other is wanted.
    fn joint(&self, outline: &Outline, side: Side) -> Option<Joint> {
        if self.settings.side.is_some_and(|only| only != side) {
            return None;
        }
        let alone = self.settings.side.is_some();
        let twice = self.settings.fault == Some(Fault::MollifiedTwice);
        Some(Joint {
            gain: outline.radiance_gain,
            refracts: outline.refracts,
            flux: self.beams[0].emission.flux(),
            sharing: (!alone && !twice).then(|| self.sharing()),
            fault: self.settings.fault,
        })
    }
}

impl Prepared for Bidirectional {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let (seed, iteration) = self.defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let before = film.nonzero.iter().sum();
        let bandwidth = self.defect.bandwidth(iteration, bandwidth);
        let kernel = AngleKernel::new(self.kernel, bandwidth, self.settings.fault);
        let mut block = Block::new();
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            self.eye_subpaths(&stream, first, live, &mut block);
            if self.has_direct && film.reads(&DIRECT) {
                self.next_event(&mut block, film);
            }
            uniforms(
                &stream,
                first,
                Dimension::Emission,
                &mut block.u,
                &mut block.v,
            );
            let Block { u, v, .. } = &mut block;
            self.defect.numbers(Dimension::Emission, u, v);
            for (index, beam) in self.beams.iter().enumerate() {
                beam.emission.rays(&block.u, &block.v, &mut block.photons);
                let is_read = |class: &PathClass| film.layer_of(*class).is_some();
                if beam.classes.iter().flatten().any(is_read) {
                    self.light_tracing(index, beam, live, &mut block, film);
                }
            }
            if self.mollified.contains(&true) && film.reads(&CAUSTIC) {
                self.mollified(&stream, first, &kernel, &mut block, film);
            }
        }
        self.defect.finish(paths, before, film);
    }
}

/// Memory for a block of paths.
pub(super) struct Block {
    /// Film positions of the camera subpaths.
    pub(super) column: Lanes,
    pub(super) row: Lanes,
    pub(super) rays: Rays,
    /// Where the camera subpaths end; the weight is P times what radiance is multiplied by on its way to the film.
    pub(super) eye: Landings,
    pub(super) photons: Rays,
    /// Where the light subpaths end.
    pub(super) light: Landings,
    pub(super) u: Lanes,
    pub(super) v: Lanes,
    pub(super) irradiance: Lanes,
    pub(super) cosine: Lanes,
    pub(super) free: Lanes,
    pub(super) value: Lanes,
    pub(super) joints: Joints,
}

impl Block {
    pub(super) fn new() -> Self {
        Block {
            column: zeros(),
            row: zeros(),
            rays: Rays::default(),
            eye: Landings::new(),
            photons: Rays::default(),
            light: Landings::new(),
            u: zeros(),
            v: zeros(),
            irradiance: zeros(),
            cosine: zeros(),
            free: zeros(),
            value: zeros(),
            joints: Joints::new(),
        }
    }

    /// Adds the positive values to the film, in path order: camera subpaths that see the floor straight, and through the
    /// surface.
    fn splat(&self, classes: [PathClass; 2], film: &mut Film) {
        let mut list = [0_u16; BLOCK];
        for (k, class) in classes.into_iter().enumerate() {
            let Some(layer) = film.layer_of(class) else {
                continue;
            };
            let wanted = k as f64;
            let n = select(&mut list, |i| {
                (self.value[i] > 0.0) & (self.eye.chain[i] == wanted)
            });
            for &i in &list[..n] {
                let i = usize::from(i);
                add(film, layer, self.column[i], self.row[i], self.value[i]);
            }
            film.nonzero[layer] += n as u64;
        }
    }
}

impl Bidirectional {
    /// Camera subpaths up to the floor.
    pub(super) fn eye_subpaths(&self, stream: &Stream, first: u64, live: usize, block: &mut Block) {
        let outline = self.tracer.outline();
        let Block {
            column,
            row,
            rays,
            eye,
            ..
        } = block;
        uniforms(stream, first, Dimension::Film, column, row);
        self.defect.numbers(Dimension::Film, column, row);
        to_film(&outline.camera, column, row);
        film_rays(&outline.camera, column, row, rays);
        self.tracer.see(rays, eye);
        let pixels = outline.camera.pixels();
        for i in 0..BLOCK {
            let through = if eye.chain[i] > 0.5 {
                outline.radiance_scale
            } else {
                1.0
            };
            eye.weight[i] = eye.weight[i] * pixels * through;
        }
        eye.weight[live..].fill(0.0);
    }

    /// Techniques (1, t): the light straight from the floor.
    fn next_event(&self, block: &mut Block, film: &mut Film) {
        let outline = self.tracer.outline();
        let Block {
            eye,
            irradiance,
            cosine,
            value,
            ..
        } = block;
        self.tracer.lit(&eye.x, &eye.y, irradiance, cosine);
        let scale = DIRECT.map(|class| outline.floor.bsdf * self.defect.class_scale(class));
        connect_to_light(
            &outline.camera,
            &self.sharing(),
            &self.defect,
            self.direct_flux,
            scale,
            eye,
            [irradiance, cosine],
            value,
        );
        block.splat(DIRECT, film);
    }

    /// Techniques (s, 1): the pinhole from the floor.
    fn light_tracing(
        &self,
        index: usize,
        beam: &Beam,
        live: usize,
        block: &mut Block,
        film: &mut Film,
    ) {
        let outline = self.tracer.outline();
        let Block {
            photons,
            light,
            rays,
            irradiance,
            cosine,
            free,
            value,
            ..
        } = block;
        self.tracer.land(index, photons, light);
        self.tracer.seen(&light.x, &light.y, free);
        // Film positions and pixels per area, where the rays of the camera subpaths have been.
        let [column, row, density] = [&mut rays.origin.x, &mut rays.origin.y, &mut rays.origin.z];
        project(&outline.camera, light, free, column, row, density);
        density[live..].fill(0.0);
        let carried = self.defect.flux(self.aimed_flux(&beam.emission));
        for (chain, class) in beam.classes.iter().enumerate() {
            let Some(class) = *class else { continue };
            let Some(layer) = film.layer_of(class) else {
                continue;
            };
            let wanted = chain as f64;
            let shared = class == PathClass::LDE;
            if shared {
                self.tracer.lit(&light.x, &light.y, irradiance, cosine);
            }
            let scale = carried * outline.floor.bsdf * self.defect.class_scale(class);
            connect_to_pinhole(
                &outline.camera,
                &self.sharing(),
                &self.defect,
                shared.then_some(self.direct_flux),
                scale,
                light,
                [irradiance, cosine],
                density,
                value,
            );
            let mut list = [0_u16; BLOCK];
            let n = select(&mut list, |i| (value[i] > 0.0) & (light.chain[i] == wanted));
            for &i in &list[..n] {
                let i = usize::from(i);
                add(film, layer, column[i], row[i], value[i]);
            }
            film.nonzero[layer] += n as u64;
        }
    }

    /// The flux that photons are taken to carry together.
    fn aimed_flux(&self, emission: &Emission) -> f64 {
        match self.settings.fault {
            Some(Fault::SphereFluxOnAimedPhotons) => self.tracer.emission(Aim::Table(0)).flux(),
            _ => emission.flux(),
        }
    }

    /// Techniques (1, t) and (2, t - 1) of the classes with a mollified vertex.
    fn mollified(
        &self,
        stream: &Stream,
        first: u64,
        kernel: &AngleKernel,
        block: &mut Block,
        film: &mut Film,
    ) {
        let outline = self.tracer.outline();
        let scale: [f64; 2] = core::array::from_fn(|k| {
            let scale = outline.floor.bsdf * self.defect.class_scale(CAUSTIC[k]);
            if self.mollified[k] { scale } else { 0.0 }
        });
        for side in [Side::Camera, Side::Light] {
            let Some(joint) = self.joint(outline, side) else {
                continue;
            };
            let Block {
                eye,
                photons,
                u,
                v,
                joints,
                value,
                ..
            } = block;
            let floor = [&eye.x, &eye.y];
            match side {
                Side::Camera => {
                    uniforms(stream, first, Dimension::Direction, u, v);
                    self.defect.numbers(Dimension::Direction, u, v);
                    joints.meet_from_camera(&*self.tracer, floor, [u, v], &joint, kernel);
                }
                Side::Light => {
                    joints.meet_from_light(&*self.tracer, photons, floor, &joint, kernel)
                }
            }
            radiance(eye, scale, &joints.value, value);
            block.splat(CAUSTIC, film);
        }
    }
}
