//! Sections of the tube, for threads to share: each computes every contact of its own spheres.
//!
//! A contact across a border is computed on both sides, with the same result. The section that holds its row of the list
//! counts it.

use super::book::{AllTerms, Leg, Run};
use super::motion::Moved;
use super::network::Rings;
use super::pairs::{Border, Pairs};
use super::spheres::{Forces, Own, Spheres};
use crate::bodies::Bodies;
use crate::fast::threads::Threads;
use crate::neighbours::{Drift, Neighbours};
use crate::wall::Wall;

/// The work that a grain, and a sphere of the wall, makes besides its pairs, in listed pairs.
const PAIRS_OF_A_GRAIN: usize = 2;
const PAIRS_OF_A_WALL_SPHERE: usize = 6;

/// Where the wall has no rings, borders are sought at so many places for each section.
const SLICES_OF_A_SECTION: usize = 16;

/// A section of the tube.
#[derive(Clone, Debug, Default)]
pub(super) struct Section {
    pub(super) number: u16,
    pub(super) own: Own,
    pub(super) forces: Forces,
    /// Its grains, and its spheres of the wall.
    pub(super) moved: [Moved; 2],
    /// Behind which of its grains each of its runs ends.
    pub(super) runs: Vec<u32>,
    /// Room: bounds of displacements or velocities of both.
    pub(super) drifts: [Drift; 2],
}

/// The pairs of a section's rows that other sections compute too.
#[derive(Clone, Debug, Default)]
pub(super) struct Offer {
    pub(super) borders: Vec<Border>,
}

/// How the spheres are shared out to sections.
#[derive(Clone, Debug, Default)]
pub(super) struct Shares {
    pub(super) sections: Vec<Section>,
    /// The pairs of each whose first sphere is a grain, and those of wall spheres only.
    pub(super) pairs: Vec<[Pairs; 2]>,
    pub(super) offers: Vec<Offer>,
    /// The rings of each.
    pub(super) rings: Vec<Rings>,
    /// All rows of grains, in the order of the list.
    pub(super) runs: Vec<Run>,
    /// In which the terms of their contacts, and of the rings, are added up.
    pub(super) legs: Vec<Leg>,
    /// The section of each sphere, by its number.
    pub(super) section_of: Vec<u16>,
    /// Room: of each slice of the tube the work that its spheres make, then its section.
    slices: Vec<usize>,
    /// Room: the place of the next sphere of each section.
    next: Vec<usize>,
    /// Pairs across borders since the spheres were shared out: at first, and now.
    borders: Option<(usize, usize)>,
}

impl Section {
    pub(super) fn length(&self) -> usize {
        self.own.number
    }

    /// Lists its pairs: the rows of its spheres, and of those of others the pairs that it has a sphere of.
    pub(super) fn load_pairs<H: Copy + Default + PartialEq>(
        &self,
        [of_grains, of_wall]: &mut [Pairs; 2],
        list: &Neighbours<H>,
        spheres: &Spheres,
        offers: &[Offer],
    ) {
        let borders = offers.iter().flat_map(|offer| &offer.borders);
        let borders = borders.filter(|border| border.section == self.number);
        let mut borders: Vec<Border> = borders.copied().collect();
        borders.sort_unstable_by_key(|border| border.at);
        let of_wall_begin =
            borders.partition_point(|border| (border.first as usize) < spheres.grains);
        let (at_grains, at_wall) = borders.split_at(of_wall_begin);
        let start = self.own.start;
        let mut behind = start;
        let runs = self.runs.iter().map(|&end| {
            let first = core::mem::replace(&mut behind, start + end as usize);
            first..behind
        });
        of_grains.load(list, runs, at_grains, spheres);
        let wall = core::iter::once(self.own.of_wall());
        of_wall.load(list, wall, at_wall, spheres);
    }
}

impl Offer {
    /// Looks for the pairs in the rows of a section whose second sphere is in another.
    pub(super) fn find_borders<H: Copy + Default + PartialEq>(
        &mut self,
        section: &Section,
        list: &Neighbours<H>,
        spheres: &Spheres,
        section_of: &[u16],
    ) {
        let own = section.number;
        self.borders.clear();
        for &row in &spheres.number[section.own.all()] {
            let row = row as usize;
            if row >= list.rows() {
                continue;
            }
            for (at, &second) in list.range(row).zip(list.partners(row)) {
                let section = section_of[second as usize];
                if section != own {
                    self.borders.push(Border {
                        section,
                        first: row as u32,
                        second,
                        at: at as u32,
                    });
                }
            }
        }
    }
}

impl Shares {
    /// The sections, and the terms of their sums.
    pub(super) fn with_terms(&mut self) -> (&mut [Section], AllTerms<'_>) {
        let terms = AllTerms {
            pairs: &self.pairs,
            rings: &self.rings,
            runs: &self.runs,
            legs: &self.legs,
        };
        (&mut self.sections, terms)
    }

    /// Whether sections reach so far into each other that they are better shared out again.
    pub(super) fn are_worn(&self) -> bool {
        let pairs = self.pairs.iter().map(|[of_grains, _]| of_grains.listed());
        self.borders
            .is_some_and(|(first, now)| now > 2 * first + pairs.sum::<usize>() / 100)
    }

    pub(super) fn count_borders(&mut self) {
        let now = self.offers.iter().map(|offer| offer.borders.len()).sum();
        let first = self.borders.map_or(now, |(first, _)| first);
        self.borders = Some((first, now));
    }

    /// Cuts the tube into sections of about the same work, between rings of an elastic wall, one for one thread; answers
    /// the spheres' numbers, section by section.
    pub(super) fn share_out<H: Copy + Default + PartialEq>(
        &mut self,
        bodies: &Bodies,
        list: &Neighbours<H>,
        wall: &Wall,
        threads: &Threads,
        numbers: &mut Vec<u32>,
    ) {
        let (grains, all) = (bodies.grains, bodies.number());
        let (rings, per_ring) = wall.elastic().map_or((0, 0), |wall| {
            let lattice = wall.lattice();
            (lattice.rings() as usize, lattice.spheres_per_ring as usize)
        });
        let most = threads.stretches(all);
        let slices = match rings {
            0 => SLICES_OF_A_SECTION * most,
            rings => rings,
        };
        let sections = most.min(slices);
        let slice_of = |grain: usize| {
            let along = bodies.position[grain].z / wall.length();
            ((along * slices as f64) as usize).min(slices - 1)
        };
        self.slices.clear();
        self.slices
            .resize(slices, PAIRS_OF_A_WALL_SPHERE * per_ring);
        for grain in 0..grains {
            let pairs = if grain < list.rows() {
                list.range(grain).len()
            } else {
                0
            };
            self.slices[slice_of(grain)] += PAIRS_OF_A_GRAIN + pairs;
        }
        let whole = self.slices.iter().sum::<usize>().max(1);
        let mut before = 0;
        for work in &mut self.slices {
            let section = before * sections / whole;
            before += *work;
            *work = section.min(sections - 1);
        }
        let section_of_slice = &self.slices[..];
        self.section_of.clear();
        self.section_of
            .extend((0..grains).map(|grain| section_of_slice[slice_of(grain)] as u16));
        let of_wall = (0..rings).flat_map(|ring| core::iter::repeat_n(ring, per_ring));
        self.section_of
            .extend(of_wall.map(|ring| section_of_slice[ring] as u16));
        self.section_of.resize(all, 0);

        self.borders = None;
        self.sections.resize_with(sections, Section::default);
        self.pairs.resize_with(sections, Default::default);
        self.offers.resize_with(sections, Offer::default);
        self.rings.resize_with(sections, Rings::default);
        for (number, section) in (0..).zip(&mut self.sections) {
            (section.number, section.own) = (number, Own::default());
            section.runs.clear();
        }
        for (sphere, &section) in self.section_of.iter().enumerate() {
            let own = &mut self.sections[section as usize].own;
            own.number += 1;
            own.grains += usize::from(sphere < grains);
        }
        self.next.clear();
        let mut end = 0;
        for section in &mut self.sections {
            section.own.start = end;
            self.next.push(end);
            end += section.own.number;
        }
        numbers.clear();
        numbers.resize(all, 0);
        self.runs.clear();
        let (of_grains, of_wall) = self.section_of.split_at(grains);
        let of_sections = of_grains.chunk_by(|a, b| a == b);
        let all = of_sections.chain(of_wall.chunk_by(|a, b| a == b));
        let mut sphere = 0;
        for of_section in all {
            let number = of_section[0] as usize;
            let place = &mut self.next[number];
            let places = *place..*place + of_section.len();
            *place = places.end;
            if (sphere as usize) < grains {
                let section = &mut self.sections[number];
                self.runs.push(Run {
                    section: number,
                    number: section.runs.len(),
                    rows: of_section.len(),
                });
                section.runs.push((places.end - section.own.start) as u32);
            }
            for number in &mut numbers[places] {
                *number = sphere;
                sphere += 1;
            }
        }
        let with_rings = if rings == 0 { 0 } else { sections };
        Leg::of(&self.runs, with_rings, &mut self.legs);
    }
}
