// SPDX-License-Identifier: Apache-2.0
// Reflections averaged over frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "compose/glossy/coat_history.h"
#include "core/image/metrics.h"
#include "denoise/atrous_pass.h"
#include "lambent/renderer.h"
#include "raytracing/camera_rays.h"
#include "support/field_scenes.h"

namespace lambent::coat_history_test {
namespace {

constexpr ivec2 kSize(48, 32);
constexpr std::size_t kPixels = std::size_t{48} * 32;

/// A camera above a floor (y = 0), looking forward and down.
Camera camera_at(float x) {
  return look_at({x, 1.0f, 0.0f}, {x, 0.4f, -1.0f}, 0.6f);
}

/// A frame of a floor that reflects a picture at some distance from the floor, along lobes.
struct ReflectingFloor {
  ReflectingFloor(const Camera& camera, float alpha, float distance)
      : positions_ws(kPixels),
        normals_ws(kPixels, vec3(0.0f, 1.0f, 0.0f)),
        to_viewer_ws(kPixels),
        light(kPixels),
        depths(kPixels),
        alphas(kPixels, alpha),
        inverse_distances(kPixels, 1.0f / distance) {
    const CameraRecord record = camera_record(camera, kSize.x, kSize.y);
    for (std::size_t i = 0; i < kPixels; ++i) {
      const CameraRay ray = camera_ray(
          record, {static_cast<float>(i % 48) + 0.5f, static_cast<float>(i / 48) + 0.5f});
      const float along = -ray.origin_ws.y / ray.direction_ws.y;
      positions_ws[i] = ray.origin_ws + along * ray.direction_ws;
      to_viewer_ws[i] = -ray.direction_ws;
      depths[i] = view_depth(record, positions_ws[i]);
      light[i] = picture(i, distance);
    }
  }

  /// What a pixel's mirror direction shows: a wave across the scene.
  vec3 picture(std::size_t i, float distance) const {
    const vec3 shown = positions_ws[i] + distance * reflect(-to_viewer_ws[i], normals_ws[i]);
    return vec3(1.0f + std::sin(2.0f * shown.x));
  }

  SurfacesSeen surfaces() const { return {positions_ws, normals_ws, depths}; }
  LobesSeen lobes() { return {normals_ws, to_viewer_ws, alphas, inverse_distances, light, {}}; }

  std::vector<vec3> positions_ws, normals_ws, to_viewer_ws, light;
  std::vector<float> depths, alphas, inverse_distances;
};

/// Motion of the floor's points.
std::vector<PixelMotion> motion_of(const ReflectingFloor& now, const FrameAveraging& by) {
  std::vector<PixelMotion> motion;
  for (const vec3& position_ws : now.positions_ws) {
    motion.push_back(motion_between(image_point(by.views.now, position_ws),
                                    image_point(by.views.before, position_ws)));
  }
  return motion;
}

FrameAveraging averaging(const Camera& before, const Camera& now) {
  return {kSize,
          {camera_record(now, kSize.x, kSize.y), camera_record(before, kSize.x, kSize.y), 1u},
          10.0f};
}

/// The history of a first frame.
LobeHistory history_of(ReflectingFloor& floor) {
  LobeHistory history;
  average_lobes({kSize, {}, 10.0f}, {}, floor.surfaces(), {}, {}, floor.lobes(), history);
  return history;
}

TEST(CoatHistory, StartsWithTheFrameItself) {
  ReflectingFloor floor(camera_at(0.0f), 0.1f, 2.0f);
  const std::vector<vec3> light = floor.light;
  const LobeHistory history = history_of(floor);
  EXPECT_EQ(floor.light, light);
  EXPECT_EQ(history.light, light);
  for (const float frames : history.frames) ASSERT_EQ(frames, 1.0f);
}

TEST(CoatHistory, AveragesAllFramesOfARestingView) {
  const Camera camera = camera_at(0.0f);
  ReflectingFloor floor(camera, 0.01f, 2.0f);
  const FrameAveraging by = averaging(camera, camera);
  LobeHistory last = history_of(floor);
  for (int i = 2; i <= 5; ++i) {
    for (vec3& light : floor.light) light = vec3(static_cast<float>(i));
    if (i == 2) last.light.assign(kPixels, vec3(1.0f));
    LobeHistory next;
    average_lobes(by, motion_of(floor, by), floor.surfaces(), floor.surfaces(), last, floor.lobes(),
                  next);
    last = next;
    // The mean of 1 to i
    for (const vec3& light : floor.light) ASSERT_NEAR(light.x, 0.5f * (1.0f + i), 1e-4f);
  }
}

TEST(CoatHistory, FollowsWhatAMirrorShowsNotItsSurface) {
  const Camera before = camera_at(0.0f), now = camera_at(0.08f);
  const FrameAveraging by = averaging(before, now);
  ReflectingFloor first(before, 0.06f, 3.0f), second(now, 0.06f, 3.0f);
  const std::vector<vec3> truth = second.light;
  const LobeHistory last = history_of(first);
  // Without light of its own, what the frame shows is half of what is found in the history
  for (vec3& light : second.light) light = vec3(0.0f);
  LobeHistory next;
  average_lobes(by, motion_of(second, by), second.surfaces(), first.surfaces(), last,
                second.lobes(), next);
  int found = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (next.frames[i] <= 1.5f) continue;
    ++found;
    const float history = second.light[i].x * next.frames[i] / (next.frames[i] - 1.0f);
    ASSERT_NEAR(history, truth[i].x, 0.05f) << i;
  }
  EXPECT_GT(found, static_cast<int>(kPixels) / 2);  // the others come into view
}

TEST(CoatHistory, KeepsLobesThatShowSomethingElseApart) {
  // Cameras that face each other see the same points of the floor reflect opposite walls
  const Camera before = camera_at(0.0f),
               now = look_at({0.0f, 1.0f, -3.3f}, {0.0f, 0.4f, -2.3f}, 0.6f);
  const FrameAveraging by = averaging(before, now);
  for (const float alpha : {0.03f, 0.3f}) {
    ReflectingFloor first(before, alpha, 3.0f), second(now, alpha, 3.0f);
    const std::vector<PixelMotion> motion = motion_of(second, by);
    // The surface itself is found
    const vec2 offset = motion[kPixels / 2 + 24].offset;
    ASSERT_LT(std::abs(offset.x), 2.0f);
    ASSERT_LT(std::abs(offset.y), 15.0f);
    const std::vector<vec3> light = second.light;
    const LobeHistory last = history_of(first);
    LobeHistory next;
    average_lobes(by, motion, second.surfaces(), first.surfaces(), last, second.lobes(), next);
    EXPECT_TRUE(second.light == light);
  }
}

TEST(CoatHistory, LetsNoBrokenLightIn) {
  const Camera camera = camera_at(0.0f);
  const FrameAveraging by = averaging(camera, camera);
  ReflectingFloor floor(camera, 0.1f, 2.0f);
  LobeHistory last = history_of(floor);
  floor.light[100].y = std::nanf("");
  floor.alphas[200] = 0.0f;
  LobeHistory next;
  average_lobes(by, motion_of(floor, by), floor.surfaces(), floor.surfaces(), last, floor.lobes(),
                next);
  for (const vec3& light : next.light) ASSERT_TRUE(std::isfinite(light.y));
  EXPECT_EQ(next.frames[200], 0.0f);
  EXPECT_EQ(next.lobes[200].sharpness, 0.0f);
  EXPECT_EQ(next.frames[201], 2.0f);
}

/// Frames of a scene with glossy surfaces.
class GlossySequence : public ::testing::Test {
 protected:
  GlossySequence() {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(4);
    settings.rays_per_probe = 64;
    field.emplace(test::make_field(stage, settings, 3));
  }
  const Camera& camera() const { return stage.scene.cameras.at(0); }
  IndirectSources sources() const { return {.field = &*field}; }

  static FrameSettings averaging_over(int frames) {
    FrameSettings settings = quality_settings(Quality::interactive);
    settings.width = 96;
    settings.height = 64;
    settings.averaged_frames = frames;
    return settings;
  }
  RenderedFrame truth_from(const Camera& from) const {
    FrameSettings settings = averaging_over(1);
    settings.denoise = false;
    settings.glossy_rows = 1;
    settings.reflected_emissive_samples = 8;
    settings.samples = 64;
    return Renderer(stage.world, sources()).render(from, settings).value();
  }
  static double error_of(const RenderedFrame& frame, const RenderedFrame& truth) {
    return compare_images(*frame.image.find("glossy"), *truth.image.find("glossy"),
                          {.block = 4, .perceptual = false})
        .value()
        .relative_rmse;
  }

  test::Stage stage{"spheres"};
  std::optional<IrradianceField> field;
};

TEST_F(GlossySequence, HasLessNoiseOnceTheViewRests) {
  const RenderedFrame truth = truth_from(camera());
  Renderer renderer(stage.world, sources());
  const double first = error_of(renderer.render(camera(), averaging_over(10)).value(), truth);
  for (int i = 0; i < 14; ++i) renderer.render(camera(), averaging_over(10)).value();
  const double later = error_of(renderer.render(camera(), averaging_over(10)).value(), truth);
  EXPECT_LT(later, 0.75 * first) << first;
}

TEST_F(GlossySequence, HasLessNoiseWhileTheCameraWalks) {
  Camera moved = camera();
  Renderer averaging(stage.world, sources()), single(stage.world, sources());
  RenderedFrame averaged, alone;
  for (int i = 0; i < 12; ++i) {
    moved.world_from_view[3] += 0.006f * moved.world_from_view[0];
    averaged = averaging.render(moved, averaging_over(10)).value();
    alone = single.render(moved, averaging_over(1)).value();
  }
  const RenderedFrame truth = truth_from(moved);
  EXPECT_LT(error_of(averaged, truth), 0.9 * error_of(alone, truth)) << error_of(alone, truth);
}

}  // namespace
}  // namespace lambent::coat_history_test
