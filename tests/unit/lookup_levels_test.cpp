// SPDX-License-Identifier: Apache-2.0
// The level of lookups over large parts of the picture, while light moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numeric>
#include <vector>

#include "compose/history/lookup_levels.h"
#include "lambent/renderer.h"
#include "support/field_scenes.h"

namespace lambent::lookup_levels_test {
namespace {

constexpr float kTolerance = 0.05f;  // of depths [m]

/// A wall whose right half is 1 m farther away and faces another way.
struct TwoWalls {
  TwoWalls(int width, int height) {
    const float pixel = 2.0f / static_cast<float>(height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const bool far = 2 * x >= width;
        positions_ws.push_back(pixel * vec3(static_cast<float>(x), static_cast<float>(y), 0.0f) -
                               vec3(0.0f, 0.0f, far ? 1.0f : 0.0f));
        normals_ws.push_back(far ? normalize(vec3(1.0f, 0.0f, 0.2f)) : vec3(0.0f, 0.0f, 1.0f));
        depths.push_back(far ? 4.0f : 3.0f);
      }
    }
    view = {.width = width,
            .height = height,
            .positions_ws = positions_ws,
            .normals_ws = normals_ws,
            .depths = depths};
  }
  std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y * view.width + x); }
  std::vector<vec3> light(float near, float far) const {
    std::vector<vec3> all;
    for (const float depth : depths) all.emplace_back(depth == 4.0f ? far : near);
    return all;
  }
  std::vector<vec3> positions_ws, normals_ws;
  std::vector<float> depths;
  DenoiseView view;
};

TEST(LookupLevels, AreThoseOfAPixelsSurface) {
  // One size needs each pixel, the other every third
  for (const ivec2 size : {ivec2(64, 36), ivec2(720, 405)}) {
    const TwoWalls walls(size.x, size.y);
    const LookupLevels levels(walls.view, walls.light(1.0f, 2.0f), walls.light(1.5f, 1.6f));
    const vec3 brighter =
        levels.followed(walls.view, walls.pixel(size.x / 2 - 1, 10), kTolerance)->factor;
    const vec3 darker =
        levels.followed(walls.view, walls.pixel(size.x / 2, 10), kTolerance)->factor;
    EXPECT_NEAR(brighter.x, 1.5f, 0.01f) << size.x;
    EXPECT_NEAR(darker.z, 0.8f, 0.01f) << size.x;
  }
  const TwoWalls walls(64, 36);
  EXPECT_FALSE(LookupLevels().followed(walls.view, 0, kTolerance));
}

TEST(LookupLevels, AreNotThoseOfCloudsOfNoise) {
  const TwoWalls walls(320, 180);
  std::vector<vec3> before = walls.light(1.0f, 1.0f), now = before;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto x = static_cast<float>(i % 320), y = static_cast<float>(i / 320);
    before[i] *= 1.0f + 0.2f * std::sin(0.35f * x) * std::sin(0.35f * y);
    now[i] *= 1.0f + 0.2f * std::cos(0.35f * x) * std::cos(0.35f * y);
  }
  const LookupLevels levels(walls.view, before, now);
  for (int x = 0; x < 320; ++x) {
    const auto level = levels.followed(walls.view, walls.pixel(x, 90), kTolerance);
    EXPECT_NEAR(level->factor.x, 1.0f, 0.005f) << x;
    EXPECT_EQ(level->kept, 1.0f) << x;
  }
}

// A patch of sun leaves the middle of a wall. The mean over a third of the picture hardly changes.
TEST(LookupLevels, FollowLightThatLeavesPartOfAWall) {
  const TwoWalls walls(320, 180);
  std::vector<vec3> before = walls.light(1.0f, 1.0f);
  const std::vector<vec3> now = before;
  const auto from_middle = [](std::size_t i) {
    return length(vec2(static_cast<float>(i % 320) - 80.0f, static_cast<float>(i / 320) - 90.0f));
  };
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (from_middle(i) < 30.0f) before[i] *= 1.4f;
  }
  const LookupLevels levels(walls.view, before, now);
  const auto middle = levels.followed(walls.view, walls.pixel(80, 90), kTolerance);
  EXPECT_NEAR(1.4f * middle->factor.x, 1.0f, 0.1f);
  // No edges: averages begin anew nowhere, and neighbours follow alike
  float last = levels.followed(walls.view, walls.pixel(1, 90), kTolerance)->factor.x;
  for (int x = 2; x < 160; ++x) {
    const auto level = levels.followed(walls.view, walls.pixel(x, 90), kTolerance);
    EXPECT_EQ(level->kept, 1.0f) << x;
    EXPECT_NEAR(level->factor.x, last, 0.02f) << x;
    last = level->factor.x;
  }
}

// A pole between the pixels at which levels are found: its own lookups have to tell.
TEST(LookupLevels, AreUnknownForThingsThinnerThanTheyAreApart) {
  const TwoWalls walls(720, 405);
  const LookupLevels levels(walls.view, walls.light(1.0f, 1.0f), walls.light(0.1f, 0.1f));
  ASSERT_GT(levels.pixels_apart(), 1);
  DenoiseView with_pole = walls.view;
  std::vector<float> depths(walls.view.depths.begin(), walls.view.depths.end());
  const std::size_t pole = walls.pixel(levels.pixels_apart() + 1, 10);
  depths[pole] *= 0.5f;
  with_pole.depths = depths;
  EXPECT_TRUE(levels.followed(walls.view, pole, kTolerance));
  EXPECT_FALSE(levels.followed(with_pole, pole, kTolerance));
}

TEST(LookupLevels, FollowLargeChangesAlone) {
  const auto followed = [](float before, float now) { return followed_level(before, now, 0.03f); };
  EXPECT_EQ(followed(1.0f, 1.0f), 1.0f);
  EXPECT_NEAR(followed(1.0f, 1.01f), 1.001f, 1e-3f);
  EXPECT_NEAR(followed(1.0f, 1.0f / 1.03f), 1.0f / 1.015f, 1e-3f);
  EXPECT_NEAR(followed(2.0f, 3.0f), 1.5f, 0.01f);
  EXPECT_NEAR(followed(1.0f, 50.0f), kMaxLevelChange, 0.01f);
  EXPECT_NEAR(followed(1.0f, 0.0f), 1.0f / kMaxLevelChange, 0.01f);
  EXPECT_EQ(followed(0.0f, 0.0f), 1.0f);
}

TEST(LookupLevels, KeepNothingOfOtherLight) {
  const TwoWalls walls(64, 36);
  for (const float change : {0.3f, 0.45f, 2.2f, 3.0f}) {
    const LookupLevels levels(walls.view, walls.light(1.0f, 1.0f), walls.light(change, 1.0f));
    EXPECT_EQ(levels.followed(walls.view, walls.pixel(10, 10), kTolerance)->kept, 0.0f) << change;
    EXPECT_EQ(levels.followed(walls.view, walls.pixel(50, 10), kTolerance)->kept, 1.0f) << change;
  }
}

TEST(LookupLevels, AreOfPixelsThatHaveAHistory) {
  // Half of what the left part showed before is unknown, as where the camera turns
  const TwoWalls walls(64, 36);
  std::vector<float> depths = walls.depths;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (i % 64 < 16) depths[i] = 0.0f;
  }
  DenoiseView known = walls.view;
  known.depths = depths;
  std::vector<vec3> before = walls.light(1.0f, 1.0f);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (depths[i] == 0.0f) before[i] = vec3(0.0f);
  }
  const LookupLevels levels(known, before, walls.light(1.5f, 1.5f));
  EXPECT_NEAR(levels.followed(walls.view, walls.pixel(20, 10), kTolerance)->factor.x, 1.5f, 0.01f);
  EXPECT_FALSE(levels.followed(walls.view, walls.pixel(5, 10), kTolerance));
}

using Blocks = std::vector<double>;

/// A room lit by a spot's patch of light on a wall, and its frames.
struct MovingPatch {
  static constexpr int kWidth = 64, kHeight = 48, kBlock = 4;

  /// Irradiance of a frame once the world has been edited.
  Blocks next() {
    EXPECT_TRUE(world.update());
    return frame();
  }
  Blocks frame() {
    field.update(world);
    return blocks_of(renderer);
  }
  Blocks blocks_of(Renderer& by) const {
    FrameSettings settings = quality_settings(Quality::interactive);
    settings.width = kWidth;
    settings.height = kHeight;
    settings.averaged_frames = 10;
    const RenderedFrame frame = by.render(scene.cameras.at(0), settings).value();
    const Image& image = *frame.image.find("irradiance");
    Blocks blocks(kWidth / kBlock * kHeight / kBlock);
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const int block = i / kWidth / kBlock * (kWidth / kBlock) + i % kWidth / kBlock;
      blocks[static_cast<std::size_t>(block)] += image.pixels[static_cast<std::size_t>(3 * i + 1)];
    }
    return blocks;
  }
  /// Moves the patch by 4 cm.
  void move() {
    scene.lights[0].direction_ws = normalize(vec3(-1.0f, 0.0f, 0.01f * moment));
    moment += 1.0f;
  }

  Scene scene = make();
  World world{scene};
  IrradianceField field = make_field(world);
  Renderer renderer{world, {.field = &field}};
  float moment = 0.0f;

  static Scene make() {
    Scene room = scenes::make("cornell").value();
    for (Material& material : room.materials) material.emission = vec3(0.0f);
    Light& spot = room.lights.emplace_back();
    spot.type = Light::Type::spot;
    spot.position_ws = {4.0f, 3.0f, 2.0f};
    spot.intensity = vec3(200.0f);
    spot.outer_cone_angle = 0.25f;
    spot.inner_cone_angle = 0.2f;
    return room;
  }
  static IrradianceField make_field(const World& world) {
    FieldSettings settings;
    settings.probe_count = ivec3(7);
    IrradianceField field = *IrradianceField::make(settings, open_bounds(world));
    for (int i = 0; i < 8; ++i) field.update(world);
    return field;
  }
};

double total(const Blocks& blocks) {
  return std::accumulate(blocks.begin(), blocks.end(), 0.0);
}

/// Second differences, to which a steady change adds nothing, over the light: of the frames from
/// the seventh on, and all of their blocks.
struct Unrest {
  double median, ninth_decile;
};
Unrest unrest_of(const std::vector<Blocks>& frames) {
  std::vector<double> changes;
  for (std::size_t k = 6; k < frames.size(); ++k) {
    for (std::size_t i = 0; i < frames[k].size(); ++i) {
      if (frames[k][i] <= 0.0) continue;
      changes.push_back(std::abs(frames[k][i] - 2.0 * frames[k - 1][i] + frames[k - 2][i]) /
                        frames[k][i]);
    }
  }
  std::ranges::sort(changes);
  return {changes[changes.size() / 2], changes[changes.size() * 9 / 10]};
}

TEST(LookupLevels, KeepWallsCalmWhileLightMoves) {
  constexpr int kFrames = 14;
  for (const int every : {1, 2}) {
    MovingPatch patch;
    std::vector<Blocks> frames(kFrames);
    for (int i = 0; i < kFrames; ++i) {
      const bool moves = i % every == 0;
      if (moves) patch.move();
      frames[static_cast<std::size_t>(i)] = moves ? patch.next() : patch.frame();
    }
    const Unrest unrest = unrest_of(frames);
    std::printf("moved in every frame of %d: %.4f, ninth decile %.4f\n", every, unrest.median,
                unrest.ninth_decile);
    EXPECT_LT(unrest.median, 0.048) << every;
    // Where averages were discarded by noise, there were stains
    if (every == 1) {
      EXPECT_LT(unrest.ninth_decile, 0.115);
    }
  }
}

TEST(LookupLevels, FollowLightThatFades) {
  MovingPatch patch;
  patch.move();
  Blocks shown;
  for (int i = 0; i < 12; ++i) {
    patch.scene.lights[0].intensity *= 0.95f;
    shown = patch.next();
  }
  Renderer fresh(patch.world, {.field = &patch.field});
  const Blocks now = patch.blocks_of(fresh);
  const double ratio = total(shown) / total(now);
  std::printf("shown over what a first frame shows: %.4f\n", ratio);
  EXPECT_NEAR(ratio, 1.0, 0.06);
}

/// What is shown of light that jumps by a factor, over what a first frame shows.
double shown_after_jump(float change) {
  MovingPatch patch;
  patch.move();
  for (int i = 0; i < 4; ++i) {
    patch.scene.lights[0].intensity *= 1.01f;
    patch.next();
  }
  patch.scene.lights[0].intensity *= change;
  const Blocks shown = patch.next();
  Renderer fresh(patch.world, {.field = &patch.field});
  return total(shown) / total(patch.blocks_of(fresh));
}

// A candle flickers by more than averages can follow. Jumps by a factor of ten end them at each
// pixel, so that the same rays are seen alone: both differ by noise of the field, up to 3 %.
TEST(LookupLevels, FollowLightThatJumps) {
  for (const vec2 jumps : {vec2(0.43f, 0.1f), vec2(2.3f, 10.0f)}) {
    const double shown = shown_after_jump(jumps.x), alone = shown_after_jump(jumps.y);
    std::printf("light times %.2f: %.4f, without averages %.4f\n", jumps.x, shown, alone);
    EXPECT_NEAR(shown / alone, 1.0, 0.05) << jumps.x;
  }
}

}  // namespace
}  // namespace lambent::lookup_levels_test
