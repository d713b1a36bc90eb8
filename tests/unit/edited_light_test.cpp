// SPDX-License-Identifier: Apache-2.0
// What edits leave of averages: how many samples a probe's average still counts as, and the noise
// of a field whose scene is edited all the time.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "field/edits/edited_light_math.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::edited_light_test {
namespace {

using glm::vec3;

/// Direct light along the rays of a probe before an edit and after it.
struct Rays {
  std::vector<float> before, after;
};

EditedLight sums_of(const Rays& rays) {
  EditedLight sums{};
  for (std::size_t i = 0; i < rays.before.size(); ++i) {
    sums = add_ray(sums, kSurfelSurface, rays.before[i], rays.after[i]);
  }
  return sums;
}

/// What is left of so many samples where this light is reflected beside the direct light, as
/// radiance before and after.
float samples_left(float samples, const Rays& rays, float was = 0.0f, float is = 0.0f) {
  const EditedLight sums = sums_of(rays);
  const float held = kPi * (sums.before / sums.rays + was);
  const float now = kPi * (sums.after / sums.rays + is);
  return samples_after_ratio(samples, estimate_variance(sums, held, now));
}

TEST(SamplesAfterEdit, StayWhereAllLightChangesAlike) {
  const Rays rays{{1.0f, 3.0f, 0.0f, 2.0f}, {2.0f, 6.0f, 0.0f, 4.0f}};
  EXPECT_NEAR(samples_left(50.0f, rays), 50.0f, 1e-2f);
  EXPECT_NEAR(samples_left(50.0f, rays, 1.0f, 2.0f), 50.0f, 1e-2f);
}

TEST(SamplesAfterEdit, AreAtMostOneWhereOtherRaysMeetTheLight) {
  const Rays rays{{8.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f, 0.0f}};
  EXPECT_EQ(samples_left(50.0f, rays), 1.0f);
  EXPECT_LT(samples_left(50.0f, rays, 1.0f, 1.0f), 2.0f);
}

TEST(SamplesAfterEdit, StayWhereTheAverageStartsAnewOrThereIsNoLight) {
  const Rays rays{{8.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f, 0.0f}};
  EXPECT_EQ(samples_left(0.0f, rays), 0.0f);
  EXPECT_EQ(samples_left(9.0f, {{0.0f, 0.0f}, {0.0f, 0.0f}}), 9.0f);
}

// Hardly any of the probe's light is direct, and an edit that makes one ray 1 % brighter than the
// others must not cost the average: by the formula, 49.8 samples are left.
TEST(SamplesAfterEdit, StayWhereReflectedLightHidesTheChange) {
  const Rays rays{{0.0f, 0.0f, 0.0f, 0.0f}, {0.01f, 0.0f, 0.0f, 0.0f}};
  EXPECT_GT(samples_left(50.0f, rays, 1.0f, 1.0f), 49.0f);
}

TEST(SamplesAfterEdit, AreOneWhereTheFirstLightOfADarkProbeIsReflected) {
  const EditedLight none = sums_of({{0.0f, 0.0f}, {0.0f, 0.0f}});
  const EstimateVariance variance = estimate_variance(none, 0.0f, 1.0f);
  EXPECT_EQ(samples_after_edit(50.0f, variance, /*likeness=*/0.0f), 1.0f);
}

// An average is multiplied by the ratio of the light after an edit to that before it, both of the
// last rays. The product has the variance of an average of as many updates as the function says;
// 4,000 trials tell it to 2 %, and the formula is of first order.
TEST(SamplesAfterEdit, TellTheVarianceThatIsLeft) {
  constexpr int kRays = 144, kTrials = 4000, kSamples = 30;
  std::mt19937 random(5);
  std::exponential_distribution<float> radiance(1.0f);
  std::bernoulli_distribution is_edited(0.1);
  double squares = 0.0, expected = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    double average = 0.0;
    Rays rays{std::vector<float>(kRays), std::vector<float>(kRays)};
    for (int sample = 0; sample < kSamples; ++sample) {
      for (int i = 0; i < kRays; ++i) {
        rays.before[i] = radiance(random);
        average += rays.before[i] / (kRays * kSamples);
        rays.after[i] = is_edited(random) ? 3.0f * radiance(random) : rays.before[i];
      }
    }
    const EditedLight sums = sums_of(rays);
    const double mean = 0.9 + 0.1 * 3.0;
    const double found = average * sums.after / sums.before / mean - 1.0;
    squares += found * found / kTrials;
    // The variance of one ray after the edit: E[x^2] - E[x]^2 with E[x^2] = 0.9 * 2 + 0.1 * 18
    const double of_ray = (0.9 * 2.0 + 0.1 * 18.0) / (mean * mean) - 1.0;
    expected += of_ray / kRays / samples_left(kSamples, rays) / kTrials;
  }
  EXPECT_NEAR(expected / squares, 1.0, 0.15);
}

/// A closed room with a wide spot of light on its floor, and a red block that passes through it.
struct Passage {
  explicit Passage(std::uint32_t seed)
      : scene(make()),
        world(scene),
        field(*IrradianceField::make(settings(seed), {vec3(-3, 0, -2), vec3(3, 3, 2)})) {
    for (int i = 0; i < 8; ++i) field.update(world);
  }
  Passage(const Passage&) = delete;
  Passage& operator=(const Passage&) = delete;

  static FieldSettings settings(std::uint32_t seed) {
    FieldSettings settings;
    settings.probe_count = {5, 3, 4};
    settings.seed = seed;
    return settings;
  }
  static Scene make() {
    Scene scene = test::scene_of({test::box_mesh({-3, 0, -2}, {3, 3, 2}, /*inwards=*/true)});
    scene.materials.push_back(test::lambert({0.9f, 0.05f, 0.05f}));
    Mesh block = test::box_mesh({-0.4f, 0, -0.4f}, {0.4f, 0.8f, 0.4f});
    block.material = 1;
    test::add(scene, std::move(block));
    Light spot = test::point_light(vec3(60.0f), {0, 2.9f, 0});
    spot.type = Light::Type::spot;
    spot.direction_ws = {0, -1, 0};
    spot.inner_cone_angle = 0.9f;
    spot.outer_cone_angle = 0.95f;
    scene.lights = {spot};
    return scene;
  }
  /// Moves the block there and back.
  void pass(int updates) {
    for (int i = 0; i < updates; ++i) {
      const float x = 2.0f * std::cos(0.3f * static_cast<float>(i));
      scene.instances[1].world_from_object[3] = glm::vec4(x, 0.0f, 0.0f, 1.0f);
      ASSERT_TRUE(world.update());
      field.update(world);
    }
  }
  std::vector<vec3> light_on_walls() const {
    std::vector<FieldQuery> queries;
    for (const float x : {-2.0f, -1.0f, 0.0f, 1.0f, 2.0f}) {
      for (const float z : {-1.0f, 1.0f}) {
        const vec3 inwards(0.0f, 0.0f, -z);
        queries.push_back({vec3(x, 1.5f, 2.0f * z), inwards, inwards});
      }
    }
    std::vector<vec3> light(queries.size());
    field.irradiance(queries, light);
    return light;
  }

  Scene scene;
  World world;
  IrradianceField field;
};

// Each edit multiplies averages by a ratio that has errors. Where they count as before, the errors
// add up like a random walk, until walls have red and green stains.
TEST(EditedField, DoesNotDriftWhileSomethingPassesThroughItsLight) {
  constexpr int kEdits = 40, kSeeds = 6;
  std::vector<std::vector<vec3>> found;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    Passage passage(seed);
    passage.pass(kEdits);
    found.push_back(passage.light_on_walls());
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    vec3 mean(0.0f);
    for (const std::vector<vec3>& light : found) mean += light[i] / static_cast<float>(kSeeds);
    for (const std::vector<vec3>& light : found) {
      const vec3 off = (light[i] - mean) / mean;
      squares += glm::dot(off, off) / (3.0 * (kSeeds - 1) * found[0].size());
    }
  }
  // It is 0.045, and 0.081 where averages keep all that the likeness of their light lets them
  EXPECT_LT(std::sqrt(squares), 0.06);
}

}  // namespace
}  // namespace lambent::edited_light_test
