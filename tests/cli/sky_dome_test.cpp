// SPDX-License-Identifier: Apache-2.0
// Pictures of scenes that bring their sky as a mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "first_picture/daylight.h"
#include "lambent/image.h"
#include "scene/environment_sampling.h"
#include "scenes/glb_writer.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::sky_dome_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kQuick =
    " --method reference --samples 256 --size 24x24 --eye=0,3,14 --target=0,1,0 -o ";

/// A box on a ground, lit by nothing but a dome that is brighter on one side.
Scene scene_under_a_dome() {
  Scene scene = test::scene_of(
      {test::box_mesh({-2, 0, -2}, {2, 3, 2}), test::box_mesh({-30, -1, -30}, {30, 0, 30})});
  Material blue;
  blue.unlit = true;
  blue.base_color = glm::vec4(0.4f, 0.7f, 1.0f, 1.0f);
  scene.materials.push_back(blue);
  Mesh dome = test::sphere(400.0f, 24, 1);
  for (const glm::vec3& p : dome.positions) {
    dome.colors.emplace_back(glm::vec3(p.x < 0.0f ? 1.0f : 0.3f), 1.0f);
  }
  test::add(scene, std::move(dome));
  return scene;
}

glm::dvec3 mean_of(const std::string& path) {
  const auto read = read_image(path);
  EXPECT_TRUE(read.has_value());
  const Image& all = read->layers[0].image;
  glm::dvec3 sum(0.0);
  for (int y = 0; y < all.height; ++y) {
    for (int x = 0; x < all.width; ++x) {
      for (int c = 0; c < 3; ++c) sum[c] += all.at(x, y)[c];
    }
  }
  return sum / static_cast<double>(all.width * all.height);
}

TEST(SkyDomes, LightAsTheyDoAsMeshes) {
  const test::TemporaryDirectory directory;
  const std::string scene = directory.file("dome.glb");
  ASSERT_TRUE(scenes::write_glb(scene_under_a_dome(), scene));
  const std::string sky = directory.file("sky.exr"), mesh = directory.file("mesh.exr");
  const auto as_sky = test::run_program("render " + scene + kQuick + sky + " --light scene");
  ASSERT_EQ(as_sky.status, 0) << as_sky.errors;
  EXPECT_THAT(as_sky.errors, HasSubstr("the dome around it as its sky"));
  // --light none leaves what surfaces emit
  const auto as_mesh = test::run_program("render " + scene + kQuick + mesh + " --light none");
  ASSERT_EQ(as_mesh.status, 0) << as_mesh.errors;
  EXPECT_THAT(as_mesh.errors, Not(HasSubstr("the dome")));
  const glm::dvec3 with_sky = mean_of(sky), with_mesh = mean_of(mesh);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(with_sky[c] / with_mesh[c], 1.0, 0.02) << c;
}

TEST(SkyDomes, OfAClearDayGetASunInFirstPictures) {
  const test::TemporaryDirectory directory;
  const std::string scene = directory.file("dome.glb");
  ASSERT_TRUE(scenes::write_glb(scene_under_a_dome(), scene));
  const std::string sunny = directory.file("sunny.exr"), plain = directory.file("plain.exr");
  const auto by_day = test::run_program("render " + scene + kQuick + sunny);
  ASSERT_EQ(by_day.status, 0) << by_day.errors;
  EXPECT_THAT(by_day.errors, HasSubstr("light: the dome around the scene as its sky, and a sun"));
  const auto as_it_is = test::run_program("render " + scene + kQuick + plain + " --light scene");
  ASSERT_EQ(as_it_is.status, 0) << as_it_is.errors;
  EXPECT_THAT(as_it_is.errors, HasSubstr("light: the scene's, with the dome"));
  // A clear sky's sun is yellow, and brings four fifths of the light
  const glm::dvec3 with_sun = mean_of(sunny), without = mean_of(plain);
  EXPECT_GT(with_sun.x, 5.0 * without.x);
  EXPECT_GT(with_sun.x / without.x, 1.5 * with_sun.z / without.z);
}

TEST(SkyDomes, GiveWayToAnotherSky) {
  const test::TemporaryDirectory directory;
  const std::string scene = directory.file("dome.glb"), red = directory.file("red.exr");
  ASSERT_TRUE(scenes::write_glb(scene_under_a_dome(), scene));
  const auto run = test::run_program("render " + scene + kQuick + red + " --sky 1,0,0");
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(mean_of(red).z, 0.0);
  EXPECT_GT(mean_of(red).x, 0.3);
}

// A file's sun outdoors gets a sky in the first picture, in proportion to it, unless the scene's
// light alone is asked for.
TEST(Skies, AreAddedToSunsOutdoors) {
  const test::TemporaryDirectory directory;
  Scene scene = test::scene_of({test::box_mesh({-9, -1, -9}, {9, 0, 9}),
                                test::box_mesh({-2, 0, -2}, {0, 3, 0}),
                                test::box_mesh({3, 0, 1}, {5, 2, 3})});
  const std::string without_sun = directory.file("dark.glb"), with_sun = directory.file("sun.glb");
  ASSERT_TRUE(scenes::write_glb(scene, without_sun));
  Light& sun = scene.lights.emplace_back();
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::normalize(glm::vec3(0.3f, -1.0f, 0.2f));
  sun.intensity = glm::vec3(4.0f, 3.6f, 3.0f);  // a fifth of that of a clear afternoon
  ASSERT_TRUE(scenes::write_glb(scene, with_sun));

  // The view shows little but the sky
  const std::string upwards =
      " --method direct --size 16x16 --eye=0,20,30 --target=0,60,0 --fov 20 -o ";
  const auto sky_of = [&](const std::string& options, const std::string& words) {
    const std::string picture = directory.file("sky.exr");
    const auto shown = test::run_program("render " + with_sun + upwards + picture + options);
    EXPECT_EQ(shown.status, 0) << shown.errors;
    EXPECT_THAT(shown.errors, HasSubstr(words));
    return mean_of(picture);
  };
  const glm::dvec3 added = sky_of("", "under a sky in proportion to its suns");
  // 53 degrees above the horizon, the map's colour is nearly that of the zenith
  const glm::vec3 sky = sky_radiance(make_day_sky(0.2f), glm::normalize(glm::vec3(0, 40, -30)));
  EXPECT_NEAR(added.x, sky.x, 0.05f * sky.x);
  EXPECT_NEAR(added.z, sky.z, 0.05f * sky.z);
  EXPECT_EQ(sky_of(" --light sky", "under a sky in proportion to its suns"), added);
  EXPECT_EQ(sky_of(" --light scene", "under a black sky"), glm::dvec3(0.0));

  const auto refused = test::run_program("render " + without_sun + upwards +
                                         directory.file("none.exr") + " --light sky");
  EXPECT_NE(refused.status, 0);
  EXPECT_THAT(refused.errors, HasSubstr("it has none"));
}

}  // namespace
}  // namespace lambent::sky_dome_test
