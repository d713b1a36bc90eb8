// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scene/light_sampling.h"
#include "shared/constants.h"
#include "shared/random.h"
#include "support/chi_squared.h"
#include "support/hand_made.h"

namespace lambent::light_test {
namespace {

using test::add;
using test::lambert;
using test::quad;

constexpr int kSamples = 100000;

glm::vec3 next_uniform3(RandomStream& random) {
  const glm::vec2 pair = next_uniform2(random);
  return {pair, next_uniform(random)};
}

// A texture of the given size, made of grey bytes row by row.
Texture grey_texture(int width, int height, const std::vector<int>& greys) {
  Texture texture;
  texture.levels.resize(1);
  texture.levels[0].width = width;
  texture.levels[0].height = height;
  for (const int grey : greys) {
    const auto byte = static_cast<std::uint8_t>(grey);
    texture.levels[0].rgba.insert(texture.levels[0].rgba.end(), {byte, byte, byte, 255});
  }
  build_mips(texture);
  return texture;
}

TEST(PunctualLight, RangeEndsItsLightSmoothly) {
  Light light = test::point_light(glm::vec3(8.0f), {0.0f, 0.0f, 0.0f});
  light.range = 4.0f;
  EXPECT_NEAR(sample_punctual(light, {2.0f, 0.0f, 0.0f}).irradiance.x, 2.0f * (1.0f - 1.0f / 16.0f),
              1e-6f);
  EXPECT_EQ(sample_punctual(light, {4.5f, 0.0f, 0.0f}).irradiance.x, 0.0f);
}

TEST(PunctualLight, DirectionalComesFromInfinity) {
  const PunctualSample sample =
      sample_punctual(test::sun(glm::vec3(3.0f), {0.0f, -1.0f, 0.0f}), glm::vec3(5.0f));
  EXPECT_EQ(sample.irradiance, glm::vec3(3.0f));
  EXPECT_EQ(sample.to_light, glm::vec3(0.0f, 1.0f, 0.0f));
  EXPECT_TRUE(std::isinf(sample.distance));
}

TEST(PunctualLight, AtItsOwnPositionSendsNothing) {
  EXPECT_EQ(sample_punctual(test::point_light(glm::vec3(1.0f), glm::vec3(2.0f)), glm::vec3(2.0f))
                .irradiance,
            glm::vec3(0.0f));
}

TEST(PunctualLight, SpotWithEqualConesHasAHardEdge) {
  Light light = test::point_light(glm::vec3(1.0f), {0.0f, 1.0f, 0.0f});
  light.type = Light::Type::spot;
  light.direction_ws = {0.0f, -1.0f, 0.0f};
  light.inner_cone_angle = light.outer_cone_angle = 0.5f;
  EXPECT_EQ(sample_punctual(light, {0.0f, 0.0f, 0.0f}).irradiance.x, 1.0f);
  EXPECT_EQ(sample_punctual(light, {std::tan(0.51f), 0.0f, 0.0f}).irradiance.x, 0.0f);
}

TEST(EmissiveTriangles, AreDrawnByPower) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f), glm::vec3(1.0f)),
                     lambert(glm::vec3(0.5f), glm::vec3(3.0f)), lambert(glm::vec3(0.5f))};
  add(scene, quad({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0));
  add(scene, quad({0.0f, 0.0f, 1.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 1));
  add(scene, quad({0.0f, 0.0f, 2.0f}, {9.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 2));
  const EmissiveTriangles lights(scene);
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_NEAR(lights.total_power(), kTwoPi * 7.0f, 1e-3f);
  EXPECT_NEAR(lights.pdf_area(0, 1, glm::vec2(0.3f)), 1.0f / 7.0f, 1e-6f);
  EXPECT_NEAR(lights.pdf_area(1, 0, glm::vec2(0.3f)), 3.0f / 7.0f, 1e-6f);
  EXPECT_EQ(lights.pdf_area(2, 0, glm::vec2(0.3f)), 0.0f);

  RandomStream random = make_random_stream(1u, 0u, 0u);
  int bright = 0;
  for (int i = 0; i < kSamples; ++i) {
    const EmissiveSample sample = lights.sample(next_uniform3(random));
    const bool is_bright = sample.position_ws.z > 0.5f;
    bright += is_bright ? 1 : 0;
    ASSERT_FLOAT_EQ(sample.pdf_area, is_bright ? 3.0f / 7.0f : 1.0f / 7.0f);
    ASSERT_EQ(sample.radiance.x, is_bright ? 3.0f : 1.0f);
  }
  EXPECT_NEAR(static_cast<double>(bright) / kSamples, 6.0 / 7.0, 0.005);
}

TEST(EmissiveTriangles, SpreadEvenlyOverEachTriangle) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f), glm::vec3(1.0f))};
  add(scene, quad({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0));
  const EmissiveTriangles lights(scene);
  constexpr int kCells = 8;
  std::vector<double> observed(kCells * kCells);
  RandomStream random = make_random_stream(2u, 0u, 0u);
  for (int i = 0; i < kSamples; ++i) {
    const glm::vec3 p =
        lights.sample(next_uniform3(random)).position_ws * static_cast<float>(kCells);
    observed[std::min(static_cast<int>(p.y), kCells - 1) * kCells +
             std::min(static_cast<int>(p.x), kCells - 1)] += 1.0;
  }
  const std::vector<double> expected(observed.size(),
                                     static_cast<double>(kSamples) / (kCells * kCells));
  EXPECT_LT(test::chi_squared_deviation(observed, expected), test::kMaxChiSquaredDeviation);
}

TEST(EmissiveTriangles, AreFoundWhereASingleTexelEmits) {
  constexpr int kSize = 64;
  std::vector<int> greys(kSize * kSize, 0);
  greys[40 * kSize + 50] = 255;
  Scene scene;
  scene.textures = {grey_texture(kSize, kSize, greys)};
  scene.materials = {lambert(glm::vec3(0.5f), glm::vec3(2.0f))};
  scene.materials[0].emission_texture.texture = 0;
  add(scene, quad({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0));
  const EmissiveTriangles lights(scene);
  // Only the pieces around the texel are left
  EXPECT_GT(lights.size(), 0u);
  EXPECT_LT(lights.size(), 9u);

  // The estimate of the emitted power is right though one texel in 4,096 emits
  RandomStream random = make_random_stream(3u, 0u, 0u);
  double sum = 0.0;
  for (int i = 0; i < 10 * kSamples; ++i) {
    const EmissiveSample sample = lights.sample(next_uniform3(random));
    sum += sample.radiance.x / sample.pdf_area;
  }
  EXPECT_NEAR(sum / (10 * kSamples) * kSize * kSize / 2.0, 1.0, 0.01);
}

TEST(EmissiveTriangles, LeaveOutWhatTheTextureKeepsDark) {
  // The left half of the texture is black; so is the quad that shows it alone
  Scene scene;
  constexpr int kSize = 32;
  std::vector<int> greys;
  for (int i = 0; i < kSize * kSize; ++i) greys.push_back(i % kSize < kSize / 2 ? 0 : 255);
  scene.textures = {grey_texture(kSize, kSize, greys)};
  scene.materials = {lambert(glm::vec3(0.5f), glm::vec3(2.0f))};
  scene.materials[0].emission_texture.texture = 0;
  for (const float left : {0.1f, 0.6f}) {
    Mesh mesh = quad({left, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0);
    mesh.uvs[0] = {{left, 0.1f}, {left + 0.2f, 0.1f}, {left + 0.2f, 0.9f}, {left, 0.9f}};
    add(scene, mesh);
  }
  const EmissiveTriangles lights(scene);
  EXPECT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights.pdf_area(0, 0, glm::vec2(0.3f)), 0.0f);
  EXPECT_NEAR(lights.pdf_area(1, 0, glm::vec2(0.3f)), 1.0f, 1e-5f);
  EXPECT_NEAR(lights.total_power(), kTwoPi * 2.0f, 0.01f);
}

TEST(EmissiveTriangles, UnlitSurfacesShineWithTheirColour) {
  Scene scene;
  Material unlit;
  unlit.base_color = {0.2f, 0.4f, 0.6f, 1.0f};
  unlit.unlit = true;
  scene.materials = {unlit};
  add(scene, quad({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0));
  const EmissiveTriangles lights(scene);
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights.sample({0.3f, 0.3f, 0.3f}).radiance, glm::vec3(0.2f, 0.4f, 0.6f));
}

TEST(EmissiveTriangles, SendNothingWhereCoverageLetsRaysThrough) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f), glm::vec3(2.0f))};
  scene.materials[0].base_color.a = 0.25f;
  add(scene, quad({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0));
  const EmissiveTriangles lights(scene);
  scene.materials[0].alpha_mode = AlphaMode::blend;
  EXPECT_FLOAT_EQ(lights.sample({0.3f, 0.3f, 0.3f}).radiance.x, 0.5f);
  scene.materials[0].alpha_mode = AlphaMode::mask;
  EXPECT_EQ(lights.sample({0.3f, 0.3f, 0.3f}).radiance.x, 0.0f);
}

TEST(EmissiveTriangles, SendThroughAClearcoatWhatItLetsPassAtThatAngle) {
  Scene scene;
  Material lamp;
  lamp.emission = glm::vec3(2.0f);
  lamp.clearcoat = 0.7f;
  scene.materials = {lamp};
  add(scene, quad({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0));
  const EmissiveTriangles lights(scene);
  EXPECT_FLOAT_EQ(lights.sample({0.3f, 0.3f, 0.3f}).radiance.x, 2.0f);
  EXPECT_FLOAT_EQ(lights.sample({0.3f, 0.3f, 0.3f}).clearcoat, 0.7f);
  const auto sent = [&](float cosine) {
    const glm::vec3 direction(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
    return lights.radiance(lights.entries()[0], {0.3f, 0.3f}, direction).x;
  };
  // KHR_materials_clearcoat: of ior 1.5
  EXPECT_NEAR(sent(1.0f), 2.0f * (1.0f - 0.7f * 0.04f), 1e-6f);
  EXPECT_NEAR(sent(-0.2f), 2.0f * (1.0f - 0.7f * (0.04f + 0.96f * std::pow(0.8f, 5.0f))), 1e-5f);
  scene.materials[0].lambert = true;
  EXPECT_FLOAT_EQ(sent(0.2f), 2.0f);
}

TEST(EmissiveTriangles, NoneIsNoLight) {
  Scene scene;
  const EmissiveTriangles lights(scene);
  EXPECT_TRUE(lights.empty());
  EXPECT_EQ(lights.sample({0.5f, 0.5f, 0.5f}).pdf_area, 0.0f);
}

}  // namespace
}  // namespace lambent::light_test
