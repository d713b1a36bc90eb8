// SPDX-License-Identifier: Apache-2.0
// The field against our own reference in rooms as strangers model them: walls wound any way, of
// two sides, thick and thin. Beads and blotches are looked for, which a mean hides.
#include <gtest/gtest.h>

#include <cstdio>
#include <utility>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "scenes/builtin.h"
#include "shared/constants.h"
#include "support/box_scenes.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::unseen_scenes_test {
namespace {

constexpr int kWidth = 96, kHeight = 54, kBlock = 6;
// Of the field: beads and blotches are where probes stand, after few updates as after many.
constexpr int kUpdates = 4;
// A pixel of the reference: the error of blocks is told without its noise, which is 0.5 % of the
// mean and a tenth of blocks at most.
constexpr int kSamples = 128;
constexpr int kWalls = 0, kLamp = 1;
constexpr int kCornellMaterials = 4;

/// A room of 6 by 3 by 5 m with a lamp below its ceiling and a box on its floor.
struct Room {
  float wall_thickness = 0.0f;  ///< [m]; 0: single sheets.
  bool two_sided = false;
  bool wound_both_ways = false;  ///< Every third triangle of each mesh runs the other way.
  bool panel = false;            ///< A sheet that shows the camera its back.
};

/// A box of one mesh whose corners have a normal a side.
Mesh flat_box(const glm::vec3& low, const glm::vec3& high, bool inwards = false) {
  const Mesh round = test::box_mesh(low, high, inwards);
  Mesh flat;
  for (const glm::uvec3& t : round.triangles) {
    const glm::vec3 corners[] = {round.positions[t.x], round.positions[t.y], round.positions[t.z]};
    const auto first = static_cast<glm::uint>(flat.positions.size());
    flat.positions.insert(flat.positions.end(), corners, corners + 3);
    flat.normals.insert(
        flat.normals.end(), 3,
        glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0])));
    flat.triangles.emplace_back(first, first + 1, first + 2);
  }
  return flat;
}

Scene furnish(const Room& room) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.6f)),
                     test::lambert(glm::vec3(0.0f), glm::vec3(12.0f))};
  for (Material& material : scene.materials) material.double_sided = room.two_sided;
  const glm::vec3 low(0.0f), high(6.0f, 3.0f, 5.0f);
  test::add(scene, flat_box(low, high, true));
  if (room.wall_thickness > 0.0f) {
    test::add(scene, flat_box(low - room.wall_thickness, high + room.wall_thickness));
  }
  test::add(scene, flat_box({1.0f, 0.0f, 1.0f}, {2.1f, 0.9f, 1.8f}));
  if (room.panel) {
    test::add(scene,
              test::quad({3.5f, 0.4f, 1.5f}, {1.5f, 0.0f, 0.0f}, {0.0f, 1.6f, 0.0f}, kWalls));
  }
  if (room.wound_both_ways) {
    for (Mesh& mesh : scene.meshes) {
      for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
        std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
      }
    }
  }
  test::add(scene, test::quad({2.5f, 2.9f, 2.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, kLamp));
  return scene;
}

Metrics compare_with_reference(Scene scene, const Camera& camera) {
  const test::Stage stage(std::move(scene));
  ReferenceSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples = kSamples;
  settings.layer_errors = true;
  const LayeredImage reference = render_reference(stage.world, camera, settings).image;
  const IrradianceField field = test::make_field(stage, {}, kUpdates);
  FrameSettings frame;
  frame.width = kWidth;
  frame.height = kHeight;
  const LayeredImage image =
      Renderer(stage.world, {.field = &field}).render(camera, frame).value().image;
  const Metrics metrics = compare_images(*image.find("irradiance"), *reference.find("irradiance"),
                                         {.block = kBlock,
                                          .standard_error = reference.find("irradiance.error"),
                                          .perceptual = false})
                              .value();
  std::printf("mean ratio %.4f, relative RMSE %.4f, spots %.3f to %.3f\n", metrics.mean_ratio,
              *metrics.noise_corrected_relative_rmse, metrics.blocks.darkest_spot,
              metrics.blocks.brightest_spot);
  return metrics;
}

void expect_like_reference(Scene scene, const Camera& camera) {
  const Metrics metrics = compare_with_reference(std::move(scene), camera);
  EXPECT_NEAR(metrics.mean_ratio, 1.0, 0.03);
  EXPECT_LE(*metrics.noise_corrected_relative_rmse, 0.12);
  EXPECT_GE(metrics.blocks.darkest_spot, 0.6);
  EXPECT_LE(metrics.blocks.brightest_spot, 1.6);
}

void expect_like_reference(const Room& room) {
  expect_like_reference(furnish(room),
                        look_at({5.6f, 1.7f, 4.6f}, {1.5f, 1.1f, 0.8f}, 75.0f * kPi / 180.0f));
}

TEST(UnseenRoom, OfThinWallsIsLitAsTheReferenceLightsIt) {
  expect_like_reference({});
}

TEST(UnseenRoom, OfThickWallsOfTwoSidesIsLitAsTheReferenceLightsIt) {
  expect_like_reference({.wall_thickness = 0.3f, .two_sided = true});
}

TEST(UnseenRoom, WoundBothWaysIsLitAsTheReferenceLightsIt) {
  expect_like_reference({.wound_both_ways = true});
}

TEST(UnseenRoom, OfThickWallsWoundBothWaysIsLitAsTheReferenceLightsIt) {
  expect_like_reference({.wall_thickness = 0.2f, .wound_both_ways = true});
}

TEST(UnseenRoom, WithAPanelSeenFromBehindIsLitAsTheReferenceLightsIt) {
  expect_like_reference({.panel = true});
}

/// A dark room under nine white tubes that hang 4 mm below white housings.
Scene under_tubes() {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.1f)),
                     test::lambert(glm::vec3(0.8f), glm::vec3(12.0f)),
                     test::lambert(glm::vec3(0.8f))};
  constexpr int kHousings = 2;
  test::add(scene, flat_box(glm::vec3(0.0f), {6.0f, 3.0f, 5.0f}, true));
  for (const float x : {1.0f, 3.0f, 5.0f}) {
    for (const float z : {0.9f, 2.5f, 4.1f}) {
      Mesh tube = flat_box({x - 0.6f, 2.85f, z - 0.02f}, {x + 0.6f, 2.89f, z + 0.02f});
      Mesh housing = flat_box({x - 0.62f, 2.894f, z - 0.08f}, {x + 0.62f, 2.96f, z + 0.08f});
      tube.material = kLamp;
      housing.material = kHousings;
      test::add(scene, std::move(tube));
      test::add(scene, std::move(housing));
    }
  }
  return scene;
}

/// Ratio of the irradiance under tubes to the reference's, in the mean over a picture.
double ratio_under_tubes(int gather_rays) {
  const test::Stage stage(under_tubes());
  const Camera camera = look_at({5.6f, 1.2f, 4.6f}, {1.5f, 0.6f, 0.8f}, 75.0f * kPi / 180.0f);
  ReferenceSettings settings;
  settings.width = kWidth / 2;
  settings.height = kHeight / 2;
  settings.samples = 512;
  const LayeredImage reference = render_reference(stage.world, camera, settings).image;
  const IrradianceField field = test::make_field(stage, {}, kUpdates);
  FrameSettings frame;
  frame.width = settings.width;
  frame.height = settings.height;
  frame.gather_rays = gather_rays;
  const LayeredImage image =
      Renderer(stage.world, {.field = &field}).render(camera, frame).value().image;
  const Metrics metrics =
      compare_images(*image.find("irradiance"), *reference.find("irradiance"), {}).value();
  std::printf("mean ratio %.4f\n", metrics.mean_ratio);
  return metrics.mean_ratio;
}

TEST(UnseenRoom, UnderTubesGathersTheLightOfTheirHousings) {
  const double ratio = ratio_under_tubes(64);
  // Measured: 0.885; 0.799 where no secondary gather follows another, and 0.806 where none starts
  // beside lamps. Paths between a tube and its housing end after five bounces
  EXPECT_GE(ratio, 0.86);
  EXPECT_LE(ratio, 1.02);
}

TEST(UnseenRoom, UnderTubesLooksUpTheLightOfTheirHousings) {
  const double ratio = ratio_under_tubes(0);
  // Measured: 0.841; 0.793 where corrections are learned without secondary gathers
  EXPECT_GE(ratio, 0.82);
  EXPECT_LE(ratio, 1.02);
}

// White is the colour of materials that state none, as those of untextured models. Light is
// reflected some forty times: what each bounce loses adds up.
TEST(UnseenRoom, OfWhiteMaterialIsAboutAsBrightAsTheReference) {
  Scene scene = furnish(Room{});
  scene.materials[kWalls] = Material{};
  scene.materials[kWalls].metallic = 0.0f;
  const Metrics metrics = compare_with_reference(
      std::move(scene), look_at({5.6f, 1.7f, 4.6f}, {1.5f, 1.1f, 0.8f}, 75.0f * kPi / 180.0f));
  // Measured: 1.037; 0.568 where FieldSettings::max_albedo is 0.95
  EXPECT_GE(metrics.mean_ratio, 0.95);
  EXPECT_LE(metrics.mean_ratio, 1.06);
}

TEST(UnseenRoom, UnderAMirrorIsLitAsTheReferenceLightsIt) {
  Scene scene = scenes::make("cornell").value();
  Material mirror;
  mirror.base_color = glm::vec4(0.95f, 0.95f, 0.95f, 1.0f);
  mirror.roughness = 0.1f;
  for (Instance& instance : scene.instances) {
    if (instance.name == "ceiling") scene.meshes[instance.mesh].material = kCornellMaterials;
  }
  ASSERT_EQ(scene.materials.size(), kCornellMaterials);
  scene.materials.push_back(mirror);
  const Camera camera = scene.cameras.front();
  expect_like_reference(std::move(scene), camera);
}

}  // namespace
}  // namespace lambent::unseen_scenes_test
