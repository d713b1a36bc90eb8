// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019.
#include "field/distances.h"

#include <vector>

#include "core/parallel.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 16;

// A ray that meets the back of a single-sided surface counts as shortened to this share, so that a
// probe inside something trusts its surroundings little. JCGT 10(2) 2021, sec. 4.
constexpr float kBackFaceDistanceShare = 0.2f;

bool is_back_face(const Scene& scene, const Hit& hit) {
  if (hit.missed() || hit.front_face) return false;
  return !scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material].double_sided;
}

}  // namespace

void blend_distances(const Scene& scene, const BlendMatrix& blend, const TraceGroup& group,
                     std::span<const float> shares, uint salt, ProbeStore& store) {
  const int rays = blend.rays();
  const int texels = blend.texels();
  const float farthest = max_probe_distance(store.grid());

  // Compute what all rays together weigh in each texel: the same for every probe
  std::vector<float> ones(2 * static_cast<std::size_t>(rays), 1.0f);
  std::vector<vec2> totals(texels);
  blend.apply2(ones.data(), &totals[0].x);

  parallel_chunks(group.probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<vec2> values(rays), sums(texels), moments(texels);
    for (std::size_t k = begin; k < end; ++k) {
      // Cut the distances and count the back faces
      int back_faces = 0;
      for (int i = 0; i < rays; ++i) {
        const Hit& hit = group.hits[k * rays + i];
        float distance = min(hit.distance, farthest);
        if (is_back_face(scene, hit)) {
          ++back_faces;
          distance *= kBackFaceDistanceShare;
        }
        values[i] = {distance, distance * distance};
      }
      const bool inside_matter =
          static_cast<float>(back_faces) > kMaxBackFaceShare * static_cast<float>(rays);

      // Compute the mean distance and mean squared distance along each texel's direction
      blend.apply2(&values[0].x, &sums[0].x);
      for (int t = 0; t < texels; ++t) {
        moments[t] = inside_matter ? vec2(0.0f) : sums[t] / totals[t];
      }
      store.blend_moments(group.probes[k], moments, shares[k], salt);
    }
  });
}

}  // namespace lambent
