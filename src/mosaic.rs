//! Areas of an image as unions of disjoint rectangles, for what is known of rectangles only.

/// Pixels x to x + width of rows y to y + height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Left column.
    pub x: u32,
    /// Top row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Rectangle {
    /// Number of pixels.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Whether all of it is in another.
    pub fn is_inside(&self, outer: &Rectangle) -> bool {
        outer.x <= self.x
            && self.x + self.width <= outer.x + outer.width
            && outer.y <= self.y
            && self.y + self.height <= outer.y + outer.height
    }
}

/// Disjoint rectangles of which areas are made.
#[derive(Clone, Debug, PartialEq)]
pub struct Mosaic {
    /// The rectangles.
    pub rectangles: Vec<Rectangle>,
    /// For each area the positions of its rectangles.
    pub areas: Vec<Vec<usize>>,
}

/// Runs of pixels (in increasing order of `row * width + column`) in their rows; those that lie exactly below each other are one rectangle.
pub fn runs(pixels: &[u32], width: u32) -> Vec<Rectangle> {
    let mut rectangles: Vec<Rectangle> = Vec::new();
    // Those that end at the row before, and those of this row.
    let (mut above, mut here): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    let mut row = 0;
    let mut rest = pixels;
    while let Some(&start) = rest.first() {
        let (x, y) = (start % width, start / width);
        let follows = |k: usize| rest.get(k) == Some(&(start + k as u32));
        let length = (1..(width - x) as usize)
            .find(|&k| !follows(k))
            .unwrap_or((width - x) as usize);
        rest = &rest[length..];
        if y != row {
            above = if y == row + 1 {
                core::mem::take(&mut here)
            } else {
                Vec::new()
            };
            here.clear();
            row = y;
        }
        let same = |&k: &usize| rectangles[k].x == x && rectangles[k].width == length as u32;
        let k = match above.iter().copied().find(same) {
            Some(k) => {
                rectangles[k].height += 1;
                k
            }
            None => {
                rectangles.push(Rectangle {
                    x,
                    y,
                    width: length as u32,
                    height: 1,
                });
                rectangles.len() - 1
            }
        };
        here.push(k);
    }
    rectangles
}
