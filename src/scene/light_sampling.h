// SPDX-License-Identifier: Apache-2.0
// Emissive triangles as lights: a table to draw from, and its densities.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

#include "lambent/scene.h"
#include "scene/emissive_sample.h"
#include "scene/punctual_light.h"

namespace lambent {

/// A light as formulas see it.
LightRecord light_record(const Light& light);

/// What `light` sends to `position_ws`; irradiance 0 outside its cone or range.
PunctualSample sample_punctual(const Light& light, const glm::vec3& position_ws);

/// All emissive triangles of a scene, drawn with probability proportional to their power.
class EmissiveTriangles {
 public:
  explicit EmissiveTriangles(const Scene& scene);

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }

  /// A point for three uniform numbers: the first picks the triangle, the others the point on it.
  EmissiveSample sample(const glm::vec3& u) const;

  /// A given point of a triangle, as if it were drawn; of density 0 where it does not emit.
  EmissiveSample at(std::uint32_t instance, std::uint32_t triangle,
                    const glm::vec2& barycentrics) const;

  /// The density [1/m^2] with which `sample` draws points of this triangle; 0 where it does not
  /// emit.
  float pdf_area(std::uint32_t instance, std::uint32_t triangle) const;

  /// The triangles, by instance and triangle.
  const std::vector<EmitterRecord>& entries() const { return entries_; }
  /// Upper end of each entry's interval of [0, 1).
  const std::vector<float>& cumulative() const { return cumulative_; }

  /// World-space boxes of the emissive triangles, one an instance [m].
  const std::vector<Bounds>& bounds() const { return bounds_; }

  /// Power of all triangles, both sides [W], luminance-weighted.
  float total_power() const { return total_power_; }

 private:
  const Scene* scene_;
  std::vector<EmitterRecord> entries_;
  std::vector<Bounds> bounds_;
  std::vector<float> cumulative_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_of_;
  float total_power_ = 0.0f;
};

}  // namespace lambent
