//! Blocks that were read lately, so that loops do not read theirs again and long programs do not keep all.

use std::cell::RefCell;
use std::rc::Rc;

/// The number of blocks that are kept: longer loops read theirs each time.
const KEPT: usize = 1024;

/// The blocks read last, each in the place that its number has modulo [`KEPT`].
pub(super) struct Recent<T>(RefCell<Vec<KeptBlock<T>>>);

/// A block with its number.
type KeptBlock<T> = Option<(usize, Rc<T>)>;

impl<T> Default for Recent<T> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<T> Recent<T> {
    /// A block by its number, which `read` reads if it is not here. What fails is not kept.
    pub fn get<E>(&self, number: usize, read: impl FnOnce() -> Result<T, E>) -> Result<Rc<T>, E> {
        let place = number % KEPT;
        if let Some(Some((kept, block))) = self.0.borrow().get(place)
            && *kept == number
        {
            return Ok(Rc::clone(block));
        }
        let block = Rc::new(read()?);
        let mut blocks = self.0.borrow_mut();
        if blocks.len() <= place {
            blocks.resize_with(place + 1, || None);
        }
        blocks[place] = Some((number, Rc::clone(&block)));
        Ok(block)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_their_own() {
        let recent = Recent::default();
        let mut read = 0;
        let mut get = |number: usize| {
            let block = recent.get(number, || {
                read += 1;
                if number == 7 { Err(()) } else { Ok(number) }
            });
            (block.map(|block| *block), read)
        };
        assert_eq!(get(3), (Ok(3), 1));
        assert_eq!(get(3), (Ok(3), 1));
        assert_eq!(get(3 + KEPT), (Ok(3 + KEPT), 2));
        assert_eq!(get(3), (Ok(3), 3));
        assert_eq!(get(7), (Err(()), 4));
        assert_eq!(get(7), (Err(()), 5));
    }
}
