// SPDX-License-Identifier: Apache-2.0
// Based on: Dachsbacher and Stamminger, "Reflective Shadow Maps", I3D 2005, sec. 3.1. Maps are
// traced, not rasterised, so that any projection may be chosen: point lights have one octahedral
// map in place of six faces, without seams and with texels of more even solid angle.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/parallel.h"
#include "lambent/rsm.h"
#include "lambent/world.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "rsm/maps/map.h"
#include "rsm/maps/map_texel.h"
#include "rsm/maps/projection.h"
#include "rsm/to_records.h"
#include "scene/light_sampling.h"
#include "scene/validate.h"
#include "shared/color.h"

namespace lambent {
namespace {

using Kind = RsmProjection::Kind;

// Wider cones have octahedral maps, as the texels of a plane would be too uneven.
constexpr float kWidestPerspective = 1.04719755f;  // from the axis [rad], 60 degrees
// Narrower cones would leave no plane to map to.
constexpr float kNarrowestPerspective = 1e-3f;  // from the axis [rad]

// Number of orientations about the axis that are tried for the smallest orthographic map.
constexpr int kOrientations = 16;
// Margin of an orthographic map, as a share of the scene's size, so that walls seen edge-on are
// inside.
constexpr float kFrustumMargin = 1e-3f;

mat3 axes_along(const vec3& direction) {
  const Frame frame = make_frame(-direction);
  return {frame.tangent, frame.bitangent, frame.normal};
}

/// The orthographic map that contains all vertices of the scene, rotated for the smallest area.
RsmProjection fit_orthographic(const Scene& scene, const vec3& direction) {
  const mat3 axes = axes_along(direction);
  std::vector<vec3> points;
  for (const Instance& instance : scene.instances) {
    for (const vec3& position : scene.meshes[instance.mesh].positions) {
      points.push_back(vec3(instance.world_from_object * vec4(position, 1.0f)) * axes);
    }
  }
  RsmProjection best;
  best.kind = Kind::orthographic;
  best.world_from_light = axes;
  float best_area = std::numeric_limits<float>::max();
  for (int i = 0; i < kOrientations && !points.empty(); ++i) {
    // Orientations repeat after a quarter turn
    const float angle = 0.5f * kPi * static_cast<float>(i) / kOrientations;
    const float c = cos(angle), s = sin(angle);
    Bounds box;
    for (const vec3& p : points) box.add(vec3(c * p.x + s * p.y, c * p.y - s * p.x, p.z));
    const vec3 size = box.max - box.min, middle = 0.5f * (box.min + box.max);
    if (size.x * size.y >= best_area) continue;
    best_area = size.x * size.y;
    const mat3 turned(c * axes[0] + s * axes[1], c * axes[1] - s * axes[0], axes[2]);
    const float margin = kFrustumMargin * std::max({size.x, size.y, size.z});
    best.world_from_light = turned;
    best.half_extent = 0.5f * vec2(size.x, size.y) + vec2(margin);
    best.origin_ws = turned * vec3(middle.x, middle.y, box.max.z + margin);
  }
  return best;
}

Ray texel_ray(const MapProjection& p, const vec2& square) {
  const MapRay through = map_ray(p, square);
  Ray ray;
  ray.origin = through.origin_ws;
  ray.direction = through.direction_ws;
  return ray;
}

RsmTexel texel_of_light(const World& world, const Light& light, const Ray& ray, const Hit& hit,
                        float cross_section) {
  const Surface surface = surface_at(world.scene(), ray, hit);
  const PunctualSample sample = sample_punctual(light, surface.position_ws);
  return to_texel(lit_texel(surface.position_ws, surface.normal_ws, surface.geometric_normal_ws,
                            surface.reflectance, ray.direction, sample.irradiance, cross_section));
}

/// Traces one ray for each texel and calls shade(first texel, rays, hits) for each row.
template <class MakeRay, class Shade>
void trace_map(const World& world, ReflectiveShadowMap& map, MakeRay make_ray, Shade shade) {
  const auto resolution = static_cast<std::size_t>(map.resolution);
  map.texels.assign(resolution * resolution, {});
  parallel_chunks(resolution, 1, [&](std::size_t y, std::size_t) {
    std::vector<Ray> rays(resolution);
    std::vector<Hit> hits(resolution);
    for (std::size_t x = 0; x < resolution; ++x) {
      rays[x] = make_ray(texel_middle(static_cast<int>(x), static_cast<int>(y), map.resolution));
    }
    tracer_of(world).closest_hits(rays, hits);
    // Instances that cast no indirect light still shadow what is behind them
    for (Hit& hit : hits) {
      if (!hit.missed() && !world.scene().instances[hit.instance].casts_gi) hit = {};
    }
    shade(y * resolution, rays, hits);
  });
}

}  // namespace

Expected<void> check_map_request(const Camera& camera, float aspect, const RsmSettings& settings) {
  if (Expected<void> fine = check(settings); !fine) return fine;
  if (const char* flaw = flaw_of(camera)) return fail("", "camera", flaw);
  if (aspect > 0.0f && std::isfinite(aspect)) return {};
  return fail("", "aspect", "must be above 0");
}

RsmProjection fit_projection(const Scene& scene, const Light& light) {
  if (light.type == Light::Type::directional) return fit_orthographic(scene, light.direction_ws);
  RsmProjection projection;
  projection.origin_ws = light.position_ws;
  if (light.type == Light::Type::spot && light.outer_cone_angle <= kWidestPerspective) {
    projection.kind = Kind::perspective;
    projection.world_from_light = axes_along(light.direction_ws);
    projection.half_extent =
        vec2(std::tan(std::max(light.outer_cone_angle, kNarrowestPerspective)));
  }
  return projection;
}

RsmProjection camera_projection(const Camera& camera, float aspect) {
  RsmProjection p;
  p.kind = camera.orthographic ? Kind::orthographic : Kind::perspective;
  p.origin_ws = vec3(camera.world_from_view[3]);
  for (int i = 0; i < 3; ++i) p.world_from_light[i] = normalize(vec3(camera.world_from_view[i]));
  const float half_height =
      camera.orthographic ? 0.5f * camera.vertical_extent : std::tan(0.5f * camera.vertical_fov);
  p.half_extent = vec2(aspect * half_height, half_height);
  return p;
}

ShadeHitsSettings camera_shading(const RsmSettings& settings) {
  ShadeHitsSettings shading;
  shading.seed = settings.seed;
  return shading;
}

void render_rsm(const World& world, const Light& light, const RsmSettings& settings,
                ReflectiveShadowMap& map) {
  map.resolution = settings.resolution;
  map.projection = fit_projection(world.scene(), light);
  const MapProjection projection = to_record(map.projection);
  trace_map(
      world, map, [&](const vec2& square) { return texel_ray(projection, square); },
      [&](std::size_t first, const std::vector<Ray>& rays, const std::vector<Hit>& hits) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (hits[i].missed()) continue;
          const int x = static_cast<int>(i);
          const int y = static_cast<int>(first / rays.size());
          const float area = perpendicular_area(projection, texel_middle(x, y, map.resolution),
                                                map.resolution, hits[i].distance);
          if (area > 0.0f) {
            map.texels[first + i] = texel_of_light(world, light, rays[i], hits[i], area);
          }
        }
      });
}

void render_rsm(const World& world, const Camera& camera, float aspect, const RsmSettings& settings,
                ReflectiveShadowMap& map) {
  map.resolution = settings.resolution;
  map.projection = camera_projection(camera, aspect);
  const MapProjection projection = to_record(map.projection);
  const ShadeHitsSettings shading = camera_shading(settings);
  trace_map(
      world, map, [&](const vec2& square) { return texel_ray(projection, square); },
      [&](std::size_t first, const std::vector<Ray>& rays, const std::vector<Hit>& hits) {
        std::vector<ShadedHit> shaded(rays.size());
        ShadeHitsScratch scratch;
        shade_hits(world, rays, hits, shading, first, scratch, shaded);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (hits[i].missed()) continue;
          const Surface surface = surface_at(world.scene(), rays[i], hits[i]);
          const vec2 square = texel_middle(static_cast<int>(i),
                                           static_cast<int>(first / rays.size()), map.resolution);
          map.texels[first + i] = to_texel(
              seen_texel(surface.position_ws, surface.geometric_normal_ws, rays[i].direction,
                         shaded[i].surface.albedo_over_pi * shaded[i].direct_irradiance,
                         perpendicular_area(projection, square, map.resolution, hits[i].distance)));
        }
      });
}

void render_rsms(const World& world, const Camera& camera, float aspect,
                 const RsmSettings& settings, std::vector<ReflectiveShadowMap>& maps) {
  const std::vector<Light>& lights = world.scene().lights;
  maps.resize(settings.from_camera ? 1 : lights.size());
  if (settings.from_camera) return render_rsm(world, camera, aspect, settings, maps.front());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    render_rsm(world, lights[i], settings, maps[i]);
  }
}

Expected<ReflectiveShadowMap> render_rsm(const World& world, const Light& light,
                                         const RsmSettings& settings) {
  if (const auto fine = check(settings); !fine) return tl::unexpected(fine.error());
  if (const char* flaw = flaw_of(light)) return fail("", "light", flaw);
  ReflectiveShadowMap map;
  render_rsm(world, light, settings, map);
  return map;
}

Expected<ReflectiveShadowMap> render_rsm(const World& world, const Camera& camera, float aspect,
                                         const RsmSettings& settings) {
  const Expected<void> fine = check_map_request(camera, aspect, settings);
  if (!fine) return tl::unexpected(fine.error());
  ReflectiveShadowMap map;
  render_rsm(world, camera, aspect, settings, map);
  return map;
}

Expected<std::vector<ReflectiveShadowMap>> render_rsms(const World& world, const Camera& camera,
                                                       float aspect, const RsmSettings& settings) {
  const Expected<void> fine = check_map_request(camera, aspect, settings);
  if (!fine) return tl::unexpected(fine.error());
  std::vector<ReflectiveShadowMap> maps;
  render_rsms(world, camera, aspect, settings, maps);
  return maps;
}

Image flux_image(const ReflectiveShadowMap& map) {
  Image image(map.resolution, map.resolution, 3);
  float brightest = 0.0f;
  for (const RsmTexel& texel : map.texels) brightest = std::max(brightest, luminance(texel.flux));
  const float scale = brightest > 0.0f ? 1.0f / brightest : 0.0f;
  for (std::size_t i = 0; i < map.texels.size(); ++i) {
    for (int c = 0; c < 3; ++c) image.pixels[3 * i + c] = scale * map.texels[i].flux[c];
  }
  return image;
}

}  // namespace lambent
