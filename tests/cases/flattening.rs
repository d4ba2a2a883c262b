//! Empty operands, and scenes that are built to take all memory or time.
