// SPDX-License-Identifier: Apache-2.0
// Based on: Kajiya, "The Rendering Equation", SIGGRAPH 1986; Veach, "Robust Monte Carlo Methods for
// Light Transport Simulation", 1997 (multiple importance sampling).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "lambent/scene.h"
#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "reference/sampler.h"
#include "reference/strategy.h"
#include "scene/environment_sampling.h"

namespace lambent::reference {

/// One sample of a pixel, its light split by how the surface that is seen reflects it.
struct PixelSample {
  glm::vec3 direct{0.0f};      ///< Diffuse, from punctual lights and emissive surfaces.
  glm::vec3 indirect{0.0f};    ///< Diffuse, all other light.
  glm::vec3 irradiance{0.0f};  ///< What `indirect` reflects [W/m^2].
  glm::vec3 glossy{0.0f};      ///< Specular, all light.
  glm::vec3 emission{0.0f};    ///< Emitted towards the camera; the sky where nothing is hit.
  glm::vec3 albedo{0.0f};      ///< Of the diffuse part.
  glm::vec3 normal{0.0f};      ///< Shading normal.

  glm::vec3 radiance() const { return direct + indirect + glossy + emission; }
};

/// Irradiance at a point, split as in PixelSample.
struct IrradianceSample {
  glm::vec3 direct{0.0f};
  glm::vec3 indirect{0.0f};
};

/// Follows light paths backwards through a world. Const and safe to call from many threads at once.
class PathIntegrator {
 public:
  /// Refers to the world, which must outlive it. `max_bounces` counts the bounces of indirect
  /// light.
  PathIntegrator(const World& world, int max_bounces, Strategy strategy);

  /// An unbiased estimate of what arrives along a camera ray. Adds the rays it took to `rays`.
  PixelSample sample_pixel(const Ray& ray, SobolSampler& random, std::uint64_t& rays) const;

  /// An unbiased estimate of the irradiance at a point of a surface of that unit normal.
  IrradianceSample sample_irradiance(const glm::vec3& position_ws, const glm::vec3& normal_ws,
                                     SobolSampler& random, std::uint64_t& rays) const;

 private:
  struct Vertex;
  struct Lighting;
  struct Incident;

  Lighting sample_lights(const Vertex& vertex, SobolSampler& random, std::uint64_t& rays) const;
  void add_punctual(const Vertex& vertex, float u, Lighting& lighting) const;
  void add_emissive(const Vertex& vertex, const glm::vec3& u, Lighting& lighting) const;
  void add_environment(const Vertex& vertex, const glm::vec2& u, Lighting& lighting) const;
  void drop_occluded(const Vertex& vertex, Lighting& lighting, std::uint64_t& rays) const;

  Incident sample_incident(Ray ray, float pdf, SobolSampler& random, std::uint64_t& rays) const;
  glm::vec3 sky_found(const glm::vec3& direction_ws, float pdf) const;
  glm::vec3 emission_found(const Surface& surface, const Ray& ray, const Hit& hit, float pdf) const;
  float found_weight(float pdf, float light_pdf) const;
  float drawn_weight(float light_pdf, float pdf) const;

  const World& world_;
  const Scene& scene_;
  int max_bounces_;
  Strategy strategy_;
  EnvironmentDistribution environment_;
};

}  // namespace lambent::reference
