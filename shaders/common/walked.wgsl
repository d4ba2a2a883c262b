// What an evaluator with tapes has read so far, where pipelines count: cells, and entries of their tapes.

var<private> walked: vec2u;
