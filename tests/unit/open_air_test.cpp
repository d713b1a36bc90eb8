// SPDX-License-Identifier: Apache-2.0
// Light in open air, where lookups read probes that sleep.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "field/field_access.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "field/schedule/schedule.h"
#include "shared/color.h"
#include "support/edited_field.h"
#include "support/field_scenes.h"

namespace lambent::open_air_test {
namespace {

FieldSettings few_probes() {
  FieldSettings settings = test::exact_formats();
  settings.probe_count = glm::ivec3(16, 7, 9);
  settings.rays_per_probe = 64;
  settings.corrections = false;
  return settings;
}

/// Points at the places of the probes that sleep, facing two ways.
std::vector<FieldQuery> points_in_air(const IrradianceField& field) {
  std::vector<FieldQuery> points;
  const ProbeStore& store = store_of(field);
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (statuses_of(field)[probe].state != ProbeState::sleeping) continue;
    for (const float up : {-1.0f, 1.0f}) {
      const glm::vec3 normal(0.0f, up, 0.0f);
      points.push_back({store.probe_position_ws(probe), normal, normal});
    }
  }
  return points;
}

/// What a field holds in open air after one update with as many rays as there may be.
std::vector<glm::vec3> exact_light(const Scene& scene, std::span<const FieldQuery> points) {
  const World world(scene);
  FieldSettings settings = few_probes();
  settings.rays_per_probe = 4096;
  IrradianceField field = IrradianceField::make(settings, open_bounds(world)).value();
  field.update(world);
  return test::look_up(field, points);
}

/// The relative root mean square error of luminance.
double error(const IrradianceField& field, std::span<const FieldQuery> points,
             std::span<const glm::vec3> exact) {
  const std::vector<glm::vec3> found = test::look_up(field, points);
  double squares = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double off = luminance(found[i]) - luminance(exact[i]);
    squares += off * off;
    sum += luminance(exact[i]);
  }
  const auto count = static_cast<double>(exact.size());
  return std::sqrt(squares / count) / (sum / count);
}

/// Two rooms, and a field over them that has had one update.
struct Rooms {
  Rooms()
      : edited("two-rooms", few_probes(), /*updates=*/1),
        points(points_in_air(edited.field)),
        exact(exact_light(edited.scene, points)) {
    EXPECT_GT(points.size(), 400u);
  }

  /// The error in open air when the field has had this many updates.
  double error_after(int updates, const UpdateRequest& request = {}) {
    while (edited.field.updates() < updates) edited.field.update(edited.world, request);
    const double off = error(edited.field, points, exact);
    std::printf("%d updates: relative RMS error in open air %.3f\n", updates, off);
    return off;
  }

  test::Edited edited;
  std::vector<FieldQuery> points;
  std::vector<glm::vec3> exact;
};

// Sleeping probes have averaged one update more than such periods have passed.
constexpr int kPeriod = static_cast<int>(kSleepingPeriod);

TEST(OpenAir, LightConverges) {
  Rooms rooms;
  const double few = rooms.error_after(4);
  EXPECT_LT(rooms.error_after(4 * kPeriod), 0.6 * few);
  EXPECT_LT(rooms.error_after(16 * kPeriod), 0.35 * few);
}

TEST(OpenAir, LightConvergesWithinABudget) {
  Rooms rooms;
  // A fraction of what all probes take
  const UpdateRequest request{.ray_budget = 16384};
  const double few = rooms.error_after(4, request);
  EXPECT_LT(rooms.error_after(16 * kPeriod, request), 0.5 * few);
}

TEST(OpenAir, LightConvergesAgainAfterAnEdit) {
  Rooms rooms;
  rooms.error_after(4 * kPeriod);
  rooms.edited.scene.lights[0].position_ws += glm::vec3(-0.8f, -1.2f, 0.9f);
  ASSERT_TRUE(rooms.edited.world.update().has_value());
  rooms.exact = exact_light(rooms.edited.scene, rooms.points);
  const double few = rooms.error_after(4 * kPeriod + 8);
  EXPECT_LT(rooms.error_after(12 * kPeriod), 0.6 * few);
}

TEST(OpenAir, AveragesWhileEditsGoOn) {
  Rooms rooms;
  const double few = rooms.error_after(4);
  for (int i = 0; i < 10 * kPeriod; ++i) {
    // Too small to be seen
    rooms.edited.scene.lights[0].intensity *= i % 2 == 0 ? 1.0001f : 1.0f / 1.0001f;
    ASSERT_TRUE(rooms.edited.world.update().has_value());
    rooms.edited.field.update(rooms.edited.world);
  }
  EXPECT_LT(rooms.error_after(4 + 10 * kPeriod), 0.6 * few);
}

}  // namespace
}  // namespace lambent::open_air_test
