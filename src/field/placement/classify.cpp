// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 5.
#include "field/placement/classify.h"

#include <algorithm>
#include <cassert>

#include "field/lookup/lookup.h"

namespace lambent {
namespace {

// Surfaces up to this fraction of a cell beyond the eight cells count as inside: points on them are
// clamped into the grid, or rounding moves them into a neighbouring cell.
constexpr float kCellSlack = 1e-3f;

bool is_vigilant(ProbeState state) {
  return state == ProbeState::vigilant || state == ProbeState::newly_vigilant;
}

bool is_awake(ProbeState state) {
  return state == ProbeState::awake || state == ProbeState::newly_awake;
}

}  // namespace

ClassificationInput classification_input(std::span<const FixedRayHit> fixed_hits,
                                         const vec3& position, const vec3& grid_position,
                                         const vec3& spacing) {
  ClassificationInput input;
  input.inside_geometry = inside_geometry(fixed_hits);
  for (const FixedRayHit& hit : fixed_hits) {
    if (missed(hit)) continue;
    const vec3 cells = abs((position + hit.distance * hit.direction - grid_position) / spacing);
    if (max(cells.x, max(cells.y, cells.z)) <= 1.0f + kCellSlack) input.lights_surface = true;
  }
  return input;
}

ProbeState next_state(ProbeState before, const ClassificationInput& input, bool near_moving) {
  if (input.inside_geometry) return ProbeState::off;
  if (input.lights_surface) {
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

/// The grid coordinates of the probes that may light something in a box: those no farther from
/// `middle` than `reach` along each axis [cells].
struct LitCells {
  vec3 middle, reach;

  LitCells(const Bounds& box, const ProbeGrid& grid) {
    const vec3 half = 0.5f * (box.max - box.min);
    middle = grid_coords(grid, box.min + half);
    // Enclose the box in one along the grid's axes
    const mat3 turn(abs(grid.axes[0]), abs(grid.axes[1]), abs(grid.axes[2]));
    const float bias = kBiasScale * kBias * smallest_spacing(grid);
    reach = (half * turn + bias) / grid.spacing + 1.0f;
  }
};

void classify_probe(const ProbeStore& store, const ClassificationInput& input,
                    std::span<const Bounds> moving, int probe, ProbeStatus& status) {
  const ProbeGrid& grid = store.grid_of(probe);
  const vec3 grid_position = store.probe_grid_position_ws(probe);
  const bool near_moving = std::any_of(moving.begin(), moving.end(), [&](const Bounds& b) {
    return may_light(b, grid_position, grid);
  });
  status.state = next_state(status.state, input, near_moving);
}

}  // namespace

bool may_light(const Bounds& moving, const vec3& grid_position_ws, const ProbeGrid& grid) {
  if (moving.empty()) return false;
  const LitCells cells(moving, grid);
  return glm::all(
      glm::lessThanEqual(abs(grid_coords(grid, grid_position_ws) - cells.middle), cells.reach));
}

void classify_probes(const ProbeStore& store,
                     std::span<const ClassificationInput> classification_inputs,
                     std::span<const Bounds> moving, std::span<ProbeStatus> statuses) {
  assert(classification_inputs.size() == statuses.size());
  for (int probe = 0; probe < store.probes(); ++probe) {
    classify_probe(store, classification_inputs[probe], moving, probe, statuses[probe]);
  }
}

std::vector<int> classify_probes_near(const Bounds& box, const ProbeStore& store,
                                      std::span<const ClassificationInput> classification_inputs,
                                      std::span<const Bounds> moving,
                                      std::span<ProbeStatus> statuses) {
  std::vector<int> changed;
  if (box.empty()) return changed;
  for (const ProbeGrid& grid : store.grids()) {
    // Visit one probe more on each side, for rounding; may_light() decides about each
    const LitCells cells(box, grid);
    const vec3 reach = cells.reach + 1.0f, last(grid.count - 1);
    const ivec3 low(clamp(cells.middle - reach, vec3(0.0f), last));
    const ivec3 high(clamp(cells.middle + reach, vec3(0.0f), last));
    for (int z = low.z; z <= high.z; ++z) {
      for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
          const int probe = probe_index(grid, {x, y, z});
          const ProbeState before = statuses[probe].state;
          classify_probe(store, classification_inputs[probe], moving, probe, statuses[probe]);
          if (statuses[probe].state != before) changed.push_back(probe);
        }
      }
    }
  }
  return changed;
}

}  // namespace lambent
