// SPDX-License-Identifier: Apache-2.0
// Unlit surfaces: at which radiance the camera sees them, and what that leaves alone.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "compose/unlit.h"
#include "core/image/tone_map.h"
#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/world.h"
#include "reference/path_tracer.h"
#include "support/unlit_scene.h"

namespace lambent::unlit_test {
namespace {

constexpr int kSize = 16;
const glm::vec3 kColor(0.5f, 0.25f, 0.125f);

glm::vec3 pixel(const Image& image, float share_of_width) {
  const float* at = image.at(static_cast<int>(share_of_width * kSize), kSize / 2);
  return {at[0], at[1], at[2]};
}

FrameSettings frame_of(float unlit_radiance) {
  FrameSettings frame;
  frame.width = frame.height = kSize;
  frame.unlit_radiance = unlit_radiance;
  return frame;
}

TEST(Unlit, IsSeenAtTheRadianceThatTheFrameAsksFor) {
  const Scene scene = test::scene_with_sign(kColor, 100.0f);
  ASSERT_TRUE(shows_unlit(scene));
  const World world(scene);
  IrradianceField field = *IrradianceField::make({}, world_bounds(scene));
  for (int i = 0; i < 4; ++i) field.update(world);
  Renderer renderer(world, IndirectSources{&field});
  const Image one = *renderer.render(scene.cameras[0], frame_of(1.0f))->image.find("");
  const Image eight = *renderer.render(scene.cameras[0], frame_of(8.0f))->image.find("");
  EXPECT_EQ(pixel(one, test::kSignX), kColor);
  EXPECT_EQ(pixel(eight, test::kSignX), 8.0f * kColor);
  // What the sign lights does not know of it
  EXPECT_GT(pixel(one, test::kFloorX).x, 0.0f);
  EXPECT_EQ(pixel(one, test::kFloorX), pixel(eight, test::kFloorX));
}

TEST(Unlit, IsSeenByTheReferenceAlike) {
  const Scene scene = test::scene_with_sign(kColor, 100.0f);
  const World world(scene);
  ReferenceSettings settings;
  settings.width = settings.height = kSize;
  settings.samples = 4;
  const Image one = *render_reference(world, scene.cameras[0], settings).image.find("");
  settings.unlit_radiance = 8.0f;
  const Image eight = *render_reference(world, scene.cameras[0], settings).image.find("");
  EXPECT_EQ(pixel(eight, test::kSignX), 8.0f * kColor);
  EXPECT_EQ(pixel(one, test::kFloorX), pixel(eight, test::kFloorX));
}

TEST(Unlit, RadianceIsChecked) {
  for (const float bad : {-1.0f, 2e10f, std::numeric_limits<float>::quiet_NaN()}) {
    const Expected<void> fine = check(frame_of(bad));
    ASSERT_FALSE(fine);
    EXPECT_EQ(fine.error().place, "unlit radiance");
  }
}

TEST(Unlit, ColorsShowAsTheyAreAtAnyExposure) {
  for (const ToneMap curve : {ToneMap::linear, ToneMap::aces, ToneMap::neutral}) {
    for (const float stops : {-9.0f, 0.0f, 4.5f}) {
      const float radiance = radiance_of_colors(curve, stops);
      const auto shown = [&](float grey) {
        Image image(1, 1, 3);
        image.pixels.assign(3, grey * radiance);
        return display_image(image, curve, stops).pixels[1];
      };
      // Mid-grey, sRGB-encoded; others but for the contrast that curves are for
      EXPECT_NEAR(shown(0.18f), 0.4614f, 1e-3f);
      EXPECT_NEAR(shown(0.5f), 0.735f, 0.06f);
      EXPECT_NEAR(shown(0.05f), 0.2475f, 0.09f);
      EXPECT_GT(shown(1.0f), 0.84f);
    }
  }
}

}  // namespace
}  // namespace lambent::unlit_test
