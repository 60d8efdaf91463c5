//! Integers as sums of indices of work-groups and invocations.

/// A number that is one in a whole dispatch: a constant, times a symbol if there is one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Coefficient {
    pub(super) factor: i64,
    pub(super) symbol: Option<Symbol>,
}

/// A number that a dispatch gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Symbol {
    /// The word at a byte offset of a buffer that is only read, by its position in the interface.
    Word { buffer: u32, offset: u32 },
    /// A word of the immediates.
    Immediate(u32),
    /// The elements of so many bytes that a buffer holds.
    Elements { buffer: u32, bytes: u32 },
    /// The work-groups along an axis.
    Workgroups(usize),
}

/// A number that differs between work-groups or invocations. The axis is x, y or z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Variable {
    /// The number of the work-group.
    Group(usize),
    /// The number of the invocation in its work-group.
    Local(usize),
    /// The number of the invocation among those of all work-groups.
    Global(usize),
    /// The column or row of the fragment's pixel.
    Pixel(usize),
}

/// The sum of variables times coefficients and of a number from `low` to `high`; modulo 2³² it is
/// the word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Form {
    pub(super) terms: Vec<(Variable, Coefficient)>,
    /// Numbers of the dispatch that are added, such as `width * 2`.
    pub(super) constants: Vec<Coefficient>,
    pub(super) low: i64,
    pub(super) high: i64,
    /// For each axis a number that the global index is below of.
    pub(super) bounds: [Option<Coefficient>; 3],
    /// Forms that are the word itself, and at most a number. Otherwise this form is wrong.
    pub(super) conditions: Vec<(Self, u32)>,
}

impl Coefficient {
    pub(super) fn number(factor: i64) -> Self {
        Self {
            factor,
            symbol: None,
        }
    }

    fn product(self, other: Self) -> Option<Self> {
        let symbol = match (self.symbol, other.symbol) {
            (Some(_), Some(_)) => return None,
            (one, other) => one.or(other),
        };
        let factor = self.factor.checked_mul(other.factor)?;
        Some(Self { factor, symbol })
    }
}

impl Form {
    /// A number in an interval.
    pub(super) fn interval(low: i64, high: i64) -> Self {
        Self {
            terms: Vec::new(),
            constants: Vec::new(),
            low,
            high,
            bounds: [None; 3],
            conditions: Vec::new(),
        }
    }

    /// Any word.
    pub(super) fn unknown() -> Self {
        Self::interval(0, i64::from(u32::MAX))
    }

    pub(super) fn variable(variable: Variable) -> Self {
        Self {
            terms: vec![(variable, Coefficient::number(1))],
            ..Self::interval(0, 0)
        }
    }

    pub(super) fn symbol(symbol: Symbol) -> Self {
        let coefficient = Coefficient {
            factor: 1,
            symbol: Some(symbol),
        };
        Self {
            constants: vec![coefficient],
            ..Self::interval(0, 0)
        }
    }

    /// The number, if it is one in the whole dispatch and has one part.
    pub(super) fn coefficient(&self) -> Option<Coefficient> {
        if !self.terms.is_empty() || self.low != self.high {
            return None;
        }
        match self.constants[..] {
            [] => Some(Coefficient::number(self.low)),
            [one] if self.low == 0 => Some(one),
            _ => None,
        }
    }

    /// The quotient of the length of a buffer.
    pub(super) fn divided_length(&self, divisor: i64) -> Option<Self> {
        let Coefficient { factor, symbol } = self.coefficient()?;
        let (1, Some(Symbol::Elements { buffer, bytes })) = (factor, symbol) else {
            return None;
        };
        let bytes = bytes.checked_mul(u32::try_from(divisor).ok()?)?;
        Some(Self::symbol(Symbol::Elements { buffer, bytes }))
    }

    /// The interval, if there is nothing else.
    pub(super) fn only_interval(&self) -> Option<[i64; 2]> {
        let is_plain = self.terms.is_empty() && self.constants.is_empty();
        is_plain.then_some([self.low, self.high])
    }

    /// The interval, if there is nothing else and the number is the word itself.
    pub(super) fn words(&self) -> Option<[i64; 2]> {
        let interval = self.only_interval()?;
        let is_word = |end: &i64| u32::try_from(*end).is_ok();
        interval.iter().all(is_word).then_some(interval)
    }

    /// The axis, if this is the number of the invocation along it among all work-groups.
    pub(super) fn global_axis(&self) -> Option<usize> {
        let is_plain = self.constants.is_empty() && self.low == 0 && self.high == 0;
        match self.terms[..] {
            [(Variable::Global(axis), one)] if is_plain && one == Coefficient::number(1) => {
                Some(axis)
            }
            _ => None,
        }
    }

    /// The sum; `None` if it cannot be told. `size` is that of a work-group.
    pub(super) fn sum(&self, other: &Self, size: [u32; 3]) -> Option<Self> {
        let mut sum = self.clone();
        sum.low = sum.low.checked_add(other.low)?;
        sum.high = sum.high.checked_add(other.high)?;
        for coefficient in &other.constants {
            add_to(&mut sum.constants, *coefficient)?;
        }
        for (variable, coefficient) in &other.terms {
            sum.add_term(*variable, *coefficient)?;
        }
        for condition in &other.conditions {
            if !sum.conditions.contains(condition) {
                sum.conditions.push(condition.clone());
            }
        }
        for (bound, of_other) in sum.bounds.iter_mut().zip(other.bounds) {
            *bound = bound.or(of_other);
        }
        sum.join(size);
        Some(sum)
    }

    fn add_term(&mut self, variable: Variable, coefficient: Coefficient) -> Option<()> {
        let like = |(one, before): &&mut (Variable, Coefficient)| {
            *one == variable && before.symbol == coefficient.symbol
        };
        if let Some((_, before)) = self.terms.iter_mut().find(like) {
            before.factor = before.factor.checked_add(coefficient.factor)?;
            self.terms
                .retain(|(_, coefficient)| coefficient.factor != 0);
        } else {
            self.terms.push((variable, coefficient));
        }
        Some(())
    }

    /// Finds global indices: c · size · group + c · local.
    fn join(&mut self, size: [u32; 3]) {
        for (axis, size) in size.into_iter().enumerate() {
            let local = self
                .terms
                .iter()
                .position(|(one, _)| *one == Variable::Local(axis));
            let group = self
                .terms
                .iter()
                .position(|(one, _)| *one == Variable::Group(axis));
            let (Some(local), Some(group)) = (local, group) else {
                continue;
            };
            let (of_local, of_group) = (self.terms[local].1, self.terms[group].1);
            let expected = of_local.product(Coefficient::number(i64::from(size)));
            if expected == Some(of_group) {
                self.terms.retain(|(one, _)| {
                    !matches!(one, Variable::Local(a) | Variable::Group(a) if *a == axis)
                });
                self.terms.push((Variable::Global(axis), of_local));
            }
        }
    }

    /// The lesser of this and a number, on the condition that it is this.
    pub(super) fn at_most(&self, limit: u32) -> Self {
        if let Some([_, high]) = self.words() {
            return if high <= i64::from(limit) {
                self.clone()
            } else {
                Self::interval(0, i64::from(limit))
            };
        }
        let mut form = self.clone();
        form.conditions.push((self.clone(), limit));
        form
    }

    /// The product with a number of the dispatch; `None` if it cannot be told.
    pub(super) fn product(&self, factor: Coefficient) -> Option<Self> {
        let mut product = self.clone();
        if factor.symbol.is_some() {
            // An interval times a number that is not known yet.
            if self.low != self.high {
                return None;
            }
            let constant = Coefficient::number(self.low).product(factor)?;
            product.low = 0;
            product.high = 0;
            for one in &mut product.constants {
                *one = one.product(factor)?;
            }
            if constant.factor != 0 {
                add_to(&mut product.constants, constant)?;
            }
        } else {
            let ends = [self.low, self.high].map(|end| end.checked_mul(factor.factor));
            let [Some(low), Some(high)] = ends else {
                return None;
            };
            product.low = low.min(high);
            product.high = low.max(high);
            for one in &mut product.constants {
                *one = one.product(factor)?;
            }
        }
        for (_, coefficient) in &mut product.terms {
            *coefficient = coefficient.product(factor)?;
        }
        product
            .terms
            .retain(|(_, coefficient)| coefficient.factor != 0);
        Some(product)
    }
}

fn add_to(constants: &mut Vec<Coefficient>, more: Coefficient) -> Option<()> {
    if let Some(before) = constants.iter_mut().find(|one| one.symbol == more.symbol) {
        before.factor = before.factor.checked_add(more.factor)?;
    } else {
        constants.push(more);
    }
    constants.retain(|one| one.factor != 0);
    Some(())
}
