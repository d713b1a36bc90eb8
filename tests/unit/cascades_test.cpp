// SPDX-License-Identifier: Apache-2.0
// Light in fields of several volumes, and in ones that follow the viewer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "field/field_access.h"
#include "field/probes/probe_status.h"
#include "shared/color.h"
#include "support/field_scenes.h"
#include "support/temporary_directory.h"

namespace lambent::cascades_test {
namespace {

using test::look_up;
using test::make_field;
using test::seen_points;
using test::Stage;

/// A box to stand in the middle of.
const Stage& cornell() {
  static const Stage stage("cornell");
  return stage;
}
// Functions, so that the room is surveyed in processes that run these tests alone
vec3 room_middle() {
  static const Bounds bounds = cornell().bounds();
  return 0.5f * (bounds.min + bounds.max);
}
float probe_spacing() {
  static const Bounds bounds = cornell().bounds();
  return (bounds.max.x - bounds.min.x) / 7.0f;
}

/// Cascades, the finest of which fills the box.
FieldSettings cascades(int levels) {
  FieldSettings settings;
  settings.cascades = levels;
  settings.probe_count = ivec3(10);
  settings.probe_spacing = probe_spacing();
  settings.rays_per_probe = 64;
  return settings;
}

double mean_luminance(const std::vector<glm::vec3>& light) {
  double sum = 0.0;
  for (const glm::vec3& e : light) sum += luminance(e);
  return sum / static_cast<double>(light.size());
}

/// Largest and root mean square difference of luminance, over b's mean.
struct Difference {
  double largest = 0.0, rms = 0.0;
};
Difference difference(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  Difference result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::abs(luminance(a[i]) - luminance(b[i]));
    result.largest = std::max(result.largest, d);
    result.rms += d * d;
  }
  const double mean = mean_luminance(b);
  result.rms = std::sqrt(result.rms / static_cast<double>(a.size())) / mean;
  result.largest /= mean;
  return result;
}

IrradianceField settled_cascades(const Stage& stage, const FieldSettings& settings,
                                 const vec3& viewer, int updates = 12) {
  IrradianceField field = make_field(stage, settings, 0);
  for (int i = 0; i < updates; ++i) field.update(stage.world, {0, 0.0, viewer});
  return field;
}

TEST(Cascades, HoldTheLightOfOneVolume) {
  const Stage& stage = cornell();
  FieldSettings one;
  one.probe_count = ivec3(8);
  const std::vector<FieldQuery> points = seen_points(stage);
  const std::vector<glm::vec3> expected = look_up(make_field(stage, one, 8), points);
  const IrradianceField field = settled_cascades(stage, cascades(2), room_middle());
  EXPECT_EQ(field.grids().size(), 2u);
  EXPECT_EQ(field.probes(), 2000);
  const std::vector<glm::vec3> light = look_up(field, points);
  // With direct light free of noise (16 samples of emitters), cascades are 5.5 % darker
  EXPECT_NEAR(mean_luminance(light), mean_luminance(expected), 0.07 * mean_luminance(expected));
  EXPECT_LT(difference(light, expected).rms, 0.15);
}

TEST(Cascades, ATurnedVolumeHoldsTheSameLight) {
  const Stage& stage = cornell();
  const std::vector<FieldQuery> points = seen_points(stage);
  FieldSettings settings;
  settings.probe_count = ivec3(6);
  const std::vector<glm::vec3> straight = look_up(make_field(stage, settings, 8), points);
  ProbeVolume volume;
  volume.centre = room_middle();
  volume.size = vec3(9.0f * probe_spacing());
  volume.probe_count = ivec3(10);
  const float c = std::cos(0.6f), s = std::sin(0.6f);
  volume.axes = {{c, 0.0f, -s}, {0.0f, 1.0f, 0.0f}, {s, 0.0f, c}};
  settings.volumes = {volume};
  const IrradianceField field = make_field(stage, settings, 8);
  const std::vector<glm::vec3> light = look_up(field, points);
  EXPECT_NEAR(mean_luminance(light), mean_luminance(straight), 0.05 * mean_luminance(straight));
  EXPECT_LT(difference(light, straight).rms, 0.15);
}

TEST(Cascades, CoarseOnesAreTracedLessOften) {
  const Stage& stage = cornell();
  IrradianceField field = settled_cascades(stage, cascades(3), room_middle(), 1);
  const std::vector<ProbeStatus> first(statuses_of(field).begin(), statuses_of(field).end());
  for (int i = 0; i < 16; ++i) field.update(stage.world, {0, 0.0, room_middle()});
  for (int level = 0; level < 3; ++level) {
    float samples = 0.0f;
    int live = 0;
    for (int probe = 1000 * level; probe < 1000 * (level + 1); ++probe) {
      const ProbeStatus& record = statuses_of(field)[probe];
      if (record.state != ProbeState::vigilant) continue;
      samples += record.samples - first[probe].samples;
      ++live;
    }
    ASSERT_GT(live, 0);
    EXPECT_NEAR(samples / static_cast<float>(live), 16.0f / static_cast<float>(1 << level), 0.01f);
  }
}

TEST(Cascades, AScrollIsNotSeen) {
  const Stage& stage = cornell();
  const std::vector<FieldQuery> points = seen_points(stage);
  for (const vec3& way : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0),
                          vec3(0, 0, 1), vec3(0, 0, -1)}) {
    IrradianceField field = settled_cascades(stage, cascades(2), room_middle(), 16);
    // Three quarters of a cell off its middle the finest volume moves on
    const vec3 middle = field.grids()[0].origin + 4.5f * probe_spacing();
    const vec3 nearly = middle + 0.74f * probe_spacing() * way;
    const vec3 there = middle + 0.76f * probe_spacing() * way;
    for (int i = 0; i < 4; ++i) field.update(stage.world, {64, 0.0, nearly});
    const std::vector<glm::vec3> before = look_up(field, points);
    const int recycled = field.update(stage.world, {64, 0.0, there}).probes_recycled;
    const std::vector<glm::vec3> after = look_up(field, points);
    EXPECT_EQ(recycled, 100);
    EXPECT_LT(difference(after, before).largest, 0.02);
  }
}

TEST(Cascades, NewProbesTakeOverTheLightThatWasThere) {
  const Stage& stage = cornell();
  IrradianceField field = settled_cascades(stage, cascades(2), room_middle(), 16);
  const std::vector<FieldQuery> points = seen_points(stage);
  const std::vector<glm::vec3> before = look_up(field, points);
  // Two cells at once, and nearly no rays to learn anything with
  const UpdateStatistics moved = field.update(
      stage.world, {64, 0.0, room_middle() + probe_spacing() * vec3(2.0f, 0.0f, 0.0f)});
  EXPECT_GT(moved.probes_recycled, 0);
  EXPECT_LE(moved.probe_rays, 64u);
  EXPECT_LT(difference(look_up(field, points), before).rms, 0.1);
  EXPECT_NEAR(mean_luminance(look_up(field, points)), mean_luminance(before),
              0.03 * mean_luminance(before));
}

TEST(Cascades, FollowEditsWhileTheViewerMoves) {
  Scene scene = cornell().scene;
  World world(scene);
  IrradianceField field = IrradianceField::make(cascades(2), open_bounds(world)).value();
  vec3 viewer = room_middle();
  for (int i = 0; i < 12; ++i) field.update(world, {0, 0.0, viewer});
  const std::vector<FieldQuery> points = seen_points(cornell());
  const double before = mean_luminance(look_up(field, points));
  for (Material& material : scene.materials) material.emission *= 2.0f;
  ASSERT_TRUE(world.update());
  for (int i = 0; i < 6; ++i) {
    viewer.x += 0.4f * probe_spacing();
    field.update(world, {20000, 0.0, viewer});
  }
  EXPECT_NEAR(mean_luminance(look_up(field, points)), 2.0 * before, 0.1 * before);
}

TEST(Cascades, SurviveTheirFile) {
  test::TemporaryDirectory folder;
  const std::string path = folder.file("a.field");
  const Stage& stage = cornell();
  IrradianceField field = settled_cascades(stage, cascades(2), room_middle(), 4);
  field.update(stage.world, {0, 0.0, room_middle() + probe_spacing() * vec3(2.0f, -1.0f, 1.0f)});
  ASSERT_TRUE(save_field(path, field, stage.world));
  Expected<LoadedField> loaded = load_field(path, cascades(2), stage.world);
  ASSERT_TRUE(loaded) << loaded.error().message();
  const std::vector<FieldQuery> points = seen_points(stage);
  EXPECT_LT(difference(look_up(loaded->field, points), look_up(field, points)).largest, 1e-6);
  // ... and goes on following
  const vec3 on = room_middle() + probe_spacing() * vec3(3.0f, -1.0f, 1.0f);
  EXPECT_GT(loaded->field.update(stage.world, {0, 0.0, on}).probes_recycled, 0);
  field.update(stage.world, {0, 0.0, on});
  EXPECT_LT(difference(look_up(loaded->field, points), look_up(field, points)).rms, 0.1);
}

}  // namespace
}  // namespace lambent::cascades_test
