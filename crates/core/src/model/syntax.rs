//! The syntax tree of a model text.

use std::ops::Range;

use smol_str::SmolStr;

/// Bytes of the model text.
pub type Span = Range<usize>;

/// A name where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Name {
    pub text: String,
    pub span: Span,
}

/// One statement.
#[derive(Debug, Clone, PartialEq)]
pub enum Statement {
    /// `name = expression`
    Assign { name: Name, value: Expr },
    /// `name(parameters) = expression`
    Function {
        name: Name,
        parameters: Vec<Name>,
        body: Expr,
    },
    /// A bare expression: the value of a measurand.
    Value(Expr),
}

/// An expression and the text it came from.
#[derive(Debug, Clone, PartialEq)]
pub struct Expr {
    pub span: Span,
    pub node: Node,
}

/// Operators between two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Infix {
    Add,
    Sub,
    Mul,
    Div,
    Power,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

impl Infix {
    /// As it is printed, without spaces; also its name in the operation table.
    pub fn symbol(self) -> &'static str {
        match self {
            Infix::Add => "+",
            Infix::Sub => "-",
            Infix::Mul => "*",
            Infix::Div => "/",
            Infix::Power => "^",
            Infix::Less => "<",
            Infix::LessEqual => "<=",
            Infix::Greater => ">",
            Infix::GreaterEqual => ">=",
            Infix::Equal => "==",
            Infix::NotEqual => "!=",
            Infix::And => "and",
            Infix::Or => "or",
        }
    }

    /// Binding strength; a higher number binds tighter.
    pub fn level(self) -> u8 {
        match self {
            Infix::Or => 1,
            Infix::And => 2,
            Infix::Less
            | Infix::LessEqual
            | Infix::Greater
            | Infix::GreaterEqual
            | Infix::Equal
            | Infix::NotEqual => NOT + 1,
            Infix::Add | Infix::Sub => 5,
            Infix::Mul | Infix::Div => 6,
            Infix::Power => 8,
        }
    }

    /// Whether this compares two quantities.
    pub fn compares(self) -> bool {
        self.level() == Infix::Less.level()
    }
}

/// Binding strength of `not`.
pub const NOT: u8 = 3;
/// Binding strength of unary minus: between `*` and `^`, so that -x^2 is -(x^2).
pub const MINUS: u8 = 7;
/// Binding strength of names, numbers, calls and brackets.
pub const ATOM: u8 = 10;

/// What an expression is. A sum has thousands, of names most: what else is large is boxed.
#[derive(Debug, Clone, PartialEq)]
pub enum Node {
    /// A number as written, with its unit text if it has one.
    Number {
        value: f64,
        text: SmolStr,
        unit: Option<Box<UnitText>>,
    },
    /// A quoted unit by itself, allowed only where a function asks for one.
    Unit(Box<UnitText>),
    /// A name.
    Name(SmolStr),
    /// Operators of one level, applied from left to right: `a + b - c`.
    Chain {
        first: Box<Expr>,
        rest: Vec<(Infix, Expr)>,
    },
    /// `base ^ exponent`
    Power {
        base: Box<Expr>,
        exponent: Box<Expr>,
    },
    /// `-x`
    Minus(Box<Expr>),
    /// `not x`
    Not(Box<Expr>),
    /// `name(arguments)`
    Call {
        name: Box<Name>,
        arguments: Vec<Expr>,
    },
    /// `[a, b, c]`
    Vector(Vec<Expr>),
    /// `x[i]`
    Index { vector: Box<Expr>, index: Box<Expr> },
    /// `if c then a else b`, `if(c, a, b)`
    If {
        condition: Box<Expr>,
        yes: Box<Expr>,
        no: Box<Expr>,
    },
}

/// The text between the quotes of `25 'mm'`.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitText {
    pub text: String,
    /// Without the quotes.
    pub span: Span,
}

impl Expr {
    /// The parts of an expression, in the order of the text.
    pub fn children(&self) -> Vec<&Expr> {
        match &self.node {
            Node::Number { .. } | Node::Unit(_) | Node::Name(_) => Vec::new(),
            Node::Chain { first, rest } => std::iter::once(&**first)
                .chain(rest.iter().map(|(_, e)| e))
                .collect(),
            Node::Power {
                base: a,
                exponent: b,
            }
            | Node::Index {
                vector: a,
                index: b,
            } => vec![a, b],
            Node::Minus(a) | Node::Not(a) => vec![a],
            Node::Call { arguments, .. } => arguments.iter().collect(),
            Node::Vector(items) => items.iter().collect(),
            Node::If { condition, yes, no } => vec![condition, yes, no],
        }
    }

    /// Every name that occurs, whether as a value or as a called function, in the order of the text.
    pub fn names(&self) -> Vec<&str> {
        let mut found = Vec::new();
        let mut open = vec![self];
        while let Some(e) = open.pop() {
            match &e.node {
                Node::Name(name) => found.push(name.as_str()),
                Node::Call { name, .. } => found.push(name.text.as_str()),
                _ => {}
            }
            open.extend(e.children().into_iter().rev());
        }
        found
    }
}
