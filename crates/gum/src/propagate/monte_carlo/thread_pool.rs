//! Threads that share the work of a run.
//!
//! To start a thread, or to wake one that sleeps, takes as long as to draw some ten thousand trials. A run
//! has many parts, with little to do between them. Its threads therefore stay until it ends, and look for
//! further work for a moment before they sleep.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, RecvError, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, yield_now};
use std::time::{Duration, Instant};

/// How long a thread looks for further work before it sleeps: longer than what one thread mostly does between the
/// parts of a run.
const PATIENCE: Duration = Duration::from_micros(300);

/// What a helper is asked to do.
type Job<'env> = Box<dyn FnOnce() + Send + 'env>;

/// The thread that calls, and helpers that work on things that outlive them all.
pub(super) struct ThreadPool<'env> {
    helpers: RefCell<Vec<Sender<Job<'env>>>>,
}

impl<'env> ThreadPool<'env> {
    /// Does something with a pool of so many threads, that of the caller included; of fewer where there are fewer
    /// tasks at a time, or where the system gives no more.
    pub(super) fn with<R>(
        threads: usize,
        tasks: u64,
        run: impl FnOnce(&ThreadPool<'env>) -> R,
    ) -> R {
        let threads = usize::try_from(tasks).map_or(threads, |tasks| threads.min(tasks));
        std::thread::scope(|scope| {
            let helper = |_| {
                let (sender, jobs) = channel::<Job<'env>>();
                let work = move || {
                    while let Ok(job) = soon(&jobs) {
                        job();
                    }
                };
                let started = Builder::new().spawn_scoped(scope, work);
                started.ok().map(|_| sender)
            };
            let helpers = (1..threads).map_while(helper).collect();
            run(&ThreadPool {
                helpers: RefCell::new(helpers),
            })
        })
    }

    /// How many threads there are.
    pub(super) fn threads(&self) -> usize {
        self.helpers.borrow().len() + 1
    }

    /// Lets the helpers go, so that nobody has to wait for them at the end. Further tasks are left to the caller.
    pub(super) fn dismiss(&self) {
        self.helpers.borrow_mut().clear();
    }

    /// Asks the helpers for `task` of every item. Each of them begins with a seed, for as many as there are seeds, and
    /// makes a scratch space of it. The caller goes on at once.
    pub(super) fn start<I, D, W, T, R>(
        &self,
        items: Vec<I>,
        seeds: impl Iterator<Item = D>,
        begin: impl Fn(D) -> W + Send + Sync + 'env,
        task: impl Fn(&mut W, I) -> T + Send + Sync + 'env,
        finish: impl Fn(W) -> R + Send + Sync + 'env,
    ) -> Started<'env, D, T, R>
    where
        I: Send + 'env,
        D: Send + 'env,
        T: Send + 'env,
        R: Send + 'env,
    {
        let queue = Mutex::new(items.into_iter().enumerate());
        let work: Work<'env, D, T, R> = Arc::new(move |seed: D| {
            let mut scratch = begin(seed);
            let mut done = Vec::new();
            loop {
                // Whoever panics while taking an item leaves the queue consistent.
                let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
                let Some((index, item)) = next else { break };
                done.push((index, task(&mut scratch, item)));
            }
            (done, finish(scratch))
        });
        let (sender, results) = channel();
        for (helper, seed) in self.helpers.borrow().iter().zip(seeds) {
            let (work, sender) = (Arc::clone(&work), sender.clone());
            let job = move || {
                let result = catch_unwind(AssertUnwindSafe(|| work(seed)));
                // Nobody waits for it where the caller has panicked.
                let _ = sender.send(result);
            };
            // A helper is there as long as its pool.
            let _ = helper.send(Box::new(job));
        }
        Started { work, results }
    }

    /// `task` of every item, by the helpers and the caller. Each thread that is needed begins with a `seed`, and makes
    /// a scratch space of it. Results in the order of the items, and what `finish` makes of the scratch spaces in no
    /// order.
    pub(super) fn map<I, D, W, T, R>(
        &self,
        items: Vec<I>,
        mut seed: impl FnMut() -> D,
        begin: impl Fn(D) -> W + Send + Sync + 'env,
        task: impl Fn(&mut W, I) -> T + Send + Sync + 'env,
        finish: impl Fn(W) -> R + Send + Sync + 'env,
    ) -> (Vec<T>, Vec<R>)
    where
        I: Send + 'env,
        D: Send + 'env,
        T: Send + 'env,
        R: Send + 'env,
    {
        let others = items.len().saturating_sub(1);
        let seeds = std::iter::repeat_with(&mut seed).take(others);
        let started = self.start(items, seeds, begin, task, finish);
        started.join(seed())
    }
}

/// Results with the numbers of their items, and what became of a scratch space.
type Done<T, R> = (Vec<(usize, T)>, R);

/// What a thread does with a seed, until no item is left.
type Work<'env, D, T, R> = Arc<dyn Fn(D) -> Done<T, R> + Send + Sync + 'env>;

/// What helpers have been asked for.
pub(super) struct Started<'env, D, T, R> {
    work: Work<'env, D, T, R>,
    results: Receiver<std::thread::Result<Done<T, R>>>,
}

impl<D, T, R> Started<'_, D, T, R> {
    /// Takes part, with a seed, and waits for the others. Results as of [`ThreadPool::map`].
    pub(super) fn join(self, seed: D) -> (Vec<T>, Vec<R>) {
        let own = (self.work)(seed);
        self.wait_with(Some(own))
    }

    /// Waits for the helpers, of which at least one must have been asked if there were items. Results as of
    /// [`ThreadPool::map`].
    pub(super) fn wait(self) -> (Vec<T>, Vec<R>) {
        self.wait_with(None)
    }

    fn wait_with(self, own: Option<Done<T, R>>) -> (Vec<T>, Vec<R>) {
        let mut all: Vec<Done<T, R>> = own.into_iter().collect();
        while let Ok(result) = soon(&self.results) {
            all.push(result.unwrap_or_else(|panic| resume_unwind(panic)));
        }
        let (done, rest): (Vec<Vec<_>>, Vec<R>) = all.into_iter().unzip();
        let mut done: Vec<(usize, T)> = done.into_iter().flatten().collect();
        done.sort_unstable_by_key(|(index, _)| *index);
        (done.into_iter().map(|(_, result)| result).collect(), rest)
    }
}

/// `task` of every item on several threads, each with a scratch space; results in the order of the
/// items, and what `finish` makes of the scratch spaces in no order.
pub(crate) fn parallel_map<I: Send, W, T: Send, R: Send>(
    items: Vec<I>,
    threads: usize,
    scratch: impl Fn() -> W + Send + Sync,
    task: impl Fn(&mut W, I) -> T + Send + Sync,
    finish: impl Fn(W) -> R + Send + Sync,
) -> (Vec<T>, Vec<R>) {
    ThreadPool::with(threads, items.len() as u64, |pool| {
        pool.map(items, || (), |()| scratch(), task, finish)
    })
}

/// What comes next; an error where nothing will.
fn soon<T>(receiver: &Receiver<T>) -> Result<T, RecvError> {
    // Where there are no threads there may be no clock either, and nobody to wait for.
    let mut start = None;
    loop {
        match receiver.try_recv() {
            Ok(next) => return Ok(next),
            Err(TryRecvError::Disconnected) => return Err(RecvError),
            Err(TryRecvError::Empty) => yield_now(),
        }
        if start.get_or_insert_with(Instant::now).elapsed() >= PATIENCE {
            return receiver.recv();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        let items: Vec<usize> = (0..50).collect();
        let squares: Vec<usize> = (0..50).map(|i| i * i).collect();
        let (done, counts) = parallel_map(
            items,
            4,
            || 0,
            |count, i| {
                *count += 1;
                i * i
            },
            |count| count,
        );
        assert_eq!(done, squares);
        assert_eq!((counts.len(), counts.iter().sum::<i32>()), (4, 50));
    }

    #[test]
    fn a_pool_takes_on_one_task_after_another() {
        let offset = 3_usize;
        let sums: Vec<usize> = ThreadPool::with(3, 20, |pool| {
            let sum = |round: usize| {
                // Now and then the helpers have gone to sleep.
                if round.is_multiple_of(8) {
                    std::thread::sleep(2 * PATIENCE);
                }
                let items = (0..round).collect();
                let (done, rest) = pool.map(
                    items,
                    || 10_usize,
                    |seed| seed,
                    |_, i| i + offset,
                    |seed| seed,
                );
                assert_eq!(rest, vec![10; round.clamp(1, 3)]);
                done.into_iter().sum()
            };
            (0..20).map(sum).collect()
        });
        let expected: Vec<usize> = (0..20)
            .map(|n: usize| n * 3 + n * n.saturating_sub(1) / 2)
            .collect();
        assert_eq!(sums, expected);
    }

    #[test]
    fn helpers_work_while_the_caller_does_something_else() {
        let caller = std::thread::current().id();
        let (done, seeds) = ThreadPool::with(3, 20, |pool| {
            let thread = |_: &mut u8, ()| std::thread::current().id();
            let begun = pool.start(vec![(); 20], [4, 5].into_iter(), |seed| seed, thread, |s| s);
            let more = pool.start(vec![(); 5], [6].into_iter(), |seed| seed, thread, |s| s);
            assert_eq!(more.join(7).1.len(), 2);
            begun.wait()
        });
        assert_eq!(done.len(), 20);
        assert!(!done.contains(&caller));
        assert_eq!(seeds.iter().sum::<u8>(), 9);
    }

    #[test]
    fn a_panic_of_a_helper_reaches_the_caller() {
        let work = || {
            ThreadPool::with(2, 2, |pool| {
                let own = std::thread::current().id();
                let begin = move |()| assert_eq!(std::thread::current().id(), own, "no helper");
                pool.map(vec![(); 20], || (), begin, |(), ()| (), |()| ())
            })
        };
        let panic = catch_unwind(AssertUnwindSafe(work)).expect_err("the helper panics");
        let text = panic.downcast_ref::<String>().expect("a text");
        assert!(text.contains("no helper"), "{text}");
    }

    #[test]
    fn without_helpers_the_caller_does_the_work() {
        let threads = ThreadPool::with(3, 20, |pool| {
            let thread = |(): &mut (), ()| std::thread::current().id();
            pool.dismiss();
            assert_eq!(pool.threads(), 1);
            pool.map(vec![(); 20], || (), |()| (), thread, |()| ()).0
        });
        assert_eq!(threads, [std::thread::current().id(); 20]);
    }

    #[test]
    fn there_are_no_more_threads_than_tasks() {
        assert_eq!(ThreadPool::with(8, 3, |pool| pool.threads()), 3);
        assert_eq!(ThreadPool::with(0, 3, |pool| pool.threads()), 1);
        let (done, rest) = parallel_map(Vec::<u8>::new(), 4, || (), |(), i| i, |()| ());
        assert_eq!((done.len(), rest.len()), (0, 1));
    }
}
