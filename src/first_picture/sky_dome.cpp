// SPDX-License-Identifier: Apache-2.0
// Skies that scenes bring as meshes.
#include "first_picture/sky_dome.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "first_picture/daylight.h"
#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "lambent/first_picture.h"
#include "raytracing/boxes.h"
#include "raytracing/surface.h"
#include "raytracing/trace_rays.h"
#include "raytracing/world_access.h"
#include "scene/attributes.h"
#include "scene/latitude_longitude.h"
#include "shared/color.h"

namespace lambent {
namespace {

// Number of directions from the middle of the scene in which a dome is looked for. It need not
// reach down to the horizon, which the ground may hide: directions with a smaller sine of their
// elevation than this do not count.
constexpr int kDomeRays = 128;
constexpr float kMinSineOfElevation = 0.2f;
// Share of them in which it must emit: it may have small gaps, and black spots. What reflects
// nothing need only be there, from kSkyDistance on: a sky of stars is mostly black.
constexpr float kMinDome = 0.95f;
// Its distance from the middle of the scene is at least so many times that within which half of the
// scene's triangles are, or kSkyDistance: where a dome is nearer, its light differs from place to
// place.
constexpr float kMinDistance = 5.0f;
// From this distance on [m], it is a sky whatever it surrounds, such as a terrain that reaches far
// towards it: no lamp is so large.
constexpr float kSkyDistance = 100.0f;
// A dome's diagonal is at least this share of the scene's, which the ground below may exceed.
constexpr float kMinSize = 0.2f;
// Columns of the map: as many as the dome's texture has, within these. The edge of half a dome
// needs some; more than the upper limit would take longer than the rest of a picture.
constexpr int kMinColumns = 256, kMaxColumns = 4096;

// Largest channel of colours without a unit [W/(m^2 sr)]: white, and what rounding adds to it.
constexpr float kMaxColor = 1.01f;
// A sky is a day's if a level white surface has at least this luminance in its light. White being
// 1, photographs show a clear sky about as mid-grey, 0.18, and painters brighter; a blue hour has
// less than 0.05.
constexpr float kMinDayLuminance = 0.1f;
// It is clear if that surface is at least so many times as blue as red. In the light of
// make_day_sky it is 3 times as blue, in that of a blue sky half full of white clouds 1.55, and
// in that of an overcast one 1 to 1.35.
constexpr float kMinClearBlueness = 1.5f;
// Of the sky below the first sine of elevation (20 degrees), the light is at least as blue as red
// by day, with hills in it, too. That of a dawn or a dusk is red.
constexpr float kLowSky = 0.342f, kMinLowBlueness = 1.0f;

/// Whether a surface may be a sky: it emits, nothing can be seen through it, and it does not move.
bool may_be_sky(const Scene& scene, const Instance& instance) {
  const Material& material = scene.materials[scene.meshes[instance.mesh].material];
  return may_emit(material) && material.alpha_mode == AlphaMode::opaque &&
         material.transmission == 0.0f && !instance.dynamic;
}

const TextureView& emission_view(const Material& material) {
  return material.unlit ? material.base_color_texture : material.emission_texture;
}

/// Copies an instance into a scene that holds what it emits and nothing else.
void copy_emission(const Scene& scene, const Instance& instance, Scene& dome) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  const Material& source = scene.materials[mesh.material];
  Material material;
  material.unlit = source.unlit;
  material.base_color = source.base_color;
  material.emission = source.emission;
  TextureView view = emission_view(source);
  if (view.texture >= 0) {
    dome.textures.push_back(scene.textures[view.texture]);
    view.texture = static_cast<int>(dome.textures.size()) - 1;
  }
  (material.unlit ? material.base_color_texture : material.emission_texture) = view;
  dome.materials.push_back(material);
  dome.meshes.push_back(mesh);
  dome.meshes.back().material = static_cast<int>(dome.materials.size()) - 1;
  dome.instances.push_back(instance);
  dome.instances.back().mesh = static_cast<int>(dome.meshes.size()) - 1;
}

glm::vec3 emission_at(const World& dome, const Ray& ray, const Hit& hit) {
  return hit.missed() ? glm::vec3(0.0f) : surface_at(dome.scene(), ray, hit).emission;
}

/// Whether the dome is in nearly all directions above the horizon, far away.
bool covers_sky(const World& dome, const Middle& middle) {
  std::vector<Ray> rays = rays_around(middle.position_ws, kDomeRays);
  std::erase_if(rays, [](const Ray& ray) { return ray.direction.y < kMinSineOfElevation; });
  const std::vector<Hit> hits = trace(dome, rays);
  const float least = std::min(kMinDistance * middle.reach, kSkyDistance);
  const Material& material = dome.scene().materials.front();
  const bool is_black = material.unlit || glm::vec3(material.base_color) == glm::vec3(0.0f);
  float covered = 0.0f;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].distance < least) return false;
    const bool there = is_black && !hits[i].missed() && hits[i].distance >= kSkyDistance;
    if (there || emission_at(dome, rays[i], hits[i]) != glm::vec3(0.0f)) covered += 1.0f;
  }
  return covered >= kMinDome * static_cast<float>(rays.size());
}

/// Factor on what an unlit dome emits: its colours have no unit, so that beside a sun they are
/// taken for those of a sky that suits it.
float unlit_factor(const Scene& dome) {
  if (!dome.materials.front().unlit) return 1.0f;
  return std::max(1.0f, sun_ratio(dome) * kDaySkyLuminance);
}

int columns_for(const Scene& dome) {
  int columns = kMinColumns;
  for (const Texture& texture : dome.textures) {
    columns = std::max(columns, texture.levels.front().width);
  }
  return std::min(columns, kMaxColumns);
}

}  // namespace

std::optional<float> clear_day_luminance(const Environment& sky) {
  // Sum what a level surface receives of the sky near the horizon, and above that
  glm::dvec3 low(0.0), high(0.0);
  double weights = 0.0;
  for (int y = 0; y < sky.map.height / 2; ++y) {
    const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(sky.map.height);
    const float up = direction_from_latitude_longitude({0.0f, v}, 0.0f).y;
    glm::dvec3 row(0.0);
    for (int x = 0; x < sky.map.width; ++x) {
      const float* texel = sky.map.at(x, y);
      const glm::vec3 radiance = sky.radiance * glm::vec3(texel[0], texel[1], texel[2]);
      if (std::max({radiance.x, radiance.y, radiance.z}) > kMaxColor) return std::nullopt;
      row += radiance;
    }
    // The cosine, and the solid angle of the row's texels but for a constant
    const double weight = up * std::sqrt(1.0f - up * up);
    (up < kLowSky ? low : high) += weight * row;
    weights += weight * sky.map.width;
  }
  if (weights == 0.0) return std::nullopt;
  const glm::vec3 mean((low + high) / weights);
  const bool is_clear = mean.z >= kMinClearBlueness * mean.x && low.z >= kMinLowBlueness * low.x;
  if (!is_clear || luminance(mean) < kMinDayLuminance) return std::nullopt;
  return luminance(mean);
}

std::optional<Scene> take_sky_dome(Scene& scene) {
  // Most scenes have no such surface, and bounds take long where scenes are large
  const bool any = std::any_of(scene.instances.begin(), scene.instances.end(),
                               [&](const Instance& each) { return may_be_sky(scene, each); });
  if (!any) return std::nullopt;
  std::vector<Bounds> boxes;
  boxes.reserve(scene.instances.size());
  Bounds all;
  for (const Instance& instance : scene.instances) {
    boxes.push_back(instance_bounds(scene, instance));
    if (boxes.back().empty()) continue;
    all.add(boxes.back());
  }
  std::vector<std::uint32_t> candidates, rest;
  bool any_lit = false;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].empty()) continue;
    const bool large = diagonal(boxes[i]) >= kMinSize * diagonal(all);
    (large && may_be_sky(scene, scene.instances[i]) ? candidates : rest).push_back(i);
  }
  for (const std::uint32_t i : rest) {
    any_lit |= !scene.materials[scene.meshes[scene.instances[i].mesh].material].unlit;
  }
  if (candidates.empty() || !any_lit) return std::nullopt;

  const Middle middle = find_middle(scene, boxes, rest);
  Scene taken;
  std::vector<std::uint32_t> domes;
  for (const std::uint32_t i : candidates) {
    if (!contains(boxes[i], middle.position_ws)) continue;
    Scene dome;
    copy_emission(scene, scene.instances[i], dome);
    if (!covers_sky(World(dome), middle)) continue;
    copy_emission(scene, scene.instances[i], taken);
    domes.push_back(i);
  }
  if (domes.empty()) return std::nullopt;
  taken.lights = scene.lights;
  Mesh nothing;
  nothing.material = scene.meshes[scene.instances[domes.front()].mesh].material;
  scene.meshes.push_back(std::move(nothing));
  for (const std::uint32_t i : domes) {
    scene.instances[i].mesh = static_cast<int>(scene.meshes.size()) - 1;
  }
  return taken;
}

Environment sky_of_dome(const Scene& dome, const glm::vec3& eye_ws) {
  const World world(dome);
  const int columns = columns_for(dome), rows = columns / 2;
  Environment sky;
  sky.radiance = glm::vec3(unlit_factor(dome));
  sky.map = Image(columns, rows, 3);
  parallel_chunks(static_cast<std::size_t>(rows), 1, [&](std::size_t row, std::size_t) {
    const int y = static_cast<int>(row);
    std::vector<Ray> rays;
    rays.reserve(columns);
    for (int x = 0; x < columns; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(columns),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(rows));
      rays.push_back({eye_ws, 0.0f, direction_from_latitude_longitude(uv, 0.0f)});
    }
    std::vector<Hit> hits(rays.size());
    tracer_of(world).closest_hits(rays, hits);
    for (int x = 0; x < columns; ++x) {
      const glm::vec3 radiance = emission_at(world, rays[x], hits[x]);
      for (int c = 0; c < 3; ++c) sky.map.at(x, y)[c] = radiance[c];
    }
  });
  return sky;
}

}  // namespace lambent
