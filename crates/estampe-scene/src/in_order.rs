//! Items that several threads work on ahead, and that the calling thread takes in order.

use crate::Workers;
use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

impl Workers {
    /// Fills items one after the other with `next`, works on each of them on any thread, and takes
    /// them in order on the calling thread, which works too while the first item is not ready.
    ///
    /// `next` returns false after the last item. Items are few, and are used again with the
    /// contents that they had. The first error ends everything; an error of `next` comes after the
    /// items before it are taken.
    ///
    /// # Errors
    /// Those of `next` and `take`.
    pub fn in_order<T: Default + Send, E: Send>(
        self,
        mut next: impl FnMut(&mut T) -> Result<bool, E> + Send,
        work: impl Fn(&mut T) + Sync,
        mut take: impl FnMut(&mut T) -> Result<(), E>,
    ) -> Result<(), E> {
        if self.count() < 2 {
            let mut item = T::default();
            while next(&mut item)? {
                work(&mut item);
                take(&mut item)?;
            }
            return Ok(());
        }
        let line = Line {
            state: Mutex::new(State {
                next,
                end: None,
                first: 0,
                begun: VecDeque::new(),
                free: Vec::new(),
                is_stopped: false,
            }),
            changed: Condvar::new(),
            most: 2 * self.count(),
        };
        std::thread::scope(|scope| {
            // Ends the helpers, however this thread leaves.
            let _stop = Stop {
                line: &line,
                only_in_panic: false,
            };
            for _ in 1..self.count() {
                let help = || {
                    let _stop = Stop {
                        line: &line,
                        only_in_panic: true,
                    };
                    while let Some((number, mut item)) = line.begin() {
                        work(&mut item);
                        line.finish(number, item);
                    }
                };
                // If the system refuses a thread, the existing threads do the work.
                let _ = std::thread::Builder::new().spawn_scoped(scope, help);
            }
            loop {
                match line.step() {
                    Step::Take(mut item) => {
                        take(&mut item)?;
                        line.recycle(item);
                    }
                    Step::Work(number, mut item) => {
                        work(&mut item);
                        line.finish(number, item);
                    }
                    Step::End(result) => return result,
                }
            }
        })
    }
}

/// What the calling thread does next.
enum Step<T, E> {
    Take(T),
    Work(u64, T),
    End(Result<(), E>),
}

/// The items that are begun.
struct Line<T, E, N> {
    state: Mutex<State<T, E, N>>,
    /// An item is finished or taken, or all ends.
    changed: Condvar,
    /// The most items that are begun and not taken.
    most: usize,
}

struct State<T, E, N> {
    next: N,
    /// Set after the last item.
    end: Option<Result<(), E>>,
    /// The number of the first item in `begun`.
    first: u64,
    /// The items that are not taken; `None` while a thread works on one.
    begun: VecDeque<Option<T>>,
    /// Items that are used again.
    free: Vec<T>,
    is_stopped: bool,
}

impl<T: Default, E, N: FnMut(&mut T) -> Result<bool, E>> State<T, E, N> {
    /// The next item, if there is one.
    fn begin(&mut self, most: usize) -> Option<(u64, T)> {
        if self.begun.len() >= most || self.end.is_some() {
            return None;
        }
        let mut item = self.free.pop().unwrap_or_default();
        match (self.next)(&mut item) {
            Ok(true) => {
                let number = self.first + self.begun.len() as u64;
                self.begun.push_back(None);
                return Some((number, item));
            }
            Ok(false) => self.end = Some(Ok(())),
            Err(error) => self.end = Some(Err(error)),
        }
        None
    }
}

impl<T: Default, E, N: FnMut(&mut T) -> Result<bool, E>> Line<T, E, N> {
    /// The next item for a helper, once there is room for it; `None` after the last.
    fn begin(&self) -> Option<(u64, T)> {
        let mut state = self.lock();
        loop {
            if state.is_stopped || state.end.is_some() {
                return None;
            }
            if let Some(begun) = state.begin(self.most) {
                return Some(begun);
            }
            if state.end.is_some() {
                self.changed.notify_all();
                return None;
            }
            state = self.wait(state);
        }
    }

    /// The next step of the calling thread.
    fn step(&self) -> Step<T, E> {
        let mut state = self.lock();
        loop {
            // A helper that panics leaves its item unfinished; the scope hands the panic on.
            assert!(
                !state.is_stopped,
                "a thread that works on items has panicked"
            );
            if let Some(item) = state.begun.front_mut().and_then(Option::take) {
                state.begun.pop_front();
                state.first += 1;
                return Step::Take(item);
            }
            if let Some((number, item)) = state.begin(self.most) {
                return Step::Work(number, item);
            }
            if state.begun.is_empty()
                && let Some(end) = state.end.take()
            {
                return Step::End(end);
            }
            state = self.wait(state);
        }
    }

    fn finish(&self, number: u64, item: T) {
        let mut state = self.lock();
        let place = usize::try_from(number - state.first).unwrap_or(usize::MAX);
        if let Some(slot) = state.begun.get_mut(place) {
            *slot = Some(item);
        }
        drop(state);
        self.changed.notify_all();
    }
}

impl<T, E, N> Line<T, E, N> {
    fn recycle(&self, item: T) {
        self.lock().free.push(item);
        self.changed.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, State<T, E, N>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'s>(&self, state: MutexGuard<'s, State<T, E, N>>) -> MutexGuard<'s, State<T, E, N>> {
        let woken = self.changed.wait(state);
        woken.unwrap_or_else(PoisonError::into_inner)
    }
}

/// Ends all threads when it is dropped.
struct Stop<'l, T, E, N> {
    line: &'l Line<T, E, N>,
    only_in_panic: bool,
}

impl<T, E, N> Drop for Stop<'_, T, E, N> {
    fn drop(&mut self) {
        if !self.only_in_panic || std::thread::panicking() {
            self.line.lock().is_stopped = true;
            self.line.changed.notify_all();
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Workers;

    /// Squares the numbers up to `count` ahead; the error is the number that `take` refuses.
    fn squares(threads: usize, count: u64, refused: Option<u64>) -> (Vec<u64>, Result<(), u64>) {
        let mut number = 0;
        let mut taken = Vec::new();
        let result = Workers::new(threads).in_order(
            |item: &mut (u64, Vec<u64>)| {
                number += 1;
                item.0 = number;
                Ok(number <= count)
            },
            |(number, list)| list.push(*number * *number),
            |(number, list)| {
                taken.append(list);
                if refused == Some(*number) {
                    Err(*number)
                } else {
                    Ok(())
                }
            },
        );
        (taken, result)
    }

    #[test]
    fn items_are_taken_in_order_by_any_number_of_threads() {
        for threads in [1, 2, 3, 8] {
            for count in [0, 1, 2, 5, 1000] {
                let expected: Vec<u64> = (1..=count).map(|number| number * number).collect();
                assert_eq!(squares(threads, count, None), (expected, Ok(())));
            }
        }
    }

    #[test]
    fn the_first_error_ends_the_work() {
        for threads in [1, 2, 5] {
            let (taken, result) = squares(threads, 1000, Some(7));
            assert_eq!((taken.len(), result), (7, Err(7)), "{threads} threads");
        }
    }

    #[test]
    fn items_before_an_error_are_taken() {
        for threads in [1, 2, 5] {
            let mut number = 0;
            let mut taken = Vec::new();
            let result = Workers::new(threads).in_order(
                |item: &mut u32| {
                    number += 1;
                    *item = number;
                    if number == 20 {
                        Err("no more")
                    } else {
                        Ok(true)
                    }
                },
                |_| {},
                |&mut item| {
                    taken.push(item);
                    Ok(())
                },
            );
            assert_eq!(result, Err("no more"));
            assert!(taken.iter().copied().eq(1..20), "{taken:?}");
        }
    }

    #[test]
    fn a_panic_of_a_helper_is_handed_on() {
        for threads in [1, 2, 4] {
            let mut number = 0;
            let work = std::panic::AssertUnwindSafe(|| {
                Workers::new(threads).in_order(
                    |item: &mut u32| {
                        number += 1;
                        *item = number;
                        Ok::<bool, ()>(number < 50)
                    },
                    |&mut item| assert!(item != 30, "thirty"),
                    |_| Ok(()),
                )
            });
            assert!(std::panic::catch_unwind(work).is_err(), "{threads} threads");
        }
    }
}
