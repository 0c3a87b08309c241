//! The numbers of one evaluation, by the names of the reference tables: for the closed forms in any precision and, exactly
//! the same numbers, for the certificate.

use nephroid_analytic::certificate::source::Source;
use nephroid_analytic::enclosure::Enclosure;
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::{Vec3, vec3};

/// Parameters of a configuration and a receiver point.
#[derive(Clone, Debug, PartialEq)]
pub struct Inputs {
    numbers: Vec<(&'static str, Vec<f64>)>,
    words: Vec<(&'static str, &'static str)>,
    /// Receiver point (x, y) [m].
    pub x: [f64; 2],
}

impl Inputs {
    /// Parameters with one number each.
    pub fn new(numbers: &[(&'static str, f64)], x: [f64; 2]) -> Self {
        Inputs {
            numbers: numbers.iter().map(|&(k, v)| (k, vec![v])).collect(),
            words: Vec::new(),
            x,
        }
    }

    /// With a point or a list, in place of what stood under the key.
    pub fn with(mut self, key: &'static str, values: &[f64]) -> Self {
        self.numbers.retain(|(k, _)| *k != key);
        self.numbers.push((key, values.to_vec()));
        self
    }

    /// At another receiver point.
    pub fn at_point(self, x: [f64; 2]) -> Self {
        Inputs { x, ..self }
    }

    /// With a word.
    pub fn say(mut self, key: &'static str, word: &'static str) -> Self {
        self.words.push((key, word));
        self
    }

    /// Every number rounded to a precision: what a formula in that precision is given.
    pub fn rounded<S: Scalar>(&self) -> Self {
        let round = |v: f64| S::from_f64(v).to_f64();
        Inputs {
            numbers: self
                .numbers
                .iter()
                .map(|(k, v)| (*k, v.iter().map(|&v| round(v)).collect()))
                .collect(),
            words: self.words.clone(),
            x: self.x.map(round),
        }
    }

    /// Lengths times `factor`, wave numbers divided by it.
    pub fn scaled(mut self, factor: f64, pure: &[&str]) -> Self {
        for (key, values) in &mut self.numbers {
            if *key == "waves_A_k_phase" {
                for row in values.chunks_mut(3) {
                    row[0] *= factor;
                    row[1] /= factor;
                }
            } else if !pure.contains(key) {
                values.iter_mut().for_each(|v| *v *= factor);
            }
        }
        self.x = self.x.map(|v| v * factor);
        self
    }

    /// Everything moved along (1, 1, 0); `places` are the keys that are points.
    pub fn translated(mut self, by: f64, places: &[&str]) -> Self {
        for (key, values) in &mut self.numbers {
            if places.contains(key) {
                values.iter_mut().take(2).for_each(|v| *v += by);
            }
        }
        self.x = self.x.map(|v| v + by);
        self
    }

    /// The same with each number in turn, those of the point too, changed by the part `delta` of itself.
    pub fn perturbed(&self, delta: f64) -> Vec<Self> {
        let mut all = Vec::new();
        for (k, (_, values)) in self.numbers.iter().enumerate() {
            for i in (0..values.len()).filter(|&i| values[i] != 0.0) {
                let mut changed = self.clone();
                changed.numbers[k].1[i] *= 1.0 + delta;
                all.push(changed);
            }
        }
        for i in (0..2).filter(|&i| self.x[i] != 0.0) {
            let mut changed = self.clone();
            changed.x[i] *= 1.0 + delta;
            all.push(changed);
        }
        all
    }

    fn find(&self, key: &str) -> Option<&[f64]> {
        let found = self.numbers.iter().find(|(k, _)| *k == key);
        found.map(|(_, v)| v.as_slice())
    }

    /// Whether a number is there.
    pub fn has_number(&self, key: &str) -> bool {
        self.find(key).is_some()
    }

    /// A number; 0 where there is none.
    pub fn scalar<S: Scalar>(&self, key: &str) -> S {
        let value = self.find(key).and_then(|v| v.first().copied());
        S::from_f64(value.unwrap_or(0.0))
    }

    /// A point; the origin where there is none.
    pub fn vector<S: Scalar>(&self, key: &str) -> Vec3<S> {
        let v = self.find(key).unwrap_or(&[]);
        let at = |i: usize| S::from_f64(v.get(i).copied().unwrap_or(0.0));
        vec3(at(0), at(1), at(2))
    }

    /// Rows of three.
    pub fn rows<S: Scalar>(&self, key: &str) -> Vec<[S; 3]> {
        let rows = self.find(key).unwrap_or(&[]).chunks_exact(3);
        rows.map(|r| [r[0], r[1], r[2]].map(S::from_f64)).collect()
    }

    /// The word under a key.
    pub fn word(&self, key: &str) -> Option<&'static str> {
        self.words.iter().find(|(k, _)| *k == key).map(|(_, w)| *w)
    }
}

impl Source for Inputs {
    fn text(&self, key: &str, indices: &[usize]) -> Option<String> {
        if let Some(word) = self.word(key) {
            return Some(word.to_owned());
        }
        // Whole numbers are read as text; everything else as the point that it is, below.
        self.at(key, indices).map(|v| v.to_string())
    }

    fn number(&self, key: &str) -> Option<Enclosure> {
        self.at(key, &[]).map(Enclosure::point)
    }

    fn entry(&self, key: &str, indices: &[usize]) -> Option<Enclosure> {
        self.at(key, indices).map(Enclosure::point)
    }
}

impl Inputs {
    fn at(&self, key: &str, indices: &[usize]) -> Option<f64> {
        let values = self.find(key)?;
        match *indices {
            [] => values.first().copied(),
            [i] => values.get(i).copied(),
            [i, j] if j < 3 => values.get(3 * i + j).copied(),
            _ => None,
        }
    }
}
