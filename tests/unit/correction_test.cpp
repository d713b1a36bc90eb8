// SPDX-License-Identifier: Apache-2.0
// Corrections of lookups: what the table learns, forgets and reads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "field/correction/correction_table.h"
#include "field/correction/train_math.h"

namespace lambent::correction_test {
namespace {

/// A grid of 9 x 9 x 9 probes, 0.8 m apart, so that the finest cells have edges of 0.1 m.
ProbeGrid grid() {
  ProbeGrid grid{};
  grid.origin_ws = vec3(-3.2f);
  grid.spacing = vec3(0.8f);
  grid.axes = mat3(1.0f);
  grid.count = ivec3(9);
  return grid;
}

constexpr vec3 kUp{0.0f, 1.0f, 0.0f};

/// Samples on the floor, of which `ratio(x)` of what is looked up is gathered.
template <class Ratio>
std::vector<CorrectionSample> samples_on_floor(int count, Ratio ratio, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-3.0f, 3.0f), pick(0.0f, 1.0f);
  std::vector<CorrectionSample> samples;
  for (int i = 0; i < count; ++i) {
    // Compilers draw the arguments of a call in orders of their own
    const float z = place(random), x = place(random);
    const vec3 position(x, 0.01f, z);
    samples.push_back({position, kUp, 0, ratio(position.x) * 2.0f, 0.0f, 2.0f, pick(random)});
  }
  return samples;
}

CorrectionTable taught(const std::vector<CorrectionSample>& samples) {
  CorrectionTable table(probe_count(grid()));
  const ProbeGrid grids[] = {grid()};
  table.learn(grids, samples, 1);
  return table;
}

float read(const CorrectionTable& table, const vec3& at, const vec3& normal = kUp,
           CorrectionUse how = CorrectionUse::smooth) {
  return table.at(grid(), 0, at, normal, how);
}

TEST(Corrections, AreOneWhereNothingIsKnown) {
  const CorrectionTable table(probe_count(grid()));
  EXPECT_TRUE(table.empty());
  EXPECT_EQ(read(table, vec3(0.0f)), 1.0f);
}

TEST(Corrections, FollowARatioThatVariesWithThePlace) {
  const auto ratio = [](float x) { return x < 0.0f ? 0.5f : 1.25f; };
  const CorrectionTable table = taught(samples_on_floor(100000, ratio));
  for (float x = -2.5f; x <= 2.5f; x += 0.25f) {
    if (std::abs(x) < 0.3f) continue;
    EXPECT_NEAR(read(table, {x, 0.01f, 0.4f}), ratio(x), 0.03f * ratio(x)) << x;
  }
}

TEST(Corrections, AreNotReadOnSurfacesThatFaceElsewhere) {
  const CorrectionTable table = taught(samples_on_floor(100000, [](float) { return 0.5f; }));
  EXPECT_EQ(read(table, {0.4f, 0.01f, 0.4f}, -kUp), 1.0f);
  EXPECT_EQ(read(table, {0.4f, 0.01f, 0.4f}, {1.0f, 0.0f, 0.0f}), 1.0f);
}

TEST(Corrections, AreSmoothAcrossCells) {
  const CorrectionTable table =
      taught(samples_on_floor(100000, [](float x) { return 1.0f + 0.2f * std::sin(2.0f * x); }));
  float largest = 0.0f, before = read(table, {-2.0f, 0.01f, 0.1f});
  for (float x = -2.0f; x < 2.0f; x += 0.002f) {
    const float here = read(table, {x, 0.01f, 0.1f});
    largest = std::max(largest, std::abs(here - before));
    before = here;
  }
  // Steps of the function itself are at most 0.0008
  EXPECT_LT(largest, 0.004f);
}

TEST(Corrections, ReadFromSingleCellsHaveTheMeanOfInterpolatedOnes) {
  const CorrectionTable table =
      taught(samples_on_floor(100000, [](float x) { return 1.0f + 0.2f * std::sin(2.0f * x); }));
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-2.0f, 2.0f);
  double smooth = 0.0, picked = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const float z = place(random), x = place(random);
    const vec3 at(x, 0.01f, z);
    smooth += read(table, at);
    picked += read(table, at, kUp, CorrectionUse::picked);
  }
  EXPECT_NEAR(picked / smooth, 1.0, 0.005);
}

TEST(Corrections, ReadFromSingleCellsAreThoseOfTheSurface) {
  // Also where the surface is between two layers of cells, as floors at a height of 0 are
  for (const float height : {0.0f, 0.01f, 0.05f}) {
    std::vector<CorrectionSample> samples = samples_on_floor(100000, [](float) { return 0.5f; });
    for (CorrectionSample& sample : samples) sample.position_ws.y = height;
    const CorrectionTable table = taught(samples);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-2.0f, 2.0f);
    double picked = 0.0;
    constexpr int kPlaces = 10000;
    for (int i = 0; i < kPlaces; ++i) {
      const float z = place(random), x = place(random);
      picked += read(table, {x, height, z}, kUp, CorrectionUse::picked);
    }
    EXPECT_NEAR(picked / kPlaces, 0.5, 0.01) << height;
  }
}

struct Spread {
  double mean, deviation;
};

/// Of what lookups read over the floor.
Spread spread_of(const CorrectionTable& table) {
  double sum = 0.0, squares = 0.0;
  int count = 0;
  for (float x = -2.5f; x <= 2.5f; x += 0.05f, ++count) {
    const double ratio = read(table, {x, 0.01f, -0.7f * x});
    sum += ratio;
    squares += ratio * ratio;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

TEST(Corrections, LearnFromGathersThatMeetALamp) {
  // One gather in 50 brings 100 times what is looked up, and the others nothing
  std::vector<CorrectionSample> samples;
  for (int i = 0; i < 1000; ++i) {
    const float gathered = i % 50 == 0 ? 200.0f : 0.0f;
    samples.push_back({{0.05f, 0.01f, 0.05f}, kUp, 0, gathered, 0.0f, 2.0f, 0.5f});
  }
  EXPECT_NEAR(read(taught(samples), {0.05f, 0.01f, 0.05f}), 2.0f, 0.02f);
}

TEST(Corrections, SumTheBrightestSamplesOfACellWithoutOverflow) {
  constexpr std::uint64_t kSamples = 2000;
  EXPECT_LT(kSamples * correction_sum(1e9f, 1.0f, 1.0f).gathered, std::uint64_t{1} << 32);
}

TEST(Corrections, AreSmootherWhereGathersAreNoisy) {
  // Of four samples, three find nothing and one finds four times the light: a variance of 3 L^2
  std::vector<CorrectionSample> samples = samples_on_floor(20000, [](float) { return 1.0f; });
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].gathered = i % 4 == 0 ? 4.0f * samples[i].looked_up : 0.0f;
  }
  const Spread blind = spread_of(taught(samples));
  for (CorrectionSample& sample : samples) {
    sample.variance = 3.0f * sample.looked_up * sample.looked_up;
  }
  const Spread told = spread_of(taught(samples));
  EXPECT_NEAR(blind.mean, 1.0, 0.03);
  EXPECT_NEAR(told.mean, 1.0, 0.03);
  EXPECT_GT(blind.deviation, 0.05);
  EXPECT_LT(told.deviation, 0.4 * blind.deviation);
}

TEST(Corrections, CountQuietSamplesAsOneEach) {
  std::vector<CorrectionSample> samples =
      samples_on_floor(20000, [](float x) { return 1.0f + 0.3f * x / 3.0f; });
  const CorrectionTable silent = taught(samples);
  for (CorrectionSample& sample : samples) {
    sample.variance = 0.9f * kTypicalNoise * sample.looked_up * sample.looked_up;
  }
  const CorrectionTable quiet = taught(samples);
  for (float x = -2.5f; x <= 2.5f; x += 0.1f) {
    EXPECT_EQ(read(quiet, {x, 0.01f, -x}), read(silent, {x, 0.01f, -x}));
  }
}

TEST(Corrections, AreTrustedHoweverMuchLightThereIsInNooks) {
  constexpr float kRatio = 0.5f;
  std::vector<CorrectionSample> samples = samples_on_floor(20000, [](float) { return kRatio; });
  for (CorrectionSample& sample : samples) {
    const bool lampshade = sample.position_ws.x > 2.9f;
    if (lampshade) sample.gathered = 100.0f * sample.looked_up;
    sample.variance = 0.1f * sample.gathered * sample.gathered;
  }
  const CorrectionTable table = taught(samples);
  for (float x = -2.5f; x <= 1.0f; x += 0.25f) {
    EXPECT_NEAR(read(table, {x, 0.01f, 0.4f}), kRatio, 0.02f) << x;
  }
}

TEST(Corrections, AreTheSameWhereBlocksAreRemembered) {
  const CorrectionTable table =
      taught(samples_on_floor(20000, [](float x) { return 1.0f + 0.2f * x; }));
  RecentBlocks recent;
  for (const CorrectionUse use : {CorrectionUse::smooth, CorrectionUse::picked}) {
    for (int i = 0; i < 5000; ++i) {
      // There and back, so that blocks are asked for again and places are shared
      const float x = 3.5f * std::sin(0.37f * static_cast<float>(i));
      const vec3 place(x, 0.02f, 0.5f * x), normal = normalize(vec3(0.3f * x, 1.0f, 0.2f));
      EXPECT_EQ(table.at(grid(), 0, place, normal, use, &recent),
                table.at(grid(), 0, place, normal, use));
    }
  }
}

TEST(Corrections, LearnTheSameInAnyOrder) {
  std::vector<CorrectionSample> samples =
      samples_on_floor(5000, [](float x) { return 1.0f + 0.3f * x / 3.0f; });
  const CorrectionTable forwards = taught(samples);
  std::reverse(samples.begin(), samples.end());
  const CorrectionTable backwards = taught(samples);
  for (float x = -2.5f; x <= 2.5f; x += 0.1f) {
    EXPECT_EQ(read(forwards, {x, 0.01f, -x}), read(backwards, {x, 0.01f, -x}));
  }
}

TEST(Corrections, AreReadTheSameFromTheirBlocks) {
  const CorrectionTable table =
      taught(samples_on_floor(20000, [](float x) { return 1.0f + 0.3f * x / 3.0f; }));
  CorrectionTable restored(probe_count(grid()));
  restored.restore(table.blocks(), 1.0f);
  for (float x = -2.5f; x <= 2.5f; x += 0.1f) {
    EXPECT_EQ(read(restored, {x, 0.01f, -x}), read(table, {x, 0.01f, -x}));
  }
}

TEST(Corrections, FollowLaterSamplesWhereTheLightChanged) {
  const ProbeGrid grids[] = {grid()};
  CorrectionTable table = taught(samples_on_floor(100000, [](float) { return 0.5f; }));
  std::vector<float> kept(probe_count(grid()), 1.0f);
  for (int probe = 0; probe < probe_count(grid()); ++probe) {
    if (probe_coords(grid(), probe).x >= 4) kept[probe] = 0.0f;
  }
  table.forget(grids, kept);
  EXPECT_NEAR(read(table, {-2.0f, 0.01f, 0.4f}), 0.5f, 0.02f);
  EXPECT_NEAR(read(table, {2.0f, 0.01f, 0.4f}), 1.0f, 0.02f);
  table.learn(grids,
              samples_on_floor(
                  50000, [](float) { return 1.5f; }, 2),
              2);
  EXPECT_NEAR(read(table, {2.0f, 0.01f, 0.4f}), 1.5f, 0.05f);
}

TEST(Corrections, ForgetWhatIsNeverConfirmed) {
  const ProbeGrid grids[] = {grid()};
  CorrectionTable table = taught(samples_on_floor(200, [](float) { return 0.5f; }));
  const std::size_t known = table.blocks().size();
  const std::vector<CorrectionSample> elsewhere = {
      {{2.9f, 2.9f, 2.9f}, kUp, 0, 1.0f, 0.0f, 1.0f, 0.5f}};
  for (uint number = 2; number < 60; ++number) table.learn(grids, elsewhere, number);
  EXPECT_LT(table.blocks().size(), known / 10);
}

TEST(Corrections, PickedTogetherAreThoseByThemselves) {
  // Few samples, so that some points read coarser levels, and some none
  const CorrectionTable table =
      taught(samples_on_floor(2000, [](float x) { return x < 0.0f ? 0.5f : 1.25f; }));
  const ProbeGrid probes = grid();
  std::mt19937 random(4);
  std::uniform_real_distribution<float> place(-3.2f, 3.2f);
  std::size_t corrected = 0;
  for (std::size_t count = 1; count <= kMostPicked; ++count) {
    std::vector<CorrectionPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
      const vec3 normal = i % 5 == 0 ? vec3(0.6f, 0.8f, 0.0f) : kUp;
      points.push_back({&probes, 0, {place(random), 0.01f, place(random)}, normal});
    }
    std::vector<float> ratios(count);
    table.picked_at(points, ratios);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(ratios[i],
                read(table, points[i].position_ws, points[i].normal_ws, CorrectionUse::picked));
      corrected += ratios[i] != 1.0f ? 1 : 0;
    }
  }
  EXPECT_GT(corrected, 50u);
}

TEST(Corrections, LearnAtOneSurfelOfEachRun) {
  for (const uint number : {1u, kFilledTraining, kSettledTraining}) {
    const uint stride = training_stride(number);
    double sum = 0.0;
    for (uint point = 0; point < 4000; ++point) {
      const uint surfel = training_surfel(point, number, 1);
      ASSERT_EQ(surfel / stride, point);
      sum += surfel % stride;
    }
    EXPECT_NEAR(sum / 4000.0, 0.5 * (stride - 1.0), 0.03 * stride);
  }
}

}  // namespace
}  // namespace lambent::correction_test
