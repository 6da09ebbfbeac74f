//! What is computed for whom: of each page the newest wish, which may be stopped.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::Semaphore;
use tokio::task::spawn_blocking;
use tokio::time::timeout;

use gumption_gum::propagate::Progress;

/// Wishes that are worked on at a time; each takes all cores.
const AT_A_TIME: usize = 2;

/// Wishes that may wait: more pages than anyone has open.
const MOST_PAGES: usize = 64;

/// Something that is being computed.
#[derive(Debug, Clone, Default)]
pub(crate) struct Job {
    /// Trials of Monte Carlo; whether it was stopped.
    pub trials: Progress,
    /// Share that is done, in 2⁻³².
    share: Arc<AtomicU64>,
}

impl Job {
    /// Hears which share is done, and says whether to go on.
    pub fn at(&self, share: f64) -> ControlFlow<()> {
        let share = (share * f64::from(u32::MAX)) as u64;
        self.share.store(share, Ordering::Relaxed);
        match self.trials.is_stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Share that is done.
    pub fn share(&self) -> f64 {
        self.share.load(Ordering::Relaxed) as f64 / f64::from(u32::MAX)
    }
}

/// The pages for which something is computed.
#[derive(Debug)]
pub(crate) struct Pages {
    jobs: Mutex<HashMap<String, Job>>,
    places: Arc<Semaphore>,
}

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ended {
    /// A newer wish, or the reader, has stopped it.
    Stopped,
    /// It took too long.
    Late,
    /// Too many pages wait.
    Crowded,
}

/// A job that is stopped when nobody waits for it any more.
struct Waited<'p> {
    pages: &'p Pages,
    page: String,
    job: Job,
}

impl Drop for Waited<'_> {
    fn drop(&mut self) {
        self.job.trials.stop();
        let mut jobs = self.pages.jobs();
        let own = |job: &Job| Arc::ptr_eq(&job.share, &self.job.share);
        if jobs.get(&self.page).is_some_and(own) {
            jobs.remove(&self.page);
        }
    }
}

impl Pages {
    /// Nothing is computed.
    pub fn new() -> Pages {
        Pages {
            jobs: Mutex::default(),
            places: Arc::new(Semaphore::new(AT_A_TIME)),
        }
    }

    fn jobs(&self) -> MutexGuard<'_, HashMap<String, Job>> {
        self.jobs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What is computed for a page.
    pub fn of(&self, page: &str) -> Option<Job> {
        self.jobs().get(page).cloned()
    }

    /// Computes something for a page, in place of what was being computed for it.
    ///
    /// # Errors
    /// It was stopped, or took longer than `most`.
    pub async fn compute<R: Send + 'static>(
        &self,
        page: String,
        most: Duration,
        work: impl FnOnce(&Job) -> R + Send + 'static,
    ) -> Result<R, Ended> {
        let job = Job::default();
        {
            let mut jobs = self.jobs();
            if jobs.len() >= MOST_PAGES && !jobs.contains_key(&page) {
                return Err(Ended::Crowded);
            }
            if let Some(older) = jobs.insert(page.clone(), job.clone()) {
                older.trials.stop();
            }
        }
        let waited = Waited {
            pages: self,
            page,
            job: job.clone(),
        };
        let Ok(place) = Arc::clone(&self.places).acquire_owned().await else {
            return Err(Ended::Stopped);
        };
        if job.trials.is_stopped() {
            return Err(Ended::Stopped);
        }
        let running = spawn_blocking(move || {
            let found = work(&job);
            // Free when the work has ended, though nobody may be waiting for it any more.
            drop(place);
            (found, job.trials.is_stopped())
        });
        let done = timeout(most, running).await;
        drop(waited);
        match done {
            Ok(Ok((found, false))) => Ok(found),
            Ok(_) => Err(Ended::Stopped),
            Err(_) => Err(Ended::Late),
        }
    }
}
