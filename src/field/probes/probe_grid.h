// SPDX-License-Identifier: Apache-2.0
// The grid of a volume: the places of its probes, the cell around a point, and the volume's weight
// there.
#ifndef LAMBENT_FIELD_PROBES_PROBE_GRID_H
#define LAMBENT_FIELD_PROBES_PROBE_GRID_H

#include "shared/packing.h"

LAMBENT_BEGIN

// The most probes of a field. A larger grid would take 1.2 GB for the store alone, and is most
// likely a typing error.
const int kMaxProbes = 1048576;

// The longest stored distance has between 2^6 and 2^7 units. Its square is then close to the
// largest half, which keeps the squares of short distances above the smallest half.
const int kDistanceUnitBits = 6;

/// A volume: a regular grid of probes with any rotation. The place of probe c on the grid is
/// origin_ws + axes * (c * spacing). When a volume scrolls, its probes stay where they are in
/// memory, and the slab that is left behind becomes the one in front (toroidal addressing).
struct ProbeGrid {
  vec3 origin_ws;    ///< [m]
  vec3 spacing;      ///< [m], > 0
  mat3 axes;         ///< Columns: the grid's axes in world space, unit and orthogonal.
  ivec3 count;       ///< >= 2 along each axis
  ivec3 scroll;      ///< Probe c is stored as the one of coordinates (c + scroll) mod count; >= 0.
  int first;         ///< Index of the probe stored first, among the probes of all volumes.
  vec3 fade_centre;  ///< Centre of the box in which it has a weight [cells from probe 0].
  vec3 fade_half;    ///< Half the size of that box [cells]; > 0.
  vec3 fade_cells;   ///< The weight falls to 0 across this many cells within the box's faces; > 0.
};

LAMBENT_FN int probe_count(ProbeGrid grid) {
  return grid.count.x * grid.count.y * grid.count.z;
}

/// A point in cells from probe 0, along the grid's axes.
LAMBENT_FN vec3 grid_coords(ProbeGrid grid, vec3 position_ws) {
  return ((position_ws - grid.origin_ws) * grid.axes) / grid.spacing;
}

/// The point at these grid coordinates, given in cells from probe 0.
LAMBENT_FN vec3 grid_position(ProbeGrid grid, vec3 cells) {
  return grid.origin_ws + grid.axes * (grid.spacing * cells);
}

LAMBENT_FN vec3 probe_position(ProbeGrid grid, ivec3 coords) {
  return grid_position(grid, vec3(coords));
}

/// The position of a probe that is offset from its place on the grid [cells].
LAMBENT_FN vec3 placed_position(ProbeGrid grid, ivec3 coords, vec3 offset) {
  return probe_position(grid, coords) + grid.axes * (offset * grid.spacing);
}

/// Smallest distance between neighbouring probes [m].
LAMBENT_FN float smallest_spacing(ProbeGrid grid) {
  return min(grid.spacing.x, min(grid.spacing.y, grid.spacing.z));
}

/// The coordinates under which a probe is stored in memory.
LAMBENT_FN ivec3 stored_coords(ProbeGrid grid, ivec3 coords) {
  ivec3 c = coords + grid.scroll;
  return ivec3(c.x < grid.count.x ? c.x : c.x - grid.count.x,
               c.y < grid.count.y ? c.y : c.y - grid.count.y,
               c.z < grid.count.z ? c.z : c.z - grid.count.z);
}

/// The index of a probe among the probes of all volumes.
LAMBENT_FN int probe_index(ProbeGrid grid, ivec3 coords) {
  ivec3 c = stored_coords(grid, coords);
  return grid.first + c.x + grid.count.x * (c.y + grid.count.y * c.z);
}

LAMBENT_FN ivec3 probe_coords(ProbeGrid grid, int index) {
  int i = index - grid.first;
  ivec3 c = ivec3(i % grid.count.x, (i / grid.count.x) % grid.count.y,
                  i / (grid.count.x * grid.count.y)) -
            grid.scroll;
  return ivec3(c.x < 0 ? c.x + grid.count.x : c.x, c.y < 0 ? c.y + grid.count.y : c.y,
               c.z < 0 ? c.z + grid.count.z : c.z);
}

/// The cell around a point: its lowest probe, and the point's place between that and the highest
/// one, 0 to 1 along each axis.
struct ProbeCell {
  ivec3 base;
  vec3 fraction;
};

/// The cell that contains a point. A point beyond the grid gets the nearest cell, whose probes
/// light it.
LAMBENT_FN ProbeCell probe_cell(ProbeGrid grid, vec3 position_ws) {
  vec3 cells = vec3(grid.count - ivec3(1));
  // In this order of arguments a NaN becomes 0
  vec3 p = min(max(vec3(0.0f), grid_coords(grid, position_ws)), cells);
  vec3 base = min(floor(p), cells - vec3(1.0f));
  ProbeCell cell = {ivec3(base), p - base};
  return cell;
}

// The number of values of cell_wrap: all combinations of three directions.
const int kCellWraps = 8;

/// The directions in which a cell wraps around the end of memory to its beginning, as the bits of
/// cell_corner(). The corners of such a cell have other indices relative to its lowest probe.
LAMBENT_FN int cell_wrap(ProbeGrid grid, ivec3 base) {
  ivec3 c = stored_coords(grid, base);
  return (c.x + 1 == grid.count.x ? 1 : 0) | (c.y + 1 == grid.count.y ? 2 : 0) |
         (c.z + 1 == grid.count.z ? 4 : 0);
}

/// The blend weight of a volume at a point: 1 well inside the box in which the volume has a weight,
/// falling to 0 at the box's faces. In a box thinner than twice fade_cells, it falls from the
/// middle on.
LAMBENT_FN float volume_blend_weight(ProbeGrid grid, vec3 position_ws) {
  vec3 inside = grid.fade_half - abs(grid_coords(grid, position_ws) - grid.fade_centre);
  vec3 weight = inside / min(grid.fade_half, grid.fade_cells);
  return clamp(min(weight.x, min(weight.y, weight.z)), 0.0f, 1.0f);
}

/// The share that a volume takes of the weight which the volumes before it leave at a point: its
/// blend weight, or all of it in the last of `volumes`.
LAMBENT_FN float volume_share(ProbeGrid grid, int volume, int volumes, vec3 position_ws) {
  return volume + 1 == volumes ? 1.0f : volume_blend_weight(grid, position_ws);
}

const int kCellCorners = 8;

/// Corner 0..7 of a cell as an offset: bit 0 is x, bit 1 is y, bit 2 is z.
LAMBENT_FN ivec3 cell_corner(int corner) {
  return ivec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
}

// Stored distances are compared only with distances to points of the cells around a probe, which
// are at most a cell's diagonal away. Stored distances are clamped to this many diagonals, so that
// far surfaces do not dominate the variance.
const float kMaxDistanceDiagonals = 1.5f;

/// The longest distance that a probe stores [m].
LAMBENT_FN float max_probe_distance(ProbeGrid grid) {
  return kMaxDistanceDiagonals * length(grid.spacing);
}

/// The unit in which tiles store distances [m]; squared distances are stored in its square. Each
/// grid has its own, so that scenes of millimetres and of kilometres fit the range of halves
/// (squares stay below 2^14). It is a power of two, so that conversion does not round.
LAMBENT_FN float distance_unit(ProbeGrid grid) {
  int exponent = int(floatBitsToUint(max_probe_distance(grid)) >> 23u) - kFloatBias;
  return power_of_two(exponent - kDistanceUnitBits);
}

// The largest offset of a probe from its place on the grid, along each axis [cells]. It is below
// 0.5, so that probes never pass each other. JCGT 10(2) 2021, sec. 4.
const float kMaxProbeOffset = 0.45f;

// Offsets are stored as three signed numbers of 10 bits; 511 stands for kMaxProbeOffset.
const int kOffsetBits = 10;
const float kOffsetSteps = 511.0f;

/// Encodes the offset of a probe from its place on the grid [cells], clamped to kMaxProbeOffset.
LAMBENT_FN uint encode_probe_offset(vec3 cells) {
  vec3 steps = clamp(cells / kMaxProbeOffset, vec3(-1.0f), vec3(1.0f)) * kOffsetSteps;
  ivec3 q = ivec3(floor(steps + vec3(0.5f)));
  return (uint(q.x) & 1023u) | ((uint(q.y) & 1023u) << 10u) | ((uint(q.z) & 1023u) << 20u);
}

LAMBENT_FN vec3 decode_probe_offset(uint word) {
  // Extend each number's sign
  ivec3 q = ivec3(int(word << 22u) >> 22, int(word << 12u) >> 22, int(word << 2u) >> 22);
  return vec3(q) * (kMaxProbeOffset / kOffsetSteps);
}

/// Trilinear weight of a corner.
LAMBENT_FN float trilinear_weight(vec3 fraction, ivec3 corner) {
  return (corner.x != 0 ? fraction.x : 1.0f - fraction.x) *
         (corner.y != 0 ? fraction.y : 1.0f - fraction.y) *
         (corner.z != 0 ? fraction.z : 1.0f - fraction.z);
}

LAMBENT_END
#endif
