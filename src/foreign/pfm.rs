//! PFM: `PF` (colour) or `Pf` (grey), width, height, scale, then 32-bit floats from the bottom row up; a negative scale means
//! little endian.

use super::channels::{Channel, Raw, content, wrong_size};
use crate::error::Error;

/// What is allowed, for messages.
const ALLOWED: &str =
    "PF or Pf, width, height, scale 1 or -1, then width x height 32-bit floats per channel";
/// The header is shorter than this.
const LONGEST_HEADER: usize = 256;

/// Reads a file of the expected size.
///
/// # Errors
/// [`Error::Content`] for anything else than such a file.
pub fn read(file: &str, bytes: &[u8], expected: (u32, u32)) -> Result<Raw, Error> {
    let bad = |message: String| content(file, message, ALLOWED);
    let mut at = 0;
    let mut word = |what: &str| -> Result<&str, Error> {
        let head = &bytes[..bytes.len().min(LONGEST_HEADER)];
        let is_space = |b: &u8| b.is_ascii_whitespace();
        let skipped = head[at..].iter().take_while(|b| is_space(b)).count();
        let start = at + skipped;
        let length = head[start..].iter().take_while(|b| !is_space(b)).count();
        let end = start + length;
        // Exactly one white space ends a word, the last one the header.
        if length == 0 || end >= head.len() {
            return Err(bad(format!("the PFM header ends before its {what}")));
        }
        at = end + 1;
        core::str::from_utf8(&head[start..end])
            .map_err(|_| bad(format!("the PFM header's {what} is no text")))
    };
    let names: &[&str] = match word("type")? {
        "PF" => &["R", "G", "B"],
        "Pf" => &["Y"],
        other => return Err(bad(format!("the type is {other:?}"))),
    };
    let mut side = |what: &str| -> Result<u64, Error> {
        let text = word(what)?;
        text.parse()
            .map_err(|_| bad(format!("the {what} is {text:?}")))
    };
    let size = (side("width")?, side("height")?);
    if size != (u64::from(expected.0), u64::from(expected.1)) {
        return Err(wrong_size(file, size, expected));
    }
    let text = word("scale")?;
    let scale: f64 = text
        .parse()
        .map_err(|_| bad(format!("the scale is {text:?}")))?;
    if scale.abs() != 1.0 {
        // Programs disagree on whether it multiplies the values.
        return Err(bad(format!("the scale is {text}")));
    }
    let (width, height) = (expected.0 as usize, expected.1 as usize);
    let data = &bytes[at.min(bytes.len())..];
    let needed = width * height * names.len() * 4;
    if data.len() < needed {
        return Err(bad(format!(
            "truncated: {} bytes of pixels where {needed} should be",
            data.len()
        )));
    }
    let value = |i: usize| {
        let four: [u8; 4] = core::array::from_fn(|k| data[4 * i + k]);
        if scale < 0.0 {
            f32::from_le_bytes(four)
        } else {
            f32::from_be_bytes(four)
        }
    };
    let channel = |(k, name): (usize, &&str)| {
        let pixel = |i: usize| {
            let (row, column) = (height - 1 - i / width, i % width);
            value((row * width + column) * names.len() + k)
        };
        Channel {
            name: (*name).to_owned(),
            is_half: false,
            values: (0..width * height).map(pixel).collect(),
        }
    };
    Ok(Raw {
        channels: names.iter().enumerate().map(channel).collect(),
        ..Raw::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, values: &[f32], little: bool) -> Vec<u8> {
        let mut bytes = header.as_bytes().to_vec();
        for v in values {
            bytes.extend(if little {
                v.to_le_bytes()
            } else {
                v.to_be_bytes()
            });
        }
        bytes
    }

    #[test]
    fn rows_come_from_the_bottom_in_either_byte_order() {
        for (scale, little) in [("-1.0", true), ("1", false)] {
            let bytes = file(
                &format!("Pf\n2 3\n{scale}\n"),
                &[1., 2., 3., 4., 5., 6.],
                little,
            );
            let raw = read("a.pfm", &bytes, (2, 3)).unwrap();
            assert_eq!(raw.channels[0].values, [5., 6., 3., 4., 1., 2.]);
        }
        let bytes = file("PF 1 1 -1.0\n", &[1., 2., 3.], true);
        let raw = read("a.pfm", &bytes, (1, 1)).unwrap();
        let blue = &raw.channels[2];
        assert_eq!((blue.name.as_str(), blue.values[0]), ("B", 3.0));
    }

    #[test]
    fn what_is_no_such_file_is_refused() {
        for (header, values) in [
            ("Pf\n2 1\n-1\n", 1),
            ("Pf\n1 1\n-2\n", 1),
            ("Pf\n1 1\n0\n", 1),
            ("Pf\n1\n", 0),
            ("P5\n1 1\n-1\n", 1),
            ("Pf\n-1 1\n-1\n", 1),
            ("Pf\n99999999999999999999 1\n-1\n", 1),
            ("Pf\n1 1\n-1\n", 0),
            ("Pf", 0),
        ] {
            let bytes = file(header, &vec![1.0; values], true);
            assert!(read("a.pfm", &bytes, (1, 1)).is_err(), "{header}");
        }
    }
}
