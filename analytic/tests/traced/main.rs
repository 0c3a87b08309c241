//! A second route to the focusing kinds: light traced through the implicit surfaces with vectors, the irradiance from
//! differences of the landing point, the number of roots from dense scans. Nothing here calls the formulas under test
//! except to be compared with them.

mod conics;
mod precision;
mod sphere;
mod tracing;
mod waves;
