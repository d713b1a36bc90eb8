// SPDX-License-Identifier: Apache-2.0
// Which of the eight probes around a point are seen from it: by their distances, by rays, or both.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/lookup/lookup_cpu.h"
#include "field/probes/probe_store.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// Which probes of each cell see each other, found by rays. Where the probes that matter to a point
/// do, no wall runs between them, and their distances can be trusted.
class CellVisibility {
 public:
  /// Every probe sees every other.
  explicit CellVisibility(int probes);

  /// Looks again in the cells whose lowest probes these are. Returns the rays traced.
  std::uint64_t update(const RayTracer& tracer, const ProbeStore& store,
                       std::span<const int> probes);

  /// Bit 8 i + k: corners i and k of the cell see each other. `base` is the cell's lowest probe.
  std::uint64_t of_cell(int base) const { return cells_[base]; }

 private:
  std::vector<std::uint64_t> cells_;
};

/// The lowest probes of all cells that have one of the probes as a corner, in ascending order.
std::vector<int> cells_around(const ProbeStore& store, std::span<const int> probes);

/// What lookups find visibility with.
struct VisibilityRays {
  Visibility mode = Visibility::moments;
  const RayTracer* tracer = nullptr;                ///< Null: by distances alone.
  const CellVisibility* cell_visibility = nullptr;  ///< Of the probes; hybrid needs it.
};

/// Weights for each query in one volume. Single-threaded. Returns the rays traced.
std::uint64_t visible_corner_weights(const ProbeStore& store, int volume, const VisibilityRays& by,
                                     std::span<const FieldQuery> queries,
                                     std::span<CornerWeights> result);

}  // namespace lambent
