// SPDX-License-Identifier: Apache-2.0
// Paths of the reference through surfaces that let light through.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "reference/sampler.h"

namespace lambent::reference {

/// Density of directions whose lights are found by scattering alone.
inline constexpr float kFoundByScatteringAlone = std::numeric_limits<float>::infinity();

/// A scattered ray on its way to the next surface that scatters it.
struct Traveller {
  float pdf;       ///< Density with which its direction was drawn [1/sr].
  float distance;  ///< Behind it, through panes [m].
  int crossed;     ///< Surfaces.
};

/// The ray that leaves a surface on the side of its geometric normal.
Ray ray_from(const glm::vec3& position_ws, const glm::vec3& geometric_normal_ws,
             const glm::vec3& direction_ws);

/// Share of light that arrives along a shadow ray. It goes straight through smooth panes. Where a
/// surface scatters or refracts it, scattered rays find the light; but for punctual lights, which
/// none can find: their light is taken to go straight there, too.
glm::vec3 light_through(const World& world, Ray ray, bool from_punctual, std::uint64_t& rays);

/// Whether a path goes on through a surface, which chance decides; `ray` is then the one behind it.
/// Else the throughput is that of what the surface reflects.
bool cross(const Surface& surface, Ray& ray, glm::vec3& throughput, Traveller& traveller,
           SobolSampler& random);

}  // namespace lambent::reference
