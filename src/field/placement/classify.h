// SPDX-License-Identifier: Apache-2.0
// What each probe is for: to light surfaces that keep still, something that moves, or nothing.
#pragma once

#include <span>
#include <vector>

#include "field/placement/relocate.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "lambent/field.h"

namespace lambent {

/// What of the scene that keeps still lies around a probe.
struct ClassificationInput {
  bool inside_geometry = false;
  bool lights_surface = false;  ///< A surface is within the eight cells that it is a corner of.
};

/// From what a probe that belongs at `home` sees from `position`, both in the sights' frame.
ClassificationInput classification_input(std::span<const FixedRayHit> fixed_hits,
                                         const vec3& position, const vec3& home,
                                         const vec3& spacing);

/// What a probe turns into. `near_moving`: something that moves may ask it for light. A state that
/// is new to the probe is a newly_* one until it has been traced.
ProbeState next_state(ProbeState before, const ClassificationInput& input, bool near_moving);

/// The state of a probe once it has been traced.
ProbeState state_once_traced(ProbeState state);

/// Whether a probe that belongs at `home_ws` may light something within these bounds: they reach it
/// once expanded by a cell and by the lookup's bias.
bool may_light(const Bounds& moving, const vec3& home_ws, const ProbeGrid& grid);

/// Sets the state of every probe. Spans of one entry a probe; `moving` are the bounds of what
/// moves.
void classify_probes(const ProbeStore& store,
                     std::span<const ClassificationInput> classification_inputs,
                     std::span<const Bounds> moving, std::span<ProbeStatus> statuses);

/// The same for the probes that may light something in this box alone. Returns those whose state
/// changed.
std::vector<int> classify_probes_near(const Bounds& box, const ProbeStore& store,
                                      std::span<const ClassificationInput> classification_inputs,
                                      std::span<const Bounds> moving,
                                      std::span<ProbeStatus> statuses);

}  // namespace lambent
