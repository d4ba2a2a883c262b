//! glTF files: what is read from good ones, and how bad ones are refused.

mod asset;
mod broken;
mod escapes;
mod mutated;
mod rays;
mod reading;
mod tiny;
