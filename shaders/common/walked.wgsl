// Cells, and entries of their tapes, that a tape evaluator has read so far, in counting pipelines.

var<private> walked: vec2u;
