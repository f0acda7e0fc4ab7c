//! Work shared among threads, or done on the calling one: the only place that knows which.
//!
//! Work comes as two closures (`join`) or as pieces (`Pieces`) of slices (`for_each`). Each piece is written by one
//! thread and nothing is summed across pieces, so the results are the same bits however the work is shared.

use std::{cell::Cell, fmt};

#[cfg(feature = "threads")]
use std::sync::Arc;

/// Where a tracker's work is done. The boxes do not depend on it.
#[derive(Clone, Default)]
#[non_exhaustive]
pub enum Threads {
    /// On the calling thread alone: no thread is started and no pool touched, as a process that forks needs it.
    #[cfg_attr(not(feature = "threads"), default)]
    Calling,
    /// In the pool that the tracker is called from: rayon's global one unless that is changed.
    #[cfg(feature = "threads")]
    #[default]
    Ambient,
    /// In this pool.
    #[cfg(feature = "threads")]
    Pool(Arc<rayon::ThreadPool>),
}

impl fmt::Debug for Threads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Calling => f.write_str("Calling"),
            #[cfg(feature = "threads")]
            Self::Ambient => f.write_str("Ambient"),
            #[cfg(feature = "threads")]
            Self::Pool(pool) => write!(f, "Pool({})", pool.current_num_threads()),
        }
    }
}

impl Threads {
    /// Does the work, which may share itself out only as this says.
    pub(crate) fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match self {
            Self::Calling => {
                let _alone = Alone::begin();
                work()
            }
            // Into rayon's pool once, instead of once for each loop that it shares out.
            #[cfg(feature = "threads")]
            Self::Ambient => rayon::scope(|_| work()),
            #[cfg(feature = "threads")]
            Self::Pool(pool) => pool.install(work),
        }
    }
}

thread_local! {
    /// Whether this thread is to do all of its work itself.
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// While it lives, its thread shares nothing out.
struct Alone {
    before: bool,
}

impl Alone {
    fn begin() -> Self {
        Self { before: ALONE.replace(true) }
    }
}

impl Drop for Alone {
    fn drop(&mut self) {
        ALONE.set(self.before);
    }
}

#[cfg(feature = "threads")]
fn is_shared() -> bool {
    !ALONE.get()
}

#[cfg(not(feature = "threads"))]
fn is_shared() -> bool {
    false
}

/// Does both, at once if there is a thread to spare.
pub(crate) fn join<A: Send, B: Send>(
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    #[cfg(feature = "threads")]
    if is_shared() {
        return rayon::join(one, other);
    }
    (one(), other())
}

/// Something in pieces that different threads may take: slices, their chunks, and several of these side by side.
pub(crate) trait Pieces: Send + Sized {
    /// A piece.
    type Piece;
    /// How many pieces there are.
    fn count(&self) -> usize;
    /// The first `count` pieces, and the others.
    fn split_at(self, count: usize) -> (Self, Self);
    /// The pieces, in order.
    fn into_iter(self) -> impl Iterator<Item = Self::Piece>;
}

/// Chunks of so many elements; the last may be shorter.
pub(crate) struct Chunks<'a, T>(pub &'a [T], pub usize);

/// Chunks of so many elements, to be written; the last may be shorter.
pub(crate) struct ChunksMut<'a, T>(pub &'a mut [T], pub usize);

impl<'a, T: Sync> Pieces for Chunks<'a, T> {
    type Piece = &'a [T];

    fn count(&self) -> usize {
        self.0.len().div_ceil(self.1)
    }

    fn split_at(self, count: usize) -> (Self, Self) {
        let (front, back) = self.0.split_at((count * self.1).min(self.0.len()));
        (Self(front, self.1), Self(back, self.1))
    }

    fn into_iter(self) -> impl Iterator<Item = &'a [T]> {
        self.0.chunks(self.1)
    }
}

impl<'a, T: Send> Pieces for ChunksMut<'a, T> {
    type Piece = &'a mut [T];

    fn count(&self) -> usize {
        self.0.len().div_ceil(self.1)
    }

    fn split_at(self, count: usize) -> (Self, Self) {
        let (front, back) = self.0.split_at_mut((count * self.1).min(self.0.len()));
        (Self(front, self.1), Self(back, self.1))
    }

    fn into_iter(self) -> impl Iterator<Item = &'a mut [T]> {
        self.0.chunks_mut(self.1)
    }
}

impl<'a, T: Sync> Pieces for &'a [T] {
    type Piece = &'a T;

    fn count(&self) -> usize {
        self.len()
    }

    fn split_at(self, count: usize) -> (Self, Self) {
        <[T]>::split_at(self, count)
    }

    fn into_iter(self) -> impl Iterator<Item = &'a T> {
        self.iter()
    }
}

impl<'a, T: Send> Pieces for &'a mut [T] {
    type Piece = &'a mut T;

    fn count(&self) -> usize {
        self.len()
    }

    fn split_at(self, count: usize) -> (Self, Self) {
        self.split_at_mut(count)
    }

    fn into_iter(self) -> impl Iterator<Item = &'a mut T> {
        self.iter_mut()
    }
}

impl<A: Pieces, B: Pieces> Pieces for (A, B) {
    type Piece = (A::Piece, B::Piece);

    fn count(&self) -> usize {
        self.0.count().min(self.1.count())
    }

    fn split_at(self, count: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.split_at(count), self.1.split_at(count));
        ((a, b), (c, d))
    }

    fn into_iter(self) -> impl Iterator<Item = Self::Piece> {
        self.0.into_iter().zip(self.1.into_iter())
    }
}

/// Gives every piece, with its number counted from 0, to `work`. A thread takes at least `least` of them.
pub(crate) fn for_each<P: Pieces>(pieces: P, least: usize, work: impl Fn(usize, P::Piece) + Sync) {
    for_each_with(pieces, least, || (), |(), number, piece| work(number, piece));
}

/// [`for_each`] with something of its own, such as scratch memory, for those that are done one after another.
pub(crate) fn for_each_with<P: Pieces, S>(
    pieces: P,
    least: usize,
    scratch: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize, P::Piece) + Sync,
) {
    halve(pieces, 0, least, &scratch, &work);
}

fn halve<P: Pieces, S>(
    pieces: P,
    first: usize,
    least: usize,
    scratch: &(impl Fn() -> S + Sync),
    work: &(impl Fn(&mut S, usize, P::Piece) + Sync),
) {
    let count = pieces.count();
    if !is_shared() || count < 2 * least {
        let mut scratch = scratch();
        for (offset, piece) in pieces.into_iter().enumerate() {
            work(&mut scratch, first + offset, piece);
        }
        return;
    }
    let half = count / 2;
    let (front, back) = pieces.split_at(half);
    join(|| halve(front, first, least, scratch, work), || halve(back, first + half, least, scratch, work));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What each piece saw: its number, its first element, and the length of its chunk.
    fn seen(threads: &Threads, least: usize) -> Vec<(usize, u32, usize)> {
        let source: Vec<u32> = (0..23).collect();
        let mut out = vec![(0, 0, 0); 6];
        threads.run(|| {
            for_each((Chunks(&source, 4), out.as_mut_slice()), least, |number, (chunk, out)| {
                *out = (number, chunk[0], chunk.len());
            });
        });
        out
    }

    #[test]
    fn every_piece_is_seen_once_with_its_number_however_it_is_shared() {
        let expected: Vec<_> = (0..6).map(|i| (i, 4 * i as u32, if i == 5 { 3 } else { 4 })).collect();
        for least in [1, 2, 4, 100] {
            assert_eq!(seen(&Threads::Calling, least), expected);
            assert_eq!(seen(&Threads::default(), least), expected);
        }
    }

    #[test]
    fn on_the_calling_thread_nothing_leaves_it_and_the_rest_of_the_thread_is_as_before() {
        let me = std::thread::current().id();
        let mut ids = vec![None; 1000];
        Threads::Calling.run(|| {
            for_each(ids.as_mut_slice(), 1, |_, id| *id = Some(std::thread::current().id()));
            let (a, b) = join(|| std::thread::current().id(), || std::thread::current().id());
            assert_eq!((a, b), (me, me));
        });
        assert!(ids.iter().all(|id| *id == Some(me)));
        assert!(!ALONE.get());
        let broken = std::panic::catch_unwind(|| Threads::Calling.run(|| panic!("broken")));
        assert!(broken.is_err() && !ALONE.get(), "a panic ends it too");
    }

    #[test]
    fn scratch_belongs_to_pieces_that_follow_each_other() {
        let mut out = vec![0; 9];
        Threads::Calling.run(|| {
            for_each_with(
                out.as_mut_slice(),
                1,
                || 0,
                |sum, number, out| {
                    *sum += number;
                    *out = *sum;
                },
            );
        });
        assert_eq!(out, [0, 1, 3, 6, 10, 15, 21, 28, 36]);
    }
}
