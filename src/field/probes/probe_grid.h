// SPDX-License-Identifier: Apache-2.0
// Where the probes of a volume stand, which eight surround a point, and how much the volume has to
// say about it.
#ifndef LAMBENT_FIELD_PROBES_PROBE_GRID_H
#define LAMBENT_FIELD_PROBES_PROBE_GRID_H

#include "shared/packing.h"

LAMBENT_BEGIN

// Above this a grid is a typing error: it would take 1.2 GB for the store alone.
const int kMaxProbes = 1048576;

// The longest distance counts between 2^6 and 2^7 units: squares reach almost to the largest half,
// so that those of short distances stay above the smallest.
const int kDistanceUnitBits = 6;

/// A volume: a regular grid of probes, turned any way. Probe c belongs at origin_ws + axes * (c *
/// spacing). A volume that follows the viewer keeps its probes where they are in memory as it moves
/// on: what was the first slab becomes the last (toroidal addressing).
struct ProbeGrid {
  vec3 origin_ws;    ///< [m]
  vec3 spacing;      ///< [m], > 0
  mat3 axes;         ///< Columns: the grid's axes in world space, unit and orthogonal.
  ivec3 count;       ///< >= 2 along each axis
  ivec3 scroll;      ///< Probe c is stored as the one of coordinates (c + scroll) mod count; >= 0.
  int first;         ///< Index of the probe stored first, among those of all volumes.
  vec3 fade_centre;  ///< Of the box in which the volume counts [cells from probe 0].
  vec3 fade_half;    ///< Half the size of that box [cells]; > 0.
  vec3 fade_cells;   ///< Across so many cells within its faces the volume hands over; > 0.
};

LAMBENT_FN int probe_count(ProbeGrid grid) {
  return grid.count.x * grid.count.y * grid.count.z;
}

/// A point in cells from probe 0, along the grid's axes.
LAMBENT_FN vec3 grid_coords(ProbeGrid grid, vec3 position_ws) {
  return ((position_ws - grid.origin_ws) * grid.axes) / grid.spacing;
}

/// The point that lies so many cells from probe 0.
LAMBENT_FN vec3 grid_position(ProbeGrid grid, vec3 cells) {
  return grid.origin_ws + grid.axes * (grid.spacing * cells);
}

LAMBENT_FN vec3 probe_position(ProbeGrid grid, ivec3 coords) {
  return grid_position(grid, vec3(coords));
}

/// Where a probe stands that is so many cells off its place on the grid.
LAMBENT_FN vec3 placed_position(ProbeGrid grid, ivec3 coords, vec3 offset) {
  return probe_position(grid, coords) + grid.axes * (offset * grid.spacing);
}

/// Smallest distance between neighbouring probes [m].
LAMBENT_FN float smallest_spacing(ProbeGrid grid) {
  return min(grid.spacing.x, min(grid.spacing.y, grid.spacing.z));
}

/// Coordinates of the place in memory of a probe.
LAMBENT_FN ivec3 stored_coords(ProbeGrid grid, ivec3 coords) {
  ivec3 c = coords + grid.scroll;
  return ivec3(c.x < grid.count.x ? c.x : c.x - grid.count.x,
               c.y < grid.count.y ? c.y : c.y - grid.count.y,
               c.z < grid.count.z ? c.z : c.z - grid.count.z);
}

/// Index of a probe among those of all volumes.
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

/// The cell around a point: its lowest probe and the point's place between that and the highest, 0
/// to 1.
struct ProbeCell {
  ivec3 base;
  vec3 fraction;
};

/// The cell that holds the point, or the nearest one: a point beyond the grid is lit by the probes
/// nearest to it.
LAMBENT_FN ProbeCell probe_cell(ProbeGrid grid, vec3 position_ws) {
  vec3 cells = vec3(grid.count - ivec3(1));
  // In this order of arguments a NaN becomes 0
  vec3 p = min(max(vec3(0.0f), grid_coords(grid, position_ws)), cells);
  vec3 base = min(floor(p), cells - vec3(1.0f));
  ProbeCell cell = {ivec3(base), p - base};
  return cell;
}

// Values of cell_wrap: each combination of three directions.
const int kCellWraps = 8;

/// In which directions, by bits as of a corner, a cell runs over the end of memory to its
/// beginning. Its corners lie elsewhere relative to its lowest probe then.
LAMBENT_FN int cell_wrap(ProbeGrid grid, ivec3 base) {
  ivec3 c = stored_coords(grid, base);
  return (c.x + 1 == grid.count.x ? 1 : 0) | (c.y + 1 == grid.count.y ? 2 : 0) |
         (c.z + 1 == grid.count.z ? 4 : 0);
}

/// What a volume has to say about a point, 0 to 1: 1 well inside the box in which it counts, fading
/// to 0 at its faces; where it is thin, all the way from the middle.
LAMBENT_FN float volume_blend_weight(ProbeGrid grid, vec3 position_ws) {
  vec3 inside = grid.fade_half - abs(grid_coords(grid, position_ws) - grid.fade_centre);
  vec3 weight = inside / min(grid.fade_half, grid.fade_cells);
  return clamp(min(weight.x, min(weight.y, weight.z)), 0.0f, 1.0f);
}

const int kCellCorners = 8;

/// Corner 0..7 of a cell as an offset: bit 0 is x, bit 1 is y, bit 2 is z.
LAMBENT_FN ivec3 cell_corner(int corner) {
  return ivec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
}

// Distances are only compared with those to points of the cells around a probe, at most a cell's
// diagonal away; longer ones are cut to this many diagonals, so that far surfaces do not swamp the
// variance of near ones.
const float kMaxDistanceDiagonals = 1.5f;

/// The longest distance that a probe holds [m].
LAMBENT_FN float max_probe_distance(ProbeGrid grid) {
  return kMaxDistanceDiagonals * length(grid.spacing);
}

/// The unit in which tiles hold distances and, squared, their squares [m]: of its own for each
/// grid, so that scenes of millimetres and of kilometres fit the range of halves alike (squares
/// stay below 2^14); a power of two, so that changing units rounds nothing.
LAMBENT_FN float distance_unit(ProbeGrid grid) {
  int exponent = int(floatBitsToUint(max_probe_distance(grid)) >> 23u) - kFloatBias;
  return power_of_two(exponent - kDistanceUnitBits);
}

// Probes leave their place on the grid by at most this share of a cell along each axis, so that
// they never pass each other. JCGT 10(2) 2021, sec. 4.
const float kMaxProbeOffset = 0.45f;

// Offsets are stored as three signed numbers of 10 bits; 511 stands for kMaxProbeOffset.
const int kOffsetBits = 10;
const float kOffsetSteps = 511.0f;

/// Offset of a probe from its place on the grid, in shares of a cell, clamped to what can be
/// stored.
LAMBENT_FN uint encode_probe_offset(vec3 cells) {
  vec3 steps = clamp(cells / kMaxProbeOffset, vec3(-1.0f), vec3(1.0f)) * kOffsetSteps;
  ivec3 q = ivec3(floor(steps + vec3(0.5f)));
  return (uint(q.x) & 1023u) | ((uint(q.y) & 1023u) << 10u) | ((uint(q.z) & 1023u) << 20u);
}

LAMBENT_FN vec3 decode_probe_offset(uint word) {
  // Shift each number's sign to the top and back
  ivec3 q = ivec3(int(word << 22u) >> 22, int(word << 12u) >> 22, int(word << 2u) >> 22);
  return vec3(q) * (kMaxProbeOffset / kOffsetSteps);
}

/// Trilinear weight of a corner.
LAMBENT_FN float trilinear_weight(vec3 fraction, ivec3 corner) {
  vec3 w = mix(vec3(1.0f) - fraction, fraction, vec3(corner));
  return w.x * w.y * w.z;
}

LAMBENT_END
#endif
