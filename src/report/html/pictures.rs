//! Pictures as data: the truth and the observed on one grey scale, maps of the difference on a fixed diverging one.

use core::fmt::Write as _;
use std::io::Cursor;

use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

use super::escaped;
use crate::report::comparison::Comparison;

/// Where the scale of the difference ends, as a part of the mean truth.
pub const LARGEST_DIFFERENCE: f64 = 0.5;
/// Where the scale of z ends.
pub const LARGEST_Z: f64 = 5.0;
/// The ends and the middle of the diverging scale: safe for those who do not tell red from green.
const LOW: [f64; 3] = [33.0, 102.0, 172.0];
const MIDDLE: [f64; 3] = [247.0, 247.0, 247.0];
const HIGH: [f64; 3] = [178.0, 24.0, 43.0];
/// Where nothing is compared.
const NOTHING: [u8; 3] = [128, 128, 128];
/// The mean lit pixel is shown at 1 - 1/e.
const STEEPNESS: f64 = 1.0;

/// The four pictures of a comparison.
///
/// # Errors
/// What the writer of pictures says.
pub fn figures(c: &Comparison) -> Result<String, String> {
    let lit: Vec<f64> = c.truth.iter().copied().filter(|v| *v > 0.0).collect();
    let mean = lit.iter().sum::<f64>() / lit.len().max(1) as f64;
    let exposure = if mean > 0.0 { STEEPNESS / mean } else { 1.0 };
    let size = [c.width, c.height];
    let truth = grey(&c.truth, size, exposure)?;
    let observed = grey(&c.observed, size, exposure)?;
    let place = format!("{}, {}, {}", c.scene, c.integrator, c.content);
    let mut out = format!(
        "<h3>{}</h3>\n<div class=\"pictures\">\n",
        escaped(&c.content)
    );
    out += &swapped([&truth, &observed], ["Truth", "Observed"], &place, size);
    out += &swapped([&observed, &truth], ["Observed", "Truth"], &place, size);
    if let Some(cells) = &c.cells {
        let grid = [cells.grid.columns as u32, cells.grid.rows as u32];
        if cells.z.iter().any(Option::is_some) {
            let picture = diverging(&cells.z, grid, LARGEST_Z)?;
            let caption = format!("z: standard errors from the truth, {}", cells.grid.words());
            out += &map(&picture, &caption, ["−5", "+5"], &place, size);
        }
        let picture = diverging(&cells.difference, grid, LARGEST_DIFFERENCE)?;
        let caption = format!(
            "Observed − truth, in parts of the mean lit pixel, {}",
            cells.grid.words()
        );
        out += &map(&picture, &caption, ["−50 %", "+50 %"], &place, size);
    }
    let _ = writeln!(
        out,
        "</div>\n<p class=\"small muted\">{} Grey scale 1 − exp(−L / {mean:.3e}), L in W/(m² sr), sRGB. Blue: too dark, red: too bright, \
         grey: not compared; beyond the ends of the scale the colour stays.</p>",
        escaped(&c.about.join(" "))
    );
    Ok(out)
}

/// A picture that shows the other one while it is pointed at, or has the focus.
fn swapped(
    pictures: [&str; 2],
    names: [&str; 2],
    place: &str,
    [width, height]: [u32; 2],
) -> String {
    let [first, other] = names;
    let place = escaped(place);
    format!(
        "<figure class=\"swap\" tabindex=\"0\"><span class=\"frame\">\
         <img src=\"{}\" width=\"{width}\" height=\"{height}\" alt=\"{first}: {place}\">\
         <img class=\"other\" src=\"{}\" width=\"{width}\" height=\"{height}\" alt=\"\"></span>\
         <figcaption><strong class=\"off\">{first}</strong><strong class=\"on\">{other}</strong> \
         <span class=\"muted off\">(point, tap or focus: {})</span></figcaption></figure>\n",
        pictures[0],
        pictures[1],
        other.to_lowercase()
    )
}

fn map(
    picture: &str,
    caption: &str,
    ends: [&str; 2],
    place: &str,
    [width, height]: [u32; 2],
) -> String {
    format!(
        "<figure><span class=\"frame\"><img src=\"{picture}\" width=\"{width}\" height=\"{height}\" alt=\"{caption}: {}\"></span>\
         <div class=\"scale\" aria-hidden=\"true\">{}<span class=\"ramp\"></span>{}</div>\
         <figcaption>{caption}</figcaption></figure>\n",
        escaped(place),
        ends[0],
        ends[1]
    )
}

fn grey(values: &[f64], size: [u32; 2], exposure: f64) -> Result<String, String> {
    let shown = |v: &f64| {
        let linear = -libm::expm1(-exposure * v.max(0.0));
        let encoded = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
        };
        (255.0 * encoded + 0.5) as u8
    };
    let bytes: Vec<u8> = values.iter().map(shown).collect();
    png(&bytes, size, ExtendedColorType::L8)
}

fn diverging(values: &[Option<f64>], size: [u32; 2], end: f64) -> Result<String, String> {
    let color = |v: &Option<f64>| -> [u8; 3] {
        let Some(v) = v else {
            return NOTHING;
        };
        let t = (v / end).clamp(-1.0, 1.0);
        let far = if t < 0.0 { LOW } else { HIGH };
        core::array::from_fn(|k| (MIDDLE[k] + t.abs() * (far[k] - MIDDLE[k]) + 0.5) as u8)
    };
    let bytes: Vec<u8> = values.iter().flat_map(color).collect();
    png(&bytes, size, ExtendedColorType::Rgb8)
}

/// A PNG as a `data:` address.
fn png(
    bytes: &[u8],
    [width, height]: [u32; 2],
    color: ExtendedColorType,
) -> Result<String, String> {
    let mut file = Cursor::new(Vec::new());
    PngEncoder::new(&mut file)
        .write_image(bytes, width, height, color)
        .map_err(|e| e.to_string())?;
    Ok(format!(
        "data:image/png;base64,{}",
        base64(&file.into_inner())
    ))
}

/// Base 64 [RFC 4648, section 4].
fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |k: usize| u32::from(group.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            if k <= group.len() {
                let digit = bits >> (18 - 6 * k) & 63;
                out.push(char::from(ALPHABET[digit as usize]));
            } else {
                out.push('=');
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn test_vectors_of_rfc_4648() {
        let cases = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (text, expected) in cases {
            assert_eq!(base64(text.as_bytes()), expected);
        }
    }
}
