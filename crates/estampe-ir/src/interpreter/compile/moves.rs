//! Moves that happen at once, as moves that happen one after the other.

use std::collections::HashMap;
use std::hash::Hash;

/// Puts the moves `(to, from)` in an order in which nothing is overwritten before it is moved.
/// Cycles are broken by a new place. No two moves have the same `to`.
pub(super) fn sequence<T, P>(moves: Vec<(T, P)>, mut new: impl FnMut() -> P) -> Vec<(P, P)>
where
    T: Into<P>,
    P: Copy + Eq + Hash,
{
    let moves = moves.into_iter().map(|(to, from)| (to.into(), from));
    let mut from_of: HashMap<P, P> = HashMap::new();
    let mut order = Vec::new();
    let mut readers: HashMap<P, usize> = HashMap::new();
    for (to, from) in moves {
        if to != from {
            from_of.insert(to, from);
            order.push(to);
            *readers.entry(from).or_default() += 1;
        }
    }
    let is_free = |to: &P| !readers.contains_key(to);
    let mut free: Vec<P> = order.iter().copied().filter(is_free).collect();
    let mut done = Vec::new();
    let mut rest = order.into_iter();
    loop {
        while let Some(to) = free.pop() {
            let Some(from) = from_of.remove(&to) else {
                continue;
            };
            done.push((to, from));
            let left = readers.entry(from).or_insert(1);
            *left -= 1;
            if *left == 0 && from_of.contains_key(&from) {
                free.push(from);
            }
        }
        // What is left are cycles: the old word of one place is kept elsewhere.
        let Some(to) = rest.find(|to| from_of.contains_key(to)) else {
            return done;
        };
        let kept = new();
        done.push((kept, to));
        for from in from_of.values_mut() {
            if *from == to {
                *from = kept;
            }
        }
        readers.remove(&to);
        free.push(to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_in_order_do_what_moves_at_once_do() {
        let mut random = fastrand::Rng::with_seed(7);
        let mut cycles = 0;
        for _ in 0..2000 {
            let places = random.usize(1..8);
            let mut targets: Vec<usize> = (0..places).collect();
            random.shuffle(&mut targets);
            targets.truncate(random.usize(0..=places));
            let moves: Vec<(usize, usize)> = targets
                .into_iter()
                .map(|to| (to, random.usize(0..places)))
                .collect();
            let before: Vec<usize> = (100..100 + places).collect();
            let mut at_once = before.clone();
            for &(to, from) in &moves {
                at_once[to] = before[from];
            }
            let mut next = places;
            let ordered = sequence(moves, || {
                next += 1;
                next - 1
            });
            cycles += next - places;
            let mut one_by_one = before;
            one_by_one.resize(next, 0);
            for (to, from) in ordered {
                one_by_one[to] = one_by_one[from];
            }
            assert_eq!(one_by_one[..places], at_once);
        }
        assert!(cycles > 100);
    }
}
