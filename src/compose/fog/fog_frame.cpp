// SPDX-License-Identifier: Apache-2.0
#include "compose/fog/fog_frame.h"

#include "compose/frame_tasks.h"
#include "core/parallel.h"
#include "raytracing/camera_rays.h"

namespace lambent {
namespace {}  // namespace

FogRequest fog_request(const FrameRequest& request) {
  const FrameSettings& settings = request.settings;
  const Band rows = traced_rows(request);
  FogRequest fog{request.world, request.sources.field, settings.fog};
  fog.camera = camera_record(request.camera, settings.width, settings.height);
  fog.width = settings.width;
  fog.height = settings.height;
  fog.first_row = rows.first_row;
  fog.rows = rows.rows;
  fog.frame = request.first_sample;
  fog.seed = settings.seed;
  fog.averaged_frames = settings.averaged_frames;
  return fog;
}

void find_fog(const FrameRequest& request, const FroxelFog& fog, const Band& band, int sample,
              const GBuffer& gbuffer, std::vector<glm::vec4>& light) {
  const FrameSettings& settings = request.settings;
  light.resize(gbuffer.size());
  parallel_chunks(gbuffer.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int x = static_cast<int>(i % settings.width);
      const int y = band.first_row + static_cast<int>(i / settings.width);
      const glm::vec2 pixel = sample_position(settings, x, y, sample, request.jitter());
      const CameraRay ray = camera_ray(fog.grid().camera, pixel);
      light[i] = fog.along(pixel, ray.origin_ws, ray.direction_ws, gbuffer.hits[i].distance);
    }
  });
}

}  // namespace lambent
