//! The worker threads.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// The operating system refused the threads that were asked for.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {threads} threads: {source}")]
pub struct PoolError {
    threads: usize,
    source: ThreadPoolBuildError,
}

/// Starts `threads` workers; 0 means one for each core that this process may use. What runs inside of the pool
/// (`pool.install`), for example the building of a tree, keeps to the same number.
///
/// # Errors
/// The operating system refuses.
pub fn pool(threads: usize) -> Result<ThreadPool, PoolError> {
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        asked => asked,
    };
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(|index| format!("worker {index}"))
        .build()
        .map_err(|source| PoolError { threads, source })
}
