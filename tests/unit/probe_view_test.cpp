// SPDX-License-Identifier: Apache-2.0
#include "compose/probe_view.h"

#include <gtest/gtest.h>

#include "field/field_access.h"
#include "field/probes/probe_store.h"
#include "lambent/renderer.h"
#include "shared/constants.h"
#include "support/field_scenes.h"

namespace lambent::probe_view_test {
namespace {

constexpr int kWidth = 160, kHeight = 120;

class ProbeView : public ::testing::Test {
 protected:
  ProbeView() : field(test::make_field(stage, settings(), 2)) {}

  static FieldSettings settings() {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(4);
    settings.rays_per_probe = 64;
    return settings;
  }

  LayeredImage draw(ProbeAspect aspect, float radius = 0.2f) const {
    FrameSettings frame;
    frame.width = kWidth;
    frame.height = kHeight;
    LayeredImage image = Renderer(stage.world).render(camera(), frame).value().image;
    draw_probes(stage.world, field, camera(), {aspect, radius}, image);
    return image;
  }

  Camera camera() const { return stage.scene.cameras.at(0); }

  /// The pixel in which a point is visible, and its depth along the view axis.
  glm::vec3 project(const glm::vec3& point_ws) const {
    const glm::vec3 p(glm::inverse(camera().world_from_view) * glm::vec4(point_ws, 1.0f));
    const float slope = std::tan(0.5f * camera().vertical_fov);
    return {0.5f * kWidth + 0.5f * kHeight * p.x / (-p.z * slope),
            0.5f * kHeight - 0.5f * kHeight * p.y / (-p.z * slope), -p.z};
  }

  test::Stage stage{"cornell"};
  IrradianceField field;
};

TEST_F(ProbeView, SpheresStandWhereProbesDo) {
  const LayeredImage image = draw(ProbeAspect::state);
  const Image* probes = image.find("probes");
  ASSERT_NE(probes, nullptr);
  int seen = 0, hidden = 0;
  for (int probe = 0; probe < field.probes(); ++probe) {
    const glm::vec3 at = project(store_of(field).probe_position_ws(probe));
    if (at.x < 1 || at.y < 1 || at.x >= kWidth - 1 || at.y >= kHeight - 1) continue;
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    const float scene_depth = image.find("depth")->at(x, y)[0];
    const float margin = 0.2f * field.grids()[0].spacing.x;
    if (at.z < scene_depth - margin) {
      EXPECT_EQ(probes->at(x, y)[3], 1.0f) << probe;
      ++seen;
    } else if (at.z > scene_depth + 2.0f * margin) {
      ++hidden;
    }
  }
  EXPECT_GT(seen, 30);
  EXPECT_GT(hidden, 0);
}

TEST_F(ProbeView, ScenesHideSpheresBehindThem) {
  // A radius that is small enough for spheres not to pass through the wall near them
  constexpr float kInside = 0.05f;
  // From behind the back wall, opposite the open side, nothing of the room is visible
  const Bounds room = world_bounds(stage.scene);
  const glm::vec3 middle = 0.5f * (room.min + room.max);
  const glm::vec3 eye(camera().world_from_view[3]);
  const Camera behind = look_at(2.0f * middle - eye, middle, 0.2f);
  LayeredImage image{32, 32, {{"", Image(32, 32, 3)}}};
  draw_probes(stage.world, field, behind, {ProbeAspect::state, kInside}, image);
  for (const float value : image.find("probes")->pixels) EXPECT_EQ(value, 0.0f);

  const Scene nothing;
  const World open(nothing);
  draw_probes(open, field, behind, {ProbeAspect::state, kInside}, image);
  float covered = 0.0f;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) covered += image.find("probes")->at(x, y)[3];
  }
  EXPECT_GT(covered, 0.0f);
}

TEST_F(ProbeView, ShowsWhatProbesHold) {
  // The camera looks straight at one probe, at the middle of its sphere
  const int probe = 21;
  const glm::vec3 centre = store_of(field).probe_position_ws(probe);
  const glm::vec3 way = glm::normalize(glm::vec3(0.3f, 0.2f, 1.0f));
  const Camera camera = look_at(centre + 0.3f * field.grids()[0].spacing.x * way, centre, 0.02f);
  LayeredImage image{9, 9, {{"", Image(9, 9, 3)}}};
  draw_probes(stage.world, field, camera, {ProbeAspect::irradiance, 0.1f}, image);
  const float* pixel = image.find("probes")->at(4, 4);
  const vec3 expected = store_of(field).irradiance(probe, way) * kInvPi;
  EXPECT_EQ(pixel[3], 1.0f);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(pixel[c], expected[c], 0.02f * expected[c]);
    EXPECT_EQ(image.find("")->at(4, 4)[c], pixel[c]);
  }
}

TEST_F(ProbeView, EveryAspectHasItsColours) {
  const LayeredImage state = draw(ProbeAspect::state), age = draw(ProbeAspect::age);
  const LayeredImage distance = draw(ProbeAspect::distance), light = draw(ProbeAspect::irradiance);
  EXPECT_NE(state.find("probes")->pixels, age.find("probes")->pixels);
  EXPECT_NE(age.find("probes")->pixels, distance.find("probes")->pixels);
  EXPECT_NE(distance.find("probes")->pixels, light.find("probes")->pixels);
  const vec3 colors[] = {probe_state_color(ProbeState::off),
                         probe_state_color(ProbeState::sleeping),
                         probe_state_color(ProbeState::newly_awake),
                         probe_state_color(ProbeState::awake),
                         probe_state_color(ProbeState::newly_vigilant),
                         probe_state_color(ProbeState::vigilant)};
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < i; ++k) EXPECT_GT(glm::distance(colors[i], colors[k]), 0.3f);
  }
}

}  // namespace
}  // namespace lambent::probe_view_test
