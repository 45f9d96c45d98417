//! Pages as their readers meet them: decoded by code that shares nothing with the encoder, and searched for what must
//! not be in them.

mod decoder;
mod moments;
mod page;
mod scene;
mod waves;
