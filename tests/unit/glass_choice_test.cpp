// SPDX-License-Identifier: Apache-2.0
// How the paths of a pixel's samples choose between reflection and crossing at glass.
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "glossy/path_math.h"

namespace lambent::glass_choice_test {
namespace {

constexpr uint kSeed = 5;

TEST(GlassChoice, OfSuccessiveSamplesLieInEqualParts) {
  for (uint pixel = 0; pixel < 50; ++pixel) {
    for (const uint bounce : {1u, 2u, 7u}) {
      for (uint first = 0; first < 16; first += 4) {
        std::set<int> parts;
        for (uint i = first; i < first + 4; ++i) {
          parts.insert(static_cast<int>(
              4.0f * glass_choice(pixel, pack_path_step(bounce, i, 4), kSeed).number));
        }
        EXPECT_EQ(parts, (std::set<int>{0, 1, 2, 3})) << pixel << " " << bounce;
      }
    }
  }
}

// Two surfaces of which each lets three of four samples pass let nine of sixteen pass together, at
// each pixel.
TEST(GlassChoice, OfTwoBouncesAreIndependentAtEachPixel) {
  constexpr uint kSamples = 1024;
  for (uint pixel = 0; pixel < 20; ++pixel) {
    int both = 0;
    for (uint i = 0; i < kSamples; ++i) {
      const auto number = [&](uint bounce) {
        return glass_choice(pixel, pack_path_step(bounce, i, 4), kSeed).number;
      };
      if (number(1) < 0.75f && number(2) < 0.75f) ++both;
    }
    EXPECT_NEAR(static_cast<double>(both) / kSamples, 0.5625, 0.04) << pixel;
  }
}

/// A smooth branch at the glass that it is to pass next.
CoatPath path_through_glass() {
  CoatPath path = begin_path_through_glass(0.0f, 0.0f);
  path.fork = kForkBranch;
  return path;
}

/// Sums, over samples of a pixel, of what paths carry on from their first choice that are reflected
/// and that cross.
vec2 carried(Transmission through, uint samples) {
  const Reflectance glass = coated_reflectance(vec3(1.0f), 0.0f, 0.0f, 1.0f, vec3(1.0f), 1.5f);
  const vec3 normal(0.0f, 0.0f, 1.0f), to_viewer = normalize(vec3(0.3f, 0.0f, 1.0f));
  vec2 sums(0.0f);
  for (uint i = 0; i < samples; ++i) {
    CoatPath path = path_through_glass();
    const NextRay next =
        go_on(through, glass, {1.0f, 0.0f}, normal, normal, to_viewer, 0.0f, kFirstBounceOfForks,
              glass_choice(9, pack_path_step(kFirstBounceOfForks, i, samples), kSeed),
              make_random_stream(9, i, kSeed), path);
    const bool crosses = next.side < 0.0f || next.direction_ws.z < 0.0f;
    (crosses ? sums.y : sums.x) += path.throughput.x / static_cast<float>(samples);
  }
  return sums;
}

// Four samples of a pixel carry all of the 4 % that glass reflects and all that it lets pass: they
// are as dark or bright in the next pixel.
TEST(GlassChoice, FourSamplesCarryWhatIsReflectedAndWhatPasses) {
  constexpr float kReflected = 0.04f;
  Transmission pane = no_transmission();
  pane.tint = vec3(1.0f);
  pane.alpha = 0.0f;
  Transmission out_of_volume = pane;
  out_of_volume.kind = kLeavesVolume;
  out_of_volume.eta = 1.5f;
  for (const Transmission& through : {pane, out_of_volume}) {
    for (const uint samples : {4u, 16u}) {
      const vec2 sums = carried(through, samples);
      EXPECT_NEAR(sums.x, kReflected, 0.01f);
      EXPECT_NEAR(sums.y, 1.0f - kReflected, 0.01f);
    }
  }
}

// Of branches with weights, each of which meets other light, one is kept.
TEST(GlassBranches, OneStandsForAll) {
  constexpr float kWeights[] = {0.04f, 0.3f, 0.01f}, kLight[] = {5.0f, 1.0f, 200.0f};
  constexpr int kDraws = 4096;
  double sum = 0.0, expected = 0.0;
  for (int k = 0; k < 3; ++k) expected += kWeights[k] * kLight[k];
  for (int draw = 0; draw < kDraws; ++draw) {
    Reservoir branches = begin_reservoir((static_cast<float>(draw) + 0.5f) / kDraws);
    float kept = 0.0f, light = 0.0f;
    for (int k = 0; k < 3; ++k) {
      float factor = 1.0f;
      if (keeps_branch(kWeights[k], branches, factor)) {
        kept = kWeights[k];
        light = kLight[k];
      }
      kept *= factor;
    }
    sum += kept * light;
  }
  EXPECT_NEAR(sum / kDraws, expected, 0.01 * expected);
}

// The main way within a volume is the greater part of the light, and it and its branch are all.
TEST(GlassBranches, AndTheMainWayAreAllTheLight) {
  const Reflectance glass = coated_reflectance(vec3(1.0f), 0.0f, 0.0f, 1.0f, vec3(1.0f), 1.5f);
  Transmission leaves = no_transmission();
  leaves.tint = vec3(1.0f);
  leaves.alpha = 0.0f;
  leaves.kind = kLeavesVolume;
  leaves.eta = 1.5f;
  const vec3 normal(0.0f, 0.0f, 1.0f);
  // Straight on, and just within the critical angle
  for (const auto& [sine, samples] :
       {std::pair(0.0f, 1u), std::pair(0.6666f, 1u), std::pair(0.0f, 4u), std::pair(0.6666f, 4u)}) {
    const vec3 to_viewer(sine, 0.0f, std::sqrt(1.0f - sine * sine));
    const bool is_reflected = inner_reflection(to_viewer.z, leaves.eta) > 0.5f;
    EXPECT_EQ(is_reflected, sine > 0.0f);
    CoatPath path = path_through_glass(), branch;
    path.fork = kForks;
    ASSERT_TRUE(forks(path, leaves, glass, 1.0f, to_viewer.z, kFirstBounceOfForks));
    const RandomStream random = make_random_stream(9, 0, kSeed);
    split(leaves, glass, {1.0f, 0.0f}, normal, normal, to_viewer, 0.0f,
          pack_path_step(kFirstBounceOfForks, 0u, samples), random, path, branch);
    EXPECT_EQ(branch.stage, samples == 1u ? kStageLongWay : kStageThroughGlass);
    const NextRay next = go_on(leaves, glass, {1.0f, 0.0f}, normal, normal, to_viewer, 0.0f,
                               kFirstBounceOfForks, {}, random, path);
    EXPECT_EQ(next.side > 0.0f, is_reflected);
    EXPECT_GE(path.throughput.x, 0.5f);
    EXPECT_NEAR(path.throughput.x + branch.throughput.x, 1.0f, 1e-5f);
  }
}

// A coat that light of long ways meets samples lights: what hits them after it, behind glass, is
// weighed against these samples.
TEST(GlassBranches, KnowTheCoatThatSampledLightsBehindGlass) {
  const Reflectance metal = coated_reflectance(vec3(0.9f), 1.0f, 0.5f, 1.0f, vec3(1.0f), 1.5f);
  const Reflectance glass = coated_reflectance(vec3(1.0f), 0.0f, 0.0f, 1.0f, vec3(1.0f), 1.5f);
  Transmission pane = no_transmission();
  pane.tint = vec3(1.0f);
  pane.alpha = 0.0f;
  pane.kind = kCrossesPane;
  const vec3 normal(0.0f, 0.0f, 1.0f);
  CoatPath path = path_through_glass();
  path.stage = kStageLongWay;
  path.fork = kForkBranch;
  const RandomStream random = make_random_stream(9, 0, kSeed);
  go_on(no_transmission(), metal, {1.0f, 0.0f}, normal, normal, normal, 2.0f, kFirstBounceOfForks,
        {}, random, path);
  ASSERT_GT(path.pdf, 0.0f);
  const float pdf = path.pdf;
  extend_through_glass(pane, glass, normal, normal, 3.0f, vec3(0.5f), path);
  EXPECT_EQ(path.pdf, pdf);
  EXPECT_EQ(path.density_scale, 2.0f);
}

// Rays of one pixel's coat, of which each has a random stream, choose apart.
TEST(GlassChoice, OfFewSamplesIsEachRaysOwn) {
  const Reflectance glass = coated_reflectance(vec3(1.0f), 0.0f, 0.0f, 1.0f, vec3(1.0f), 1.5f);
  Transmission half = no_transmission();
  half.alpha = 0.0f;
  half.tint = vec3(0.04f);
  const vec3 normal(0.0f, 0.0f, 1.0f);
  int crossing = 0;
  constexpr int kRays = 200;
  for (uint ray = 0; ray < kRays; ++ray) {
    CoatPath path = path_through_glass();
    const NextRay next = go_on(half, glass, {1.0f, 0.0f}, normal, normal, normal, 0.0f, 2,
                               glass_choice(9, pack_path_step(2, 0, 1), kSeed),
                               make_random_stream(9, ray, kSeed), path);
    if (next.side < 0.0f) ++crossing;
  }
  EXPECT_GT(crossing, kRays / 4);
  EXPECT_LT(crossing, kRays * 3 / 4);
}

// With fewer samples chances are in proportion: none of them may show reflections alone.
TEST(GlassChoice, OfFewSamplesIsInProportion) {
  EXPECT_EQ(glass_choice(1, pack_path_step(kFirstBounceOfForks, 0, 2), kSeed).least_chance, 0.0f);
  EXPECT_EQ(glass_choice(1, pack_path_step(kFirstBounceOfForks, 0, 4), kSeed).least_chance,
            kLeastGlassChance);
}

// Each choice in favour of faint reflections makes the paths that cross rarer and heavier.
TEST(GlassChoice, PathsThroughManySurfacesWeighLessThanTwice) {
  float weight = 1.0f;
  for (uint bounce = kFirstBounceOfForks; bounce <= kMaxGlassVertices; ++bounce) {
    const float least = glass_choice(1, pack_path_step(bounce, 0, 4), kSeed).least_chance;
    EXPECT_GT(least, 0.0f);
    weight /= 1.0f - least;
  }
  EXPECT_LT(weight, 2.0f);
}

}  // namespace
}  // namespace lambent::glass_choice_test
