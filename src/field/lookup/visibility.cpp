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
constexpr std::uint64_t kAllSeen = ~std::uint64_t{0};
constexpr std::size_t kCellsPerTask = 64;

Ray to_ray(const RayRecord& ray) {
  return {ray.origin_ws, ray.t_min, ray.direction_ws, ray.t_max, ray.mask};
}

std::uint64_t sight(int corner, int other) {
  return std::uint64_t{1} << visibility_bit(corner, other);
}

/// Names the query and the corner that a visibility ray tests.
struct Question {
  std::size_t query;
  int corner;
};

/// Collects the visibility rays of a batch of lookups, to trace them together.
class CornerRays {
 public:
  CornerRays(const ProbeStore& store, int volume)
      : store_(store), spacing_min_(smallest_spacing(store.grid(volume))) {}

  /// Adds a ray from the biased position of a query to a corner. The biased position is off the
  /// surface, so that rounding cannot make the ray hit the surface itself.
  void ask(const FieldQuery& query, int base, std::uint32_t table, std::size_t index, int corner) {
    const vec3 start =
        biased_position(query.position_ws, query.normal_ws, query.to_viewer_ws, spacing_min_);
    const int probe = base + store_.corner_table()[table].probe[corner];
    rays_.push_back(to_ray(visibility_ray(start, store_.probe_position_ws(probe))));
    tests_.push_back({index, corner});
  }

  /// Traces the rays and calls hidden(test) for every corner that is occluded. Returns their
  /// number.
  template <class Hidden>
  std::uint64_t answer(const RayTracer& tracer, Hidden hidden) {
    occluded_.resize(rays_.size());
    tracer.occlusions(rays_, occluded_);
    for (std::size_t r = 0; r < rays_.size(); ++r) {
      if (occluded_[r] != 0) hidden(tests_[r]);
    }
    return rays_.size();
  }

 private:
  const ProbeStore& store_;
  float spacing_min_;
  std::vector<Ray> rays_;
  std::vector<Question> tests_;
  std::vector<std::uint8_t> occluded_;
};

/// Exact visibility: traces a ray to each corner that could count.
std::uint64_t exact_weights(const ProbeStore& store, int volume, const RayTracer& tracer,
                            std::span<const FieldQuery> queries, std::span<CornerWeights> result) {
  CornerRays rays(store, volume);
  std::vector<CornerTerms> terms(queries.size());
  std::vector<CornerWeights> seen(queries.size());
  corner_terms(store, volume, queries, terms);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    seen[i] = {terms[i].base, terms[i].table, {}};
    for (int k = 0; k < kCorners; ++k) {
      seen[i].weight[k] = seen_weight(terms[i].trilinear[k], terms[i].wrap[k]);
      if (seen[i].weight[k] > 0.0f) rays.ask(queries[i], terms[i].base, terms[i].table, i, k);
    }
  }
  const std::uint64_t traced =
      rays.answer(tracer, [&](const Question& q) { seen[q.query].weight[q.corner] = 0.0f; });

  // Where no probe is visible, use the weights by distances
  corner_weights(store, volume, queries, result);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (scale_weights(seen[i], 1.0f) != 0) result[i] = seen[i];
  }
  return traced;
}

/// Hybrid visibility: weights by distances, tested with rays where the heaviest corner of a cell
/// does not see another corner that counts.
std::uint64_t hybrid_weights(const ProbeStore& store, int volume, const VisibilityRays& by,
                             std::span<const FieldQuery> queries, std::span<CornerWeights> result) {
  corner_weights(store, volume, queries, result);
  CornerRays rays(store, volume);
  std::vector<std::size_t> checked;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const std::uint64_t cell = by.cell_visibility->of_cell(result[i].base);
    if (cell == kAllSeen) continue;
    const auto seen = static_cast<uint>(cell >> visibility_bit(heaviest_corner(result[i]), 0));
    const VisibilityMask mask = visibility_mask(result[i], seen, 1.0f);
    for (int k = 0; k < kCorners; ++k) {
      if (((mask.hidden >> k) & 1u) != 0) result[i].weight[k] = 0.0f;
      if (((mask.tested >> k) & 1u) != 0) {
        rays.ask(queries[i], result[i].base, result[i].table, i, k);
      }
    }
    checked.push_back(i);
  }
  const std::uint64_t traced = rays.answer(*by.tracer, [&](const Question& question) {
    result[question.query].weight[question.corner] = 0.0f;
  });
  // The heaviest corner always keeps its weight, so that a sum remains
  for (const std::size_t i : checked) scale_weights(result[i], 1.0f);
  return traced;
}

}  // namespace

CellVisibility::CellVisibility(int probes) : cells_(probes, kAllSeen) {}

std::uint64_t CellVisibility::update(const RayTracer& tracer, const ProbeStore& store,
                                     std::span<const int> probes) {
  std::atomic<std::uint64_t> traced = 0;
  const std::size_t batch = batch_of(tracer, kCellPairs, kCellsPerTask);
  parallel_chunks(probes.size(), batch, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays;
    std::vector<std::uint64_t> pairs;
    std::vector<int> cells;
    for (const int base : probes.subspan(begin, end - begin)) {
      const int volume = store.volume_of(base);
      const ProbeGrid& grid = store.grid(volume);
      // The last probe of a row is not the lowest corner of any cell
      const ivec3 coords = probe_coords(grid, base);
      if (glm::any(glm::greaterThanEqual(coords, grid.count - ivec3(1)))) continue;
      const CornerOffsets& offsets = store.corner_table()[static_cast<std::size_t>(
          kCellWraps * volume + cell_wrap(grid, coords))];
      cells_[base] = kAllSeen;
      for (int i = 0; i < kCorners; ++i) {
        const vec3 start = store.probe_position_ws(base + offsets.probe[i]);
        for (int k = i + 1; k < kCorners; ++k) {
          const vec3 other = store.probe_position_ws(base + offsets.probe[k]);
          rays.push_back(to_ray(visibility_ray(start, other)));
          pairs.push_back(sight(i, k) | sight(k, i));
          cells.push_back(base);
        }
      }
    }
    std::vector<std::uint8_t> occluded(rays.size());
    tracer.occlusions(rays, occluded);
    for (std::size_t r = 0; r < rays.size(); ++r) {
      if (occluded[r] != 0) cells_[cells[r]] &= ~pairs[r];
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
