// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lambent/field.h"

namespace lambent::grid_fit_test {
namespace {

using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

const Bounds kRoom{{-3.0f, 0.0f, -2.0f}, {3.0f, 3.0f, 2.0f}};

glm::vec3 last_probe(const FieldGrid& grid) {
  return grid.origin + grid.spacing * glm::vec3(grid.count - 1);
}

void expect_sound(const FieldGrid& grid) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(grid.count[k], 2);
    EXPECT_GT(grid.spacing[k], 0.0f);
    EXPECT_TRUE(std::isfinite(grid.spacing[k]) && std::isfinite(grid.origin[k]));
  }
}

TEST(GridFit, GivesTheCountsThatAreAskedFor) {
  FieldSettings settings;
  settings.probe_count = {9, 5, 7};
  const FieldGrid grid = fit_grid(settings, kRoom).value();
  EXPECT_EQ(grid.count, settings.probe_count);
  EXPECT_EQ(grid.probes(), 9 * 5 * 7);
}

TEST(GridFit, PutsTheOutermostProbesJustInsideTheBounds) {
  FieldSettings settings;
  settings.probe_count = {9, 5, 7};
  const FieldGrid grid = fit_grid(settings, kRoom).value();
  for (int k = 0; k < 3; ++k) {
    const float below = grid.origin[k] - kRoom.min[k];
    const float above = kRoom.max[k] - last_probe(grid)[k];
    // In front of the wall, but nearer to it than to the next probe by far
    EXPECT_GT(below, 0.0f);
    EXPECT_LT(below, 0.25f * grid.spacing[k]);
    EXPECT_NEAR(below, above, 1e-4f);
  }
}

TEST(GridFit, SpacesProbesNoWiderThanAskedAndHardlyCloser) {
  for (const float spacing : {0.25f, 0.4f, 1.0f, 1.7f}) {
    FieldSettings settings;
    settings.probe_spacing = spacing;
    const FieldGrid grid = fit_grid(settings, kRoom).value();
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(grid.spacing[k], 1.001f * spacing);
      // As few probes as that takes
      const float cells = static_cast<float>(grid.count[k] - 1);
      if (grid.count[k] > 2) {
        EXPECT_GT((kRoom.max - kRoom.min)[k] / (cells - 1.0f), spacing * 0.999f);
      }
    }
  }
}

TEST(GridFit, SpendsItsBudgetEvenly) {
  for (const int budget : {8, 100, 512, 4096, 30000}) {
    FieldSettings settings;
    settings.probe_budget = budget;
    const FieldGrid grid = fit_grid(settings, kRoom).value();
    expect_sound(grid);
    EXPECT_LE(grid.probes(), budget);
    EXPECT_GE(grid.probes(), budget / 2);
    if (budget < 512) continue;
    EXPECT_LT(std::max({grid.spacing.x, grid.spacing.y, grid.spacing.z}),
              1.5f * std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z}));
  }
}

TEST(GridFit, FillsAGivenVolumeToItsCorners) {
  FieldSettings settings;
  settings.probe_count = {3, 4, 5};
  settings.volume = {{-1.0f, 2.0f, 3.0f}, {1.0f, 5.0f, 7.0f}};
  const FieldGrid grid = fit_grid(settings, kRoom).value();
  EXPECT_LT(glm::distance(grid.origin, settings.volume.min), 1e-5f);
  EXPECT_LT(glm::distance(last_probe(grid), settings.volume.max), 1e-5f);
}

TEST(GridFit, GivesFlatAndEmptyScenesAVolumeToo) {
  const Bounds flat{{-5.0f, 1.0f, -5.0f}, {5.0f, 1.0f, 5.0f}};
  const Bounds line{{0.0f, 0.0f, 0.0f}, {0.0f, 8.0f, 0.0f}};
  const Bounds point{glm::vec3(3.0f), glm::vec3(3.0f)};
  for (const Bounds& bounds : {flat, line, point, Bounds{}}) {
    for (const float spacing : {0.0f, 0.5f}) {
      FieldSettings settings;
      settings.probe_spacing = spacing;
      settings.probe_budget = 512;
      const Expected<FieldGrid> grid = fit_grid(settings, bounds);
      ASSERT_TRUE(grid) << grid.error().message();
      expect_sound(*grid);
    }
  }
}

struct BadCase {
  const char* name;
  const char* word;  // of the message
  void (*spoil)(FieldSettings&);
};

class BadGrid : public testing::TestWithParam<BadCase> {};

TEST_P(BadGrid, IsAnErrorThatNamesTheSetting) {
  FieldSettings settings;
  GetParam().spoil(settings);
  const Expected<FieldGrid> grid = fit_grid(settings, kRoom);
  ASSERT_FALSE(grid);
  EXPECT_THAT(grid.error().message(), HasSubstr(GetParam().word));
  const Expected<IrradianceField> field = IrradianceField::make(settings, kRoom);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().message(), grid.error().message());
}

using S = FieldSettings&;
INSTANTIATE_TEST_SUITE_P(
    Settings, BadGrid,
    testing::Values(
        BadCase{"one_probe", "probes",
                [](S s) {
                  s.probe_count = {1, 4, 4};
                }},
        BadCase{"no_probe_along_an_axis", "probes",
                [](S s) {
                  s.probe_count = {4, 0, 4};
                }},
        BadCase{"negative_count", "probes",
                [](S s) {
                  s.probe_count = {4, 4, -2};
                }},
        BadCase{"too_many_probes", "probes", [](S s) { s.probe_count = glm::ivec3(200); }},
        BadCase{"product_beyond_32_bits", "probes", [](S s) { s.probe_count = glm::ivec3(4096); }},
        BadCase{"negative_spacing", "spacing", [](S s) { s.probe_spacing = -1.0f; }},
        BadCase{"spacing_not_a_number", "spacing", [](S s) { s.probe_spacing = kNaN; }},
        BadCase{"infinite_spacing", "spacing", [](S s) { s.probe_spacing = kInfinity; }},
        BadCase{"spacing_next_to_nothing", "spacing", [](S s) { s.probe_spacing = 1e-30f; }},
        BadCase{"small_spacing", "spacing", [](S s) { s.probe_spacing = 0.01f; }},
        BadCase{"small_budget", "budget", [](S s) { s.probe_budget = 7; }},
        BadCase{"negative_budget", "budget", [](S s) { s.probe_budget = -4096; }},
        BadCase{"volume_not_a_number", "volume",
                [](S s) {
                  s.volume = {glm::vec3(kNaN), glm::vec3(1.0f)};
                }},
        BadCase{"infinite_volume", "volume",
                [](S s) {
                  s.volume = {glm::vec3(0.0f), glm::vec3(1.0f, kInfinity, 1.0f)};
                }},
        BadCase{"volume_inside_out_along_y", "volume",
                [](S s) {
                  s.volume = {glm::vec3(0.0f, 2.0f, 0.0f), glm::vec3(1.0f)};
                }},
        BadCase{"volume_beyond_floats", "volume",
                [](S s) {
                  s.volume = {glm::vec3(-3e38f), glm::vec3(3e38f)};
                }}),
    [](const auto& tested) { return std::string(tested.param.name); });

class BadField : public testing::TestWithParam<BadCase> {};

TEST_P(BadField, IsAnErrorThatNamesTheSetting) {
  FieldSettings settings;
  GetParam().spoil(settings);
  const Expected<IrradianceField> field = IrradianceField::make(settings, kRoom);
  ASSERT_FALSE(field);
  EXPECT_THAT(field.error().message(), HasSubstr(GetParam().word));
}

INSTANTIATE_TEST_SUITE_P(
    Settings, BadField,
    testing::Values(
        BadCase{"few_rays", "rays", [](S s) { s.rays_per_probe = 15; }},
        BadCase{"many_rays", "rays", [](S s) { s.rays_per_probe = 4097; }},
        BadCase{"full_hysteresis", "hysteresis", [](S s) { s.hysteresis = 1.0f; }},
        BadCase{"hysteresis_not_a_number", "hysteresis", [](S s) { s.hysteresis = kNaN; }},
        BadCase{"odd_irradiance_tile", "irradiance", [](S s) { s.irradiance_texels = 5; }},
        BadCase{"large_irradiance_tile", "irradiance", [](S s) { s.irradiance_texels = 18; }},
        BadCase{"small_distance_tile", "distance", [](S s) { s.distance_texels = 3; }},
        BadCase{"albedo_of_one", "albedo", [](S s) { s.max_albedo = 1.0f; }},
        BadCase{"no_tolerance", "tolerance", [](S s) { s.solve_tolerance = 0.0f; }},
        BadCase{"no_iterations", "solve iterations", [](S s) { s.max_solve_iterations = 0; }},
        BadCase{"negative_bounces", "bounces", [](S s) { s.max_bounces = -2; }},
        BadCase{"no_emissive_samples", "emissive", [](S s) { s.emissive_samples = 0; }},
        BadCase{"infinite_lod_bias", "LOD", [](S s) { s.texture_lod_bias = kInfinity; }}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace lambent::grid_fit_test
