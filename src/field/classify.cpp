// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 5.
#include "field/classify.h"

#include <algorithm>
#include <cassert>

#include "field/lookup.h"

namespace lambent {
namespace {

// Surfaces this share of a cell beyond the eight cells count, too: points on them are clamped into
// the grid or have a neighbour's rounding.
constexpr float kReachSlack = 1e-3f;

bool is_vigilant(ProbeState state) {
  return state == ProbeState::vigilant || state == ProbeState::newly_vigilant;
}

bool is_awake(ProbeState state) {
  return state == ProbeState::awake || state == ProbeState::newly_awake;
}

}  // namespace

ProbeReach probe_reach(std::span<const Sight> sights, const vec3& position, const vec3& home,
                       const vec3& spacing) {
  ProbeReach reach;
  reach.in_solid_matter = in_solid_matter(sights);
  for (const Sight& sight : sights) {
    if (sight.missed()) continue;
    const vec3 cells = abs((position + sight.distance * sight.direction - home) / spacing);
    if (max(cells.x, max(cells.y, cells.z)) <= 1.0f + kReachSlack) reach.lights_surface = true;
  }
  return reach;
}

ProbeState next_state(ProbeState before, const ProbeReach& reach, bool near_moving) {
  if (reach.in_solid_matter) return ProbeState::off;
  if (reach.lights_surface) {
    return is_vigilant(before) ? before : ProbeState::newly_vigilant;
  }
  if (near_moving) return is_awake(before) ? before : ProbeState::newly_awake;
  return ProbeState::sleeping;
}

ProbeState state_once_traced(ProbeState state) {
  if (state == ProbeState::newly_vigilant) return ProbeState::vigilant;
  if (state == ProbeState::newly_awake) return ProbeState::awake;
  return state;
}

bool may_light(const Bounds& moving, const vec3& home_ws, const ProbeGrid& grid) {
  if (moving.empty()) return false;
  // A box along the grid's axes around the box
  const vec3 half = 0.5f * (moving.max - moving.min);
  const vec3 centre = grid_coords(grid, moving.min + half);
  const mat3 turn(abs(grid.axes[0]), abs(grid.axes[1]), abs(grid.axes[2]));
  const float bias = kBiasScale * kBias * smallest_spacing(grid);
  const vec3 reach = (half * turn + bias) / grid.spacing + 1.0f;
  return glm::all(glm::lessThanEqual(abs(grid_coords(grid, home_ws) - centre), reach));
}

void classify_probes(const ProbeStore& store, std::span<const ProbeReach> reaches,
                     std::span<const Bounds> moving, std::span<ProbeRecord> records) {
  assert(reaches.size() == records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const ProbeGrid& grid = store.grid_of(static_cast<int>(i));
    const vec3 home = store.probe_home_ws(static_cast<int>(i));
    const bool near_moving = std::any_of(moving.begin(), moving.end(),
                                         [&](const Bounds& b) { return may_light(b, home, grid); });
    records[i].state = next_state(records[i].state, reaches[i], near_moving);
  }
}

ProbeCounts count_states(std::span<const ProbeRecord> records) {
  ProbeCounts counts;
  int* const by_state[] = {&counts.off,   &counts.sleeping,       &counts.newly_awake,
                           &counts.awake, &counts.newly_vigilant, &counts.vigilant};
  for (const ProbeRecord& record : records) ++*by_state[static_cast<int>(record.state)];
  return counts;
}

}  // namespace lambent
