// SPDX-License-Identifier: Apache-2.0
// Averages of light while parts of the world move.
#include "compose/history/moved_parts.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::moved_parts_test {
namespace {

const Bounds kLamp{{-0.5f, 9.9f, -0.5f}, {0.5f, 10.1f, 0.5f}};
const vec3 kUp(0.0f, 1.0f, 0.0f);

Bounds box_at(const vec3& center, float half) {
  return {center - half, center + half};
}

TEST(MovedParts, CountForLessTheFartherTheyAre) {
  const std::vector<Bounds> moved = {box_at({0.0f, 1.0f, 0.0f}, 0.5f)};
  const MovedParts parts(moved, {});
  EXPECT_EQ(parts.frames_of_surface({0.0f, 0.4f, 0.0f}, kUp), 1.0f);
  const float near = parts.frames_of_surface({1.5f, 0.4f, 0.0f}, kUp);
  const float far = parts.frames_of_surface({2.0f, 0.4f, 0.0f}, kUp);
  EXPECT_GT(near, 1.0f);
  EXPECT_GT(far, near);
  const float most = parts.frames_of_surface({50.0f, 0.4f, 0.0f}, kUp);
  EXPECT_GT(most, far);
  // What is below a surface's horizon sends no light there
  EXPECT_EQ(parts.frames_of_surface({0.0f, 2.5f, 0.0f}, kUp), most);
}

TEST(MovedParts, ContainTheirSurfacesAndNotWhatIsBesideThem) {
  const std::vector<Bounds> moved = {
      {}, {{-2.0f, 1.0f, -2.0f}, {2.0f, 1.2f, 2.0f}}, {{4.0f, 0.0f, 0.0f}, {4.0f, 1.0f, 1.0f}}};
  const MovedParts parts(moved, {});
  EXPECT_TRUE(parts.contain({2.0f, 1.1f, 0.0f}));
  EXPECT_TRUE(parts.contain({0.3f, 1.2f, -1.0f}));
  // A sheet, to within rounding
  EXPECT_TRUE(parts.contain({4.0001f, 0.5f, 0.5f}));
  // A floor below a rotor is within its bounding sphere
  EXPECT_FALSE(parts.contain({0.0f, 0.0f, 0.0f}));
}

TEST(MovedParts, EndAveragesInTheShadowsOfLamps) {
  const std::vector<Bounds> moved = {box_at({0.0f, 6.0f, 0.0f}, 0.1f)}, lamps = {kLamp};
  const MovedParts parts(moved, lamps);
  EXPECT_EQ(parts.frames_of_surface({0.0f, 0.0f, 0.0f}, kUp), 1.0f);
  EXPECT_GT(parts.frames_of_surface({8.0f, 0.0f, 0.0f}, kUp), 4.0f);
  // Above the lamp the part is not in the way
  EXPECT_GT(parts.frames_of_surface({0.0f, 20.0f, 0.0f}, -kUp), 4.0f);
}

TEST(MovedParts, EndAveragesOfLobesThatMayShowThem) {
  const std::vector<Bounds> moved = {box_at({0.0f, 5.0f, 0.0f}, 0.2f)};
  const MovedParts parts(moved, {});
  const auto lobe = [](const vec3& mirror_ws, float alpha, float inverse_distance) {
    return LobeGuide{mirror_ws, vec3(0.0f), 1.0f / (alpha * alpha), inverse_distance};
  };
  const vec3 place(0.0f), aside = normalize(vec3(1.0f, 1.0f, 0.0f));
  EXPECT_EQ(parts.frames_of_lobe(place, lobe(kUp, 0.01f, 0.05f)), 1.0f);
  // A wall hides the part, or the mirror faces elsewhere, unless its lobe is wide
  EXPECT_GT(parts.frames_of_lobe(place, lobe(kUp, 0.01f, 1.0f)), 4.0f);
  EXPECT_GT(parts.frames_of_lobe(place, lobe(aside, 0.01f, 0.05f)), 4.0f);
  EXPECT_EQ(parts.frames_of_lobe(place, lobe(aside, 0.4f, 0.05f)), 1.0f);
  // What the mirror shows is just beside the part
  const vec3 past = normalize(vec3(0.15f, 1.0f, 0.0f));
  EXPECT_LT(parts.frames_of_lobe(place, lobe(past, 0.01f, 0.2f)), 8.0f);
  EXPECT_GT(parts.frames_of_lobe(place, lobe(past, 0.01f, 0.2f)), 1.0f);
}

TEST(MovedParts, AreUnknownWhereEditsRelight) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f))};
  test::add_room(scene, 4.0f, 0);
  World world(scene);
  EXPECT_TRUE(moved_since(world, 0));
  scene.instances[0].world_from_object[3].y -= 1.0f;
  ASSERT_TRUE(world.update());
  EXPECT_TRUE(moved_since(world, 0));
  scene.environment.radiance = glm::vec3(2.0f);
  ASSERT_TRUE(world.update());
  EXPECT_FALSE(moved_since(world, 0));
  EXPECT_TRUE(moved_since(world, 2));
  EXPECT_FALSE(moved_since(world, 7));
}

/// The error of a layer against the same without noise.
double error_of(const RenderedFrame& frame, const RenderedFrame& truth, const char* layer) {
  return compare_images(*frame.image.find(layer), *truth.image.find(layer),
                        {.block = 4, .perceptual = false})
      .value()
      .relative_rmse;
}

TEST(MovedParts, LeaveAveragesElsewhereAsTheyAre) {
  Scene scene = scenes::make("cornell").value();
  // The last instance, a block, becomes small, and moves along the floor
  glm::mat4& block = scene.instances.back().world_from_object;
  block = glm::mat4(glm::mat3(0.3f)) * block;
  World world(scene);
  FieldSettings of_field;
  of_field.probe_count = glm::ivec3(6);
  of_field.rays_per_probe = 64;
  IrradianceField field = *IrradianceField::make(of_field, open_bounds(world));
  for (int i = 0; i < 3; ++i) field.update(world);
  FrameSettings settings = quality_settings(Quality::interactive);
  settings.width = 64;
  settings.height = 48;
  FrameSettings single = settings;
  settings.averaged_frames = 16;
  single.averaged_frames = 1;
  const Camera& camera = scene.cameras.at(0);
  FrameSettings exact = single;
  exact.denoise = false;
  exact.samples = 64;
  exact.gather_rays = exact.emissive_samples = 4;
  exact.seed = 2;
  Renderer averaging(world, {.field = &field}), alone(world, {.field = &field});
  // A single frame's error is chance
  constexpr int kFrames = 12, kCompared = 6;
  const char* const layers[] = {"irradiance", "direct"};
  double now[2] = {}, before[2] = {};
  for (int i = 0; i < kFrames; ++i) {
    block[3].x += 0.01f;
    ASSERT_TRUE(world.update());
    field.update(world);
    single.seed = 10 + static_cast<std::uint32_t>(i);
    const RenderedFrame averaged = averaging.render(camera, settings).value();
    const RenderedFrame without = alone.render(camera, single).value();
    if (i < kFrames - kCompared) continue;
    const RenderedFrame truth = Renderer(world, {.field = &field}).render(camera, exact).value();
    for (int k = 0; k < 2; ++k) {
      now[k] += error_of(averaged, truth, layers[k]) / kCompared;
      before[k] += error_of(without, truth, layers[k]) / kCompared;
    }
  }
  for (int k = 0; k < 2; ++k) {
    std::printf("%s: error %.4f, %.4f without averages\n", layers[k], now[k], before[k]);
    // Edges that single samples miss are most of the error of direct light
    EXPECT_LT(now[k], (k == 0 ? 0.85 : 1.02) * before[k]) << layers[k];
  }
}

TEST(MovedParts, ShowWhatTheirRaysBringThoughTheFieldLags) {
  // A field that is nearly dark, so that rays bring more than its lookups by far
  Scene scene = scenes::make("cornell").value();
  const std::vector<Material> materials = scene.materials;
  for (Material& material : scene.materials) material.emission *= 1e-3f;
  World world(scene);
  FieldSettings of_field;
  of_field.probe_count = glm::ivec3(4);
  of_field.rays_per_probe = 64;
  IrradianceField field = *IrradianceField::make(of_field, open_bounds(world));
  field.update(world);
  scene.materials = materials;
  ASSERT_TRUE(world.update());
  FrameSettings settings = quality_settings(Quality::interactive);
  settings.width = 64;
  settings.height = 48;
  Renderer renderer(world, {.field = &field});
  const auto mean_light = [&](int frames) {
    settings.averaged_frames = frames;
    const RenderedFrame frame = renderer.render(scene.cameras.at(0), settings).value();
    double sum = 0.0;
    for (const float value : frame.image.find("irradiance")->pixels) sum += value;
    return sum;
  };
  const double whole = mean_light(1), still = mean_light(16);
  scene.instances.back().world_from_object[3].x += 0.01f;
  ASSERT_TRUE(world.update());
  // The block's light is there at once, that of the walls as slowly as before
  const double moved = mean_light(16);
  EXPECT_LT(still, 0.1 * whole);
  EXPECT_GT(moved, still + 0.05 * whole);
  EXPECT_LT(moved, 0.5 * whole);
  // Once it rests, its average goes on from the frames before: that one frame does not stay
  const double rested = mean_light(16);
  EXPECT_LT(rested, moved);
}

}  // namespace
}  // namespace lambent::moved_parts_test
