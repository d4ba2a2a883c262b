//! Choice of evaluators, and how long compiling keeps a picture waiting.
