//! Long work: on a thread of its own, with progress and Ctrl-C.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use pyo3::exceptions::{PyRuntimeError, PyTypeError};
use pyo3::prelude::*;

/// How often signals are looked for, and how often counts are told.
const LOOK: Duration = Duration::from_millis(50);

/// How long work that was given up may take to end before the caller goes on without it.
const GRACE: Duration = Duration::from_millis(500);

/// What is told of work in progress: what is done, how much of it, of how much.
type News = (String, u64, Option<u64>);

/// The hook through which work tells where it is, and by which it is given up.
#[derive(Clone)]
pub(crate) struct Hook {
    given_up: Arc<AtomicBool>,
    news: Sender<News>,
    told: Arc<Mutex<Option<Instant>>>,
}

/// What unwinds work that was given up.
struct GivenUp;

impl Hook {
    /// Where the work may be given up. Unwinds then, without a panic's message.
    pub(crate) fn check(&self) {
        if self.given_up.load(Ordering::Relaxed) {
            resume_unwind(Box::new(GivenUp));
        }
    }

    /// A new stage of work, the `number`th, which cannot be counted.
    pub(crate) fn stage(&self, what: &str, number: u64) {
        self.check();
        let _ = self.news.send((what.to_owned(), number, None));
    }

    /// So much of countable work is done.
    pub(crate) fn done(&self, what: &str, done: u64, total: u64) {
        self.check();
        let now = Instant::now();
        let mut told = held(&self.told);
        if done >= total || told.is_none_or(|before| now - before >= LOOK) {
            *told = Some(now);
            let _ = self.news.send((what.to_owned(), done, Some(total)));
        }
    }

    /// Ends the work with a Python exception, from inside of it.
    pub(crate) fn fail(error: PyErr) -> ! {
        resume_unwind(Box::new(error))
    }
}

/// Runs `work` on a thread of its own, Python's lock released, and gives what it gives.
///
/// `progress` is called on this thread. Where it raises, or a signal does (Ctrl-C), the work is
/// given up at its next look at the hook; what takes longer than half a second to get there
/// ends by itself later, and the exception is raised without waiting for it.
pub(crate) fn long<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Hook) -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    if let Some(other) = progress.filter(|progress| !progress.is_callable()) {
        return Err(PyTypeError::new_err(format!(
            "progress is a {}; valid: a function of (what, done, total)",
            other.get_type().name()?
        )));
    }
    let (news, heard) = channel();
    let hook = Hook {
        given_up: Arc::new(AtomicBool::new(false)),
        news,
        told: Arc::default(),
    };
    let given_up = hook.given_up.clone();
    let (gives, given) = channel();
    // A receiver is not to be shared between threads by itself.
    let (heard, given) = (Mutex::new(heard), Mutex::new(given));
    std::thread::Builder::new()
        .name("feed-axis".to_owned())
        .spawn(move || {
            // Nothing that was unwound is used again.
            let result = catch_unwind(AssertUnwindSafe(|| work(&hook)));
            let _ = gives.send(result);
        })?;
    if let Err(raised) = attend(py, &heard, progress) {
        given_up.store(true, Ordering::Relaxed);
        py.detach(|| held(&given).recv_timeout(GRACE)).ok();
        return Err(raised);
    }
    match py.detach(|| held(&given).recv()) {
        Ok(Ok(result)) => result,
        Ok(Err(thrown)) => Err(unwound(thrown)),
        Err(_) => Err(PyRuntimeError::new_err("the work ended without a result")),
    }
}

/// What a lock holds, whoever has panicked with it.
fn held<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Tells progress and looks for signals until the work has ended.
fn attend(
    py: Python<'_>,
    heard: &Mutex<Receiver<News>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<()> {
    loop {
        let news = py.detach(|| held(heard).recv_timeout(LOOK));
        py.check_signals()?;
        match (news, progress) {
            (Ok(news), Some(progress)) => drop(progress.call1(news)?),
            (Err(RecvTimeoutError::Disconnected), _) => return Ok(()),
            _ => (),
        }
    }
}

/// What a thread has thrown, as an exception.
fn unwound(thrown: Box<dyn Any + Send>) -> PyErr {
    match thrown.downcast::<PyErr>() {
        Ok(raised) => *raised,
        Err(other) => {
            let words = other.downcast_ref::<String>().map(String::as_str);
            let words = words.or(other.downcast_ref::<&str>().copied());
            let words = words.unwrap_or("the work was given up");
            PyRuntimeError::new_err(format!("a defect of feed_axis: {words}"))
        }
    }
}
