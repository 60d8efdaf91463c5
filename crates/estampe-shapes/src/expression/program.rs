//! Programs: an expression in postfix order, run on a stack.

use super::function::{Function, Pair, apply_integer_power};
use super::number::Number;

/// A step of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Constant(f64),
    Variable(u8),
    Negate,
    Apply(Function),
    Combine(Pair),
    /// Raises to a constant power.
    IntegerPower(i32),
}

/// The steps of an expression. They leave exactly one number on the stack.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Program {
    steps: Vec<Step>,
    /// Numbers on the stack after all steps so far.
    height: usize,
    /// A bit for each variable that a step reads, or read before it was found to be constant.
    used: u32,
}

/// The exponents that are computed by multiplication. Larger ones would sum up more rounding than
/// `libm::pow` has.
const MAX_INTEGER_POWER: i32 = 16;

/// The most numbers on the stack.
const MAX_HEIGHT: usize = 48;

impl Program {
    pub(super) fn uses(&self, variable: usize) -> bool {
        variable < 32 && self.used >> variable & 1 == 1
    }

    /// Appends a number; `false` if the stack is full.
    pub(super) fn push(&mut self, step: Step) -> bool {
        if let Step::Variable(variable) = step {
            self.used |= 1 << variable;
        }
        self.steps.push(step);
        self.height += 1;
        self.height <= MAX_HEIGHT
    }

    /// Appends a step that replaces the number on top.
    pub(super) fn replace(&mut self, step: Step) {
        match self.steps.last() {
            Some(&Step::Constant(value)) => {
                let result = run_steps(&[Step::Constant(value), step], &[] as &[f64]);
                self.steps.pop();
                self.steps.push(Step::Constant(result));
            }
            _ => self.steps.push(step),
        }
    }

    /// Appends a step that replaces the two numbers on top by one.
    pub(super) fn combine(&mut self, pair: Pair) {
        self.height -= 1;
        let exponent = match self.steps.last() {
            Some(&Step::Constant(exponent)) if pair == Pair::Power => small_integer(exponent),
            _ => None,
        };
        if let Some(exponent) = exponent {
            self.steps.pop();
            return self.replace(Step::IntegerPower(exponent));
        }
        if let &[.., Step::Constant(a), Step::Constant(b)] = &self.steps[..] {
            self.steps.truncate(self.steps.len() - 2);
            self.steps.push(Step::Constant(pair.apply(a, b)));
        } else {
            self.steps.push(Step::Combine(pair));
        }
    }

    /// The program of `self − other`; `None` if the stack is too small.
    pub(super) fn minus(mut self, other: Self) -> Option<Self> {
        let highest = 1 + other.steps.iter().fold((0_usize, 0), highest_after).1;
        self.steps.extend(other.steps);
        self.used |= other.used;
        self.height += 1;
        self.combine(Pair::Subtract);
        (highest <= MAX_HEIGHT).then_some(self)
    }

    /// Runs the program.
    pub(super) fn run<N: Number>(&self, arguments: &[N]) -> N {
        run_steps(&self.steps, arguments)
    }
}

/// The height of the stack and the greatest height so far, after one more step.
fn highest_after((height, highest): (usize, usize), step: &Step) -> (usize, usize) {
    let height = match step {
        Step::Constant(_) | Step::Variable(_) => height + 1,
        Step::Combine(_) => height.saturating_sub(1),
        Step::Negate | Step::Apply(_) | Step::IntegerPower(_) => height,
    };
    (height, highest.max(height))
}

/// The exponent, if it is an integer for which multiplication is used.
fn small_integer(exponent: f64) -> Option<i32> {
    (-MAX_INTEGER_POWER..=MAX_INTEGER_POWER).find(|&n| f64::from(n) == exponent)
}

fn run_steps<N: Number>(steps: &[Step], arguments: &[N]) -> N {
    let mut stack = [N::constant(f64::NAN); MAX_HEIGHT];
    let mut height = 0;
    for step in steps {
        match *step {
            Step::Constant(value) => {
                stack[height] = N::constant(value);
                height += 1;
            }
            Step::Variable(variable) => {
                let argument = arguments.get(usize::from(variable));
                stack[height] = argument.copied().unwrap_or(N::constant(f64::NAN));
                height += 1;
            }
            Step::Negate => stack[height - 1] = stack[height - 1].negated(),
            Step::Apply(function) => stack[height - 1] = function.apply(stack[height - 1]),
            Step::IntegerPower(n) => {
                stack[height - 1] = apply_integer_power(stack[height - 1], n);
            }
            Step::Combine(pair) => {
                height -= 1;
                stack[height - 1] = pair.apply(stack[height - 1], stack[height]);
            }
        }
    }
    stack[0]
}
