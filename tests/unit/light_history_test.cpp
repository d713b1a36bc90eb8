// SPDX-License-Identifier: Apache-2.0
// Light averaged over frames.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/image/metrics.h"
#include "denoise/history_math.h"
#include "lambent/renderer.h"
#include "support/field_scenes.h"

namespace lambent::light_history_test {
namespace {

/// A world that may be edited, and a field that stays as it was.
struct EditedStage {
  explicit EditedStage(const std::string& name) : scene(scenes::make(name).value()), world(scene) {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(4);
    settings.rays_per_probe = 64;
    field.emplace(*IrradianceField::make(settings, open_bounds(world)));
    for (int i = 0; i < 3; ++i) field->update(world);
  }
  Scene scene;
  World world;
  std::optional<IrradianceField> field;
};

FrameSettings averaging(int frames) {
  FrameSettings settings = quality_settings(Quality::interactive);
  settings.width = 64;
  settings.height = 48;
  settings.averaged_frames = frames;
  return settings;
}

double error_of(const RenderedFrame& frame, const RenderedFrame& truth, const char* layer) {
  return compare_images(*frame.image.find(layer), *truth.image.find(layer),
                        {.block = 4, .perceptual = false})
      .value()
      .relative_rmse;
}

/// The picture after so many others of the same camera, of which `kept` at the end are averaged.
RenderedFrame after(const EditedStage& stage, const Camera& camera, int others, int frames) {
  Renderer renderer(stage.world, {.field = &*stage.field});
  for (int i = 0; i < others; ++i) renderer.render(camera, averaging(frames)).value();
  return renderer.render(camera, averaging(frames)).value();
}

class LightHistoryTest : public ::testing::Test {
 protected:
  const Camera& camera() const { return stage.scene.cameras.at(0); }
  RenderedFrame truth_from(const Camera& from) const {
    FrameSettings settings = averaging(1);
    settings.denoise = false;
    settings.gather_rays = settings.emissive_samples = 256;
    Renderer renderer(stage.world, {.field = &*stage.field});
    return renderer.render(from, settings).value();
  }

  EditedStage stage{"cornell"};
};

TEST_F(LightHistoryTest, AveragesNoiseAwayWhereNothingMoves) {
  const RenderedFrame truth = truth_from(camera());
  const RenderedFrame first = after(stage, camera(), 0, 10), later = after(stage, camera(), 15, 10);
  // Direct light has less noise to lose, beside what the filter blurs
  EXPECT_LT(error_of(later, truth, "irradiance"), 0.75 * error_of(first, truth, "irradiance"));
  EXPECT_LT(error_of(later, truth, "direct"), 0.9 * error_of(first, truth, "direct"));
}

TEST_F(LightHistoryTest, FollowsSurfacesThatTheCameraPasses) {
  // Walk along the box, and compare the last picture with one that has no history
  Camera moved = camera();
  Renderer renderer(stage.world, {.field = &*stage.field});
  Renderer without(stage.world, {.field = &*stage.field});
  RenderedFrame averaged, single;
  for (int i = 0; i < 12; ++i) {
    moved.world_from_view[3].x += 0.004f;
    averaged = renderer.render(moved, averaging(10)).value();
    single = without.render(moved, averaging(1)).value();
  }
  const RenderedFrame truth = truth_from(moved);
  EXPECT_LT(error_of(averaged, truth, "irradiance"), 0.85 * error_of(single, truth, "irradiance"));
  EXPECT_LT(error_of(averaged, truth, "direct"), error_of(single, truth, "direct"));
}

TEST(LightHistory, IsLessNoisyBeforeACameraThatMovesThanNeighboursSay) {
  // The error was 0.107 where differences between neighbours were taken for all of the noise
  constexpr double kMaxError = 0.1;
  const Scene scene = scenes::make("two-rooms").value();
  const World world(scene);
  IrradianceField field = IrradianceField::make({}, open_bounds(world)).value();
  for (int i = 0; i < 8; ++i) field.update(world);
  FrameSettings settings = averaging(10);
  settings.width = 160;
  settings.height = 90;
  Camera camera = scene.cameras.at(0);
  Renderer renderer(world, {.field = &field});
  RenderedFrame frame;
  for (int i = 0; i < 16; ++i) {
    camera.world_from_view[3] += 0.02f * camera.world_from_view[0];
    frame = renderer.render(camera, settings).value();
  }
  settings.averaged_frames = 1;
  settings.denoise = false;
  settings.gather_rays = 256;
  Renderer without(world, {.field = &field});
  const RenderedFrame truth = without.render(camera, settings).value();
  const double error = error_of(frame, truth, "irradiance");
  std::printf("irradiance: error %.4f\n", error);
  EXPECT_LT(error, kMaxError);
}

TEST_F(LightHistoryTest, ForgetsLightOnceTheWorldHasChanged) {
  Renderer averaged(stage.world, {.field = &*stage.field});
  Renderer forgetful(stage.world, {.field = &*stage.field});
  for (int i = 0; i < 4; ++i) {
    averaged.render(camera(), averaging(10)).value();
    // One that averages nothing has no history
    forgetful.render(camera(), averaging(1)).value();
  }
  for (Material& material : stage.scene.materials) material.emission *= 0.1f;
  ASSERT_TRUE(stage.world.update());
  // A field that did not follow would tell that light is the same
  stage.field->update(stage.world);
  const RenderedFrame a = averaged.render(camera(), averaging(10)).value();
  const RenderedFrame b = forgetful.render(camera(), averaging(10)).value();
  EXPECT_EQ(a.image.find("")->pixels, b.image.find("")->pixels);
}

TEST_F(LightHistoryTest, ForgetsDifferencesFromLookupsThatHaveChanged) {
  // A field that is four times too bright for a few frames, as by a single ray that met a bright
  // spot
  const std::vector<Material> materials = stage.scene.materials;
  for (Material& material : stage.scene.materials) material.emission *= 4.0f;
  const World bright(stage.scene);
  IrradianceField field = *IrradianceField::make(stage.field->settings(), open_bounds(bright));
  for (int i = 0; i < 3; ++i) field.update(bright);
  stage.scene.materials = materials;
  Renderer renderer(stage.world, {.field = &field});
  for (int i = 0; i < 6; ++i) renderer.render(camera(), averaging(10)).value();
  field = std::move(*stage.field);
  stage.field.emplace(*IrradianceField::make(field.settings(), open_bounds(stage.world)));
  for (int i = 0; i < 3; ++i) stage.field->update(stage.world);
  const RenderedFrame now = renderer.render(camera(), averaging(10)).value();
  EXPECT_LT(error_of(now, truth_from(camera()), "irradiance"), 0.2);
}

TEST_F(LightHistoryTest, SpreadsRareBrightRaysOverFrames) {
  // A lamp a centimetre above the floor, whose bright spot few gathering rays meet
  for (Material& material : stage.scene.materials) material.emission = glm::vec3(0.0f);
  Light& lamp = stage.scene.lights.emplace_back();
  lamp.type = Light::Type::point;
  lamp.position_ws = {0.2f, 0.01f, 0.3f};
  lamp.intensity = glm::vec3(1.0f);
  ASSERT_TRUE(stage.world.update());
  for (int i = 0; i < 16; ++i) stage.field->update(stage.world);
  Renderer renderer(stage.world, {.field = &*stage.field});
  double before = 0.0, greatest = 0.0;
  for (int i = 0; i < 12; ++i) {
    const RenderedFrame frame = renderer.render(camera(), averaging(10)).value();
    double mean = 0.0;
    for (const float value : frame.image.find("irradiance")->pixels) mean += value;
    ASSERT_GT(mean, 0.0);
    // The first frame has no average of other light yet, either
    if (i > 1) greatest = std::max(greatest, std::abs(mean / before - 1.0));
    before = mean;
  }
  EXPECT_LT(greatest, 0.1);
}

TEST_F(LightHistoryTest, RefusesPicturesInPartsOrOfManySamples) {
  const auto refused = [&](auto change) {
    FrameSettings settings = averaging(4);
    change(settings);
    const Expected<void> fine = check(settings);
    return fine ? "" : fine.error().place;
  };
  EXPECT_EQ(refused([](FrameSettings&) {}), "");
  EXPECT_EQ(refused([](FrameSettings& s) { s.averaged_frames = 0; }), "averaged frames");
  EXPECT_EQ(refused([](FrameSettings& s) { s.averaged_frames = 1001; }), "averaged frames");
  EXPECT_EQ(refused([](FrameSettings& s) { s.samples = 2; }), "averaged frames");
  EXPECT_EQ(refused([](FrameSettings& s) { s.denoise = false; }), "averaged frames");
  EXPECT_EQ(refused([](FrameSettings& s) { s.rows = 4; }), "averaged frames");
}

/// A picture of 4 x 3 pixels whose right half is farther away, and whose last row faces another
/// way.
struct SmallFrame {
  float fetch_depth_before(int pixel) const { return pixel % 4 < 2 ? 1.0f : 2.0f; }
  vec3 fetch_normal_before(int pixel) const {
    return pixel / 4 < 2 ? vec3(0.0f, 0.0f, 1.0f) : vec3(1.0f, 0.0f, 0.0f);
  }

#include "denoise/history.inl.h"
};

TEST(LightHistoryMath, FindsTheSameSurfaceAndNoOther) {
  const ivec2 size(4, 3);
  const vec3 facing(0.0f, 0.0f, 1.0f);
  SmallFrame frame;
  const auto taps_at = [&](vec2 place, float depth) {
    return frame.history_taps(size, place, depth, 0.01f, facing);
  };
  // In the middle of a pixel there is that pixel alone
  const HistoryTaps exact = taps_at(vec2(1.5f, 1.5f), 1.0f);
  EXPECT_EQ(exact.pixels[0], 5);
  EXPECT_EQ(exact.weights[0], 1.0f);
  // Between four, all count; at an edge of depth or of normals those of the surface
  const HistoryTaps four = taps_at(vec2(1.0f, 1.0f), 1.0f);
  for (const float weight : four.weights) EXPECT_FLOAT_EQ(weight, 0.25f);
  const HistoryTaps edge = taps_at(vec2(2.0f, 2.0f), 2.0f);
  EXPECT_FLOAT_EQ(edge.weights[1], 1.0f);
  EXPECT_EQ(edge.pixels[1], 6);
  // Nothing is left of another surface, and outside
  EXPECT_FALSE(is_history(taps_at(vec2(1.5f, 1.5f), 1.5f)));
  EXPECT_FALSE(is_history(taps_at(vec2(0.5f, 2.5f), 1.0f)));
  EXPECT_FALSE(is_history(taps_at(vec2(-3.0f, 1.0f), 1.0f)));
}

TEST(LightHistoryMath, KeepsAveragesWhileLookupsStayTheSame) {
  EXPECT_EQ(kept_by_lookup(2.0f, 2.0f), 1.0f);
  EXPECT_EQ(kept_by_lookup(2.0f, 1.8f), 1.0f);
  EXPECT_EQ(kept_by_lookup(1.0f, 3.0f), 0.0f);
  EXPECT_EQ(kept_by_lookup(3.0f, 1.0f), 0.0f);
  EXPECT_EQ(kept_by_lookup(0.0f, 0.0f), 1.0f);
  EXPECT_EQ(kept_by_lookup(0.0f, 1.0f), 0.0f);
  EXPECT_NEAR(kept_by_lookup(1.0f, 0.725f), 0.5f, 1e-5f);
}

TEST(LightHistoryMath, AveragesExcessOverManyFrames) {
  vec3 average(0.0f);
  for (int i = 0; i < 400; ++i) average = averaged_excess(average, vec3(3.0f));
  EXPECT_NEAR(average.x, 3.0f, 1e-3f);
  // A single ray is a small part of what it would be in its frame alone
  EXPECT_LT(averaged_excess(vec3(0.0f), vec3(3.0f)).x, 0.1f);
}

TEST(LightHistoryMath, AveragesVarianceAsThatOfAMean) {
  float variance = 2.0f, frames = 1.0f;
  for (int i = 1; i < 8; ++i) {
    frames = averaged_frames(frames, 100.0f);
    variance = averaged_variance(variance, 2.0f, frames);
    EXPECT_NEAR(variance, 2.0f / frames, 1e-5f);
  }
  EXPECT_EQ(averaged_frames(10.0f, 10.0f), 10.0f);
}

}  // namespace
}  // namespace lambent::light_history_test
