//! What an evaluation answers: values with error bounds, and how far they are from expected ones.

use nephroid_analytic::kinds::Estimate;

use crate::error::Error;
use crate::evaluate::certify::Certificate;
use crate::evaluate::reading::Object;

/// Relative size below which an expected zero counts as met.
pub const ZERO: f64 = 1e-12;
/// Conditioning from which a point counts as near a singularity, in scenes that have one.
pub const NEAR_SINGULARITY: f64 = 100.0;

/// A computed value and, where the file has one, the expected value.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What it is: `E_caustic`, `paths.LSDE.E`, `paths.LSDE.roots.0.E`.
    pub key: String,
    /// The value.
    pub value: f64,
    /// Absolute error bound; infinite on a fold.
    pub error_bound: f64,
    /// Relative change of the value per relative change of the inputs.
    pub conditioning: f64,
    /// Whether the point is near a singularity, so that the error bound replaces the tolerance.
    pub near_singularity: bool,
    /// The expected value, if the file has one.
    pub expected: Option<f64>,
    /// Relative size of one unit in the last of the digits that an expected value was rounded to, 0 where it is not known.
    pub last_digit: f64,
    /// |value - expected|/|expected|, or |value| over the configuration's largest value where 0 is expected.
    pub relative_difference: Option<f64>,
    /// What is proven of the true value, where that was asked for.
    pub certificate: Option<Certificate>,
}

impl Row {
    /// The relative difference that the conditioning allows near a singularity.
    pub fn allowed_by_conditioning(&self) -> f64 {
        if self.error_bound == f64::INFINITY {
            f64::INFINITY
        } else if self.value == 0.0 {
            ZERO
        } else {
            self.error_bound / f64::abs(self.value)
        }
    }

    /// The relative difference that is allowed at a tolerance.
    pub fn allowed(&self, tolerance: f64) -> f64 {
        if self.expected == Some(0.0) {
            ZERO
        } else if self.near_singularity {
            tolerance.max(self.allowed_by_conditioning())
        } else {
            tolerance.max(self.last_digit)
        }
    }

    /// Whether the value is as close to the expected one as the tolerance, or the conditioning, asks.
    pub fn passes(&self, tolerance: f64) -> bool {
        self.relative_difference
            .is_none_or(|d| d <= self.allowed(tolerance))
    }
}

/// The values at one point or of one view.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// The point's or view's id.
    pub id: String,
    /// The values.
    pub rows: Vec<Row>,
    /// Number of roots per path class.
    pub roots: Vec<(String, u32)>,
    /// Distance to the nearest singularity [m].
    pub singularity: Option<f64>,
}

/// The points and views of one configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// The configuration's id.
    pub id: String,
    /// Points, then views.
    pub items: Vec<Item>,
}

/// The answer to a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The file's schema.
    pub schema: String,
    /// The file's scene.
    pub scene: String,
    /// The configurations in the order of the file.
    pub configurations: Vec<Configuration>,
}

/// A row and where it stands.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// Configuration id.
    pub configuration: &'a str,
    /// Point or view id.
    pub item: &'a str,
    /// The row.
    pub row: &'a Row,
}

impl Report {
    /// All rows in the order of the file.
    pub fn rows(&self) -> impl Iterator<Item = Placed<'_>> {
        self.configurations.iter().flat_map(|c| {
            c.items.iter().flat_map(|i| {
                i.rows.iter().map(|row| Placed {
                    configuration: &c.id,
                    item: &i.id,
                    row,
                })
            })
        })
    }

    /// The compared row with the largest relative difference, among all rows or only away from singularities.
    pub fn worst(&self, regular_only: bool) -> Option<Placed<'_>> {
        self.rows()
            .filter(|p| p.row.relative_difference.is_some())
            .filter(|p| !(regular_only && p.row.near_singularity))
            .max_by(|a, b| {
                let key = |p: &Placed<'_>| p.row.relative_difference.unwrap_or(0.0);
                key(a).total_cmp(&key(b))
            })
    }
}

/// Collects the rows of one point or view.
pub struct Rows<'a> {
    item: Object<'a>,
    near_singularity: bool,
    rows: Vec<Row>,
    roots: Vec<(String, u32)>,
}

impl<'a> Rows<'a> {
    /// For a point or view of a scene without a singularity.
    pub fn regular(item: Object<'a>) -> Self {
        Rows {
            item,
            near_singularity: false,
            rows: vec![],
            roots: vec![],
        }
    }

    /// For a point or view of a scene that has a singularity, with its caustic irradiance there.
    pub fn near(item: Object<'a>, caustic: &Estimate<f64>) -> Self {
        Rows {
            near_singularity: !(caustic.conditioning() <= NEAR_SINGULARITY),
            ..Self::regular(item)
        }
    }

    /// Adds a value under a key of the point, compared with what the point has under that key.
    ///
    /// # Errors
    /// [`Error::Content`] if the expected value is not a finite number.
    pub fn add(&mut self, key: &str, estimate: Estimate<f64>) -> Result<(), Error> {
        let expected = self.item.expected(key)?;
        self.push(key.to_owned(), estimate, expected);
        Ok(())
    }

    /// Adds a value compared with one key of another object, down to the last digit that is written there.
    ///
    /// # Errors
    /// [`Error::Content`] if the expected value is not a finite number.
    pub fn add_as(
        &mut self,
        name: &str,
        estimate: Estimate<f64>,
        object: &Object<'_>,
        key: &str,
    ) -> Result<(), Error> {
        self.push(name.to_owned(), estimate, object.expected(key)?);
        let written = object.get(key).and_then(|v| v.as_str());
        if let (Some(row), Some(text)) = (self.rows.last_mut(), written) {
            row.last_digit = last_digit(text);
        }
        Ok(())
    }

    fn push(&mut self, key: String, estimate: Estimate<f64>, expected: Option<f64>) {
        let conditioning = estimate.conditioning();
        self.rows.push(Row {
            key,
            value: estimate.value,
            error_bound: estimate.error,
            conditioning,
            near_singularity: self.near_singularity && !(conditioning <= NEAR_SINGULARITY),
            expected,
            last_digit: 0.0,
            relative_difference: None,
            certificate: None,
        });
    }

    /// Adds a path class: its irradiance and that of each root, compared with the entry of that class in `paths`.
    /// Roots are compared in descending order: which expected root belongs to which does not depend on their other keys.
    ///
    /// # Errors
    /// [`Error::Content`] for an entry that cannot be read.
    pub fn add_class(
        &mut self,
        class: &str,
        total: Estimate<f64>,
        roots: &[Estimate<f64>],
    ) -> Result<(), Error> {
        let listed = self.listed(class)?;
        if roots.is_empty() && listed.is_none() {
            return Ok(());
        }
        let count = u32::try_from(roots.len()).unwrap_or(u32::MAX);
        self.roots.push((class.to_owned(), count));
        let (expected, expected_roots) = match listed {
            None => (None, vec![]),
            Some(path) => (path.expected("E")?, path.objects("roots")?),
        };
        self.push(format!("paths.{class}.E"), total, expected);
        self.add_roots(&format!("paths.{class}.roots"), "E", roots, &expected_roots)
    }

    /// Adds the values of roots under `prefix.N.key`.
    ///
    /// # Errors
    /// [`Error::Content`] for an expected value that is not a finite number.
    pub fn add_roots(
        &mut self,
        prefix: &str,
        key: &str,
        roots: &[Estimate<f64>],
        expected: &[Object<'_>],
    ) -> Result<(), Error> {
        let mut listed = expected
            .iter()
            .filter_map(|root| root.expected(key).transpose())
            .collect::<Result<Vec<f64>, Error>>()?;
        listed.sort_by(|a, b| b.total_cmp(a));
        let mut sorted = roots.to_vec();
        sorted.sort_by(|a, b| b.value.total_cmp(&a.value));
        // Some values absent: which root they belong to is unknown, so that only complete lists are compared.
        let complete = listed.len() == expected.len() && !expected.is_empty();
        let rows = if complete {
            sorted.len().max(listed.len())
        } else {
            sorted.len()
        };
        for n in 0..rows {
            let estimate = sorted.get(n).copied().unwrap_or(Estimate::NONE);
            let value = if complete {
                Some(listed.get(n).copied().unwrap_or(0.0))
            } else {
                None
            };
            self.push(format!("{prefix}.{n}.{key}"), estimate, value);
        }
        Ok(())
    }

    /// The entry of a class in `paths`; `R` and `T` count as `S`.
    fn listed(&self, class: &str) -> Result<Option<Object<'a>>, Error> {
        for path in self.item.objects("paths")? {
            let name = path.text("class")?;
            if general_class(name) == class {
                return Ok(Some(path));
            }
        }
        Ok(None)
    }

    /// Adds what `paths` lists of classes that the scene does not carry: their light is zero.
    ///
    /// # Errors
    /// [`Error::Content`] for something that is not a path class.
    pub fn add_missing_classes(&mut self) -> Result<(), Error> {
        for path in self.item.objects("paths")? {
            let name = path.text("class")?;
            let general = general_class(name);
            let inner = general.strip_prefix('L').and_then(|t| t.strip_suffix("DE"));
            if inner.is_none_or(|t| t.chars().any(|c| c != 'S')) {
                let allowed = "a path class: L, then any of S R T, then DE";
                return Err(path.error("class", &format!("`{name}`"), allowed));
            }
            if !self.roots.iter().any(|(c, _)| *c == general) {
                self.add_class(&general, Estimate::NONE, &[])?;
            }
        }
        Ok(())
    }

    /// The finished item.
    ///
    /// # Errors
    /// [`Error::Content`] without an id.
    pub fn finish(self, singularity: Option<f64>) -> Result<Item, Error> {
        Ok(Item {
            id: self.item.text("id")?.to_owned(),
            rows: self.rows,
            roots: self.roots,
            singularity,
        })
    }
}

/// Relative size of one unit in the last digit of a decimal number that is visibly rounded: 8 to 15 significant digits.
/// Fewer are an exact short decimal, more are below the precision of this program.
fn last_digit(text: &str) -> f64 {
    let mantissa = text.split(['e', 'E']).next().unwrap_or_default();
    let digits = mantissa
        .trim_start_matches(['+', '-', '0', '.'])
        .bytes()
        .filter(u8::is_ascii_digit)
        .count();
    if !(8..=15).contains(&digits) {
        return 0.0;
    }
    (1..digits).fold(1.0, |unit, _| unit / 10.0)
}

fn general_class(name: &str) -> String {
    name.replace(['R', 'T'], "S")
}

/// Fills in the relative differences of a configuration, whose largest value is the measure of an expected zero.
pub fn compare(items: &mut [Item]) {
    let largest = items
        .iter()
        .flat_map(|i| &i.rows)
        .map(|r| f64::abs(r.expected.unwrap_or(r.value)))
        .filter(|v| v.is_finite())
        .fold(0.0, f64::max);
    for row in items.iter_mut().flat_map(|i| &mut i.rows) {
        row.relative_difference = row.expected.map(|expected| {
            let difference = f64::abs(row.value - expected);
            let measure = if expected == 0.0 {
                largest
            } else {
                f64::abs(expected)
            };
            if difference == 0.0 {
                0.0
            } else if measure > 0.0 && difference.is_finite() {
                difference / measure
            } else {
                f64::INFINITY
            }
        });
    }
}
