// SPDX-License-Identifier: Apache-2.0
// Paths of the reference through transmissive surfaces.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "raytracing/transmission_math.h"
#include "reference/sampler.h"

namespace lambent::reference {

/// The density of directions for which only scattered rays find emitters, and samples of lights
/// cannot.
inline constexpr float kFoundByScatteringAlone = std::numeric_limits<float>::infinity();

/// The state of a scattered ray until the next surface that scatters it.
struct PathSegment {
  float pdf;              ///< Density with which its direction was drawn [1/sr].
  float distance = 0.0f;  ///< Length of its path so far, through clear panes [m].
  int crossed = 0;        ///< Number of surfaces that it has passed.
  bool seen = false;      ///< It left the camera, and has only passed surfaces since.

  /// Goes on behind a surface: where that scatters light, in a new direction.
  void cross(const Transmission& through, const ThroughDraw& drawn);
};

/// The ray that leaves a surface on the side of its geometric normal.
Ray ray_from(const glm::vec3& position_ws, const glm::vec3& geometric_normal_ws,
             const glm::vec3& direction_ws);

/// Share of light that arrives along a shadow ray, which passes smooth panes straight. Where a
/// surface scatters or refracts light, scattered rays find emitters instead, and the result is 0,
/// unless the ray `crosses_all`: those to punctual lights, which no scattered ray can hit.
glm::vec3 light_through(const World& world, Ray ray, bool crosses_all, std::uint64_t& rays);

/// Whether a path goes on through a surface, drawn at random; `ray` is then the one behind it.
/// Otherwise, the throughput is divided by the probability of reflection.
bool cross(const Surface& surface, Ray& ray, glm::vec3& throughput, PathSegment& traveller,
           SobolSampler& random);

}  // namespace lambent::reference
