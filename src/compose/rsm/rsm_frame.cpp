// SPDX-License-Identifier: Apache-2.0
#include "compose/rsm/rsm_frame.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "compose/frame_tasks.h"
#include "compose/rsm/replace_light.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "raytracing/camera_rays.h"
#include "rsm/maps/map.h"
#include "rsm/upsample.h"
#include "shared/demodulate.h"

namespace lambent {
namespace {

/// Traces the small view through the middle of its pixels.
void trace_view(const World& world, const Camera& camera, const RsmSettings& rsm, int width,
                int height, RsmFrame& frame) {
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
    const Band band{row, std::min(band_rows, height - row)};
    trace_gbuffer(world, camera, settings, band, 0, gbuffer);
    if (rsm.direct) {
      Stopwatch watch;
      frame.direct_rays += shade_direct_view(world, rsm, gbuffer, band, width, frame.direct);
      frame.direct_ms += watch.lap();
    }
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

/// An image scaled to a frame's size by repeating or skipping pixels.
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

/// The small view, as upsampling reads it.
struct SmallPicture {
  explicit SmallPicture(const RsmFrame& seen) : frame(seen) {}

  vec3 fetch_position(int pixel) { return frame.positions_ws[pixel]; }
  vec3 fetch_normal(int pixel) { return frame.normals_ws[pixel]; }
  vec3 fetch_light(int pixel) { return frame.light.irradiance[pixel]; }

#include "rsm/upsample.inl.h"

  const RsmFrame& frame;
};

/// The small view's direct light, as upsampling reads it.
struct DirectPicture {
  explicit DirectPicture(const RsmFrame& seen) : frame(seen) {}

  vec3 fetch_position(int pixel) { return frame.positions_ws[pixel]; }
  vec3 fetch_normal(int pixel) { return frame.normals_ws[pixel]; }
  ReflectedPair fetch_direct(int pixel) { return frame.direct.direct[pixel]; }

#include "rsm/direct_upsample.inl.h"

  const RsmFrame& frame;
};

/// The first of the maps; without texels where there is none.
ReflectiveShadowMap first_map(const FrameRequest& request, float aspect) {
  const RsmSettings& rsm = *request.sources.rsm;
  const std::vector<Light>& lights = request.world.scene().lights;
  ReflectiveShadowMap map;
  if (rsm.from_camera) {
    render_rsm(request.world, request.camera, aspect, rsm, map);
  } else if (!lights.empty()) {
    render_rsm(request.world, lights.front(), rsm, map);
  }
  return map;
}

/// Calls body(pixel, place, surface, inverse_tolerance) for pixels of a band that show a surface:
/// their place in the small view, and the plane tolerance with which upsampling there tells
/// surfaces apart.
template <class Body>
void for_each_sample(const RsmFrame& frame, const GBuffer& gbuffer, const Camera& camera, int width,
                     const Band& band, Body body) {
  const float scale = 1.0f / static_cast<float>(frame.downscale);
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      const auto x = static_cast<float>(i % static_cast<std::size_t>(width));
      const auto y = static_cast<float>(i / static_cast<std::size_t>(width)) +
                     static_cast<float>(band.first_row);
      const Surface& surface = gbuffer.surfaces[i];
      const float depth = view_depth(camera, surface.position_ws);
      body(i, place_in_small_picture({x, y}, scale), surface,
           1.0f / (frame.plane_tolerance * depth));
    }
  });
}

}  // namespace

void light_by_rsm(const FrameRequest& request, RsmFrame& frame) {
  const FrameSettings& settings = request.settings;
  const RsmSettings& rsm = *request.sources.rsm;
  frame.downscale = rsm.downscale;
  frame.plane_tolerance = rsm.plane_tolerance;
  const int width = (settings.width + rsm.downscale - 1) / rsm.downscale;
  const int height = (settings.height + rsm.downscale - 1) / rsm.downscale;
  frame.direct_rays = 0;
  frame.direct_ms = 0.0;
  if (rsm.direct) {
    start_direct_view(request.world, rsm, static_cast<std::size_t>(width) * height, frame.direct);
  }
  trace_view(request.world, request.camera, rsm, width, height, frame);
  const RsmView view{width, height, frame.positions_ws, frame.normals_ws, frame.depths};
  if (rsm.direct) {
    Stopwatch watch;
    finish_direct_view(view, rsm, frame.direct);
    frame.direct_ms += watch.lap();
  }
  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  const bool keep_stages = request.sources.rsm_stages;
  [[maybe_unused]] const Expected<void> done = frame.gatherer.gather(
      request.world, request.camera, aspect, view, rsm, frame.light, keep_stages);
  assert(done);  // settings were checked, and the view is whole
  frame.light.rays += frame.direct_rays;
  if (rsm.direct) frame.light.passes.push_back({"rsm.direct", frame.direct_ms});
  frame.layers.clear();
  if (keep_stages) {
    const ReflectiveShadowMap first = first_map(request, aspect);
    frame.layers = rsm_stage_layers(first.texels.empty() ? nullptr : &first, frame.light,
                                    settings.width, settings.height);
  }
}

std::vector<Layer> rsm_stage_layers(const ReflectiveShadowMap* first_map,
                                    const RsmIrradiance& light, int width, int height) {
  std::vector<Layer> layers;
  // Include the first map alone, as more would not fit
  if (first_map != nullptr) {
    layers.push_back(fitted_layer("rsm.flux", flux_image(*first_map), width, height));
  }
  for (const Layer& stage : light.stages) {
    layers.push_back(fitted_layer(stage.name, stage.image, width, height));
  }
  return layers;
}

void look_up_rsm(const RsmFrame& frame, const GBuffer& gbuffer, const Camera& camera, int width,
                 const Band& band, std::vector<glm::vec3>& irradiance) {
  irradiance.assign(gbuffer.size(), vec3(0.0f));
  const ivec2 size(frame.light.width, frame.light.height);
  for_each_sample(frame, gbuffer, camera, width, band,
                  [&](std::size_t i, const vec2& place, const Surface& surface, float tolerance) {
                    irradiance[i] = SmallPicture(frame).upsample_light(
                        size, place, surface.position_ws, surface.normal_ws, tolerance);
                  });
}

void replace_light(const std::vector<vec3>& subtracted_field, const std::vector<vec3>& added,
                   std::vector<vec3>& irradiance) {
  irradiance.resize(added.size(), vec3(0.0f));
  parallel_chunks(irradiance.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      irradiance[i] = replaced_light(irradiance[i], added[i],
                                     subtracted_field.empty() ? vec3(0.0f) : subtracted_field[i]);
    }
  });
}

void add_rsm_direct(const RsmFrame& frame, const GBuffer& gbuffer, const Camera& camera, int width,
                    const Band& band, ReflectedLight& light) {
  const ivec2 size(frame.light.width, frame.light.height);
  for_each_sample(frame, gbuffer, camera, width, band,
                  [&](std::size_t i, const vec2& place, const Surface& surface, float tolerance) {
                    const ReflectedPair pair = DirectPicture(frame).upsample_direct(
                        size, place, surface.position_ws, surface.normal_ws, tolerance);
                    light.diffuse[i] += pair.diffuse * filtered_albedo(surface.reflectance);
                    light.specular[i] += pair.specular;
                  });
}

}  // namespace lambent
