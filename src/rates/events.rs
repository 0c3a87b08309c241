//! Events along a schedule: contributions that are not zero, and replicates that have none.

use super::converge::{Point, Request};
use super::counts::{none_of, p_bound};
use super::law::Law;
use super::outcome::Test;
use super::runs::Along;

/// Probabilities of a hit are interpolated and averaged over a close-up to better than this.
const KNOWN_TO: f64 = 1e-3;
/// Contributions that are not zero (of paths; for merging: iterations that found a photon) since the n before, in all replicates,
/// and replicates that had none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Events {
    /// Number of events.
    pub count: u64,
    /// Its expectation.
    pub expected: f64,
    /// How far it may be off, relative to it, where the region is not quite a point.
    pub known_to: f64,
    /// Replicates without any.
    pub empty: u64,
    /// Their expected number.
    pub expected_empty: f64,
}

/// Events since the n before, where the probabilities of a hit are known.
pub(super) fn events(law: &Law, rows: &[Along], paths: u64, merges: bool) -> Option<Vec<Events>> {
    let hits: Vec<f64> = law
        .iterations
        .iter()
        .map(|e| e.hit)
        .collect::<Option<_>>()?;
    let replicates = rows.len() as f64;
    let (mut result, mut expected, mut empty) = (Vec::new(), 0.0, 1.0);
    let mut known_to = KNOWN_TO;
    for ((n, &p), e) in (1_usize..).zip(&hits).zip(&law.iterations) {
        known_to = f64::max(known_to, e.excess);
        let nothing = none_of(p, paths as f64);
        expected += if merges {
            1.0 - nothing
        } else {
            p * paths as f64
        };
        empty *= nothing;
        if n.is_power_of_two() {
            let k = result.len();
            let of = |r: &Along| {
                if merges {
                    r.alive[k]
                } else {
                    r.contributions[k]
                }
            };
            result.push(Events {
                count: rows.iter().map(of).sum(),
                expected: replicates * expected,
                known_to,
                empty: rows.iter().filter(|r| of(r) == 0).count() as u64,
                expected_empty: replicates * empty,
            });
            (expected, empty, known_to) = (0.0, 1.0, KNOWN_TO);
        }
    }
    (!result.is_empty()).then_some(result)
}

/// Their numbers against what they should be.
pub(super) fn count_tests(
    request: &Request,
    points: &[Point],
    paths: u64,
    merges: bool,
) -> Vec<Test> {
    let mut tests = Vec::new();
    let mut before = 0;
    for p in points {
        let iterations = f64::from(p.iterations - before);
        before = p.iterations;
        let Some(events) = p.events else {
            continue;
        };
        let replicates = f64::from(request.asked.replicates);
        let trials = replicates * iterations * if merges { 1.0 } else { paths as f64 };
        tests.push(Test {
            what: format!(
                "number of contributions that are not zero up to iteration {}",
                p.iterations
            ),
            p: p_bound(
                events.count,
                trials,
                events.expected,
                KNOWN_TO * events.expected,
            ),
        });
        tests.push(Test {
            what: format!(
                "replicates to which the iterations up to {} add nothing",
                p.iterations
            ),
            p: p_bound(
                events.empty,
                replicates,
                events.expected_empty,
                KNOWN_TO * replicates,
            ),
        });
    }
    tests
}
