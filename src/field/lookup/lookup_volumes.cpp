// SPDX-License-Identifier: Apache-2.0
#include "field/lookup/lookup_volumes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

#include "field/correction/correction_table.h"
#include "field/lookup/lookup.h"

namespace lambent {
namespace {

// The number of queries per batch: few enough that the weights stay in the first-level cache
// between the two kernels.
constexpr std::size_t kBatch = 256;

/// The weights in a field of several volumes: looks up each volume for the queries in which it has
/// a weight.
std::uint64_t find_blended(const ProbeStore& store, const VisibilityRays& by,
                           std::span<const FieldQuery> queries, QueryWeights& result) {
  result.corners.clear();
  result.query.clear();
  std::vector<float> left(queries.size(), 1.0f);
  std::vector<FieldQuery> asking;
  std::vector<std::uint32_t> which;
  std::vector<float> volume_weights;
  std::vector<CornerWeights> corners;
  std::uint64_t traced = 0;
  for (int volume = 0; volume < store.volumes(); ++volume) {
    asking.clear();
    which.clear();
    volume_weights.clear();
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (left[i] <= kMinRemainingWeight) continue;
      const float volume_weight =
          volume_share(store.grid(volume), volume, store.volumes(), queries[i].position_ws);
      if (volume_weight <= 0.0f) continue;
      asking.push_back(queries[i]);
      which.push_back(static_cast<std::uint32_t>(i));
      volume_weights.push_back(volume_weight);
    }
    corners.resize(asking.size());
    traced += visible_corner_weights(store, volume, by, asking, corners);
    for (std::size_t k = 0; k < asking.size(); ++k) {
      // Where no probe of this volume is visible, the next volumes take its weight
      if (sum_of_weights(corners[k]) == 0.0f) continue;
      const float volume_weight = left[which[k]] * volume_weights[k];
      left[which[k]] -= volume_weight;
      for (float& weight : corners[k].weight) weight *= volume_weight;
      result.corners.push_back(corners[k]);
      result.query.push_back(which[k]);
    }
  }
  // Where no probe of the last volume is visible, scale up the weights of the volumes before it
  for (std::size_t k = 0; k < result.corners.size(); ++k) {
    const float unanswered = left[result.query[k]];
    if (unanswered <= kMinRemainingWeight) continue;
    for (float& weight : result.corners[k].weight) weight /= 1.0f - unanswered;
  }
  return traced;
}

std::uint64_t find_uncorrected(const ProbeStore& store, const VisibilityRays& by,
                               std::span<const FieldQuery> queries, QueryWeights& result) {
  if (store.volumes() > 1) return find_blended(store, by, queries, result);
  result.corners.resize(queries.size());
  result.query.resize(queries.size());
  std::iota(result.query.begin(), result.query.end(), 0u);
  return visible_corner_weights(store, 0, by, queries, result.corners);
}

/// Multiplies the weights of lookups by a correction each, which their positions pick.
void correct_by_picks(const ProbeStore& store, const VisibilityRays& by,
                      std::span<const FieldQuery> queries, QueryWeights& weights) {
  std::array<CorrectionPoint, kMostPicked> points;
  std::array<float, kMostPicked> ratios;
  for (std::size_t first = 0; first < weights.corners.size(); first += kMostPicked) {
    const std::size_t count = std::min(kMostPicked, weights.corners.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const FieldQuery& query = queries[weights.query[first + i]];
      const int volume = static_cast<int>(weights.corners[first + i].table) / kCellWraps;
      points[i] = {&store.grid(volume), volume, query.position_ws, query.normal_ws};
    }
    by.correction->picked_at(std::span(points).first(count), std::span(ratios).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      for (float& weight : weights.corners[first + i].weight) weight *= ratios[i];
    }
  }
}

/// Multiplies the weights of lookups by the corrections at their points.
void correct_weights(const ProbeStore& store, const VisibilityRays& by,
                     std::span<const FieldQuery> queries, QueryWeights& weights) {
  if (by.correction_use == CorrectionUse::picked) {
    correct_by_picks(store, by, queries, weights);
    return;
  }
  RecentBlocks blocks;
  for (std::size_t i = 0; i < weights.corners.size(); ++i) {
    CornerWeights& corners = weights.corners[i];
    const FieldQuery& query = queries[weights.query[i]];
    const int volume = static_cast<int>(corners.table) / kCellWraps;
    const float ratio = by.correction->at(store.grid(volume), volume, query.position_ws,
                                          query.normal_ws, by.correction_use, &blocks);
    for (float& weight : corners.weight) weight *= ratio;
  }
}

}  // namespace

std::uint64_t find_weights(const ProbeStore& store, const VisibilityRays& by,
                           std::span<const FieldQuery> queries, QueryWeights& result) {
  const std::uint64_t traced = find_uncorrected(store, by, queries, result);
  if (by.correction != nullptr && !by.correction->empty()) {
    correct_weights(store, by, queries, result);
  }
  return traced;
}

std::uint64_t lookup_irradiance(const ProbeStore& store, const VisibilityRays& by,
                                std::span<const FieldQuery> queries, std::span<vec3> result) {
  assert(queries.size() == result.size());
  QueryWeights weights;
  std::fill(result.begin(), result.end(), vec3(0.0f));
  std::uint64_t traced = 0;
  for (std::size_t first = 0; first < queries.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, queries.size() - first);
    const std::span<const FieldQuery> batch = queries.subspan(first, count);
    traced += find_weights(store, by, batch, weights);
    add_irradiance(store, batch, weights.corners, weights.query, result.subspan(first, count));
  }
  return traced;
}

}  // namespace lambent
