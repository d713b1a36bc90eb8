// SPDX-License-Identifier: Apache-2.0
// Schedules that a device decides: compares them with a simple selection on the host, and tests
// their effect on a recorded field.
#include <numeric>

#include "field/probes/tile_light.h"
#include "field/schedule/schedule.h"
#include "field/vulkan/device_schedule.h"
#include "support/hand_made.h"
#include "twin/field_update_cpu.h"
#include "twin/recorded_field.h"
#include "vulkan/acceleration.h"

namespace lambent::schedule_test {
namespace {

using test::cornell, test::recorded_settings, test::RecordedFieldTest;
using vulkan::Buffer, vulkan::Memory, vulkan::RecordedField, vulkan::RecordedFieldSettings;

constexpr std::uint32_t kUpdate = 1000;  // counted from 0
constexpr float kMeanDeviation = 0.8f;

/// Probes with random states, histories and variances.
struct Crowd {
  explicit Crowd(const FieldSettings& of)
      : settings(of), store(test::grids_for(of, cornell().bounds()), of) {
    RandomStream random = make_random_stream(1, 2, 3);
    const auto uniform = [&] { return next_uniform(random); };
    for (int probe = 0; probe < store.probes(); ++probe) {
      RecordedProbe stands{};
      stands.samples = 120.0f * uniform() * uniform();
      standing.push_back(stands);
      states.push_back(uniform() < 0.1f ? kProbeOff : kProbeOn);
      const uint age = static_cast<uint>(300.0f * uniform() * uniform());
      variability.push_back(
          {{0.2f * uniform() * uniform(), 5u}, uniform() < 0.02f ? 0u : kUpdate - age});
    }
  }

  /// The bin of a probe, as the kernel computes it, on the processor.
  int bin_of(int probe, bool look) const {
    const ProbeVariability& own = variability[probe];
    const float weight = level_weight(roles[store.volume_of(probe)].level);
    const bool off = states[probe] == kProbeOff;
    if (off) {
      const bool looked_at = look && waits_too_long(own.last_traced, kUpdate + 1);
      return looked_at ? priority_bin(probe_urgency(0.0f, own.last_traced, kUpdate + 1, weight))
                       : kInactiveBin;
    }
    const ProbeGrid& grid = store.grid_of(probe);
    float sum = own.known.variance;
    int count = 1;
    for (int other = 0; other < store.probes(); ++other) {
      const ivec3 apart = probe_coords(grid, other) - probe_coords(grid, probe);
      if (dot(vec3(apart), vec3(apart)) != 1.0f || states[other] == kProbeOff) continue;
      sum += variability[other].known.variance;
      ++count;
    }
    const float deviation = probe_deviation(own.known.variance, sum / static_cast<float>(count));
    const float samples = standing[probe].samples;
    float reduction = error_reduction(deviation, samples, longest_average(settings));
    if (reduction > 0.0f)
      reduction =
          scheduled_reduction(reduction, error_reduction_per_deviation(samples), kMeanDeviation);
    return priority_bin(probe_urgency(reduction, own.last_traced, kUpdate + 1, weight));
  }

  FieldSettings settings;
  ProbeStore store;
  std::vector<VolumeRole> roles = {{.follows_viewer = false, .level = 2}};  // for the only volume
  std::vector<RecordedProbe> standing;
  std::vector<uint> states;
  std::vector<ProbeVariability> variability;
};

FieldSettings many_probes() {
  FieldSettings settings;
  settings.probe_count = {20, 7, 5};  // three chunks, the last of them not full
  settings.rays_per_probe = 32;
  return settings;
}

class DeviceScheduleTest : public test::OnDevice {
 protected:
  struct Chosen {
    ScheduleState state;
    std::vector<uint> bins;
    std::vector<int> probes;
    std::vector<ProbeBlock> blocks;
  };
  static Chosen choose(const Crowd& crowd, int most, bool look) {
    const FieldResources field(device(), crowd.settings, crowd.store);
    DeviceSchedule schedule(field, crowd.roles, most, crowd.settings.rays_per_probe);
    const Buffer standing = vulkan::upload(device(), crowd.standing, "standing");
    const Buffer states = vulkan::upload(device(), crowd.states, "states");
    vulkan::write<ProbeVariability>(device(), crowd.variability, schedule.variability());
    ScheduleState state{};
    state.mean_deviation = kMeanDeviation;
    vulkan::write<ScheduleState>(device(), std::span(&state, 1), schedule.state());
    device().run([&](vulkan::Recorder& to) {
      schedule.record_choose(to, {{standing.address()}, {states.address()}}, kUpdate, look);
    });
    Chosen chosen = {vulkan::download<ScheduleState>(device(), schedule.state()).front(),
                     vulkan::download<uint>(device(), schedule.bins()),
                     vulkan::download<int>(device(), schedule.list({}).indices),
                     vulkan::download<ProbeBlock>(device(), schedule.list({}).blocks)};
    chosen.probes.resize(chosen.state.list.probes);
    return chosen;
  }
};

TEST_F(DeviceScheduleTest, ChoosesWhatAPlainSortChooses) {
  const Crowd crowd(many_probes());
  for (const int most : {8, 96, 400, 696}) {
    const bool look = most == 96;
    const Chosen chosen = choose(crowd, most, look);
    // A device's roots and divisions may differ in the last bits, for a probe between two bins
    int other = 0;
    for (int probe = 0; probe < crowd.store.probes(); ++probe) {
      const int bin = static_cast<int>(chosen.bins[probe]), expected = crowd.bin_of(probe, look);
      EXPECT_LE(abs(bin - expected), 1) << probe;
      other += bin != expected ? 1 : 0;
    }
    EXPECT_LE(other, 3);

    std::vector<int> order(crowd.store.probes());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return chosen.bins[a] > chosen.bins[b]; });
    const auto wanting = std::count_if(chosen.bins.begin(), chosen.bins.end(),
                                       [](uint bin) { return bin >= kFirstReductionBin; });
    const int count = std::min(static_cast<int>((wanting + 7) / 8 * 8), most);
    order.resize(count);
    std::sort(order.begin(), order.end());
    EXPECT_EQ(chosen.probes, order) << most;
  }
}

TEST_F(DeviceScheduleTest, SizesTheKernelsThatFollow) {
  const Crowd crowd(many_probes());
  const int most = 400;
  const Chosen chosen = choose(crowd, most, false);
  const FieldResources field(device(), crowd.settings, crowd.store);
  DeviceProbes same;
  same.probes = chosen.probes;
  same.most_rays = crowd.settings.rays_per_probe;
  same.block_count = same.count() / kBlockProbes;
  for (uint shape = 0; shape < kListShapes; ++shape) {
    const GroupCounts expected = field.groups_over(same, shape);
    const GroupCounts& groups = chosen.state.list.over[shape];
    EXPECT_EQ(groups.x, expected.x) << shape;
    EXPECT_EQ(groups.y, expected.y) << shape;
    EXPECT_EQ(groups.z, 1u);
  }
  EXPECT_EQ(chosen.state.list.texels, chosen.probes.size() * field.tile_texels());
  for (int b = 0; b < most / kBlockProbes; ++b) {
    EXPECT_EQ(chosen.blocks[b].count, b < same.block_count ? kBlockProbes : 0);
    EXPECT_EQ(chosen.blocks[b].first, b * kBlockProbes);
  }
}

TEST_F(DeviceScheduleTest, LetsAllRestWhereAllAreSettled) {
  Crowd crowd(many_probes());
  for (RecordedProbe& standing : crowd.standing) standing.samples = 1000.0f;
  for (ProbeVariability& variability : crowd.variability) variability.last_traced = kUpdate;
  const Chosen chosen = choose(crowd, 96, false);
  EXPECT_TRUE(chosen.probes.empty());
  EXPECT_EQ(chosen.state.list.over[kOverRays].y, 0u);
  EXPECT_EQ(chosen.state.list.over[kOverProbes].x, 0u);
}

TEST_F(DeviceScheduleTest, LearnsVarianceAsTheProcessorDoes) {
  const FieldSettings settings = many_probes();
  const Crowd crowd(settings);
  const FieldResources field(device(), settings, crowd.store);
  const std::size_t texels = field.tile_texels();
  DeviceSchedule schedule(field, crowd.roles, 696, settings.rays_per_probe);
  DeviceProbes list;
  for (int probe = 1; probe < crowd.store.probes(); probe += 3) list.probes.push_back(probe);
  list.indices = vulkan::upload(device(), list.probes, "probes");
  RandomStream random = make_random_stream(4, 5, 6);
  WorkingIrradiance light(crowd.store.probes() * texels), before(list.probes.size() * texels);
  const auto fill = [&](WorkingIrradiance& tiles) {
    // One tile in ten is dark
    for (std::size_t i = 0; i < tiles.size(); i += texels) {
      const float scale = next_uniform(random) < 0.1f ? 0.0f : next_uniform(random);
      for (std::size_t t = 0; t < texels; ++t) tiles[i + t] = vec4(scale * next_uniform(random));
    }
  };
  fill(light);
  fill(before);
  std::vector<float> blend_weights;
  for (int k = 0; k < list.count(); ++k) {
    // Some probes are left out (weight 0), some have no history (weight 1)
    blend_weights.push_back(k % 10 == 0   ? 0.0f
                            : k % 10 == 1 ? 1.0f
                                          : 0.05f + 0.4f * next_uniform(random));
  }
  constexpr float kMeanLight = 0.3f;
  ScheduleState state{};
  state.mean_light = kMeanLight;
  state.live = 600;
  vulkan::write<vec4>(device(), light, field.light());
  vulkan::write<ProbeVariability>(device(), crowd.variability, schedule.variability());
  vulkan::write<ScheduleState>(device(), std::span(&state, 1), schedule.state());
  const Buffer blend_weight_buffer = vulkan::upload(device(), blend_weights, "blend_weights");
  const Buffer before_buffer = vulkan::upload<vec4>(device(), before, "before");
  device().run([&](vulkan::Recorder& to) {
    schedule.record_update_variability(to, list, {blend_weight_buffer.address()},
                                       {before_buffer.address()}, kUpdate);
  });
  const auto booked = vulkan::download<ProbeVariability>(device(), schedule.variability());
  const auto after = vulkan::download<ScheduleState>(device(), schedule.state()).front();

  std::vector<ProbeVariability> expected = crowd.variability;
  float sum = 0.0f, count = 0.0f;
  for (int k = 0; k < list.count(); ++k) {
    if (blend_weights[k] == 0.0f) continue;
    ProbeVariability& variability = expected[list.probes[k]];
    const TileLight now(&light[list.probes[k] * texels], texels), was(&before[k * texels], texels);
    sum += mean_luminance(now);
    count += 1.0f;
    ProbeStatus record;
    record.variance = variability.known.variance;
    record.variance_samples = static_cast<std::uint16_t>(variability.known.samples);
    record.samples = 1.0f / blend_weights[k] - 1.0f;
    learn_variance(estimate_relative_square(light_change(was, now), static_cast<int>(texels),
                                            blend_weights[k], kMeanLight),
                   1.0f, record);
    variability = {{record.variance, record.variance_samples}, kUpdate + 1};
  }
  for (int probe = 0; probe < crowd.store.probes(); ++probe) {
    const ProbeVariability& is = booked[probe];
    const ProbeVariability& should = expected[probe];
    // The sums over a tile are in another order
    EXPECT_NEAR(is.known.variance, should.known.variance, 1e-4f * should.known.variance) << probe;
    EXPECT_EQ(is.known.samples, should.known.samples) << probe;
    EXPECT_EQ(is.last_traced, should.last_traced) << probe;
  }
  EXPECT_NEAR(after.mean_light, learned_light(kMeanLight, sum / count, count, 600.0f), 1e-5f);
}

class BudgetedFieldTest : public RecordedFieldTest {
 protected:
  /// The number of probes that the device has chosen.
  static std::uint32_t served(const RecordedField& field) {
    const vulkan::BufferRange launch = field.ray_launch();
    return launch.buffer == VK_NULL_HANDLE ? 0 : download<GroupCounts>(launch).front().y;
  }
};

TEST_F(BudgetedFieldTest, ComesToTheSameLightWithAQuarterOfTheRaysAndThenRests) {
  FieldSettings settings = recorded_settings();
  settings.hysteresis = 0.9f;  // averages remember ten updates
  RecordedFieldSettings recorded;
  recorded.rays_per_update = settings.rays_per_probe * settings.probe_count.x *
                             settings.probe_count.y * settings.probe_count.z / 4;
  RecordedField field = make(settings, recorded);
  int updates = 0;
  for (std::uint32_t now = 1; now > 0; ++updates) {
    ASSERT_LT(updates, 70) << "probes that are settled do not rest";
    update(field);
    now = updates < 10 ? 1 : served(field);  // two rounds of five updates first
    EXPECT_LE(now, 16u);                     // whole blocks within 20 probes
  }
  EXPECT_GE(updates, 5 * 10);
  const IrradianceField on_cpu = test::make_field(cornell(), settings, 10);
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  // Both have the noise of different rays: the last 10 x 72 per probe
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), 0.08);

  // After a change, probes are traced again
  update(field, {.history = 0.1f});
  EXPECT_EQ(served(field), 16u);
}

TEST_F(BudgetedFieldTest, TracesNoMoreThanItsProbesDecidedOn) {
  FieldSettings settings = recorded_settings();
  settings.hysteresis = 0.5f;  // averages remember two updates
  RecordedFieldSettings recorded;
  recorded.rays_per_update = 24 * settings.rays_per_probe;
  RecordedField field = make(settings, recorded);
  // Two rounds, in the second of which averages start again, and three updates of 24 of 80 probes
  for (int i = 0; i < 4 + 4 + 3; ++i) update(field);
  const vulkan::PlannedUpdate planned = field.plan().value();
  EXPECT_TRUE(planned.on_device);
  EXPECT_EQ(planned.probes, 24u);

  // A ball that surrounds the room
  const Mesh ball = test::sphere(1000.0f, 6, 0);
  const Buffer positions =
      vulkan::upload(device(), ball.positions, "positions", vulkan::kGeometryUsage);
  const Buffer triangles =
      vulkan::upload(device(), ball.triangles, "triangles", vulkan::kGeometryUsage);
  const vulkan::TriangleGeometry geometry = {positions.address(), triangles.address(),
                                             static_cast<std::uint32_t>(ball.positions.size()),
                                             static_cast<std::uint32_t>(ball.triangles.size())};
  const auto structures = vulkan::TriangleBuilder(device()).build(std::span(&geometry, 1));
  const vulkan::PlacedStructure placed = {.structure = structures[0].address()};
  vulkan::InstanceStructure scene(device());
  device().run([&](vulkan::Recorder& to) {
    scene.build(to, std::span(&placed, 1));
    to.barrier();
    const vulkan::BufferRange hits = field.hits();
    device().fn().vkCmdFillBuffer(to.commands(), hits.buffer, hits.offset, hits.bytes, 0u);
    field.record_rays(to.commands());
    field.record_trace(to.commands(), scene.handle());
  });
  const auto rays = download<RayRecord>(field.rays());
  const auto hits = download<HitRecord>(field.hits());
  ASSERT_EQ(served(field), 8u);
  for (std::uint32_t i = 0; i < planned.rays; ++i) {
    const bool asked = i < 8 * planned.rays_per_probe;
    EXPECT_EQ(rays[i].mask, asked ? 0xFFu : 0u);
    EXPECT_EQ(hits[i].distance > 500.0f, asked);
  }
}

}  // namespace
}  // namespace lambent::schedule_test
