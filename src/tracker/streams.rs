//! Random streams. Each use in each frame has a stream of its own, so that no draw depends on threads or on other draws.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// What randomness is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    /// The pool of Haar-like features.
    Pool,
    /// Training samples.
    Samples,
    /// The particles of a set, by its index below 32.
    Particles(usize),
}

/// The generator for one use in one frame (counted from 0 at `init`).
pub(super) fn stream(seed: u64, frame: u64, purpose: Use) -> ChaCha8Rng {
    let purpose = match purpose {
        Use::Pool => 0,
        Use::Samples => 1,
        Use::Particles(set) => 32 + set as u64,
    };
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(frame.wrapping_mul(64).wrapping_add(purpose));
    generator
}
