//! One error probability for a whole suite: Holm's procedure.
//!
//! The m p-values are put in order; the smallest is compared with level/m, the next with level/(m - 1), and so on up to the
//! first that is larger [Holm 1979]. Why no more than the level is spent, whatever the dependence: let m₀ of the null
//! hypotheses be true. Before the first of these is rejected, at most m - m₀ (false ones) have been, so it is compared
//! with at most level/m₀; and by the union bound the probability that any of m₀ true ones has p ≤ level/m₀ is at most
//! the level. (It is the closed procedure whose local tests are Bonferroni's [Marcus, Peritz & Gabriel 1976].)
//!
//! "Different" and "equivalent" are two families, each with its own level. The p-values are those of
//! [`super::spending`], valid at whatever look a run ended. A run itself stops by level/m, which Holm never
//! undercuts: the procedure can only add decisions at the end.

/// For each p-value the level it was compared with if it is rejected. NaN is never rejected.
pub fn holm(p: &[f64], level: f64, checks: u64) -> Vec<Option<f64>> {
    let mut order: Vec<usize> = (0..p.len()).filter(|&i| !p[i].is_nan()).collect();
    order.sort_by(|&i, &j| p[i].total_cmp(&p[j]));
    let mut result = vec![None; p.len()];
    let mut remaining = checks.max(p.len() as u64);
    for i in order {
        let share = level / remaining.max(1) as f64;
        if !(p[i] <= share) {
            break;
        }
        result[i] = Some(share);
        remaining -= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Holm's own example of the step: 0.01, 0.02, 0.03, 0.04 at 0.05.
    #[test]
    fn steps_down_to_the_first_that_stays() {
        let p = [0.02, 0.005, 0.04, 0.016];
        // 0.005 ≤ 0.0125, 0.016 ≤ 0.0167, 0.02 ≤ 0.025, 0.04 ≤ 0.05.
        assert!(holm(&p, 0.05, 4).iter().all(Option::is_some));
        let p = [0.02, 0.005, 0.04, 0.017];
        assert_eq!(holm(&p, 0.05, 4), [None, Some(0.0125), None, None]);
        assert_eq!(holm(&[f64::NAN, 0.01], 0.05, 2), [None, Some(0.025)]);
        // A family of which some are not listed.
        assert_eq!(holm(&[0.01], 0.05, 10), [None]);
    }

    /// All true, strongly dependent or not: rejections of any happen with at most the level. 20000 runs at 0.01: 200
    /// expected if independent, above 290 with probability below 1e-9.
    #[test]
    fn any_false_rejection_is_as_rare_as_stated() {
        use crate::stream::{philox, uniform};
        for dependent in [false, true] {
            let wrong = (0..20_000_u32)
                .filter(|&run| {
                    let p: Vec<f64> = (0..20)
                        .map(|k| {
                            let [a, b, ..] =
                                philox([run, if dependent { k / 10 } else { k }, 0, 0], [3, 4]);
                            uniform(a, b)
                        })
                        .collect();
                    holm(&p, 0.01, 20).iter().any(Option::is_some)
                })
                .count();
            assert!(wrong < 290, "{wrong}");
            assert!(dependent || wrong > 110, "{wrong}");
        }
    }
}
