// SPDX-License-Identifier: Apache-2.0
#include "scene/light_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/attributes.h"
#include "scene/emission_map.h"
#include "shared/color.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

std::uint64_t triangle_key(std::uint32_t instance, std::uint32_t triangle) {
  return (static_cast<std::uint64_t>(instance) << 32) | triangle;
}

#include "scene/emissive_sample.inl.h"

// A triangle placed in the world; without a probability.
EmitterRecord in_the_world(const Instance& instance, const Mesh& mesh, std::uint32_t index,
                           std::uint32_t triangle) {
  const glm::uvec3& v = mesh.triangles[triangle];
  const glm::vec3& p0 = mesh.positions[v.x];
  const glm::mat3 linear(instance.world_from_object);
  EmitterRecord emitter{index,           triangle,        0.0f,           0.0f,
                        glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)};
  emitter.corner_ws = glm::vec3(instance.world_from_object * glm::vec4(p0, 1.0f));
  emitter.edge1_ws = linear * (mesh.positions[v.y] - p0);
  emitter.edge2_ws = linear * (mesh.positions[v.z] - p0);
  emitter.area = 0.5f * glm::length(glm::cross(emitter.edge1_ws, emitter.edge2_ws));
  return emitter;
}

// The brightest vertex colour of a triangle: an unlit surface emits in proportion to it.
float vertex_color_bound(const Mesh& mesh, const Material& material, const glm::uvec3& v) {
  if (!material.unlit || mesh.colors.empty()) return 1.0f;
  return std::max({luminance(glm::vec3(mesh.colors[v.x])), luminance(glm::vec3(mesh.colors[v.y])),
                   luminance(glm::vec3(mesh.colors[v.z]))});
}

}  // namespace

static_assert(kLightDirectional == static_cast<uint>(Light::Type::directional) &&
              kLightPoint == static_cast<uint>(Light::Type::point) &&
              kLightSpot == static_cast<uint>(Light::Type::spot));

LightRecord light_record(const Light& light) {
  LightRecord record = {light.intensity,
                        static_cast<uint>(light.type),
                        light.position_ws,
                        light.range,
                        light.direction_ws,
                        0.0f,
                        0.0f};
  if (light.type == Light::Type::spot) {
    record.cos_outer = std::cos(light.outer_cone_angle);
    record.cone_scale = cone_scale(std::cos(light.inner_cone_angle), record.cos_outer);
  }
  return record;
}

PunctualSample sample_punctual(const Light& light, const glm::vec3& position_ws) {
  return sample_punctual(light_record(light), position_ws);
}

EmissiveTriangles::EmissiveTriangles(const Scene& scene) : scene_(&scene) {
  // Compute each triangle's power: its area times the mean radiance of what its texture shows there
  std::vector<EmissionMap> maps;
  maps.reserve(scene.materials.size());
  for (const Material& material : scene.materials) maps.emplace_back(scene, material);

  std::vector<double> powers;
  double total = 0.0;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& material = scene.materials[mesh.material];
    if (!may_emit(material)) continue;
    Bounds bounds;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const EmitterRecord emitter = in_the_world(instance, mesh, i, t);
      const float radiance = maps[mesh.material].mean_luminance(mesh, t) *
                             vertex_color_bound(mesh, material, mesh.triangles[t]);
      // Written so that a NaN, too, is left out
      if (!(emitter.area > 0.0f) || !(radiance > 0.0f)) continue;
      entries_.push_back(emitter);
      powers.push_back(static_cast<double>(emitter.area) * radiance);
      total += powers.back();
      bounds.add(emitter.corner_ws);
      bounds.add(emitter.corner_ws + emitter.edge1_ws);
      bounds.add(emitter.corner_ws + emitter.edge2_ws);
    }
    if (!bounds.empty()) bounds_.push_back(bounds);
  }
  total_power_ = static_cast<float>(kTwoPi * total);

  // Compute the cumulative distribution
  double sum = 0.0;
  cumulative_.reserve(entries_.size());
  index_of_.reserve(entries_.size());
  for (std::uint32_t e = 0; e < entries_.size(); ++e) {
    sum += powers[e];
    entries_[e].probability = static_cast<float>(powers[e] / total);
    cumulative_.push_back(static_cast<float>(sum / total));
    index_of_.emplace(triangle_key(entries_[e].instance, entries_[e].triangle), e);
  }
}

EmissiveSample EmissiveTriangles::sample(const glm::vec3& u) const {
  if (empty()) return {};
  const EmitterRecord& emitter = entries_[pick(u.x).emitter];
  const glm::vec2 barycentrics = sample_uniform_triangle({u.y, u.z});
  EmissiveSample drawn;
  drawn.position_ws =
      emitter.corner_ws + barycentrics.x * emitter.edge1_ws + barycentrics.y * emitter.edge2_ws;
  drawn.normal_ws = glm::cross(emitter.edge1_ws, emitter.edge2_ws) / (2.0f * emitter.area);
  const PointEmission sent = emission_of(*scene_, emitter, barycentrics);
  drawn.radiance = sent.radiance;
  drawn.clearcoat = sent.clearcoat;
  drawn.pdf_area = emitter.probability / emitter.area;
  return drawn;
}

EmitterPick EmissiveTriangles::pick(float u) const {
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u);
  const auto emitter = static_cast<std::uint32_t>(found - cumulative_.begin());
  const float begin = emitter > 0 ? cumulative_[emitter - 1] : 0.0f;
  const float probability = entries_[emitter].probability;
  return {emitter, probability, std::clamp((u - begin) / probability, 0.0f, kLargestUniform)};
}

glm::vec3 EmissiveTriangles::radiance(const EmitterRecord& emitter, const glm::vec2& barycentrics,
                                      const glm::vec3& direction_ws) const {
  return emitted_radiance(*scene_, emitter, barycentrics, direction_ws);
}

float EmissiveTriangles::pdf_area(std::uint32_t instance, std::uint32_t triangle) const {
  const auto found = index_of_.find(triangle_key(instance, triangle));
  if (found == index_of_.end()) return 0.0f;
  const EmitterRecord& entry = entries_[found->second];
  return entry.probability / entry.area;
}

}  // namespace lambent
