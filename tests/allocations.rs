//! Memory: what an update allocates does not depend on the number of particles, and nothing piles up.
//!
//! Everything is in one test: the counts are of the whole program, so no other test may run beside it.

use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering::Relaxed},
    },
};

use infopart::{
    frame::Frame,
    geometry::Rect,
    sequence::{FrameSource, Walker, WalkerOptions},
    tracker::{InfoPart, Parameters, Tracker},
};

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);
static ALLOCATED_BYTES: AtomicU64 = AtomicU64::new(0);
static FREED_BYTES: AtomicU64 = AtomicU64::new(0);

/// The system's allocator, counting.
struct Counting;

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Relaxed);
        ALLOCATED_BYTES.fetch_add(layout.size() as u64, Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        FREED_BYTES.fetch_add(layout.size() as u64, Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

fn live_bytes() -> u64 {
    ALLOCATED_BYTES.load(Relaxed) - FREED_BYTES.load(Relaxed)
}

/// A walk forth and back without end, and the person's box at its start.
struct Walk {
    frames: Vec<Frame>,
    first: Rect,
}

impl Walk {
    fn new() -> Self {
        let options = WalkerOptions { width: 160, height: 120, frames: 50, ..WalkerOptions::default() };
        let mut walker = Walker::new(options);
        let first = walker.ground_truth()[0].unwrap();
        let frames = std::iter::from_fn(|| walker.next_frame().unwrap()).map(|frame| frame.frame).collect();
        Self { frames, first }
    }

    /// The frames after the first.
    fn later(&self) -> impl Iterator<Item = &Frame> {
        let last = self.frames.len() - 1;
        (1..=last).chain((0..last).rev()).cycle().map(|index| &self.frames[index])
    }
}

fn tracker(particles: usize, walk: &Walk) -> InfoPart {
    let mut parameters = Parameters::default();
    parameters.particles = particles;
    // One thread: how often work is split among several, and so what that allocates, is up to chance.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut tracker = InfoPart::with_pool(parameters.check().unwrap(), Arc::new(pool));
    tracker.init(walk.frames[0].view(), walk.first).unwrap();
    tracker
}

/// Allocations of each of 100 updates after 100 others, with training and learning among them.
fn allocations_of_updates(particles: usize, walk: &Walk) -> Vec<u64> {
    let mut tracker = tracker(particles, walk);
    let count = |frame: &Frame| {
        let before = ALLOCATIONS.load(Relaxed);
        tracker.update(frame.view()).unwrap();
        ALLOCATIONS.load(Relaxed) - before
    };
    walk.later().take(200).map(count).collect::<Vec<_>>().split_off(100)
}

#[test]
fn an_update_allocates_nothing_per_particle_and_nothing_piles_up() {
    let walk = Walk::new();
    let (few, many) = (allocations_of_updates(200, &walk), allocations_of_updates(2000, &walk));
    let (few_in_all, many_in_all) = (few.iter().sum::<u64>(), many.iter().sum::<u64>());
    println!("allocations of 100 updates: {few_in_all} at 200 particles, {many_in_all} at 2000");
    // Buffers that a larger search region outgrows, and rayon's queue, are the little that is left.
    let most = few.iter().chain(&many).max().unwrap();
    assert!(*most <= 32, "an update with {most} allocations: {few:?} {many:?}");
    assert!(many_in_all <= few_in_all + 200, "{few_in_all} at 200 particles, {many_in_all} at 2000");

    let mut tracker = tracker(50, &walk);
    let mut live = Vec::with_capacity(5000);
    for frame in walk.later().take(5000) {
        tracker.update(frame.view()).unwrap();
        live.push(live_bytes());
    }
    // A larger search region than any before makes buffers grow, once; what piles up grows with the frames.
    let mut highest = *live[..500].iter().max().unwrap();
    let mut records = 0;
    for bytes in &live[500..] {
        records += usize::from(*bytes > highest);
        highest = highest.max(*bytes);
    }
    println!("bytes in use: {} after 500 frames, {highest} at most in 5000; {records} records", live[499]);
    assert!(records <= 20, "in {records} of 4500 frames more bytes were in use than ever before");
    assert!(highest <= 2 * live[499], "{} bytes, then {highest}", live[499]);
}
