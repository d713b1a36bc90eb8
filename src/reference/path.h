// SPDX-License-Identifier: Apache-2.0
// Based on: Kajiya, "The Rendering Equation", SIGGRAPH 1986; Veach, "Robust Monte Carlo Methods for
// Light Transport Simulation", 1997 (multiple importance sampling).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "lambent/scene.h"
#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "reference/glass.h"
#include "reference/sampler.h"
#include "reference/strategy.h"
#include "scene/environment_sampling.h"
#include "scene/media/media.h"

namespace lambent::reference {

/// One sample of a pixel, split by how the visible surface reflects the light. All parts except
/// `irradiance`, `fog`, `albedo` and `normal` are attenuated by the fog in front of the surface.
struct PixelSample {
  glm::vec3 direct{0.0f};        ///< Diffuse, from punctual lights and emissive surfaces.
  glm::vec3 indirect{0.0f};      ///< Diffuse, all other light.
  glm::vec3 irradiance{0.0f};    ///< The irradiance that `indirect` reflects [W/m^2].
  glm::vec3 glossy{0.0f};        ///< Specular, all light.
  glm::vec3 transmission{0.0f};  ///< Transmitted through the surface.
  glm::vec3 emission{0.0f};      ///< Emitted towards the camera; the sky where nothing is hit.
  glm::vec3 fog{0.0f};           ///< Scattered to the camera by fog, all light.
  glm::vec3 albedo{0.0f};        ///< Albedo of the diffuse part.
  glm::vec3 normal{0.0f};        ///< Shading normal.

  glm::vec3 radiance() const { return direct + indirect + glossy + transmission + emission + fog; }
};

/// Irradiance at a point, split as in PixelSample.
struct IrradianceSample {
  glm::vec3 direct{0.0f};
  glm::vec3 indirect{0.0f};
};

/// Traces light paths backwards through a world. Const and safe to call from many threads at once.
class PathIntegrator {
 public:
  /// Refers to the world, which must outlive it. `max_bounces`: largest number of bounces of
  /// indirect light, off surfaces and in fog. `unlit_radiance`: see FrameSettings.
  PathIntegrator(const World& world, int max_bounces, Strategy strategy,
                 float unlit_radiance = 1.0f);

  /// An unbiased estimate of the light along a camera ray. Adds the number of rays traced to
  /// `rays`.
  PixelSample sample_pixel(const Ray& ray, SobolSampler& random, std::uint64_t& rays) const;

  /// An unbiased estimate of the irradiance at a point of a surface with this unit normal.
  IrradianceSample sample_irradiance(const glm::vec3& position_ws, const glm::vec3& normal_ws,
                                     SobolSampler& random, std::uint64_t& rays) const;

 private:
  struct Vertex;
  struct Lighting;
  struct Incident;

  Lighting sample_lights(const Vertex& vertex, SobolSampler& random, std::uint64_t& rays,
                         bool with_punctual = true) const;
  void add_punctual(const Vertex& vertex, float u, Lighting& lighting) const;
  void add_emissive(const Vertex& vertex, const glm::vec3& u, Lighting& lighting) const;
  void add_environment(const Vertex& vertex, const glm::vec2& u, Lighting& lighting) const;
  void dim(const Vertex& vertex, Lighting& lighting, std::uint64_t& rays) const;
  Incident light_behind(const Surface& surface, const glm::vec3& to_viewer_ws, bool seen,
                        SobolSampler& random, std::uint64_t& rays) const;
  glm::vec3 sample_through(const Surface& surface, const Ray& ray, SobolSampler& random,
                           std::uint64_t& rays) const;
  PixelSample sample_seen(const Ray& ray, const Hit& hit, SobolSampler& random,
                          std::uint64_t& rays) const;
  glm::vec3 sample_fog(const Ray& ray, float t_max, float depth, SobolSampler& random,
                       std::uint64_t& rays) const;
  std::optional<Vertex> scatter_in_fog(const Ray& ray, float t_max, SobolSampler& random) const;

  Incident sample_incident(Ray ray, PathSegment traveller, SobolSampler& random,
                           std::uint64_t& rays) const;
  glm::vec3 sky_found(const glm::vec3& direction_ws, float pdf) const;
  glm::vec3 emission_found(const Surface& surface, const Ray& ray, const Hit& hit,
                           const PathSegment& traveller) const;
  float found_weight(float pdf, float light_pdf) const;
  float drawn_weight(float light_pdf, float pdf) const;

  const World& world_;
  const Scene& scene_;
  int max_bounces_;
  Strategy strategy_;
  float unlit_radiance_;
  EnvironmentDistribution environment_;
  Media media_;
};

}  // namespace lambent::reference
