// SPDX-License-Identifier: Apache-2.0
// The textures that shaders look streamed light up in.
#include "stream/light/light_textures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "field/probes/tile.h"
#include "support/light_box.h"

namespace lambent::stream::light_textures_test {
namespace {

using test::Box;

/// The word of a probe's tile at a texel, gutter included.
std::uint32_t word_at(const std::vector<std::uint32_t>& atlas, int probe, int texels, ivec2 texel) {
  const int edge = texels + 2, in_row = LightTextures::kWidth / edge;
  const int x = probe % in_row * edge + texel.x, y = probe / in_row * edge + texel.y;
  return atlas.at(static_cast<std::size_t>(y) * LightTextures::kWidth + x);
}

/// Halves have 11 bits, RGB9E5 at least 8 of its largest channel.
constexpr float kHalf = 1.0f / 2048.0f, kRgb9e5 = 1.0f / 256.0f;
/// A step of the darkest light that RGB9E5 holds.
constexpr float kLeastRgb9e5 = 1.0f / 16777216.0f;

void expect_same(const LightTextures& textures, const LightDecoder& decoder) {
  ASSERT_EQ(textures.grids().size(), decoder.grids().size());
  const int edge = decoder.irradiance_texels(), distance_edge = decoder.distance_texels();
  std::vector<glm::vec3> light(edge * edge);
  std::vector<glm::vec2> moments(distance_edge * distance_edge);
  for (int probe = 0; probe < decoder.probes(); ++probe) {
    EXPECT_EQ(glm::vec3(textures.places()[probe]), decoder.position_ws(probe));
    decoder.irradiance(probe, light);
    for (int t = 0; t < (edge + 2) * (edge + 2); ++t) {
      const ivec2 texel(t % (edge + 2), t / (edge + 2)), source = tile_source(texel, edge);
      const vec3 stored = decode_rgb9e5(word_at(textures.irradiance(), probe, edge, texel));
      const vec3 decoded = light[source.y * edge + source.x];
      const float most =
          kRgb9e5 * glm::max(decoded.x, glm::max(decoded.y, decoded.z)) + kLeastRgb9e5;
      ASSERT_TRUE(glm::all(glm::lessThanEqual(glm::abs(stored - decoded), vec3(most)))) << probe;
    }
    decoder.distances(probe, moments);
    const ProbeGrid& grid = *std::find_if(textures.grids().rbegin(), textures.grids().rend(),
                                          [&](const ProbeGrid& one) { return one.first <= probe; });
    for (int t = 0; t < distance_edge * distance_edge; ++t) {
      const ivec2 texel = ivec2(t % distance_edge, t / distance_edge) + 1;
      const vec2 stored = decode_half2(word_at(textures.distances(), probe, distance_edge, texel)) *
                          vec2(distance_unit(grid), distance_unit(grid) * distance_unit(grid));
      ASSERT_NEAR(stored.x, moments[t].x, kHalf * moments[t].x + 1e-6f) << probe;
      ASSERT_NEAR(stored.y, moments[t].y, kHalf * moments[t].y + 1e-6f) << probe;
    }
  }
}

TEST(LightTextures, HoldWhatIsDecodedWhileLightChangesAndVolumesScroll) {
  FieldSettings settings = Box::small_field();
  settings.cascades = 2;
  Box box(settings);
  LightEncoder encoder = test::made_encoder();
  LightDecoder decoder;
  LightTextures textures(decoder);
  textures.follow();
  EXPECT_TRUE(textures.irradiance().empty());
  for (int update = 0; update < 8; ++update) {
    for (const LightMessage& message : test::encoded(encoder, box)) {
      ASSERT_TRUE(decoder.receive(message.bytes));
      textures.follow();
    }
    expect_same(textures, decoder);
    box.shine(1.3f);
    if (update % 3 == 2) box.look_from({0.6f * static_cast<float>(update), 2.0f, 2.0f});
  }
  EXPECT_GT(textures.geometry_changes(), 1u);
}

}  // namespace
}  // namespace lambent::stream::light_textures_test
