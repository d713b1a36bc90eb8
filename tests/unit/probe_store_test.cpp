// SPDX-License-Identifier: Apache-2.0
#include "field/probes/probe_store.h"

#include <gtest/gtest.h>

#include <string>

#include "field/probes/volumes.h"
#include "shared/random.h"

namespace lambent::probe_store_test {
namespace {

constexpr float kHysteresis = 0.97f;
// The largest relative drift of stored irradiance and moments when the same values are blended in.
constexpr double kMaxDrift = 0.001;

constexpr IrradianceFormat kIrradianceFormats[] = {
    IrradianceFormat::rgb9e5, IrradianceFormat::r11g11b10f, IrradianceFormat::float32};
constexpr DistanceFormat kDistanceFormats[] = {DistanceFormat::rg16f, DistanceFormat::rg32f};

/// A store with some thousand texels, so that the mean effect of dither is estimated well.
ProbeStore make_store(IrradianceFormat irradiance, DistanceFormat distance) {
  FieldSettings settings;
  settings.irradiance_format = irradiance;
  settings.distance_format = distance;
  return {still_grid({vec3(0.0f), vec3(1.0f), ivec3(8, 8, 5)}), settings};
}

uint salt_of(int update) {
  return hash_pcg3d(uvec3(static_cast<uint>(update), 1u, 2u)).x;
}

/// Blends a constant into the store, update after update, as the field does.
void run_average(ProbeStore& store, const vec3& light, int first, int count) {
  const int n = store.irradiance_texels();
  std::vector<vec3> interior(n * n);
  for (int update = first; update < first + count; ++update) {
    for (int probe = 0; probe < store.probes(); ++probe) {
      for (int t = 0; t < n * n; ++t) {
        const vec3 history = store.irradiance_texel(probe, ivec2(t % n, t / n) + 1);
        interior[t] = mix(history, light, 1.0f - kHysteresis);
      }
      store.store_irradiance(probe, interior, salt_of(update));
    }
  }
}

glm::dvec3 mean_irradiance(const ProbeStore& store) {
  const int n = store.irradiance_texels();
  glm::dvec3 sum(0.0);
  for (int probe = 0; probe < store.probes(); ++probe) {
    for (int t = 0; t < n * n; ++t) {
      sum += glm::dvec3(store.irradiance_texel(probe, ivec2(t % n, t / n) + 1));
    }
  }
  return sum / static_cast<double>(store.probes() * n * n);
}

/// The mean over many updates of the mean over all texels, after enough updates that the start has
/// no weight.
glm::dvec3 settled_irradiance(ProbeStore& store, const vec3& light) {
  constexpr int kForget = 300;  // updates: 0.97^300 is 1e-4
  constexpr int kWindows = 20, kWindow = 10;
  run_average(store, light, 0, kForget);
  glm::dvec3 mean(0.0);
  for (int i = 0; i < kWindows; ++i) {
    run_average(store, light, kForget + i * kWindow, kWindow);
    mean += mean_irradiance(store) / static_cast<double>(kWindows);
  }
  return mean;
}

class StoredLight : public testing::TestWithParam<IrradianceFormat> {};

TEST_P(StoredLight, NeitherStallsNorDriftsUnderARunningMean) {
  for (const float level : {1.07e-3f, 0.0123f, 0.377f, 1.0f, 3.33f, 97.0f, 1.01e3f}) {
    const vec3 light = level * vec3(1.0f, 0.83f, 0.61f);
    for (const float start : {0.0f, 3.0f}) {
      ProbeStore store = make_store(GetParam(), DistanceFormat::rg16f);
      std::vector<vec3> interior(store.irradiance_texels() * store.irradiance_texels(),
                                 start * light);
      for (int probe = 0; probe < store.probes(); ++probe) {
        store.store_irradiance(probe, interior, 77u);
      }
      const glm::dvec3 settled = settled_irradiance(store, light);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(settled[c] / light[c], 1.0, kMaxDrift)
            << "level " << level << ", channel " << c << ", from " << start;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, StoredLight, testing::ValuesIn(kIrradianceFormats));

class StoredDistances : public testing::TestWithParam<DistanceFormat> {};

TEST_P(StoredDistances, NeitherStallNorDriftUnderARunningMean) {
  for (const float level : {0.0123f, 0.377f, 1.11f, 2.5f}) {
    ProbeStore store = make_store(IrradianceFormat::rgb9e5, GetParam());
    const int n = store.distance_texels();
    const std::vector<vec2> moments(n * n, vec2(level, 1.1f * level * level));
    glm::dvec2 mean(0.0);
    constexpr int kForget = 300, kAverage = 60;
    for (int update = 0; update < kForget + kAverage; ++update) {
      for (int probe = 0; probe < 32; ++probe) {
        store.blend_moments(probe, moments, 1.0f - kHysteresis, salt_of(update));
        if (update < kForget) continue;
        for (int t = 0; t < n * n; ++t) {
          mean += glm::dvec2(store.moments_texel(probe, ivec2(t % n, t / n) + 1));
        }
      }
    }
    mean /= static_cast<double>(kAverage) * 32 * n * n;
    EXPECT_NEAR(mean.x / moments[0].x, 1.0, kMaxDrift) << level;
    EXPECT_NEAR(mean.y / moments[0].y, 1.0, kMaxDrift) << level;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, StoredDistances, testing::ValuesIn(kDistanceFormats));

TEST(ProbeStore, NeedsNoMoreThanThePublishedBytesAProbe) {
  const ProbeStore store = make_store(IrradianceFormat::rgb9e5, DistanceFormat::rg16f);
  // 6 x 6 and 16 x 16 texels of 4 bytes, as in McGuire's talk of 2019
  EXPECT_LE(store.bytes(), 1168u * store.probes());
}

TEST(ProbeStore, OffsetsKeepTheirPlaceWithinAStepAndTheirBounds) {
  const float step = kMaxProbeOffset / kOffsetSteps;
  EXPECT_EQ(decode_probe_offset(0u), vec3(0.0f));
  for (const vec3 cells : {vec3(0.0f), vec3(0.45f, -0.45f, 0.1f), vec3(-0.2f, 0.301f, -0.003f)}) {
    const vec3 stored = decode_probe_offset(encode_probe_offset(cells));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(stored[c], cells[c], 0.5001f * step);
    EXPECT_EQ(decode_probe_offset(encode_probe_offset(stored)), stored);
  }
  EXPECT_EQ(decode_probe_offset(encode_probe_offset({9.0f, -9.0f, 0.0f})),
            vec3(kMaxProbeOffset, -kMaxProbeOffset, 0.0f));
}

TEST(ProbeStore, ClearsToDarkness) {
  for (const IrradianceFormat format : kIrradianceFormats) {
    ProbeStore store = make_store(format, DistanceFormat::rg16f);
    run_average(store, vec3(5.0f), 0, 2);
    EXPECT_GT(mean_irradiance(store).x, 0.0);
    store.clear();
    EXPECT_EQ(mean_irradiance(store), glm::dvec3(0.0));
  }
}

TEST(ProbeStore, TheSameSaltStoresTheSameBits) {
  ProbeStore a = make_store(IrradianceFormat::rgb9e5, DistanceFormat::rg16f);
  ProbeStore b = make_store(IrradianceFormat::rgb9e5, DistanceFormat::rg16f);
  run_average(a, vec3(1.23f), 0, 1);
  run_average(b, vec3(1.23f), 0, 1);
  EXPECT_TRUE(std::equal(a.irradiance_words().begin(), a.irradiance_words().end(),
                         b.irradiance_words().begin()));
  run_average(b, vec3(1.23f), 1, 1);
  EXPECT_FALSE(std::equal(a.irradiance_words().begin(), a.irradiance_words().end(),
                          b.irradiance_words().begin()));
}

}  // namespace
}  // namespace lambent::probe_store_test
