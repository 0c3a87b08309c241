//! The kill matrix: every exhibit at each of its stands, after the same stands without a fault.

use nephroid_analytic::scene::Entry;

use super::baselines::{self, Accepted};
use super::exhibits::{Exhibit, Stand};
use super::trial::{Hall, MOST_PATHS, SetUp, Trial};
use crate::entry;
use crate::error::Error;
use crate::exit;
use crate::integrators;
use crate::verify::effort::Effort;
use crate::verify::suite::{Coverage, Pair, Subject, select};

/// Paths of a stand without a fault, and of exhibits that cannot be noticed.
const CONTROL_PATHS: u64 = 50_000_000;

/// Which part of the museum is shown.
pub struct Tour {
    /// The exhibits.
    pub exhibits: Vec<&'static Exhibit>,
    /// The stands of this integrator only.
    pub integrator: Option<String>,
    /// Seeds `seed ..`, so many.
    pub seeds: u64,
    /// The first seed.
    pub seed: u64,
    /// Whether the other renderers' rules are tried too.
    pub baselines: bool,
}

/// What came of one stand, over all seeds.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The exhibit; `None` for the control.
    pub exhibit: Option<&'static Exhibit>,
    /// The stand.
    pub stand: Stand,
    /// By seed.
    pub trials: Vec<Trial>,
    /// What the rules of other renderers say to the first seed's paths.
    pub accepted: Option<Accepted>,
}

impl Row {
    /// Seeds in which it was noticed.
    pub fn noticed(&self) -> usize {
        self.trials.iter().filter(|t| t.noticed).count()
    }

    /// Whether it was noticed in every seed.
    pub fn killed(&self) -> bool {
        self.noticed() == self.trials.len()
    }

    /// Whether it is as it should be: noticed in every seed, or, without a fault or with one that cannot be, in none.
    pub fn is_as_expected(&self) -> bool {
        match self.exhibit {
            Some(e) if e.unkillable.is_none() => self.killed(),
            _ => self.noticed() == 0,
        }
    }

    /// The most of a number over the seeds.
    pub fn worst(&self, of: impl Fn(&Trial) -> f64) -> f64 {
        self.trials.iter().map(of).fold(0.0, f64::max)
    }

    /// What it looks like with the first seed.
    pub fn looks_like(&self) -> Option<&str> {
        self.trials.first()?.looks_like.as_deref()
    }
}

/// All rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// Stands without a fault.
    pub controls: Vec<Row>,
    /// Stands with one.
    pub rows: Vec<Row>,
    /// Checks among which the level was shared.
    pub checks: u64,
    /// Seeds of each row.
    pub seeds: u64,
}

impl Matrix {
    /// 0 if all is as it should be, else 1; 4 if there was nothing to show.
    pub fn exit_code(&self) -> u8 {
        if self.rows.is_empty() {
            return exit::NOTHING_RAN;
        }
        let mut rows = self.controls.iter().chain(&self.rows);
        if rows.all(Row::is_as_expected) {
            exit::PASS
        } else {
            exit::DIFFERENT
        }
    }
}

/// Checks of a whole suite at `standard`: all scenes of the catalogue with all integrators.
///
/// # Errors
/// An entry that does not load.
pub fn checks_of_suite() -> Result<u64, Error> {
    let subjects = entry::names().map(|name| {
        let entry: Entry = entry::load(name)?;
        Ok(Subject {
            argument: name.to_owned(),
            entry,
        })
    });
    let subjects = subjects.collect::<Result<Vec<_>, Error>>()?;
    let (pairs, _) = select(&subjects, &integrators::all(), Coverage::Affordable);
    Ok(pairs.iter().map(Pair::checks).sum())
}

/// Takes the tour. `progress` hears of each row before it starts: its position, their number and its title.
///
/// # Errors
/// A stand that names no integrator or scene.
pub fn run(tour: &Tour, progress: &dyn Fn(usize, usize, &str)) -> Result<Matrix, Error> {
    let checks = checks_of_suite()?;
    let mut hall = Hall::new(Effort::Standard, checks);
    let is_shown = |s: &&Stand| tour.integrator.as_deref().is_none_or(|i| i == s.integrator);
    let stands: Vec<(&'static Exhibit, Stand)> = tour
        .exhibits
        .iter()
        .flat_map(|&e| e.stands.iter().filter(is_shown).map(move |&s| (e, s)))
        .collect();
    let mut controls: Vec<Stand> = Vec::new();
    for (_, stand) in &stands {
        if !controls.contains(stand) {
            controls.push(*stand);
        }
    }
    let count = controls.len() + stands.len();
    let mut matrix = Matrix {
        controls: Vec::new(),
        rows: Vec::new(),
        checks,
        seeds: tour.seeds,
    };
    for (k, stand) in controls.into_iter().enumerate() {
        progress(k, count, &format!("no fault: {}", stand.title()));
        let set_up = hall.set_up(&stand)?;
        matrix.controls.push(row(tour, &hall, &set_up, None)?);
    }
    for (k, (exhibit, stand)) in stands.into_iter().enumerate() {
        let title = format!("{}: {}", exhibit.id, stand.title());
        progress(matrix.controls.len() + k, count, &title);
        let set_up = hall.set_up(&stand)?;
        matrix.rows.push(row(tour, &hall, &set_up, Some(exhibit))?);
    }
    Ok(matrix)
}

fn row(
    tour: &Tour,
    hall: &Hall,
    set_up: &SetUp,
    exhibit: Option<&'static Exhibit>,
) -> Result<Row, Error> {
    let fault = exhibit.map(|e| e.fault);
    let killable = exhibit.is_some_and(|e| e.unkillable.is_none());
    let most = if killable { MOST_PATHS } else { CONTROL_PATHS };
    let seeds = tour.seed..tour.seed + tour.seeds;
    // The diagnosis costs as much as the verdict: once.
    let trials = seeds.map(|seed| hall.trial(set_up, fault, seed, most, seed == tour.seed));
    let trials = trials.collect::<Result<Vec<_>, _>>()?;
    let accepted = match (tour.baselines, trials.first()) {
        (true, Some(first)) => Some(baselines::of(set_up, fault, tour.seed, first.paths)?),
        _ => None,
    };
    Ok(Row {
        exhibit,
        stand: set_up.stand,
        trials,
        accepted,
    })
}
