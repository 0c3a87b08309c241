//! Precedence climbing: `+ -` before `* /` before a sign before `^`, which groups to the right.

use super::expression::{Function, Node, Operation, ParseError, Term};
use super::number::Number;
use super::token::{Kind, Token, tokens};

/// Nested deeper than this, an expression is refused: its tree could exhaust the stack.
const DEEPEST: usize = 100;

const OPERAND: &str = "a number, n, a function, a sign or `(`";

struct Parser {
    tokens: Vec<Token>,
    at: usize,
    depth: usize,
}

/// Reads a whole text.
pub(super) fn parse(text: &str) -> Result<Node, ParseError> {
    let mut parser = Parser {
        tokens: tokens(text)?,
        at: 0,
        depth: 0,
    };
    let node = parser.expression(0)?;
    match parser.next().kind {
        Kind::End => Ok(node),
        _ => Err(parser.unexpected("an operator or the end of the expression")),
    }
}

impl Parser {
    fn next(&self) -> &Token {
        // The last token is the end, beyond which nothing reads.
        &self.tokens[self.at.min(self.tokens.len() - 1)]
    }

    fn unexpected(&self, expected: &str) -> ParseError {
        let token = self.next();
        let found = match token.kind {
            Kind::End => "the end of the expression".to_owned(),
            _ => format!("`{}`", token.text),
        };
        ParseError::new(token.column, found, expected)
    }

    fn sign(&self) -> Option<char> {
        match self.next().kind {
            Kind::Sign(c) => Some(c),
            _ => None,
        }
    }

    fn expression(&mut self, least: u8) -> Result<Node, ParseError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.unexpected("at most 100 levels of nesting"));
        }
        let mut left = self.operand()?;
        while let Some((operation, left_power, right_power)) = self.sign().and_then(binding) {
            if left_power < least {
                break;
            }
            let column = self.next().column;
            self.at += 1;
            let right = self.expression(right_power)?;
            left = Node {
                column,
                term: Term::Binary(operation, Box::new(left), Box::new(right)),
            };
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operand(&mut self) -> Result<Node, ParseError> {
        let token = self.next().clone();
        let node = |term| Node {
            column: token.column,
            term,
        };
        match token.kind {
            Kind::Number(number) => {
                self.at += 1;
                Ok(node(Term::Constant(number)))
            }
            Kind::Name(name) => self.name(&name, token.column),
            Kind::Sign('(') => {
                self.at += 1;
                let inner = self.expression(0)?;
                self.close("an operator or `)`")?;
                Ok(inner)
            }
            Kind::Sign('-') => {
                self.at += 1;
                let inner = self.expression(SIGN)?;
                Ok(node(Term::Negated(Box::new(inner))))
            }
            Kind::Sign('+') => {
                self.at += 1;
                self.expression(SIGN)
            }
            _ => Err(self.unexpected(OPERAND)),
        }
    }

    fn name(&mut self, name: &str, column: usize) -> Result<Node, ParseError> {
        let constant = match name {
            "n" => Some(Term::Index),
            "e" => Some(Term::Constant(Number::inexact(core::f64::consts::E))),
            "pi" => Some(Term::Constant(Number::inexact(core::f64::consts::PI))),
            _ => None,
        };
        if let Some(term) = constant {
            self.at += 1;
            return Ok(Node { column, term });
        }
        let Some(function) = Function::named(name) else {
            let known = format!("n, e, pi or one of {}", Function::names());
            return Err(self.unexpected(&known));
        };
        self.at += 1;
        if self.sign() != Some('(') {
            return Err(self.unexpected(&format!("`(` after `{name}`")));
        }
        self.at += 1;
        let mut arguments = vec![self.expression(0)?];
        while self.sign() == Some(',') {
            if arguments.len() == function.arguments().1 {
                return Err(self.unexpected(&format!("`)`: {}", function.usage())));
            }
            self.at += 1;
            arguments.push(self.expression(0)?);
        }
        if arguments.len() < function.arguments().0 {
            return Err(self.unexpected(&format!("`,`: {}", function.usage())));
        }
        self.close("an operator, `,` or `)`")?;
        function.check(&arguments)?;
        Ok(Node {
            column,
            term: Term::Call(function, arguments),
        })
    }

    fn close(&mut self, expected: &str) -> Result<(), ParseError> {
        if self.sign() != Some(')') {
            return Err(self.unexpected(expected));
        }
        self.at += 1;
        Ok(())
    }
}

/// A sign binds what multiplies, not what adds: -n^2 is -(n^2).
const SIGN: u8 = 5;

/// An operator and how strongly it binds to the left and to the right.
fn binding(sign: char) -> Option<(Operation, u8, u8)> {
    Some(match sign {
        '+' => (Operation::Add, 1, 2),
        '-' => (Operation::Subtract, 1, 2),
        '*' => (Operation::Multiply, 3, 4),
        '/' => (Operation::Divide, 3, 4),
        '^' => (Operation::Power, 8, 7),
        _ => return None,
    })
}
