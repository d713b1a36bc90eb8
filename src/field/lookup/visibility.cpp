// SPDX-License-Identifier: Apache-2.0
#include "field/lookup/visibility.h"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "core/parallel.h"
#include "field/lookup/visibility_math.h"

namespace lambent {
namespace {

constexpr int kCorners = kCellCorners;
constexpr std::size_t kCellsPerTask = 64;

Ray to_ray(const RayRecord& ray) {
  return {ray.origin_ws, ray.t_min, ray.direction_ws, ray.t_max, ray.mask};
}

/// The query and the corner that a visibility ray tests.
struct CornerTest {
  std::size_t query;
  int corner;
};

/// Collects the visibility rays of a batch of lookups, to trace them together.
class CornerRays {
 public:
  CornerRays(const ProbeStore& store, int volume)
      : store_(store), volume_(lookup_grid(store.grid(volume))) {}

  /// Exact visibility: the weights that a query's corners have if rays show that they are visible.
  CornerWeights weights_if_visible(const FieldQuery& query, const CornerWeights& corners) {
    return visible_corners(volume_, cell_of(query), corners, query.position_ws, query.normal_ws);
  }

  /// Adds rays from the biased position of a query to some corners, given as bits.
  void add(const FieldQuery& query, std::size_t index, uint corners) {
    if (corners == 0u) return;
    const LookupCell cell = cell_of(query);
    for (int k = 0; k < kCorners; ++k) {
      if ((corners >> k & 1u) == 0u) continue;
      rays_.push_back(to_ray(corner_ray(volume_.grid, cell, k)));
      tests_.push_back({index, k});
    }
  }

  /// Traces the rays and calls hidden(test) for every corner that is occluded. Returns their
  /// number.
  template <class Hidden>
  std::uint64_t trace(const RayTracer& tracer, Hidden hidden) {
    occluded_.resize(rays_.size());
    tracer.occlusions(rays_, occluded_);
    for (std::size_t r = 0; r < rays_.size(); ++r) {
      if (occluded_[r] != 0) hidden(tests_[r]);
    }
    return rays_.size();
  }

 private:
  vec3 fetch_offset(int probe) const { return store_.probe_offset(probe); }
#include "field/lookup/visibility.inl.h"

  LookupCell cell_of(const FieldQuery& query) const {
    return lookup_cell(volume_, query.position_ws, query.normal_ws, query.to_viewer_ws,
                       query.viewer_distance);
  }

  const ProbeStore& store_;
  LookupGrid volume_;
  std::vector<Ray> rays_;
  std::vector<CornerTest> tests_;
  std::vector<std::uint8_t> occluded_;
};

/// Exact visibility: traces a ray to each corner that has a weight if it is visible.
std::uint64_t exact_weights(const ProbeStore& store, int volume, const RayTracer& tracer,
                            std::span<const FieldQuery> queries, std::span<CornerWeights> result) {
  corner_weights(store, volume, queries, result);
  CornerRays rays(store, volume);
  std::vector<CornerWeights> visible(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    visible[i] = rays.weights_if_visible(queries[i], result[i]);
    rays.add(queries[i], i, weighed_corners(visible[i]));
  }
  const std::uint64_t traced = rays.trace(
      tracer, [&](const CornerTest& test) { visible[test.query].weight[test.corner] = 0.0f; });

  // Where no probe is visible, the weights by distances stay
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (scale_weights(visible[i], 1.0f) != 0) result[i] = visible[i];
  }
  return traced;
}

/// Hybrid visibility: weights by distances, tested with rays where a corner with a weight is not
/// visible from the heaviest corner of the cell.
std::uint64_t hybrid_weights(const ProbeStore& store, int volume, const VisibilityRays& by,
                             std::span<const FieldQuery> queries, std::span<CornerWeights> result) {
  corner_weights(store, volume, queries, result);
  CornerRays rays(store, volume);
  // The corners that rays find to be hidden, as bits, of each query
  std::vector<uint> hidden(queries.size(), 0u);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const uvec2& cell = by.cell_visibility->of_cell(result[i].base);
    if (cell == all_visible()) continue;
    const VisibilityMask mask = visibility_mask(result[i], cell, 1.0f);
    hide_corners(result[i], mask.hidden);
    // The heaviest corner is not among these, so that a sum remains
    if (mask.hidden != 0u) scale_weights(result[i], 1.0f);
    rays.add(queries[i], i, mask.tested);
  }
  const std::uint64_t traced = rays.trace(
      *by.tracer, [&](const CornerTest& test) { hidden[test.query] |= 1u << test.corner; });
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (hidden[i] == 0u) continue;
    result[i] =
        tested_weights(result[i], hidden[i], by.cell_visibility->of_cell(result[i].base), 1.0f);
  }
  return traced;
}

}  // namespace

CellVisibility::CellVisibility(int probes) : cells_(probes, all_visible()) {}

std::uint64_t CellVisibility::update(const RayTracer& tracer, const ProbeStore& store,
                                     std::span<const int> probes) {
  std::atomic<std::uint64_t> traced = 0;
  const std::size_t batch = batch_of(tracer, kCellPairs, kCellsPerTask);
  parallel_chunks(probes.size(), batch, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays;
    std::vector<int> cells;
    for (const int base : probes.subspan(begin, end - begin)) {
      const int volume = store.volume_of(base);
      const ProbeGrid& grid = store.grid(volume);
      // The last probe of a row is not the lowest corner of any cell
      const ivec3 coords = probe_coords(grid, base);
      if (glm::any(glm::greaterThanEqual(coords, grid.count - ivec3(1)))) continue;
      const CornerOffsets& offsets = store.corner_table()[static_cast<std::size_t>(
          kCellWraps * volume + cell_wrap(grid, coords))];
      cells.push_back(base);
      for (int pair = 0; pair < kCellPairs; ++pair) {
        const ivec2 ends = cell_pair(pair);
        const vec3 start = store.probe_position_ws(base + offsets.probe[ends.x]);
        const vec3 other = store.probe_position_ws(base + offsets.probe[ends.y]);
        rays.push_back(to_ray(visibility_ray(start, other)));
      }
    }
    std::vector<std::uint8_t> occluded(rays.size());
    tracer.occlusions(rays, occluded);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      uvec2& cell = cells_[cells[c]] = all_visible();
      for (int pair = 0; pair < kCellPairs; ++pair) {
        if (occluded[c * kCellPairs + pair] != 0) cell = without_pair(cell, cell_pair(pair));
      }
    }
    traced += rays.size();
  });
  return traced;
}

std::vector<int> cells_around(const ProbeStore& store, std::span<const int> probes) {
  std::vector<std::uint8_t> has_one(store.probes(), 0);
  for (const int probe : probes) {
    const ProbeGrid& grid = store.grid_of(probe);
    const ivec3 coords = probe_coords(grid, probe), last = grid.count - ivec3(2);
    for (int k = 0; k < kCorners; ++k) {
      const ivec3 base = coords - cell_corner(k);
      if (base == clamp(base, ivec3(0), last)) has_one[probe_index(grid, base)] = 1;
    }
  }
  std::vector<int> cells;
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (has_one[probe] != 0) cells.push_back(probe);
  }
  return cells;
}

std::uint64_t visible_corner_weights(const ProbeStore& store, int volume, const VisibilityRays& by,
                                     std::span<const FieldQuery> queries,
                                     std::span<CornerWeights> result) {
  if (by.tracer != nullptr && by.mode == Visibility::exact) {
    return exact_weights(store, volume, *by.tracer, queries, result);
  }
  if (by.tracer != nullptr && by.mode == Visibility::hybrid) {
    assert(by.cell_visibility != nullptr);
    return hybrid_weights(store, volume, by, queries, result);
  }
  corner_weights(store, volume, queries, result);
  return 0;
}

}  // namespace lambent
