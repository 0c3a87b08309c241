//! Which cells of a bundle are kept, and as what.

use crate::flux::cells::{Cell, Cutter, DEEPEST, NEGLIGIBLE, Shape, Task};
use crate::flux::poly::{Chebyshev, Polynomial, value};

/// Largest span of a regular and of a folded cell [pixels].
const SPAN: [f64; 2] = [12.0, 1.0];
/// Allowed error of an interpolant, relative to its variation.
const SMOOTH: f64 = 1e-12;

/// As much, for parts of an interpolant.
const SMOOTH_PART: f64 = 8e-12;
/// Halvings towards a border after which a square root is suspected there.
const ROUGH: u32 = 3;

impl Cutter<'_> {
    /// All conditions hold: keeps the cell if it is smooth and small enough. `inherited` is the relative error of the
    /// interpolants x, y and flux if they are parts of a larger cell's.
    pub(super) fn keep(&mut self, task: Task, fits: [Chebyshev; 3], inherited: f64) {
        let [x, y, flux] = fits;
        let (px, py) = (x.polynomial(), y.polynomial());
        let Some((range, size)) = self.film_range(&px, &py) else {
            let wider = |c: &Chebyshev| [c.c[0][1].abs(), c.c[1][0].abs()];
            let [a, b] = [0, 1].map(|k| wider(&x)[k] + wider(&y)[k]);
            self.halve(task, usize::from(b > a));
            return;
        };
        // Errors of the interpolants: of the place relative to the cell or to a thousandth of a pixel, of the flux
        // relative to itself.
        let scale = self.lens.density(px.c[0][0], py.c[0][0]);
        let pixel = 1.0 / scale.abs().sqrt();
        let place = (x.spread() + y.spread()).max(1e-3 * pixel);
        let rounding = 1e-15 * (x.c[0][0].abs() + y.c[0][0].abs() + x.spread() + y.spread());
        let amount = flux.c[0][0].abs() + flux.spread();
        let mut miss = [0.0; 2];
        let tails = [x.tails(), y.tails(), flux.tails()];
        for (k, miss) in miss.iter_mut().enumerate() {
            let in_place = (tails[0][k] + tails[1][k] - 30.0 * rounding).max(0.0) / place;
            let in_flux = (tails[2][k] - 3e-14 * amount).max(0.0) / amount.max(1e-300);
            *miss = in_place.max(in_flux);
        }
        let worst = miss[0].max(miss[1]).max(inherited);
        let total = flux.integral();
        if worst > SMOOTH.max(inherited) {
            // What a small cell misses may be large for the cell, but not for the pixel.
            if 4.0 * amount * worst.min(1.0) > 10.0 * NEGLIGIBLE * self.typical {
                let axis = usize::from(miss[1] > miss[0]);
                match task.edge {
                    Some((edge, n)) if edge.axis == axis && n >= ROUGH => {
                        self.queue.push_back(Task {
                            chart: task.chart.squared(edge),
                            edge: None,
                            ..task
                        });
                    }
                    _ => self.halve(task, axis),
                }
                return;
            }
        }
        let error = (worst + 1e-15) * 4.0 * amount;
        let single = (0..2).all(|k| range[k][0].floor() == range[k][1].floor());
        let shape = if regular(&x, &y) {
            Shape::Regular
        } else {
            Shape::Folded
        };
        let allowed = SPAN[usize::from(shape == Shape::Folded)];
        let span = (range[0][1] - range[0][0]).max(range[1][1] - range[1][0]);
        if span > allowed && !single && task.depth < DEEPEST {
            let axis = usize::from(size[1] > size[0]);
            let inherited = 2.0 * worst.max(1e-14);
            if inherited > SMOOTH_PART {
                self.halve(task, axis);
                return;
            }
            for (upper, half) in [false, true].into_iter().zip(task.halves(axis)) {
                let [x, y, flux] = [x, y, flux].map(|c| c.half(axis, upper));
                let flux = flux.combined(0.5, &flux, 0.0, 0.0);
                if !self.out_of_frame(&x, &y) {
                    self.keep(half, [x, y, flux], inherited);
                }
            }
            return;
        }
        // Slices go along a: the direction in which more happens.
        let exchange = shape == Shape::Folded && size[1] > size[0];
        let order = |c: Chebyshev| {
            if exchange {
                c.exchanged().polynomial()
            } else {
                c.polynomial()
            }
        };
        let mut primitive = order(flux);
        for row in &mut primitive.c {
            for (k, c) in row.iter_mut().enumerate() {
                *c /= (k + 1) as f64;
            }
        }
        let cell = Cell {
            x: order(x),
            y: order(y),
            flux: primitive,
            shape,
        };
        self.push(range, total, error, Some(cell));
    }

    /// Range of the film coordinates, and the largest extent on the film along either axis; `None` if not all of the cell
    /// is in front of the camera.
    fn film_range(&self, x: &Polynomial, y: &Polynomial) -> Option<([[f64; 2]; 2], [f64; 2])> {
        const AT: [f64; 5] = [-1.0, -0.6, 0.0, 0.6, 1.0];
        let mut film = [[[0.0; 2]; 5]; 5];
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for (l, b) in AT.into_iter().enumerate() {
            let (cx, cy) = (x.along_a(b), y.along_a(b));
            for (k, a) in AT.into_iter().enumerate() {
                let p = [&cx, &cy].map(|c| value(c, a));
                if !(self.lens.depth(p[0], p[1]) > 0.0) {
                    return None;
                }
                film[l][k] = self.lens.film(p[0], p[1]);
                for (range, f) in range.iter_mut().zip(film[l][k]) {
                    *range = [range[0].min(f), range[1].max(f)];
                }
            }
        }
        let length = |line: [[f64; 2]; 5]| -> f64 {
            let steps = line.windows(2).map(|w| {
                let d = [w[1][0] - w[0][0], w[1][1] - w[0][1]];
                f64::abs(d[0]).max(f64::abs(d[1]))
            });
            steps.sum()
        };
        let columns: [[[f64; 2]; 5]; 5] =
            core::array::from_fn(|k| core::array::from_fn(|l| film[l][k]));
        let size = [film, columns].map(|lines| lines.map(length).into_iter().fold(0.0, f64::max));
        Some((range, size))
    }
}

/// Whether the map is the identity plus a contraction, after its linear part is inverted: then it is one-to-one, and
/// Newton's method converges on it.
fn regular(x: &Chebyshev, y: &Chebyshev) -> bool {
    let [xa, xb] = [x.c[0][1], x.c[1][0]];
    let [ya, yb] = [y.c[0][1], y.c[1][0]];
    let det = xa * yb - xb * ya;
    if !(det.abs() > 1e-12 * (xa.abs() + ya.abs()) * (xb.abs() + yb.abs())) {
        return false;
    }
    let first = x.combined(yb / det, y, -xb / det, 0.0);
    let second = x.combined(-ya / det, y, xa / det, 0.0);
    let weight = |k: usize, l: usize| {
        if k + l > 1 {
            (k * k + l * l) as f64
        } else {
            0.0
        }
    };
    first.sum(weight) < 0.5 && second.sum(weight) < 0.5
}
