//! Tokens of a schedule expression, each with its column.

use super::expression::ParseError;
use super::number::Number;

/// What a token is.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    Number(Number),
    Name(String),
    /// One of `+ - * / ^ ( ) ,`.
    Sign(char),
    End,
}

/// A token and the column of its first character, from 1.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) column: usize,
    pub(super) text: String,
}

/// A longer expression is refused: its tree could exhaust the stack.
const MOST_TOKENS: usize = 1000;

/// Splits a text into tokens, of which the last one is [`Kind::End`].
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, ParseError> {
    let characters: Vec<char> = text.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < characters.len() {
        let start = at;
        let c = characters[at];
        let kind = if c.is_whitespace() {
            at += 1;
            continue;
        } else if c.is_ascii_digit() || c == '.' {
            at = end_of_number(&characters, at);
            let text: String = characters[start..at].iter().collect();
            let number = Number::decimal(&text).filter(|n| n.value().is_finite());
            Kind::Number(number.ok_or_else(|| {
                ParseError::new(start + 1, format!("`{text}`"), "a finite decimal number")
            })?)
        } else if c.is_ascii_alphabetic() {
            while at < characters.len()
                && (characters[at].is_ascii_alphanumeric() || characters[at] == '_')
            {
                at += 1;
            }
            Kind::Name(characters[start..at].iter().collect())
        } else if "+-*/^(),".contains(c) {
            at += 1;
            Kind::Sign(c)
        } else {
            let expected = "a number, n, a function, or one of + - * / ^ ( ) ,";
            return Err(ParseError::new(start + 1, format!("`{c}`"), expected));
        };
        found.push(Token {
            kind,
            column: start + 1,
            text: characters[start..at].iter().collect(),
        });
        if found.len() > MOST_TOKENS {
            return Err(ParseError::new(
                start + 1,
                "a long expression".to_owned(),
                "at most 1000 numbers, names and signs",
            ));
        }
    }
    found.push(Token {
        kind: Kind::End,
        column: characters.len() + 1,
        text: String::new(),
    });
    Ok(found)
}

/// Digits, a point, digits, and an exponent if digits follow its letter.
fn end_of_number(characters: &[char], start: usize) -> usize {
    let digits = |mut at: usize| {
        while characters.get(at).is_some_and(char::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let mut at = digits(start);
    if characters.get(at) == Some(&'.') {
        at = digits(at + 1);
    }
    if matches!(characters.get(at), Some('e' | 'E')) {
        let sign = usize::from(matches!(characters.get(at + 1), Some('+' | '-')));
        let end = digits(at + 1 + sign);
        if end > at + 1 + sign {
            at = end;
        }
    }
    at
}
