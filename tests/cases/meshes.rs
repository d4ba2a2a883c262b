//! glTF models.
