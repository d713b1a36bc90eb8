// SPDX-License-Identifier: Apache-2.0
#include "scene/light_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/attributes.h"
#include "scene/emission_map.h"
#include "shared/color.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

std::uint64_t triangle_key(std::uint32_t instance, std::uint32_t triangle) {
  return (static_cast<std::uint64_t>(instance) << 32) | triangle;
}

// What emissive_sample.inl.h asks for.
using EmittersRef = const EmissiveTriangles&;

uint emitter_count(const EmissiveTriangles& emitters) {
  return static_cast<uint>(emitters.size());
}
EmitterRecord fetch_emitter(const EmissiveTriangles& emitters, uint emitter) {
  return emitters.entries()[emitter];
}
float fetch_cumulative(const EmissiveTriangles& emitters, uint emitter) {
  return emitters.cumulative()[emitter];
}
float fetch_pdf_area(const EmissiveTriangles& emitters, uint instance, uint triangle) {
  return emitters.pdf_area(instance, triangle);
}

#include "scene/emissive_sample.inl.h"

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
      const float area = 0.5f * glm::length(world_edge_product(instance, mesh, mesh.triangles[t]));
      const float radiance = maps[mesh.material].mean_luminance(mesh, t) *
                             vertex_color_bound(mesh, material, mesh.triangles[t]);
      // Written so that a NaN, too, is left out
      if (!(area > 0.0f) || !(radiance > 0.0f)) continue;
      entries_.push_back({i, t, area, 0.0f});
      powers.push_back(static_cast<double>(area) * radiance);
      total += powers.back();
      for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3& position = mesh.positions[mesh.triangles[t][corner]];
        bounds.add(glm::vec3(instance.world_from_object * glm::vec4(position, 1.0f)));
      }
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
  return sample_emissive(*scene_, *this, u);
}

EmissiveSample EmissiveTriangles::at(std::uint32_t instance, std::uint32_t triangle,
                                     const glm::vec2& barycentrics) const {
  return emissive_point(*scene_, *this, instance, triangle, barycentrics);
}

float EmissiveTriangles::pdf_area(std::uint32_t instance, std::uint32_t triangle) const {
  const auto found = index_of_.find(triangle_key(instance, triangle));
  if (found == index_of_.end()) return 0.0f;
  const EmitterRecord& entry = entries_[found->second];
  return entry.probability / entry.area;
}

}  // namespace lambent
