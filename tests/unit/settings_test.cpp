// SPDX-License-Identifier: Apache-2.0
// Settings that make no sense are refused by name, wherever they are given.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lambent/field.h"
#include "lambent/first_picture.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"
#include "support/field_scenes.h"

namespace lambent::settings_test {
namespace {

const float kNan = std::nanf("");

/// The setting that is refused; empty: none is.
template <class T>
std::string refusal(const Expected<T>& result) {
  return result ? "" : result.error().place;
}

/// The field setting that is refused after an edit of the defaults; empty: none is.
template <class Edit>
std::string refused_of_field(Edit edit) {
  FieldSettings settings;
  settings.probe_count = glm::ivec3(2);
  edit(settings);
  return refusal(IrradianceField::make(settings, {glm::vec3(-1.0f), glm::vec3(1.0f)}));
}

using Field = FieldSettings;

TEST(FieldSettings, OutOfRangeAreRefusedByName) {
  EXPECT_EQ(refused_of_field([](Field&) {}), "");
  EXPECT_EQ(refused_of_field([](Field& s) { s.rays_per_probe = 15; }), "rays");
  EXPECT_EQ(refused_of_field([](Field& s) { s.rays_per_probe = 4097; }), "rays");
  EXPECT_EQ(refused_of_field([](Field& s) { s.hysteresis = 1.0f; }), "hysteresis");
  EXPECT_EQ(refused_of_field([](Field& s) { s.hysteresis = kNan; }), "hysteresis");
  EXPECT_EQ(refused_of_field([](Field& s) { s.irradiance_texels = 5; }), "irradiance texels");
  EXPECT_EQ(refused_of_field([](Field& s) { s.irradiance_texels = 18; }), "irradiance texels");
  EXPECT_EQ(refused_of_field([](Field& s) { s.distance_texels = 3; }), "distance texels");
  EXPECT_EQ(refused_of_field([](Field& s) { s.max_albedo = 1.0f; }), "max albedo");
  EXPECT_EQ(refused_of_field([](Field& s) { s.solve_tolerance = 0.0f; }), "solve tolerance");
  EXPECT_EQ(refused_of_field([](Field& s) { s.max_solve_iterations = 0; }), "max solve iterations");
  EXPECT_EQ(refused_of_field([](Field& s) { s.max_bounces = -2; }), "bounces");
  EXPECT_EQ(refused_of_field([](Field& s) { s.emissive_samples = 65; }), "emissive samples");
  EXPECT_EQ(refused_of_field([](Field& s) { s.texture_lod_bias = kNan; }), "texture LOD bias");
  EXPECT_EQ(refused_of_field([](Field& s) { s.cascades = 17; }), "cascades");
  EXPECT_EQ(refused_of_field([](Field& s) { s.visibility = Visibility(7); }), "visibility");
  EXPECT_EQ(refused_of_field([](Field& s) { s.irradiance_format = IrradianceFormat(9); }),
            "irradiance format");
  EXPECT_EQ(refused_of_field([](Field& s) { s.distance_format = DistanceFormat(2); }),
            "distance format");
  // Unit and orthogonal, but left-handed
  const auto mirror = [](Field& s) { s.volumes.emplace_back().axes[0] *= -1.0f; };
  EXPECT_NE(refused_of_field(mirror), "");
}

TEST(FieldIrradiance, AnswersAsManyQueriesAsThereIsRoomFor) {
  const test::Stage stage("cornell");
  const IrradianceField field = test::make_field(stage, {.probe_count = glm::ivec3(3)});
  const std::vector<FieldQuery> queries(100, {glm::vec3(0.5f), {0, 1, 0}, {0, 1, 0}});
  std::vector<glm::vec3> light(10, glm::vec3(-1.0f));
  field.irradiance(queries, std::span(light).first(4));
  EXPECT_GE(light[3].x, 0.0f);
  EXPECT_EQ(light[4], glm::vec3(-1.0f));
  field.irradiance(std::span(queries).first(6), light);
  EXPECT_GE(light[5].x, 0.0f);
  EXPECT_EQ(light[6], glm::vec3(-1.0f));
  field.irradiance(queries, {});
}

TEST(FirstViewSettings, OutOfRangeAreRefusedByName) {
  const test::Stage stage("cornell");
  const auto refused = [&](const FirstViewSettings& settings) {
    return refusal(first_view(stage.world, settings));
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.vertical_fov = 0.0f}), "vertical fov");
  EXPECT_EQ(refused({.vertical_fov = 3.2f}), "vertical fov");
  EXPECT_EQ(refused({.vertical_fov = kNan}), "vertical fov");
  EXPECT_EQ(refused({.vertical_fov = {}, .aspect = 0.0f}), "aspect");
  EXPECT_EQ(refused({.vertical_fov = {}, .aspect = INFINITY}), "aspect");
}

TEST(VisiblePoints, AreRefusedForPicturesThatCannotBe) {
  const test::Stage stage("cornell");
  Camera camera = stage.scene.cameras.at(0);
  EXPECT_EQ(refusal(visible_points(stage.world, camera, 4, 3)), "");
  EXPECT_EQ(refusal(visible_points(stage.world, camera, 0, 3)), "width");
  EXPECT_EQ(refusal(visible_points(stage.world, camera, 4, 16385)), "height");
  camera.world_from_view[0].x = kNan;
  EXPECT_EQ(refusal(visible_points(stage.world, camera, 4, 3)), "camera");
}

TEST(ReflectiveShadowMaps, AreRefusedForWhatCannotBeMapped) {
  const test::Stage stage("cornell");
  RsmSettings good, bad;
  good.resolution = 8;
  bad.resolution = 0;
  Light light;
  EXPECT_EQ(refusal(render_rsm(stage.world, light, good)), "");
  EXPECT_EQ(refusal(render_rsm(stage.world, light, bad)), "resolution");
  light.intensity.x = -1.0f;
  EXPECT_EQ(refusal(render_rsm(stage.world, light, good)), "light");

  Camera camera = stage.scene.cameras.at(0);
  EXPECT_EQ(refusal(render_rsm(stage.world, camera, 1.0f, good)), "");
  EXPECT_EQ(refusal(render_rsm(stage.world, camera, 1.0f, bad)), "resolution");
  EXPECT_EQ(refusal(render_rsm(stage.world, camera, 0.0f, good)), "aspect");
  EXPECT_EQ(refusal(render_rsms(stage.world, camera, kNan, good)), "aspect");
  EXPECT_EQ(refusal(render_rsms(stage.world, camera, 1.0f, bad)), "resolution");
  camera.vertical_fov = 4.0f;
  EXPECT_EQ(refusal(render_rsm(stage.world, camera, 1.0f, good)), "camera");
  EXPECT_EQ(refusal(render_rsms(stage.world, camera, 1.0f, good)), "camera");
}

TEST(RsmGather, IsRefusedForViewsThatAreNotWhole) {
  const test::Stage stage("cornell");
  const std::vector<glm::vec3> vectors(6, glm::vec3(0.0f));
  const std::vector<float> depths(6, 0.0f);
  RsmIrradiance light;
  const auto refused = [&](const RsmView& view, const RsmSettings& settings) {
    return refusal(RsmGatherer().gather(stage.world, {}, view, settings, light));
  };
  const RsmView whole{3, 2, vectors, vectors, depths};
  RsmView empty = whole, short_of_normals = whole, short_of_depths = whole;
  empty.width = 0;
  short_of_normals.normals_ws = std::span(vectors).first(5);
  short_of_depths.depths = {};
  RsmSettings bad;
  bad.downscale = 0;
  EXPECT_EQ(refused(whole, {}), "");
  EXPECT_EQ(refused(empty, {}), "view");
  EXPECT_EQ(refused(short_of_normals, {}), "view");
  EXPECT_EQ(refused(short_of_depths, {}), "view");
  EXPECT_EQ(refused(whole, bad), "downscale");
}

}  // namespace
}  // namespace lambent::settings_test
