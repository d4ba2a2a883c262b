//! Input in the editor: keys, clicks, numbers.
