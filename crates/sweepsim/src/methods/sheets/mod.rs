//! What searches of sheets share: the points at which a line meets a piece of the moving tool are functions of one unknown, whose zeros are wanted, each exactly once.

pub(crate) mod intervals;
