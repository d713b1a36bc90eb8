// SPDX-License-Identifier: Apache-2.0
#include "bench/lights/by_power.h"

#include <algorithm>

#include "shared/color.h"
#include "shared/constants.h"

namespace lambent::bench {

ByPower::ByPower(const World& world) : world_(world) {
  double sum = 0.0;
  for (const Light& light : world.scene().lights) {
    sum += 4.0 * kPi * luminance(light.intensity);
    cumulative_.push_back(sum);
  }
  cumulative_.push_back(sum + emissive_of(world).total_power());
}

LightCandidate ByPower::draw(const LitPoint& point, RandomStream& random) const {
  const double u = next_uniform(random) * cumulative_.back();
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u);
  const auto index = static_cast<std::size_t>(found - cumulative_.begin());
  const double begin = index > 0 ? cumulative_[index - 1] : 0.0;
  const auto probability = static_cast<float>((cumulative_[index] - begin) / cumulative_.back());
  const std::vector<Light>& lights = world_.scene().lights;
  if (index < lights.size()) {
    const PunctualSample light = sample_punctual(lights[index], point.position_ws);
    return {light.to_light, light.distance, light.irradiance / probability, 0};
  }
  const glm::vec2 uv = next_uniform2(random);
  const EmissiveSample drawn = emissive_of(world_).sample({next_uniform(random), uv.x, uv.y});
  const glm::vec3 offset = drawn.position_ws - point.position_ws;
  const float squared = glm::dot(offset, offset);
  if (drawn.pdf_area <= 0.0f || squared <= 0.0f) return no_candidate();
  const glm::vec3 to_light = offset / std::sqrt(squared);
  const float cosine = std::abs(glm::dot(drawn.normal_ws, to_light));
  return {to_light, std::sqrt(squared),
          drawn.radiance * clearcoat_transmittance(drawn.clearcoat, cosine) *
              (cosine / (squared * drawn.pdf_area * probability)),
          1};
}

void ByPower::direct_irradiance(std::span<const DirectLightQuery> queries, std::uint32_t round,
                                std::span<glm::vec3> irradiance) const {
  std::vector<Ray> rays;
  std::vector<std::size_t> points;
  std::vector<glm::vec3> stakes;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    irradiance[i] = glm::vec3(0.0f);
    const LitPoint& point = queries[i].point;
    RandomStream random =
        make_random_stream(static_cast<std::uint32_t>(queries[i].index), round, 5u);
    const LightCandidate light = draw(point, random);
    const glm::vec3 unoccluded = unoccluded_irradiance(point, seen_shape(point), light);
    if (unoccluded == glm::vec3(0.0f)) continue;
    rays.push_back(shadow_ray(point.position_ws, point.geometric_normal_ws, light));
    points.push_back(i);
    stakes.push_back(unoccluded);
  }
  std::vector<std::uint8_t> occluded(rays.size());
  tracer_of(world_).occlusions(rays, occluded);
  for (std::size_t r = 0; r < rays.size(); ++r) {
    if (occluded[r] == 0) irradiance[points[r]] += stakes[r];
  }
}

}  // namespace lambent::bench
