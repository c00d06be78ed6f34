//! How long grains take through an open tube.

/// Most bins of the distribution.
const BINS: usize = 256;
/// Most blocks of times that came one after another.
const BLOCKS: usize = 128;

/// Transit times: number, mean and variance, how they are distributed over bins of equal width, and their means over blocks
/// of times that came one after another.
///
/// Bins and blocks are few whatever the run: where they do not suffice, every two become one, twice as wide or long.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TransitTimes {
    number: u64,
    mean: f64,
    /// Sum of squared differences from the mean \[t^2\].
    squares: f64,
    /// Width of a bin \[t\].
    width: f64,
    bins: Vec<u64>,
    /// Times in a block.
    block_length: u64,
    /// Sums of the blocks; the last block may not be full \[t\].
    blocks: Vec<f64>,
}

impl TransitTimes {
    /// None yet; bins begin with this width \[t\].
    pub(crate) fn new(width: f64) -> Self {
        Self {
            number: 0,
            mean: 0.0,
            squares: 0.0,
            width,
            bins: Vec::new(),
            block_length: 1,
            blocks: Vec::new(),
        }
    }

    /// Whether a run can have come to these times, read from a file.
    pub(crate) fn fits(&self) -> bool {
        self.width > 0.0
            && self.bins.len() <= BINS
            && self.bins.iter().sum::<u64>() == self.number
            && self.blocks.len() <= BLOCKS
            && self.block_length.is_power_of_two()
            && self.number.div_ceil(self.block_length) == self.blocks.len() as u64
    }

    /// Adds a time \[t\].
    pub(crate) fn add(&mut self, time: f64) {
        if self.number.is_multiple_of(self.block_length) {
            if self.blocks.len() == BLOCKS {
                self.block_length *= 2;
                let pairs = self.blocks.chunks(2).map(|pair| pair.iter().sum());
                self.blocks = pairs.collect();
            }
            self.blocks.push(0.0);
        }
        if let Some(last) = self.blocks.last_mut() {
            *last += time;
        }
        self.number += 1;
        let off = time - self.mean;
        self.mean += off / self.number as f64;
        self.squares += off * (time - self.mean);
        while time >= self.width * BINS as f64 {
            self.width *= 2.0;
            let pairs = self.bins.chunks(2).map(|pair| pair.iter().sum());
            self.bins = pairs.collect();
        }
        let bin = ((time / self.width) as usize).min(BINS - 1);
        if self.bins.len() <= bin {
            self.bins.resize(bin + 1, 0);
        }
        self.bins[bin] += 1;
    }

    /// How many there are.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Their mean; NaN of none \[t\].
    pub fn mean(&self) -> f64 {
        if self.number == 0 {
            f64::NAN
        } else {
            self.mean
        }
    }

    /// Their variance, with the divisor n - 1; NaN below two \[t^2\].
    pub fn variance(&self) -> f64 {
        match self.number {
            0 | 1 => f64::NAN,
            number => self.squares / (number - 1) as f64,
        }
    }

    /// Means over blocks of equally many times that came one after another, up to 128 blocks; one that is not full is left
    /// out \[t\].
    pub fn block_means(&self) -> Vec<f64> {
        let whole = (self.number / self.block_length) as usize;
        let means = self.blocks[..whole].iter();
        means.map(|sum| sum / self.block_length as f64).collect()
    }

    /// Width of a bin \[t\], and the number of times in each from 0 on.
    pub fn distribution(&self) -> (f64, &[u64]) {
        (self.width, &self.bins)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_any_length_keep_their_moments_in_few_bins() {
        let mut found = TransitTimes::new(0.5);
        let times = || (0..10_000_u32).map(|k| f64::from(k) * 0.25);
        times().for_each(|time| found.add(time));
        assert!(found.fits());
        assert_eq!(found.number(), 10_000);
        // Mean and variance of equally spaced numbers.
        assert!((found.mean() / (0.25 * 9999.0 / 2.0) - 1.0).abs() < 1e-12);
        let variance = 0.0625 * 10_000.0 * 10_001.0 / 12.0;
        assert!((found.variance() / variance - 1.0).abs() < 1e-12);
        let (width, bins) = found.distribution();
        // 2500 in 256 bins of 0.5 2^5.
        assert_eq!((width, bins.len()), (16.0, 157));
        assert!(bins[..156].iter().all(|&bin| bin == 64));
        assert_eq!(bins.iter().sum::<u64>(), 10_000);
        // 78 whole blocks of 128, and the first of them in the middle of 0 to 127.
        let means = found.block_means();
        assert_eq!((means.len(), means[0]), (78, 0.25 * 63.5));
        assert_eq!(means[77], 0.25 * (77.0 * 128.0 + 63.5));
    }
}
