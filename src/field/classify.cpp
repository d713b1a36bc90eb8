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

ProbeReach probe_reach(std::span<const Sight> sights, const vec3& position_ws, const vec3& home_ws,
                       const vec3& spacing) {
  ProbeReach reach;
  reach.in_solid_matter = in_solid_matter(sights);
  for (const Sight& sight : sights) {
    if (sight.missed()) continue;
    const vec3 cells = abs((position_ws + sight.distance * sight.direction - home_ws) / spacing);
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

namespace {

/// How far outside of a box a probe lights it.
vec3 reach_around(const ProbeGrid& grid) {
  const float smallest = min(grid.spacing.x, min(grid.spacing.y, grid.spacing.z));
  return grid.spacing + vec3(kBiasScale * kBias * smallest);
}

void classify_probe(const ProbeGrid& grid, const ProbeReach& reach, std::span<const Bounds> moving,
                    const ivec3& place, ProbeRecord& record) {
  const vec3 home = probe_position(grid, place);
  const bool near_moving = std::any_of(moving.begin(), moving.end(),
                                       [&](const Bounds& b) { return may_light(b, home, grid); });
  record.state = next_state(record.state, reach, near_moving);
}

}  // namespace

bool may_light(const Bounds& moving, const vec3& home_ws, const ProbeGrid& grid) {
  if (moving.empty()) return false;
  const vec3 around = reach_around(grid);
  return glm::all(glm::greaterThanEqual(home_ws, moving.min - around)) &&
         glm::all(glm::lessThanEqual(home_ws, moving.max + around));
}

void classify_probes(const ProbeGrid& grid, std::span<const ProbeReach> reaches,
                     std::span<const Bounds> moving, std::span<ProbeRecord> records) {
  assert(reaches.size() == records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    classify_probe(grid, reaches[i], moving, probe_coords(grid, static_cast<int>(i)), records[i]);
  }
}

std::vector<int> classify_probes_near(const Bounds& box, const ProbeGrid& grid,
                                      std::span<const ProbeReach> reaches,
                                      std::span<const Bounds> moving,
                                      std::span<ProbeRecord> records) {
  std::vector<int> changed;
  if (box.empty()) return changed;
  // A probe more on each side, for rounding; the probe's own test decides
  const vec3 around = reach_around(grid) + grid.spacing;
  const vec3 last(grid.count - 1);
  const ivec3 low(clamp((box.min - around - grid.origin_ws) / grid.spacing, vec3(0.0f), last));
  const ivec3 high(clamp((box.max + around - grid.origin_ws) / grid.spacing, vec3(0.0f), last));
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        const int probe = probe_index(grid, {x, y, z});
        const ProbeState before = records[probe].state;
        classify_probe(grid, reaches[probe], moving, {x, y, z}, records[probe]);
        if (records[probe].state != before) changed.push_back(probe);
      }
    }
  }
  return changed;
}

}  // namespace lambent
