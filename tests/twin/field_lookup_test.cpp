// SPDX-License-Identifier: Apache-2.0
// Compares the lookup of a field on a device with the processor's lookup of the same store.
#include "field/lookup/lookup_volumes.h"
#include "field/vulkan/field_resources.h"
#include "support/random_store.h"
#include "support/vulkan_device.h"
#include "twin/field_update_cpu.h"

namespace lambent::field_lookup_test {
namespace {

struct LookupCase {
  IrradianceFormat irradiance;
  DistanceFormat distance;
  int cascades;
};

class FieldLookup : public test::OnDevice, public testing::WithParamInterface<LookupCase> {};

TEST_P(FieldLookup, AnswersAsTheProcessorDoes) {
  FieldSettings settings = GetParam().cascades > 0 ? test::few_cascades() : test::few_probes();
  const test::Stage stage("cornell");
  settings.irradiance_format = GetParam().irradiance;
  settings.distance_format = GetParam().distance;
  ProbeStore store(test::grids_for(settings, stage.bounds()), settings);
  test::fill_randomly(store);
  const FieldResources field(device(), settings, store);
  RandomStream random = make_random_stream(1, 2, 3);
  std::vector<FieldQuery> queries(3000);
  for (FieldQuery& query : queries) {
    query.position_ws = 3.0f * vec3(next_uniform2(random), next_uniform(random)) - vec3(1.5f);
    query.normal_ws = test::random_unit(random);
    query.to_viewer_ws = test::random_unit(random);
    if (next_uniform(random) < 0.5f) query.viewer_distance = 0.2f * next_uniform(random);
  }
  const vulkan::Buffer in = vulkan::upload(device(), queries, "queries");
  const vulkan::Buffer out(device(), queries.size() * sizeof(vec3), vulkan::Memory::device, "E");
  device().run([&](vulkan::Recorder& to) {
    field.record_lookup(to, {in.address()}, static_cast<std::uint32_t>(queries.size()),
                        {out.address()});
  });
  const auto found = vulkan::download<vec3>(device(), out);
  std::vector<vec3> expected(queries.size());
  lookup_irradiance(store, {}, queries, expected);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    // Where hardly any probe is visible, Chebyshev's bound magnifies rounding
    ASSERT_LE(length(found[i] - expected[i]), 2e-3f * length(expected[i])) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Formats, FieldLookup,
    testing::Values(LookupCase{IrradianceFormat::rgb9e5, DistanceFormat::rg16f, 0},
                    LookupCase{IrradianceFormat::r11g11b10f, DistanceFormat::rg32f, 0},
                    LookupCase{IrradianceFormat::float32, DistanceFormat::rg32f, 0},
                    LookupCase{IrradianceFormat::rgb9e5, DistanceFormat::rg16f, 3}));

}  // namespace
}  // namespace lambent::field_lookup_test
