//! Light path classes in Heckbert's notation, written from the light to the eye.
//!
//! `LDE` is direct light, `LSDE` a caustic, `LDSE` direct light seen through a specular surface, `LSDSE` a reflected
//! caustic. `R` (reflection) and `T` (transmission) stand for `S` where they differ: `LTTDE`.

use core::fmt;
use core::str::FromStr;

/// One specular interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Specular {
    /// Either kind: `S`.
    Any,
    /// Reflection: `R`.
    Reflection,
    /// Transmission: `T`.
    Transmission,
}

impl Specular {
    const fn letter(self) -> char {
        match self {
            Specular::Any => 'S',
            Specular::Reflection => 'R',
            Specular::Transmission => 'T',
        }
    }

    const fn from_letter(letter: char) -> Option<Self> {
        match letter {
            'S' => Some(Specular::Any),
            'R' => Some(Specular::Reflection),
            'T' => Some(Specular::Transmission),
            _ => None,
        }
    }
}

/// The longest specular chain on one side of the diffuse vertex.
pub const MAX_CHAIN: usize = 14;

/// A chain of specular interactions, in the order of the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Chain {
    length: u8,
    letters: [Option<Specular>; MAX_CHAIN],
}

impl Chain {
    /// No specular interaction.
    pub const EMPTY: Self = Chain {
        length: 0,
        letters: [None; MAX_CHAIN],
    };

    /// `count` interactions of unspecified kind (at most [`MAX_CHAIN`]).
    pub const fn of(count: usize) -> Self {
        let count = if count > MAX_CHAIN { MAX_CHAIN } else { count };
        let mut chain = Chain::EMPTY;
        let mut i = 0;
        while i < count {
            chain.letters[i] = Some(Specular::Any);
            i += 1;
        }
        chain.length = count as u8;
        chain
    }

    /// Number of interactions.
    pub const fn len(&self) -> usize {
        self.length as usize
    }

    /// Whether there is none.
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// The interactions, in the order of the light.
    pub fn iter(&self) -> impl Iterator<Item = Specular> + '_ {
        self.letters.iter().flatten().copied()
    }

    /// The given interactions, of which the first [`MAX_CHAIN`] count.
    pub const fn of_kinds(kinds: &[Specular]) -> Self {
        let mut chain = Chain::of(kinds.len());
        let mut i = 0;
        while i < chain.len() {
            chain.letters[i] = Some(kinds[i]);
            i += 1;
        }
        chain
    }

    fn push(&mut self, s: Specular) -> bool {
        if self.len() == MAX_CHAIN {
            return false;
        }
        self.letters[self.len()] = Some(s);
        self.length += 1;
        true
    }
}

/// A path class `L S* D+ S* E`: the specular chain on the light's side, the diffuse interactions in the middle, and the
/// specular chain on the eye's side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PathClass {
    /// Specular interactions between the eye and the diffuse vertex (in the order of the light).
    pub eye: Chain,
    /// Specular interactions between the light and the diffuse vertex.
    pub light: Chain,
    /// Number of diffuse interactions in a row.
    pub diffuse: u8,
}

impl PathClass {
    /// Direct light.
    pub const LDE: Self = Self::new(0, 0);
    /// Caustic.
    pub const LSDE: Self = Self::new(1, 0);
    /// Direct light seen through one specular interaction.
    pub const LDSE: Self = Self::new(0, 1);
    /// Reflected caustic.
    pub const LSDSE: Self = Self::new(1, 1);

    /// `L S^light D S^eye E`.
    pub const fn new(light: usize, eye: usize) -> Self {
        PathClass {
            eye: Chain::of(eye),
            light: Chain::of(light),
            diffuse: 1,
        }
    }

    /// `L`, the given interactions, `DE`.
    pub const fn caustic(kinds: &[Specular]) -> Self {
        PathClass {
            eye: Chain::EMPTY,
            light: Chain::of_kinds(kinds),
            diffuse: 1,
        }
    }

    /// Number of edges from the light to the eye.
    pub const fn edges(&self) -> usize {
        self.light.len() + self.eye.len() + self.diffuse as usize + 1
    }

    /// Whether a light path of this class has a specular interaction before the diffuse vertex: a caustic.
    pub const fn is_caustic(&self) -> bool {
        !self.light.is_empty()
    }
}

impl fmt::Display for PathClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = String::from("L");
        text.extend(self.light.iter().map(Specular::letter));
        text.extend(core::iter::repeat_n('D', usize::from(self.diffuse)));
        text.extend(self.eye.iter().map(Specular::letter));
        text.push('E');
        f.pad(&text)
    }
}

/// The text is not a path class of the form `L S* D+ S* E`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotAPathClass(pub String);

impl fmt::Display for NotAPathClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "`{}` is not a path class: expected L, then any of S R T, then D, then any of S R T, then E",
            self.0
        )
    }
}

impl core::error::Error for NotAPathClass {}

impl FromStr for PathClass {
    type Err = NotAPathClass;

    fn from_str(text: &str) -> Result<Self, NotAPathClass> {
        let error = || NotAPathClass(text.to_owned());
        let inner = text
            .strip_prefix('L')
            .and_then(|t| t.strip_suffix('E'))
            .ok_or_else(error)?;
        let mut class = PathClass {
            eye: Chain::EMPTY,
            light: Chain::EMPTY,
            diffuse: 0,
        };
        let mut seen_specular_after_diffuse = false;
        for letter in inner.chars() {
            let ok = match (letter, Specular::from_letter(letter)) {
                ('D', _) => {
                    class.diffuse = class.diffuse.saturating_add(1);
                    !seen_specular_after_diffuse
                }
                (_, Some(s)) if class.diffuse == 0 => class.light.push(s),
                (_, Some(s)) => {
                    seen_specular_after_diffuse = true;
                    class.eye.push(s)
                }
                _ => false,
            };
            if !ok {
                return Err(error());
            }
        }
        if class.diffuse == 0 {
            Err(error())
        } else {
            Ok(class)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn display_and_parse_are_inverse() {
        for text in [
            "LDE", "LSDE", "LDSE", "LSDSE", "LSSDE", "LTTDE", "LTRTDE", "LRDE", "LDDE", "LSSSDSSE",
        ] {
            assert_eq!(text.parse::<PathClass>().unwrap().to_string(), text);
        }
        assert_eq!("LSDSE".parse::<PathClass>().unwrap(), PathClass::LSDSE);
    }

    #[test]
    fn what_is_not_a_class_is_refused() {
        for text in [
            "",
            "L",
            "LE",
            "LSE",
            "LSDSDE",
            "DE",
            "LXDE",
            "lsde",
            "LSSSSSSSSSSSSSSSDE",
        ] {
            assert!(text.parse::<PathClass>().is_err(), "{text}");
        }
    }

    #[test]
    fn kinds_of_interactions_are_told() {
        const R: Specular = Specular::Reflection;
        const T: Specular = Specular::Transmission;
        for (kinds, text) in [(&[][..], "LDE"), (&[R], "LRDE"), (&[T, R, R, T], "LTRRTDE")] {
            assert_eq!(PathClass::caustic(kinds).to_string(), text);
            assert_eq!(text.parse(), Ok(PathClass::caustic(kinds)));
        }
    }

    #[test]
    fn edges_are_counted() {
        assert_eq!(PathClass::LDE.edges(), 2);
        assert_eq!(PathClass::LSDSE.edges(), 4);
    }
}
