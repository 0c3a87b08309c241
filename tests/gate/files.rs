//! Every bad file: a clear message, exit code 2, no panic.

use std::io::Cursor;
use std::sync::OnceLock;

use exr::prelude::*;
use nephroid::foreign::picture::of_bytes;
use nephroid_analytic::class::PathClass;
use proptest::prelude::*;

use super::support::{file, gate, mirror_wall, shown};

const SIDE: usize = 128;

/// A file of these channels.
pub fn exr(channels: &[(&str, FlatSamples)], encoding: Encoding, size: (usize, usize)) -> Vec<u8> {
    let list = channels
        .iter()
        .map(|(name, samples)| AnyChannel::new(*name, samples.clone()));
    let layer = Layer::new(
        size,
        LayerAttributes::default(),
        encoding,
        AnyChannels::sort(list.collect()),
    );
    let mut bytes = Vec::new();
    let image = Image::from_layer(layer);
    image
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes))
        .unwrap();
    bytes
}

pub fn flat(value: f32) -> FlatSamples {
    FlatSamples::F32(vec![value; SIDE * SIDE])
}

/// Writes a file and judges it.
fn judged(name: &str, bytes: &[u8]) -> (i32, String) {
    let path = file(name);
    std::fs::write(&path, bytes).unwrap();
    let (code, _, err) = gate("mirror-wall", &[shown(&path)], &[]);
    (code, err)
}

fn is_refused(name: &str, bytes: &[u8], parts: &[&str]) {
    let (code, err) = judged(name, bytes);
    assert_eq!(code, 2, "{name}: {err}");
    for part in parts {
        assert!(err.contains(part), "{name}: {part}: {err}");
    }
    assert!(!err.contains("panicked"), "{name}: {err}");
}

#[test]
fn values_that_are_no_numbers_are_counted_and_located() {
    let mut values = vec![0.5_f32; SIDE * SIDE];
    values[3 * SIDE + 7] = f32::NAN;
    values[5 * SIDE] = f32::INFINITY;
    let bytes = exr(
        &[("LSDE.Y", FlatSamples::F32(values))],
        Encoding::default(),
        (SIDE, SIDE),
    );
    is_refused(
        "nan.exr",
        &bytes,
        &[
            "LSDE.Y",
            "1 values are not a number, 1 are infinite",
            "column 7, row 3",
        ],
    );
    let mut values = vec![f16::from_f32(0.5); SIDE * SIDE];
    values[2] = f16::from_f32(70000.0);
    let bytes = exr(
        &[("Y", FlatSamples::F16(values))],
        Encoding::default(),
        (SIDE, SIDE),
    );
    is_refused(
        "overflow.exr",
        &bytes,
        &["channel Y", "65504", "column 2, row 0"],
    );
}

#[test]
fn what_is_not_this_image_is_refused() {
    let small = FlatSamples::F32(vec![0.5; 64 * 64]);
    let bytes = exr(&[("Y", small)], Encoding::default(), (64, 64));
    is_refused("small.exr", &bytes, &["64 x 64", "128 x 128"]);
    is_refused("empty.exr", &[], &["an empty file"]);
    is_refused("text.exr", b"hello", &["neither OpenEXR nor PFM"]);
    is_refused("short.pfm", b"PF\n128 128\n-1\nabc", &["truncated"]);
    let whole = exr(&[("Y", flat(0.5))], Encoding::default(), (SIDE, SIDE));
    is_refused("truncated.exr", &whole[..whole.len() - 7], &["truncated"]);
    is_refused("half.exr", &whole[..whole.len() / 2], &["truncated"]);
    let depth = exr(&[("Depth.Z", flat(0.5))], Encoding::default(), (SIDE, SIDE));
    is_refused("depth.exr", &depth, &["no channel of light among Depth.Z"]);
    let (code, _, err) = gate("mirror-wall", &["no-such-file.exr".to_owned()], &[]);
    assert_eq!(code, 2, "{err}");
    // Deep: a flag of the version field.
    let mut deep = whole.clone();
    deep[5] |= 8;
    is_refused("deep.exr", &deep, &["deep data"]);
    // DWAA is number 8 of the compression attribute.
    let at = whole
        .windows(12)
        .position(|w| w == b"compression\0")
        .unwrap();
    let mut dwa = whole.clone();
    let value = at + 12 + b"compression\0".len() + 4;
    dwa[value] = 8;
    is_refused("dwa.exr", &dwa, &["DWA"]);
    // The sampling of a channel is in the last eight bytes of its entry.
    let at = whole.windows(9).position(|w| w == b"channels\0").unwrap();
    let mut subsampled = whole;
    let entry = at + 9 + b"chlist\0".len() + 4;
    subsampled[entry + 2 + 8] = 2;
    is_refused("subsampled.exr", &subsampled, &["channel Y", "subsampled"]);
}

#[test]
fn files_that_are_no_replicates_are_refused() {
    let scene = mirror_wall();
    let all = scene.all();
    let mut files = scene.beauty("replicates", &all, 3);
    files.push(files[1].clone());
    let (code, _, err) = gate("mirror-wall", &files, &[]);
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("the same image as"), "{err}");
    let other = file("other-layers.exr");
    std::fs::write(
        &other,
        exr(&[("LDE.Y", flat(0.5))], Encoding::default(), (SIDE, SIDE)),
    )
    .unwrap();
    let (code, _, err) = gate("mirror-wall", &[files[0].clone(), shown(&other)], &[]);
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("its layers are LDE"), "{err}");
}

#[test]
fn bad_options_are_refused() {
    let files = mirror_wall().beauty("options", &mirror_wall().all(), 1);
    for options in [
        &["--cannot", "LTTDE"][..],
        &["--offset", "0.3,0"],
        &["--offset", "9,0"],
        &["--gain", "0"],
        &["--margin", "0.9"],
        &["--technique", "camera"],
        &["--bandwidth", "0.1"],
        &[
            "--technique",
            "merge",
            "--bandwidth",
            "0.1",
            "--kernel",
            "vmf",
        ],
        &[
            "--technique",
            "camera",
            "--bandwidth",
            "0.1",
            "--offset",
            "1,0",
        ],
        &["--shell"],
        &["--command", "true {seed} {out}"],
        &["--mask", "no-such.png"],
        &["--name", "a b"],
    ] {
        let (code, _, err) = gate("mirror-wall", &files, options);
        assert_eq!(code, 2, "{options:?}: {err}");
    }
    let (code, _, _) = gate("mirror-wall", &[], &[]);
    assert_eq!(code, 2);
    let (code, _, _) = gate("no-such-scene", &files, &[]);
    assert_eq!(code, 2);
}

/// Small files of each kind, for damage.
fn samples() -> &'static Vec<Vec<u8>> {
    static SAMPLES: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    SAMPLES.get_or_init(|| {
        let values: Vec<f32> = (0..64).map(|i| 0.1 * i as f32).collect();
        let single = FlatSamples::F32(values.clone());
        let half = FlatSamples::F16(values.iter().map(|v| f16::from_f32(*v)).collect());
        let channels = [
            ("R", single.clone()),
            ("G", single.clone()),
            ("B", single),
            ("LSDE.Y", half),
        ];
        let mut files = Vec::new();
        for compression in [
            Compression::Uncompressed,
            Compression::RLE,
            Compression::ZIP1,
            Compression::ZIP16,
            Compression::PIZ,
            Compression::PXR24,
        ] {
            for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(4, 4))] {
                let encoding = Encoding {
                    compression,
                    blocks,
                    line_order: LineOrder::Increasing,
                };
                files.push(exr(&channels, encoding, (8, 8)));
            }
        }
        let mut pfm = b"Pf\n8 8\n-1\n".to_vec();
        pfm.extend(values.iter().flat_map(|v| v.to_le_bytes()));
        files.push(pfm);
        files
    })
}

fn read(bytes: &[u8]) -> bool {
    of_bytes("damaged", bytes, (8, 8), &[PathClass::LDE, PathClass::LSDE]).is_ok()
}

#[test]
fn whole_files_of_every_encoding_are_read() {
    assert!(samples().iter().all(|s| read(s)));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// A panic inside would be caught and printed: the reader must answer, one way or the other.
    #[test]
    fn truncated_files_are_errors(k in 0_usize..13, part in 0.0_f64..1.0) {
        let whole = &samples()[k];
        let length = (part * whole.len() as f64) as usize;
        prop_assert!(!read(&whole[..length]));
    }

    #[test]
    fn damaged_files_do_no_harm(k in 0_usize..13, flips in prop::collection::vec((any::<prop::sample::Index>(), 0_u8..8), 1..6)) {
        let mut damaged = samples()[k].clone();
        for (at, bit) in flips {
            let at = at.index(damaged.len());
            damaged[at] ^= 1 << bit;
        }
        read(&damaged);
    }
}
