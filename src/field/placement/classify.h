// SPDX-License-Identifier: Apache-2.0
// Classification: whether a probe lights static surfaces, dynamic instances, or nothing.
#pragma once

#include <span>
#include <vector>

#include "field/placement/relocate.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "lambent/field.h"

namespace lambent {

/// The static geometry around a probe, as far as classification depends on it.
struct ClassificationInput {
  bool inside_geometry = false;  ///< The probe stands inside geometry.
  bool lights_surface = false;   ///< A surface is within one of the eight cells around the probe.
};

/// Computes the input from the hits of a probe's fixed rays. The probe stands at `position`, and
/// its place on the grid is `grid_position`; both are in the frame of the hits.
ClassificationInput classification_input(std::span<const FixedRayHit> fixed_hits,
                                         const vec3& position, const vec3& grid_position,
                                         const vec3& spacing);

/// The next state of a probe. `near_moving` is whether it may light a dynamic instance. A probe
/// that becomes awake or vigilant is in one of the newly_* states until it has been traced.
ProbeState next_state(ProbeState before, const ClassificationInput& input, bool near_moving);

/// The state of a probe once it has been traced.
ProbeState state_once_traced(ProbeState state);

/// Whether a probe whose place on the grid is `grid_position_ws` may light something within these
/// bounds: they contain it once expanded by a cell and by the lookup's bias.
bool may_light(const Bounds& moving, const vec3& grid_position_ws, const ProbeGrid& grid);

/// Sets the state of every probe. The inputs and statuses have one entry per probe; `moving` are
/// the bounds of the dynamic instances.
void classify_probes(const ProbeStore& store,
                     std::span<const ClassificationInput> classification_inputs,
                     std::span<const Bounds> moving, std::span<ProbeStatus> statuses);

/// Sets the states of those probes that may light something in this box; the others keep theirs.
/// Returns the probes whose state changed.
std::vector<int> classify_probes_near(const Bounds& box, const ProbeStore& store,
                                      std::span<const ClassificationInput> classification_inputs,
                                      std::span<const Bounds> moving,
                                      std::span<ProbeStatus> statuses);

}  // namespace lambent
