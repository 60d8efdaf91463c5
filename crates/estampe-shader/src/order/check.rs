//! The forms of a dispatch: are the places of different work-groups different?

use super::analysis::{Accesses, OfBuffer, OfTexture};
use super::form::{Coefficient, Form, Symbol, Variable};
use estampe_types::Bindings;
use estampe_types::shader::WorkgroupOrder;

/// What a dispatch fixes.
struct Numbers<'a> {
    accesses: &'a Accesses,
    bindings: &'a Bindings,
    count: [u32; 3],
}

/// A form with numbers for all coefficients: the number of values of each variable and its weight,
/// for variables that differ between work-groups, and the interval of what is added.
struct Digits {
    /// Axis, number of values, weight.
    digits: Vec<(usize, u64, u64)>,
    low: i128,
    high: i128,
}

impl Accesses {
    /// The order in which the work-groups of a dispatch must run, so that its results do not
    /// depend on threads.
    #[must_use]
    pub fn order(&self, bindings: &Bindings, count: [u32; 3]) -> WorkgroupOrder {
        let numbers = Numbers {
            accesses: self,
            bindings,
            count,
        };
        if count.iter().all(|side| *side <= 1) {
            return WorkgroupOrder::Free;
        }
        let buffers = self.buffers.iter().filter(|buffer| buffer.is_stored);
        let textures = self.textures.iter().filter(|texture| texture.is_stored);
        let is_free = !numbers.has_aliases()
            && buffers
                .into_iter()
                .all(|buffer| numbers.is_buffer_free(buffer))
            && textures
                .into_iter()
                .all(|texture| numbers.is_texture_free(texture));
        if is_free {
            WorkgroupOrder::Free
        } else {
            WorkgroupOrder::InOrder
        }
    }
}

impl Accesses {
    /// True if what a fragment shader stores does not depend on the order of different pixels:
    /// texels at the fragment's own pixel, and sums whose terms nobody sees. Aliases of a texture
    /// are the same texels at the same pixel.
    #[must_use]
    pub fn is_free_of_pixels(&self) -> bool {
        let is_pixel = |form: &Form, axis: usize| *form == Form::variable(Variable::Pixel(axis));
        let is_own = |forms: &Vec<Form>| {
            forms.len() >= 2 && is_pixel(&forms[0], 0) && is_pixel(&forms[1], 1)
        };
        let buffers = self.buffers.iter().filter(|buffer| buffer.is_stored);
        let textures = self.textures.iter().filter(|texture| texture.is_stored);
        buffers.into_iter().all(|buffer| buffer.is_sum())
            && textures
                .into_iter()
                .all(|texture| texture.forms.iter().all(is_own))
    }
}

impl OfBuffer {
    /// Only added to, and so on, by operations whose results are not used.
    fn is_sum(&self) -> bool {
        !self.others && self.atomics.len() == 1
    }
}

impl Numbers<'_> {
    /// True if the shader knows a buffer or texture that it writes by several names.
    fn has_aliases(&self) -> bool {
        let buffers: Vec<_> = self
            .accesses
            .buffers
            .iter()
            .filter_map(|buffer| self.bindings.storage_buffer(buffer.place.0, buffer.place.1))
            .map(|(buffer, _)| buffer)
            .collect();
        let textures: Vec<_> = self
            .accesses
            .textures
            .iter()
            .filter_map(|texture| {
                let (group, binding) = texture.place;
                self.bindings.storage_texture(group, binding)
            })
            .collect();
        let twice = |at: usize, is_same: &dyn Fn(usize) -> bool| (0..at).any(is_same);
        (0..buffers.len()).any(|at| twice(at, &|other| buffers[at].is_same(buffers[other])))
            || (0..textures.len())
                .any(|at| twice(at, &|other| textures[at].is_same(textures[other])))
    }

    fn is_buffer_free(&self, buffer: &OfBuffer) -> bool {
        if buffer.is_sum() {
            return true;
        }
        let determined = self.determined(&buffer.forms);
        determined.is_some_and(|axes| self.are_all(axes))
    }

    fn is_texture_free(&self, texture: &OfTexture) -> bool {
        let parts = texture.forms.iter().map(Vec::len).max().unwrap_or(0);
        let mut axes = [false; 3];
        for part in 0..parts {
            let forms: Option<Vec<Form>> = texture
                .forms
                .iter()
                .map(|forms| forms.get(part).cloned())
                .collect();
            let determined = forms.and_then(|forms| self.determined(&forms));
            for axis in 0..3 {
                axes[axis] |= determined.is_some_and(|determined| determined[axis]);
            }
        }
        self.are_all(axes)
    }

    /// True if work-groups differ in no other axis.
    fn are_all(&self, axes: [bool; 3]) -> bool {
        axes.iter()
            .zip(self.count)
            .all(|(is, count)| *is || count <= 1)
    }

    /// The axes along which work-groups have different places, if all forms are alike: numbers in
    /// mixed radix.
    fn determined(&self, forms: &[Form]) -> Option<[bool; 3]> {
        let mut all: Option<Digits> = None;
        for form in forms {
            let mut digits = self.digits(form)?;
            digits
                .digits
                .sort_by_key(|(axis, _, weight)| (*weight, *axis));
            all = Some(match all {
                None => digits,
                Some(mut before) => {
                    if before.digits.len() != digits.digits.len() {
                        return None;
                    }
                    for (a, b) in before.digits.iter_mut().zip(&digits.digits) {
                        if (a.0, a.2) != (b.0, b.2) {
                            return None;
                        }
                        a.1 = a.1.max(b.1);
                    }
                    before.low = before.low.min(digits.low);
                    before.high = before.high.max(digits.high);
                    before
                }
            });
        }
        let all = all?;
        let mut reach = u128::try_from(all.high - all.low).ok()? + 1;
        let mut axes = [false; 3];
        for (axis, values, weight) in all.digits {
            if u128::from(weight) < reach {
                return None;
            }
            reach += u128::from(weight) * u128::from(values.saturating_sub(1));
            axes[axis] = true;
        }
        // Words are numbers modulo 2³².
        (reach <= 1 << 32).then_some(axes)
    }

    fn digits(&self, form: &Form) -> Option<Digits> {
        for (form, limit) in &form.conditions {
            let Digits { digits, low, high } = self.digits(form)?;
            let reaches = digits.iter().map(|(_, values, weight)| {
                i128::from(values.saturating_sub(1)) * i128::from(*weight)
            });
            if low < 0 || high + reaches.sum::<i128>() > i128::from(*limit) {
                return None;
            }
        }
        let mut digits = Digits {
            digits: Vec::new(),
            low: i128::from(form.low),
            high: i128::from(form.high),
        };
        for constant in &form.constants {
            let number = self.number(*constant)?;
            digits.low += number;
            digits.high += number;
        }
        let size = self.accesses.size;
        for (variable, coefficient) in &form.terms {
            let weight = self.number(*coefficient)?;
            let (axis, values, is_of_groups) = match *variable {
                Variable::Local(axis) => (axis, u64::from(size[axis]), false),
                Variable::Group(axis) => (axis, u64::from(self.count[axis]), true),
                Variable::Pixel(_) => return None,
                Variable::Global(axis) => {
                    let all = u64::from(self.count[axis]) * u64::from(size[axis]);
                    let bound = form.bounds[axis].map(|bound| self.number(bound));
                    let bound = match bound {
                        Some(bound) => u64::try_from(bound?).unwrap_or(u64::MAX),
                        None => u64::MAX,
                    };
                    (axis, all.min(bound), true)
                }
            };
            let reach = weight.checked_mul(i128::from(values.saturating_sub(1)))?;
            if is_of_groups && self.count[axis] > 1 {
                if weight < 0 {
                    digits.low += reach;
                    digits.high += reach;
                }
                let weight = u64::try_from(weight.unsigned_abs()).ok()?;
                if digits.digits.iter().any(|(one, ..)| *one == axis) {
                    return None;
                }
                digits.digits.push((axis, values, weight));
            } else {
                digits.low += reach.min(0);
                digits.high += reach.max(0);
            }
        }
        Some(digits)
    }

    fn number(&self, coefficient: Coefficient) -> Option<i128> {
        let word = match coefficient.symbol {
            None => 1,
            Some(Symbol::Workgroups(axis)) => i128::from(self.count[axis]),
            Some(Symbol::Immediate(at)) => {
                i128::from(self.bindings.immediate_words::<1>(at as usize)[0])
            }
            Some(Symbol::Word { buffer, offset }) => {
                let (group, binding) = self.accesses.buffers.get(buffer as usize)?.place;
                i128::from(self.bindings.u32s::<1>(group, binding, offset)[0])
            }
            Some(Symbol::Elements { buffer, bytes }) => {
                let (group, binding) = self.accesses.buffers.get(buffer as usize)?.place;
                let read = self.bindings.buffer(group, binding).map(|(_, range)| range);
                let written = self.bindings.storage_buffer(group, binding);
                let range = read.or(written.map(|(_, range)| range))?;
                i128::try_from(range.len()).ok()? / i128::from(bytes)
            }
        };
        Some(i128::from(coefficient.factor) * word)
    }
}
