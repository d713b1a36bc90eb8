// SPDX-License-Identifier: Apache-2.0
#include "first_picture/seen.h"

#include <algorithm>
#include <optional>

#include "core/parallel.h"
#include "first_picture/survey.h"
#include "raytracing/direct_light.h"
#include "raytracing/surface.h"
#include "raytracing/trace_rays.h"
#include "raytracing/world_access.h"
#include "scene/attributes.h"
#include "shared/random.h"
#include "shared/rays.h"

namespace lambent {
namespace {

// Number of points across and up the picture.
constexpr int kAcross = 24, kUp = 14;
constexpr float kAspect = 16.0f / 9.0f;
// Number of rays that look for emitters and sky at each point; samples of emitters at each point,
// and at each hit of those rays.
constexpr int kRaysPerPoint = 8;
constexpr int kEmitterSamples = 16, kBounceSamples = 4;
// Points are lit where they receive at least this share of the median of those that receive any
// light: others are dark in comparison.
constexpr float kLitShare = 1.0f / 32.0f;
// Unlit materials have colours, but no unit of light. They count as emitters only where at least
// this share of the samples shows them, as walls whose light was baked, and not for a poster.
constexpr float kMostlyUnlit = 0.5f;
// Number of directions around the camera.
constexpr int kSphereRays = 64;
// Seed of the random numbers of measurements.
constexpr std::uint32_t kLightSeed = 3;
// Seed of the choice of lights to which shadow rays go.
constexpr std::uint32_t kLitViewSeed = 4;

LitPoint lit_point(const Surface& surface) {
  return {surface.position_ws, surface.geometric_normal_ws, surface.geometric_normal_ws};
}

float largest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// What reaches a point.
struct PointLight {
  float irradiance = 0.0f;         ///< From emitters, directly and after one bounce.
  float brightest_emitter = 0.0f;  ///< Largest radiance of those emitters [W/(m^2 sr)].
  int escaped = 0;                 ///< Number of rays that left the scene, through glass or not.
};

/// The emissive surfaces that may light a view.
struct CountedEmitters {
  const World& world;
  bool unlit;  ///< Whether those of unlit materials count.
};

/// Irradiance from emissive surfaces, estimated from `samples` samples of them.
float emitted_irradiance(const CountedEmitters& by, const LitPoint& point, int samples,
                         RandomStream& random, float& brightest_emitter) {
  const World& world = by.world;
  const EmissiveTriangles& emissive = emissive_of(world);
  if (emissive.empty()) return 0.0f;
  float sum = 0.0f;
  const float share = 1.0f / static_cast<float>(samples);
  for (int i = 0; i < samples; ++i) {
    const float u = (static_cast<float>(i) + next_uniform(random)) * share;
    // From the tree of lights: a lamp nearby may be outshone by lamps in other rooms. Lights that
    // are no triangles have larger numbers
    const LightPick pick = lights_of(world).pick(point.position_ws, point.normal_ws, no_pick_lobe(),
                                                 std::min(u, kLargestUniform));
    if (pick.probability <= 0.0f || pick.light >= emissive.size()) continue;
    const EmitterRecord& emitter = emissive.entries()[pick.light];
    if (!by.unlit && is_unlit(material_of(world.scene(), emitter.instance))) continue;
    const TrianglePointSeen seen =
        draw_on_triangle(emitter.corner_ws - point.position_ws, emitter.edge1_ws, emitter.edge2_ws,
                         next_uniform2(random));
    const float cosine = glm::dot(point.normal_ws, seen.to_point);
    if (seen.pdf <= 0.0f || cosine <= 0.0f) continue;
    const glm::vec3 radiance = emissive.radiance(emitter, seen.barycentrics, seen.to_point);
    const LightCandidate light = {seen.to_point, seen.distance,
                                  radiance * (share / (seen.pdf * pick.probability)), 0.0f};
    if (tracer_of(world).occluded(
            shadow_ray(point.position_ws, point.geometric_normal_ws, light))) {
      continue;
    }
    sum += cosine * largest(light.perpendicular_irradiance);
    brightest_emitter = std::max(brightest_emitter, largest(radiance));
  }
  return sum;
}

PointLight light_at(const CountedEmitters& by, const LitPoint& point, RandomStream& random) {
  const World& world = by.world;
  PointLight light;
  light.irradiance =
      emitted_irradiance(by, point, kEmitterSamples, random, light.brightest_emitter);
  for (int r = 0; r < kRaysPerPoint; ++r) {
    const glm::vec3 direction =
        sample_cosine_about(point.geometric_normal_ws, next_uniform2(random));
    const Ray ray{offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f, direction};
    const Hit hit = tracer_of(world).closest_hit(ray);
    if (hit.missed() || leads_to_sky(world, ray)) {
      ++light.escaped;
      continue;
    }
    if (emissive_of(world).empty()) continue;
    const Surface surface = surface_at(world.scene(), ray, hit);
    const float albedo = largest(surface.reflectance.diffuse);
    light.irradiance += albedo *
                        emitted_irradiance(by, lit_point(surface), kBounceSamples, random,
                                           light.brightest_emitter) /
                        kRaysPerPoint;
  }
  return light;
}

/// A shadow ray from a point to one of the scene's lights, chosen at random: each of the lights is
/// as likely as all emissive surfaces together.
std::optional<Ray> ray_to_any_light(const World& world, const glm::vec3& from,
                                    RandomStream& random) {
  const std::vector<Light>& lights = world.scene().lights;
  const std::size_t sources = lights.size() + (emissive_of(world).empty() ? 0 : 1);
  const auto which = static_cast<std::size_t>(next_uniform(random) * static_cast<float>(sources));
  if (which < lights.size()) {
    const PunctualSample sample = sample_punctual(lights[which], from);
    if (sample.irradiance == glm::vec3(0.0f)) return std::nullopt;
    return Ray{from, 0.0f, sample.to_light, sample.distance};
  }
  const vec2 u = next_uniform2(random);
  const EmissiveSample emitter = emissive_of(world).sample({u.x, u.y, next_uniform(random)});
  const glm::vec3 way = emitter.position_ws - from;
  const float distance = glm::length(way);
  if (emitter.radiance == glm::vec3(0.0f) || distance <= 0.0f) return std::nullopt;
  return Ray{from, 0.0f, way / distance, distance * (1.0f - kShadowRayShortening)};
}

}  // namespace

SeenView sample_view(const World& world, const Camera& camera) {
  const std::vector<Ray> rays = frame_rays(camera, kAspect, kAcross, kUp);
  const std::vector<Hit> hits = trace(world, rays);
  SeenView view;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].missed()) continue;
    const Surface surface = surface_at(world.scene(), rays[i], hits[i]);
    view.points.push_back({lit_point(surface), largest(surface.emission),
                           is_unlit(material_of(world.scene(), hits[i].instance))});
  }
  ShadowRays towards_sky;
  towards_sky.trace(tracer_of(world), rays);
  std::size_t open = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    open += largest(towards_sky.share(i)) >= kMinClearTransmittance ? 1 : 0;
  }
  view.sky_share = static_cast<float>(open) / static_cast<float>(rays.size());
  return view;
}

ViewLight measure_view_light(const World& world, const SeenView& view) {
  const std::size_t count = view.points.size();
  const auto unlit = static_cast<float>(std::ranges::count(view.points, true, &SeenPoint::unlit));
  const CountedEmitters by{world, unlit >= kMostlyUnlit * static_cast<float>(count)};
  std::vector<PointLight> lights(count);
  parallel_chunks(count, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      RandomStream random = make_random_stream(static_cast<std::uint32_t>(i), 0, kLightSeed);
      lights[i] = light_at(by, view.points[i].point, random);
    }
  });

  std::vector<float> lit;
  std::size_t reflecting = 0, emitting = 0;
  float emitted = 0.0f;
  int open = 0;
  ViewLight light;
  for (std::size_t i = 0; i < count; ++i) {
    open += lights[i].escaped;
    light.brightest_emitter = std::max(light.brightest_emitter, lights[i].brightest_emitter);
    if (view.points[i].unlit && !by.unlit) continue;
    if (view.points[i].emission > 0.0f) {
      emitted += view.points[i].emission;
      ++emitting;
      continue;
    }
    ++reflecting;
    if (lights[i].irradiance > 0.0f) lit.push_back(lights[i].irradiance);
  }
  if (count > 0) {
    light.sky_visibility = static_cast<float>(open) / static_cast<float>(count * kRaysPerPoint);
  }
  if (!lit.empty()) {
    std::ranges::sort(lit);
    const float middle = lit[lit.size() / 2], ninth_decile = lit[lit.size() * 9 / 10];
    light.evenness = lit[lit.size() / 4] / ninth_decile;
    const float least = middle * kLitShare;
    const auto bright = std::count_if(lit.begin(), lit.end(), [&](float e) { return e >= least; });
    if (emitted > 0.0f) light.emitter_radiance = emitted / static_cast<float>(emitting);
    light.emission_ratio =
        emitted > 0.0f ? middle * kInvPi / light.emitter_radiance : kInfiniteDistance;
    light.lit_by_emission = static_cast<float>(bright) / static_cast<float>(reflecting);
  }
  return light;
}

float enclosure(const World& world, const Camera& camera) {
  const std::vector<std::uint8_t> closed =
      trace_occlusion(world, rays_around(glm::vec3(camera.world_from_view[3]), kSphereRays));
  return static_cast<float>(std::count(closed.begin(), closed.end(), 1)) / kSphereRays;
}

std::vector<std::uint8_t> find_lit(const World& world, std::span<const Ray> rays,
                                   std::span<const Hit> hits) {
  std::vector<std::uint8_t> lit(rays.size(), 0);
  if (world.scene().lights.empty() && emissive_of(world).empty()) return lit;
  std::vector<Ray> to_lights;
  std::vector<std::size_t> hit_of_ray;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].missed()) continue;
    RandomStream random = make_random_stream(static_cast<std::uint32_t>(i), 0, kLitViewSeed);
    const float distance = hits[i].distance * (1.0f - kShadowRayShortening);
    const auto ray = ray_to_any_light(world, rays[i].origin + distance * rays[i].direction, random);
    if (!ray) continue;
    to_lights.push_back(*ray);
    hit_of_ray.push_back(i);
  }
  const std::vector<std::uint8_t> shadowed = trace_occlusion(world, to_lights);
  for (std::size_t r = 0; r < to_lights.size(); ++r) lit[hit_of_ray[r]] = shadowed[r] == 0 ? 1 : 0;
  return lit;
}

}  // namespace lambent
