// SPDX-License-Identifier: Apache-2.0
#include "compose/motion/motion.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface_math.h"
#include "raytracing/world_access.h"
#include "scene/attributes.h"

namespace lambent {
namespace {

// What motion.inl.h requires of its includer.
struct SceneBefore {
  const FrameBefore* frame;
};
using SceneBeforeRef = const SceneBefore&;

bool was_there(const SceneBefore& before, uint instance) {
  return before.frame->at_rest || before.frame->instances[instance].known;
}
mat4 transform_before(const SceneBefore& before, uint instance, const Instance& now) {
  return before.frame->at_rest ? now.world_from_object
                               : before.frame->instances[instance].world_from_object;
}
vec3 fetch_position_before(const SceneBefore& before, uint instance, const Mesh& now, uint vertex) {
  const bool bent =
      !before.frame->at_rest && before.frame->instances[instance].positions != nullptr;
  return bent ? (*before.frame->instances[instance].positions)[vertex] : now.positions[vertex];
}

#include "compose/motion/motion.inl.h"

/// Whether a hit's surface is blended. Such surfaces have no motion: rays go on behind them.
bool is_see_through(const Scene& scene, const Hit& hit) {
  const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
  return scene.materials[mesh.material].alpha_mode == AlphaMode::blend;
}

}  // namespace

MotionViews motion_views(const Camera& camera, int width, int height, const FrameBefore* before) {
  const CameraRecord now = camera_record(camera, width, height);
  if (before == nullptr) return {now, now, 0u};
  return {now, camera_record(before->camera, width, height), 1u};
}

bool has_see_through(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
    return material.alpha_mode == AlphaMode::blend;
  });
}

std::uint64_t find_motion(const FrameRequest& request, const Band& band, int sample,
                          const GBuffer& gbuffer, std::vector<PixelMotion>& motion) {
  const World& world = request.world;
  const Scene& scene = world.scene();
  const FrameSettings& settings = request.settings;
  const MotionViews views =
      motion_views(request.camera, settings.width, settings.height, request.before);
  const SceneBefore scene_before{request.before};
  const int width = settings.width;
  std::atomic<std::uint64_t> rays = 0;
  motion.resize(gbuffer.size());
  parallel_chunks(band.rows, 1, [&](std::size_t begin, std::size_t) {
    const int row = band.first_row + static_cast<int>(begin);
    for (int x = 0; x < width; ++x) {
      const std::size_t i = begin * width + x;
      Hit hit = gbuffer.hits[i];
      if (!hit.missed() && is_see_through(scene, hit)) {
        const vec2 at = sample_position(settings, x, row, sample, request.jitter());
        const CameraRay ray = camera_ray(views.now, at);
        hit = tracer_of(world).closest_hit(
            {ray.origin_ws, 0.0f, ray.direction_ws, kInfiniteDistance, kRayOfMotion});
        ++rays;
      }
      if (hit.missed()) {
        motion[i] = sky_motion(views, -gbuffer.to_viewer_ws[i]);
      } else if (is_see_through(scene, hit)) {
        // This build of Embree has no ray masks, so that no ray goes on behind the surface
        motion[i] = unknown_motion(infinity());
      } else {
        motion[i] = surface_motion(scene, scene_before, views, hit.instance, hit.triangle,
                                   hit.barycentrics);
      }
    }
  });
  return rays;
}

Layer motion_layer(int width, int height, std::span<const PixelMotion> motion) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  Layer layer{"motion", Image(width, height, 2)};
  float* out = layer.image.pixels.data();
  for (const PixelMotion& pixel : motion) {
    *out++ = pixel.known != 0u ? pixel.offset.x : kUnknown;
    *out++ = pixel.known != 0u ? pixel.offset.y : kUnknown;
  }
  return layer;
}

}  // namespace lambent
