// SPDX-License-Identifier: Apache-2.0
// The light of a scene must not depend on its unit of length.
#include <gtest/gtest.h>

#include <vector>

#include "field/lookup/lookup_cpu.h"
#include "field/probes/volumes.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent::field_scale_test {
namespace {

/// Weights at some points of a cell of `scale` metres, whose probes store mean distances of 0.3 to
/// 0.7 of its edge.
std::vector<CornerWeights> weights_at_scale(float scale, DistanceFormat format) {
  FieldSettings settings;
  settings.distance_format = format;
  ProbeStore store(still_grid({vec3(0.0f), vec3(scale), ivec3(2)}), settings);
  const int texels = store.distance_texels() * store.distance_texels();
  RandomStream random = make_random_stream(5, 6, 7);
  for (int probe = 0; probe < store.probes(); ++probe) {
    std::vector<vec2> moments(texels);
    for (vec2& texel : moments) {
      const float mean = scale * (0.3f + 0.4f * next_uniform(random));
      texel = {mean, 1.05f * mean * mean};
    }
    store.blend_moments(probe, moments, 1.0f, 11u);
  }
  std::vector<FieldQuery> queries;
  for (int i = 0; i < 64; ++i) {
    const vec3 place(next_uniform2(random), next_uniform(random));
    const vec3 normal = sample_uniform_sphere(next_uniform2(random));
    queries.push_back({scale * place, normal, normal});
  }
  std::vector<CornerWeights> weights(queries.size());
  corner_weights(store, 0, queries, weights);
  return weights;
}

class FieldScale : public testing::TestWithParam<DistanceFormat> {};

TEST_P(FieldScale, DoesNotChangeWhatIsVisible) {
  // Powers of two scale floats without rounding, so that halves and their dither are the same
  constexpr float kTolerance = 1e-5f;
  const std::vector<CornerWeights> metres = weights_at_scale(1.0f, GetParam());
  for (const float scale : {1.0f / 1024.0f, 1.0f / 64.0f, 32.0f, 1024.0f}) {
    const std::vector<CornerWeights> scaled = weights_at_scale(scale, GetParam());
    for (std::size_t i = 0; i < metres.size(); ++i) {
      for (int corner = 0; corner < 8; ++corner) {
        EXPECT_NEAR(scaled[i].weight[corner], metres[i].weight[corner], kTolerance) << scale;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, FieldScale,
                         testing::Values(DistanceFormat::rg16f, DistanceFormat::rg32f));

}  // namespace
}  // namespace lambent::field_scale_test
