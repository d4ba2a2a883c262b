// What an evaluator with lists has read so far, where kernels count: cells, and tokens of their lists.

var<private> walked: vec2u;
