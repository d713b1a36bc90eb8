// SPDX-License-Identifier: Apache-2.0
#include "field/schedule/importance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "field/probes/probe_store.h"
#include "field/probes/volumes.h"
#include "shared/color.h"
#include "support/field_scenes.h"
#include "support/random_store.h"

namespace lambent::importance_test {
namespace {

using test::Stage;

TEST(Importance, OfProbesThatNothingReadsIsNone) {
  ProbeStore store(still_grid({vec3(0.0f), vec3(1.0f), ivec3(6)}), {});
  test::fill_randomly(store);
  const FieldQuery point{vec3(0.5f), vec3(0, 1, 0), vec3(0, 1, 0)};
  const std::vector<float> importance =
      probe_importance(store, {&point, 1}, std::vector<ProbeTrace>(store.probes()));
  EXPECT_EQ(*std::max_element(importance.begin(), importance.end()), 1.0f);
  for (int probe = 0; probe < store.probes(); ++probe) {
    // The eight corners of the cell alone
    const ivec3 coords = probe_coords(store.grid(0), probe);
    const bool corner = glm::all(glm::lessThanEqual(coords, ivec3(1)));
    EXPECT_EQ(importance[probe] > 0.0f, corner) << probe;
  }
  EXPECT_EQ(probe_importance(store, {}, std::vector<ProbeTrace>(store.probes()))[0], 0.0f);
}

TEST(Importance, BringsRaysToWhatIsSeen) {
  // Of sixteen rooms one is seen: a field that knows it is the better there, after as many rays
  const Stage stage("house");
  const std::vector<FieldQuery> points = test::seen_points(stage);
  FieldSettings settings;
  settings.probe_budget = 500;
  const IrradianceField settled = test::make_field(stage, settings, 24);
  const std::vector<glm::vec3> truth = test::look_up(settled, points);
  settings.seed = 2;
  const auto error = [&](std::span<const FieldQuery> seen) {
    IrradianceField field = test::make_field(stage, settings, 0);
    for (int i = 0; i < 24; ++i) field.update(stage.world, {5000, 0.0, std::nullopt, seen});
    const std::vector<glm::vec3> light = test::look_up(field, points);
    double sum = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double d = luminance(light[i]) - luminance(truth[i]);
      sum += d * d;
    }
    return std::sqrt(sum);
  };
  const double told = error(points), untold = error({});
  EXPECT_LT(told, 0.8 * untold);
}

}  // namespace
}  // namespace lambent::importance_test
