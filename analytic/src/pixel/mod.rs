//! Pixels: the mean radiance over a pixel's box, per path class, with an error bound.
//!
//! A pixel's value is never a point sample. Planar scenes are clipped into smooth polygons ([`planar`]); scenes with
//! curved film edges go by scan lines between exact events.

mod cup;
mod events;
mod fan;
mod floor_polygon;
mod furnace;
mod line;
pub mod planar;
mod planar_image;
pub mod polygon;
mod pool;
mod quartic;
pub mod rule;

use crate::camera::Bounded;
use crate::class::PathClass;
use crate::entries;
use crate::flux::FluxImage;
use crate::scene::{Entry, InvalidParameter};

use cup::CupImage;
use furnace::FurnaceImage;
use planar_image::PlanarImage;
use pool::PoolImage;

/// The exact image of an entry, a row at a time.
#[derive(Clone, Debug)]
pub struct PixelTruth {
    classes: &'static [PathClass],
    width: u32,
    image: Image,
}

#[derive(Clone, Debug)]
enum Image {
    Planar(PlanarImage),
    Cup(CupImage),
    Pool(PoolImage),
    Flux(FluxImage),
    Furnace(FurnaceImage),
}

/// The image of a floor that is seen directly, by conservation of flux.
fn flux_image(entry: &Entry) -> Option<FluxImage> {
    let layers = entries::form(&entry.kind).bundles()?;
    Some(FluxImage::new(&entry.camera, entry.kind.floor()?, layers))
}

impl PixelTruth {
    /// Validates and prepares an entry.
    ///
    /// # Errors
    /// The first parameter for which the closed form does not hold.
    pub fn new(entry: &Entry) -> Result<Self, InvalidParameter> {
        entry.validate()?;
        let image = PlanarImage::new(entry)
            .map(Image::Planar)
            .or_else(|| CupImage::new(entry).map(Image::Cup))
            .or_else(|| PoolImage::new(entry).map(Image::Pool))
            .or_else(|| FurnaceImage::new(entry).map(Image::Furnace))
            .or_else(|| flux_image(entry).map(Image::Flux));
        let Some(image) = image else {
            return Err(InvalidParameter {
                key: "kind".to_owned(),
                found: entry.kind.name().to_owned(),
                allowed: "a kind with exact pixels".to_owned(),
            });
        };
        Ok(PixelTruth {
            classes: entry.kind.classes(),
            width: entry.camera.width,
            image,
        })
    }

    /// The path classes, in the order of the layers.
    pub fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    /// Row `j` (0 is the top): `[class][column]`, the mean radiance over the pixel [W m⁻² sr⁻¹] with its absolute error
    /// bound, to a relative tolerance (clamped to at least 1e-14).
    pub fn row(&self, j: u32, tolerance: f64) -> Vec<Vec<Bounded>> {
        let tolerance = tolerance.max(1e-14);
        let mut row = vec![vec![Bounded::default(); self.width as usize]; self.classes.len()];
        match &self.image {
            Image::Planar(image) => image.row(j, tolerance, &mut row),
            Image::Cup(image) => image.row(j, tolerance, &mut row),
            Image::Pool(image) => image.row(j, tolerance, &mut row),
            Image::Furnace(image) => image.row(j, tolerance, &mut row),
            Image::Flux(image) => image.row(j, tolerance, &mut row),
        }
        row
    }
}
