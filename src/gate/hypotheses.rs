//! What the image would be if one thing were wrong: the pictures that a measured image is compared with.

use super::truths::Truth;

/// What may be wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// Nothing but a factor.
    Factor,
    /// These classes are missing.
    Missing(Vec<usize>),
    /// Mirrored left and right, top and bottom, and across the diagonal.
    Turned([bool; 3]),
    /// Moved by columns to the right and rows down.
    Moved([f64; 2]),
    /// Larger about the middle by a factor.
    Zoomed(f64),
    /// Encoded for a display.
    Encoded(&'static str),
    /// Clamped at a value.
    Clamped(f64),
}

/// A cause and the picture it gives.
pub struct Hypothesis {
    /// What may be wrong.
    pub cause: Cause,
    /// `[row * width + column]`; NaN where it is not known.
    pub picture: Vec<f64>,
}

/// The image is compared with what is moved by up to so many pixels, in halves.
const MOVES: i32 = 4;
/// Magnifications that are tried, besides those of known mistakes: their number, and the largest.
const ZOOMS: i32 = 24;
const LARGEST_ZOOM: f64 = 2.0;
/// Larger images are not compared by each class that may be missing with each other.
const MOST_CLASSES: usize = 6;

/// All hypotheses about an image of some classes, the simplest first. `brightest` is its largest value.
pub fn all(truth: &Truth, classes: &[usize], covered: &[bool], brightest: f64) -> Vec<Hypothesis> {
    let width = truth.image.width as usize;
    let [image, _] = truth.pixels(classes);
    let mut list = vec![Hypothesis {
        cause: Cause::Factor,
        picture: image.clone(),
    }];
    let mut add = |cause: Cause, picture: Vec<f64>| list.push(Hypothesis { cause, picture });
    for absent in subsets(classes) {
        let left: Vec<usize> = classes
            .iter()
            .copied()
            .filter(|c| !absent.contains(c))
            .collect();
        add(Cause::Missing(absent), truth.pixels(&left)[0].clone());
    }
    for k in 1..8 {
        let how = [k & 1 != 0, k & 2 != 0, k & 4 != 0];
        if let Some(picture) = turned(&image, width, how) {
            add(Cause::Turned(how), picture);
        }
    }
    let fine = truth.fine(classes);
    let height = image.len() / width;
    for dy in -MOVES..=MOVES {
        for dx in -MOVES..=MOVES {
            if (dx, dy) != (0, 0) {
                let by = [0.5 * f64::from(dx), 0.5 * f64::from(dy)];
                add(
                    Cause::Moved(by),
                    moved(&fine, width, height, by, truth.offset()),
                );
            }
        }
    }
    if brightest < image.iter().copied().fold(0.0, f64::max) {
        add(
            Cause::Clamped(brightest),
            image.iter().map(|v| v.min(brightest)).collect(),
        );
    }
    for (name, encode) in ENCODINGS {
        add(
            Cause::Encoded(name),
            image.iter().map(|&v| encode(v)).collect(),
        );
    }
    for zoom in zooms(truth) {
        add(
            Cause::Zoomed(zoom),
            zoomed(&fine, width, height, zoom, truth.offset()),
        );
    }
    for h in &mut list {
        h.picture
            .iter_mut()
            .zip(covered)
            .for_each(|(v, c)| *v = if *c { *v } else { 0.0 });
    }
    list
}

/// A name and a transfer function.
type Encoding = (&'static str, fn(f64) -> f64);

/// Transfer functions from radiance to what a display is sent, and one that is applied the other way round.
const ENCODINGS: [Encoding; 4] = [
    ("the sRGB transfer function", srgb),
    ("a power of 1/2.2 (gamma)", |v| {
        libm::pow(v.max(0.0), 1.0 / 2.2)
    }),
    ("a power of 1/2.4 (gamma)", |v| {
        libm::pow(v.max(0.0), 1.0 / 2.4)
    }),
    (
        "a power of 2.2 (gamma taken away from linear values)",
        |v| libm::pow(v.max(0.0), 2.2),
    ),
];

fn srgb(v: f64) -> f64 {
    if v <= 0.003_130_8 {
        12.92 * v
    } else {
        1.055 * libm::pow(v, 1.0 / 2.4) - 0.055
    }
}

/// Classes that may be missing together: each, and any of a few; never all.
fn subsets(classes: &[usize]) -> Vec<Vec<usize>> {
    let n = classes.len();
    if n > MOST_CLASSES {
        return classes.iter().map(|&c| vec![c]).collect();
    }
    let mut sets: Vec<u32> = (1..(1_u32 << n).saturating_sub(1)).collect();
    sets.sort_by_key(|s| s.count_ones());
    let members = |s: u32| {
        (0..n)
            .filter(|k| s >> k & 1 == 1)
            .map(|k| classes[k])
            .collect()
    };
    sets.into_iter().map(members).collect()
}

/// The image turned over; `None` if it would have another shape.
fn turned(image: &[f64], width: usize, [across, down, diagonal]: [bool; 3]) -> Option<Vec<f64>> {
    let height = image.len() / width;
    if diagonal && width != height {
        return None;
    }
    let pixel = |i: usize| {
        let (x, y) = (i % width, i / width);
        let (x, y) = if diagonal { (y, x) } else { (x, y) };
        let x = if across { width - 1 - x } else { x };
        let y = if down { height - 1 - y } else { y };
        image[y * width + x]
    };
    Some((0..image.len()).map(pixel).collect())
}

/// The image moved by halves of a pixel, from one that is twice as fine; NaN beyond its border.
fn moved(fine: &[f64], width: usize, height: usize, by: [f64; 2], offset: [f64; 2]) -> Vec<f64> {
    let [dx, dy] = [0, 1].map(|k| libm::round(2.0 * (by[k] + offset[k])) as i64);
    let at = |x: i64, y: i64| {
        let is_inside = x >= 0 && y >= 0 && x < 2 * width as i64 && y < 2 * height as i64;
        if is_inside {
            fine[y as usize * 2 * width + x as usize]
        } else {
            f64::NAN
        }
    };
    let pixel = |i: usize| {
        let (x, y) = (2 * (i % width) as i64 - dx, 2 * (i / width) as i64 - dy);
        0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1))
    };
    (0..width * height).map(pixel).collect()
}

/// The image enlarged about its middle, from one that is twice as fine, at four points of each pixel; NaN beyond.
fn zoomed(fine: &[f64], width: usize, height: usize, zoom: f64, offset: [f64; 2]) -> Vec<f64> {
    let size = [width as f64, height as f64];
    let at = |x: f64, y: f64| {
        let from =
            |p: f64, k: usize| 2.0 * (0.5 * size[k] + (p - offset[k] - 0.5 * size[k]) / zoom);
        let (u, v) = (from(x, 0), from(y, 1));
        let is_inside = u >= 0.0 && v >= 0.0 && u < 2.0 * size[0] && v < 2.0 * size[1];
        if is_inside {
            fine[v as usize * 2 * width + u as usize]
        } else {
            f64::NAN
        }
    };
    let pixel = |i: usize| {
        let (x, y) = ((i % width) as f64, (i / width) as f64);
        let row = |v: f64| at(x + 0.25, v) + at(x + 0.75, v);
        0.25 * (row(y + 0.25) + row(y + 0.75))
    };
    (0..width * height).map(pixel).collect()
}

/// Magnifications of known mistakes about the field of view, and others.
fn zooms(truth: &Truth) -> Vec<f64> {
    let mut list: Vec<f64> = conventions(truth)
        .into_iter()
        .map(|(zoom, _)| zoom)
        .collect();
    for k in (-ZOOMS..=ZOOMS).filter(|k| *k != 0) {
        list.push(libm::pow(LARGEST_ZOOM, f64::from(k) / f64::from(ZOOMS)));
    }
    list
}

/// How the image is enlarged by a field of view that is taken for another one.
pub fn conventions(truth: &Truth) -> Vec<(f64, &'static str)> {
    let camera = &truth.entry().camera;
    let half = 0.5 * camera.field_of_view_degrees.to_radians();
    let aspect = f64::from(camera.width) / f64::from(camera.height);
    let mut list = vec![(
        libm::tan(half) / libm::tan(0.5 * half),
        "the full angle taken for twice the angle",
    )];
    if 2.0 * half < core::f64::consts::FRAC_PI_2 {
        list.push((
            libm::tan(half) / libm::tan(2.0 * half),
            "the full angle taken for half of the angle",
        ));
    }
    if camera.width != camera.height {
        list.push((aspect, "the vertical angle taken for the horizontal one"));
        list.push((
            1.0 / aspect,
            "the horizontal angle taken for the vertical one",
        ));
    }
    list.into_iter()
        .filter(|(z, _)| z.is_finite() && *z > 0.1 && *z < 10.0)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_what_they_say() {
        let image = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(
            turned(&image, 2, [true, false, false]).unwrap(),
            [2.0, 1.0, 4.0, 3.0]
        );
        assert_eq!(
            turned(&image, 2, [false, true, false]).unwrap(),
            [3.0, 4.0, 1.0, 2.0]
        );
        assert_eq!(
            turned(&image, 2, [false, false, true]).unwrap(),
            [1.0, 3.0, 2.0, 4.0]
        );
        assert_eq!(turned(&image, 4, [false, false, true]), None);
        let fine: Vec<f64> = (0..16).map(f64::from).collect();
        let shown = |v: Vec<f64>| -> Vec<Option<f64>> {
            v.into_iter().map(|v| (!v.is_nan()).then_some(v)).collect()
        };
        assert_eq!(
            moved(&fine, 2, 2, [0.0, 0.0], [0.0; 2]),
            [2.5, 4.5, 10.5, 12.5]
        );
        assert_eq!(
            shown(moved(&fine, 2, 2, [1.0, 0.0], [0.0; 2])),
            [None, Some(2.5), None, Some(10.5)]
        );
        assert_eq!(
            shown(moved(&fine, 2, 2, [0.0, -0.5], [0.0; 2])),
            [Some(6.5), Some(8.5), None, None]
        );
        assert_eq!(zoomed(&fine, 2, 2, 1.0, [0.0; 2]), [2.5, 4.5, 10.5, 12.5]);
        assert_eq!(subsets(&[3, 5]), [vec![3], vec![5]]);
        assert_eq!(subsets(&[1, 2, 3]).len(), 6);
    }
}
