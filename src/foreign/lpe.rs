//! Light path expressions: which of a scene's path classes an expression stands for.
//!
//! An expression is a regular expression over the events of a path from the camera (`C`) to the light (`L`), in the notation
//! of [OSL]: an event is `<type scattering>`, with type `R` (reflection), `T` (transmission) or `.`, and scattering `D`
//! (diffuse), `G` (glossy), `S` (singular) or `.`; a lone `D`, `S`, `R`, `T` or `.` leaves the other open; `[..]` lists
//! alternatives, `[^..]` excludes, `(..|..)` groups, `*`, `+`, `?` and `{n}` repeat. `L`, `<L.>` and `O` end at a light: all
//! light comes from one. `C<RD>L` is `LDE`, `CS+DL` is direct light in a mirror.

use nephroid_analytic::class::{PathClass, Specular};

/// A parsed expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression(Node);

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Event(Event),
    Set(Vec<Event>, bool),
    Sequence(Vec<Node>),
    Either(Vec<Node>),
    Repeat(Box<Node>, usize, usize),
}

/// What an event may be; `None` is anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Event {
    kind: Option<char>,
    scattering: Option<char>,
}

/// An event of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Met {
    Camera,
    Light,
    Diffuse,
    Specular(Specular),
}

/// Repetitions that `*` and `+` may stand for: more than any path of a scene has.
const MANY: usize = 20;
/// Longer expressions are not read.
const LONGEST: usize = 128;
/// Groups in groups.
const DEEPEST: usize = 8;

impl Expression {
    /// Reads an expression; `None` for what is none.
    pub fn parse(text: &str) -> Option<Self> {
        let text: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
        let is_ended = text.last().is_some_and(|c| "LO>)".contains(*c));
        if text.len() > LONGEST || text.first() != Some(&'C') || !is_ended {
            return None;
        }
        let mut reader = Reader { text: &text, at: 0 };
        let node = reader.either(0)?;
        (reader.at == text.len()).then_some(Expression(node))
    }

    /// Whether paths of a class are among those it stands for.
    pub fn matches(&self, class: &PathClass) -> bool {
        let mut path = vec![Met::Camera];
        // Classes are written from the light, expressions from the camera.
        let eye: Vec<_> = class.eye.iter().collect();
        path.extend(eye.into_iter().rev().map(Met::Specular));
        path.extend(core::iter::repeat_n(
            Met::Diffuse,
            usize::from(class.diffuse),
        ));
        let light: Vec<_> = class.light.iter().collect();
        path.extend(light.into_iter().rev().map(Met::Specular));
        path.push(Met::Light);
        ends(&self.0, &path, &[0]).contains(&path.len())
    }
}

/// Where a match of a node may end, from any of some starts: sorted, without repetition, so that no expression takes long.
fn ends(node: &Node, path: &[Met], starts: &[usize]) -> Vec<usize> {
    let mut found: Vec<usize> = match node {
        Node::Event(event) => steps(path, starts, |m| event.admits(m)),
        Node::Set(events, excluded) => steps(path, starts, |m| {
            events.iter().any(|e| e.admits(m)) != *excluded
        }),
        Node::Sequence(nodes) => nodes
            .iter()
            .fold(starts.to_vec(), |at, n| ends(n, path, &at)),
        Node::Either(nodes) => nodes.iter().flat_map(|n| ends(n, path, starts)).collect(),
        Node::Repeat(inner, least, most) => {
            let mut at = starts.to_vec();
            let mut all = if *least == 0 { at.clone() } else { Vec::new() };
            for count in 1..=*most {
                at = ends(inner, path, &at);
                if at.is_empty() {
                    break;
                }
                if count >= *least {
                    all.extend(&at);
                }
            }
            all
        }
    };
    found.sort_unstable();
    found.dedup();
    found
}

fn steps(path: &[Met], starts: &[usize], admits: impl Fn(Met) -> bool) -> Vec<usize> {
    let step = |&s: &usize| (s < path.len() && admits(path[s])).then_some(s + 1);
    starts.iter().filter_map(step).collect()
}

impl Event {
    const ANY: Self = Event {
        kind: None,
        scattering: None,
    };

    fn of_letter(letter: char) -> Option<Self> {
        match letter {
            'C' | 'L' | 'O' => Some(Event {
                kind: Some(if letter == 'O' { 'L' } else { letter }),
                scattering: None,
            }),
            'R' | 'T' => Some(Event {
                kind: Some(letter),
                scattering: None,
            }),
            'D' | 'G' | 'S' => Some(Event {
                kind: None,
                scattering: Some(letter),
            }),
            '.' => Some(Event::ANY),
            _ => None,
        }
    }

    fn admits(self, met: Met) -> bool {
        let kind = match met {
            Met::Camera => Some('C'),
            Met::Light => Some('L'),
            Met::Diffuse | Met::Specular(Specular::Reflection) => Some('R'),
            Met::Specular(Specular::Transmission) => Some('T'),
            // Of a class that does not tell them apart either one is meant.
            Met::Specular(Specular::Any) => None,
        };
        let scattering = match met {
            Met::Diffuse => Some('D'),
            Met::Specular(_) => Some('S'),
            Met::Camera | Met::Light => None,
        };
        let is_end = matches!(met, Met::Camera | Met::Light);
        let kind_fits = match (self.kind, kind) {
            (Some(a), Some(b)) => a == b,
            (Some(a), None) => a == 'R' || a == 'T',
            // `.` is any scattering event; the ends are written out.
            (None, _) => !is_end,
        };
        let scattering_fits = match self.scattering {
            Some(a) => scattering == Some(a),
            None => true,
        };
        kind_fits && scattering_fits
    }
}

struct Reader<'a> {
    text: &'a [char],
    at: usize,
}

impl Reader<'_> {
    fn peek(&self) -> Option<char> {
        self.text.get(self.at).copied()
    }

    fn next(&mut self) -> Option<char> {
        let c = self.peek()?;
        self.at += 1;
        Some(c)
    }

    fn either(&mut self, depth: usize) -> Option<Node> {
        if depth > DEEPEST {
            return None;
        }
        let mut nodes = vec![self.sequence(depth)?];
        while self.peek() == Some('|') {
            self.at += 1;
            nodes.push(self.sequence(depth)?);
        }
        Some(Node::Either(nodes))
    }

    fn sequence(&mut self, depth: usize) -> Option<Node> {
        let mut nodes = Vec::new();
        while let Some(c) = self.peek().filter(|c| !"|)".contains(*c)) {
            self.at += 1;
            let node = match c {
                '(' => {
                    let inner = self.either(depth + 1)?;
                    (self.next()? == ')').then_some(inner)?
                }
                '[' => self.set()?,
                '<' => Node::Event(self.bracketed()?),
                letter => Node::Event(Event::of_letter(letter)?),
            };
            nodes.push(self.repeated(node)?);
        }
        (!nodes.is_empty()).then_some(Node::Sequence(nodes))
    }

    fn repeated(&mut self, node: Node) -> Option<Node> {
        let (least, most) = match self.peek() {
            Some('*') => (0, MANY),
            Some('+') => (1, MANY),
            Some('?') => (0, 1),
            Some('{') => {
                self.at += 1;
                let count = self.next()?.to_digit(10)? as usize;
                (self.peek()? == '}').then_some((count, count))?
            }
            _ => return Some(node),
        };
        self.at += 1;
        Some(Node::Repeat(Box::new(node), least, most))
    }

    fn set(&mut self) -> Option<Node> {
        let excluded = self.peek() == Some('^');
        if excluded {
            self.at += 1;
        }
        let mut events = Vec::new();
        loop {
            match self.next()? {
                ']' => break,
                '<' => events.push(self.bracketed()?),
                letter => events.push(Event::of_letter(letter)?),
            }
        }
        (!events.is_empty()).then_some(Node::Set(events, excluded))
    }

    /// `<RD>`, `<.S>`, `<L.>`; a third field, a label, is read over if it is open.
    fn bracketed(&mut self) -> Option<Event> {
        let open = |c: char| (c != '.').then_some(c);
        let kind = self.next().filter(|c| "RTLO.".contains(*c))?;
        let scattering = self.next().filter(|c| "DGS.".contains(*c))?;
        let mut end = self.next()?;
        if end == '.' {
            end = self.next()?;
        }
        (end == '>').then_some(Event {
            kind: open(if kind == 'O' { 'L' } else { kind }),
            scattering: open(scattering),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matched(expression: &str) -> Vec<&'static str> {
        let e = Expression::parse(expression).unwrap();
        ["LDE", "LSDE", "LDSE", "LSDSE", "LTTDE", "LRDE", "LDDE"]
            .into_iter()
            .filter(|c| e.matches(&c.parse().unwrap()))
            .collect()
    }

    #[test]
    fn expressions_stand_for_their_classes() {
        assert_eq!(matched("C<RD>L"), ["LDE"]);
        assert_eq!(matched("CDL"), ["LDE"]);
        assert_eq!(matched("CDS+L"), ["LSDE", "LTTDE", "LRDE"]);
        assert_eq!(matched("CD<T.>{2}L"), ["LTTDE"]);
        assert_eq!(matched("C<.S>+D<L.>"), ["LDSE"]);
        assert_eq!(matched("C[SG]+D[SG]+L"), ["LSDSE"]);
        assert_eq!(matched("C(S|D)DL"), ["LDSE", "LDDE"]);
        assert_eq!(matched("CD[^D]+L"), ["LSDE", "LTTDE", "LRDE"]);
        assert_eq!(matched("C.*<L.>").len(), 7);
        assert_eq!(matched("C<RS>DL"), ["LDSE"]);
        assert_eq!(matched("CGL"), [""; 0]);
    }

    #[test]
    fn what_is_none_is_not_read() {
        for text in [
            "", "C", "DL", "Combined", "Color", "C<", "C<RD", "C<XD>L", "C(D", "CD)L", "C[L",
            "C{9}", "C*{", "C[]L",
        ] {
            assert_eq!(Expression::parse(text), None, "{text}");
        }
        let nested = format!("C{}D{}L", "(".repeat(50), ")".repeat(50));
        assert_eq!(Expression::parse(&nested), None);
        // Exponential for an engine that tries one way after the other.
        let hard = format!("C{}L", "(.*)*".repeat(12));
        assert!(
            Expression::parse(&hard)
                .unwrap()
                .matches(&"LSSSDSSE".parse().unwrap())
        );
    }
}
