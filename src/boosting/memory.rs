//! The samples a classifier is trained on: some kept for good, the rest in a ring where the newest replace the oldest.

/// What a sample shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum Label {
    /// The target: y = +1.
    Target,
    /// The background: y = -1.
    Background,
}

impl Label {
    /// y in {-1, +1}.
    pub fn sign(self) -> f64 {
        match self {
            Self::Target => 1.0,
            Self::Background => -1.0,
        }
    }
}

/// Labelled feature vectors, stored a feature a row, so that training reads memory in order.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct SampleMemory {
    features: usize,
    kept: usize,
    recent: usize,
    oldest: usize,
    labels: Vec<Label>,
    values: Vec<f32>,
}

impl SampleMemory {
    /// A memory of vectors of `features` numbers: `kept` samples that stay, then the last `recent` ones.
    pub fn new(features: usize, kept: usize, recent: usize) -> Self {
        let capacity = kept + recent;
        Self {
            features,
            kept,
            recent,
            oldest: 0,
            labels: Vec::with_capacity(capacity),
            values: vec![0.0; features * capacity],
        }
    }

    /// Numbers in a sample.
    pub fn features(&self) -> usize {
        self.features
    }

    /// Samples held.
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    /// Samples held at most.
    pub fn capacity(&self) -> usize {
        self.kept + self.recent
    }

    /// Labels, in the order of the samples.
    pub fn labels(&self) -> &[Label] {
        &self.labels
    }

    /// The values of one feature, in the order of the samples.
    pub fn row(&self, feature: usize) -> &[f32] {
        &self.values[feature * self.capacity()..][..self.len()]
    }

    /// Adds a sample. The first `kept` stay for good; once the memory is full, the oldest of the others makes room. A memory
    /// without room for recent samples drops it.
    ///
    /// # Panics
    /// If `sample` has another length than the memory's vectors.
    pub fn add(&mut self, sample: &[f32], label: Label) {
        assert_eq!(sample.len(), self.features, "a sample has as many numbers as the memory's vectors");
        let slot = if self.len() < self.capacity() {
            self.labels.push(label);
            self.len() - 1
        } else if self.recent > 0 {
            let slot = self.kept + self.oldest;
            self.oldest = (self.oldest + 1) % self.recent;
            self.labels[slot] = label;
            slot
        } else {
            return;
        };
        let capacity = self.capacity();
        for (feature, value) in sample.iter().enumerate() {
            self.values[feature * capacity + slot] = *value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_samples_stay_and_the_oldest_of_the_rest_go() {
        let mut memory = SampleMemory::new(2, 1, 2);
        for i in 0..6 {
            let label = if i % 2 == 0 { Label::Target } else { Label::Background };
            memory.add(&[i as f32, -(i as f32)], label);
        }
        assert_eq!(memory.row(0), [0.0, 5.0, 4.0]);
        assert_eq!(memory.row(1), [0.0, -5.0, -4.0]);
        assert_eq!(memory.labels(), [Label::Target, Label::Background, Label::Target]);
    }

    #[test]
    fn without_room_for_recent_samples_later_ones_are_dropped() {
        let mut memory = SampleMemory::new(1, 1, 0);
        memory.add(&[1.0], Label::Target);
        memory.add(&[2.0], Label::Background);
        assert_eq!((memory.len(), memory.row(0)[0]), (1, 1.0));
    }
}
