// SPDX-License-Identifier: Apache-2.0
// Fields over time: after edits, with budgets and with scrolling volumes, a field on the device
// holds the same light as one on the processor.
#include <cmath>
#include <random>

#include "field/field_access.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "shared/lang.h"
#include "support/temporary_directory.h"
#include "support/vulkan_device.h"

namespace lambent::field_dynamics_test {
namespace {

// Both fields draw the same random numbers. Some texels differ by a step, because of rays that
// graze edges, and of rounding that changes a dither or a schedule.
constexpr double kTolerance = 0.01;

constexpr int kPoints = 500;

/// Queries at points in the open part of a box, with normals in all directions.
std::vector<FieldQuery> points_in(const Bounds& box) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<FieldQuery> points(kPoints);
  for (FieldQuery& point : points) {
    const vec3 u(unit(random), unit(random), unit(random));
    point.position_ws = box.min + (box.max - box.min) * (0.1f + 0.8f * u);
    point.normal_ws = point.to_viewer_ws =
        normalize(vec3(unit(random), unit(random), unit(random)) - 0.5f);
  }
  return points;
}

/// The same scene in a world on the processor and in one on the device, with a field in each.
class Twins {
 public:
  Twins(const char* name, FieldSettings settings, std::shared_ptr<vulkan::Device> device)
      : scene(*scenes::make(name)), here(scene), there(scene, std::move(device)) {
    const Bounds box = open_bounds(here);
    points = points_in(box);
    cpu = std::make_unique<IrradianceField>(*IrradianceField::make(settings, box));
    field_resources = std::make_unique<IrradianceField>(*IrradianceField::make(settings, box));
  }

  void edited() {
    ASSERT_TRUE(here.update());
    ASSERT_TRUE(there.update());
  }

  /// Moves the scene off the lattice on which the probes of cascades stand: rounding decides
  /// whether the rays of a probe on a wall hit the wall.
  void leave_lattice() {
    for (Instance& instance : scene.instances) {
      instance.world_from_object[3] += vec4(0.037f, 0.041f, 0.043f, 0.0f);
    }
    edited();
  }

  void update(const UpdateRequest& request = {}) {
    on_cpu = cpu->update(here, request);
    on_device = field_resources->update(there, request);
  }

  double difference(bool by_rays = true) const {
    std::vector<glm::vec3> a(points.size()), b(points.size());
    cpu->irradiance(points, a, by_rays ? &here : nullptr);
    field_resources->irradiance(points, b, by_rays ? &there : nullptr);
    double difference_sum = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const vec3 d = a[i] - b[i];
      difference_sum += dot(d, d);
      whole += dot(a[i], a[i]);
    }
    return std::sqrt(difference_sum / whole);
  }

  Scene scene;
  World here, there;
  std::vector<FieldQuery> points;
  std::unique_ptr<IrradianceField> cpu, field_resources;
  UpdateStatistics on_cpu, on_device;
};

FieldSettings small() {
  FieldSettings settings;
  settings.probe_count = {4, 4, 4};
  settings.rays_per_probe = 32;
  return settings;
}

using FieldOverTime = test::OnDevice;

TEST_F(FieldOverTime, AveragesAlike) {
  Twins twins("cornell", small(), shared_device());
  for (int i = 0; i < 6; ++i) twins.update();
  EXPECT_LE(twins.difference(), kTolerance);
  EXPECT_EQ(twins.on_device.probe_rays, twins.on_cpu.probe_rays);
  EXPECT_NEAR(static_cast<double>(twins.on_device.shadow_rays),
              static_cast<double>(twins.on_cpu.shadow_rays),
              kTolerance * static_cast<double>(twins.on_cpu.shadow_rays));
  EXPECT_GT(twins.on_device.correction_rays, 0u);
  EXPECT_NEAR(static_cast<double>(twins.on_device.correction_rays),
              static_cast<double>(twins.on_cpu.correction_rays),
              kTolerance * static_cast<double>(twins.on_cpu.correction_rays));
  EXPECT_EQ(twins.on_device.solve_iterations, twins.on_cpu.solve_iterations);
  EXPECT_NEAR(twins.on_device.change, twins.on_cpu.change, 0.01 * twins.on_cpu.change);
}

TEST_F(FieldOverTime, FollowsALampAlike) {
  Twins twins("cornell", small(), shared_device());
  for (int i = 0; i < 3; ++i) twins.update();
  for (Material& material : twins.scene.materials) material.emission *= 0.25f;
  twins.edited();
  twins.update();
  EXPECT_LE(twins.difference(), kTolerance);
  EXPECT_EQ(twins.on_device.probes_invalidated, twins.on_cpu.probes_invalidated);
  twins.update();
  EXPECT_LE(twins.difference(), kTolerance);
}

TEST_F(FieldOverTime, FollowsAMovedBoxAlike) {
  Twins twins("cornell", small(), shared_device());
  twins.scene.instances.back().dynamic = true;
  twins.edited();
  for (int i = 0; i < 3; ++i) twins.update();
  twins.scene.instances.back().world_from_object[3].x += 0.15f;
  twins.edited();
  twins.update();
  EXPECT_LE(twins.difference(), kTolerance);
  for (int i = 0; i < 2; ++i) twins.update();
  EXPECT_LE(twins.difference(), kTolerance);
}

/// A request with a budget that suffices for less than half of the probes.
UpdateRequest scarce_rays() {
  UpdateRequest request;
  request.ray_budget = 1000;
  request.viewer_ws = vec3(0.5f, 0.5f, 0.5f);
  return request;
}

// If rounding changes one choice of a schedule, all later choices differ as well. Budgets are
// therefore compared over a few updates, which choose the same probes on both sides: the first four
// trace each probe, and the fifth those with the largest errors.
constexpr int kScarceUpdates = 5;

TEST_F(FieldOverTime, SpendsABudgetAlike) {
  Twins twins("two-rooms", small(), shared_device());
  const UpdateRequest request = scarce_rays();
  for (int i = 0; i < kScarceUpdates; ++i) {
    twins.update(request);
    EXPECT_EQ(twins.on_device.probes_traced, twins.on_cpu.probes_traced) << "update " << i;
    EXPECT_LE(twins.difference(), kTolerance) << "update " << i;
  }
}

TEST_F(FieldOverTime, SpendsABudgetOnSeenPointsAlike) {
  Twins twins("two-rooms", small(), shared_device());
  UpdateRequest request = scarce_rays();
  twins.update(request);
  // With visible points, the schedule also depends on the importance that surfels scatter
  request.seen = twins.points;
  for (int i = 1; i < kScarceUpdates; ++i) {
    twins.update(request);
    EXPECT_EQ(twins.on_device.probes_traced, twins.on_cpu.probes_traced) << "update " << i;
    EXPECT_LE(twins.difference(), kTolerance) << "update " << i;
  }
}

TEST_F(FieldOverTime, CountsBouncesAlike) {
  FieldSettings settings = small();
  settings.max_bounces = 2;
  Twins twins("cornell", settings, shared_device());
  for (int i = 0; i < 2; ++i) twins.update();
  EXPECT_LE(twins.difference(), kTolerance);
}

TEST_F(FieldOverTime, FollowsTheViewerAlike) {
  FieldSettings settings;
  settings.cascades = 2;
  settings.probe_count = {4, 4, 4};
  settings.probe_spacing = 0.15f;
  settings.rays_per_probe = 32;
  Twins twins("cornell", settings, shared_device());
  twins.leave_lattice();
  UpdateRequest request;
  for (int i = 0; i < 4; ++i) {
    request.viewer_ws = vec3(0.2f + 0.1f * static_cast<float>(i), 0.25f, 0.3f);
    twins.update(request);
    EXPECT_EQ(twins.on_device.probes_recycled, twins.on_cpu.probes_recycled);
  }
  EXPECT_LE(twins.difference(), kTolerance);
}

TEST_F(FieldOverTime, SeesByRaysAlike) {
  for (const Visibility visibility : {Visibility::hybrid, Visibility::exact}) {
    FieldSettings settings = small();
    settings.visibility = visibility;
    Twins twins("two-rooms", settings, shared_device());
    for (int i = 0; i < 2; ++i) twins.update();
    EXPECT_NE(device_lookups_of(*twins.field_resources), nullptr);
    EXPECT_LE(twins.difference(), kTolerance);
    EXPECT_NEAR(static_cast<double>(twins.on_device.shadow_rays),
                static_cast<double>(twins.on_cpu.shadow_rays),
                kTolerance * static_cast<double>(twins.on_cpu.shadow_rays));
    EXPECT_NEAR(static_cast<double>(twins.on_device.correction_rays),
                static_cast<double>(twins.on_cpu.correction_rays),
                kTolerance * static_cast<double>(twins.on_cpu.correction_rays));
    EXPECT_LE(twins.difference(/*by_rays=*/false), kTolerance);
  }
}

TEST_F(FieldOverTime, SeesMovedBoxesByRaysAlike) {
  FieldSettings settings = small();
  settings.visibility = Visibility::hybrid;
  Twins twins("cornell", settings, shared_device());
  twins.scene.instances.back().dynamic = true;
  twins.edited();
  for (int i = 0; i < 2; ++i) twins.update();
  twins.scene.instances.back().world_from_object[3].x += 0.15f;
  twins.edited();
  for (int i = 0; i < 2; ++i) {
    twins.update();
    EXPECT_LE(twins.difference(), kTolerance);
  }
}

TEST_F(FieldOverTime, SeesByRaysInCascadesAlike) {
  FieldSettings settings;
  settings.cascades = 2;
  settings.probe_count = {4, 4, 4};
  settings.probe_spacing = 0.31f;
  settings.rays_per_probe = 32;
  settings.visibility = Visibility::hybrid;
  Twins twins("two-rooms", settings, shared_device());
  twins.leave_lattice();
  UpdateRequest request;
  for (int i = 0; i < 3; ++i) {
    request.viewer_ws = vec3(0.2f + 0.3f * static_cast<float>(i), 0.25f, 0.3f);
    twins.update(request);
  }
  EXPECT_LE(twins.difference(), kTolerance);
}

TEST_F(FieldOverTime, ComesAndGoesWithItsLight) {
  Twins twins("cornell", small(), shared_device());
  for (int i = 0; i < 4; ++i) twins.update();
  // The device's field continues on the processor, and the processor's on the device
  twins.cpu->update(twins.there);
  twins.field_resources->update(twins.here);
  std::vector<glm::vec3> a(twins.points.size()), b(a);
  twins.cpu->irradiance(twins.points, a);
  twins.field_resources->irradiance(twins.points, b);
  EXPECT_LE(twins.difference(), kTolerance);
  EXPECT_NE(device_lookups_of(*twins.cpu), nullptr);
  EXPECT_EQ(device_lookups_of(*twins.field_resources), nullptr);
}

TEST_F(FieldOverTime, IsSavedAsItIs) {
  const test::TemporaryDirectory directory;
  Twins twins("cornell", small(), shared_device());
  for (int i = 0; i < 2; ++i) twins.update();
  const std::string path = directory.file("cornell.field");
  ASSERT_TRUE(save_field(path, *twins.field_resources, twins.there));
  const Expected<LoadedField> loaded = load_field(path, small(), twins.here);
  ASSERT_TRUE(loaded);
  std::vector<glm::vec3> a(twins.points.size()), b(a);
  twins.field_resources->irradiance(twins.points, a);
  loaded->field.irradiance(twins.points, b);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(length(a[i] - b[i]), 0.0f, 1e-4f * length(a[i]) + 1e-6f);
  }
}

TEST_F(FieldOverTime, IsTheSameToTheBitTwice) {
  Twins one("cornell", small(), shared_device()), other("cornell", small(), shared_device());
  for (int i = 0; i < 3; ++i) {
    one.field_resources->update(one.there);
    other.field_resources->update(other.there);
  }
  std::vector<glm::vec3> a(one.points.size()), b(a);
  one.field_resources->irradiance(one.points, a);
  other.field_resources->irradiance(one.points, b);
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace lambent::field_dynamics_test
