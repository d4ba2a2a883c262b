//! Truth tracer.
