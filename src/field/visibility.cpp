// SPDX-License-Identifier: Apache-2.0
#include "field/visibility.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>

#include "field/lookup.h"

namespace lambent {
namespace {

float env(const char* name, float fallback) {
  const char* text = std::getenv(name);
  return text ? static_cast<float>(std::atof(text)) : fallback;
}
constexpr int kCorners = 8;
constexpr std::size_t kBatch = 256;
const float kShare = env("VSHARE", 1e-3f);
const float kSure = env("VSURE", 0.99f);

std::size_t traced_corner_weights(const ProbeStore& store, Visibility mode,
                                  const RayTracer& tracer, std::span<const FieldQuery> queries,
                                  std::span<CornerWeights> result) {
  const ProbeGrid& grid = store.grid();
  const CornerOffsets offsets = corner_offsets(grid);
  const float spacing_min = min(grid.spacing.x, min(grid.spacing.y, grid.spacing.z));
  std::vector<CornerTerms> terms(queries.size());
  corner_terms(store, queries, terms);
  std::vector<Ray> rays;
  std::vector<float*> asked;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    CornerTerms& t = terms[i];
    const FieldQuery& q = queries[i];
    float weight[kCorners], sum = 0.0f;
    for (int k = 0; k < kCorners; ++k) {
      weight[k] = t.trilinear[k] * combined_weight(t.wrap[k], t.visibility[k]);
      if (t.wrap[k] == 0.0f) weight[k] = 0.0f;
      sum += weight[k];
    }
    for (int k = 0; k < kCorners; ++k) {
      if (mode == Visibility::hybrid && !(weight[k] > kShare * sum && t.visibility[k] < kSure)) continue;
      if (t.trilinear[k] * t.wrap[k] <= 1e-6f) continue;
      const vec3 start = biased_position(q.position_ws, q.normal_ws, q.to_viewer_ws, spacing_min);
      const vec3 way = store.probe_position_ws(t.base + offsets.probe[k]) - start;
      const float distance = max(length(way), kMinProbeDistance);
      rays.push_back({start, 0.0f, way / distance, distance});
      asked.push_back(&t.visibility[k]);
    }
  }
  std::vector<std::uint8_t> occluded(rays.size());
  tracer.occlusions(rays, occluded);
  for (std::size_t r = 0; r < rays.size(); ++r) *asked[r] = occluded[r] != 0 ? 0.0f : 1.0f;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const CornerTerms& t = terms[i];
    result[i].base = t.base;
    float sum = 0.0f;
    for (int k = 0; k < kCorners; ++k) {
      const float w = t.wrap[k] == 0.0f ? 0.0f : combined_weight(t.wrap[k], t.visibility[k]);
      result[i].weight[k] = t.trilinear[k] * w;
      sum += result[i].weight[k];
    }
    for (float& w : result[i].weight) w = sum > 0.0f ? w / sum : 0.0f;
  }
  return rays.size();
}

}  // namespace

std::size_t visible_corner_weights(const ProbeStore& store, Visibility mode,
                                   const RayTracer* tracer, std::span<const FieldQuery> queries,
                                   std::span<CornerWeights> result) {
  if (mode == Visibility::moments || tracer == nullptr) {
    corner_weights(store, queries, result);
    return 0;
  }
  return traced_corner_weights(store, mode, *tracer, queries, result);
}

void visible_irradiance(const ProbeStore& store, Visibility mode, const RayTracer* tracer,
                        std::span<const FieldQuery> queries, std::span<vec3> result) {
  assert(queries.size() == result.size());
  CornerWeights weights[kBatch];
  for (std::size_t first = 0; first < queries.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, queries.size() - first);
    const std::span<const FieldQuery> batch = queries.subspan(first, count);
    visible_corner_weights(store, mode, tracer, batch, {weights, count});
    weighted_irradiance(store, batch, {weights, count}, result.subspan(first, count));
  }
}

}  // namespace lambent
