//! The README of an exported directory.

use std::fmt::Write as _;

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use super::{Export, Format, Plan, integrators, mitsuba, tessellation};

/// The text.
pub fn text(entry: &Entry, format: Format, plan: &Plan, export: &Export) -> String {
    let mut out = String::new();
    let name = &entry.name;
    let _ = write!(
        out,
        "# {name} for {}\n\n{}.\n\n## Render\n\nIn this directory:\n\n",
        title(format),
        entry.title
    );
    let example = format
        .command()
        .replace("{seed}", "1")
        .replace("{spp}", "64")
        .replace("{integrator}", integrators::of(format)[0].0)
        .replace("{out}", "image.exr")
        .replace("{dir}/", "");
    let _ = write!(out, "```sh\n{example}\n```\n\n{}\n\n", notes(entry, format));
    out.push_str(
        "The image is linear, single precision, with a box filter of one pixel: the mean radiance over each pixel in W/(m² sr), the \
         same in every colour channel.\n\n",
    );
    depth(&mut out, entry, plan);
    let known = crate::entry::names().any(|known| known == name);
    sampled(
        &mut out,
        if known { name } else { "SCENE.toml" },
        format,
        plan,
    );
    geometry(&mut out, export);
    out
}

fn title(format: Format) -> &'static str {
    match format {
        Format::Mitsuba => "Mitsuba 3",
        Format::Pbrt => "pbrt-v4",
        Format::Luxcore => "LuxCore",
    }
}

fn notes(entry: &Entry, format: Format) -> String {
    match format {
        Format::Mitsuba => format!(
            "`seed`, `spp`, `integrator` and `max_depth` are parameters of `{}` with defaults; any RGB or monochrome variant will do. \
             Seeds must be at least {} apart: images of closer ones share random numbers, and do not show their noise. (The gate \
             draws its seeds from all over 31 bits.)",
            mitsuba::FILE,
            mitsuba::seed_spacing(entry.camera.width, entry.camera.height)
        ),
        Format::Pbrt => "The integrator is the file that is given before the scene. This format has not been measured with the renderer."
            .to_owned(),
        Format::Luxcore => "`render.py` needs the package `pyluxcore`. It waits until the renderer halts by itself: an image saved before \
                            the first passes end is short of light. The same seed does not give the same image twice. The screen \
                            window is moved by one row, by which the renderer draws lower; a point light's gain is 4π per W/sr."
            .to_owned(),
    }
}

fn list(classes: &[PathClass]) -> String {
    let names: Vec<_> = classes.iter().map(|c| format!("`{c}`")).collect();
    if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    }
}

fn depth(out: &mut String, entry: &Entry, plan: &Plan) {
    let closure = entry.kind.closure();
    let _ = write!(
        out,
        "## Path depth\n\nThe files ask for paths of at most {} edges from the light to the eye: then the image is the sum of {}. ",
        plan.edges,
        list(&plan.comparable)
    );
    let _ = match closure.longest {
        None => writeln!(out, "Longer paths bring nothing: {}.\n", closure.reason),
        Some(longest) => writeln!(
            out,
            "Fair are at most {longest} edges: {}. A renderer that is not limited to that is not comparable on the whole image.\n",
            closure.reason
        ),
    };
    if !plan.left_out.is_empty() {
        let _ = writeln!(
            out,
            "Left out: {}. They have more edges than that, and are comparable only as a layer of their own.\n",
            list(&plan.left_out)
        );
    }
}

fn sampled(out: &mut String, scene: &str, format: Format, plan: &Plan) {
    out.push_str("## What the integrators can sample\n\n| integrator | how | can sample | cannot |\n| --- | --- | --- | --- |\n");
    let mut example = None;
    for (name, reach) in integrators::of(format) {
        let (can, cannot): (Vec<PathClass>, Vec<PathClass>) =
            plan.comparable.iter().partition(|c| reach.samples(c));
        let _ = writeln!(
            out,
            "| `{name}` | {} | {} | {} |",
            reach.meaning(),
            list(&can),
            list(&cannot)
        );
        if !can.is_empty() && example.is_none() {
            example = Some((*name, cannot));
        }
    }
    if let Some((name, cannot)) = example {
        let declared: String = cannot.iter().map(|c| format!(" --cannot {c}")).collect();
        let command = format
            .command()
            .replace("{spp}", "64")
            .replace("{integrator}", name);
        let _ = write!(
            out,
            "\nThe gate is told what an integrator cannot sample; here it runs `{name}` itself, started in this directory:\n\n```sh\n\
             nephroid gate {scene}{declared} \\\n  --command '{command}'\n```\n\n"
        );
    }
}

fn geometry(out: &mut String, export: &Export) {
    out.push_str("## Geometry\n\n");
    let curved: Vec<_> = export
        .meshed
        .iter()
        .filter_map(|m| Some((m.name, m.tessellated.as_ref()?)))
        .collect();
    if curved.is_empty() {
        out.push_str("Every surface is exact: the renderer's own shapes, or two triangles for a rectangle.\n");
        return;
    }
    out.push_str(
        "Meshes with the surface's own normals at their vertices stand for what the renderer has no shape for:\n\n\
         | shape | triangles | displacement [pixels] | largest angle between facet and normal |\n| --- | --- | --- | --- |\n",
    );
    for (name, t) in curved {
        let _ = writeln!(
            out,
            "| {name} | {} | {:.1e} | {:.1e} |",
            t.mesh.triangles.len(),
            t.displacement,
            t.mesh.facet_angle()
        );
    }
    let _ = writeln!(
        out,
        "\nThe error of a pixel by that is at most {:.1e} of the brightest of the pixel and its neighbours (a measured estimate from two \
         nested tessellations; {:.1e} pixels of displacement are aimed at). `export.json` has it for the gate.",
        export.pixel_error(),
        tessellation::ALLOWED
    );
}
