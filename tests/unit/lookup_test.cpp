// SPDX-License-Identifier: Apache-2.0
#include "field/lookup/lookup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "field/lookup/lookup_volumes.h"
#include "field/probes/volumes.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "support/field_scenes.h"
#include "support/random_store.h"

namespace lambent::lookup_test {
namespace {

using test::look_up;
using test::make_field;
using test::random_unit;
using test::SharedLookup;
using test::Stage;

ProbeGrid uneven_grid() {
  return still_grid({vec3(-1.0f, 0.5f, 2.0f), vec3(0.7f, 1.1f, 0.9f), ivec3(4, 3, 5)});
}

ProbeStore random_store(const FieldSettings& settings) {
  ProbeStore store(uneven_grid(), settings);
  test::fill_randomly(store);
  return store;
}

/// Queries at points in the grid, on its probes, and up to two cells beyond, with random normals
/// and viewers.
std::vector<FieldQuery> random_queries(const ProbeGrid& grid, int count) {
  RandomStream random = make_random_stream(4, 5, 6);
  const vec3 size = grid.spacing * vec3(grid.count - 1);
  std::vector<FieldQuery> queries(count);
  for (int i = 0; i < count; ++i) {
    const vec3 u = vec3(next_uniform2(random), next_uniform(random));
    FieldQuery& q = queries[i];
    q.position_ws = grid.origin_ws + size * u;
    if (i % 4 == 1) q.position_ws += grid.spacing * (4.0f * u - 2.0f);
    q.normal_ws = random_unit(random);
    q.to_viewer_ws = random_unit(random);
    if (i % 16 == 2) q.normal_ws = {0.0f, 0.0f, -1.0f};
    if (i % 16 == 3) q.position_ws = grid.origin_ws + grid.spacing * floor(3.0f * u);
  }
  return queries;
}

struct Formats {
  IrradianceFormat irradiance;
  DistanceFormat distance;
  int irradiance_texels, distance_texels;
};

class Lookup : public testing::TestWithParam<Formats> {
 protected:
  static ProbeStore store() {
    FieldSettings settings;
    settings.irradiance_format = GetParam().irradiance;
    settings.distance_format = GetParam().distance;
    settings.irradiance_texels = GetParam().irradiance_texels;
    settings.distance_texels = GetParam().distance_texels;
    return random_store(settings);
  }
};

TEST_P(Lookup, OfManyPointsEqualsTheSharedLookup) {
  // The sums are in another order, and a variance is a difference of nearly equal numbers
  constexpr float kTolerance = 2e-4f;
  const ProbeStore tested = store();
  SharedLookup shared{tested};
  // The count is not a multiple of any batch size
  std::vector<FieldQuery> queries = random_queries(tested.grid(0), 1237);
  for (std::size_t i = 0; i < queries.size(); i += 2) {
    queries[i].viewer_distance = 1e-4f * static_cast<float>(i);
  }
  std::vector<vec3> result(queries.size());
  lookup_irradiance(tested, {}, queries, result);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const FieldQuery& q = queries[i];
    const vec3 expected = shared.lookup_irradiance(tested.volumes(), q.position_ws, q.normal_ws,
                                                   q.to_viewer_ws, q.viewer_distance);
    EXPECT_LT(glm::distance(result[i], expected), kTolerance * glm::length(expected)) << i;
  }
}

TEST_P(Lookup, WeightsAddUpToOneAndTellWhatTheLookupReads) {
  const ProbeStore tested = store();
  const std::vector<FieldQuery> queries = random_queries(tested.grid(0), 301);
  std::vector<CornerWeights> weights(queries.size());
  std::vector<vec3> result(queries.size());
  corner_weights(tested, 0, queries, weights);
  lookup_irradiance(tested, {}, queries, result);
  const CornerOffsets offsets = tested.corner_table()[0];
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto& w = weights[i].weight;
    EXPECT_NEAR(std::accumulate(std::begin(w), std::end(w), 0.0f), 1.0f, 1e-5f);
    vec3 sum(0.0f);
    for (int k = 0; k < 8; ++k) {
      EXPECT_GE(w[k], 0.0f);
      const int probe = weights[i].base + offsets.probe[k];
      ASSERT_GE(probe, 0);
      ASSERT_LT(probe, tested.probes());
      sum += w[k] * tested.irradiance(probe, queries[i].normal_ws);
    }
    EXPECT_LT(glm::distance(sum, result[i]), 1e-4f * glm::length(sum)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    EveryFormat, Lookup,
    testing::Values(Formats{IrradianceFormat::rgb9e5, DistanceFormat::rg16f, 4, 14},
                    Formats{IrradianceFormat::rgb9e5, DistanceFormat::rg32f, 4, 14},
                    Formats{IrradianceFormat::r11g11b10f, DistanceFormat::rg16f, 6, 14},
                    Formats{IrradianceFormat::r11g11b10f, DistanceFormat::rg32f, 8, 11},
                    Formats{IrradianceFormat::float32, DistanceFormat::rg16f, 2, 4},
                    Formats{IrradianceFormat::float32, DistanceFormat::rg32f, 16, 32}));

/// A store whose probes have no surfaces near and hold one number each, the same in all directions.
template <class Value>
ProbeStore store_of(Value value) {
  const FieldSettings settings = test::exact_formats();
  ProbeStore store(uneven_grid(), settings);
  const std::vector<vec2> far(settings.distance_texels * settings.distance_texels,
                              vec2(100.0f, 10000.0f));
  for (int probe = 0; probe < store.probes(); ++probe) {
    const std::vector<vec3> light(settings.irradiance_texels * settings.irradiance_texels,
                                  vec3(value(probe_coords(store.grid(0), probe))));
    store.store_irradiance(probe, light, 0u);
    store.blend_moments(probe, far, 1.0f, 0u);
  }
  return store;
}

TEST(IrradianceLookup, OfConstantLightIsThatLightEverywhere) {
  const ProbeStore store = store_of([](const ivec3&) { return 0.75f; });
  std::vector<FieldQuery> queries = random_queries(store.grid(0), 500);
  for (std::size_t i = 0; i < 100; ++i) queries[i].position_ws *= 1e4f;
  std::vector<vec3> result(queries.size());
  lookup_irradiance(store, {}, queries, result);
  for (const vec3& e : result) EXPECT_LT(glm::distance(e, vec3(0.75f)), 1e-5f);
}

TEST(IrradianceLookup, BeyondTheVolumeReadsTheNearestProbes) {
  const ProbeStore store = store_of([](const ivec3& c) { return static_cast<float>(c.x); });
  const ProbeGrid& grid = store.grid(0);
  std::vector<FieldQuery> queries = random_queries(grid, 200);
  const float end = grid.origin_ws.x + grid.spacing.x * static_cast<float>(grid.count.x - 1);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    queries[i].position_ws.x = i % 2 == 0 ? grid.origin_ws.x - 0.3f * static_cast<float>(i)
                                          : end + 0.3f * static_cast<float>(i);
  }
  std::vector<vec3> result(queries.size());
  lookup_irradiance(store, {}, queries, result);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const float expected = i % 2 == 0 ? 0.0f : static_cast<float>(grid.count.x - 1);
    EXPECT_NEAR(result[i].x, expected, 1e-4f) << i;
  }
}

TEST(IrradianceLookup, IsLinearInTheLight) {
  const ProbeStore once = store_of([](const ivec3& c) { return 1.0f + c.x + 0.3f * c.y * c.z; });
  const ProbeStore thrice =
      store_of([](const ivec3& c) { return 3.0f * (1.0f + c.x + 0.3f * c.y * c.z); });
  const std::vector<FieldQuery> queries = random_queries(once.grid(0), 100);
  std::vector<vec3> a(queries.size()), b(queries.size());
  lookup_irradiance(once, {}, queries, a);
  lookup_irradiance(thrice, {}, queries, b);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_LT(glm::distance(3.0f * a[i], b[i]), 1e-5f * glm::length(b[i]));
  }
}

TEST(IrradianceLookup, SurvivesNumbersThatAreNone) {
  const ProbeStore store = store_of([](const ivec3&) { return 1.0f; });
  std::vector<FieldQuery> queries(6);
  queries[0].position_ws = vec3(NAN);
  queries[1].position_ws = {INFINITY, -INFINITY, 0.0f};
  queries[2].normal_ws = vec3(NAN);
  queries[3].normal_ws = vec3(0.0f);
  queries[4].to_viewer_ws = vec3(NAN);
  std::vector<vec3> result(queries.size());
  lookup_irradiance(store, {}, queries, result);  // reads no memory but the store's
  EXPECT_NEAR(result[5].x, 1.0f, 1e-5f);
}

/// Irradiance at points that the scene's camera sees.
std::vector<float> seen_irradiance(const std::string& scene, const FieldSettings& settings) {
  const Stage stage(scene);
  const IrradianceField field = make_field(stage, settings, 2);
  std::vector<float> irradiance;
  for (const vec3& e : look_up(field, test::seen_points(stage))) {
    irradiance.push_back((e.x + e.y + e.z) / 3.0f);
  }
  return irradiance;
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(IrradianceLookup, IsDarkBehindAClosedWall) {
  FieldSettings settings;
  settings.probe_spacing = 0.5f;
  const std::vector<float> open = seen_irradiance("two-rooms", settings);
  const std::vector<float> sealed = seen_irradiance("two-rooms-sealed", settings);
  const double lit = mean(open);
  ASSERT_GT(lit, 0.0);
  // Measured as shares of the light through a door gap: 0.008 %, and 0.06 % at the worst point.
  // With the published weights: 0.2 % and 15 %
  EXPECT_LT(mean(sealed), 5e-4 * lit);
  EXPECT_LT(*std::max_element(sealed.begin(), sealed.end()), 5e-3 * lit);
}

}  // namespace
}  // namespace lambent::lookup_test
