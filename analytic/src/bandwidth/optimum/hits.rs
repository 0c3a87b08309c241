//! How often a sample is not zero, and the bandwidth at which no path is missed.
//!
//! Samples have the density w/f, w the weight of the mean and f the value of one sample without its kernel, so a sample is not zero with
//! probability p(α) = ∫ w/f over the support. All N samples miss with (1 − p)^N; the *preview* bandwidth is the smallest at which
//! that is at most ε.

use crate::bandwidth::chart::connection::Connection;
use crate::bandwidth::chart::link::{Case, Link};
use crate::bandwidth::chart::merging::Merging;
use crate::bandwidth::chart::{Integrand, Node, integrate};
use crate::bandwidth::kernel::Profile;
use crate::bandwidth::law::family::Family;
use crate::bandwidth::light::Class;
use crate::bandwidth::{Bounded, Kernel, Technique};

/// An integrand whose density is that of the samples.
struct Sampled<I>(I);

impl<I: Integrand> Integrand for Sampled<I> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.0.domain()
    }

    fn edges(&self) -> &[f64] {
        self.0.edges()
    }

    fn spans(&self) -> &[f64] {
        self.0.spans()
    }

    fn node(&self, u: [f64; 2]) -> Node {
        let mut node = self.0.node(u);
        let [w, squared] = node.density;
        node.density = [if w > 0.0 { w * w / squared } else { w }, 0.0];
        node
    }

    fn kernel(&self, _: usize, _: &Node) -> [f64; 2] {
        [1.0, 0.0]
    }

    fn rounding(&self) -> f64 {
        self.0.rounding()
    }

    fn coarse(&self) -> [u32; 2] {
        self.0.coarse()
    }
}

/// Probability that a sample at a floor point is not zero. Of the von Mises–Fisher kernel, which ends nowhere, `None`.
pub(super) fn probability(
    family: &Family,
    class: &Class,
    x: [f64; 2],
    bandwidth: f64,
    tolerance: f64,
) -> Option<Bounded> {
    if family.kernel == Kernel::VonMisesFisher {
        return None;
    }
    let profile = Profile::new(
        family.kernel,
        family.technique.bandwidth_is_angle(),
        &[bandwidth],
    );
    let mut sum = Bounded::default();
    let mut add = |pair: crate::bandwidth::quadrature::Pair| {
        sum.value += pair.value[0];
        sum.error += pair.error[0];
    };
    for caustic in &class.caustics {
        let mut connect = |link| {
            let c = Connection::new(
                caustic,
                x,
                family.receiver,
                family.technique,
                &profile,
                link,
            );
            add(integrate(&Sampled(c), tolerance, [0.0; 2]));
        };
        if family.technique != Technique::Linked {
            connect(None);
            continue;
        }
        for case in Case::all(family.convention, 0, family.receiver.escape.is_some()) {
            connect(Some(Link {
                convention: family.convention,
                radius: bandwidth,
                kernel: family.kernel,
                case,
            }));
        }
    }
    for bundle in &class.bundles {
        let m = Merging::new(bundle, family.receiver, x, &profile, class.photons);
        if !m.is_weighted() {
            return None;
        }
        add(integrate(&Sampled(m), tolerance, [0.0; 2]));
    }
    Some(sum)
}

/// The smallest bandwidth up to `high` with (1 − p)^paths ≤ ε, p growing with the bandwidth.
pub(super) fn preview(
    high: f64,
    paths: f64,
    epsilon: f64,
    mut probability: impl FnMut(f64) -> Option<f64>,
) -> Option<f64> {
    // p ≥ 1 − ε^(1/N).
    let wanted = -libm::expm1(libm::log(epsilon) / paths);
    if !(probability(high)? >= wanted) {
        return None;
    }
    // p is nearly α² p(1): steps of that kind inside a bracket, in ln α.
    let (mut low, mut high) = (
        libm::log(crate::bandwidth::SMALLEST_BANDWIDTH),
        libm::log(high),
    );
    let mut t = high;
    for _ in 0..60 {
        let p = probability(libm::exp(t))?;
        if p >= wanted {
            high = t;
        } else {
            low = t;
        }
        if high - low < 1e-6 {
            break;
        }
        let guess = t + 0.5 * libm::log(wanted / p);
        // A little beyond, so that both ends of the bracket close in.
        let next = if p >= wanted {
            guess - 2e-7
        } else {
            guess + 2e-7
        };
        t = if next > low && next < high {
            next
        } else {
            0.5 * (low + high)
        };
    }
    Some(libm::exp(high))
}
