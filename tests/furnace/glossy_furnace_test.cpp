// SPDX-License-Identifier: Apache-2.0
// What coats reflect where radiance is 1 from all around: their directional albedo, and no light
// twice or not at all, whether it comes from emitters or the sky, and for every roughness.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "glossy/glossy_math.h"
#include "lambent/renderer.h"
#include "support/field_scenes.h"
#include "support/furnace_ball.h"

namespace lambent::glossy_furnace_test {
namespace {

constexpr int kSide = 64;     // of the picture [pixels]
constexpr int kSamples = 16;  // a pixel

// The project's bar for energy. A coat of index 1 reflects at grazing angles alone, where the fit
// of the Fresnel term's mean is 2 % off. Rough dielectrics with rays on every second row lose up to
// 1 % of emitters all around: a mean over few rays is one of weights, too.
constexpr double kTolerance = 0.005;
constexpr double kGrazingTolerance = 0.02;
constexpr double kDielectricUnderEmitters = 0.01;

// Roughnesses of mirrors, of lobes that lamps' samples and rays share, of the change from rays to
// the field's light, and beyond.
constexpr float kRoughnesses[] = {0.0f, 0.1f, 0.25f, 0.31f, 0.5f, 0.7f, 0.85f, 1.0f};

enum class Source { emitters, sky };

struct Case {
  Source source;
  float roughness;
  float metallic;
  float ior;
};

double tolerance_of(const Case& c) {
  const bool rough = c.roughness > 0.0f;
  if (c.source == Source::emitters && c.metallic == 0.0f && rough) return kDielectricUnderEmitters;
  return c.ior > 1.0f ? kTolerance : kGrazingTolerance;
}

/// A ball with a coat.
Scene ball(const Case& c) {
  Material coat;
  coat.base_color = c.metallic > 0.0f ? glm::vec4(1.0f) : glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  coat.metallic = c.metallic;
  coat.roughness = c.roughness;
  coat.ior = c.ior;
  return test::furnace_ball(coat, c.source == Source::sky);
}

/// Share of light from everywhere that a surface's coat reflects; none comes from below either of
/// its horizons.
double reflected_share(const Surface& surface, const vec3& to_viewer_ws, uint point) {
  constexpr uint kDraws = 32;  // by 26,000 points of the ball: a standard error below 0.1 %
  const Frame frame = make_frame(surface.normal_ws);
  RandomStream random = make_random_stream(point, 0u, 1u);
  const vec2 shift = next_uniform2(random);
  double sum = 0.0;
  for (uint i = 0; i < kDraws; ++i) {
    const CoatDraw drawn = draw_coat_ray(surface.reflectance, frame, to_viewer_ws,
                                         glm::fract(plastic_sequence(i) + shift));
    if (drawn.pdf <= 0.0f) continue;
    if (dot(surface.geometric_normal_ws, drawn.direction_ws) > 0.0f) sum += drawn.weight.x;
  }
  return sum / kDraws;
}

class GlossyFurnace : public testing::TestWithParam<Case> {};

TEST_P(GlossyFurnace, ReflectsItsAlbedo) {
  const test::Stage stage(ball(GetParam()));
  FieldSettings settings = test::exact_formats();
  settings.probe_count = glm::ivec3(4);
  settings.rays_per_probe = 1024;  // the field's own error is a tenth of a percent
  const IrradianceField field = test::make_field(stage, settings, 2);
  FrameSettings frame;
  frame.width = frame.height = kSide;
  frame.samples = kSamples;
  const double expected = test::mean_over_ball(stage, kSide, kSamples, reflected_share);
  for (const int rows : {1, 2}) {
    frame.glossy_rows = rows;
    const LayeredImage image =
        Renderer(stage.world, {.field = &field}).render(stage.scene.cameras[0], frame)->image;
    const Image& glossy = *image.find("glossy");
    double mean = 0.0;
    for (std::size_t i = 0; i < glossy.pixels.size(); i += 3) mean += glossy.pixels[i];
    mean /= kSide * kSide;
    std::printf("%d rows: ratio %.4f\n", rows, mean / expected);
    EXPECT_NEAR(mean / expected, 1.0, tolerance_of(GetParam())) << rows << " rows";
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Source source : {Source::emitters, Source::sky}) {
    for (const float roughness : kRoughnesses) {
      all.push_back({source, roughness, 1.0f, 1.5f});
      all.push_back({source, roughness, 0.0f, 1.5f});
      if (source == Source::emitters) continue;
      for (const float ior : {1.0f, 2.0f}) all.push_back({source, roughness, 0.0f, ior});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Cases, GlossyFurnace, testing::ValuesIn(cases()), [](const auto& tested) {
  const Case& c = tested.param;
  return std::string(c.source == Source::emitters ? "emitters" : "sky") +
         (c.metallic > 0.0f
              ? "_metal_"
              : "_dielectric_" + std::to_string(static_cast<int>(std::lround(10.0f * c.ior))) +
                    "_") +
         std::to_string(static_cast<int>(std::lround(100.0f * c.roughness)));
});

}  // namespace
}  // namespace lambent::glossy_furnace_test
