// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019.
#include "field/transport/distances.h"

#include <algorithm>
#include <vector>

#include "core/parallel.h"
#include "field/placement/classify_math.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 16;

}  // namespace

DistanceBlend::DistanceBlend(const FieldSettings& settings, std::span<const vec3> directions)
    : blend_(settings.distance_texels, kDistanceExponent, directions), totals_(blend_.texels()) {
  const std::vector<float> ones(2 * directions.size(), 1.0f);
  blend_.apply2(ones.data(), &totals_[0].x);
}

void DistanceBlend::moments(std::span<const RayDistance> seen, float farthest,
                            std::span<vec2> moments) const {
  // Clamp the distances and count the rays from inside solid matter
  thread_local std::vector<vec2> values, sums;
  values.resize(seen.size());
  sums.resize(moments.size());
  int from_inside = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const uint inside = seen[i].from_inside ? 1u : 0u;
    from_inside += static_cast<int>(inside);
    const float distance = counted_distance(seen[i].distance, inside, farthest);
    values[i] = {distance, distance * distance};
  }
  if (is_inside_geometry(from_inside, static_cast<int>(seen.size())) != 0u) {
    std::fill(moments.begin(), moments.end(), vec2(0.0f));
    return;
  }
  blend_.apply2(&values[0].x, &sums[0].x);
  for (std::size_t t = 0; t < moments.size(); ++t) moments[t] = sums[t] / totals_[t];
}

void blend_distances(const SolidSides& solid_sides, const DistanceBlend& blend,
                     const TraceGroup& group, std::span<const float> blend_weights,
                     uint dither_seed, ProbeStore& store) {
  const auto rays = static_cast<std::size_t>(blend.rays());
  parallel_chunks(group.probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<RayDistance> seen(rays);
    std::vector<vec2> moments(blend.texels());
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t i = 0; i < rays; ++i) {
        const Hit& hit = group.hits[k * rays + i];
        seen[i] = {hit.distance, solid_sides.is_solid(hit)};
      }
      const float farthest = max_probe_distance(store.grid_of(group.probes[k]));
      blend.moments(seen, farthest, moments);
      store.blend_moments(group.probes[k], moments, blend_weights[k], dither_seed);
    }
  });
}

}  // namespace lambent
