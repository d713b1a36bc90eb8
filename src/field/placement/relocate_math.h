// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 4. The hits of a probe's fixed rays, and the steps of its
// relocation (relocate.inl.h computes where each step leads).
#ifndef LAMBENT_FIELD_PLACEMENT_RELOCATE_MATH_H
#define LAMBENT_FIELD_PLACEMENT_RELOCATE_MATH_H

#include "field/probes/probe_grid.h"

LAMBENT_BEGIN

// The most steps of a search. Most probes need two, those in corners four.
const int kMaxRelocationSteps = 8;

// Probes stand in front of surfaces by this fraction of the smallest spacing. With a smaller
// margin, their distances in grazing directions are too coarse to distinguish the near side of a
// wall from the far one: in the two rooms of `scripts/measure leaks` with probes 1 m apart, the
// mean light behind the sealed wall of 5 cm is 0.58 % of that with the door open at a margin of
// 0.1, and 0.14 % at this one. With a larger margin, surfaces lie outside the hull of the probes.
const float kSurfaceMargin = 0.15f;

// Between two surfaces whose distance is below this fraction of the smallest spacing, there is no
// room for a probe: they are taken as a sheet, such as a wall without thickness in which a layer of
// probes happens to lie. The fraction is far above the rounding of hits.
const float kLeastRoom = 1e-3f;

// A probe within this fraction of the margin from its best place stays, so that it never
// oscillates.
const float kMarginTolerance = 0.25f;

// Only hits with at least this cosine between ray and normal count as planes below the probe: the
// surface must pass under the probe, not just lie in the same plane far away.
const float kMinFacingCosine = 0.7f;

// Surfaces whose normals' cosine is below this count as facing different ways, as in a corner.
const float kMaxCornerCosine = 0.5f;

// The least sine of the angle between a plane's normal and those of the planes that a probe already
// stands in front of. Planes at a smaller angle are skipped, since a step towards a plane along the
// others is divided by the sine.
const float kMinSteepness = 0.5f;

// The additional cost of a place inside geometry that the probe can leave [margins]. It exceeds the
// cost of any place outside.
const float kInsideGeometryCost = 100.0f;

/// The hit of a probe's fixed ray on static geometry, in the frame of the probe's grid.
struct FixedRayHit {
  vec3 direction;    ///< Direction of the ray, unit.
  float distance;    ///< [m]; infinite for a miss.
  vec3 normal;       ///< Normal of the triangle, unit, towards the probe.
  uint from_inside;  ///< 1: the side that the ray hit bounds solid matter.
};

LAMBENT_FN bool missed(FixedRayHit hit) {
  return hit.distance == infinity();
}

/// The plane of a surface that passes below a probe.
struct PlaneBelow {
  vec3 normal;   ///< Unit, towards the probe.
  float height;  ///< Height of the probe over the plane [m].
};

LAMBENT_FN bool passes_below(FixedRayHit hit) {
  float cosine = -dot(hit.direction, hit.normal);
  return hit.from_inside == 0u && !missed(hit) && cosine >= kMinFacingCosine;
}

LAMBENT_FN PlaneBelow plane_below(FixedRayHit hit) {
  PlaneBelow plane = {hit.normal, hit.distance * -dot(hit.direction, hit.normal)};
  return plane;
}

/// Whether the coordinates under which a probe is stored have an odd sum. Its neighbours on the
/// grid differ, except where a scrolled grid with an odd number of probes wraps around.
LAMBENT_FN uint is_odd_probe(ProbeGrid grid, int probe) {
  ivec3 stored = stored_coords(grid, probe_coords(grid, probe));
  return uint(stored.x + stored.y + stored.z) & 1u;
}

/// The side of a sheet to which a probe within it moves, as the plane below it. Neighbours move to
/// different sides, so that both are lit.
LAMBENT_FN PlaneBelow side_of_sheet(PlaneBelow sheet, uint odd) {
  vec3 n = abs(sheet.normal);
  float largest = n.x >= n.y && n.x >= n.z ? sheet.normal.x
                  : n.y >= n.z             ? sheet.normal.y
                                           : sheet.normal.z;
  bool turned = (largest < 0.0f) != (odd != 0u);
  PlaneBelow side = {turned ? -sheet.normal : sheet.normal, turned ? -sheet.height : sheet.height};
  return side;
}

/// Whether a probe whose place on the grid is `grid_position` may stand at a position.
LAMBENT_FN bool within_reach(vec3 position, vec3 grid_position, vec3 spacing) {
  vec3 cells = abs((position - grid_position) / spacing);
  return max(cells.x, max(cells.y, cells.z)) <= kMaxProbeOffset;
}

/// The cost of a probe's position: its distance from the better one [margins], and more inside
/// geometry.
LAMBENT_FN float placement_cost(vec3 position, vec3 better, float margin, uint inside_geometry) {
  float cost = length(better - position) / margin;
  return better != position && inside_geometry != 0u ? cost + kInsideGeometryCost : cost;
}

/// The state of a probe's relocation. A search steps from one better position to the next, and ends
/// at the position of least cost. From there another search begins, until one finds no position
/// that is clearly better than its first. Each search that moves the probe lowers its cost, so that
/// relocation converges even in clutter, where every step leads to another. Offsets are in cells.
struct RelocationState {
  vec3 first;
  vec3 best;
  float least;     ///< The cost of the best offset.
  int steps;       ///< Steps taken in this search.
  uint converged;  ///< 1: relocation has converged.
};

LAMBENT_FN RelocationState begin_relocation(vec3 offset) {
  RelocationState relocation = {offset, offset, infinity(), 0, 0u};
  return relocation;
}

/// Ends a search at the best offset so far. Begins another search from there, unless the search
/// began at the best offset: relocation has then converged. Returns the best offset.
LAMBENT_FN vec3 end_relocation(LAMBENT_INOUT(RelocationState) relocation) {
  vec3 best = relocation.best;
  if (relocation.best == relocation.first) {
    relocation.converged = 1u;
  } else {
    relocation = begin_relocation(best);
  }
  return best;
}

/// Takes one step from `offset`, whose cost is given, towards `better`, which equals `offset` where
/// the probe should stay. Returns the offset for the next step.
LAMBENT_FN vec3 relocation_step(LAMBENT_INOUT(RelocationState) relocation, vec3 offset, vec3 better,
                                float cost) {
  if (relocation.steps == 0 || cost <= relocation.least) {
    relocation.best = offset;
    // Leave the first position only for one that is clearly better
    relocation.least = relocation.steps == 0 ? cost - kMarginTolerance : cost;
  }
  if (better != offset) {
    ++relocation.steps;
    if (relocation.steps <= kMaxRelocationSteps) return better;
  }
  return end_relocation(relocation);
}

LAMBENT_END
#endif
