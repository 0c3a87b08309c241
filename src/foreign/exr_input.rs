//! OpenEXR input: every channel of every part, placed into the frame.
//!
//! The header is judged before any pixel is read: deep data, lossy compression that changes means (DWA, and B44 of 16-bit
//! channels), subsampled channels, a frame of another size and a data window out of proportion are refused there. The
//! library's own checks come after that; should it panic on a file, that is an error about the file as well.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{
    AttributeValue, Compression, FlatSamples, ReadChannels as _, ReadLayers as _, SampleType, read,
};

use super::channels::{Channel, Raw, content, wrong_size};
use crate::error::Error;

/// The first four bytes.
pub const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// The bit of the fifth to eighth that says "deep".
const DEEP: u8 = 1 << 3;
/// Pixels of a data window at most, in frames: what an overscan may need.
const LARGEST_WINDOW: u64 = 16;
/// Channels of all parts at most.
const MOST_CHANNELS: usize = 1024;
/// Bytes of all pixels at most.
const MOST_BYTES: u64 = 1 << 32;
/// What to write instead, for messages.
const ALLOWED: &str = "flat channels of 16 or 32-bit float, not subsampled, with no, RLE, ZIP, PIZ or PXR24 compression";

/// Reads a file whose display window has the expected size.
///
/// # Errors
/// [`Error::Content`], which names the file, the channel and what is allowed.
pub fn read_channels(file: &str, bytes: &[u8], expected: (u32, u32)) -> Result<Raw, Error> {
    // A shield: the library means to answer with errors.
    let result = catch_unwind(AssertUnwindSafe(|| read_guarded(file, bytes, expected)));
    result.unwrap_or_else(|_| {
        Err(content(
            file,
            "damaged: its blocks do not fit its header",
            ALLOWED,
        ))
    })
}

fn read_guarded(file: &str, bytes: &[u8], expected: (u32, u32)) -> Result<Raw, Error> {
    let failed = |e: exr::error::Error| failure(file, &e);
    if bytes.get(5).is_some_and(|flags| flags & DEEP != 0) {
        return Err(content(
            file,
            "deep data: a list of samples in each pixel",
            ALLOWED,
        ));
    }
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(failed)?;
    check(file, &meta.headers, expected)?;
    let samples_per_pixel = meta.headers.iter().find_map(samples_per_pixel);
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(failed)?;
    let frame = image.attributes.display_window;
    let has_parts = image.layer_data.len() > 1;
    let mut raw = Raw {
        samples_per_pixel,
        ..Raw::default()
    };
    for part in &image.layer_data {
        let offset = [
            i64::from(part.attributes.layer_position.0) - i64::from(frame.position.0),
            i64::from(part.attributes.layer_position.1) - i64::from(frame.position.1),
        ];
        let placement = Placement {
            offset,
            size: [part.size.0 as i64, part.size.1 as i64],
            frame: [i64::from(expected.0), i64::from(expected.1)],
        };
        let covered = placement.covered();
        if !covered.contains(&true) {
            return Err(content(
                file,
                "the data window is beside the display window: no pixel of the frame is in the file",
                "a crop inside the display window",
            ));
        }
        if covered.contains(&false) {
            raw.covered = Some(match raw.covered.take() {
                Some(before) => before.iter().zip(&covered).map(|(a, b)| a & b).collect(),
                None => covered,
            });
        }
        let prefix = match &part.attributes.layer_name {
            Some(name) if has_parts => format!("{name}."),
            _ => String::new(),
        };
        for channel in &part.channel_data.list {
            let own = channel.name.to_string();
            let name = if own.starts_with(&prefix) {
                own
            } else {
                format!("{prefix}{own}")
            };
            let (is_half, values) = match &channel.sample_data {
                FlatSamples::F16(v) => (true, placement.place(v.len(), |i| v[i].to_f32())),
                FlatSamples::F32(v) => (false, placement.place(v.len(), |i| v[i])),
                FlatSamples::U32(_) => {
                    raw.skipped.push(name);
                    continue;
                }
            };
            raw.channels.push(Channel {
                name,
                is_half,
                values,
            });
        }
    }
    Ok(raw)
}

/// Where a part's pixels are in the frame.
struct Placement {
    offset: [i64; 2],
    size: [i64; 2],
    frame: [i64; 2],
}

impl Placement {
    /// The position in the part of a pixel of the frame.
    fn source(&self, pixel: usize) -> Option<usize> {
        let at = [
            pixel as i64 % self.frame[0] - self.offset[0],
            pixel as i64 / self.frame[0] - self.offset[1],
        ];
        let is_inside = (0..2).all(|k| at[k] >= 0 && at[k] < self.size[k]);
        is_inside.then(|| (at[1] * self.size[0] + at[0]) as usize)
    }

    fn pixels(&self) -> usize {
        (self.frame[0] * self.frame[1]) as usize
    }

    fn covered(&self) -> Vec<bool> {
        (0..self.pixels())
            .map(|i| self.source(i).is_some())
            .collect()
    }

    fn place(&self, length: usize, value: impl Fn(usize) -> f32) -> Vec<f32> {
        let pixel = |i: usize| match self.source(i) {
            Some(j) if j < length => value(j),
            _ => 0.0,
        };
        (0..self.pixels()).map(pixel).collect()
    }
}

/// Refuses by the headers what is not supported, or too large to be this image.
fn check(file: &str, headers: &[Header], expected: (u32, u32)) -> Result<(), Error> {
    let bad = |message: String| content(file, message, ALLOWED);
    let frame_pixels = u64::from(expected.0) * u64::from(expected.1);
    let (mut channels, mut total) = (0, 0_u64);
    for header in headers {
        if header.deep {
            return Err(bad("deep data: a list of samples in each pixel".to_owned()));
        }
        let frame = header.shared_attributes.display_window.size;
        let frame = (frame.0 as u64, frame.1 as u64);
        if frame != (u64::from(expected.0), u64::from(expected.1)) {
            return Err(wrong_size(file, frame, expected));
        }
        let size = [header.layer_size.0 as u64, header.layer_size.1 as u64];
        let pixels = size[0].checked_mul(size[1]);
        let Some(pixels) = pixels.filter(|p| *p > 0 && *p <= LARGEST_WINDOW * frame_pixels) else {
            return Err(content(
                file,
                format!("the data window has {} x {} pixels", size[0], size[1]),
                format!(
                    "at most {LARGEST_WINDOW} times the {} x {} of the frame",
                    expected.0, expected.1
                ),
            ));
        };
        channels += header.channels.list.len();
        total = total.saturating_add(pixels.saturating_mul(header.channels.bytes_per_pixel as u64));
        let halves = || {
            header
                .channels
                .list
                .iter()
                .filter(|c| c.sample_type == SampleType::F16)
        };
        match header.compression {
            Compression::DWAA(_) | Compression::DWAB(_) => {
                return Err(bad("DWA compression, which changes the values".to_owned()));
            }
            Compression::B44 | Compression::B44A => {
                if let Some(channel) = halves().next() {
                    return Err(bad(format!(
                        "channel {}: B44 compression, which changes 16-bit values",
                        channel.name
                    )));
                }
            }
            _ => {}
        }
        for channel in &header.channels.list {
            if (channel.sampling.0, channel.sampling.1) != (1, 1) {
                return Err(bad(format!(
                    "channel {}: subsampled, one value for {} x {} pixels",
                    channel.name, channel.sampling.0, channel.sampling.1
                )));
            }
        }
    }
    if channels > MOST_CHANNELS || total > MOST_BYTES {
        return Err(content(
            file,
            format!("{channels} channels with {total} bytes"),
            format!("at most {MOST_CHANNELS} channels with {MOST_BYTES} bytes"),
        ));
    }
    Ok(())
}

/// What pbrt-v4 writes into its files.
fn samples_per_pixel(header: &Header) -> Option<f64> {
    let others = [
        &header.own_attributes.other,
        &header.shared_attributes.other,
    ];
    let named = |(name, value): (&exr::prelude::Text, &AttributeValue)| {
        let value = match value {
            AttributeValue::I32(v) => f64::from(*v),
            AttributeValue::F32(v) => f64::from(*v),
            _ => return None,
        };
        (*name == *"samplesPerPixel" && value >= 1.0).then_some(value)
    };
    others
        .into_iter()
        .find_map(|list| list.iter().find_map(named))
}

/// The library's errors in our words.
fn failure(file: &str, error: &exr::error::Error) -> Error {
    use exr::error::Error as E;
    let message = match error {
        E::NotSupported(what) => format!("not supported: {what}"),
        E::Invalid(what) => format!("damaged or truncated: {what}"),
        E::Io(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            "truncated: it ends too early".to_owned()
        }
        E::Io(e) => format!("damaged or truncated: {e}"),
        E::Aborted => "reading was aborted".to_owned(),
    };
    content(file, message, ALLOWED)
}
