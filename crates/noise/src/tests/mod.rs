//! The noise against its definitions: the cipher, the transform, the law, the pass.

#![allow(clippy::disallowed_methods, reason = "definitions are written with the functions of the platform")]

mod cipher;
mod law;
mod means;
mod pass;
mod transform;
