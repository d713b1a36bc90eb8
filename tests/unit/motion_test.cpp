// SPDX-License-Identifier: Apache-2.0
// Motion of pixels against finite differences: a point of a surface is followed from the frame
// before by the scene as it was then, and both are projected in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <random>

#include "lambent/renderer.h"
#include "lambent/world.h"
#include "raytracing/camera_rays.h"
#include "raytracing/world_access.h"
#include "support/moving_scene.h"

namespace lambent::motion_test {
namespace {

using test::Mover;

constexpr int kWidth = 64, kHeight = 36;

// A hundredth of a pixel: more than the rounding of positions in float, and less than shows.
constexpr double kTolerance = 0.01;

/// Where a picture shows a place; none behind the camera.
std::optional<glm::dvec2> seen_at(const Camera& camera, const glm::dvec3& position) {
  const glm::dvec3 view(glm::inverse(glm::dmat4(camera.world_from_view)) *
                        glm::dvec4(position, 1.0));
  if (view.z >= 0.0) return std::nullopt;
  const double half_height =
      camera.orthographic ? 0.5 * static_cast<double>(camera.vertical_extent)
                          : -view.z * std::tan(0.5 * static_cast<double>(camera.vertical_fov));
  return glm::dvec2(kWidth, kHeight) * 0.5 +
         0.5 * kHeight * glm::dvec2(view.x, -view.y) / half_height;
}

/// The place of a hit's point in a scene of the same triangles.
glm::dvec3 place_of(const Scene& scene, const Hit& hit) {
  const Instance& instance = scene.instances[hit.instance];
  const Mesh& mesh = scene.meshes[instance.mesh];
  const glm::uvec3& t = mesh.triangles[hit.triangle];
  const glm::dvec2 b(hit.barycentrics);
  const glm::dvec3 position = glm::dvec3(mesh.positions[t.x]) * (1.0 - b.x - b.y) +
                              glm::dvec3(mesh.positions[t.y]) * b.x +
                              glm::dvec3(mesh.positions[t.z]) * b.y;
  return glm::dvec3(glm::dmat4(instance.world_from_object) * glm::dvec4(position, 1.0));
}

FrameSettings with_motion() {
  FrameSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.motion = true;
  return settings;
}

/// Pixels whose motion was held against what it should be.
struct Checked {
  int surfaces = 0, sky = 0;
  double fastest = 0.0;  // [pixels]
};

class MotionTest : public ::testing::Test {
 protected:
  explicit MotionTest(float scene_size = 1.0f)
      : size(scene_size), scene(test::moving_scene(scene_size)) {}

  /// A camera on a ball around the movers that looks at one of them.
  Camera random_camera() {
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const float angle = -1.2f + 2.4f * uniform(random);
    const float distance = size * (3.0f + 6.0f * uniform(random));
    const glm::vec3 target = size * glm::vec3(-2.5f + 5.0f * uniform(random), 0.8f, 0.0f);
    const glm::vec3 away(std::sin(angle), 0.1f + 0.4f * uniform(random), std::cos(angle));
    return look_at(target + distance * away, target, 0.7f + 0.4f * uniform(random));
  }
  /// The camera after a step and a turn.
  Camera moved(Camera camera) {
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto some = [&](float most) {
      return most * glm::vec3(uniform(random), uniform(random), uniform(random));
    };
    const glm::vec3 turn = some(0.05f), step = some(0.2f * size);
    camera.world_from_view = glm::translate(glm::mat4(1.0f), step) * camera.world_from_view *
                             glm::rotate(glm::mat4(1.0f), turn.x, {1.0f, 0.0f, 0.0f}) *
                             glm::rotate(glm::mat4(1.0f), turn.y, {0.0f, 1.0f, 0.0f}) *
                             glm::rotate(glm::mat4(1.0f), turn.z, {0.0f, 0.0f, 1.0f});
    return camera;
  }

  /// Renders a frame of `before` and one of `now`, with the scene at two times between, and checks
  /// the second one's motion at each pixel. What `follows` refuses must be unknown.
  template <class Follows>
  Checked check(const Camera& before, const Camera& now, float time_before, float time_now,
                Follows follows) {
    World world(scene);
    Renderer renderer(world);
    animate(scene, 0, time_before);
    EXPECT_TRUE(world.update());
    EXPECT_TRUE(renderer.render(before, with_motion()));
    const Scene scene_before = scene;
    animate(scene, 0, time_now);
    EXPECT_TRUE(world.update());
    const RenderedFrame frame = renderer.render(now, with_motion()).value();
    return compare(*frame.image.find("motion"), world, scene_before, before, now, follows);
  }
  Checked check(const Camera& before, const Camera& now, float time_before, float time_now) {
    return check(before, now, time_before, time_now, [](const Hit&) { return true; });
  }

  bool is_see_through(const Hit& hit) const {
    const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
    return scene.materials[mesh.material].alpha_mode == AlphaMode::blend;
  }

  template <class Follows>
  Checked compare(const Image& motion, const World& world, const Scene& scene_before,
                  const Camera& before, const Camera& now, Follows follows) {
    Checked checked;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const glm::dvec2 at(x + 0.5, y + 0.5);
        const Ray ray =
            camera_ray(now, kWidth, kHeight, static_cast<float>(at.x), static_cast<float>(at.y));
        Hit hit = tracer_of(world).closest_hit(ray);
        if (!hit.missed() && is_see_through(hit)) {
          Ray through = ray;
          through.mask = kRayOfMotion;
          hit = tracer_of(world).closest_hit(through);
        }
        std::optional<glm::dvec2> expected;
        if (hit.missed()) {
          // Far away along the ray, as seen from where the camera was before
          const glm::dvec3 eye(before.world_from_view[3]);
          expected = seen_at(before, eye + 1e9 * glm::dvec3(ray.direction));
          ++checked.sky;
        } else if (follows(hit)) {
          expected = seen_at(before, place_of(scene_before, hit));
          ++checked.surfaces;
        }
        const float* found = motion.at(x, y);
        if (!expected) {
          EXPECT_TRUE(std::isnan(found[0]) && std::isnan(found[1])) << x << ", " << y;
          continue;
        }
        const glm::dvec2 offset = *expected - at;
        checked.fastest = std::max(checked.fastest, glm::length(offset));
        const double tolerance = kTolerance * std::max(1.0, glm::length(offset) / kWidth);
        EXPECT_NEAR(found[0], offset.x, tolerance) << x << ", " << y;
        EXPECT_NEAR(found[1], offset.y, tolerance) << x << ", " << y;
      }
    }
    return checked;
  }

  float size;
  Scene scene;
  std::mt19937 random{7};
};

class FarMotionTest : public MotionTest {
 protected:
  FarMotionTest() : MotionTest(500.0f) {}
};

TEST_F(MotionTest, FollowsAWalkAndATurnOfTheCamera) {
  for (int i = 0; i < 6; ++i) {
    const Camera before = random_camera();
    const Checked checked = check(before, moved(before), 0.0f, 0.0f);
    EXPECT_GT(checked.surfaces, 500);
    EXPECT_GT(checked.fastest, 1.0);
  }
}

TEST_F(MotionTest, FollowsInstancesJointsAndMorphsUnderACameraAtRest) {
  for (int i = 0; i < 4; ++i) {
    const Camera camera = random_camera();
    EXPECT_GT(check(camera, camera, 0.2f, 0.5f).fastest, 1.0);
  }
}

TEST_F(MotionTest, FollowsAllOfThemAtOnce) {
  for (int i = 0; i < 6; ++i) {
    const Camera before = random_camera();
    const float time = 0.1f * static_cast<float>(i);
    check(before, moved(before), time, time + 0.15f);
  }
}

TEST_F(FarMotionTest, FollowsWhatIsHundredsOfMetresAway) {
  for (int i = 0; i < 4; ++i) {
    const Camera before = random_camera();
    check(before, moved(before), 0.3f, 0.5f);
  }
}

TEST_F(MotionTest, OfTheSkyFollowsTheCamerasTurnAlone) {
  const Camera before = look_at({0.0f, 1.0f, 8.0f}, {0.0f, 30.0f, 0.0f}, 1.0f);
  Camera now = moved(before);
  EXPECT_EQ(check(before, now, 0.0f, 0.5f).sky, kWidth * kHeight);
  now = before;
  now.world_from_view[3].x += 3.0f;
  EXPECT_LT(check(before, now, 0.0f, 0.5f).fastest, kTolerance);
}

TEST_F(MotionTest, FollowsAZoomAndParallelRays) {
  const Camera before = random_camera();
  Camera now = before;
  now.vertical_fov *= 0.8f;
  EXPECT_GT(check(before, now, 0.0f, 0.1f).fastest, 1.0);

  Camera parallel = look_at({1.0f, 6.0f, 5.0f}, {0.0f, 0.5f, 0.0f}, 1.0f);
  parallel.orthographic = true;
  parallel.vertical_extent = 3.0f;  // the floor fills the picture
  Camera shifted = parallel;
  shifted.world_from_view[3] += glm::vec4(0.3f, 0.1f, 0.0f, 0.0f);
  EXPECT_GT(check(parallel, shifted, 0.0f, 0.1f).surfaces, 500);
}

TEST_F(MotionTest, IsExactlyNothingWhereNothingMoves) {
  const Camera camera = random_camera();
  World world(scene);
  Renderer renderer(world);
  ASSERT_TRUE(renderer.render(camera, with_motion()));
  const RenderedFrame frame = renderer.render(camera, with_motion()).value();
  for (const float value : frame.image.find("motion")->pixels) EXPECT_EQ(value, 0.0f);
}

TEST_F(MotionTest, FollowsOverSeveralUpdatesOfTheWorldAndThroughAListInAnotherOrder) {
  const Camera camera = look_at({0.0f, 3.0f, 8.0f}, {0.0f, 0.5f, 0.0f}, 0.9f);
  World world(scene);
  Renderer renderer(world);
  ASSERT_TRUE(renderer.render(camera, with_motion()));
  const Scene scene_before = scene;
  scene.rig.instances.clear();  // they go by place in the list
  for (const float time : {0.1f, 0.2f, 0.3f}) {
    animate(scene, 0, time);
    ASSERT_TRUE(world.update());
  }
  // The floor goes to the end, and all others move up
  std::rotate(scene.instances.begin(), scene.instances.begin() + 1, scene.instances.end());
  ASSERT_TRUE(world.update());
  Scene as_listed_now = scene_before;
  std::rotate(as_listed_now.instances.begin(), as_listed_now.instances.begin() + 1,
              as_listed_now.instances.end());
  const RenderedFrame frame = renderer.render(camera, with_motion()).value();
  const Checked checked = compare(*frame.image.find("motion"), world, as_listed_now, camera, camera,
                                  [](const Hit&) { return true; });
  EXPECT_GT(checked.fastest, 1.0);
}

TEST_F(MotionTest, IsUnknownOfWhatIsNewAndOfAMeshEditedByHandForTheFirstTime) {
  const Camera camera = look_at({0.0f, 3.0f, 8.0f}, {0.0f, 0.5f, 0.0f}, 0.9f);
  World world(scene);
  Renderer renderer(world);
  ASSERT_TRUE(renderer.render(camera, with_motion()));
  const auto moves_up = [](Mesh& mesh) {
    for (glm::vec3& position : mesh.positions) position.y += 0.1f;
    ++mesh.revision;
  };
  const auto next = [&](auto follows) {
    const Scene before = scene;
    moves_up(scene.meshes[static_cast<int>(Mover::turning)]);
    EXPECT_TRUE(world.update());
    const RenderedFrame frame = renderer.render(camera, with_motion()).value();
    return compare(*frame.image.find("motion"), world, before, camera, camera, follows);
  };
  const Checked first =
      next([](const Hit& hit) { return hit.instance != static_cast<unsigned>(Mover::turning); });
  EXPECT_LT(first.fastest, kTolerance);
  EXPECT_GT(next([](const Hit&) { return true; }).fastest, 0.4);

  Instance added = scene.instances[static_cast<int>(Mover::turning)];
  added.world_from_object[3].z += 2.0f;
  scene.instances.push_back(added);
  ASSERT_TRUE(world.update());
  const RenderedFrame frame = renderer.render(camera, with_motion()).value();
  const auto is_old = [&](const Hit& hit) { return hit.instance + 1 != scene.instances.size(); };
  compare(*frame.image.find("motion"), world, scene, camera, camera, is_old);
}

TEST_F(MotionTest, IsUnknownInTheFirstPictureAndAfterAChangeOfSize) {
  const Camera camera = random_camera();
  const World world(scene);
  Renderer renderer(world);
  const auto all_unknown = [&](const FrameSettings& settings) {
    const RenderedFrame frame = renderer.render(camera, settings).value();
    const Image& motion = *frame.image.find("motion");
    EXPECT_EQ(motion.channels, 2);
    return std::all_of(motion.pixels.begin(), motion.pixels.end(),
                       [](float value) { return std::isnan(value); });
  };
  FrameSettings smaller = with_motion();
  smaller.width = 32;
  EXPECT_TRUE(all_unknown(with_motion()));
  EXPECT_FALSE(all_unknown(with_motion()));
  EXPECT_TRUE(all_unknown(smaller));
  EXPECT_FALSE(all_unknown(smaller));
}

TEST_F(MotionTest, IsTheSameOfAPictureInParts) {
  World world(scene);
  Renderer whole(world), parts(world);
  const Camera before = random_camera(), now = moved(before);
  const RenderedFrame one =
      (whole.render(before, with_motion()).value(), whole.render(now, with_motion()).value());
  const Image& expected = *one.image.find("motion");
  const Camera cameras[] = {before, now};
  for (const Camera& camera : cameras) {
    FrameSettings some = with_motion();
    some.rows = 12;
    for (; some.first_row < kHeight; some.first_row += some.rows) {
      const RenderedFrame part = parts.render(camera, some).value();
      const Image& motion = *part.image.find("motion");
      if (&camera == cameras) continue;
      EXPECT_TRUE(
          std::equal(motion.pixels.begin(), motion.pixels.end(), expected.at(0, some.first_row)))
          << some.first_row;
    }
  }
}

}  // namespace
}  // namespace lambent::motion_test
