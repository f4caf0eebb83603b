//! The noise against its definitions: the cipher, the transform, the law, the pass.

mod cipher;
mod law;
mod means;
mod pass;
mod transform;
