//! OpenEXR output: one part, one 32-bit float channel per layer, the same bytes every time.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Compression, Encoding, FlatSamples, Image, Layer,
    LayerAttributes, LineOrder, Text, WritableImage,
};
use nephroid_analytic::scene::Entry;

use crate::error::Error;
use crate::output::write_whole;

/// The attributes that every image of this program carries: version, scene and parameters (JSON of the entry).
pub fn metadata(entry: &Entry) -> Vec<(String, String)> {
    // EXR strings are bytes: JSON has an escape for what is not ASCII.
    let mut parameters = String::new();
    for c in serde_json::to_string(entry).unwrap_or_default().chars() {
        if c.is_ascii() {
            parameters.push(c);
        } else {
            let mut units = [0; 2];
            for unit in c.encode_utf16(&mut units) {
                parameters.push_str(&format!("\\u{unit:04x}"));
            }
        }
    }
    vec![
        (
            "nephroid:version".to_owned(),
            env!("CARGO_PKG_VERSION").to_owned(),
        ),
        ("nephroid:scene".to_owned(), entry.name.clone()),
        ("nephroid:parameters".to_owned(), parameters),
    ]
}

/// Writes an image: `layers` are channel names (`LSDE.Y`) with `width * height` values, row 0 at the top; `metadata` are
/// text attributes. Scan lines, ZIP compression (lossless), values rounded to f32.
///
/// # Errors
/// [`Error::Io`] if the file cannot be written; nothing is left behind then.
pub fn write_exr(
    path: &Path,
    width: u32,
    height: u32,
    layers: &[(String, &[f64])],
    metadata: &[(String, String)],
) -> Result<(), Error> {
    let shown = path.display().to_string();
    let failed =
        |e: exr::error::Error| Error::read(&shown, std::io::Error::other(format!("OpenEXR: {e}")));
    let channels = layers.iter().map(|(name, values)| {
        // The format's f32 is what readers see: round once, to nearest.
        let values = values.iter().map(|&v| v as f32).collect();
        AnyChannel::new(name.as_str(), FlatSamples::F32(values))
    });
    let mut attributes = LayerAttributes::default();
    for (key, value) in metadata {
        let value = AttributeValue::Text(text(value));
        attributes.other.insert(text(key), value);
    }
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: exr::image::Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new(
        (width as usize, height as usize),
        attributes,
        encoding,
        AnyChannels::sort(channels.collect()),
    );
    let mut bytes = Vec::new();
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes))
        .map_err(failed)?;
    sort_attributes(&mut bytes);
    write_whole(path, |temporary| {
        std::fs::write(temporary, &bytes).map_err(|source| Error::read(&shown, source))
    })
}

/// The half of f32's error that a reader of the file sees: how far the stored value is from the given one.
pub fn rounding_error(value: f64) -> f64 {
    (f64::from(value as f32) - value).abs()
}

/// An error bound as it must be stored: the next f32 above, never below.
pub fn rounded_up(bound: f64) -> f64 {
    let stored = bound as f32;
    if f64::from(stored) < bound {
        f64::from(stored.next_up())
    } else {
        f64::from(stored)
    }
}

fn text(value: &str) -> Text {
    // `Text` refuses what is not one byte per character.
    let plain: String = value
        .chars()
        .map(|c| if c.is_ascii() { c } else { '?' })
        .collect();
    Text::from(plain.as_str())
}

/// Sorts the header's attributes by name: the library keeps them in a hash map, whose order changes from run to run. The
/// header's length stays, and with it every offset behind it.
fn sort_attributes(bytes: &mut [u8]) {
    const START: usize = 8;
    let until_zero = |at: usize| {
        let end = bytes.get(at..)?.iter().position(|&b| b == 0)?;
        Some(at + end + 1)
    };
    let mut attributes = Vec::new();
    let mut at = START;
    while bytes.get(at).is_some_and(|&b| b != 0) {
        // name, 0, type, 0, length (4 bytes, little endian), value.
        let Some(size_at) = until_zero(at).and_then(until_zero) else {
            return;
        };
        let Some(size) = bytes.get(size_at..size_at + 4) else {
            return;
        };
        let size = u32::from_le_bytes([size[0], size[1], size[2], size[3]]) as usize;
        let end = size_at + 4 + size;
        let Some(attribute) = bytes.get(at..end) else {
            return;
        };
        attributes.push(attribute.to_vec());
        at = end;
    }
    attributes.sort();
    bytes[START..at].copy_from_slice(&attributes.concat());
}
