//! What other programs write: halves, tiles, parts, crops, colour, names, variances.

use std::time::Instant;

use exr::prelude::*;

use super::files::exr;
use super::support::{Image as Pixels, NOISE, file, gate, json, mirror_wall, noisy, shown, state};

const SIDE: usize = 128;

fn single(image: &[f64]) -> FlatSamples {
    FlatSamples::F32(image.iter().map(|&v| v as f32).collect())
}

fn write(name: &str, bytes: &[u8]) -> String {
    let path = file(name);
    std::fs::write(&path, bytes).unwrap();
    shown(&path)
}

#[test]
fn halves_in_tiles_under_names_of_cycles() {
    let all = mirror_wall().all();
    let files: Vec<String> = (0..8)
        .map(|k| {
            let half = FlatSamples::F16(
                noisy(&all, 50 + k)
                    .iter()
                    .map(|&v| f16::from_f64(v))
                    .collect(),
            );
            let channels = ["R", "G", "B", "A"].map(|c| format!("ViewLayer.Combined.{c}"));
            let list: Vec<_> = channels
                .iter()
                .map(|c| (c.as_str(), half.clone()))
                .collect();
            let encoding = Encoding {
                compression: Compression::PIZ,
                blocks: Blocks::Tiles(Vec2(32, 32)),
                line_order: LineOrder::Increasing,
            };
            write(
                &format!("cycles-{k}.exr"),
                &exr(&list, encoding, (SIDE, SIDE)),
            )
        })
        .collect();
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.03"]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (0, "equivalent"),
        "{answer:#}"
    );
}

#[test]
fn light_path_expressions_of_two_parts() {
    let scene = mirror_wall();
    let layer = |name: &str, class: &str, seed: u32| {
        let values = single(&noisy(&scene.sum(&[class]), seed));
        let channels = AnyChannels::sort(
            ["R", "G", "B"]
                .map(|c| AnyChannel::new(c, values.clone()))
                .into_iter()
                .collect(),
        );
        let attributes = LayerAttributes::named(name);
        Layer::new((SIDE, SIDE), attributes, Encoding::default(), channels)
    };
    let files: Vec<String> = (0..8)
        .map(|k| {
            let layers = vec![
                layer("lpe:C<RD>L", "LDE", 100 + k),
                layer("lpe:CDSL", "LSDE", 200 + k),
                layer("lpe:C<.S>DL", "LDSE", 300 + k),
                layer("lpe:CSDSL", "LSDSE", 400 + k),
            ];
            let attributes = ImageAttributes::new(IntegerBounds::from_dimensions((SIDE, SIDE)));
            let image = Image::from_layers(attributes, layers);
            let mut bytes = Vec::new();
            image
                .write()
                .non_parallel()
                .to_buffered(std::io::Cursor::new(&mut bytes))
                .unwrap();
            write(&format!("parts-{k}.exr"), &bytes)
        })
        .collect();
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.03"]);
    assert_eq!(code, 0, "{answer:#}");
    for class in ["LDE", "LSDE", "LDSE", "LSDSE", "all"] {
        assert_eq!(state(&answer, class), "equivalent", "{answer:#}");
    }
}

/// A crop of the frame: the data window is smaller than the display window.
#[test]
fn a_crop_is_judged_as_far_as_it_goes() {
    let all = mirror_wall().all();
    let (x, y, w, h) = (16_usize, 40_usize, 100_usize, 70_usize);
    let files: Vec<String> = (0..8)
        .map(|k| {
            let whole = noisy(&all, 500 + k);
            let part: Pixels = (0..w * h)
                .map(|i| whole[(y + i / w) * SIDE + x + i % w])
                .collect();
            let channels = AnyChannels::sort(
                ["R", "G", "B"]
                    .map(|c| AnyChannel::new(c, single(&part)))
                    .into_iter()
                    .collect(),
            );
            let attributes = LayerAttributes::default().with_position(Vec2(x as i32, y as i32));
            let layer = Layer::new((w, h), attributes, Encoding::default(), channels);
            let frame = ImageAttributes::new(IntegerBounds::from_dimensions((SIDE, SIDE)));
            let image = Image::new(frame, layer);
            let mut bytes = Vec::new();
            image
                .write()
                .non_parallel()
                .to_buffered(std::io::Cursor::new(&mut bytes))
                .unwrap();
            write(&format!("crop-{k}.exr"), &bytes)
        })
        .collect();
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.03"]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (0, "equivalent"),
        "{answer:#}"
    );
    assert!(
        answer["notes"].to_string().contains("7000 of 16384"),
        "{answer:#}"
    );
}

#[test]
fn colour_is_told() {
    let all = mirror_wall().all();
    let files: Vec<String> = (0..8)
        .map(|k| {
            let grey = noisy(&all, 600 + k);
            let times = |f: f64| single(&grey.iter().map(|v| f * v).collect::<Pixels>());
            let channels = [("R", times(1.03)), ("G", times(1.0)), ("B", times(0.97))];
            write(
                &format!("tint-{k}.exr"),
                &exr(&channels, Encoding::default(), (SIDE, SIDE)),
            )
        })
        .collect();
    let (code, text, _) = gate("mirror-wall", &files, &["--margin", "0.03"]);
    assert_eq!(code, 0, "{text}");
    assert!(
        text.contains("not grey") && text.contains("R +3.00 %"),
        "{text}"
    );
}

/// With the variance of each pixel one image is enough.
#[test]
fn a_variance_layer_is_used() {
    let all = mirror_wall().all();
    let variance: Pixels = all.iter().map(|v| v * v * NOISE * NOISE).collect();
    let write_with = |name: &str, image: &[f64], scale: f64, layer: &str| {
        let spread: Pixels = variance.iter().map(|v| v * scale).collect();
        let channels = [("Y", single(image)), (layer, single(&spread))];
        write(name, &exr(&channels, Encoding::default(), (SIDE, SIDE)))
    };
    let right = write_with("variance.exr", &noisy(&all, 700), 1.0, "variance.Y");
    let (code, answer) = json("mirror-wall", &[right], &["--margin", "0.03"]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (0, "equivalent"),
        "{answer:#}"
    );
    let bright: Pixels = noisy(&all, 701).iter().map(|v| 1.05 * v).collect();
    let wrong = write_with("variance-bright.exr", &bright, 1.0, "variance.Y");
    let (code, answer) = json("mirror-wall", &[wrong], &["--margin", "0.03"]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (1, "different"),
        "{answer:#}"
    );
    // Of one sample, of 64: used once the number is said.
    let of_sample = write_with("variance-sample.exr", &noisy(&all, 702), 64.0, "Variance.Y");
    let (code, answer) = json(
        "mirror-wall",
        std::slice::from_ref(&of_sample),
        &["--margin", "0.03"],
    );
    assert_eq!(code, 3, "{answer:#}");
    assert!(answer["notes"].to_string().contains("--spp"), "{answer:#}");
    let (code, _) = json(
        "mirror-wall",
        &[of_sample],
        &["--margin", "0.03", "--spp", "64"],
    );
    assert_eq!(code, 0);
}

#[test]
fn pfm_is_read() {
    let all = mirror_wall().all();
    let files: Vec<String> = (0..8)
        .map(|k| {
            let image = noisy(&all, 800 + k);
            let mut bytes = format!("Pf\n{SIDE} {SIDE}\n-1.0\n").into_bytes();
            for row in (0..SIDE).rev() {
                for v in &image[row * SIDE..(row + 1) * SIDE] {
                    bytes.extend((*v as f32).to_le_bytes());
                }
            }
            write(&format!("pfm-{k}.pfm"), &bytes)
        })
        .collect();
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.03"]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (0, "equivalent"),
        "{answer:#}"
    );
}

/// Sixteen images of 128 by 128 pixels with five layers: under two seconds in release. Tests are built for less speed, and
/// share their processors.
#[test]
fn sixteen_images_are_judged_at_once() {
    let scene = mirror_wall();
    let files = scene.layers("speed", 16, |_, v| Some(v.to_vec()));
    let started = Instant::now();
    let (code, out, err) = gate("mirror-wall", &files, &["--margin", "0.02"]);
    let seconds = started.elapsed().as_secs_f64();
    eprintln!("16 images: {seconds:.2} s");
    assert_eq!(code, 0, "{out} {err}");
    assert!(cfg!(debug_assertions) || seconds < 2.0, "{seconds}");
}
