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

bool is_back_face(const Scene& scene, const Hit& hit) {
  if (hit.missed() || hit.front_face) return false;
  return !scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material].double_sided;
}

}  // namespace

DistanceBlend::DistanceBlend(const FieldSettings& settings, std::span<const vec3> directions)
    : blend_(settings.distance_texels, kDistanceExponent, directions), totals_(blend_.texels()) {
  const std::vector<float> ones(2 * directions.size(), 1.0f);
  blend_.apply2(ones.data(), &totals_[0].x);
}

void DistanceBlend::moments(std::span<const SeenDistance> seen, float farthest,
                            std::span<vec2> moments) const {
  // Clamp the distances and count the back faces
  thread_local std::vector<vec2> values, sums;
  values.resize(seen.size());
  sums.resize(moments.size());
  int back_faces = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const uint back_face = seen[i].back_face ? 1u : 0u;
    back_faces += static_cast<int>(back_face);
    const float distance = counted_distance(seen[i].distance, back_face, farthest);
    values[i] = {distance, distance * distance};
  }
  if (is_inside_geometry(back_faces, static_cast<int>(seen.size())) != 0u) {
    std::fill(moments.begin(), moments.end(), vec2(0.0f));
    return;
  }
  blend_.apply2(&values[0].x, &sums[0].x);
  for (std::size_t t = 0; t < moments.size(); ++t) moments[t] = sums[t] / totals_[t];
}

void blend_distances(const Scene& scene, const DistanceBlend& blend, const TraceGroup& group,
                     std::span<const float> blend_weights, uint dither_seed, ProbeStore& store) {
  const auto rays = static_cast<std::size_t>(blend.rays());
  parallel_chunks(group.probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<SeenDistance> seen(rays);
    std::vector<vec2> moments(blend.texels());
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t i = 0; i < rays; ++i) {
        const Hit& hit = group.hits[k * rays + i];
        seen[i] = {hit.distance, is_back_face(scene, hit)};
      }
      const float farthest = max_probe_distance(store.grid_of(group.probes[k]));
      blend.moments(seen, farthest, moments);
      store.blend_moments(group.probes[k], moments, blend_weights[k], dither_seed);
    }
  });
}

}  // namespace lambent
