// SPDX-License-Identifier: Apache-2.0
// Visibility of the eight probes around a point, from their stored distances, from rays, or from
// both.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/correction/correction_use.h"
#include "field/lookup/lookup_cpu.h"
#include "field/probes/probe_store.h"
#include "raytracing/raytracer.h"

namespace lambent {

class CorrectionTable;

/// Which probes of each cell are visible to each other, found with rays. Where the probes that have
/// a weight for a point are visible to each other, no wall runs between them, and their stored
/// distances can be trusted.
class CellVisibility {
 public:
  /// At first, all probes of a cell are visible to each other.
  explicit CellVisibility(int probes);

  /// Traces rays between the corners of the cells whose lowest probes are `probes`. Returns the
  /// number of rays traced.
  std::uint64_t update(const RayTracer& tracer, const ProbeStore& store,
                       std::span<const int> probes);

  /// Which corners of a cell are visible to each other, as the bits of all_visible(). `base` is the
  /// cell's lowest probe.
  const uvec2& of_cell(int base) const { return cells_[base]; }
  /// of_cell() of all cells, indexed by their lowest probes.
  std::span<uvec2> all_cells() { return cells_; }

 private:
  std::vector<uvec2> cells_;
};

/// The lowest probes of all cells that have one of the probes as a corner, in ascending order.
std::vector<int> cells_around(const ProbeStore& store, std::span<const int> probes);

/// The data by which lookups determine visibility, and by which they are corrected.
struct VisibilityRays {
  Visibility mode = Visibility::moments;
  const RayTracer* tracer = nullptr;                ///< Null: visibility is by distances only.
  const CellVisibility* cell_visibility = nullptr;  ///< Required for hybrid visibility.
  const CorrectionTable* correction = nullptr;      ///< Null: lookups are not corrected.
  CorrectionUse correction_use{};                   ///< How the table is read.
};

/// Computes the weights for each query in one volume. Single-threaded. Returns the number of rays
/// traced.
std::uint64_t visible_corner_weights(const ProbeStore& store, int volume, const VisibilityRays& by,
                                     std::span<const FieldQuery> queries,
                                     std::span<CornerWeights> result);

}  // namespace lambent
