//! Contacts of grains with a prescribed wall, where several threads serve it: each section has those of its grains.

use peristalsis_physics::contact::NormalLaw;

use super::history::PackedHistory;
use super::section::{Section, Shares};
use super::{Listed, Scratch};
use crate::contacts::Contacts;
use crate::forces::Reference;
use crate::wall::Wall;
use crate::wall::memory::WallMemory;
use crate::wall::sums::Waiting;

/// A section of grains in a prescribed wall.
pub(super) struct BesideWall<H> {
    /// Histories of contacts with the wall; its grains are counted from 0.
    pub(super) memory: WallMemory<H>,
    pub(super) sums: Waiting,
}

impl Scratch {
    /// The sections' contacts with a prescribed wall, where there are several threads.
    pub(super) fn beside_wall<N, T: PackedHistory>(
        &self,
        reference: &Reference<'_, N, T>,
        wall: &Wall,
    ) -> Vec<BesideWall<T::History<f64>>> {
        if !self.threads.several() || wall.elastic().is_some() {
            return Vec::new();
        }
        let memory = &reference.contacts.wall;
        let beside = |section: &Section| {
            let numbers = self.spheres.number[section.own.of_grains()].iter();
            BesideWall {
                memory: memory.part(numbers.map(|&number| number as usize)),
                sums: Waiting::default(),
            }
        };
        self.shares.sections.iter().map(beside).collect()
    }

    /// Writes the histories of the contacts with a prescribed wall back, where the sections have them.
    pub(super) fn store_wall_memory<T: PackedHistory>(
        &self,
        contacts: &mut Contacts<T::History<f64>>,
        beside_wall: &[BesideWall<T::History<f64>>],
    ) {
        if beside_wall.is_empty() {
            return;
        }
        let Shares {
            sections,
            section_of,
            ..
        } = &self.shares;
        contacts.wall = WallMemory::default();
        let grains = self.spheres.place[..self.spheres.grains].iter();
        for (&place, &section) in grains.zip(section_of) {
            let section = section as usize;
            let within = place as usize - sections[section].own.start;
            let memory = &beside_wall[section].memory;
            contacts.wall.append(memory, within);
        }
    }
}

impl<N: NormalLaw, T: PackedHistory> Listed<'_, N, T> {
    /// Adds the sums over contacts with a prescribed wall after all others. With one thread there are none left to add.
    pub(super) fn add_beside_wall(&mut self) {
        if self.beside_wall.is_empty() {
            return;
        }
        let grains = self.scratch.spheres.grains;
        for &section in &self.scratch.shares.section_of[..grains] {
            let BesideWall { sums, .. } = &mut self.beside_wall[section as usize];
            sums.add_row(&mut self.sums);
        }
        for BesideWall { sums, .. } in &mut self.beside_wall {
            sums.clear();
        }
    }
}
