// Cells with simplified tapes, which hold only the entries that matter in the cell. Counterpart of
// `src/field/tape`.

#include "common/walked.wgsl"

// Headers, cells, then tape entries, two words each; see `CellTree` on the CPU.
@group(1) @binding(4) var tapes: texture_storage_2d<rg32uint, read>;

fn tape_word(at: u32) -> vec2u {
    return textureLoad(tapes, vec2u(at % LINE, at / LINE)).xy;
}

const TAPE_LEAF: u32 = 0u;
const TAPE_BEGIN: u32 = 1u;
const TAPE_END: u32 = 2u;
const TAPE_NEGATE: u32 = 3u;
// First of the shape codes of modifiers.
const MODIFIED: u32 = 0xc0u;
const HEADER_WORDS: u32 = 4u;
const CELL_EMPTY: u32 = 0u;
const CELL_REFINED: u32 = 2u;
// Margin of the grid around the bounds, in sides of a top cell: slightly less than on the CPU, to
// allow for the rounding of f32.
const GRID_MARGIN: f32 = 0.1818;

// Top cells of a space: lower corner, side and numbers, their first word, and a lower bound of the
// distance to the surface from outside the grid.
struct TapeGrid {
    low: vec3f,
    side: f32,
    counts: vec3u,
    cells: u32,
    clear: f32,
}

var<private> tape_component: Component;
var<private> tape_range: vec2u;
var<private> tape_bound: f32;
// Distance from the middle of an empty cell, else 0.
var<private> tape_slack: f32;

// The grid of the component's own space.
fn tape_own_grid() -> TapeGrid {
    let c = tape_component;
    return TapeGrid(c.grid_low, c.grid_side, c.grid_counts, c.tapes, GRID_MARGIN * c.grid_side);
}

// The grid of a modifier's content; `content` counts from 1.
fn tape_modifier_grid(content: u32) -> TapeGrid {
    let at = tape_component.tapes - HEADER_WORDS * content;
    let a = bitcast<vec2f>(tape_word(at));
    let b = bitcast<vec2f>(tape_word(at + 1u));
    let c = tape_word(at + 2u);
    let counts = vec3u(c.x & 0xffu, (c.x >> 8u) & 0xffu, c.x >> 16u);
    let clear = bitcast<f32>(tape_word(at + 3u).x);
    return TapeGrid(vec3f(a, b.x), b.y, counts, tape_component.tapes + c.y, clear);
}

// Finds the cell around `p` in the space of the grid. Its tape entries are `tape_range.x` up to
// `tape_range.y`. If there are none, `tape_bound` is a bound of the field.
fn tape_find(grid: TapeGrid, p: vec3f) {
    let size = vec3f(grid.counts) * grid.side;
    let q = p - grid.low;
    let beyond = length(max(max(-q, q - size), vec3f(0.0)));
    var side = grid.side;
    let top = min(vec3u(clamp(q / side, vec3f(0.0), vec3f(8.0))), grid.counts - 1u);
    var index = (top.z * grid.counts.y + top.y) * grid.counts.x + top.x;
    var low = vec3f(top) * side;
    let tapes = tape_component.tapes;
    var cell = tape_word(grid.cells + index);
    while (cell.x >> 30u) == CELL_REFINED && beyond == 0.0 {
        side *= 0.25;
        let child = min(vec3u(clamp((q - low) / side, vec3f(0.0), vec3f(8.0))), vec3u(3u));
        low += vec3f(child) * side;
        cell = tape_word(tapes + (cell.x & 0x3fffffffu) + child.x + child.y * 4u + child.z * 16u);
        if COUNTING {
            walked.x += 1u;
        }
    }
    let kind = cell.x >> 30u;
    let bound = bitcast<f32>(cell.y);
    let away = distance(q, low + 0.5 * side);
    tape_bound = select(select(bound + away, bound - away, bound > 0.0), beyond + grid.clear, beyond > 0.0);
    tape_slack = select(0.0, away, beyond == 0.0 && kind == CELL_EMPTY);
    let first = tapes + (cell.x & 0x3fffffffu);
    tape_range = select(vec2u(0u), vec2u(first, first + cell.y), beyond == 0.0 && kind != CELL_EMPTY);
    if COUNTING {
        walked += vec2u(1u, tape_range.y - tape_range.x);
    }
}
