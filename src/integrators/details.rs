//! A plan in detail: the techniques that build a class with what they draw, and what the scene spares.
//!
//! Everything here follows from the interactions along a path (`sampleable.rs`) and from the compiled scene; nothing is a table
//! of classes.

use nephroid_analytic::scene::Entry;

use super::sampleable::{Family, Interaction, Subpaths, possible, vertices};
use super::{ClassPlan, Technique, Treatment};
use crate::geometry::scene::Overrides;
use crate::geometry::tracer::{Aim, Emission, Extent, Outline, Traceable, Tracer, traceable};

/// One technique and what it draws.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Vertices traced from either side, (s, t). For merging both count the vertex at which they meet.
    pub subpaths: Subpaths,
    /// The densities of what is drawn, in the order in which it is drawn: from the eye, then from the light.
    pub densities: Vec<String>,
}

/// An edge that a method could connect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Its ends, as in `S-D`.
    pub ends: String,
    /// Whether one of them is specular.
    pub singular: bool,
}

/// What belongs to a class's plan beside its treatment.
#[derive(Clone, Debug, PartialEq)]
pub struct Details {
    /// The techniques; none for a class that is not sampled.
    pub techniques: Vec<Drawn>,
    /// The edges that the method could connect: the class is irregular if all of them are singular.
    pub edges: Vec<Edge>,
    /// The mollified vertex, counted from the light, which is 0.
    pub mollified: Option<usize>,
    /// What emission is limited to, for techniques that draw photons.
    pub emission: Option<Extent>,
}

/// What a ray can meet next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reach {
    /// Where the ray starts.
    pub from: &'static str,
    /// What it can meet.
    pub to: Vec<&'static str>,
}

/// A connection that paths need, and whether something could be in its way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Visibility {
    /// Its ends.
    pub between: &'static str,
    /// Whether a test is made.
    pub tested: bool,
    /// Why, or why not.
    pub reason: &'static str,
}

/// A scene, compiled.
pub struct CompiledScene {
    compiled: Traceable,
}

impl CompiledScene {
    /// Compiles a validated entry.
    pub fn new(entry: &Entry) -> Self {
        CompiledScene {
            compiled: traceable(entry, Overrides::default()),
        }
    }

    /// Which surfaces a ray can reach next.
    pub fn reach(&self) -> Vec<Reach> {
        let Traceable::Floor(tracer) = &self.compiled else {
            let to = vec!["wall"];
            let from = ["light", "wall", "eye"];
            return from
                .map(|from| Reach {
                    from,
                    to: to.clone(),
                })
                .to_vec();
        };
        let o = tracer.outline();
        let repeated = tracer.chains().iter().any(|c| c.light.len() > 1);
        let listed = |list: &[(bool, &'static str)]| {
            let there = list.iter().filter(|(there, _)| *there);
            there.map(|&(_, name)| name).collect::<Vec<_>>()
        };
        let mut rows = vec![Reach {
            from: "light",
            to: listed(&[(!o.separates, "floor"), (o.specular, "specular surface")]),
        }];
        if o.specular {
            rows.push(Reach {
                from: "specular surface",
                to: listed(&[(true, "floor"), (repeated, "specular surface")]),
            });
        }
        rows.push(Reach {
            from: "floor",
            to: listed(&[(o.specular, "specular surface")]),
        });
        rows.push(Reach {
            from: "eye",
            to: listed(&[
                (!(o.separates && o.seen_through), "floor"),
                (o.seen_through, "specular surface"),
            ]),
        });
        rows
    }

    /// Where visibility is tested, and where it need not be.
    pub fn visibility(&self) -> Vec<Visibility> {
        let Traceable::Floor(tracer) = &self.compiled else {
            return vec![Visibility {
                between: "any two points",
                tested: false,
                reason: "inside a sphere everything sees everything",
            }];
        };
        let o = tracer.outline();
        let straight = |between, hidden: bool| {
            let (tested, reason) = match (o.specular, hidden) {
                (false, _) => (false, "nothing stands over the floor"),
                (true, true) => (
                    false,
                    "never connected: the surface interrupts every straight line",
                ),
                (true, false) => (true, "the specular surface can be in the way"),
            };
            Visibility {
                between,
                tested,
                reason,
            }
        };
        let mut rows = vec![
            straight("floor and light", o.separates),
            straight("floor and pinhole", o.separates && o.seen_through),
        ];
        if o.specular {
            rows.push(Visibility {
                between: "mollified vertex and light",
                tested: o.meets_itself,
                reason: if o.meets_itself {
                    "the surface can be met again"
                } else {
                    "a ray that leaves the surface on the side of the light does not meet it again"
                },
            });
        }
        rows
    }

    /// The details of a class's plan, of a method that has the techniques of a family.
    pub fn details(&self, family: Family, plan: &ClassPlan) -> Details {
        let class = plan.class;
        let of_class = vertices(class);
        let name = |i: usize| match of_class[i] {
            Interaction::Light => "L",
            Interaction::Diffuse => "D",
            Interaction::Specular => "S",
            Interaction::Eye => "E",
        };
        let edges = (1..of_class.len())
            .map(|s| Subpaths {
                light: s,
                eye: of_class.len() - s,
            })
            .filter(|&t| family.has(t))
            .map(|t| Edge {
                ends: format!("{}-{}", name(t.light - 1), name(t.light)),
                singular: [t.light - 1, t.light]
                    .iter()
                    .any(|&i| of_class[i] == Interaction::Specular),
            })
            .collect();
        let technique = match plan.treatment {
            Treatment::Exact(t) | Treatment::Regularized(t) => Some(t),
            Treatment::NotSampled => None,
        };
        let mollified = match technique {
            Some(Technique::Camera | Technique::CameraEveryVertex | Technique::Symmetric) => {
                Some(1)
            }
            _ => None,
        };
        // Both subpaths end in the diffuse vertex: one vertex more than the path has.
        let merge = Subpaths {
            light: class.light.len() + 2,
            eye: class.eye.len() + 2,
        };
        let subpaths = match technique {
            None => Vec::new(),
            Some(Technique::NextEvent) => possible(class, Family::NextEvent, None),
            Some(Technique::LightTracing) => possible(class, Family::LightTracing, None),
            Some(Technique::Bidirectional) => possible(class, Family::Bidirectional, None),
            Some(Technique::Camera | Technique::CameraEveryVertex) => {
                possible(class, Family::NextEvent, mollified)
            }
            // The vertex next to the light is found, not drawn: the same subpaths as if it were mollified.
            Some(Technique::ManifoldSampling) => possible(class, Family::NextEvent, Some(1)),
            Some(Technique::Symmetric) => possible(class, Family::Bidirectional, mollified),
            Some(Technique::Merge | Technique::AdaptiveMerge) => vec![merge],
            Some(Technique::Connection) => possible(class, Family::Bidirectional, None),
            Some(Technique::ConnectionAndMerging) => {
                let mut all = possible(class, Family::Bidirectional, None);
                all.push(merge);
                all
            }
        };
        let emission = technique.and_then(|t| self.emission(t, plan));
        let densities = |s: &Subpaths| {
            let mut drawn = self.densities(plan, *s, emission.as_ref());
            if technique == Some(Technique::ManifoldSampling) {
                drawn.pop();
                drawn.push(
                    "specular vertex next to the light: a solution of the specular constraint, found by a walk from a random \
                     point of the surface; its probability by repeated walks"
                        .to_owned(),
                );
            }
            drawn
        };
        Details {
            techniques: subpaths
                .iter()
                .map(|s| Drawn {
                    subpaths: *s,
                    densities: densities(s),
                })
                .collect(),
            edges,
            mollified,
            emission: emission.map(|e| e.extent()),
        }
    }

    /// The photons that a technique draws for a class.
    fn emission(&self, technique: Technique, plan: &ClassPlan) -> Option<Emission> {
        let tracer: &dyn Tracer = match (&self.compiled, technique) {
            (
                _,
                Technique::NextEvent
                | Technique::Camera
                | Technique::CameraEveryVertex
                | Technique::ManifoldSampling,
            ) => return None,
            (Traceable::Furnace(furnace), _) => return Some(furnace.light.everywhere().into()),
            (Traceable::Floor(tracer), _) => tracer.as_ref(),
        };
        let chains = tracer.chains();
        let chain = chains.iter().position(|c| c.light == plan.class.light)?;
        Some(tracer.emission(match technique {
            Technique::Merge | Technique::AdaptiveMerge => Aim::Table(chain),
            _ if tracer.beams() == 1 => tracer.aim(0),
            _ => tracer.aim(chain),
        }))
    }

    fn densities(
        &self,
        plan: &ClassPlan,
        subpaths: Subpaths,
        emission: Option<&Emission>,
    ) -> Vec<String> {
        let class = plan.class;
        let outline = match &self.compiled {
            Traceable::Floor(tracer) => Some(tracer.outline()),
            Traceable::Furnace(_) => None,
        };
        let pixels = match (&self.compiled, outline) {
            (_, Some(Outline { camera, .. })) => camera.pixels(),
            (Traceable::Furnace(furnace), _) => furnace.camera.pixels(),
            (Traceable::Floor(_), None) => f64::NAN,
        };
        let ground = if outline.is_some() { "floor" } else { "wall" };
        let through = |n: usize| match n {
            0 => String::new(),
            1 => ", through the surface".to_owned(),
            n => format!(", through {n} interactions"),
        };
        let mut drawn = Vec::new();
        if subpaths.eye > 1 {
            let seen = through(class.eye.len());
            drawn.push(format!(
                "{ground} point{seen}: film position uniform over {pixels} pixels"
            ));
        }
        // Vertices beyond the first diffuse one from the eye.
        let beyond = subpaths.eye.saturating_sub(class.eye.len() + 2);
        let walk = usize::from(class.diffuse) - 1;
        for _ in 0..beyond.min(walk) {
            drawn.push(format!("next {ground} point: cos θ cos θ'/(π d²) per m²"));
        }
        if beyond > walk {
            drawn.push(format!(
                "specular vertex next to the light{}: cos θ_x cos θ_1/(π r_1²) per m² of what the direction at the {ground} \
                 point meets, cos θ_x/π per steradian",
                through(class.light.len() - 1)
            ));
        }
        if let (Some(emission), true) = (emission, subpaths.light > 1) {
            let uniform = match emission.extent() {
                Extent::SolidAngle(sr) => format!("photon direction: 1/{sr:.4} per steradian"),
                Extent::CrossSection(area) => {
                    format!("photon: 1/{area:.4} per m² of the beam's cross-section")
                }
            };
            drawn.push(uniform);
            for _ in 0..(subpaths.light - 2).min(walk) {
                drawn.push(format!("next {ground} point: cos θ cos θ'/(π d²) per m²"));
            }
        }
        drawn
    }
}
