//! A page of panels as SVG: white, self-contained, the same bytes every time.

use core::fmt::Write as _;

/// Room for the legend below the panels [px].
const FOOT: f64 = 30.0;
/// The legend's base line is this far above the bottom [px].
const BASE: f64 = 10.0;

/// A page on which panels are drawn, row by row, with a legend below them.
pub(crate) struct Sheet {
    /// The document so far.
    pub(crate) out: String,
    panel: [f64; 2],
    columns: usize,
    height: f64,
}

impl Sheet {
    /// A page for so many panels of a size [px].
    pub(crate) fn new(panel: [f64; 2], columns: usize, panels: usize) -> Self {
        let rows = panels.div_ceil(columns).max(1);
        let (width, height) = (panel[0] * columns as f64, panel[1] * rows as f64 + FOOT);
        let mut out = String::new();
        let _ = write!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"11\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        Sheet {
            out,
            panel,
            columns,
            height,
        }
    }

    /// The top left corner of a panel.
    pub(crate) fn origin(&self, panel: usize) -> [f64; 2] {
        [
            self.panel[0] * (panel % self.columns) as f64,
            self.panel[1] * (panel / self.columns) as f64,
        ]
    }

    /// Where the legend's text stands.
    pub(crate) fn legend(&self) -> f64 {
        self.height - BASE
    }

    /// The whole document.
    pub(crate) fn finish(mut self) -> String {
        self.out += "</svg>\n";
        self.out
    }
}
