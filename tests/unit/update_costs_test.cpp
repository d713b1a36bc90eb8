// SPDX-License-Identifier: Apache-2.0
// How updates are fitted into a time.
#include <gtest/gtest.h>

#include <limits>

#include "field/schedule/schedule.h"
#include "field/schedule/update_costs.h"
#include "support/edited_field.h"

namespace lambent::update_costs_test {
namespace {

constexpr double kBudgetMs = 50.0;
constexpr double kMsPerRay = 1e-3;

/// The number of rays that a field traces after many updates of kBudgetMs in which all but rays
/// takes this long.
double rays_after_many(double other_ms) {
  RayCost cost;
  std::uint64_t rays = 0;
  for (int update = 0; update < 100; ++update) {
    rays = cost.rays_within(kBudgetMs, 0.0);
    cost.learn(rays, kMsPerRay * static_cast<double>(rays), other_ms);
  }
  return static_cast<double>(rays);
}

TEST(RayCost, RaysFillTheTimeThatAllElseLeaves) {
  EXPECT_NEAR(rays_after_many(0.0), kBudgetMs / kMsPerRay, 1.0);
  EXPECT_NEAR(rays_after_many(20.0), (kBudgetMs - 20.0) / kMsPerRay, 1.0);
}

TEST(RayCost, RaysHaveHalfOfTheTimeWhereAllElseTakesLonger) {
  EXPECT_NEAR(rays_after_many(400.0), 0.5 * kBudgetMs / kMsPerRay, 1.0);
}

TEST(RayCost, NeverTracesLessThanAProbe) {
  RayCost cost;
  cost.learn(1, 1e6, 0.0);
  EXPECT_EQ(cost.rays_within(kBudgetMs, 0.0), static_cast<std::uint64_t>(kRayClasses.front()));
}

TEST(RayCost, CountsAllTimeAsThatOfRaysWhereTheirsIsNotMeasured) {
  RayCost cost;
  cost.learn(1000, 0.0, 10.0);
  EXPECT_EQ(cost.rays_within(kBudgetMs, 0.0), 5000u);
}

TEST(RayCost, KnowsNumbersForAnyTime) {
  RayCost cost;
  EXPECT_GT(cost.rays_within(std::numeric_limits<double>::infinity(), 0.0), 1000000u);
  cost.learn(1024, 1.0, 0.0);
  EXPECT_EQ(cost.rays_within(kBudgetMs, 20.0), 30u * 1024u);
  EXPECT_EQ(cost.rays_within(kBudgetMs, 200.0), 25u * 1024u);
}

TEST(EditCost, KnowsTheLastSliceAlone) {
  EditCost cost;
  cost.learn_slice(16, 80.0);
  EXPECT_EQ(cost.probes_within(kBudgetMs), 16u) << "a slice has a cost of its own";
  // A lamp differs after a door has moved
  cost.learn_slice(16, 0.8);
  EXPECT_EQ(cost.probes_within(kBudgetMs), 1000u);
  EXPECT_GT(cost.probes_within(std::numeric_limits<double>::infinity()), 1000000u);
}

TEST(EditCost, LeavesTimeForTheSolve) {
  EditCost cost;
  cost.learn_other(10.0);
  EXPECT_DOUBLE_EQ(cost.time_left(kBudgetMs, 5.0), 35.0);
  EXPECT_DOUBLE_EQ(cost.time_left(kBudgetMs, 100.0), 25.0);
}

TEST(TimeBudget, ReachesEveryProbeSoonHoweverShortTheTime) {
  test::Edited edited("cornell-spot");
  edited.scene.lights[0].intensity *= 0.25f;
  ASSERT_TRUE(edited.world.update());
  int updates = 0, stale = 1;
  for (; stale > 0 && updates < 200; ++updates) {
    stale = edited.field.update(edited.world, {.time_budget_ms = 1e-3}).probes_stale;
    EXPECT_TRUE(stale > 0 || updates > 0) << "no update takes a microsecond";
  }
  // One probe an update would take as many updates as there are probes
  EXPECT_LT(updates, edited.field.probes() / 4);
}

}  // namespace
}  // namespace lambent::update_costs_test
