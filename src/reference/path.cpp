// SPDX-License-Identifier: Apache-2.0
#include "reference/path.h"

#include <algorithm>
#include <cmath>

#include "raytracing/glass/absorption.h"
#include "raytracing/transmission_math.h"
#include "raytracing/world_access.h"
#include "reference/glass.h"
#include "reference/vertex.h"
#include "scene/light_sampling.h"
#include "shared/brdf.h"
#include "shared/constants.h"
#include "shared/rays.h"

namespace lambent::reference {
namespace {

// Largest share of the rays scattered by the first surface that samples its specular lobe: the
// others also measure irradiance, which even a mirror has.
constexpr float kMaxFirstSpecularShare = 0.75f;
// Bounces before Russian roulette may end a path: fewer would add noise to the brightest light.
constexpr int kBouncesBeforeRoulette = 2;
// Largest probability of survival in Russian roulette: paths end even where nothing is absorbed.
constexpr float kMaxSurvival = 0.95f;

float max_component(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

}  // namespace

PathIntegrator::PathIntegrator(const World& world, int max_bounces, Strategy strategy,
                               float unlit_radiance)
    : world_(world),
      scene_(world.scene()),
      max_bounces_(max_bounces),
      strategy_(strategy),
      unlit_radiance_(unlit_radiance),
      environment_(world.scene().environment),
      media_(world.scene().fog) {}

// Weight of light hit by a scattered ray of density `pdf`, which light sampling could find, too.
float PathIntegrator::found_weight(float pdf, float light_pdf) const {
  if (light_pdf <= 0.0f || strategy_ == Strategy::scatter) return 1.0f;
  if (pdf == kFoundByScatteringAlone) return 1.0f;
  return strategy_ == Strategy::light ? 0.0f : mis_power_weight(pdf, light_pdf);
}

// Weight of sampled light, which a scattered ray could hit, too.
float PathIntegrator::drawn_weight(float light_pdf, float pdf) const {
  return strategy_ == Strategy::light ? 1.0f : mis_power_weight(light_pdf, pdf);
}

glm::vec3 PathIntegrator::sky_found(const glm::vec3& direction_ws, float pdf) const {
  return sky_radiance(scene_.environment, direction_ws) *
         found_weight(pdf, environment_.pdf(direction_ws));
}

glm::vec3 PathIntegrator::emission_found(const Surface& surface, const Ray& ray, const Hit& hit,
                                         const PathSegment& traveller) const {
  if (surface.emission == glm::vec3(0.0f)) return surface.emission;
  const float distance = traveller.distance + hit.distance;
  const float cosine = std::abs(glm::dot(surface.geometric_normal_ws, ray.direction));
  const float pdf_area = emissive_of(world_).pdf_area(hit.instance, hit.triangle, hit.barycentrics);
  const float light_pdf = cosine > 0.0f ? pdf_area * distance * distance / cosine : 0.0f;
  return surface.emission * found_weight(traveller.pdf, light_pdf);
}

// Samples one light with a probability in proportion to its unoccluded light at the vertex.
void PathIntegrator::add_punctual(const Vertex& vertex, float u, Lighting& lighting) const {
  const auto importance = [&](const PunctualSample& light) {
    return vertex.is_lit_from(light.to_light)
               ? max_component(light.irradiance) * vertex.cosine(light.to_light)
               : 0.0f;
  };
  float total = 0.0f;
  for (const Light& light : scene_.lights) {
    total += importance(sample_punctual(light, vertex.position_ws));
  }
  if (!(total > 0.0f)) return;
  float left = u * total;
  PunctualSample picked{};
  float picked_importance = 0.0f;
  for (const Light& light : scene_.lights) {
    const PunctualSample candidate = sample_punctual(light, vertex.position_ws);
    const float share = importance(candidate);
    if (share <= 0.0f) continue;
    picked = candidate;
    picked_importance = share;
    left -= share;
    if (left < 0.0f) break;
  }
  // Lights often lie on a surface of their lamp, which is not in their way
  const float offset = glm::distance(vertex.ray_origin(), vertex.position_ws);
  const float end = std::max(before_hit(picked.distance - offset), 0.0f);
  lighting.add(
      {picked.to_light, end, picked.irradiance * (total / picked_importance), false, true});
}

void PathIntegrator::add_emissive(const Vertex& vertex, const glm::vec3& u,
                                  Lighting& lighting) const {
  const EmissiveSample light = emissive_of(world_).sample(u);
  const glm::vec3 offset = light.position_ws - vertex.ray_origin();
  const float squared_distance = glm::dot(offset, offset);
  if (light.pdf_area <= 0.0f || squared_distance <= 0.0f) return;
  const float distance = std::sqrt(squared_distance);
  const glm::vec3 to_light = offset / distance;
  const float cosine = std::abs(glm::dot(light.normal_ws, to_light));
  if (cosine <= 0.0f || !vertex.is_lit_from(to_light) || light.radiance == glm::vec3(0.0f)) return;
  const float light_pdf = light.pdf_area * squared_distance / cosine;
  lighting.add({to_light, distance * (1.0f - kShadowRayShortening),
                light.radiance * (clearcoat_transmittance(light.clearcoat, cosine) *
                                  drawn_weight(light_pdf, vertex.pdf(to_light)) / light_pdf),
                false});
}

void PathIntegrator::add_environment(const Vertex& vertex, const glm::vec2& u,
                                     Lighting& lighting) const {
  const EnvironmentSample sky = environment_.sample(u);
  if (sky.pdf <= 0.0f || !vertex.is_lit_from(sky.direction_ws)) return;
  lighting.add({sky.direction_ws, kInfiniteDistance,
                sky.radiance * (drawn_weight(sky.pdf, vertex.pdf(sky.direction_ws)) / sky.pdf),
                true});
}

void PathIntegrator::dim(const Vertex& vertex, Lighting& lighting, std::uint64_t& rays) const {
  int kept = 0;
  for (int i = 0; i < lighting.count; ++i) {
    Lighting::Sample& sample = lighting.samples[i];
    Ray ray = vertex.ray_to(sample.to_light_ws);
    ray.t_max = sample.distance;
    // Where scattered light passes further surfaces that scatter it, these sample the lights
    const bool crosses_all = sample.punctual && !vertex.transmits();
    const glm::vec3 share = light_through(world_, ray, crosses_all, rays);
    if (share == glm::vec3(0.0f)) continue;
    sample.weight *= share * transmittance(media_, ray.origin, ray.direction, sample.distance);
    lighting.samples[kept++] = sample;
  }
  lighting.count = kept;
}

PathIntegrator::Lighting PathIntegrator::sample_lights(const Vertex& vertex, SobolSampler& random,
                                                       std::uint64_t& rays,
                                                       bool with_punctual) const {
  Lighting lighting;
  if (with_punctual && !scene_.lights.empty()) add_punctual(vertex, random.next1(), lighting);
  if (strategy_ != Strategy::scatter) {
    if (!emissive_of(world_).empty()) {
      const glm::vec2 point = random.next2();
      add_emissive(vertex, glm::vec3(random.next1(), point), lighting);
    }
    if (!environment_.empty()) add_environment(vertex, random.next2(), lighting);
  }
  dim(vertex, lighting, rays);
  return lighting;
}

// The vertex in fog at which a ray's light is scattered before `t_max`, if it is.
std::optional<PathIntegrator::Vertex> PathIntegrator::scatter_in_fog(const Ray& ray, float t_max,
                                                                     SobolSampler& random) const {
  if (media_.empty()) return std::nullopt;
  const glm::vec2 u = random.next2();
  const float depth = -std::log1p(-u.x);
  if (depth >= optical_depth(media_, ray.origin, ray.direction, 0.0f, t_max)) return std::nullopt;
  return Vertex(ray, media_.event_at(ray.origin, ray.direction, t_max, depth, u.y));
}

// Light of sources that comes through a surface. Punctual lights shine through it to the camera
// alone (`seen`): the surfaces behind which it stands sample these straight through it.
PathIntegrator::Incident PathIntegrator::light_behind(const Surface& surface,
                                                      const glm::vec3& to_viewer_ws, bool seen,
                                                      SobolSampler& random,
                                                      std::uint64_t& rays) const {
  Incident incident;
  if (!samples_lights_behind(surface.transmission)) return incident;
  const Vertex vertex = Vertex::behind(surface, to_viewer_ws);
  const Lighting lighting = sample_lights(vertex, random, rays, seen);
  for (int i = 0; i < lighting.count; ++i) {
    const Lighting::Sample& light = lighting.samples[i];
    (light.from_sky ? incident.other : incident.emitted) +=
        vertex.evaluate(light.to_light_ws).specular * light.weight;
  }
  return incident;
}

PathIntegrator::Incident PathIntegrator::sample_incident(Ray ray, PathSegment traveller,
                                                         SobolSampler& random,
                                                         std::uint64_t& rays) const {
  Incident incident;
  glm::vec3 throughput(1.0f);
  for (int bounce = 1;; ++bounce) {
    ++rays;
    const Hit hit = tracer_of(world_).closest_hit(ray);
    std::optional<Vertex> found = scatter_in_fog(ray, hit.distance, random);
    if (!found) {
      if (hit.missed()) {
        incident.other += throughput * sky_found(ray.direction, traveller.pdf);
        return incident;
      }
      const Surface surface = surface_at(scene_, ray, hit);
      throughput *= volume_transmittance(surface.transmission.absorption, hit.distance);
      (bounce == 1 ? incident.emitted : incident.other) +=
          throughput * emission_found(surface, ray, hit, traveller);
      traveller.distance += hit.distance;
      const Incident behind = light_behind(surface, -ray.direction, traveller.seen, random, rays);
      (bounce == 1 ? incident.emitted : incident.other) += throughput * behind.emitted;
      incident.other += throughput * behind.other;
      if (cross(surface, ray, throughput, traveller, random)) {
        --bounce;  // only diffuse and glossy bounces count
        continue;
      }
      found.emplace(surface, -ray.direction, 1.0f);
    }
    if (bounce > max_bounces_) return incident;

    // Add the direct light that the vertex reflects
    const Vertex& vertex = *found;
    if (vertex.is_black()) return incident;
    const Lighting lighting = sample_lights(vertex, random, rays);
    for (int i = 0; i < lighting.count; ++i) {
      const ReflectedPair reflected = vertex.evaluate(lighting.samples[i].to_light_ws);
      incident.other +=
          throughput * (reflected.diffuse + reflected.specular) * lighting.samples[i].weight;
    }

    // Scatter, and let Russian roulette end paths of low throughput
    const glm::vec3 direction_ws = vertex.sample(random.next3());
    const float pdf = vertex.pdf(direction_ws);
    if (!(pdf > 0.0f) || !vertex.is_lit_from(direction_ws)) return incident;
    traveller = {pdf, 0.0f, traveller.crossed, false};
    const ReflectedPair reflected = vertex.evaluate(direction_ws);
    throughput *= (reflected.diffuse + reflected.specular) / pdf;
    if (bounce >= kBouncesBeforeRoulette) {
      const float survival = std::min(max_component(throughput), kMaxSurvival);
      if (random.next1() >= survival) return incident;
      throughput /= survival;
    }
    ray = vertex.ray_to(direction_ws);
  }
}

// Light transmitted through a surface along a camera ray.
glm::vec3 PathIntegrator::sample_through(const Surface& surface, const Ray& ray,
                                         SobolSampler& random, std::uint64_t& rays) const {
  const Incident sampled = light_behind(surface, -ray.direction, true, random, rays);
  const ThroughDraw drawn = draw_through(surface.transmission, surface.reflectance,
                                         surface.normal_ws, -ray.direction, random.next3());
  if (drawn.weight == glm::vec3(0.0f)) return sampled.emitted + sampled.other;
  const glm::vec3 side =
      drawn.crosses != 0u ? -surface.geometric_normal_ws : surface.geometric_normal_ws;
  PathSegment traveller{kFoundByScatteringAlone, 0.0f, 0, true};
  traveller.cross(surface.transmission, drawn);
  const Incident incident = sample_incident(ray_from(surface.position_ws, side, drawn.direction_ws),
                                            traveller, random, rays);
  return sampled.emitted + sampled.other + drawn.weight * (incident.emitted + incident.other);
}

// Light that fog scatters to the camera along a ray, where the optical depth up to `t_max` is
// `depth`.
glm::vec3 PathIntegrator::sample_fog(const Ray& ray, float t_max, float depth, SobolSampler& random,
                                     std::uint64_t& rays) const {
  if (!(depth > 0.0f)) return glm::vec3(0.0f);
  // Sample an event among those before `t_max` alone: its weight is their total probability
  const float share = -std::expm1(-depth);
  const glm::vec2 u = random.next2();
  const float event_depth = std::min(-std::log1p(-u.x * share), depth);
  const Vertex vertex(ray, media_.event_at(ray.origin, ray.direction, t_max, event_depth, u.y));
  if (vertex.is_black()) return glm::vec3(0.0f);
  glm::vec3 scattered(0.0f);
  const Lighting lighting = sample_lights(vertex, random, rays);
  for (int i = 0; i < lighting.count; ++i) {
    const Lighting::Sample& light = lighting.samples[i];
    scattered += vertex.evaluate(light.to_light_ws).diffuse * light.weight;
  }
  const glm::vec3 direction_ws = vertex.sample(random.next3());
  const Incident incident =
      sample_incident(vertex.ray_to(direction_ws), {vertex.pdf(direction_ws)}, random, rays);
  scattered += vertex.reflectance.diffuse * (incident.emitted + incident.other);
  return share * scattered;
}

PixelSample PathIntegrator::sample_pixel(const Ray& ray, SobolSampler& random,
                                         std::uint64_t& rays) const {
  ++rays;
  const Hit hit = tracer_of(world_).closest_hit(ray);
  if (media_.empty()) return sample_seen(ray, hit, random, rays);
  const float depth = optical_depth(media_, ray.origin, ray.direction, 0.0f, hit.distance);
  const float share = std::exp(-depth);
  PixelSample sample = sample_seen(ray, hit, random, rays);
  for (glm::vec3* light :
       {&sample.direct, &sample.indirect, &sample.glossy, &sample.transmission, &sample.emission}) {
    *light *= share;
  }
  sample.fog = sample_fog(ray, hit.distance, depth, random, rays);
  return sample;
}

// Light of the surface that a camera ray hits, without the fog in front.
PixelSample PathIntegrator::sample_seen(const Ray& ray, const Hit& hit, SobolSampler& random,
                                        std::uint64_t& rays) const {
  PixelSample sample;
  if (hit.missed()) {
    sample.emission = sky_radiance(scene_.environment, ray.direction);
    return sample;
  }
  const Surface surface = surface_at(scene_, ray, hit);
  const bool unlit = scene_.materials[surface.material].unlit;
  sample.emission = (unlit ? unlit_radiance_ : 1.0f) * surface.emission;
  sample.albedo = surface.reflectance.diffuse;
  sample.normal = surface.normal_ws;

  if (is_transmissive(surface.transmission)) {
    sample.transmission = sample_through(surface, ray, random, rays);
  }

  const Vertex vertex(surface, -ray.direction, kMaxFirstSpecularShare);
  const auto add = [&](const glm::vec3& direction_ws, const glm::vec3& direct_weight,
                       const glm::vec3& indirect_weight) {
    const ReflectedPair reflected = vertex.evaluate(direction_ws);
    sample.direct += reflected.diffuse * direct_weight;
    sample.indirect += reflected.diffuse * indirect_weight;
    sample.glossy += reflected.specular * (direct_weight + indirect_weight);
    sample.irradiance +=
        std::max(glm::dot(vertex.frame.normal, direction_ws), 0.0f) * indirect_weight;
  };

  const Lighting lighting = sample_lights(vertex, random, rays);
  for (int i = 0; i < lighting.count; ++i) {
    const Lighting::Sample& light = lighting.samples[i];
    add(light.to_light_ws, light.from_sky ? glm::vec3(0.0f) : light.weight,
        light.from_sky ? light.weight : glm::vec3(0.0f));
  }

  const glm::vec3 direction_ws = vertex.sample(random.next3());
  const float pdf = vertex.pdf(direction_ws);
  if (!(pdf > 0.0f) || !vertex.is_lit_from(direction_ws)) return sample;
  const Incident incident = sample_incident(vertex.ray_to(direction_ws), {pdf}, random, rays);
  add(direction_ws, incident.emitted / pdf, incident.other / pdf);
  return sample;
}

IrradianceSample PathIntegrator::sample_irradiance(const glm::vec3& position_ws,
                                                   const glm::vec3& normal_ws, SobolSampler& random,
                                                   std::uint64_t& rays) const {
  // A white Lambert surface reflects its irradiance over pi
  Surface surface{};
  surface.position_ws = position_ws;
  surface.normal_ws = normal_ws;
  surface.geometric_normal_ws = normal_ws;
  surface.reflectance = lambert_reflectance(glm::vec3(1.0f));
  const Vertex vertex(surface, normal_ws, 0.0f);

  IrradianceSample sample;
  const Lighting lighting = sample_lights(vertex, random, rays);
  for (int i = 0; i < lighting.count; ++i) {
    const Lighting::Sample& light = lighting.samples[i];
    (light.from_sky ? sample.indirect : sample.direct) +=
        light.weight * glm::dot(normal_ws, light.to_light_ws);
  }
  const glm::vec3 direction_ws = vertex.sample(random.next3());
  if (!vertex.is_lit_from(direction_ws)) return sample;
  const Incident incident =
      sample_incident(vertex.ray_to(direction_ws), {vertex.pdf(direction_ws)}, random, rays);
  sample.direct += incident.emitted * kPi;  // cosine over its density
  sample.indirect += incident.other * kPi;
  return sample;
}

}  // namespace lambent::reference
