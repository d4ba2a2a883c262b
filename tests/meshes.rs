//! glTF files: what is read from good ones, and how bad ones are refused. The shipped scenes.

mod asset;
mod broken;
mod escapes;
mod gallery;
mod mutated;
mod rays;
mod reading;
mod tiny;
