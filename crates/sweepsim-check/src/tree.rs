//! The bytes of trees.

/// A tree, and what it is about.
pub(crate) struct Tree<'a> {
    pub path: usize,
    pub first: usize,
    pub count: usize,
    pub solid: usize,
    pub bytes: &'a [u8],
}

/// Reads bytes.
pub(crate) struct Reader<'a>(pub &'a [u8]);

impl<'a> Reader<'a> {
    pub fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    /// Groups of seven bits, the lowest first.
    pub fn number(&mut self) -> Option<usize> {
        let mut number = 0_usize;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= usize::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (own, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(own)
    }
}

/// Trees, each after five numbers: path, first move, moves, solid, and bytes.
pub(crate) fn parts(bytes: &[u8]) -> Option<Vec<Tree<'_>>> {
    let (mut reader, mut all) = (Reader(bytes), Vec::new());
    while !reader.0.is_empty() {
        let mut number = || reader.number();
        let [path, first, count, solid, length] = [number()?, number()?, number()?, number()?, number()?];
        let bytes = reader.bytes(length)?;
        all.push(Tree {
            path,
            first,
            count,
            solid,
            bytes,
        });
    }
    Some(all)
}
