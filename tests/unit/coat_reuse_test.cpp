// SPDX-License-Identifier: Apache-2.0
// What a pixel's coat makes of the rays of the pixels around it.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "glossy/glossy_math.h"

namespace lambent::coat_reuse_test {
namespace {

constexpr int kEdge = 24;
constexpr float kPixel = 0.004f;  // [m] on the mirror: 640 pixels see 65 degrees from 2 m
const vec3 kEye(0.3f, 0.2f, 2.0f);
constexpr float kWall = 5.0f;  // height of the wall that the mirror faces [m]

/// A flat metal seen from kEye, and the ray of each pixel, which meets a wall of radiance 1.
struct FlatView {
  Reflectance metal;
  std::vector<CoatRay> rays;
};

using CoatViewRef = const FlatView&;

CoatLobe fetch_lobe(CoatViewRef view, ivec2 pixel) {
  const vec3 up(0.0f, 0.0f, 1.0f);
  const vec3 position(vec2(pixel) * kPixel, 0.0f);
  return make_coat_lobe(position, up, up, normalize(kEye - position), view.metal.alpha);
}
CoatRay fetch_ray(CoatViewRef view, ivec2 pixel) {
  return view.rays[pixel.y * kEdge + pixel.x];
}
ivec2 view_size(CoatViewRef) {
  return ivec2(kEdge);
}

#include "glossy/reuse.inl.h"

FlatView view_of(float alpha, uint sample) {
  FlatView view;
  view.metal = {};
  view.metal.f0 = vec3(1.0f);
  view.metal.f90 = 1.0f;
  view.metal.alpha = alpha;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const CoatLobe lobe = fetch_lobe(view, {x, y});
      const CoatDraw drawn = draw_coat_ray(view.metal, make_frame(lobe.normal_ws),
                                           lobe.to_viewer_ws, coat_uniforms({x, y}, sample, 1, 1));
      const float distance = kWall / drawn.direction_ws.z;
      CoatRay ray = no_coat_ray(distance);
      ray.direction_ws = drawn.direction_ws;
      ray.radiance = vec3(1.0f);
      ray.pdf = drawn.pdf;
      view.rays.push_back(ray);
    }
  }
  return view;
}

/// The darkest and brightest of what the pixels in the middle reflect.
vec2 range_of(const FlatView& view, uint sample) {
  vec2 range(1e9f, 0.0f);
  for (int y = kReuse; y < kEdge - kReuse; ++y) {
    for (int x = kReuse; x < kEdge - kReuse; ++x) {
      CoatReceiver at{fetch_lobe(view, {x, y}),
                      view.metal,
                      1.0f / (kPlaneTolerance * kPixel),
                      fetch_ray(view, {x, y}),
                      {},
                      {},
                      0.0f,
                      0.0f};
      find_lobe(at);
      const float light = reuse_rays(view, {x, y}, at, sample, 1).light.x;
      range = {std::min(range.x, light), std::max(range.y, light)};
    }
  }
  return range;
}

TEST(CoatReuse, ShowsAPlainWallInAMirrorWithoutGrain) {
  for (const float alpha : {0.001f, 0.002f, 0.004f, 0.01f}) {
    for (uint sample = 0; sample < 4; ++sample) {
      const vec2 range = range_of(view_of(alpha, sample), sample);
      EXPECT_GT(range.x, 0.98f) << "GGX width " << alpha << ", sample " << sample;
      EXPECT_LT(range.y, 1.02f) << "GGX width " << alpha << ", sample " << sample;
    }
  }
}

}  // namespace
}  // namespace lambent::coat_reuse_test
