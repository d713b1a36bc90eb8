// SPDX-License-Identifier: Apache-2.0
// Corrections of lookups on a device: learned from the same samples, forgotten and read as on the
// processor.
#include <algorithm>
#include <map>
#include <utility>

#include "field/correction/correction_table.h"
#include "field/lookup/lookup_volumes.h"
#include "field/vulkan/field_resources.h"
#include "support/random_store.h"
#include "support/vulkan_device.h"
#include "twin/field_update_cpu.h"
#include "vulkan/device_memory.h"

namespace lambent::corrections_test {
namespace {

using test::few_cascades;
using test::few_probes;

const test::Stage& cornell() {
  static const test::Stage stage("cornell");
  return stage;
}

using Blocks = std::map<std::pair<uint, uint>, std::array<LearnedCorrection, kCellCorners>>;

Blocks blocks_of(const CorrectionTable& table) {
  Blocks blocks;
  for (const CorrectionBlock& block : table.blocks()) {
    blocks[{block.key.rest, block.key.xy}] = block.cells;
  }
  return blocks;
}

class Corrections : public test::OnDevice {
 protected:
  /// Samples all over the volumes, so many that some buckets have no room for all of their blocks.
  static std::vector<CorrectionSample> samples_in(std::span<const ProbeGrid> grids, int count,
                                                  uint seed) {
    RandomStream random = make_random_stream(3, 4, seed);
    std::vector<CorrectionSample> samples;
    for (int i = 0; i < count; ++i) {
      const int volume = i % static_cast<int>(grids.size());
      const ProbeGrid& grid = grids[volume];
      const vec3 cells = vec3(next_uniform2(random), next_uniform(random));
      const vec3 normal = test::random_unit(random);
      samples.push_back({grid_position(grid, cells * vec3(grid.count - 1)), normal, volume,
                         3.0f * next_uniform(random), next_uniform(random),
                         0.1f + 2.0f * next_uniform(random), next_uniform(random)});
    }
    return samples;
  }

  static void learn(DeviceCorrections& table, const FieldResources& field,
                    std::span<const CorrectionSample> samples, uint number) {
    std::vector<CorrectionSampleRecord> records;
    // What is no sample changes nothing
    records.push_back({});
    for (const CorrectionSample& s : samples) {
      records.push_back(
          {s.position_ws, s.normal_ws, s.volume, s.gathered, s.variance, s.looked_up, s.pick});
    }
    const vulkan::Buffer given = host_buffer<CorrectionSampleRecord>(device(), records, "samples");
    table.reserve(records.size());
    device().run([&](vulkan::Recorder& to) {
      table.record_learn(to, {field.grids().address()}, {given.address()},
                         static_cast<std::uint32_t>(records.size()), number);
    });
  }

  static void expect_alike(const CorrectionTable& on_cpu, const CorrectionTable& on_device) {
    const Blocks expected = blocks_of(on_cpu), found = blocks_of(on_device);
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [key, cells] : expected) {
      ASSERT_TRUE(found.contains(key));
      for (int k = 0; k < kCellCorners; ++k) {
        const LearnedCorrection &is = found.at(key)[k], &should = cells[k];
        ASSERT_NEAR(is.samples, should.samples, 1e-5f * should.samples);
        // The mean of all lookups is rounded on both sides, and so are samples
        ASSERT_NEAR(is.gathered, should.gathered, 1e-3f * should.gathered + 1e-3f);
        ASSERT_NEAR(is.looked_up, should.looked_up, 1e-3f * should.looked_up + 1e-3f);
      }
    }
  }
};

TEST_F(Corrections, AreLearnedAndForgottenAsOnTheProcessor) {
  for (const FieldSettings& settings : {few_probes(), few_cascades()}) {
    const ProbeStore store(test::grids_for(settings, cornell().bounds()), settings);
    FieldResources field(device(), settings, store);
    CorrectionTable on_cpu(store.probes());
    DeviceCorrections& table = field.corrections();
    EXPECT_TRUE(table.empty());
    for (uint number = 1; number < 5; ++number) {
      const auto samples = samples_in(store.grids(), 3000, number);
      on_cpu.learn(store.grids(), samples, number);
      learn(table, field, samples, number);
      expect_alike(on_cpu, table.read());
    }
    std::vector<float> kept(store.probes(), 1.0f);
    for (int probe = 0; probe < store.probes(); probe += 3) kept[probe] = 0.5f;
    on_cpu.forget(store.grids(), kept);
    const vulkan::Buffer given = host_buffer<float>(device(), kept, "kept");
    device().run([&](vulkan::Recorder& to) {
      table.record_forget(to, {field.grids().address()}, {given.address()});
    });
    expect_alike(on_cpu, table.read());
    EXPECT_LT(on_cpu.blocks().size(), 3u * 4u * 3000u);
  }
}

/// The share of points at which two lookups differ by more than rounding.
double share_off(std::span<const vec3> found, std::span<const vec3> expected) {
  int off = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    // Where hardly any probe is seen, Chebyshev's bound magnifies rounding
    if (length(found[i] - expected[i]) > 2e-3f * length(expected[i])) ++off;
  }
  return off / static_cast<double>(found.size());
}

TEST_F(Corrections, AreReadAsOnTheProcessor) {
  for (const FieldSettings& settings : {few_probes(), few_cascades()}) {
    ProbeStore store(test::grids_for(settings, cornell().bounds()), settings);
    test::fill_randomly(store);
    CorrectionTable table(store.probes());
    table.learn(store.grids(), samples_in(store.grids(), 3000, 9), 1);
    FieldResources field(device(), settings, store);
    field.corrections().write(table);
    expect_alike(table, field.corrections().read());

    std::vector<FieldQuery> queries;
    for (const CorrectionSample& at : samples_in(store.grids(), 3000, 10)) {
      queries.push_back({at.position_ws, at.normal_ws, at.normal_ws});
    }
    const auto count = static_cast<std::uint32_t>(queries.size());
    const vulkan::Buffer in = vulkan::upload<FieldQuery>(device(), queries, "queries");
    const vulkan::Buffer out(device(), count * sizeof(vec3), vulkan::Memory::device, "E");
    std::vector<vec3> expected(count), uncorrected(count);
    lookup_irradiance(store, {}, queries, uncorrected);
    for (const CorrectionUse use : {CorrectionUse::smooth, CorrectionUse::picked}) {
      VisibilityRays by;
      by.correction = &table;
      by.correction_use = use;
      lookup_irradiance(store, by, queries, expected);
      device().run([&](vulkan::Recorder& to) {
        field.record_lookup(to, {in.address()}, count, {out.address()}, nullptr,
                            field.corrections().arrays(use));
      });
      const auto found = vulkan::download<vec3>(device(), out);
      // Points at the border of what shares a pick may pick another cell
      EXPECT_LE(share_off(found, expected), use == CorrectionUse::smooth ? 0.0 : 0.002);
      EXPECT_GT(share_off(found, uncorrected), 0.5);
    }
  }
}

}  // namespace
}  // namespace lambent::corrections_test
