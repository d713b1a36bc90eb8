// SPDX-License-Identifier: Apache-2.0
// Views at rest are shown at the size that was asked for, however slow the machine is.
#include "stream/picture/still_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/image/metrics.h"
#include "core/image/tone_map.h"
#include "lambent/renderer.h"
#include "raytracing/camera_rays.h"
#include "stream/picture/h264.h"
#include "stream/server/picture_maker.h"
#include "support/served_scene.h"

namespace lambent::stream::still_picture_test {
namespace {

using test::ServedScene;

Camera some_camera() {
  return look_at({1.0f, 2.0f, -3.0f}, {2.0f, 1.0f, 4.0f}, 0.9f);
}

/// That rays of a part's pixels are those of the whole picture.
void expect_same_rays(const Camera& camera) {
  const Camera part = camera_of_part(camera, {320, 200}, {200, -16}, {128, 96});
  for (const glm::vec2 pixel : {glm::vec2(0.5f), glm::vec2(64.0f, 48.0f), glm::vec2(120, 3)}) {
    const Ray ours = camera_ray(part, 128, 96, pixel.x, pixel.y);
    const Ray whole = camera_ray(camera, 320, 200, pixel.x + 200.0f, pixel.y - 16.0f);
    EXPECT_LT(glm::distance(ours.direction, whole.direction), 1e-5f);
    EXPECT_LT(glm::distance(ours.origin, whole.origin), 1e-5f);
  }
}

TEST(StillPicture, ThePartsOfACameraSeeWhatItSeesThere) {
  expect_same_rays(some_camera());
  Camera parallel = some_camera();
  parallel.orthographic = true;
  parallel.vertical_extent = 5.0f;
  expect_same_rays(parallel);
}

TEST(StillPicture, ItsTilesCoverItAndAreShownOnceTheyAreComplete) {
  Image small(40, 30, 3);
  std::fill(small.pixels.begin(), small.pixels.end(), 0.25f);
  StillPicture still(some_camera(), small, {321, 203}, {40, 30});
  EXPECT_EQ(still.image().width, 321);
  EXPECT_EQ(still.image().height, 203);
  EXPECT_NEAR(still.image().at(320, 202)[2], 0.25f, 1e-6f) << "begins with what was shown";
  Image tile(static_cast<int>(still.tile_size().x), static_cast<int>(still.tile_size().y), 3);
  std::fill(tile.pixels.begin(), tile.pixels.end(), 1.0f);
  int pictures = 0, tiles = 0;
  while (!still.done()) {
    ASSERT_LT(++pictures, 1000);
    if (still.add(tile)) ++tiles;
  }
  EXPECT_GT(tiles, 4);
  EXPECT_GT(pictures, 4 * tiles) << "noise is averaged";
  EXPECT_EQ(std::count(still.image().pixels.begin(), still.image().pixels.end(), 1.0f),
            std::ptrdiff_t{321} * 203 * 3);
}

/// An image whose pixels are repeated so often along each edge.
Image repeated(const Image& image, int times) {
  Image large(times * image.width, times * image.height, image.channels);
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) {
      std::copy_n(image.at(x / times, y / times), image.channels, large.at(x, y));
    }
  }
  return large;
}

double rmse(const Image& a, const Image& b) {
  const auto metrics = compare_images(a, b);
  return metrics ? metrics->rmse : 1.0;
}

/// Pictures that a machine on which no size is fast enough makes of the Cornell box at rest.
class SlowPictures : public ::testing::Test {
 protected:
  SlowPictures()
      : scene(*scenes::make("cornell-spot")),
        world(scene),
        field(*IrradianceField::make(ServedScene::small_field(), open_bounds(world))) {
    field.update(world);
    settings = ServedScene::small_settings().world.pictures;
    settings.limits.picture_ms = 1e-3;
    settings.frame.temporal_antialiasing = true;
  }
  Hello hello() const {
    Hello hello;
    hello.size = {320, 240};
    return hello;
  }
  /// Makes pictures until no more are due, and decodes them.
  std::vector<Image> watch(PictureMaker& maker) const {
    const WorldState state{1, 1};
    PictureDecoder decoder = *PictureDecoder::make();
    std::vector<Image> pictures;
    for (int i = 0; i < 500 && maker.due(state); ++i) {
      const auto picture = maker.make(state, Clock::now());
      if (!picture) return {};
      if (!*picture) continue;
      const auto decoded = decoder.decode((*picture)->bytes);
      if (!decoded) return {};
      pictures.push_back(to_display(*decoded));
    }
    EXPECT_FALSE(maker.due(state));
    return pictures;
  }

  const Scene scene;
  const World world;
  IrradianceField field;
  PictureSettings settings;
};

TEST_F(SlowPictures, ShowAViewAtRestAtTheSizeThatWasAskedFor) {
  PictureMaker maker(world, field, settings, scene.cameras.front(), hello());
  ClientInputs received;
  // The path has room for more bits than the first pictures have
  received.arrivals.assign(60, {20.0, 2.0});
  maker.follow(received);
  const std::vector<Image> pictures = watch(maker);
  const auto first_large =
      std::ranges::find_if(pictures, [](const Image& image) { return image.width > 80; });
  ASSERT_NE(first_large, pictures.end());
  ASSERT_EQ(pictures.back().width, 320);
  ASSERT_EQ(pictures.back().height, 240);
  EXPECT_GE(first_large - pictures.begin(), 16) << "small ones settle first";

  Renderer renderer(world, IndirectSources{&field});
  FrameSettings frame = settings.frame;
  frame.temporal_antialiasing = false;
  frame.width = 320;
  frame.height = 240;
  frame.samples = 8;
  const auto whole = renderer.render(scene.cameras.front(), frame);
  ASSERT_TRUE(whole);
  const Image ours = display_image(*whole->image.find(""), ToneMap::aces, 0.0f);
  const double small_error = rmse(repeated(*(first_large - 1), 4), ours);
  EXPECT_LT(rmse(pictures.back(), ours), 0.5 * small_error);
  // Where the client looks elsewhere, small pictures come again
  ClientInputs inputs;
  inputs.camera = input_of(scene.cameras.front());
  maker.follow(inputs);
  const std::vector<Image> again = watch(maker);
  ASSERT_FALSE(again.empty());
  EXPECT_EQ(again.front().width, 80);
  EXPECT_EQ(again.back().width, 320);
}

}  // namespace
}  // namespace lambent::stream::still_picture_test
