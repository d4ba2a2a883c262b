//! The reference renderer, and how pictures are compared with it.
