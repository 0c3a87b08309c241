//! PNG output with one fixed display transform, so that two pictures can be compared by eye.

use std::io::Cursor;
use std::path::Path;

use image::{GrayImage, ImageFormat};

use crate::error::Error;
use crate::output::write_whole;

/// The transform, in words: for `--help` and for the file itself.
pub const DISPLAY_TRANSFORM: &str =
    "display = 1 - exp(-2.5 L), L in W/(m^2 sr), then the sRGB curve, 8 bits, same for every scene";

/// Exposure [m² sr/W].
const EXPOSURE: f64 = 2.5;

/// The 8-bit display value of a radiance.
pub fn display(radiance: f64) -> u8 {
    let linear = -libm::expm1(-EXPOSURE * radiance.max(0.0));
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    };
    (255.0 * encoded + 0.5) as u8
}

/// Writes radiances (row 0 at the top) as a grey PNG; the transform is stated in a text chunk.
///
/// # Errors
/// [`Error::Io`] if the file cannot be written.
pub fn write_png(path: &Path, width: u32, height: u32, radiance: &[f64]) -> Result<(), Error> {
    let shown = path.display().to_string();
    let failed = |e: std::io::Error| Error::read(&shown, e);
    let pixels = radiance.iter().map(|&l| display(l)).collect();
    let picture = GrayImage::from_raw(width, height, pixels)
        .ok_or_else(|| failed(std::io::Error::other("size does not match the pixels")))?;
    let mut bytes = Vec::new();
    picture
        .write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png)
        .map_err(|e| failed(std::io::Error::other(e)))?;
    // The signature and the header chunk take 33 bytes; text may follow.
    const AFTER_HEADER: usize = 33;
    let chunk = text_chunk("Comment", DISPLAY_TRANSFORM);
    bytes.splice(AFTER_HEADER..AFTER_HEADER, chunk);
    write_whole(path, |temporary| {
        std::fs::write(temporary, &bytes).map_err(failed)
    })
}

/// A tEXt chunk [PNG specification, 11.3.3.2].
fn text_chunk(keyword: &str, text: &str) -> Vec<u8> {
    let body = [
        b"tEXt".as_slice(),
        keyword.as_bytes(),
        &[0],
        text.as_bytes(),
    ]
    .concat();
    let length = (body.len() - 4) as u32;
    let check = crc32(&body);
    [&length.to_be_bytes(), body.as_slice(), &check.to_be_bytes()].concat()
}

/// CRC-32 as PNG wants it [PNG specification, annex D].
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 };
        }
    }
    !crc
}
