//! Looks: how often a growing sample is judged, and which part of the error probability each look may spend.
//!
//! A sample size is planned from a pilot; the looks are at that size and at its halves and doubles. The planned look spends
//! half of the error probability, the earlier ones 1/8, 1/16, … backwards, the later ones 1/8, 1/16, … forwards: never
//! more than 1 in all, however many there are. By the union bound, min over looks of p/share is a p-value at whatever
//! look one stops, for whatever reason: so a clear case ends early, an unclear one goes on, and a budget may end it. The
//! schedule is fixed before the data of the test are seen; replicates of pilots are not among them.

/// Fewest replicates at the first look.
pub const FIRST_LOOK: u64 = 64;

/// One look at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Replicates so far.
    pub replicates: u64,
    /// Part of the error probability that is spent here.
    pub share: f64,
}

/// The looks for a planned number of replicates, up to the most: the last look is at the most, if the plan is not above
/// it.
pub fn looks(planned: u64, most: u64) -> Vec<Look> {
    let planned = planned.min(most).max(1);
    let mut looks = Vec::new();
    let mut before = Vec::new();
    let (mut replicates, mut share) = (planned / 2, 0.125);
    while replicates >= FIRST_LOOK {
        before.push(Look { replicates, share });
        replicates /= 2;
        share *= 0.5;
    }
    looks.extend(before.into_iter().rev());
    looks.push(Look {
        replicates: planned,
        share: 0.5,
    });
    let (mut replicates, mut share) = (planned, 0.125);
    while replicates < most {
        replicates = replicates.saturating_mul(2).min(most);
        looks.push(Look { replicates, share });
        share *= 0.5;
    }
    looks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_than_all_is_spent() {
        for (planned, most) in [
            (1, 1),
            (64, 64),
            (100, 1_000_000),
            (1 << 20, 1 << 20),
            (5000, 7000),
        ] {
            let looks = looks(planned, most);
            assert!(looks.iter().map(|l| l.share).sum::<f64>() <= 1.0);
            assert!(looks.windows(2).all(|w| w[0].replicates < w[1].replicates));
            assert_eq!(looks.last().unwrap().replicates, most);
            assert!(
                looks
                    .iter()
                    .any(|l| l.replicates == planned && l.share == 0.5)
            );
        }
        assert_eq!(looks(500, 100).last().unwrap().replicates, 100);
    }
}
