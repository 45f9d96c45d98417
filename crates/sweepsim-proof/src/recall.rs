//! Answers that are known from earlier work.
//!
//! A search is asked for parts of a work one by one; what it answers follows from the question alone. So an answer may
//! be kept by a digest of the question, and is the same whether it was kept or not.

use crate::statement::{OpenBox, Witness};

/// A digest of a question.
pub type QuestionDigest = [u8; 32];

/// Keeps answers by digests of their questions. `()` keeps none.
///
/// What the questions themselves do not tell has to be known to whoever keeps answers: all answers of one keeper are
/// about the same target and the same stock.
pub trait Recall: Sync {
    /// Whether anything is kept; otherwise no digests are made.
    fn keeps(&self) -> bool {
        false
    }

    /// The digest of a question: no two questions may have the same.
    fn digest(&self, question: &[u8]) -> QuestionDigest {
        let _ = question;
        QuestionDigest::default()
    }

    /// The answer, if it is known.
    fn recall(&self, question: &QuestionDigest) -> Option<Vec<u8>> {
        let _ = question;
        None
    }

    /// Keeps an answer.
    fn keep(&self, question: &QuestionDigest, answer: Vec<u8>) {
        let _ = (question, answer);
    }
}

impl Recall for () {}

/// Values as bytes.
#[derive(Clone, Default)]
pub(crate) struct Writing(pub Vec<u8>);

impl Writing {
    pub fn number(&mut self, number: usize) {
        self.0.extend((number as u64).to_le_bytes());
    }

    pub fn floats(&mut self, all: &[f64]) {
        all.iter().for_each(|own| self.0.extend(own.to_le_bytes()));
    }

    pub fn bytes(&mut self, bytes: &[u8]) {
        self.number(bytes.len());
        self.0.extend_from_slice(bytes);
    }

    pub fn list<T>(&mut self, all: impl ExactSizeIterator<Item = T>, mut write: impl FnMut(&mut Self, T)) {
        self.number(all.len());
        all.for_each(|own| write(self, own));
    }

    pub fn witness(&mut self, own: &Witness) {
        self.number(own.number);
        self.number(own.piece.0);
        self.floats(&[own.time, own.piece.1, own.depth]);
        self.floats(&own.place);
    }

    pub fn open(&mut self, own: &OpenBox) {
        for (number, time) in [own.first, own.last] {
            self.number(number);
            self.floats(&[time]);
        }
        self.floats(&own.low);
        self.floats(&own.high);
        self.floats(&[own.depth]);
    }
}

/// Values that were written.
pub(crate) struct Reading<'a>(pub &'a [u8]);

impl Reading<'_> {
    fn next(&mut self) -> Option<[u8; 8]> {
        let (own, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*own)
    }

    pub fn number(&mut self) -> Option<usize> {
        usize::try_from(u64::from_le_bytes(self.next()?)).ok()
    }

    pub fn float(&mut self) -> Option<f64> {
        self.next().map(f64::from_le_bytes)
    }

    pub fn point(&mut self) -> Option<[f64; 3]> {
        Some([self.float()?, self.float()?, self.float()?])
    }

    pub fn bytes(&mut self) -> Option<Vec<u8>> {
        let count = self.number()?;
        let (own, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(own.to_vec())
    }

    pub fn list<T>(&mut self, mut read: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        // Whatever is listed takes at least a byte.
        let count = self.number().filter(|count| *count <= self.0.len())?;
        (0..count).map(|_| read(self)).collect()
    }

    pub fn witness(&mut self) -> Option<Witness> {
        let (number, piece) = (self.number()?, self.number()?);
        let [time, parameter, depth] = self.point()?;
        Some(Witness {
            number,
            time,
            piece: (piece, parameter),
            place: self.point()?,
            depth,
        })
    }

    pub fn open(&mut self) -> Option<OpenBox> {
        Some(OpenBox {
            first: (self.number()?, self.float()?),
            last: (self.number()?, self.float()?),
            low: self.point()?,
            high: self.point()?,
            depth: self.float()?,
        })
    }

    /// A value, if nothing comes after it.
    pub fn last<T>(&self, value: T) -> Option<T> {
        self.0.is_empty().then_some(value)
    }
}

/// What is found, as bytes.
pub(crate) trait Answer: Sized {
    fn write(&self, to: &mut Writing);
    fn read(from: &mut Reading) -> Option<Self>;

    /// All of some parts of a work.
    fn write_all(all: &[Self]) -> Vec<u8> {
        let mut to = Writing::default();
        to.list(all.iter(), |to, own| own.write(to));
        to.0
    }

    fn read_all(bytes: &[u8], count: usize) -> Option<Vec<Self>> {
        let mut from = Reading(bytes);
        let all = from.list(Self::read)?;
        from.last(all).filter(|all| all.len() == count)
    }
}
