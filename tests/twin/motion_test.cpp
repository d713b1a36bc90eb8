// SPDX-License-Identifier: Apache-2.0
// Motion of pixels, and what is anti-aliased by it, is the same on the device as on the processor.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "lambent/renderer.h"
#include "lambent/world.h"
#include "support/moving_scene.h"
#include "support/vulkan_device.h"

namespace lambent::motion_test {
namespace {

constexpr int kWidth = 64, kHeight = 40;

// Both sides meet edges, and chances of what is see-through, that are as close as rounding in other
// pixels.
constexpr int kOtherPixels = kWidth * kHeight / 200;
// Of rounding [pixels].
constexpr float kTolerance = 2e-3f;
// Of what pixels show.
constexpr float kPictureTolerance = 5e-3f;

class Motion : public test::OnDevice {
 protected:
  static Camera camera(float turn) {
    const glm::vec3 eye(3.0f + turn, 2.0f, 7.0f - turn);
    return look_at(eye, {0.2f, 0.9f + 0.3f * turn, 0.0f}, 0.8f);
  }

  /// The third of three pictures of a moving scene, with motion or anti-aliased by it. What is
  /// see-through shows one thing or another by chances that hang on the last bit of a hit: where
  /// pictures are compared, nothing is.
  static LayeredImage frame_of(std::shared_ptr<vulkan::Device> device, int samples,
                               bool antialiased) {
    Scene scene = test::moving_scene(1.0f);
    scene.lights = {test::sun(glm::vec3(3.0f), {0.3f, -1.0f, -0.5f})};
    if (antialiased) scene.materials[1].alpha_mode = AlphaMode::opaque;
    World world(scene, std::move(device));
    Renderer renderer(world);
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.samples = samples;
    settings.motion = !antialiased;
    settings.temporal_antialiasing = antialiased;
    RenderedFrame frame;
    for (const float time : {0.1f, 0.3f, 0.4f}) {
      animate(scene, 0, time);
      EXPECT_TRUE(world.update());
      EXPECT_TRUE(renderer.render(camera(time), settings, frame));
    }
    return frame.image;
  }

  static void expect_alike(int samples) {
    const LayeredImage frame = frame_of(nullptr, samples, false);
    const LayeredImage frame_there = frame_of(shared_device(), samples, false);
    const Image& here = *frame.find("motion");
    const Image& there = *frame_there.find("motion");
    int others = 0, moving = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const float* a = here.at(i % kWidth, i / kWidth);
      const float* b = there.at(i % kWidth, i / kWidth);
      const float length = std::hypot(a[0], a[1]);
      const bool alike = std::isnan(a[0]) ? std::isnan(b[0])
                                          : std::hypot(a[0] - b[0], a[1] - b[1]) <=
                                                kTolerance * std::max(1.0f, length);
      others += alike ? 0 : 1;
      moving += length > 0.1f ? 1 : 0;
    }
    EXPECT_LE(others, kOtherPixels);
    EXPECT_GT(moving, kWidth * kHeight / 2);
  }

  static void expect_alike_pictures(int samples) {
    const LayeredImage frame = frame_of(nullptr, samples, true);
    const LayeredImage frame_there = frame_of(shared_device(), samples, true);
    const Image& here = *frame.find("");
    const Image& there = *frame_there.find("");
    int others = 0, shown = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const float* a = here.at(i % kWidth, i / kWidth);
      const float* b = there.at(i % kWidth, i / kWidth);
      others += std::abs(a[1] - b[1]) > kPictureTolerance * a[1] ? 1 : 0;
      shown += a[1] > 0.0f ? 1 : 0;
    }
    // Each such pixel is a neighbour of eight others in each frame
    EXPECT_LE(others, 9 * kOtherPixels);
    EXPECT_GT(shown, kWidth * kHeight / 2);
  }
};

TEST_F(Motion, OfAMovingSceneIsTheSame) {
  expect_alike(1);
}

TEST_F(Motion, OfTheNearestOfSeveralSamplesIsTheSame) {
  expect_alike(3);
}

TEST_F(Motion, AntialiasesAMovingSceneTheSame) {
  expect_alike_pictures(1);
  expect_alike_pictures(2);
}

}  // namespace
}  // namespace lambent::motion_test
