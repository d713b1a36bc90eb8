// SPDX-License-Identifier: Apache-2.0
// Temporal anti-aliasing, of pictures that are rendered.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "lambent/renderer.h"
#include "lambent/world.h"
#include "support/hand_made.h"
#include "temporal/taa.h"

namespace lambent::taa_test {
namespace {

constexpr int kWidth = 64, kHeight = 48;

FrameSettings frame_settings(bool antialiased, int samples = 1) {
  FrameSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples = samples;
  settings.temporal_antialiasing = antialiased;
  return settings;
}

/// Surfaces that shine by themselves: what they show is known, and has no noise.
Material shining(const glm::vec3& radiance) {
  Material material;
  material.unlit = true;
  material.base_color = glm::vec4(radiance, 1.0f);
  return material;
}

/// A grey wall at z = 0 with dark stripes that stand on end, and a bright bar in front of it.
enum Place : int { kWall = 0, kBar = 1, kFirstStripe = 2 };
Scene striped_wall(int stripes) {
  Scene scene;
  scene.materials = {shining(glm::vec3(0.4f)), shining(glm::vec3(0.1f)), shining(glm::vec3(1.0f))};
  test::add(scene, test::quad({-20.0f, -20.0f, 0.0f}, {40, 0, 0}, {0, 40, 0}, 0));
  test::add(scene, test::quad({-0.3f, -0.6f, 0.0f}, {0.6f, 0, 0}, {0, 1.2f, 0}, 2));
  for (int i = 0; i < stripes; ++i) {
    const float x = -3.0f + 0.4f * static_cast<float>(i);
    test::add(scene, test::quad({x, -3.0f, 0.05f}, {0.17f, 0.3f, 0}, {0, 6.0f, 0}, 1));
  }
  return scene;
}
void put_bar(Scene& scene, float x) {
  scene.instances[kBar].world_from_object = glm::translate(glm::mat4(1.0f), {x, 0.0f, 0.5f});
}

/// Looks at the wall from 5 m, from `x` on.
Camera camera_at(float x) {
  return look_at({x, 0.1f, 5.0f}, {x, 0.0f, 0.0f}, 0.7f);
}

Image picture_of(Renderer& renderer, const Camera& camera, const FrameSettings& settings) {
  return *renderer.render(camera, settings).value().image.find("");
}
/// The mean of many samples.
Image truth_of(const World& world, const Camera& camera, int samples = 100) {
  Renderer renderer(world);
  return picture_of(renderer, camera, frame_settings(false, samples));
}

double rmse(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double d = static_cast<double>(a.pixels[i]) - b.pixels[i];
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}
float largest_difference(const Image& a, const Image& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
  }
  return largest;
}

TEST(Taa, SmoothsEdgesOfAPictureAtRestAsManySamplesDo) {
  const Scene scene = striped_wall(15);
  const World world(scene);
  const Image truth = truth_of(world, camera_at(0.0f));
  Renderer renderer(world);
  const double raw = rmse(picture_of(renderer, camera_at(0.0f), frame_settings(false)), truth);
  Image filtered, before;
  for (int i = 0; i < 32; ++i) {
    before = std::move(filtered);
    filtered = picture_of(renderer, camera_at(0.0f), frame_settings(true));
  }
  EXPECT_LT(rmse(filtered, truth), 0.25 * raw);
  // ... and hardly flickers: a frame counts for a 32nd, and edges are between 0.1 and 1
  EXPECT_LT(largest_difference(filtered, before), 0.9f / 32.0f);
  EXPECT_LT(rmse(filtered, before), 0.004);
}

TEST(Taa, SmoothsEdgesUnderACameraThatWalks) {
  // Stripes two pixels wide are the hardest there is: what is fetched between pixels blurs them
  const Scene scene = striped_wall(15);
  const World world(scene);
  Renderer raw(world), filtered(world);
  double raw_error = 0.0, filtered_error = 0.0;
  for (int i = 0; i < 16; ++i) {
    // Not a whole number of pixels: the history is fetched between them
    const Camera camera = camera_at(0.017f * static_cast<float>(i));
    const Image a = picture_of(raw, camera, frame_settings(false));
    const Image b = picture_of(filtered, camera, frame_settings(true));
    if (i < 8) continue;
    const Image truth = truth_of(world, camera);
    raw_error += rmse(a, truth);
    filtered_error += rmse(b, truth);
  }
  EXPECT_LT(filtered_error, 0.75 * raw_error);
}

TEST(Taa, DrawsNoDarkDashesBesideALampUnderACameraThatWalks) {
  Scene scene = striped_wall(0);
  scene.materials[2] = test::lambert(glm::vec3(0.0f), glm::vec3(900.0f));
  const World world(scene);
  Renderer renderer(world);
  for (int i = 0; i < 12; ++i) {
    const Image picture =
        picture_of(renderer, camera_at(0.017f * static_cast<float>(i)), frame_settings(true));
    const float darkest = *std::ranges::min_element(picture.pixels);
    EXPECT_GT(darkest, 0.7f * 0.4f) << i;
  }
}

/// Whether the bar is not seen in a pixel nor beside it, where its edge may lie.
bool is_off_bar(const Image& truth, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int there_x = std::clamp(x + dx, 0, kWidth - 1);
      const int there_y = std::clamp(y + dy, 0, kHeight - 1);
      if (truth.at(there_x, there_y)[0] > 0.41f) return false;
    }
  }
  return true;
}

/// What is too bright where the bar is not.
float ghost(const Image& picture, const Image& truth) {
  float largest = 0.0f;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (!is_off_bar(truth, x, y)) continue;
      largest = std::max(largest, picture.at(x, y)[0] - std::max(truth.at(x, y)[0], 0.4f));
    }
  }
  return largest;
}

TEST(Taa, LeavesNoGhostsBehindABrightBarThatMoves) {
  Scene scene = striped_wall(0);
  World world(scene);
  Renderer renderer(world);
  // Where the bar is seen by less than one in so many samples it is seen whole in the pixel beside
  constexpr int kSamples = 25;
  for (const float step : {0.03f, 0.11f, 0.4f}) {
    for (int i = 0; i < 8; ++i) {
      put_bar(scene, -1.0f + step * static_cast<float>(i));
      ASSERT_TRUE(world.update());
      const Image picture = picture_of(renderer, camera_at(0.0f), frame_settings(true));
      if (i == 0) continue;
      EXPECT_LT(ghost(picture, truth_of(world, camera_at(0.0f), kSamples)), 0.02f) << step;
    }
  }
}

TEST(Taa, LeavesNoOutlineOfABarThatBeginsToMove) {
  Scene scene = striped_wall(0);
  put_bar(scene, -1.0f);
  World world(scene);
  Renderer renderer(world);
  for (int i = 0; i < 7; ++i) picture_of(renderer, camera_at(0.0f), frame_settings(true));
  for (int i = 1; i < 4; ++i) {
    put_bar(scene, -1.0f + 0.8f * static_cast<float>(i));
    ASSERT_TRUE(world.update());
    const Image picture = picture_of(renderer, camera_at(0.0f), frame_settings(true));
    EXPECT_LT(ghost(picture, truth_of(world, camera_at(0.0f), 25)), 0.02f) << i;
  }
}

TEST(Taa, LeavesNoGhostsInFrontOfStripes) {
  // The same twice, once with the bar out of sight: what differs where it no longer is, it has left
  const auto pictures_from = [](float first_x) {
    Scene scene = striped_wall(15);
    World world(scene);
    Renderer renderer(world);
    std::vector<Image> pictures;
    for (int i = 0; i < 14; ++i) {
      put_bar(scene, first_x + 0.15f * static_cast<float>(i));
      EXPECT_TRUE(world.update());
      pictures.push_back(picture_of(renderer, camera_at(0.0f), frame_settings(true)));
    }
    return pictures;
  };
  const std::vector<Image> with = pictures_from(-1.0f), without = pictures_from(-15.0f);
  const auto brighter = [&](std::size_t frame, int x, int y) {
    return static_cast<double>(with[frame].at(x, y)[0]) - without[frame].at(x, y)[0];
  };
  // The bar moves by two pixels a frame: eight after four
  const std::size_t now = with.size() - 1;
  double left = 0.0, was = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < 40; ++x) {
      const double then = brighter(now - 4, x, y);
      if (then < 0.5 || brighter(now - 1, x, y) > 0.3) continue;
      was += then;
      left += brighter(now, x, y);
    }
  }
  EXPECT_GT(was, 20.0);
  // What was hidden begins anew, and is darker as often as brighter
  EXPECT_LT(std::abs(left), 0.02 * was);
}

TEST(Taa, ForgetsEverythingAtACut) {
  Scene scene = striped_wall(15);
  for (const float away : {50.0f, -50.0f}) {
    test::add(scene, test::quad({-20.0f, -20.0f, away}, {0, 40, 0}, {40, 0, 0}, 2));
  }
  const World world(scene);
  const auto after = [&](const Camera& first) {
    Renderer renderer(world);
    picture_of(renderer, first, frame_settings(true));
    return picture_of(renderer, camera_at(0.0f), frame_settings(true));
  };
  // What came before was other things altogether; a picture of the same would be kept
  const Image a = after(look_at({0.0f, 0.0f, 6.0f}, {0.0f, 0.0f, 50.0f}, 0.7f));
  const Image b = after(look_at({0.0f, 0.0f, -6.0f}, {0.0f, 0.0f, -50.0f}, 0.7f));
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_NE(a.pixels, after(camera_at(0.0f)).pixels);
}

TEST(Taa, ForgetsEverythingAtAChangeOfSizeAndAfterAPictureWithoutIt) {
  const Scene scene = striped_wall(15);
  const World world(scene);
  Renderer fresh(world), used(world);
  const Image first = picture_of(fresh, camera_at(0.0f), frame_settings(true));
  FrameSettings larger = frame_settings(true);
  larger.width = 70;
  picture_of(used, camera_at(0.0f), larger);
  EXPECT_EQ(picture_of(used, camera_at(0.0f), frame_settings(true)).pixels, first.pixels);
  picture_of(used, camera_at(0.0f), frame_settings(false));
  EXPECT_EQ(picture_of(used, camera_at(0.0f), frame_settings(true)).pixels, first.pixels);
}

TEST(Taa, FollowsLightThatGoesOut) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.7f)), test::lambert(glm::vec3(0.2f))};
  test::add(scene, test::quad({-20.0f, -20.0f, 0.0f}, {40, 0, 0}, {0, 40, 0}, 0));
  for (int i = 0; i < 15; ++i) {
    const float x = -3.0f + 0.4f * static_cast<float>(i);
    test::add(scene, test::quad({x, -3.0f, 0.05f}, {0.17f, 0.3f, 0}, {0, 6.0f, 0}, 1));
  }
  scene.lights = {test::sun(glm::vec3(10.0f), {0.3f, -0.2f, -1.0f})};
  World world(scene);
  Renderer renderer(world);
  Image lit;
  for (int i = 0; i < 16; ++i) lit = picture_of(renderer, camera_at(0.0f), frame_settings(true));
  scene.lights[0].intensity *= 0.01f;
  ASSERT_TRUE(world.update());
  Image dark;
  for (int i = 0; i < 4; ++i) dark = picture_of(renderer, camera_at(0.0f), frame_settings(true));
  const Image truth = truth_of(world, camera_at(0.0f));
  EXPECT_LT(largest_difference(dark, truth), 0.02f * largest_difference(lit, truth));
}

TEST(Taa, FiltersThePictureAlone) {
  const Scene scene = striped_wall(15);
  const World world(scene);
  Renderer one(world), other(world);
  picture_of(one, camera_at(0.0f), frame_settings(true));
  picture_of(other, camera_at(0.1f), frame_settings(true));
  const LayeredImage a = one.render(camera_at(0.05f), frame_settings(true)).value().image;
  const LayeredImage b = other.render(camera_at(0.05f), frame_settings(true)).value().image;
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    const bool same = a.layers[i].image.pixels == b.layers[i].image.pixels;
    EXPECT_EQ(same, !a.layers[i].name.empty()) << a.layers[i].name;
  }
}

TEST(Taa, KeepsTheMeanOfGrain) {
  // A lamp that lights a floor by few draws: the mean over frames is that of one picture of many
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.6f)),
                     test::lambert(glm::vec3(0.0f), glm::vec3(8.0f))};
  test::add(scene, test::quad({-20.0f, -20.0f, 0.0f}, {40, 0, 0}, {0, 40, 0}, 0));
  test::add(scene, test::quad({-1.0f, 2.5f, 1.0f}, {0, 0, 2}, {2, 0, 0}, 1));
  const World world(scene);
  const auto mean = [](const Image& image) {
    double sum = 0.0;
    for (const float value : image.pixels) sum += value;
    return sum / static_cast<double>(image.pixels.size());
  };
  Renderer renderer(world);
  FrameSettings settings = frame_settings(true);
  settings.emissive_samples = 1;
  Image filtered;
  for (int i = 0; i < 32; ++i) {
    settings.seed = static_cast<std::uint32_t>(i);
    filtered = picture_of(renderer, camera_at(0.0f), settings);
  }
  EXPECT_NEAR(mean(filtered) / mean(truth_of(world, camera_at(0.0f))), 1.0, 0.02);
}

TEST(Taa, IsRefusedOfPartsOfAPicture) {
  const Scene scene = striped_wall(1);
  const World world(scene);
  Renderer renderer(world);
  FrameSettings part = frame_settings(true);
  part.rows = 8;
  const Expected<RenderedFrame> frame = renderer.render(camera_at(0.0f), part);
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().place, "temporal antialiasing");
}

TEST(TaaMath, WeightsOfCatmullAndRomReproduceLines) {
  for (const float t : {0.0f, 0.2f, 0.5f, 0.9f}) {
    const glm::vec4 w = catmull_rom_weights(t);
    EXPECT_NEAR(w.x + w.y + w.z + w.w, 1.0f, 1e-6f);
    EXPECT_NEAR(-w.x + w.z + 2.0f * w.w, t, 1e-6f);
  }
}

TEST(TaaMath, CompressionAndChromaAreUndone) {
  for (const glm::vec3 radiance : {glm::vec3(0.0f), glm::vec3(0.3f, 0.2f, 0.9f), glm::vec3(1e3f)}) {
    const glm::vec3 compressed = compress_radiance(radiance, 5.0f);
    EXPECT_LT(luminance(compressed), kHalfWeightOverMean);
    const glm::vec3 back = expand_radiance(rgb_from_ycocg(ycocg_from_rgb(compressed)), 5.0f);
    EXPECT_LE(glm::distance(back, radiance), 1e-3f * glm::length(radiance));
  }
}

TEST(TaaMath, JitterVisitsEachSixteenthOnceInSixteenFrames) {
  for (unsigned first = 0; first < 320; first += 16) {
    int counts[16] = {};
    for (unsigned i = first; i < first + 16; ++i) {
      const glm::vec2 at = jitter_position(i);
      ASSERT_TRUE(at.x >= 0.0f && at.x < 1.0f && at.y >= 0.0f && at.y < 1.0f);
      ++counts[4 * static_cast<int>(4.0f * at.y) + static_cast<int>(4.0f * at.x)];
    }
    for (const int count : counts) EXPECT_EQ(count, 1);
  }
}

TEST(TaaMath, JitterKeepsStepWithNoSpeed) {
  // Of sixteen frames in a row, what moves by `speed` pixels a frame is sampled on both its halves
  for (int speed = -20; speed <= 20; ++speed) {
    for (unsigned first = 0; first < 320; first += 16) {
      int on_left = 0;
      for (unsigned i = first; i < first + 16; ++i) {
        const double moved = 0.05 * speed * i;
        const double at = static_cast<double>(jitter_position(i).x) + moved;
        on_left += at - std::floor(at) < 0.5 ? 1 : 0;
      }
      EXPECT_TRUE(on_left >= 2 && on_left <= 14) << "speed " << 0.05 * speed << ", from " << first;
    }
  }
}

TEST(TemporalAntialiasing, DoesNotSpreadWhatIsNoNumber) {
  constexpr int kSide = 9;
  const std::vector<PixelMotion> motion(kSide * kSide, {glm::vec2(0.3f), 1.0f, 1.0f, 1u});
  TaaSequence sequence;
  TemporalAntialiasing antialiasing;
  for (int frame = 0; frame < 4; ++frame) {
    Image picture(kSide, kSide, 3);
    std::fill(picture.pixels.begin(), picture.pixels.end(), 0.5f);
    picture.at(4, 4)[frame % 3] = frame % 2 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                                 : std::numeric_limits<float>::infinity();
    sequence.advance(kSide, kSide, {.moved = true});
    antialiasing.resolve(sequence.frame(), motion, picture);
    for (const float value : picture.pixels) ASSERT_TRUE(value >= 0.0f && value <= 0.6f) << frame;
    EXPECT_NEAR(picture.at(0, 4)[1], 0.5f, 1e-3f);
  }
}

}  // namespace
}  // namespace lambent::taa_test
