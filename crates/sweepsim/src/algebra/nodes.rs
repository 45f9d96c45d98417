//! Lists of cells that are divided on demand and kept: a search drops those that it has left when they are many.

/// A cell that knows its parts by their numbers in the list.
pub(crate) trait Divided {
    /// Forgets the parts if they have this number or a higher one.
    fn forget_parts(&mut self, from: u32);
}

/// A search leaves behind at most this many cells. Searches of generic moves make a few hundred.
const MOST: usize = 2048;

/// The cells of a list that were made since a search began.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Recent {
    first: usize,
    full: usize,
}

impl Recent {
    /// A search begins with so many cells, which it does not drop.
    pub fn begin(cells: usize) -> Self {
        Self {
            first: cells,
            full: cells + MOST,
        }
    }

    /// Whether so many cells are too many.
    pub fn is_full(&self, cells: usize) -> bool {
        cells > self.full
    }

    /// Drops all of these cells except for those that the search still needs, whose numbers are changed, without a change of their order.
    pub fn keep<'a, T: Divided>(&mut self, cells: &mut Vec<T>, needed: impl Iterator<Item = &'a mut u32>) {
        let first = self.first as u32;
        let needed: Vec<&mut u32> = needed.filter(|number| **number >= first).collect();
        let mut kept: Vec<u32> = needed.iter().map(|number| **number).collect();
        kept.sort_unstable();
        kept.dedup();
        for (to, from) in (self.first..).zip(&kept) {
            cells.swap(to, *from as usize);
        }
        for number in needed {
            *number = first + kept.partition_point(|kept| *kept < *number) as u32;
        }
        drop_from(cells, self.first + kept.len());
        forget_from(cells, self.first);
        self.full = cells.len() + MOST;
    }
}

/// Drops the cells from this number on, and forgets that others had been divided into them.
pub(crate) fn drop_from<T: Divided>(cells: &mut Vec<T>, first: usize) {
    cells.truncate(first);
    forget_from(cells, first);
}

fn forget_from<T: Divided>(cells: &mut [T], first: usize) {
    for cell in cells {
        cell.forget_parts(first as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    /// A cell with a name.
    #[derive(Clone, Debug)]
    struct Named {
        name: u32,
        part: u32,
    }

    impl Divided for Named {
        fn forget_parts(&mut self, from: u32) {
            if self.part >= from {
                self.part = u32::MAX;
            }
        }
    }

    proptest! {
        /// What is needed keeps its order and content, older cells keep their numbers, and no part is left that is not there.
        #[test]
        fn needed_cells_stay(
            before in 1..20_usize, after in 0..60_usize, parts in collection::vec(0..100_u32, 80), needed in collection::vec(0..100_u32, 0..12),
        ) {
            let count = before + after;
            let mut cells: Vec<Named> = (0..count).map(|k| Named { name: k as u32, part: parts[k] % count as u32 }).collect();
            let old = cells.clone();
            let mut recent = Recent::begin(before);
            let mut numbers: Vec<u32> = needed.iter().map(|number| number % count as u32).collect();
            let names = numbers.clone();
            recent.keep(&mut cells, numbers.iter_mut());
            for (number, name) in numbers.iter().zip(&names) {
                prop_assert_eq!(cells[*number as usize].name, *name);
                prop_assert!((*name as usize) >= before || number == name);
            }
            prop_assert!(cells.windows(2).all(|pair| pair[0].name < pair[1].name));
            prop_assert!(cells.len() <= before + names.len() && cells[..before].iter().zip(&old).all(|(a, b)| a.name == b.name));
            for cell in &cells {
                let part = old[cell.name as usize].part;
                prop_assert_eq!(cell.part, if (part as usize) < before { part } else { u32::MAX });
            }
            prop_assert!(!recent.is_full(cells.len() + MOST) && recent.is_full(cells.len() + MOST + 1));
        }
    }
}
