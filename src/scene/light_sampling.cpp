// SPDX-License-Identifier: Apache-2.0
#include "scene/light_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/attributes.h"
#include "scene/emission/emission_map.h"
#include "shared/color.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Maximum number of pieces into which all triangles are divided; each triangle gets at most its
// share of them by power. Dividing takes one core 2 ms, and the light tree over the pieces takes 20
// ms and 10 MB.
constexpr double kMostPieces = 1 << 15;
// Edges are halved at most this often: a quad then has 32 by 32 cells. Light drawn from these costs
// about as much as from 8 by 8 cells, and has a third of the variance.
constexpr int kMostHalvings = 5;

// Smaller triangles [m^2] are not lights: the areas of their pieces would underflow, and the
// densities over them would overflow.
constexpr float kLeastArea = 1e-34f;

std::uint64_t triangle_key(std::uint32_t instance, std::uint32_t triangle) {
  return (static_cast<std::uint64_t>(instance) << 32) | triangle;
}

#include "scene/emissive_sample.inl.h"

/// An emissive triangle before it is divided.
struct WholeTriangle {
  std::uint32_t instance, triangle;
  glm::vec3 corner_ws, edge1_ws, edge2_ws;
  float area;
  float color_bound;     // bound of vertex colours, which scale texture and factor
  float mean_luminance;  // without vertex colours [W/(m^2 sr)]
  double power() const { return static_cast<double>(area) * (mean_luminance * color_bound); }
};

// Transforms a triangle to world space; the caller sets its emission.
WholeTriangle in_the_world(const Instance& instance, const Mesh& mesh, std::uint32_t index,
                           std::uint32_t triangle) {
  const glm::uvec3& v = mesh.triangles[triangle];
  const glm::vec3& p0 = mesh.positions[v.x];
  const glm::mat3 linear(instance.world_from_object);
  WholeTriangle whole{};
  whole.instance = index;
  whole.triangle = triangle;
  whole.corner_ws = glm::vec3(instance.world_from_object * glm::vec4(p0, 1.0f));
  whole.edge1_ws = linear * (mesh.positions[v.y] - p0);
  whole.edge2_ws = linear * (mesh.positions[v.z] - p0);
  whole.area = triangle_area(whole.edge1_ws, whole.edge2_ws);
  return whole;
}

// Transforms a piece to world space; the caller sets its probability. Sizes are powers of two, so
// that only the corner is rounded.
EmitterRecord record_of(const WholeTriangle& whole, const EmitterPiece& piece) {
  EmitterRecord emitter{};
  emitter.instance = whole.instance;
  emitter.triangle = whole.triangle;
  emitter.area = whole.area * (piece.size * piece.size);
  emitter.corner_ws =
      whole.corner_ws + piece.corner.x * whole.edge1_ws + piece.corner.y * whole.edge2_ws;
  emitter.edge1_ws = piece.size * whole.edge1_ws;
  emitter.edge2_ws = piece.size * whole.edge2_ws;
  emitter.piece_corner = piece.corner;
  emitter.piece_size = piece.size;
  return emitter;
}

// Returns the brightest vertex colour of a triangle: an unlit surface emits in proportion to it.
float vertex_color_bound(const Mesh& mesh, const Material& material, const glm::uvec3& v) {
  if (!material.unlit || mesh.colors.empty()) return 1.0f;
  return std::max({luminance(glm::vec3(mesh.colors[v.x])), luminance(glm::vec3(mesh.colors[v.y])),
                   luminance(glm::vec3(mesh.colors[v.z]))});
}

// Finds all triangles that may emit, in the order of instances and their triangles.
std::vector<WholeTriangle> find_emissive(const Scene& scene, const std::vector<EmissionMap>& maps) {
  std::vector<WholeTriangle> found;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& material = scene.materials[mesh.material];
    if (!may_emit(material)) continue;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      WholeTriangle whole = in_the_world(instance, mesh, i, t);
      whole.color_bound = vertex_color_bound(mesh, material, mesh.triangles[t]);
      whole.mean_luminance = maps[mesh.material].mean_luminance(mesh, t);
      // Written so that a NaN, too, is left out
      if (!(whole.area >= kLeastArea) || !(whole.power() > 0.0)) continue;
      found.push_back(whole);
    }
  }
  return found;
}

// Barycentrics of the points whose mean is the colour of an emitter: its centre, and those of the
// parts at its corners.
const glm::vec2 kTintedPoints[] = {{1.0f / 3.0f, 1.0f / 3.0f},
                                   {1.0f / 6.0f, 1.0f / 6.0f},
                                   {2.0f / 3.0f, 1.0f / 6.0f},
                                   {1.0f / 6.0f, 2.0f / 3.0f}};

// Returns a colour over its luminance; white where that is 0 or not finite.
glm::vec3 tint_of(const glm::vec3& color) {
  const float whole = luminance(color);
  return whole > 0.0f && std::isfinite(whole) ? color / whole : glm::vec3(1.0f);
}

// Returns the colour that an emitter emits, over its luminance: where it is textured, or has vertex
// colours, the mean of a few of its points, unless these are black.
glm::vec3 tint_of(const Scene& scene, const EmitterRecord& emitter) {
  const Mesh& mesh = scene.meshes[scene.instances[emitter.instance].mesh];
  const Material& material = scene.materials[mesh.material];
  const glm::vec3 plain = material.unlit ? glm::vec3(material.base_color) : material.emission;
  if (!material.unlit && material.emission_texture.texture < 0) return tint_of(plain);
  glm::vec3 sum(0.0f);
  for (const glm::vec2& barycentrics : kTintedPoints) {
    sum += emission_of(scene, emitter, barycentrics).radiance;
  }
  return tint_of(luminance(sum) > 0.0f ? sum : plain);
}

// Returns how often a triangle is halved, from its share of the total power.
int halvings_of(double share) {
  int halvings = 0;
  for (double pieces = 4.0; pieces <= share * kMostPieces && halvings < kMostHalvings;
       pieces *= 4.0) {
    ++halvings;
  }
  return halvings;
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
  std::vector<EmissionMap> maps;
  maps.reserve(scene.materials.size());
  for (const Material& material : scene.materials) maps.emplace_back(scene, material);
  const std::vector<WholeTriangle> triangles = find_emissive(scene, maps);
  double undivided = 0.0;
  for (const WholeTriangle& whole : triangles) undivided += whole.power();

  // Divide triangles; compute each piece's power from its area and the mean radiance of its part of
  // the texture
  std::vector<EmitterPiece> pieces;
  std::vector<double> powers;
  double total = 0.0;
  std::uint32_t instance = ~0u;
  links_.reserve(triangles.size());
  for (const WholeTriangle& whole : triangles) {
    const Mesh& mesh = scene.meshes[scene.instances[whole.instance].mesh];
    const EmissionMap& map = maps[mesh.material];
    const std::size_t first = pieces.size();
    auto link = static_cast<std::uint32_t>(first);
    const std::optional<UvTriangle> uvs = map.uvs_of(mesh, whole.triangle);
    const int halvings =
        uvs ? std::min(halvings_of(whole.power() / undivided), map.useful_halvings(*uvs)) : 0;
    if (halvings > 0) {
      link = pieces_.divide(map, *uvs, halvings, pieces);
    } else {
      pieces.push_back({glm::vec2(0.0f), 1.0f, whole.mean_luminance});
    }
    links_.emplace(triangle_key(whole.instance, whole.triangle), link);
    for (std::size_t p = first; p < pieces.size(); ++p) {
      const EmitterRecord& emitter = entries_.emplace_back(record_of(whole, pieces[p]));
      powers.push_back(static_cast<double>(emitter.area) *
                       (pieces[p].mean_luminance * whole.color_bound));
      total += powers.back();
      if (whole.instance != instance) bounds_.emplace_back();
      instance = whole.instance;
      bounds_.back().add(emitter.corner_ws);
      bounds_.back().add(emitter.corner_ws + emitter.edge1_ws);
      bounds_.back().add(emitter.corner_ws + emitter.edge2_ws);
    }
  }
  tints_.reserve(entries_.size());
  for (const EmitterRecord& emitter : entries_) tints_.push_back(tint_of(scene, emitter));
  total_power_ = static_cast<float>(kTwoPi * total);
  set_probabilities(powers, total);
}

void EmissiveTriangles::set_probabilities(const std::vector<double>& powers, double total) {
  double sum = 0.0;
  cumulative_.reserve(entries_.size());
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    sum += powers[e];
    entries_[e].probability = static_cast<float>(powers[e] / total);
    cumulative_.push_back(static_cast<float>(sum / total));
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

float EmissiveTriangles::pdf_area(std::uint32_t instance, std::uint32_t triangle,
                                  const glm::vec2& barycentrics) const {
  const auto found = links_.find(triangle_key(instance, triangle));
  if (found == links_.end()) return 0.0f;
  const std::uint32_t piece = pieces_.find(found->second, barycentrics);
  if (piece == EmitterPieces::kDark) return 0.0f;
  const EmitterRecord& entry = entries_[piece];
  return entry.probability / entry.area;
}

}  // namespace lambent
