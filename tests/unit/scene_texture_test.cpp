// SPDX-License-Identifier: Apache-2.0
#include "scene/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "shared/color.h"

namespace lambent::scene_texture_test {
namespace {

constexpr float kTolerance = 1e-5f;

// A row of grey texels, as numbers.
Scene row_of(const std::vector<std::uint8_t>& greys, bool srgb = false) {
  Texture texture;
  texture.srgb = srgb;
  TextureLevel level;
  level.width = static_cast<int>(greys.size());
  level.height = 1;
  for (const std::uint8_t grey : greys)
    level.rgba.insert(level.rgba.end(), {grey, grey, grey, 255});
  texture.levels.push_back(level);
  build_mips(texture);
  Scene scene;
  scene.textures.push_back(std::move(texture));
  return scene;
}

TextureView view_of(Wrap wrap, bool nearest = false) {
  TextureView view;
  view.texture = 0;
  view.wrap_u = view.wrap_v = wrap;
  view.nearest = nearest;
  return view;
}

// The row's value (0 to 255) at texel coordinate `x`.
float at(const Scene& scene, const TextureView& view, float x) {
  const auto width = static_cast<float>(scene.textures[0].levels[0].width);
  return sample_texture(scene, view, {x / width, 0.5f}).r * 255.0f;
}

TEST(SampleTexture, BlendsNeighboursLinearly) {
  const Scene scene = row_of({0, 100, 200, 100});
  const TextureView view = view_of(Wrap::clamp_to_edge);
  EXPECT_NEAR(at(scene, view, 0.5f), 0.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view, 1.0f), 50.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view, 1.75f), 125.0f, 1e-3f);
}

TEST(SampleTexture, NearestDoesNotBlend) {
  const Scene scene = row_of({0, 100, 200, 100});
  const TextureView view = view_of(Wrap::repeat, true);
  EXPECT_NEAR(at(scene, view, 1.01f), 100.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view, 1.99f), 100.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view, -1.5f), 200.0f, 1e-3f);
}

TEST(SampleTexture, WrapsAsAsked) {
  const Scene scene = row_of({10, 20, 30, 40});
  // Texel centres to the left and to the right of the row
  EXPECT_NEAR(at(scene, view_of(Wrap::repeat), -0.5f), 40.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view_of(Wrap::repeat), 4.5f), 10.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view_of(Wrap::repeat), 4.0f), 25.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view_of(Wrap::mirrored_repeat), -1.5f), 20.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view_of(Wrap::mirrored_repeat), 5.5f), 30.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view_of(Wrap::mirrored_repeat), 8.5f), 10.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view_of(Wrap::clamp_to_edge), -7.0f), 10.0f, 1e-3f);
  EXPECT_NEAR(at(scene, view_of(Wrap::clamp_to_edge), 99.0f), 40.0f, 1e-3f);
}

TEST(SampleTexture, SurvivesAnyCoordinate) {
  const Scene scene = row_of({10, 20, 30, 40});
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
    for (const float u : {1e30f, -1e30f, std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN(), 0.99999997f, -1e-9f}) {
      for (const bool nearest : {false, true}) {
        const float value = sample_texture(scene, view_of(wrap, nearest), {u, -u}).r * 255.0f;
        EXPECT_GE(value, 10.0f - 1e-3f) << u;
        EXPECT_LE(value, 40.0f + 1e-3f) << u;
      }
    }
  }
}

TEST(SampleTexture, DecodesColorButNotAlpha) {
  Texture texture;
  texture.srgb = true;
  texture.levels.push_back({1, 1, {0, 55, 188, 188}});
  Scene scene;
  scene.textures.push_back(texture);
  const glm::vec4 texel = sample_texture(scene, view_of(Wrap::repeat), {0.5f, 0.5f});
  EXPECT_NEAR(texel.r, 0.0f, kTolerance);
  EXPECT_NEAR(texel.g, linear_from_srgb(55.0f / 255.0f), kTolerance);
  EXPECT_NEAR(texel.b, linear_from_srgb(188.0f / 255.0f), kTolerance);
  EXPECT_NEAR(texel.a, 188.0f / 255.0f, kTolerance);
}

TEST(SampleTexture, TransformsCoordinates) {
  // The published test of KHR_texture_transform: a quad turned by 22.5 degrees shows at
  // (0.42095, 1.01627) what the image has at (0.77782, 0.77782)
  TextureView view;
  view.uv_rotation = 0.39269908169872414f;
  const glm::vec2 turned = transform_uv(view, {0.42095f, 1.01627f});
  EXPECT_NEAR(turned.x, 0.77782f, 1e-4f);
  EXPECT_NEAR(turned.y, 0.77782f, 1e-4f);
  // Scale comes first, offset last
  view.uv_rotation = std::acos(0.0f);
  view.uv_scale = {2.0f, 3.0f};
  view.uv_offset = {10.0f, 20.0f};
  const glm::vec2 all = transform_uv(view, {1.0f, 1.0f});
  EXPECT_NEAR(all.x, 13.0f, 1e-5f);
  EXPECT_NEAR(all.y, 18.0f, 1e-5f);
}

TEST(BuildMips, AverageLightNotNumbers) {
  // Half black, half white is half the light: 188 in sRGB, 128 as a number
  EXPECT_EQ(row_of({0, 255}, true).textures[0].levels.at(1).rgba[0], 188);
  EXPECT_EQ(row_of({0, 255}, false).textures[0].levels.at(1).rgba[0], 128);
}

TEST(BuildMips, KeepTheMeanOfOddSizes) {
  const Scene scene = row_of({255, 0, 0, 0, 255});
  const Texture& texture = scene.textures[0];
  ASSERT_EQ(texture.levels.size(), 3u);
  EXPECT_EQ(texture.levels[1].width, 2);
  EXPECT_EQ(texture.levels[2].width, 1);
  // Each texel of the second level covers two and a half of the first
  EXPECT_EQ(texture.levels[1].rgba[0], 102);
  EXPECT_EQ(texture.levels[1].rgba[4], 102);
  EXPECT_EQ(texture.levels[2].rgba[0], 102);
}

TEST(BuildMips, KeepEverySingleColor) {
  for (int grey = 0; grey < 256; ++grey) {
    const auto byte = static_cast<std::uint8_t>(grey);
    EXPECT_EQ(row_of({byte, byte, byte}, true).textures[0].levels.at(1).rgba[0], byte);
  }
}

TEST(BuildMips, ShowOnlyWhatIsCoveredWhereAlphaSaysSo) {
  // Leaves in a quarter of the texels, and black where nothing is covered
  Texture texture;
  texture.levels.resize(1);
  texture.levels[0].width = texture.levels[0].height = 4;
  for (int i = 0; i < 16; ++i) {
    const bool leaf = i % 2 == 1 && (i / 4) % 2 == 1;
    const std::uint8_t color = leaf ? 200 : 0, alpha = leaf ? 255 : 0;
    texture.levels[0].rgba.insert(texture.levels[0].rgba.end(), {color, color, color, alpha});
  }
  build_mips(texture, MipWeights::alpha);
  for (std::size_t level = 1; level < texture.levels.size(); ++level) {
    EXPECT_EQ(texture.levels[level].rgba[0], 200) << level;
    EXPECT_EQ(texture.levels[level].rgba[3], 64) << level;
  }
  build_mips(texture);
  EXPECT_EQ(texture.levels[1].rgba[0], 50);

  // Where nothing is covered, colours are those of what is around
  for (int i = 0; i < 16; ++i) texture.levels[0].rgba[4 * i + 3] = i == 5 ? 255 : 0;
  build_mips(texture, MipWeights::alpha);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(texture.levels[1].rgba[4 * i], 200) << i;
  EXPECT_EQ(texture.levels[0].rgba[0], 0);
}

TEST(BuildNormalMips, TellOfBumpsThatRoundingHidesInTheMeanNormal) {
  // Slopes of 0.05 to either side: the mean normal is shorter than 1 by half of a step
  Texture texture;
  texture.levels.resize(1);
  texture.levels[0].width = texture.levels[0].height = 16;
  for (int i = 0; i < 16 * 16; ++i) {
    const std::uint8_t lean = (i / 2 + i / 32) % 2 == 0 ? 134 : 121;
    texture.levels[0].rgba.insert(texture.levels[0].rgba.end(), {lean, 128, 255, 255});
  }
  build_normal_mips(texture);
  // The first level's texels have one normal each
  for (std::size_t level = 2; level < texture.levels.size(); ++level) {
    // Along one axis alone: half of the variance along each
    EXPECT_NEAR(255 - texture.levels[level].rgba[3], 255 * 0.05 / std::sqrt(2.0), 3) << level;
  }
}

TEST(BuildNormalMips, HoldHowFarMostNormalsScatter) {
  // Three of four pairs of columns face up, the last one leans; sizes need not be powers of two
  Texture texture;
  texture.levels.resize(1);
  texture.levels[0].width = 24;
  texture.levels[0].height = 9;
  for (int i = 0; i < 24 * 9; ++i) {
    const bool leans = i % 8 >= 6;
    const std::uint8_t lean = leans ? 220 : 128, up = leans ? 215 : 255;
    texture.levels[0].rgba.insert(texture.levels[0].rgba.end(), {lean, 128, up, 7});
  }
  build_normal_mips(texture);
  for (std::size_t i = 3; i < texture.levels[0].rgba.size(); i += 4) {
    ASSERT_EQ(texture.levels[0].rgba[i], 255);
  }
  ASSERT_EQ(texture.levels.size(), 5u);
  // The mean is off what most normals are by a quarter of (220 - 128) / 127.5, and counts by
  // 1 / sqrt(2)
  const std::uint8_t* coarsest = texture.levels.back().rgba.data();
  EXPECT_NEAR(coarsest[0], 128 + 23, 1);
  EXPECT_NEAR(255 - coarsest[3], 255 * 0.25 * (220 - 128) / 127.5 / std::sqrt(2.0), 2);
}

TEST(SampleTexture, BlendsLevelsWhereTheOneIsHalfOfTheOther) {
  const Scene scene = row_of({0, 0, 0, 0, 255, 255, 255, 255});
  const TextureView view = view_of(Wrap::clamp_to_edge);
  const auto at_level = [&](float level) {
    return sample_texture(scene, view, {0.4375f, 0.5f}, level).r;
  };
  // The middle of the last dark texel: dark, and half a texel of the next level from its edge
  EXPECT_NEAR(at_level(0.0f), 0.0f, kTolerance);
  EXPECT_NEAR(at_level(1.0f), 0.25f, kTolerance);
  EXPECT_NEAR(at_level(0.5f), 0.125f, kTolerance);
  // The coarsest level is the mean, and there is none beyond
  EXPECT_NEAR(at_level(3.0f), 0.5f, 0.01f);
  EXPECT_NEAR(at_level(30.0f), 0.5f, 0.01f);
}

TEST(BlendedLevel, IsNearTheLogarithmAndNeverJumps) {
  const vec2 edge1(1.0f, 0.0f), edge2(0.0f, 1.0f), scale(1.0f);
  float last = 0.0f;
  for (float texels = 0.25f; texels < 1e6f; texels *= 1.01f) {
    // The triangle has 1024 x 512 / 2 texels
    const float share = texels / (0.5f * 1024.0f * 512.0f);
    const float level = blended_level(edge1, edge2, scale, 1024, 512, share);
    EXPECT_NEAR(level, std::max(0.0f, 0.5f * std::log2(texels)), 0.05f);
    EXPECT_LT(level - last, 0.02f);
    last = level;
  }
}

TEST(BuildMips, RefusesTexturesWithoutAllOfTheirTexels) {
  Texture none, few, no_size;
  few.levels.push_back({4, 4, std::vector<std::uint8_t>(4 * 4 * 3)});
  no_size.levels.push_back({0, 4, {}});
  for (Texture* texture : {&none, &few, &no_size}) {
    EXPECT_THROW(build_mips(*texture), std::invalid_argument);
    EXPECT_THROW(build_normal_mips(*texture), std::invalid_argument);
  }
  Texture encoded;
  encoded.levels.push_back({1, 1, {128, 128, 255, 255}});
  encoded.srgb = true;
  EXPECT_THROW(build_normal_mips(encoded), std::invalid_argument);
}

TEST(NearestTexel, ClampsLevelsToThoseThatExist) {
  const Scene scene = row_of({0, 200});
  const TextureView view = view_of(Wrap::clamp_to_edge);
  const auto left = [&](int level) {
    return nearest_texel(scene, view, {0.25f, 0.5f}, level).r * 255.0f;
  };
  EXPECT_NEAR(left(-3), 0.0f, 1e-3f);
  EXPECT_NEAR(left(1), 100.0f, 1e-3f);
  EXPECT_NEAR(left(99), 100.0f, 1e-3f);
}

}  // namespace
}  // namespace lambent::scene_texture_test
