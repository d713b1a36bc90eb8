// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 4. What a probe sees around it, and how it walks to where it
// stands better (relocate.inl.h).
#ifndef LAMBENT_FIELD_PLACEMENT_RELOCATE_MATH_H
#define LAMBENT_FIELD_PLACEMENT_RELOCATE_MATH_H

#include "field/transport/blend_math.h"

LAMBENT_BEGIN

// Steps of one walk. Most probes stand well after two, those in corners after four.
const int kMaxRelocationSteps = 8;

// Probes stand in front of surfaces by this share of the smallest spacing. Nearer, their distances
// towards grazing directions are too coarse to tell the near side of a wall from the far one
// (behind a closed wall of 5 cm, probes 1 m apart: 0.14 % of the open door's light, against 0.58 %
// at 0.1); farther, surfaces lie outside the probes' hull.
const float kSurfaceMargin = 0.15f;

// Within this share of the margin a probe stands where it should: it never moves to and fro.
const float kMarginTolerance = 0.25f;

// A surface's height is measured by rays that meet it at most this obliquely (cosine): it must pass
// under the probe, not just lie in the same plane far away.
const float kMinFacingCosine = 0.7f;

// Surfaces whose normals' cosine is below this count as facing different ways, as in a corner.
const float kMaxCornerCosine = 0.5f;

// A corner's planes are at least this steep to each other, so that stepping along one's normal
// without leaving the other divides by no less.
const float kMinSteepness = 0.5f;

// Being in solid matter that can be left is worse than any place outside [margins].
const float kInsideGeometryCost = 100.0f;

/// What one ray from a probe met of the scene that keeps still, in the frame of the probe's grid.
struct FixedRayHit {
  vec3 direction;  ///< Of the ray, unit.
  float distance;  ///< [m]; infinite: nothing.
  vec3 normal;     ///< Of the triangle, unit, towards the probe.
  uint back_face;  ///< 1: met the back of a single-sided surface.
};

LAMBENT_FN bool missed(FixedRayHit hit) {
  return hit.distance == infinity();
}

/// A surface that passes under a probe.
struct PlaneBelow {
  vec3 normal;   ///< Unit, towards the probe.
  float height;  ///< Of the probe over it [m].
};

LAMBENT_FN bool passes_below(FixedRayHit hit) {
  float cosine = -dot(hit.direction, hit.normal);
  return hit.back_face == 0u && !missed(hit) && cosine >= kMinFacingCosine;
}

LAMBENT_FN PlaneBelow plane_below(FixedRayHit hit) {
  PlaneBelow plane = {hit.normal, hit.distance * -dot(hit.direction, hit.normal)};
  return plane;
}

/// Whether a probe that belongs at home may stand there.
LAMBENT_FN bool within_reach(vec3 position, vec3 home, vec3 spacing) {
  vec3 cells = abs((position - home) / spacing);
  return max(cells.x, max(cells.y, cells.z)) <= kMaxProbeOffset;
}

/// How much a probe wants to leave for a better position [margins].
LAMBENT_FN float placement_cost(vec3 position, vec3 better, float margin, uint inside_geometry) {
  float cost = length(better - position) / margin;
  return better != position && inside_geometry != 0u ? cost + kInsideGeometryCost : cost;
}

/// A probe's way from where it stands towards better places, after which it is left at the one it
/// wants to leave least; then it walks again from there, until no place is clearly better than the
/// first: walking again would change nothing. As each walk that moves it leaves it with less
/// unrest, it comes to rest even among clutter, where every step leads to another. Offsets are in
/// cells.
struct RelocationState {
  vec3 first;
  vec3 best;
  float least;     ///< The unrest there.
  int steps;       ///< Taken so far.
  uint converged;  ///< 1: it is over.
};

LAMBENT_FN RelocationState begin_relocation(vec3 offset) {
  RelocationState relocation = {offset, offset, infinity(), 0, 0u};
  return relocation;
}

/// Ends a walk at the best place so far, or begins another from there. Returns that place.
LAMBENT_FN vec3 end_relocation(LAMBENT_INOUT(RelocationState) relocation) {
  vec3 best = relocation.best;
  if (relocation.best == relocation.first) {
    relocation.converged = 1u;
  } else {
    relocation = begin_relocation(best);
  }
  return best;
}

/// One step: from `offset`, which the probe wants to leave this much for `better`; the same where
/// it does not. Returns where to stand next.
LAMBENT_FN vec3 relocation_step(LAMBENT_INOUT(RelocationState) relocation, vec3 offset, vec3 better,
                                float cost) {
  if (relocation.steps == 0 || cost <= relocation.least) {
    relocation.best = offset;
    // Away from the first place only for something clearly better
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
