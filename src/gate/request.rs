//! From a request to an outcome.

use std::path::PathBuf;
use std::time::Instant;

use nephroid_analytic::scene::Entry;

use super::calibration;
use super::checks::{Check, Plan, plan};
use super::command::Command;
use super::exported::Exported;
use super::images::{Images as Layer, check, notes, stacks};
use super::judged::{FEWEST_IMAGES, Judged, Look};
use super::pictures::Material;
use super::reproduce;
use super::truths::{Regularization, Truth};
use crate::error::Error;
use crate::foreign::{Picture, read};
use crate::judge::finding::{Finding, State};
use crate::judge::hypotheses::{EQUIVALENCE_LEVEL, Levels};
use crate::judge::verdict::Spent;
use crate::mask::Mask;
use crate::regions::Regions;
use crate::report::comparison::Comparison;
use crate::verify::replicates::{FINAL, Seeds};
use crate::verify::run::settle;
use crate::verify::verdicts::{ALL_CLASSES, MASK, Outcome, Program, Verdict, WHOLE_IMAGE};

/// Probability of any false "different", by default: what 8 to 16 images can carry.
pub const LEVEL: f64 = 1e-4;
/// The margin, by default.
pub const MARGIN: f64 = 0.01;
/// Images at the first look, where a command makes them.
const FIRST_LOOK: u64 = 8;
/// Tolerance of the truth as a part of the margin.
const TOLERANCE_PER_MARGIN: f64 = 0.02;
/// Seeds are below this: many programs take no larger ones.
const SEEDS: u64 = 1 << 31;

/// Where the images come from.
pub enum Images {
    /// Files, each with a seed of its own.
    Files(Vec<PathBuf>),
    /// A program that makes them, so many at most.
    Command(Command, u64),
}

/// What to judge.
pub struct Request {
    /// The scene, as it was named.
    pub argument: String,
    /// The scene.
    pub entry: Entry,
    /// The images.
    pub images: Images,
    /// What the renderer is called.
    pub name: String,
    /// Equivalence margin relative to the truth.
    pub margin: f64,
    /// Probability of any false "different".
    pub level: f64,
    /// Positions of the classes that the renderer is declared not to sample.
    pub cannot: Vec<usize>,
    /// How the renderer regularizes, if it is to be judged at its own bandwidth.
    pub regularization: Option<Regularization>,
    /// The renderer's values are so many times W/(m² sr).
    pub gain: f64,
    /// The renderer's image is so many columns to the right and rows down of the scene's.
    pub offset: [f64; 2],
    /// Judge these pixels only.
    pub mask: Option<Mask>,
    /// Samples in a pixel, where files tell the variance of one and not this.
    pub samples: Option<f64>,
    /// The exported scene from which the images were made.
    pub exported: Option<Exported>,
    /// The seed of the seeds.
    pub seed: u64,
}

/// Judges the images. `progress` hears of each image that a command makes.
///
/// # Errors
/// What cannot be read, does not fit or cannot be run.
pub fn run(request: &Request, progress: &dyn Fn(u64, u64)) -> Result<Outcome, Error> {
    let (session, pictures, looks, started) = judge(request, progress)?;
    Ok(session.outcome(&pictures, looks, started))
}

/// The same, and pictures for a report.
///
/// # Errors
/// Those of [`run`].
pub fn run_and_draw(
    request: &Request,
    progress: &dyn Fn(u64, u64),
) -> Result<(Outcome, Vec<Comparison>), Error> {
    let (session, pictures, looks, started) = judge(request, progress)?;
    let material = Material {
        renderer: &request.name,
        truth: &session.truth,
        regions: &session.regions,
        covered: &session.covered,
        layers: &session.layers,
        checks: &session.plan.checks,
    };
    let drawn = material.draw();
    Ok((session.outcome(&pictures, looks, started), drawn))
}

/// A session in which all is judged, the images, how often they were looked at, and when it began.
type Judgement<'a> = (Session<'a>, Vec<Picture>, u32, Instant);

fn judge<'a>(request: &'a Request, progress: &dyn Fn(u64, u64)) -> Result<Judgement<'a>, Error> {
    let started = Instant::now();
    let mut pictures = Vec::new();
    let mut session: Option<Session> = None;
    let mut looks = 0;
    for (count, share) in request.looks() {
        request.extend(&mut pictures, count, progress)?;
        check(&pictures)?;
        let current = match session.take() {
            Some(session) => session,
            None => Session::new(request, &pictures)?,
        };
        let current = session.insert(current);
        current.look(&pictures, share, count);
        looks += 1;
        if current.is_settled() {
            break;
        }
    }
    let Some(session) = session else {
        return Err(Error::Parameter {
            file: "command line".to_owned(),
            key: "images".to_owned(),
            found: "none".to_owned(),
            allowed: "at least one file, or --command".to_owned(),
        });
    };
    Ok((session, pictures, looks, started))
}

impl Request {
    /// Numbers of images at which they are judged, and the part of the error probabilities that each look may spend.
    fn looks(&self) -> Vec<(u64, f64)> {
        match &self.images {
            Images::Files(files) if files.is_empty() => Vec::new(),
            Images::Files(files) => vec![(files.len() as u64, 1.0)],
            Images::Command(_, most) => {
                let (mut count, mut share) = (FIRST_LOOK.min(*most), 0.5);
                let mut looks = vec![(count, share)];
                while count < *most {
                    count = (2 * count).min(*most);
                    share *= 0.5;
                    looks.push((count, share));
                }
                looks
            }
        }
    }

    /// Reads or makes images until there are so many.
    fn extend(
        &self,
        pictures: &mut Vec<Picture>,
        count: u64,
        progress: &dyn Fn(u64, u64),
    ) -> Result<(), Error> {
        let camera = &self.entry.camera;
        let read = |path: &std::path::Path| {
            read(
                path,
                (camera.width, camera.height),
                self.entry.kind.classes(),
            )
        };
        for k in pictures.len() as u64..count {
            progress(k, count);
            pictures.push(match &self.images {
                Images::Files(files) => read(&files[k as usize])?,
                Images::Command(command, _) => {
                    let seeds = Seeds::new(self.seed, &self.entry.name, "gate");
                    let seed = seeds.replicate(FINAL, k as u32) % SEEDS;
                    let mut picture = command.run(seed, read)?;
                    picture.file = format!("seed {seed}");
                    picture
                }
            });
        }
        Ok(())
    }
}

/// What stays the same from look to look.
struct Session<'a> {
    request: &'a Request,
    truth: Truth,
    covered: Vec<bool>,
    regions: Regions,
    plan: Plan,
    layers: Vec<Layer>,
    levels: Levels,
    /// By check.
    spent: Vec<Spent>,
    judged: Vec<Option<Judged>>,
}

impl<'a> Session<'a> {
    fn new(request: &'a Request, pictures: &[Picture]) -> Result<Self, Error> {
        let tolerance = TOLERANCE_PER_MARGIN * request.margin;
        let entry = &request.entry;
        let mut truth = Truth::new(entry, tolerance, request.offset);
        if let Some(exported) = &request.exported {
            truth.allow_for(exported.pixel_error);
        }
        let mut covered = truth.shown.clone();
        let of_files = pictures.first().and_then(|p| p.covered.as_deref());
        let of_mask = request.mask.as_ref().map(Mask::selected);
        for selected in [of_files, of_mask].into_iter().flatten() {
            covered.iter_mut().zip(selected).for_each(|(c, s)| *c &= *s);
        }
        let (width, height) = (entry.camera.width, entry.camera.height);
        let regions = if covered.contains(&false) {
            Regions::mask(width, height, &covered).ok_or_else(|| Error::Parameter {
                file: "command line".to_owned(),
                key: "--mask".to_owned(),
                found: "no pixel that the files cover".to_owned(),
                allowed: "a mask that leaves some of the image".to_owned(),
            })?
        } else {
            Regions::quadtree(width, height)
        };
        if let Some(how) = request.regularization {
            truth.regularize(how, tolerance, &regions)?;
        }
        let mut layers = stacks(pictures, request.gain, request.samples, &covered);
        let plan = plan(&truth, &mut layers, &request.cannot, &covered, &regions);
        let count = plan.checks.len();
        Ok(Session {
            request,
            truth,
            covered,
            regions,
            levels: Levels::shared(request.level, EQUIVALENCE_LEVEL, count as u64),
            spent: vec![Spent::default(); count],
            judged: vec![None; count],
            plan,
            layers,
        })
    }

    /// Judges what is not decided yet.
    fn look(&mut self, pictures: &[Picture], share: f64, most: u64) {
        self.layers = stacks(
            pictures,
            self.request.gain,
            self.request.samples,
            &self.covered,
        );
        // The sum of the layers is made anew with them.
        self.plan = plan(
            &self.truth,
            &mut self.layers,
            &self.request.cannot,
            &self.covered,
            &self.regions,
        );
        let shared: Vec<_> = self.layers.iter().map(|l| l.stack.shared()).collect();
        let look = Look {
            truth: &self.truth,
            regions: &self.regions,
            covered: &self.covered,
            margin: self.request.margin,
            levels: self.levels,
            share,
            most,
        };
        for (k, check) in self.plan.checks.iter().enumerate() {
            let is_open = |j: &Judged| !is_final(&j.finding);
            if self.judged[k].as_ref().is_none_or(is_open) {
                let images = check.images;
                let judged = look.judge(
                    check,
                    &self.layers[images].stack,
                    &shared[images],
                    &mut self.spent[k],
                );
                self.judged[k] = Some(judged);
            }
        }
    }

    /// Whether all is decided, or more images would not help; what a picture does not tell is no reason to go on.
    fn is_settled(&self) -> bool {
        let is_open = |f: &Finding| f.state == State::Undecided && f.replicates_needed.is_some();
        self.judged.iter().flatten().all(|j| !is_open(&j.finding))
    }

    fn outcome(self, pictures: &[Picture], looks: u32, started: Instant) -> Outcome {
        let request = self.request;
        let command = reproduce::command(request);
        let blank = |class: &str, finding: Finding| Verdict {
            scene: request.entry.name.clone(),
            variation: None,
            integrator: request.name.clone(),
            class: class.to_owned(),
            region: (if request.mask.is_some() {
                MASK
            } else {
                WHOLE_IMAGE
            })
            .to_owned(),
            finding,
            truth: None,
            mean: None,
            margin: request.margin,
            levels: self.levels,
            bandwidth: None,
            excluded: None,
            tail: None,
            looks_like: None,
            replicates: pictures.len() as u32,
            looks,
            paths: 0,
            paths_needed: None,
            seed: request.seed,
            seconds: 0.0,
            command: command.clone(),
        };
        let mut verdicts: Vec<(usize, Verdict)> = Vec::new();
        for known in &self.plan.known {
            let verdict = blank(&known.class, known.finding.clone());
            verdicts.push((
                known.position,
                Verdict {
                    looks_like: known.looks_like.clone(),
                    ..verdict
                },
            ));
        }
        for (check, judged) in self.plan.checks.iter().zip(&self.judged) {
            let Some(judged) = judged else {
                continue;
            };
            let truth = self.truth.areas(&check.classes, &self.regions)[0];
            let place = judged.finding.place.clone();
            let regularized = !self.truth.has_pixels(&check.classes);
            let position = if check.class == ALL_CLASSES {
                usize::MAX
            } else {
                check.classes[0]
            };
            let verdict = blank(&check.class, judged.finding.clone());
            verdicts.push((
                position,
                Verdict {
                    region: place.unwrap_or_else(|| check.region.to_owned()),
                    truth: Some(truth),
                    mean: Some(if check.is_separated {
                        judged.mean * truth.value
                    } else {
                        judged.mean
                    }),
                    bandwidth: request
                        .regularization
                        .filter(|_| regularized)
                        .map(|r| r.bandwidth),
                    looks_like: judged.looks_like.clone(),
                    ..verdict
                },
            ));
        }
        verdicts.sort_by_key(|(position, _)| *position);
        let mut verdicts: Vec<Verdict> = verdicts.into_iter().map(|(_, v)| v).collect();
        let checks = self.plan.checks.len() as u64;
        settle(&mut verdicts, request.level, checks);
        self.annotate(&mut verdicts);
        let seconds = started.elapsed().as_secs_f64();
        verdicts.iter_mut().for_each(|v| v.seconds = seconds);
        let mut notes = notes(pictures, request.samples);
        notes.extend(self.notes());
        Outcome {
            program: Program::Gate,
            verdicts,
            not_run: Vec::new(),
            notes,
            effort: None,
            level: request.level,
            equivalence_level: EQUIVALENCE_LEVEL,
            checks,
            margin: request.margin,
            bandwidth: request.regularization.map(|r| r.bandwidth),
            seed: request.seed,
            seconds,
        }
    }

    /// Says what different images look like; of one or two images, what they look like if they are.
    fn annotate(&self, verdicts: &mut [Verdict]) {
        let few = self
            .layers
            .first()
            .is_some_and(|l| l.stack.images.len() < FEWEST_IMAGES);
        for verdict in verdicts.iter_mut().filter(|v| v.looks_like.is_none()) {
            let is_told = verdict.finding.state == State::Different
                || (few && verdict.finding.state == State::Undecided);
            let fits = |c: &&Check| c.class == verdict.class && !c.is_separated;
            let Some(check) = self.plan.checks.iter().find(fits).filter(|_| is_told) else {
                continue;
            };
            if self.truth.has_pixels(&check.classes) {
                verdict.looks_like = calibration::of(&calibration::Subject {
                    truth: &self.truth,
                    classes: &check.classes,
                    stack: &self.layers[check.images].stack,
                    covered: &self.covered,
                });
            }
        }
    }

    /// What was assumed of the images.
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let longest = self.request.entry.kind.closure().longest;
        let has_beauty = self.layers.iter().any(|l| l.classes.is_none());
        if let (Some(longest), true) = (longest, has_beauty) {
            notes.push(format!(
                "the image of all light is compared as one of paths of up to {longest} edges (light, {} surfaces, eye): longer ones are \
                 no part of the truth",
                longest - 1
            ));
        }
        if self.request.gain != 1.0 {
            notes.push(format!(
                "values are divided by --gain {}",
                self.request.gain
            ));
        }
        if let Some(exported) = &self.request.exported {
            notes.push(format!(
                "meshes of the exported scene may change a pixel by {:.1e} of the brightest about it: so much is added to the truth's bound",
                exported.pixel_error
            ));
        }
        if self.request.offset != [0.0; 2] {
            let [x, y] = self.request.offset;
            notes.push(format!(
                "the frame is taken to be moved by --offset {x},{y}; the pixels beyond are left out"
            ));
        }
        notes
    }
}

/// Whether a verdict stands.
fn is_final(finding: &Finding) -> bool {
    !matches!(finding.state, State::Undecided | State::NotComparable)
}
