//! Histories of the contacts of grains with a prescribed wall.

/// Histories of contacts with wall spheres, grain by grain.
///
/// The spheres of a prescribed wall are in no list, so each force evaluation writes down which of them a grain touches,
/// and looks the histories up in the last one.
#[derive(Clone, Debug, Default)]
pub(crate) struct WallMemory<H> {
    start: Vec<u32>,
    entries: Vec<(u32, H)>,
    next_start: Vec<u32>,
    next_entries: Vec<(u32, H)>,
}

impl<H: Copy + Default> WallMemory<H> {
    /// Begins an evaluation.
    pub(crate) fn begin(&mut self) {
        self.next_start.clear();
        self.next_entries.clear();
        self.next_start.push(0);
    }

    /// Takes the history of a contact of grain `grain` with wall sphere `sphere` out; a fresh one where there was none.
    pub(crate) fn take(&mut self, grain: usize, sphere: u32) -> H {
        let range = self.range(grain);
        self.entries[range]
            .iter_mut()
            .find(|entry| entry.0 == sphere)
            .map_or_else(H::default, |entry| core::mem::take(&mut entry.1))
    }

    /// The history of a contact, which stays in the memory; a fresh one if the contact is new.
    pub(crate) fn history(&self, grain: usize, sphere: u32) -> H {
        self.entries[self.range(grain)]
            .iter()
            .find(|entry| entry.0 == sphere)
            .map_or_else(H::default, |entry| entry.1)
    }

    /// Writes down the history of a contact of the grain at hand.
    pub(crate) fn put(&mut self, sphere: u32, history: H) {
        self.next_entries.push((sphere, history));
    }

    /// Ends the grain at hand; histories that were not taken out belong to contacts that have ended.
    pub(crate) fn end_grain(&mut self, grain: usize) -> impl Iterator<Item = &H> {
        self.next_start.push(self.next_entries.len() as u32);
        let range = self.range(grain);
        self.entries[range].iter().map(|entry| &entry.1)
    }

    /// Ends the evaluation.
    pub(crate) fn end(&mut self) {
        core::mem::swap(&mut self.start, &mut self.next_start);
        core::mem::swap(&mut self.entries, &mut self.next_entries);
    }

    fn range(&self, grain: usize) -> core::ops::Range<usize> {
        if grain + 1 < self.start.len() {
            self.start[grain] as usize..self.start[grain + 1] as usize
        } else {
            0..0
        }
    }

    /// All histories: (grain, wall sphere, history).
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, u32, &H)> {
        (0..self.start.len().saturating_sub(1)).flat_map(move |grain| {
            self.entries[self.range(grain)]
                .iter()
                .map(move |(sphere, history)| (grain as u32, *sphere, history))
        })
    }

    /// The memory of some of the grains, counted from 0.
    pub(crate) fn part(&self, grains: impl Iterator<Item = usize> + Clone) -> Self {
        let ranges = grains.map(|grain| self.range(grain));
        let entries = ranges.clone().flat_map(|range| &self.entries[range]);
        let lengths = ranges.map(|range| range.len() as u32);
        let ends = lengths.scan(0, |end, length| {
            *end += length;
            Some(*end)
        });
        Self {
            start: core::iter::once(0).chain(ends).collect(),
            entries: entries.copied().collect(),
            ..Self::default()
        }
    }

    /// Appends what `other` remembers of `grain`, as the memory of the next grain.
    pub(crate) fn append(&mut self, other: &Self, grain: usize) {
        if self.start.is_empty() {
            self.start.push(0);
        }
        self.entries
            .extend_from_slice(&other.entries[other.range(grain)]);
        self.start.push(self.entries.len() as u32);
    }

    /// Memory that holds the given histories, in order of the grains.
    pub(crate) fn from_entries(grains: usize, histories: &[(u32, u32, H)]) -> Self {
        let mut start = Vec::with_capacity(grains + 1);
        start.push(0);
        let mut at = 0;
        for grain in 0..grains as u32 {
            while at < histories.len() && histories[at].0 == grain {
                at += 1;
            }
            start.push(at as u32);
        }
        Self {
            start,
            entries: histories
                .iter()
                .map(|&(_, sphere, history)| (sphere, history))
                .collect(),
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(memory: &WallMemory<f64>) -> Vec<(u32, u32, f64)> {
        memory
            .iter()
            .map(|(grain, sphere, history)| (grain, sphere, *history))
            .collect()
    }

    #[test]
    fn contacts_that_go_on_keep_their_history_and_others_end() {
        let mut memory = WallMemory::default();
        memory.begin();
        assert_eq!(memory.take(0, 7), 0.0);
        memory.put(7, 1.5);
        memory.put(9, 2.5);
        assert_eq!(memory.end_grain(0).count(), 0);
        memory.put(7, 3.5);
        assert_eq!(memory.end_grain(1).count(), 0);
        memory.end();
        assert_eq!(all(&memory), [(0, 7, 1.5), (0, 9, 2.5), (1, 7, 3.5)]);

        memory.begin();
        assert_eq!(memory.take(0, 9), 2.5);
        memory.put(9, 2.6);
        // Sphere 7 was not taken: its contact has ended.
        assert_eq!(memory.end_grain(0).sum::<f64>(), 1.5);
        assert_eq!(memory.end_grain(1).sum::<f64>(), 3.5);
        memory.end();
        assert_eq!(all(&memory), [(0, 9, 2.6)]);
    }

    #[test]
    fn entries_make_the_same_memory() {
        let entries = [(1, 4, 0.5), (1, 8, 0.7), (3, 4, 0.9)];
        let mut memory = WallMemory::from_entries(5, &entries);
        assert_eq!(all(&memory), entries);
        memory.begin();
        assert_eq!(
            (memory.take(3, 4), memory.take(1, 8), memory.take(4, 8)),
            (0.9, 0.7, 0.0)
        );
    }
}
