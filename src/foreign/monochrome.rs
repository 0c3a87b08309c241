//! From the channels of a layer to one number per pixel: the mean of R, G and B; or Y; or the only channel there is.

use super::channels::{Channel, content};
use crate::error::Error;

/// The largest number that a half can hold.
const LARGEST_HALF: f32 = 65504.0;

/// A layer of one number per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Monochrome {
    /// `[row * width + column]`.
    pub values: Vec<f64>,
    /// How far it is from grey, beyond rounding; `None` if it is grey.
    pub tint: Option<Tint>,
}

/// How far R, G and B are from their mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tint {
    /// Mean over the image of each, relative to the mean of the three, less 1.
    pub channels: [f64; 3],
    /// Pixels in which one of them is off by more than rounding.
    pub pixels: u64,
}

/// Combines the channels of a layer, given with the names of their components. `None` if there is none that holds light.
///
/// # Errors
/// [`Error::Content`] for what is not a number or infinite in the channels used: how many, and where the first is.
pub fn combine(
    file: &str,
    width: u32,
    components: &[(&str, &Channel)],
    covered: Option<&[bool]>,
) -> Result<Option<Monochrome>, Error> {
    let find = |name: &str| {
        components
            .iter()
            .find(|(n, _)| n.eq_ignore_ascii_case(name))
            .map(|(_, c)| *c)
    };
    if let (Some(r), Some(g), Some(b)) = (find("R"), find("G"), find("B")) {
        let rgb = [r, g, b];
        rgb.iter()
            .try_for_each(|c| check(file, width, c, covered))?;
        let at = |c: &Channel, i: usize| f64::from(c.values[i]);
        let value = |i: usize| rgb.iter().map(|c| at(c, i)).sum::<f64>() / 3.0;
        let values: Vec<f64> = (0..r.values.len()).map(value).collect();
        let tint = tint(rgb, &values);
        return Ok(Some(Monochrome { values, tint }));
    }
    let alone = || match components {
        [(name, only)] if !name.eq_ignore_ascii_case("A") => Some(*only),
        _ => None,
    };
    let Some(channel) = find("Y").or_else(|| find("")).or_else(alone) else {
        return Ok(None);
    };
    check(file, width, channel, covered)?;
    Ok(Some(Monochrome {
        values: channel.values.iter().map(|&v| f64::from(v)).collect(),
        tint: None,
    }))
}

/// Refuses a channel with values that are no numbers.
fn check(file: &str, width: u32, channel: &Channel, covered: Option<&[bool]>) -> Result<(), Error> {
    let is_covered = |i: usize| covered.is_none_or(|c| c[i]);
    let bad =
        || (0..channel.values.len()).filter(|&i| is_covered(i) && !channel.values[i].is_finite());
    let Some(first) = bad().next() else {
        return Ok(());
    };
    let nans = bad().filter(|&i| channel.values[i].is_nan()).count();
    let infinite = bad().count() - nans;
    let width = width as usize;
    let (column, row) = (first % width, first / width);
    let what = if channel.is_half && infinite > 0 {
        format!(" (what is above {LARGEST_HALF} overflows a half)")
    } else {
        String::new()
    };
    let help = if channel.is_half {
        format!("finite values from 0 to {LARGEST_HALF}; write 32-bit float for more")
    } else {
        "finite values".to_owned()
    };
    Err(content(
        file,
        format!(
            "channel {}: {nans} values are not a number, {infinite} are infinite{what}: the first at column {column}, row {row}",
            channel.name
        ),
        help,
    ))
}

fn tint(rgb: [&Channel; 3], mean: &[f64]) -> Option<Tint> {
    // Half a unit in the last place of each, twice for what a renderer's own sums add.
    let rounding = if rgb.iter().any(|c| c.is_half) {
        libm::ldexp(1.0, -10)
    } else {
        libm::ldexp(1.0, -20)
    };
    let is_off = |i: &usize| {
        let off = |c: &&Channel| {
            (f64::from(c.values[*i]) - mean[*i]).abs() > rounding * mean[*i].abs() + 1e-7 * rounding
        };
        rgb.iter().any(off)
    };
    let pixels = (0..mean.len()).filter(is_off).count() as u64;
    let total: f64 = mean.iter().sum();
    let of = |c: &Channel| c.values.iter().map(|&v| f64::from(v)).sum::<f64>() / total - 1.0;
    (pixels > 0 && total > 0.0).then(|| Tint {
        channels: rgb.map(of),
        pixels,
    })
}

impl core::fmt::Display for Tint {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let [r, g, b] = self.channels.map(|c| 100.0 * c);
        write!(
            f,
            "not grey in {} pixels: R {r:+.2} %, G {g:+.2} %, B {b:+.2} % off their mean over the image; the mean is judged",
            self.pixels
        )
    }
}
