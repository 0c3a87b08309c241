//! Scenes for other renderers: a directory with a scene file, the meshes that it needs, a description for the gate and a README.
//!
//! A kind of scene becomes a [`model`], in which surfaces are shapes that most renderers know, or patches; a format writes the
//! shapes that its renderer has and takes [`mesh`]es for the others, as fine as [`tessellation`] says. Everything is a function
//! of the scene and the format: the same bytes every time.

pub mod integrators;
pub mod kinds;
pub mod luxcore;
pub mod mesh;
pub mod mitsuba;
pub mod model;
pub mod pbrt;
mod readme;
mod surfaces;
pub mod tessellation;

use std::fs;
use std::path::Path;

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;
use serde_json::{Value, json};

use crate::error::Error;
use mesh::Mesh;
use model::{Geometry, Material, Model, Shape};
use tessellation::{Tessellated, tessellate};

/// A renderer's scene format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Mitsuba 3, XML.
    Mitsuba,
    /// pbrt-v4.
    Pbrt,
    /// LuxCore, properties.
    Luxcore,
}

impl Format {
    /// All of them.
    pub const ALL: [Format; 3] = [Format::Mitsuba, Format::Pbrt, Format::Luxcore];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Format::Mitsuba => "mitsuba",
            Format::Pbrt => "pbrt",
            Format::Luxcore => "luxcore",
        }
    }

    /// The command that makes one image, with `{seed}`, `{spp}`, `{integrator}`, `{out}` and the exported directory `{dir}`.
    pub const fn command(self) -> &'static str {
        match self {
            Format::Mitsuba => mitsuba::COMMAND,
            Format::Pbrt => pbrt::COMMAND,
            Format::Luxcore => luxcore::COMMAND,
        }
    }

    /// How far apart seeds must be for images that share no random numbers.
    pub fn seed_spacing(self, entry: &Entry) -> u64 {
        match self {
            Format::Mitsuba => mitsuba::seed_spacing(entry.camera.width, entry.camera.height),
            Format::Pbrt | Format::Luxcore => 1,
        }
    }

    fn is_native(self, geometry: &Geometry) -> bool {
        match self {
            Format::Mitsuba => mitsuba::is_native(geometry),
            Format::Pbrt => pbrt::is_native(geometry),
            Format::Luxcore => luxcore::is_native(geometry),
        }
    }
}

/// What a scene file needs to know beside the model.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The entry's title, fit for a comment.
    pub title: String,
    /// The longest path to trace, in edges from the light to the eye.
    pub edges: usize,
    /// The classes that the image is then the sum of.
    pub comparable: Vec<PathClass>,
    /// The classes that are left out, because other light has as many edges as they.
    pub left_out: Vec<PathClass>,
}

impl Plan {
    /// The path depth that makes the comparison fair: that of the closure, or of the longest class.
    pub fn new(entry: &Entry) -> Self {
        let classes = entry.kind.classes();
        let needed = classes.iter().map(PathClass::edges).max().unwrap_or(2);
        let edges = entry
            .kind
            .closure()
            .longest
            .map_or(needed, |longest| longest.min(needed));
        let (comparable, left_out) = classes.iter().partition(|c| c.edges() <= edges);
        // A comment of XML must not contain two hyphens.
        let one_line: String = entry
            .title
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        Plan {
            title: format!("{}: {}", entry.name, one_line).replace("--", "- -"),
            edges,
            comparable,
            left_out,
        }
    }
}

/// A shape that had to become a mesh, and what that does.
#[derive(Clone, Debug)]
pub struct Meshed {
    /// The shape's name.
    pub name: &'static str,
    /// The mesh; `None` where two triangles are exact.
    pub tessellated: Option<Tessellated>,
}

/// A directory's files and what they are.
#[derive(Clone, Debug)]
pub struct Export {
    /// Names, with `/` for directories, and contents.
    pub files: Vec<(String, Vec<u8>)>,
    /// The shapes that are meshes.
    pub meshed: Vec<Meshed>,
}

impl Export {
    /// A bound on a pixel's error by tessellation, relative to the brightest of it and its neighbours; 0 without meshes.
    pub fn pixel_error(&self) -> f64 {
        let curved = self.meshed.iter().filter_map(|m| m.tessellated.as_ref());
        curved.map(Tessellated::pixel_error).sum()
    }
}

/// The largest error by tessellation with which a scene is still exported.
const LARGEST_PIXEL_ERROR: f64 = 0.05;

/// Single precision, in which renderers compute, tells apart what is this much of the largest coordinate.
const SINGLE: f64 = 1e-6;

/// Exports an entry that has passed [`Entry::validate`].
///
/// # Errors
/// [`Error::Content`] for a scene that the format cannot express, with the reason.
pub fn export(entry: &Entry, format: Format) -> Result<Export, Error> {
    let model = kinds::model(entry);
    refuse(entry, format, &model)?;
    let plan = Plan::new(entry);
    let mut files = vec![];
    let mut meshed = vec![];
    for shape in &model.shapes {
        if format.is_native(&shape.geometry) {
            continue;
        }
        let (mesh, tessellated) = match (&shape.geometry, shape.geometry.patch()) {
            (Geometry::Rectangle { center, u, v }, _) => (Mesh::rectangle(*center, *u, *v), None),
            (_, Some(patch)) => {
                let tessellated = tessellate(&model, &patch, shape.material);
                (tessellated.mesh.clone(), Some(tessellated))
            }
            (_, None) => continue,
        };
        if format == Format::Pbrt && pbrt::needs_back(shape) {
            let back = mesh.backing(pbrt::back_distance(size(&mesh)));
            files.push((mesh_file(&format!("{}_back", shape.name)), back.ply()));
        }
        files.push((mesh_file(shape.name), mesh.ply()));
        let name = shape.name;
        meshed.push(Meshed { name, tessellated });
    }
    let mut text = |name: &str, text: String| files.push((name.to_owned(), text.into_bytes()));
    match format {
        Format::Mitsuba => text(mitsuba::FILE, mitsuba::scene(&model, &plan)),
        Format::Pbrt => {
            text(pbrt::FILE, pbrt::scene(&model, &plan));
            for (name, _) in integrators::of(format) {
                text(
                    &format!("integrator-{name}.pbrt"),
                    pbrt::integrator(name, &plan),
                );
            }
        }
        Format::Luxcore => {
            text(luxcore::FILE, luxcore::configuration(&model, &plan));
            text(luxcore::SCENE_FILE, luxcore::scene(&model, &plan));
            text(luxcore::RENDER.0, luxcore::RENDER.1.to_owned());
        }
    }
    let mut export = Export { files, meshed };
    let error = export.pixel_error();
    if !(error <= LARGEST_PIXEL_ERROR) {
        let message = format!(
            "{} has no shape for a curved surface of this scene, and a mesh of {} triangles would still change a pixel by {error:.1e}",
            format.name(),
            tessellation::MOST_TRIANGLES
        );
        return Err(cannot(
            entry,
            &message,
            "a scene whose curved surfaces are farther from the floor's pixels in scale",
        ));
    }
    let description = describe(entry, format, &plan, &export);
    let readme = readme::text(entry, format, &plan, &export);
    let mut json = serde_json::to_vec_pretty(&description).unwrap_or_default();
    json.push(b'\n');
    export.files.push(("export.json".to_owned(), json));
    export
        .files
        .push(("README.md".to_owned(), readme.into_bytes()));
    export.files.sort();
    Ok(export)
}

fn cannot(entry: &Entry, message: &str, help: &str) -> Error {
    Error::Content {
        file: entry.name.clone(),
        message: message.to_owned(),
        help: help.to_owned(),
    }
}

/// What a format cannot express.
fn refuse(entry: &Entry, format: Format, model: &Model) -> Result<(), Error> {
    // Single precision: shapes of very different scale, or far from the origin.
    let camera = &entry.camera;
    let far = camera
        .position
        .iter()
        .chain(&camera.look_at)
        .fold(0.0_f64, |far, c| far.max(c.abs()));
    let near = (0..3)
        .map(|k| camera.position[k] - camera.look_at[k])
        .fold(0.0, libm::hypot);
    if !(near * camera.field_of_view_degrees.to_radians() > SINGLE * far * f64::from(camera.height))
    {
        let message = format!(
            "{} computes in single precision, in which the camera's pixels are not told apart so far from the origin",
            format.name()
        );
        return Err(cannot(
            entry,
            &message,
            "a scene near the origin, of a size of about a metre",
        ));
    }
    let index = |shape: &Shape| match shape.material {
        Material::Dielectric { index, .. } => Some(index),
        _ => None,
    };
    let indices: Vec<f64> = model.shapes.iter().filter_map(index).collect();
    if format == Format::Luxcore && indices.iter().any(|n| *n > 9.0) {
        return Err(cannot(
            entry,
            "luxcore takes no refractive index above 9",
            "an index up to 9",
        ));
    }
    Ok(())
}

fn size(mesh: &Mesh) -> f64 {
    let points = || mesh.vertices.iter().map(|v| v.0);
    let low = points().fold(glam::DVec3::INFINITY, glam::DVec3::min);
    let high = points().fold(glam::DVec3::NEG_INFINITY, glam::DVec3::max);
    (high - low).max_element()
}

/// What the gate reads.
fn describe(entry: &Entry, format: Format, plan: &Plan, export: &Export) -> Value {
    let closure = entry.kind.closure();
    let names = |classes: &[PathClass]| classes.iter().map(ToString::to_string).collect::<Vec<_>>();
    let integrators = integrators::of(format).iter().map(|(name, reach)| {
        let (can, cannot): (Vec<PathClass>, Vec<PathClass>) =
            plan.comparable.iter().partition(|c| reach.samples(c));
        json!({ "name": name, "samples": names(&can), "cannot": names(&cannot) })
    });
    let meshes = export.meshed.iter().map(|m| match &m.tessellated {
        None => json!({ "shape": m.name, "triangles": 2, "exact": true }),
        Some(t) => json!({
            "shape": m.name,
            "triangles": t.mesh.triangles.len(),
            "cells": t.cells,
            "exact": false,
            "displacement_pixels": t.displacement,
            "relative_irradiance": t.shading,
            "largest_facet_angle": t.mesh.facet_angle(),
        }),
    });
    json!({
        "schema": "nephroid-export/1",
        "scene": entry.name,
        "format": format.name(),
        "command": format.command(),
        "seed_spacing": format.seed_spacing(entry),
        "longest_path_edges": plan.edges,
        "closure": { "longest": closure.longest, "reason": closure.reason },
        "comparable": names(&plan.comparable),
        "left_out": names(&plan.left_out),
        "integrators": integrators.collect::<Vec<_>>(),
        "tessellation": {
            "method": "measured estimate from two nested tessellations",
            "pixel_error": export.pixel_error(),
            "pixel_error_means": "largest error of a pixel's radiance, relative to the brightest of the pixel and its eight neighbours; \
                                  at a fold within that of a pixel's side, its square root",
            "meshes": meshes.collect::<Vec<_>>(),
        },
    })
}

/// The file of a shape's mesh.
pub fn mesh_file(shape: &str) -> String {
    format!("meshes/{shape}.ply")
}

/// A number as every format reads it: the shortest decimal that is the same number, without an exponent.
pub fn number(value: f64) -> String {
    // Adding 0 turns -0 into 0.
    format!("{}", value + 0.0)
}

/// Writes the files into a new directory, which appears whole or not at all. An export that is there already is replaced.
///
/// # Errors
/// [`Error::Io`] if something cannot be written; [`Error::Content`] if the directory is there and is no export.
pub fn write(export: &Export, directory: &Path) -> Result<(), Error> {
    let shown = directory.display().to_string();
    let io = |source| Error::read(&shown, source);
    let Some(name) = directory
        .file_name()
        .map(|n| n.to_string_lossy().into_owned())
    else {
        let source = std::io::Error::new(
            std::io::ErrorKind::InvalidInput,
            "not the name of a directory",
        );
        return Err(io(source));
    };
    let taken = directory.exists();
    if taken && !is_replaceable(directory) {
        return Err(Error::Content {
            file: shown,
            message: "is there, and is not an export".to_owned(),
            help: "a directory that does not exist, is empty, or is an export by nephroid (it is replaced)".to_owned(),
        });
    }
    let beside =
        |what: &str| directory.with_file_name(format!(".{name}.{}.{what}", std::process::id()));
    let (temporary, old) = (beside("part"), beside("old"));
    let write_all = || -> std::io::Result<()> {
        for (file, bytes) in &export.files {
            let path = temporary.join(file);
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent)?;
            }
            fs::write(path, bytes)?;
        }
        if taken {
            fs::rename(directory, &old)?;
        }
        fs::rename(&temporary, directory)
    };
    let result = write_all();
    if result.is_err() && old.exists() && !directory.exists() {
        let _ = fs::rename(&old, directory);
    }
    let _ = fs::remove_dir_all(&temporary);
    let _ = fs::remove_dir_all(&old);
    result.map_err(io)
}

/// Whether a directory is empty or an export.
fn is_replaceable(directory: &Path) -> bool {
    let Ok(mut entries) = fs::read_dir(directory) else {
        return false;
    };
    entries.next().is_none()
        || fs::read_to_string(directory.join("export.json"))
            .is_ok_and(|t| t.contains("\"nephroid-export/"))
}
