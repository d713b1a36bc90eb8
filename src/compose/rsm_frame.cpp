// SPDX-License-Identifier: Apache-2.0
#include "compose/rsm_frame.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "shared/cross_bilateral.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;

// Weight of a pixel that bilinear interpolation does not ask, beside one that it does: it decides
// where those show other surfaces.
constexpr float kFarWeight = 1e-3f;
// Sum of weights below which no pixel shows the surface.
constexpr float kLeastWeight = 1e-9f;

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

/// A pixel of the low-resolution picture that a surface may take light from.
struct Tap {
  std::size_t pixel;
  float nearness;
};

/// The 3 x 3 pixels around a place of the low-resolution picture; returns how many are in it.
int taps_around(const RsmFrame& frame, float u, float v, Tap (&taps)[9]) {
  int count = 0;
  const int middle_x = static_cast<int>(std::lround(u)),
            middle_y = static_cast<int>(std::lround(v));
  for (int y = middle_y - 1; y <= middle_y + 1; ++y) {
    for (int x = middle_x - 1; x <= middle_x + 1; ++x) {
      if (x < 0 || y < 0 || x >= frame.light.width || y >= frame.light.height) continue;
      const float near_x = std::max(kFarWeight, 1.0f - std::abs(u - static_cast<float>(x)));
      const float near_y = std::max(kFarWeight, 1.0f - std::abs(v - static_cast<float>(y)));
      taps[count++] = {static_cast<std::size_t>(y) * frame.light.width + x, near_x * near_y};
    }
  }
  return count;
}

vec3 upsampled(const RsmFrame& frame, const Surface& surface, float depth, float u, float v) {
  Tap taps[9];
  const int count = taps_around(frame, u, v, taps);
  const float inverse_tolerance = 1.0f / (frame.plane_tolerance * depth);
  vec3 sum(0.0f), any(0.0f);
  float weights = 0.0f, any_weights = 0.0f;
  for (int k = 0; k < count; ++k) {
    const std::size_t i = taps[k].pixel;
    if (frame.normals_ws[i] == vec3(0.0f)) continue;
    const vec3& light = frame.light.irradiance[i];
    const float weight =
        taps[k].nearness * cross_bilateral_weight(surface.position_ws - frame.positions_ws[i],
                                                  surface.normal_ws, frame.normals_ws[i],
                                                  inverse_tolerance);
    sum += weight * light;
    weights += weight;
    any += taps[k].nearness * light;
    any_weights += taps[k].nearness;
  }
  if (weights > kLeastWeight) return sum / weights;
  return any_weights > 0.0f ? any / any_weights : vec3(0.0f);
}

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
  if (!keep_stages) return frame;

  // Show the first map alone: more would not fit
  if (!maps.empty()) {
    frame.layers.push_back(
        fitted_layer("rsm.flux", flux_image(maps.front()), settings.width, settings.height));
  }
  for (const Layer& stage : frame.light.stages) {
    frame.layers.push_back(fitted_layer(stage.name, stage.image, settings.width, settings.height));
  }
  return frame;
}

void look_up_rsm(const RsmFrame& frame, const GBuffer& gbuffer, const Camera& camera, int width,
                 const Band& band, std::vector<glm::vec3>& irradiance) {
  irradiance.assign(gbuffer.size(), vec3(0.0f));
  const float scale = 1.0f / static_cast<float>(frame.downscale);
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      const auto x = static_cast<float>(i % static_cast<std::size_t>(width));
      const auto y = static_cast<float>(i / static_cast<std::size_t>(width)) +
                     static_cast<float>(band.first_row);
      const Surface& surface = gbuffer.surfaces[i];
      irradiance[i] = upsampled(frame, surface, view_depth(camera, surface.position_ws),
                                (x + 0.5f) * scale - 0.5f, (y + 0.5f) * scale - 0.5f);
    }
  });
}

}  // namespace lambent
