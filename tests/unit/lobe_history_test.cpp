// SPDX-License-Identifier: Apache-2.0
// Reflections averaged over frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "compose/history/lobe_history.h"
#include "denoise/atrous_pass.h"
#include "lambent/renderer.h"
#include "raytracing/camera_rays.h"
#include "support/field_scenes.h"

namespace lambent::lobe_history_test {
namespace {

constexpr ivec2 kSize(48, 32);
constexpr std::size_t kPixels = std::size_t{48} * 32;

/// A camera above a floor (y = 0), looking forward and down.
Camera camera_at(float x) {
  return look_at({x, 1.0f, 0.0f}, {x, 0.4f, -1.0f}, 0.6f);
}

/// A frame of a floor that reflects a picture at some distance from the floor, along lobes.
struct ReflectingFloor {
  /// `jitter`: where rays pass through their pixels.
  ReflectingFloor(const Camera& camera, float alpha, float distance, vec2 jitter = vec2(0.5f))
      : positions_ws(kPixels),
        normals_ws(kPixels, vec3(0.0f, 1.0f, 0.0f)),
        to_viewer_ws(kPixels),
        light(kPixels),
        excess(kPixels),
        variance(kPixels, 1.0f),
        depths(kPixels),
        alphas(kPixels, alpha),
        inverse_distances(kPixels, 1.0f / distance) {
    const CameraRecord record = camera_record(camera, kSize.x, kSize.y);
    for (std::size_t i = 0; i < kPixels; ++i) {
      const CameraRay ray = camera_ray(record, vec2(i % 48, i / 48) + jitter);
      const float along = -ray.origin_ws.y / ray.direction_ws.y;
      positions_ws[i] = ray.origin_ws + along * ray.direction_ws;
      to_viewer_ws[i] = -ray.direction_ws;
      depths[i] = view_depth(record, positions_ws[i]);
      light[i] = picture(i, distance);
      excess[i] = 3.0f * light[i];
    }
  }

  /// What a pixel's mirror direction shows: a wave across the scene.
  vec3 picture(std::size_t i, float distance) const {
    const vec3 shown = positions_ws[i] + distance * reflect(-to_viewer_ws[i], normals_ws[i]);
    return vec3(1.0f + std::sin(2.0f * shown.x));
  }

  SurfacesSeen surfaces() const { return {positions_ws, normals_ws, depths}; }
  LobesSeen lobes() {
    return {normals_ws, to_viewer_ws, alphas, inverse_distances, light, excess, variance};
  }

  std::vector<vec3> positions_ws, normals_ws, to_viewer_ws, light, excess;
  std::vector<float> variance, depths, alphas, inverse_distances;
};

FrameAveraging averaging(const Camera& before, const Camera& now) {
  return {kSize,
          {camera_record(now, kSize.x, kSize.y), camera_record(before, kSize.x, kSize.y), 1u},
          10.0f};
}

/// The history of a first frame.
LobeHistory history_of(ReflectingFloor& floor) {
  LobeHistory history;
  average_reflected_light({kSize, {}, 10.0f}, floor.surfaces(), {}, {}, floor.lobes(), history);
  return history;
}

TEST(LobeHistory, StartsWithTheFrameItself) {
  ReflectingFloor floor(camera_at(0.0f), 0.1f, 2.0f);
  const std::vector<vec3> light = floor.light;
  const LobeHistory history = history_of(floor);
  EXPECT_EQ(floor.light, light);
  EXPECT_EQ(history.light, light);
  for (const float frames : history.frames) ASSERT_EQ(frames, 1.0f);
}

TEST(LobeHistory, AveragesAllFramesOfARestingView) {
  // Rays pass through other places of their pixels in each frame, where even a mirror's lobes show
  // something else, and each second pixel has another roughness
  const Camera camera = camera_at(0.0f);
  const FrameAveraging by = averaging(camera, camera);
  const auto floor_of = [&](int frame) {
    ReflectingFloor floor(camera, 0.002f, 2.0f, fract(vec2(0.37f, 0.71f) * float(frame)));
    for (std::size_t i = 0; i < kPixels; i += 2) floor.alphas[i] = 0.2f;
    floor.light.assign(kPixels, vec3(static_cast<float>(frame)));
    floor.excess.assign(kPixels, vec3(static_cast<float>(3 * frame)));
    return floor;
  };
  ReflectingFloor before = floor_of(1);
  LobeHistory last = history_of(before);
  for (int i = 2; i <= 5; ++i) {
    ReflectingFloor floor = floor_of(i);
    LobeHistory next;
    average_reflected_light(by, floor.surfaces(), before.surfaces(), last, floor.lobes(), next);
    // The mean of 1 to i
    for (const vec3& light : floor.light) ASSERT_NEAR(light.x, 0.5f * (1.0f + i), 1e-4f);
    for (const vec3& excess : floor.excess) ASSERT_NEAR(excess.x, 1.5f * (1.0f + i), 1e-3f);
    for (const float variance : floor.variance) ASSERT_NEAR(variance, 1.0f / i, 1e-3f);
    last = next;
    before = floor;
  }
}

TEST(LobeHistory, StartsAnewOnceThereWereNoLobes) {
  const Camera camera = camera_at(0.0f);
  const FrameAveraging by = averaging(camera, camera);
  ReflectingFloor floor(camera, 0.1f, 2.0f);
  const LobeHistory first = history_of(floor);
  LobeHistory none, next;
  average_reflected_light(by, floor.surfaces(), floor.surfaces(), first, {}, none);
  EXPECT_TRUE(none.light.empty() && none.lobes.empty());
  average_reflected_light(by, floor.surfaces(), floor.surfaces(), none, floor.lobes(), next);
  for (const float frames : next.frames) ASSERT_EQ(frames, 1.0f);
}

TEST(LobeHistory, FollowsWhatAMirrorShowsNotItsSurface) {
  const Camera before = camera_at(0.0f), now = camera_at(0.08f);
  const FrameAveraging by = averaging(before, now);
  ReflectingFloor first(before, 0.06f, 3.0f), second(now, 0.06f, 3.0f);
  const std::vector<vec3> truth = second.light;
  const LobeHistory last = history_of(first);
  // Without light of its own, what the frame shows is half of what is found in the history
  for (vec3& light : second.light) light = vec3(0.0f);
  LobeHistory next;
  average_reflected_light(by, second.surfaces(), first.surfaces(), last, second.lobes(), next);
  int found = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (next.frames[i] <= 1.5f) continue;
    ++found;
    const float history = second.light[i].x * next.frames[i] / (next.frames[i] - 1.0f);
    ASSERT_NEAR(history, truth[i].x, 0.05f) << i;
  }
  EXPECT_GT(found, static_cast<int>(kPixels) / 2);  // the others come into view
}

TEST(LobeHistory, KeepsLobesThatShowSomethingElseApart) {
  // Cameras that face each other see the same points of the floor reflect opposite walls
  const Camera before = camera_at(0.0f),
               now = look_at({0.0f, 1.0f, -3.3f}, {0.0f, 0.4f, -2.3f}, 0.6f);
  const FrameAveraging by = averaging(before, now);
  for (const float alpha : {0.03f, 0.3f}) {
    ReflectingFloor first(before, alpha, 3.0f), second(now, alpha, 3.0f);
    const std::vector<vec3> light = second.light;
    LobeHistory last = history_of(first);
    LobeHistory next;
    average_reflected_light(by, second.surfaces(), first.surfaces(), last, second.lobes(), next);
    EXPECT_TRUE(second.light == light);
    // Had they reflected towards the second camera, they would count
    const vec3 viewer_ws(now.world_from_view[3]);
    for (std::size_t i = 0; i < kPixels; ++i) {
      last.lobes[i] = lobe_guide(first.normals_ws[i], normalize(viewer_ws - first.positions_ws[i]),
                                 alpha, 1.0f / 3.0f);
    }
    average_reflected_light(by, second.surfaces(), first.surfaces(), last, second.lobes(), next);
    const auto counts = [](float frames) { return frames > 1.25f; };
    EXPECT_GT(std::count_if(next.frames.begin(), next.frames.end(), counts), 100);
  }
}

TEST(LobeHistory, LetsNoBrokenLightIn) {
  const Camera camera = camera_at(0.0f);
  const FrameAveraging by = averaging(camera, camera);
  ReflectingFloor floor(camera, 0.1f, 2.0f);
  LobeHistory last = history_of(floor);
  floor.light[100].y = std::nanf("");
  floor.alphas[200] = 0.0f;
  LobeHistory next;
  average_reflected_light(by, floor.surfaces(), floor.surfaces(), last, floor.lobes(), next);
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
  /// The last of some frames, between which the camera steps aside by so much [m].
  RenderedFrame last_of_walk(int averaged, float step, std::uint32_t seed) const {
    FrameSettings settings = quality_settings(Quality::interactive);
    settings.width = 72;
    settings.height = 48;
    settings.averaged_frames = averaged;
    settings.seed = seed;
    Renderer renderer(stage.world, {.field = &*field});
    Camera camera = stage.scene.cameras.at(0);
    RenderedFrame frame;
    for (int i = 0; i < 9; ++i) {
      frame = renderer.render(camera, settings).value();
      camera.world_from_view[3] += step * camera.world_from_view[0];
    }
    return frame;
  }
  /// Mean difference of two such frames of other random numbers; of squares, the lamp's images
  /// would be nearly all.
  double noise_of_walk(int averaged, float step) const {
    const RenderedFrame one = last_of_walk(averaged, step, 1);
    const RenderedFrame other = last_of_walk(averaged, step, 2);
    const std::vector<float>& a = one.image.find("glossy")->pixels;
    const std::vector<float>& b = other.image.find("glossy")->pixels;
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += std::min(std::abs(double{a[i]} - b[i]), double{kBrightest});
    }
    return sum / static_cast<double>(a.size());
  }
  static constexpr float kBrightest = 0.2f;  // brighter than what the walls reflect

  test::Stage stage{"spheres"};
  std::optional<IrradianceField> field;
};

TEST_F(GlossySequence, HasLessNoiseOnceTheViewRests) {
  const double single = noise_of_walk(1, 0.0f);
  EXPECT_LT(noise_of_walk(10, 0.0f), 0.5 * single) << single;
}

TEST_F(GlossySequence, HasLessNoiseWhileTheCameraWalks) {
  const double single = noise_of_walk(1, 0.004f);
  EXPECT_LT(noise_of_walk(10, 0.004f), 0.65 * single) << single;
}

}  // namespace
}  // namespace lambent::lobe_history_test
