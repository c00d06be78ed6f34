//! Sums over blocks of time, from which the late part of a run can be taken at its end.

use super::Sums;

/// Blocks of one length kept at most; when there are more, the two oldest become one of twice the length.
const MOST_BLOCKS: usize = 64;
/// Groups of blocks that errors are from, at most.
const MOST_GROUPS: u64 = 10;

/// Sums over some time, by bin.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
struct Block {
    samples: u64,
    sums: Vec<Sums>,
}

impl Block {
    fn add(&mut self, other: &Self) {
        self.samples += other.samples;
        for (into, from) in self.sums.iter_mut().zip(&other.sums) {
            into.add(from);
        }
    }
}

/// Blocks of time, one after another.
///
/// Of the last periods each has a block of its own; the farther back, the longer are the blocks. So any late part can be
/// taken, be it short or long, to a few per cent of its length.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Blocks {
    /// Samples in a period.
    period: u64,
    /// None is shorter than the next; only the last can hold less than a period.
    blocks: Vec<Block>,
}

impl Blocks {
    /// None yet, of so many samples a period.
    pub(super) fn new(samples_per_period: u64) -> Self {
        Self {
            period: samples_per_period.max(1),
            blocks: Vec::new(),
        }
    }

    /// Whether these can be blocks of `bins` bins, so many samples a period, and so many in all.
    pub(super) fn fit(&self, bins: usize, samples_per_period: u64, samples: u64) -> bool {
        let mut each = self.blocks.iter().map(|block| block.samples);
        let has_bins = |block: &Block| block.sums.len() == bins;
        let of_periods = |block: &Block| {
            let periods = block.samples / self.period;
            block.samples.is_multiple_of(self.period) && periods.is_power_of_two()
        };
        let (whole, under_way) = self.whole();
        let lengths = whole.chunk_by(|one, next| one.samples == next.samples);
        self.period == samples_per_period.max(1)
            && each.try_fold(0_u64, u64::checked_add) == Some(samples)
            && self.blocks.iter().all(has_bins)
            && whole.iter().all(of_periods)
            && under_way.is_none_or(|block| block.samples < self.period)
            && whole.is_sorted_by(|one, next| one.samples >= next.samples)
            && lengths
                .map(<[Block]>::len)
                .all(|number| number <= MOST_BLOCKS)
    }

    /// The blocks of whole periods, and that of the period that is under way.
    fn whole(&self) -> (&[Block], Option<&Block>) {
        match self.blocks.split_last() {
            Some((last, before)) if last.samples < self.period => (before, Some(last)),
            _ => (&self.blocks, None),
        }
    }

    /// Begins a sample, and answers the sums that it is to be added to.
    pub(super) fn begin_sample(&mut self, bins: usize) -> &mut [Sums] {
        if self.whole().1.is_none() {
            self.begin(bins);
        }
        let last = self.blocks.last_mut().expect("a block that has begun");
        last.samples += 1;
        &mut last.sums
    }

    /// The sums of the last sample's block.
    pub(super) fn last(&mut self) -> Option<&mut Vec<Sums>> {
        self.blocks.last_mut().map(|block| &mut block.sums)
    }

    /// Begins a block; older ones may become one.
    fn begin(&mut self, bins: usize) {
        let mut length = self.period;
        loop {
            let first = self.blocks.partition_point(|block| block.samples > length);
            let longer = self.blocks.partition_point(|block| block.samples >= length);
            if longer - first < MOST_BLOCKS {
                break;
            }
            let second = self.blocks.remove(first + 1);
            self.blocks[first].add(&second);
            length *= 2;
        }
        self.blocks.push(Block {
            samples: 0,
            sums: vec![Sums::default(); bins],
        });
    }

    /// The last part of the whole periods in up to ten groups of about equally many, and how many groups these are; a period that is
    /// under way follows them as a group of its own.
    pub(super) fn late(&self, fraction: f64) -> (Vec<Vec<Sums>>, usize) {
        let (whole, under_way) = self.whole();
        let periods = whole.iter().map(|block| block.samples).sum::<u64>() / self.period;
        let wanted = match under_way {
            // With the period that is under way no less than the late part, but for blocks that reach beyond it.
            Some(block) => {
                let part = block.samples as f64 / self.period as f64;
                ((periods as f64 + part) * fraction - part).ceil()
            }
            None => (periods as f64 * fraction).round(),
        };
        let wanted = (wanted as u64).clamp(1.min(periods), periods);

        let (mut first, mut late) = (whole.len(), 0);
        while let Some(block) = whole[..first].last() {
            let with_it = late + block.samples / self.period;
            if with_it > wanted {
                break;
            }
            (first, late) = (first - 1, with_it);
        }
        let in_group = late.div_ceil(MOST_GROUPS) * self.period;
        let mut groups: Vec<Block> = Vec::new();
        for block in &whole[first..] {
            match groups.last_mut() {
                Some(group) if group.samples < in_group => group.add(block),
                _ => groups.push(block.clone()),
            }
        }
        // The rest: one that is much shorter than the others would count as much as they do.
        if groups.len() > 1
            && let Some(rest) = groups.pop_if(|last| 2 * last.samples < in_group)
            && let Some(last) = groups.last_mut()
        {
            last.add(&rest);
        }
        let number = groups.len();
        let groups = groups.into_iter().chain(under_way.cloned());
        (groups.map(|group| group.sums).collect(), number)
    }
}
