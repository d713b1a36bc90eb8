// SPDX-License-Identifier: Apache-2.0
#include "compose/rsm_frame.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "rsm/upsample.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;

/// Traces the view through the middle of its pixels.
void trace_view(const World& world, const Camera& camera, int width, int height, RsmFrame& frame) {
  FrameSettings settings;
  settings.width = width;
  settings.height = height;
  GBuffer gbuffer;
  trace_gbuffer(world, camera, settings, {0, height}, 0, gbuffer);
  frame.positions_ws.assign(gbuffer.size(), vec3(0.0f));
  frame.normals_ws.assign(gbuffer.size(), vec3(0.0f));
  frame.depths.assign(gbuffer.size(), 0.0f);
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      const float depth = view_depth(camera, gbuffer.surfaces[i].position_ws);
      if (!(depth > 0.0f)) continue;
      frame.positions_ws[i] = gbuffer.surfaces[i].position_ws;
      frame.normals_ws[i] = gbuffer.surfaces[i].normal_ws;
      frame.depths[i] = depth;
    }
  });
}

/// An image fitted into a frame, its pixels enlarged or left out.
Layer fitted_layer(std::string name, const Image& image, int width, int height) {
  Layer layer{std::move(name), Image(width, height, 3)};
  const float scale = std::max(static_cast<float>(image.width) / static_cast<float>(width),
                               static_cast<float>(image.height) / static_cast<float>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int from_x = static_cast<int>((static_cast<float>(x) + 0.5f) * scale);
      const int from_y = static_cast<int>((static_cast<float>(y) + 0.5f) * scale);
      if (from_x >= image.width || from_y >= image.height) continue;
      std::copy_n(image.at(from_x, from_y), 3, layer.image.at(x, y));
    }
  }
  return layer;
}

/// The low-resolution picture, as upsampling fetches from it.
struct SmallPicture {
  explicit SmallPicture(const RsmFrame& seen) : frame(seen) {}

  vec3 fetch_position(int pixel) { return frame.positions_ws[pixel]; }
  vec3 fetch_normal(int pixel) { return frame.normals_ws[pixel]; }
  vec3 fetch_light(int pixel) { return frame.light.irradiance[pixel]; }

#include "rsm/upsample.inl.h"

  const RsmFrame& frame;
};

}  // namespace

RsmFrame light_by_rsm(const World& world, const Camera& camera, const FrameSettings& settings,
                      const RsmSettings& rsm, bool keep_stages) {
  RsmFrame frame;
  frame.downscale = rsm.downscale;
  frame.plane_tolerance = rsm.plane_tolerance;
  const int width = (settings.width + rsm.downscale - 1) / rsm.downscale;
  const int height = (settings.height + rsm.downscale - 1) / rsm.downscale;
  trace_view(world, camera, width, height, frame);
  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  const std::vector<ReflectiveShadowMap> maps = render_rsms(world, camera, aspect, rsm);
  const RsmView view{width, height, frame.positions_ws, frame.normals_ws, frame.depths};
  RsmGatherer().gather(world, maps, view, rsm, frame.light, keep_stages);
  if (keep_stages) {
    frame.layers = rsm_stage_layers(maps, frame.light, settings.width, settings.height);
  }
  return frame;
}

std::vector<Layer> rsm_stage_layers(std::span<const ReflectiveShadowMap> maps,
                                    const RsmIrradiance& light, int width, int height) {
  std::vector<Layer> layers;
  // Show the first map alone: more would not fit
  if (!maps.empty()) {
    layers.push_back(fitted_layer("rsm.flux", flux_image(maps.front()), width, height));
  }
  for (const Layer& stage : light.stages) {
    layers.push_back(fitted_layer(stage.name, stage.image, width, height));
  }
  return layers;
}

void look_up_rsm(const RsmFrame& frame, const GBuffer& gbuffer, const Camera& camera, int width,
                 const Band& band, std::vector<glm::vec3>& irradiance) {
  irradiance.assign(gbuffer.size(), vec3(0.0f));
  const float scale = 1.0f / static_cast<float>(frame.downscale);
  const ivec2 size(frame.light.width, frame.light.height);
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    SmallPicture small(frame);
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      const auto x = static_cast<float>(i % static_cast<std::size_t>(width));
      const auto y = static_cast<float>(i / static_cast<std::size_t>(width)) +
                     static_cast<float>(band.first_row);
      const Surface& surface = gbuffer.surfaces[i];
      const float depth = view_depth(camera, surface.position_ws);
      irradiance[i] =
          small.upsample_light(size, place_in_small_picture({x, y}, scale), surface.position_ws,
                               surface.normal_ws, 1.0f / (frame.plane_tolerance * depth));
    }
  });
}

}  // namespace lambent
