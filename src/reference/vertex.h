// SPDX-License-Identifier: Apache-2.0
// Vertices of the reference's paths, and the light there.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>

#include "raytracing/transmission_math.h"
#include "reference/glass.h"
#include "reference/path.h"
#include "shared/brdf.h"
#include "shared/phase.h"
#include "shared/rays.h"
#include "shared/sampling.h"

namespace lambent::reference {

// A point at which a path scatters, on a surface, through one, or in fog.
struct PathIntegrator::Vertex {
  glm::vec3 position_ws;
  glm::vec3 geometric_normal_ws;  // on the lit side; 0: the point is in fog
  Frame frame;                    // around the shading normal; in fog, around the ray
  glm::vec3 to_viewer;            // in the frame
  Reflectance reflectance;        // in fog the diffuse part is the albedo
  LobeShares shares;
  float anisotropy = 0.0f;                   // of the fog
  Transmission through = no_transmission();  // of surfaces that show the lights behind them

  Vertex(const Surface& surface, const glm::vec3& to_viewer_ws, float max_specular_share)
      : position_ws(surface.position_ws),
        geometric_normal_ws(surface.geometric_normal_ws),
        frame(make_frame(surface.normal_ws)),
        to_viewer(to_local(frame, to_viewer_ws)),
        reflectance(surface.reflectance),
        shares(limited_shares(lobe_shares(reflectance, to_viewer.z), max_specular_share)) {}

  // A surface that samples_lights_behind().
  static Vertex behind(const Surface& surface, const glm::vec3& to_viewer_ws) {
    Vertex vertex(surface, to_viewer_ws, 0.0f);
    vertex.geometric_normal_ws = -surface.geometric_normal_ws;
    vertex.through = surface.transmission;
    return vertex;
  }

  // A vertex in fog, at a scattering event of a ray.
  Vertex(const Ray& ray, const MediumEvent& event)
      : position_ws(ray.origin + event.distance * ray.direction),
        geometric_normal_ws(0.0f),
        frame(make_frame(ray.direction)),
        to_viewer(0.0f, 0.0f, -1.0f),
        reflectance(lambert_reflectance(event.albedo)),
        shares{0.0f, 0.0f},
        anisotropy(event.anisotropy) {}

  bool in_fog() const { return geometric_normal_ws == glm::vec3(0.0f); }
  bool transmits() const { return is_transmissive(through); }
  bool is_black() const { return has_no_base(reflectance) && has_no_coat(reflectance); }
  // Light reaches the surface only where it is above the horizon of both normals; a clearcoat has a
  // normal of its own.
  bool is_lit_from(const glm::vec3& direction_ws) const {
    return in_fog() ||
           (glm::dot(geometric_normal_ws, direction_ws) > 0.0f && cosine(direction_ws) > 0.0f);
  }
  // The cosine that light from a direction is weighted by; 1 in fog.
  float cosine(const glm::vec3& direction_ws) const {
    if (in_fog()) return 1.0f;
    const float cosine = glm::dot(frame.normal, direction_ws);
    if (transmits()) return -cosine;
    if (!has_clearcoat(reflectance.layers)) return cosine;
    return std::max(cosine,
                    glm::dot(reflectance.layers.clearcoat_normal, to_local(frame, direction_ws)));
  }
  // BRDF times cosine, or the phase function times albedo.
  ReflectedPair evaluate(const glm::vec3& direction_ws) const {
    if (in_fog()) return {reflectance.diffuse * pdf(direction_ws), glm::vec3(0.0f)};
    if (transmits()) return {glm::vec3(0.0f), lobe_through(direction_ws).value};
    return evaluate_reflectance(reflectance, to_viewer, to_local(frame, direction_ws));
  }
  glm::vec3 sample(const glm::vec3& u) const {
    if (!in_fog()) return to_world(frame, sample_lobes(reflectance, to_viewer, shares, u));
    const float z = sample_phase(anisotropy, u.x);
    const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z)), angle = kTwoPi * u.y;
    return to_world(frame, {radius * std::cos(angle), radius * std::sin(angle), z});
  }
  float pdf(const glm::vec3& direction_ws) const {
    if (in_fog()) return phase(anisotropy, glm::dot(frame.normal, direction_ws));
    if (transmits()) return lobe_through(direction_ws).pdf;
    return pdf_lobes(reflectance, to_viewer, shares, to_local(frame, direction_ws));
  }
  ThroughLobe lobe_through(const glm::vec3& direction_ws) const {
    return evaluate_through(through, reflectance, to_viewer, to_local(frame, direction_ws));
  }
  glm::vec3 ray_origin() const {
    return in_fog() ? position_ws : offset_ray_origin(position_ws, geometric_normal_ws);
  }
  Ray ray_to(const glm::vec3& direction_ws) const {
    Ray ray;
    ray.origin = ray_origin();
    ray.direction = direction_ws;
    return ray;
  }
};

// Direct light at a vertex, from randomly sampled lights.
struct PathIntegrator::Lighting {
  struct Sample {
    glm::vec3 to_light_ws;
    float distance;
    glm::vec3 weight;  // radiance over density; times BRDF and cosine it is the estimate
    bool from_sky;
    bool punctual = false;  // scattered rays cannot hit the light
  };
  std::array<Sample, 3> samples;
  int count = 0;

  void add(const Sample& sample) { samples[count++] = sample; }
};

// Light that arrives along a scattered ray.
struct PathIntegrator::Incident {
  glm::vec3 emitted{0.0f};  // by the surface that the ray hits
  glm::vec3 other{0.0f};
};

}  // namespace lambent::reference
