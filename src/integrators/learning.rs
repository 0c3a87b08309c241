//! Runs of which later iterations depend on earlier ones.
//!
//! Most methods give every iteration by itself: seed, iteration and bandwidth say it all. One that chooses its bandwidth from what it has
//! seen must take its iterations in order. It looks at past photons only, so that an iteration has the expectation of its
//! bandwidth.

use super::Prepared;
use crate::film::Film;

/// The iterations of one run, in order.
pub trait Learner: Send {
    /// As [`Prepared::iterate`], after the run's earlier iterations, on the film that has them and nothing else.
    fn iterate(&mut self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film);
}

/// A run of any method.
pub enum Run<'a> {
    /// Its iterations do not depend on each other.
    Independent(&'a dyn Prepared),
    /// They do.
    Learning(Box<dyn Learner + 'a>),
}

impl<'a> Run<'a> {
    /// The start of a run.
    pub fn of(prepared: &'a dyn Prepared) -> Self {
        match prepared.learner() {
            Some(learner) => Run::Learning(learner),
            None => Run::Independent(prepared),
        }
    }

    /// The next iteration. See [`Learner::iterate`].
    pub fn iterate(
        &mut self,
        seed: u64,
        iteration: u32,
        paths: u64,
        bandwidth: f64,
        film: &mut Film,
    ) {
        match self {
            Run::Independent(prepared) => {
                prepared.iterate(seed, iteration, paths, bandwidth, film);
            }
            Run::Learning(learner) => learner.iterate(seed, iteration, paths, bandwidth, film),
        }
    }
}
