// Textures that hold rows and words, line after line.

// Their width.
const LINE: u32 = 4096u;
