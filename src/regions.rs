//! The parts of an image that are judged: all of it, the tiles of a quadtree, a user's mask.
//!
//! A bias that the mean of an image hides (light in the wrong place, a loss along an edge) is not hidden from the mean of the
//! tile it is in; a bias that is everywhere is found by the mean of the image from the fewest samples. So both are tested.
//! A tile is at least [`SMALLEST_TILE`] pixels wide and high: 256 pixels, which a replicate can fill with the 200
//! contributions that a test asks for.

use core::fmt;

use crate::mosaic::{Mosaic, Rectangle, runs};

/// Least width and height of a tile [pixels].
pub const SMALLEST_TILE: u32 = 16;
/// Most levels of the quadtree below the whole image.
pub const MOST_LEVELS: u32 = 4;

/// A part of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Area {
    /// All of it.
    Image,
    /// A rectangle of a quadtree.
    Tile {
        /// Halvings of the image: 1 for a quarter of it.
        level: u32,
        /// Left column.
        x: u32,
        /// Top row.
        y: u32,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The pixels of a user's mask, in increasing order of `row * width + column`.
    Mask(Vec<u32>),
}

impl fmt::Display for Area {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Area::Image => f.write_str("image"),
            Area::Tile {
                x,
                y,
                width,
                height,
                ..
            } => write!(f, "tile {width}x{height}+{x}+{y}"),
            Area::Mask(_) => f.write_str("mask"),
        }
    }
}

/// An image that is not divided is one of at most this many strips of rows, so that threads have something to share.
const STRIPS: u32 = 16;

/// The areas of an image, the first of which is the one that decides about equivalence.
#[derive(Clone, Debug, PartialEq)]
pub struct Regions {
    width: u32,
    height: u32,
    areas: Vec<Area>,
}

impl Regions {
    /// The image and the tiles of its quadtree.
    pub fn quadtree(width: u32, height: u32) -> Self {
        let mut areas = vec![Area::Image];
        for level in 1..=MOST_LEVELS {
            let parts = 1 << level;
            if width.min(height) / parts < SMALLEST_TILE {
                break;
            }
            // Widths differ by a pixel at most, so that no tile falls below the least.
            let cut =
                |length: u32, i: u32| (u64::from(length) * u64::from(i) / u64::from(parts)) as u32;
            for j in 0..parts {
                for i in 0..parts {
                    let (x, y) = (cut(width, i), cut(height, j));
                    areas.push(Area::Tile {
                        level,
                        x,
                        y,
                        width: cut(width, i + 1) - x,
                        height: cut(height, j + 1) - y,
                    });
                }
            }
        }
        Regions {
            width,
            height,
            areas,
        }
    }

    /// The whole image only.
    pub fn image(width: u32, height: u32) -> Self {
        Regions {
            width,
            height,
            areas: vec![Area::Image],
        }
    }

    /// The pixels of a mask only; `None` if it selects none, or has another number of pixels than the image.
    pub fn mask(width: u32, height: u32, selected: &[bool]) -> Option<Self> {
        if selected.len() != width as usize * height as usize {
            return None;
        }
        let pixels: Vec<u32> = (0..)
            .zip(selected)
            .filter(|(_, s)| **s)
            .map(|(i, _)| i)
            .collect();
        (!pixels.is_empty()).then(|| Regions {
            width,
            height,
            areas: vec![Area::Mask(pixels)],
        })
    }

    /// The areas.
    pub fn areas(&self) -> &[Area] {
        &self.areas
    }

    /// The first area alone.
    pub fn first(&self) -> Self {
        Regions {
            areas: self.areas[..1].to_vec(),
            ..*self
        }
    }

    /// The areas as unions of disjoint rectangles: the smallest tiles, the runs of a mask, or strips of an image that has
    /// neither.
    pub fn mosaic(&self) -> Mosaic {
        let deepest = self.areas.iter().map(level_of).max().unwrap_or(0);
        let rectangles = match self.areas.first() {
            Some(Area::Mask(pixels)) => runs(pixels, self.width),
            _ if deepest > 0 => self
                .areas
                .iter()
                .filter(|a| level_of(a) == deepest)
                .filter_map(|a| self.rectangle(a))
                .collect(),
            _ => {
                let strips = STRIPS.min(self.height);
                let row = |k: u32| self.height * k / strips;
                let strip = |k: u32| Rectangle {
                    x: 0,
                    y: row(k),
                    width: self.width,
                    height: row(k + 1) - row(k),
                };
                (0..strips).map(strip).collect()
            }
        };
        let of_area = |area: &Area| -> Vec<usize> {
            let outer = self.rectangle(area);
            let belongs = |r: &Rectangle| outer.is_none_or(|o| r.is_inside(&o));
            (0..rectangles.len())
                .filter(|&k| belongs(&rectangles[k]))
                .collect()
        };
        let areas = self.areas.iter().map(of_area).collect();
        Mosaic { rectangles, areas }
    }

    /// An area that is a rectangle as one.
    fn rectangle(&self, area: &Area) -> Option<Rectangle> {
        match *area {
            Area::Image => Some(Rectangle {
                x: 0,
                y: 0,
                width: self.width,
                height: self.height,
            }),
            Area::Tile {
                x,
                y,
                width,
                height,
                ..
            } => Some(Rectangle {
                x,
                y,
                width,
                height,
            }),
            Area::Mask(_) => None,
        }
    }

    /// How much of a check's error probability each area has: half for the first, the rest shared equally by the levels
    /// of the quadtree and by the tiles of a level; all for the first if it is alone. The sum is 1.
    pub fn weights(&self) -> Vec<f64> {
        let levels = f64::from(self.areas.iter().map(level_of).max().unwrap_or(0));
        self.areas
            .iter()
            .map(|area| match level_of(area) {
                0 if levels > 0.0 => 0.5,
                0 => 1.0,
                level => 0.5 / levels / libm::ldexp(1.0, 2 * level as i32),
            })
            .collect()
    }

    /// Sums of a layer over each area, in index order, and the number of its pixels that are not zero.
    pub fn reduce(&self, layer: &[f64]) -> Vec<(f64, u64)> {
        self.areas
            .iter()
            .map(|area| self.sum(area, layer))
            .collect()
    }

    /// The same for one area, by its position.
    pub fn reduce_area(&self, position: usize, layer: &[f64]) -> (f64, u64) {
        self.sum(&self.areas[position], layer)
    }

    /// Number of pixels of each area.
    pub fn pixels(&self) -> Vec<u64> {
        (0..self.areas.len()).map(|k| self.pixels_of(k)).collect()
    }

    /// Number of pixels of one area, by its position.
    pub fn pixels_of(&self, position: usize) -> u64 {
        match &self.areas[position] {
            Area::Image => u64::from(self.width) * u64::from(self.height),
            Area::Tile { width, height, .. } => u64::from(*width) * u64::from(*height),
            Area::Mask(pixels) => pixels.len() as u64,
        }
    }

    fn sum(&self, area: &Area, layer: &[f64]) -> (f64, u64) {
        match area {
            Area::Image => row_sum(layer),
            Area::Tile {
                x,
                y,
                width,
                height,
                ..
            } => (*y..y + height).fold((0.0, 0), |(sum, count), row| {
                let start = row as usize * self.width as usize + *x as usize;
                let (s, c) = row_sum(&layer[start..start + *width as usize]);
                (sum + s, count + c)
            }),
            Area::Mask(pixels) => pixels.iter().fold((0.0, 0), |(sum, count), &i| {
                let v = layer[i as usize];
                (sum + v, count + u64::from(v != 0.0))
            }),
        }
    }
}

fn level_of(area: &Area) -> u32 {
    match area {
        Area::Tile { level, .. } => *level,
        Area::Image | Area::Mask(_) => 0,
    }
}

/// Eight sums side by side, added in a fixed order: as exact as one, and the same bits everywhere.
fn row_sum(values: &[f64]) -> (f64, u64) {
    let mut sums = [0.0; 8];
    let mut counts = [0_u64; 8];
    let chunks = values.chunks_exact(8);
    let rest = chunks.remainder();
    for chunk in chunks {
        for k in 0..8 {
            sums[k] += chunk[k];
            counts[k] += u64::from(chunk[k] != 0.0);
        }
    }
    for (k, &v) in rest.iter().enumerate() {
        sums[k] += v;
        counts[k] += u64::from(v != 0.0);
    }
    (sums.iter().sum(), counts.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_of_a_level_cover_the_image_once() {
        for (width, height) in [(128, 128), (100, 77), (33, 32), (256, 64)] {
            let regions = Regions::quadtree(width, height);
            let layer: Vec<f64> = (0..width * height).map(|i| f64::from(i % 7)).collect();
            let sums = regions.reduce(&layer);
            let pixels = regions.pixels();
            let deepest = regions.areas().iter().map(level_of).max().unwrap();
            assert!(deepest >= 1);
            for level in 1..=deepest {
                let of_level =
                    || (0..sums.len()).filter(|&k| level_of(&regions.areas()[k]) == level);
                assert_eq!(of_level().map(|k| sums[k].0).sum::<f64>(), sums[0].0);
                assert_eq!(of_level().map(|k| sums[k].1).sum::<u64>(), sums[0].1);
                assert_eq!(of_level().map(|k| pixels[k]).sum::<u64>(), pixels[0]);
                assert!(of_level().all(|k| pixels[k] >= 256));
            }
            assert!((regions.weights().iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
        assert_eq!(Regions::quadtree(31, 500).areas().len(), 1);
        assert_eq!(Regions::quadtree(128, 128).areas().len(), 1 + 4 + 16 + 64);
    }

    /// Every pixel of an area is in exactly one of its rectangles, and no other is.
    #[test]
    fn rectangles_cover_their_areas_once() {
        let (width, height) = (41, 33);
        let scattered: Vec<bool> = (0..width * height)
            .map(|i| (i * i + i / 7) % 5 < 2 || i % width < 4 || i / width > 30)
            .collect();
        for regions in [
            Regions::image(width, height),
            Regions::image(3, 2),
            Regions::quadtree(100, 77),
            Regions::mask(width, height, &scattered).unwrap(),
            Regions::mask(width, height, &vec![true; scattered.len()]).unwrap(),
        ] {
            let mosaic = regions.mosaic();
            let mut layer = vec![0.0; regions.width as usize * regions.height as usize];
            for (k, r) in mosaic.rectangles.iter().enumerate() {
                for j in r.y..r.y + r.height {
                    for i in r.x..r.x + r.width {
                        let pixel = &mut layer[(j * regions.width + i) as usize];
                        assert_eq!(*pixel, 0.0);
                        *pixel = (k + 1) as f64;
                    }
                }
            }
            let sums = regions.reduce(&layer);
            for ((area, sum), pixels) in mosaic.areas.iter().zip(sums).zip(regions.pixels()) {
                let of = |k: &usize| mosaic.rectangles[*k].pixels();
                assert_eq!(area.iter().map(of).sum::<u64>(), pixels);
                let weighted = area.iter().map(|k| (k + 1) as f64 * of(k) as f64);
                assert_eq!((weighted.sum::<f64>(), pixels), sum);
            }
        }
        let whole = Regions::mask(width, height, &vec![true; scattered.len()]).unwrap();
        assert_eq!(whole.mosaic().rectangles.len(), 1);
    }

    #[test]
    fn a_mask_is_its_pixels() {
        let layer = [1.0, 2.0, 4.0, 8.0, 0.0, 16.0];
        let mask = Regions::mask(3, 2, &[true, false, false, true, true, false]).unwrap();
        assert_eq!(mask.reduce(&layer), [(9.0, 2)]);
        assert_eq!((mask.pixels(), mask.weights()), (vec![3], vec![1.0]));
        assert_eq!(Regions::mask(3, 2, &[false; 6]), None);
        assert_eq!(Regions::mask(3, 2, &[true; 5]), None);
    }
}
