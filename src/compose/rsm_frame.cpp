// SPDX-License-Identifier: Apache-2.0
#include "compose/rsm_frame.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "rsm/maps/map.h"
#include "rsm/upsample.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;

/// Traces the view through the middle of its pixels.
void trace_view(const World& world, const Camera& camera, int width, int height, RsmFrame& frame) {
  FrameSettings settings;
  settings.width = width;
  settings.height = height;
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  frame.positions_ws.assign(pixels, vec3(0.0f));
  frame.normals_ws.assign(pixels, vec3(0.0f));
  frame.depths.assign(pixels, 0.0f);
  const int band_rows = rows_of_a_band(width);
  for (int row = 0; row < height; row += band_rows) {
    GBuffer& gbuffer = frame.gbuffer;
    trace_gbuffer(world, camera, settings, {row, std::min(band_rows, height - row)}, 0, gbuffer);
    const std::size_t first = static_cast<std::size_t>(row) * width;
    parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (gbuffer.hit[i] == 0) continue;
        const float depth = view_depth(camera, gbuffer.surfaces[i].position_ws);
        if (!(depth > 0.0f)) continue;
        frame.positions_ws[first + i] = gbuffer.surfaces[i].position_ws;
        frame.normals_ws[first + i] = gbuffer.surfaces[i].normal_ws;
        frame.depths[first + i] = depth;
      }
    });
  }
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

void light_by_rsm(const FrameRequest& request, RsmFrame& frame) {
  const FrameSettings& settings = request.settings;
  const RsmSettings& rsm = *request.sources.rsm;
  frame.downscale = rsm.downscale;
  frame.plane_tolerance = rsm.plane_tolerance;
  const int width = (settings.width + rsm.downscale - 1) / rsm.downscale;
  const int height = (settings.height + rsm.downscale - 1) / rsm.downscale;
  trace_view(request.world, request.camera, width, height, frame);
  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  render_rsms(request.world, request.camera, aspect, rsm, frame.maps);
  const RsmView view{width, height, frame.positions_ws, frame.normals_ws, frame.depths};
  const bool keep_stages = request.sources.rsm_stages;
  [[maybe_unused]] const Expected<void> done =
      frame.gatherer.gather(request.world, frame.maps, view, rsm, frame.light, keep_stages);
  assert(done);  // settings were checked, and the view is whole
  frame.layers.clear();
  if (keep_stages) {
    frame.layers = rsm_stage_layers(frame.maps, frame.light, settings.width, settings.height);
  }
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
