// SPDX-License-Identifier: Apache-2.0
#include "first_picture/survey.h"

#include <algorithm>
#include <cmath>

#include "raytracing/trace_rays.h"
#include "raytracing/world_access.h"
#include "shared/random.h"
#include "shared/rays.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Seeds of the two random sequences: arbitrary, but fixed.
constexpr std::uint32_t kSurfaceSeed = 1;
constexpr std::uint32_t kSpaceSeed = 2;

// Number of places that are tested in a box.
constexpr int kPlaces = 448;
// Number of directions around each, slightly above the horizon, so that low furniture does not
// count.
constexpr int kWaysAround = 8;
constexpr float kRise = 0.15f;  // [rad]
// Number of directions that must end at a surface for a place to be enclosed: all but one.
constexpr int kMinClosedWays = kWaysAround - 1;
// The same for a sheltered place: in an opening, three directions are free.
constexpr int kMinShelteredWays = 5;
// Least share of rays that hit fronts: inside solid matter, rays hit backs. As winding may be
// wrong, a place is solid only where most rays hit backs; two-sided surfaces do not count.
constexpr float kMinFrontShare = 0.35f;

/// Running sums of the areas of a mesh's triangles in object space.
std::vector<float> cumulative_areas(const Mesh& mesh) {
  std::vector<float> sums;
  sums.reserve(mesh.triangles.size());
  float sum = 0.0f;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3& a = mesh.positions[t.x];
    const float area =
        0.5f * glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
    if (std::isfinite(area)) sum += area;
    sums.push_back(sum);
  }
  return sums;
}

/// Factor by which an instance scales areas, on average over directions.
float area_scale(const Instance& instance) {
  const glm::mat3 m(instance.world_from_object);
  const float squared = (glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2])) / 3.0f;
  return squared;
}

/// The index of the interval of `sums` that holds `u` (0 to 1) times their total.
std::size_t pick(std::span<const float> sums, float u) {
  const auto at = std::upper_bound(sums.begin(), sums.end(), u * sums.back());
  return std::min(static_cast<std::size_t>(at - sums.begin()), sums.size() - 1);
}

bool has_two_sides(const Scene& scene, const Hit& hit) {
  return scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material].double_sided;
}

}  // namespace

bool shows_back(const Scene& scene, const Hit& hit) {
  return !hit.front_face && !has_two_sides(scene, hit);
}

glm::vec3 direction_from_angles(float azimuth, float elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

std::vector<Ray> rays_around(const glm::vec3& place_ws, int count, float reach) {
  std::vector<Ray> rays;
  rays.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    rays.push_back({place_ws, 0.0f,
                    spherical_fibonacci(static_cast<uint>(i), static_cast<uint>(count)), reach});
  }
  return rays;
}

std::vector<Ray> frame_rays(const Camera& camera, float aspect, int across, int up) {
  const float half_up =
      camera.orthographic ? 0.5f * camera.vertical_extent : std::tan(0.5f * camera.vertical_fov);
  const glm::mat3 axes(camera.world_from_view);
  const glm::vec3 eye(camera.world_from_view[3]);
  std::vector<Ray> rays;
  for (int y = 0; y < up; ++y) {
    for (int x = 0; x < across; ++x) {
      const glm::vec2 place = 2.0f * (glm::vec2(x, y) + 0.5f) / glm::vec2(across, up) - 1.0f;
      const glm::vec2 at(place.x * half_up * aspect, place.y * half_up);
      if (camera.orthographic) {
        rays.push_back({eye + axes * glm::vec3(at, 0.0f), 0.0f, -axes[2]});
      } else {
        rays.push_back({eye, 0.0f, glm::normalize(axes * glm::vec3(at, -1.0f))});
      }
    }
  }
  return rays;
}

std::vector<SurfaceSample> sample_surfaces(const Scene& scene,
                                           std::span<const std::uint32_t> instances, int count) {
  // Sum up areas over the triangles of each mesh, and over instances
  std::vector<std::vector<float>> areas(scene.meshes.size());
  std::vector<std::uint32_t> with_area;
  std::vector<float> instance_sums;
  float sum = 0.0f;
  for (const std::uint32_t i : instances) {
    const int mesh = scene.instances[i].mesh;
    if (scene.meshes[mesh].triangles.empty()) continue;
    if (areas[mesh].empty()) areas[mesh] = cumulative_areas(scene.meshes[mesh]);
    const float area = areas[mesh].back() * area_scale(scene.instances[i]);
    if (!(area > 0.0f) || !std::isfinite(sum + area)) continue;
    sum += area;
    with_area.push_back(i);
    instance_sums.push_back(sum);
  }
  std::vector<SurfaceSample> points;
  if (with_area.empty()) return points;

  points.reserve(count);
  for (int i = 0; i < count; ++i) {
    RandomStream random = make_random_stream(i, 0, kSurfaceSeed);
    const float u = next_uniform(random);
    const bool by_area = i % 2 == 0;
    const std::size_t which =
        by_area ? pick(instance_sums, u)
                : std::min(static_cast<std::size_t>(u * static_cast<float>(with_area.size())),
                           with_area.size() - 1);
    const Instance& instance = scene.instances[with_area[which]];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::uvec3 t = mesh.triangles[pick(areas[instance.mesh], next_uniform(random))];
    const vec2 weights = sample_uniform_triangle(next_uniform2(random));
    const auto vertex = [&](std::uint32_t v) {
      return glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[v], 1.0f));
    };
    const glm::vec3 a = vertex(t.x), ab = vertex(t.y) - a, ac = vertex(t.z) - a;
    const glm::vec3 normal = glm::cross(ab, ac);
    const float length = glm::length(normal);
    if (!(length > 0.0f)) continue;
    const float side =
        glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f ? -1.0f : 1.0f;
    points.push_back(
        {a + weights.x * ab + weights.y * ac, normal * (side / length), with_area[which]});
  }
  return points;
}

bool leads_to_sky(const World& world, const Ray& ray) {
  if (!tracer_of(world).dims_shadows()) return false;
  glm::vec3 share;
  tracer_of(world).transmittances({&ray, 1}, {&share, 1});
  return is_clear(share);
}

float median_height(std::span<const OpenPlace> places) {
  std::vector<float> heights(places.size());
  std::ranges::transform(places, heights.begin(), height_of);
  const auto median = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::ranges::nth_element(heights, median);
  return *median;
}

SpaceSurvey survey_space(const World& world, const Bounds& bounds, SurveyedPlaces which) {
  // Trace rays around, up and down from random places
  constexpr int kRays = kWaysAround + 2;
  std::vector<Ray> rays;
  rays.reserve(static_cast<std::size_t>(kPlaces) * kRays);
  RandomStream random = make_random_stream(0, 0, kSpaceSeed);
  for (int i = 0; i < kPlaces; ++i) {
    const vec2 xy = next_uniform2(random);
    const glm::vec3 u(xy.x, xy.y, next_uniform(random));
    const glm::vec3 place = bounds.min + u * (bounds.max - bounds.min);
    const float turn = next_uniform(random);
    for (int w = 0; w < kWaysAround; ++w) {
      const float azimuth = kTwoPi * (static_cast<float>(w) + turn) / kWaysAround;
      rays.push_back({place, 0.0f, direction_from_angles(azimuth, kRise)});
    }
    rays.push_back({place, 0.0f, {0.0f, -1.0f, 0.0f}});
    rays.push_back({place, 0.0f, {0.0f, 1.0f, 0.0f}});
  }
  const std::vector<Hit> hits = trace(world, rays);

  SpaceSurvey survey;
  float two_sided_sum = 0.0f;
  for (int i = 0; i < kPlaces; ++i) {
    const Hit* around = &hits[static_cast<std::size_t>(i) * kRays];
    const Hit& down = around[kWaysAround];
    const Hit& up = around[kWaysAround + 1];
    const auto met =
        std::count_if(around, around + kRays, [](const Hit& h) { return !h.missed(); });
    const auto two_sided = std::count_if(around, around + kRays, [&](const Hit& h) {
      return !h.missed() && has_two_sides(world.scene(), h);
    });
    const auto fronts = std::count_if(around, around + kRays, [&](const Hit& h) {
      return !h.missed() && h.front_face && !has_two_sides(world.scene(), h);
    });
    const auto closed =
        std::count_if(around, around + kWaysAround, [](const Hit& h) { return !h.missed(); });
    const bool indoors = which == SurveyedPlaces::below_roofs;
    if (closed < (indoors ? kMinClosedWays : kMinShelteredWays) || down.missed()) continue;
    if (indoors && up.missed()) continue;
    const auto one_sided = static_cast<float>(met - two_sided);
    if (static_cast<float>(fronts) < kMinFrontShare * one_sided) continue;
    const glm::vec3& place = rays[static_cast<std::size_t>(i) * kRays].origin;
    const Ray& upwards = rays[static_cast<std::size_t>(i) * kRays + kWaysAround + 1];
    const OpenPlace open{place, place.y - down.distance,
                         up.missed() ? bounds.max.y : place.y + up.distance, up.missed(),
                         up.missed() || leads_to_sky(world, upwards)};
    survey.sheltered.push_back(open);
    if (closed < kMinClosedWays) continue;
    survey.enclosed.push_back(open);
    two_sided_sum += static_cast<float>(two_sided) / static_cast<float>(met);
  }
  const auto enclosed = static_cast<float>(survey.enclosed.size());
  survey.enclosed_share = enclosed / kPlaces;
  if (enclosed > 0.0f) survey.two_sided_share = two_sided_sum / enclosed;
  return survey;
}

}  // namespace lambent
