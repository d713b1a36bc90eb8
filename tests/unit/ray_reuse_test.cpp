// SPDX-License-Identifier: Apache-2.0
// What pixels make of the rays around them: lanes against the formulas of one pixel after the
// other.
#include "compose/glossy/ray_reuse.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "raytracing/camera_rays.h"
#include "raytracing/direct_light.h"
#include "support/hand_made.h"

namespace lambent::ray_reuse_test {
namespace {

// Not a multiple of any number of lanes
constexpr int kWidth = 37, kHeight = 11;

/// Pixels and their rays, as reuse.inl.h reads them.
struct Picture {
  GBuffer pixels;
  std::vector<CoatRay> rays;
};

std::size_t place_of(const ivec2& pixel) {
  return static_cast<std::size_t>(pixel.y) * kWidth + pixel.x;
}

using CoatViewRef = const Picture&;
CoatLobe fetch_lobe(CoatViewRef view, ivec2 pixel) {
  return lobe_of(view.pixels, place_of(pixel));
}
CoatRay fetch_ray(CoatViewRef view, ivec2 pixel) {
  return view.rays[place_of(pixel)];
}
ivec2 view_size(CoatViewRef /*view*/) {
  return {kWidth, kHeight};
}

#include "glossy/reuse.inl.h"

/// A bumpy wall with coats of all widths, some of whose rays went into it or left the scene.
class RayReuseTest : public testing::Test {
 protected:
  RayReuseTest() {
    GBuffer& pixels = picture.pixels;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        Surface surface{};
        surface.position_ws = vec3(0.1f * x, 0.1f * y, -3.0f + 0.01f * uniform());
        surface.geometric_normal_ws = vec3(0.0f, 0.0f, 1.0f);
        surface.normal_ws = direction_about(0.2f);
        surface.reflectance.alpha = x < 5 ? kMinGgxAlpha : 0.02f + 0.8f * uniform();
        surface.reflectance.f0 = vec3(0.04f, 0.2f, 0.9f);
        surface.reflectance.f90 = 0.8f;
        surface.gi_share = 1.0f;
        pixels.surfaces.push_back(surface);
        pixels.hit.push_back(1);
        pixels.to_viewer_ws.push_back(direction_about(0.6f));
        pixels.coat_shares.push_back({uniform() < 0.1f ? 0.0f : uniform(), 0.0f});
        picture.rays.push_back(ray_of(pixels, pixels.size() - 1));
      }
    }
  }

  float uniform() { return spread(random); }
  vec3 direction_about(float by) {
    return normalize(vec3(by * (2.0f * uniform() - 1.0f), by * (2.0f * uniform() - 1.0f), 1.0f));
  }

  CoatRay ray_of(const GBuffer& pixels, std::size_t i) {
    CoatRay ray = no_coat_ray(infinity());
    if (pixels.coat_shares[i].coat <= 0.0f || uniform() < 0.1f) return ray;
    const Surface& surface = pixels.surfaces[i];
    const CoatDraw drawn = draw_coat_ray(surface.reflectance, make_frame(surface.normal_ws),
                                         pixels.to_viewer_ws[i], vec2(uniform(), uniform()));
    ray.pdf = drawn.pdf > 0.0f && uniform() > 0.1f ? drawn.pdf : -1.0f;
    if (ray.pdf < 0.0f) return ray;
    ray.direction_ws = drawn.direction_ws;
    if (uniform() > 0.2f) ray.distance = 0.2f + 5.0f * uniform();
    ray.radiance = vec3(uniform(), uniform(), 3.0f * uniform());
    if (uniform() < 0.03f) ray.radiance *= 200.0f;
    if (uniform() < 0.2f) {
      ray.apart = vec3(20.0f, 10.0f, 5.0f);
      ray.apart_luminance = 80.0f * uniform() - 40.0f;
    }
    return ray;
  }

  /// Light and share of a pixel, and the excess of its light.
  struct Reflected {
    vec4 light;
    vec3 excess;
  };
  Reflected expected(const GlossySettings& settings, const ivec2& pixel) const {
    const std::size_t i = place_of(pixel);
    const GBuffer& pixels = picture.pixels;
    const float share = pixels.coat_shares[i].coat;
    if (share <= 0.0f) return {vec4(0.0f), vec3(0.0f)};
    const Surface& surface = pixels.surfaces[i];
    CoatReceiver at{fetch_lobe(picture, pixel),
                    surface.reflectance,
                    inverse_plane_tolerance(settings.camera, surface.position_ws),
                    fetch_ray(picture, pixel),
                    {},
                    {},
                    0.0f,
                    emitter_density_scale(settings.world, settings.frame.emissive_samples,
                                          surface.position_ws)};
    find_lobe(at);
    const ReflectedRays found = reuse_rays(picture, pixel, at, static_cast<uint>(settings.sample),
                                           static_cast<uint>(settings.frame.glossy_rows));
    return {share * light_by_rays(found.light), share * found.excess};
  }

  std::mt19937 random{7};
  std::uniform_real_distribution<float> spread{0.0f, 1.0f};
  Picture picture;
};

TEST_F(RayReuseTest, SumsUpInLanesWhatOnePixelAfterTheOtherDoes) {
  Scene scene;
  scene.materials = {test::lambert(vec3(0.5f))};
  test::add_room(scene, 10.0f, 0);
  const World world(scene);
  Camera camera;
  FrameSettings frame;
  frame.width = kWidth;
  frame.height = kHeight;
  frame.denoise = true;  // finds the excess
  for (const int rows : {1, 2, 3}) {
    for (const int sample : {0, 1}) {
      frame.glossy_rows = rows;
      const GlossySettings settings{world, nullptr, frame, camera_record(camera, kWidth, kHeight),
                                    sample};
      const GlossyRows all{picture.pixels, 0};
      CoatLight light;
      RayReuse().reflect(settings, {&all, 1}, all, picture.rays, {}, light);
      int reflecting = 0, exceeding = 0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const std::size_t i = place_of({x, y});
          const Reflected should = expected(settings, {x, y});
          // Lobes of mirrors turn the rounding of half vectors into that of light
          for (int c = 0; c < 4; ++c) {
            EXPECT_NEAR(light.light[i][c], should.light[c],
                        1e-3f * std::abs(should.light[c]) + 1e-6f)
                << x << ", " << y << " of every " << rows;
          }
          for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(light.guides[i].excess[c], should.excess[c],
                        1e-3f * std::abs(should.light[c]) + 1e-6f)
                << x << ", " << y << " of every " << rows;
          }
          reflecting += should.light.x > 0.0f ? 1 : 0;
          exceeding += should.excess.x > 0.0f ? 1 : 0;
        }
      }
      EXPECT_GT(reflecting, kWidth * kHeight / 2);
      EXPECT_GT(exceeding, kWidth * kHeight / 20);
      // Without a filter nothing is told apart
      FrameSettings raw = frame;
      raw.denoise = false;
      CoatLight unfiltered;
      RayReuse().reflect({world, nullptr, raw, settings.camera, sample}, {&all, 1}, all,
                         picture.rays, {}, unfiltered);
      EXPECT_EQ(unfiltered.light, light.light);
      EXPECT_TRUE(unfiltered.guides.empty());
    }
  }
}

}  // namespace
}  // namespace lambent::ray_reuse_test
