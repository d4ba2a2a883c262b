// Cells with pruned lists: in each cell only what can matter there. Twin of `flat::prune`.

#include "common/walked.wgsl"

// Cells, then tokens, two words each; see `CellTree` on the CPU.
@group(1) @binding(5) var lists: texture_2d<u32>;

fn pruned_word(at: u32) -> vec2u {
    return textureLoad(lists, vec2u(at % LINE, at / LINE), 0).xy;
}

const TOKEN_LEAF: u32 = 0u;
const TOKEN_BEGIN: u32 = 1u;
const TOKEN_END: u32 = 2u;
const TOKEN_NEGATE: u32 = 3u;
const CELL_EMPTY: u32 = 0u;
const CELL_REFINED: u32 = 2u;
// How far the grid reaches beyond the bounds, in sides of a cell at the top: a little less, so that f32 may round.
const GRID_MARGIN: f32 = 0.1818;

var<private> pruned_component: Component;
var<private> pruned_list: vec2u;
var<private> pruned_bound: f32;

// Finds the cell around `p`: its tokens are `pruned_list.x` up to `pruned_list.y`. Where there are none,
// `pruned_bound` is a bound of the field.
fn pruned_find(p: vec3f) {
    let grid = pruned_component;
    let size = vec3f(grid.grid_counts) * grid.grid_side;
    let q = p - grid.grid_low;
    let beyond = length(max(max(-q, q - size), vec3f(0.0)));
    var side = grid.grid_side;
    let top = min(vec3u(clamp(q / side, vec3f(0.0), vec3f(8.0))), grid.grid_counts - 1u);
    var index = (top.z * grid.grid_counts.y + top.y) * grid.grid_counts.x + top.x;
    var low = vec3f(top) * side;
    var cell = pruned_word(grid.lists + index);
    while (cell.x >> 30u) == CELL_REFINED && beyond == 0.0 {
        side *= 0.25;
        let child = min(vec3u(clamp((q - low) / side, vec3f(0.0), vec3f(8.0))), vec3u(3u));
        low += vec3f(child) * side;
        cell = pruned_word(grid.lists + (cell.x & 0x3fffffffu) + child.x + child.y * 4u + child.z * 16u);
        if COUNTING {
            walked.x += 1u;
        }
    }
    let kind = cell.x >> 30u;
    let bound = bitcast<f32>(cell.y);
    let away = distance(q, low + 0.5 * side);
    pruned_bound = select(select(bound + away, bound - away, bound > 0.0), beyond + GRID_MARGIN * grid.grid_side, beyond > 0.0);
    let first = grid.lists + (cell.x & 0x3fffffffu);
    pruned_list = select(vec2u(0u), vec2u(first, first + cell.y), beyond == 0.0 && kind != CELL_EMPTY);
    if COUNTING {
        walked += vec2u(1u, pruned_list.y - pruned_list.x);
    }
}
