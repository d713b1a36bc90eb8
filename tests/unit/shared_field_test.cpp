// SPDX-License-Identifier: Apache-2.0
// Fields that several ranks work on together, here threads: what they hold has the bits that one
// rank finds.
#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

#include "field/field_access.h"
#include "support/field_contents.h"
#include "support/field_scenes.h"
#include "support/thread_ranks.h"

namespace lambent::shared_field_test {
namespace {

using test::Contents;
using test::run_as_ranks;
using test::Stage;
using test::updated;

void expect_the_same_of_any_number(const Stage& stage, const FieldSettings& settings) {
  const Contents expected = updated(stage, settings, one_rank());
  for (const int count : {2, 3, 4}) {
    std::vector<Contents> found(count);
    run_as_ranks(count,
                 [&](Ranks& ranks) { found[ranks.own()] = updated(stage, settings, ranks); });
    for (int rank = 0; rank < count; ++rank) {
      EXPECT_TRUE(found[rank].words == expected.words) << rank << " of " << count;
      EXPECT_TRUE(found[rank].light == expected.light) << rank << " of " << count;
      EXPECT_TRUE(found[rank].statistics == expected.statistics) << rank << " of " << count;
      EXPECT_TRUE(found[rank].looked_up == expected.looked_up) << rank << " of " << count;
      EXPECT_EQ(found[rank].updates, expected.updates) << rank << " of " << count;
      EXPECT_EQ(found[rank].rays, expected.rays) << rank << " of " << count;
    }
  }
}

FieldSettings small_field() {
  FieldSettings settings;
  settings.probe_count = {9, 10, 13};
  settings.rays_per_probe = 32;
  return settings;
}

TEST(SharedField, HasTheBitsOfOneRankOnAnyNumberOfRanks) {
  expect_the_same_of_any_number(Stage("cornell"), small_field());
}

TEST(SharedField, HasTheBitsOfOneRankWhereWallsHideProbes) {
  expect_the_same_of_any_number(Stage("two-rooms"), small_field());
}

TEST(SharedField, HasTheBitsOfOneRankWithTilesThatNoTaskHoldsAWholeNumberOf) {
  FieldSettings settings = small_field();
  settings.irradiance_texels = 6;
  expect_the_same_of_any_number(Stage("cornell"), settings);
}

TEST(SharedField, HasTheBitsOfOneRankWithHybridVisibility) {
  FieldSettings settings = small_field();
  settings.visibility = Visibility::hybrid;
  expect_the_same_of_any_number(Stage("two-rooms"), settings);
}

TEST(SharedField, HasTheBitsOfOneRankWithCountedBounces) {
  FieldSettings settings = small_field();
  settings.max_bounces = 2;
  expect_the_same_of_any_number(Stage("cornell"), settings);
}

TEST(SharedField, HasTheBitsOfOneRankWithSeveralVolumes) {
  FieldSettings settings = small_field();
  const Stage stage("cornell");
  const Bounds all = stage.bounds();
  ProbeVolume corner;
  corner.centre = 0.75f * all.min + 0.25f * all.max;
  corner.size = 0.5f * (all.max - all.min);
  settings.volumes.push_back(corner);
  expect_the_same_of_any_number(stage, settings);
}

TEST(SharedField, HasTheBitsOfOneRankWithFewerProbesThanRanks) {
  FieldSettings settings = small_field();
  settings.probe_count = {2, 2, 2};
  const Stage stage("cornell");
  const Contents expected = updated(stage, settings, one_rank());
  std::vector<Contents> found(11);
  run_as_ranks(11, [&](Ranks& ranks) { found[ranks.own()] = updated(stage, settings, ranks); });
  for (const Contents& contents : found) EXPECT_TRUE(contents == expected);
}

TEST(SharedField, KeepsOnEachRankTheSurfelsOfItsOwnProbesAlone) {
  const Stage stage("cornell");
  IrradianceField alone = test::make_field(stage, small_field(), 1);
  std::vector<std::size_t> bytes(4);
  run_as_ranks(4, [&](Ranks& ranks) {
    IrradianceField field = test::make_field(stage, small_field(), 0);
    share_work(field, ranks);
    field.update(stage.world);
    bytes[ranks.own()] = field.surfel_bytes();
  });
  std::size_t sum = 0;
  for (const std::size_t own : bytes) {
    EXPECT_LT(own, alone.surfel_bytes() / 3);
    sum += own;
  }
  EXPECT_EQ(sum, alone.surfel_bytes());
}

TEST(SharedTexels, SumToTheBitsOfASingleRankWhereverTheyArePartedAt) {
  // Spans several tasks, with parts that begin and end within them, and one that is empty
  const std::size_t size = 70001;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1.0f, 3.0f);
  WorkingIrradiance a(size), b(size);
  for (std::size_t i = 0; i < size; ++i) {
    a[i] = {uniform(random), uniform(random), uniform(random), 0.0f};
    b[i] = {uniform(random), uniform(random), uniform(random), 0.0f};
  }
  // What is added beside these is rounded: sums depend on their order
  constexpr float kHuge = 1e17f;
  for (const std::size_t i : {90, 16400, 20500, 33000}) {
    a[i] = {i % 3 == 0 ? kHuge : -kHuge, 0.0f, 0.0f, 0.0f};
    b[i] = {1.0f, 0.0f, 0.0f, 0.0f};
  }
  const double expected = inner_product(a, b);
  const std::vector<std::vector<std::size_t>> partings = {
      {0, 16384, size}, {0, 100, 16385, size}, {0, 20000, 20000, 20001, 30000, size}};
  for (const std::vector<std::size_t>& firsts : partings) {
    const int count = static_cast<int>(firsts.size()) - 1;
    std::vector<double> found(count);
    run_as_ranks(count, [&](Ranks& ranks) {
      const std::size_t first = firsts[ranks.own()], last = firsts[ranks.own() + 1];
      const WorkingIrradiance own_a(a.begin() + first, a.begin() + last);
      const WorkingIrradiance own_b(b.begin() + first, b.begin() + last);
      found[ranks.own()] = SharedTexels(ranks, firsts).inner_product(own_a, own_b);
    });
    for (const double sum : found) EXPECT_EQ(sum, expected) << count << " ranks";
  }
}

}  // namespace
}  // namespace lambent::shared_field_test
