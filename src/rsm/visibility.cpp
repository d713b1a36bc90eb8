// SPDX-License-Identifier: Apache-2.0
#include "rsm/visibility.h"

#include <vector>

#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "rsm/to_records.h"
#include "rsm/visibility_rays.h"
#include "shared/random.h"

namespace lambent {
namespace {

Ray ray_between(const vec3& position_ws, const vec3& normal_ws, const vec3& texel_ws) {
  const RayRecord r = ray_to_point(position_ws, normal_ws, texel_ws, kRayMeetsAll);
  return {r.origin_ws, r.t_min, r.direction_ws, r.t_max, r.mask};
}

/// Samples texels for a point, stratified over the light they contribute, and appends rays to them.
void draw_rays(const vec3& position_ws, const vec3& normal_ws, std::span<const RsmTexel> texels,
               std::vector<float>& brought, int count, RandomStream random,
               std::vector<Ray>& rays) {
  brought.resize(texels.size());
  float total = 0.0f;
  for (std::size_t k = 0; k < texels.size(); ++k) {
    total += texel_target(position_ws, normal_ws, to_record(texels[k]));
    brought[k] = total;
  }
  if (!(total > 0.0f)) return;
  const float shift = next_uniform(random);
  std::size_t k = 0;
  for (int i = 0; i < count; ++i) {
    const float wanted = drawn_worth(total, i, shift, count);
    while (k + 1 < texels.size() && brought[k] <= wanted) ++k;
    rays.push_back(ray_between(position_ws, normal_ws, texels[k].position_ws));
  }
}

}  // namespace

std::uint64_t apply_visibility(const World& world, const GatherRow& row,
                               std::span<const RsmTexel> texels, int rays, std::size_t first_pixel,
                               std::size_t pixel_step, std::uint32_t seed) {
  std::vector<Ray> asked;
  std::vector<int> pixels;
  std::vector<float> brought;
  const auto at = [&](int plane, int x) {
    return vec3(row.guide.at(plane)[x], row.guide.at(plane + 1)[x], row.guide.at(plane + 2)[x]);
  };
  for (int x = 0; x < row.count; ++x) {
    const vec3 normal = at(kNormalPlane, x);
    if (normal == vec3(0.0f)) continue;
    const std::size_t before = asked.size();
    const auto pixel = static_cast<uint>(first_pixel + x * pixel_step);
    draw_rays(at(kPositionPlane, x), normal, texels, brought, rays,
              make_random_stream(pixel, kVisibilitySalt, seed), asked);
    if (asked.size() > before) pixels.push_back(x);
  }
  std::vector<std::uint8_t> occluded(asked.size());
  tracer_of(world).occlusions(asked, occluded);
  const auto per_pixel = static_cast<std::size_t>(rays);
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    int arrived = 0;
    for (std::size_t i = p * per_pixel; i < (p + 1) * per_pixel; ++i) arrived += 1 - occluded[i];
    const float share = static_cast<float>(arrived) / static_cast<float>(rays);
    for (int c = 0; c < kLightPlanes; ++c) row.light.at(c)[pixels[p]] *= share;
  }
  return asked.size();
}

}  // namespace lambent
