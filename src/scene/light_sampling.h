// SPDX-License-Identifier: Apache-2.0
// Emissive triangles as lights: a table to draw from, and its densities.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

#include "lambent/scene.h"
#include "scene/emission/emitter_pieces.h"
#include "scene/emissive_sample.h"
#include "scene/punctual_light.h"

namespace lambent {

/// A point drawn from the emissive triangles.
struct EmissiveSample {
  glm::vec3 position_ws{0.0f};
  glm::vec3 normal_ws{0.0f};  ///< Geometric, unit; both sides emit.
  glm::vec3 radiance{0.0f};   ///< Before it passes a clearcoat [W/(m^2 sr)].
  float clearcoat = 0.0f;     ///< Share covered by a clearcoat, 0 to 1.
  float pdf_area = 0.0f;  ///< Over the area of all emissive triangles [1/m^2]; 0: there are none.
};

/// An entry that was picked, and the uniform number that picked it, rescaled.
struct EmitterPick {
  std::uint32_t emitter;
  float probability;  ///< Of picking it.
  float rest;         ///< Uniform, 0 to 1.
};

/// Converts a light to the form that shared mathematics uses.
LightRecord light_record(const Light& light);

/// The unoccluded light from `light` at `position_ws`; irradiance 0 outside its cone or range.
PunctualSample sample_punctual(const Light& light, const glm::vec3& position_ws);

/// All emissive triangles of a scene, drawn with probability proportional to their power. Those
/// whose texture emits unevenly are drawn in pieces, and dark pieces are not drawn.
class EmissiveTriangles {
 public:
  explicit EmissiveTriangles(const Scene& scene);

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }

  /// A point for three uniform numbers: the first picks the entry, the others the point on it.
  EmissiveSample sample(const glm::vec3& u) const;

  /// Picks an entry by power. There must be one.
  EmitterPick pick(float u) const;

  /// The radiance that a point of an entry emits along a unit direction, including its coverage and
  /// the transmittance of its clearcoat [W/(m^2 sr)]. `barycentrics` are those in the entry.
  glm::vec3 radiance(const EmitterRecord& emitter, const glm::vec2& barycentrics,
                     const glm::vec3& direction_ws) const;

  /// The density [1/m^2] with which `sample` draws a point of a triangle; 0 where it does not emit.
  float pdf_area(std::uint32_t instance, std::uint32_t triangle,
                 const glm::vec2& barycentrics) const;

  /// Emissive triangles, or pieces of them where they are divided, by instance and triangle.
  const std::vector<EmitterRecord>& entries() const { return entries_; }
  /// The colours that the entries emit, each over its luminance.
  const std::vector<glm::vec3>& tints() const { return tints_; }
  /// World-space boxes of the emissive triangles, one an instance [m].
  const std::vector<Bounds>& bounds() const { return bounds_; }

  /// Power of all triangles, both sides [W], luminance-weighted.
  float total_power() const { return total_power_; }

 private:
  void set_probabilities(const std::vector<double>& powers, double total);

  const Scene* scene_;
  EmitterPieces pieces_;
  std::vector<EmitterRecord> entries_;
  std::vector<glm::vec3> tints_;
  std::vector<Bounds> bounds_;
  std::vector<float> cumulative_;
  std::unordered_map<std::uint64_t, std::uint32_t> links_;  // links of pieces_, by triangle
  float total_power_ = 0.0f;
};

}  // namespace lambent
