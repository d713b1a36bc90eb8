// SPDX-License-Identifier: Apache-2.0
// Visibility by rays on a device against the processor's: pass by pass, and where no light may be.
#include <cmath>

#include "field/field_access.h"
#include "field/lookup/visibility.h"
#include "field/lookup/visibility_math.h"
#include "field_update_cpu.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/world_access.h"
#include "shaders/copy_words_comp.h"
#include "shared/random.h"
#include "support/random_store.h"
#include "support/vulkan_device.h"
#include "twin/copy_words.h"

namespace lambent::visibility_test {
namespace {

using test::Stage;
using test::UpdateOnCpu;

// Where a ray grazes an edge, or a weight is about what a ray is worth, the two sides may see it
// otherwise: so large a share of rays, or of weights, may differ.
constexpr double kTolerance = 0.002;

// Rays change at least so much of what distances say.
constexpr double kChanged = 0.05;

struct SightCase {
  Visibility visibility;
  int cascades;
};

/// A field whose surfels and queries see by rays: on the processor, and ready to on the device.
struct Sighted {
  explicit Sighted(const SightCase& as, std::shared_ptr<vulkan::Device> device)
      : there(stage.scene, std::move(device)),
        update(stage, settings_of(as)),
        cell_visibility(update.store.probes()),
        field(device_world_of(there)->device(), update.settings, update.store),
        by{as.visibility, &tracer_of(stage.world), &cell_visibility} {
    // Distances that tell nothing leave much to rays
    test::fill_randomly(update.store);
    field.write_store(update.store);
    field.write_surfels(update.all, update.traces);
    const std::vector<int> cells = cells_around(update.store, update.all);
    cell_rays = cell_visibility.update(tracer_of(stage.world), update.store, cells);
    if (as.visibility != Visibility::hybrid) return;
    const vulkan::Buffer lowest = vulkan::upload(device_of(), cells, "cells");
    run([&](vulkan::Recorder& to, const DeviceTracer& tracer) {
      field.record_cell_visibility(to, tracer, {lowest.address()}, static_cast<int>(cells.size()));
    });
  }

  static FieldSettings settings_of(const SightCase& as) {
    FieldSettings settings = as.cascades > 0 ? test::few_cascades() : test::few_probes();
    settings.visibility = as.visibility;
    return settings;
  }
  const vulkan::Device& device_of() const { return device_world_of(there)->device(); }

  template <class Record>
  void run(Record record) const {
    const DeviceWorld& world = *device_world_of(there);
    world.device().run([&](vulkan::Recorder& to) {
      to.bind_textures(world.scene().textures());
      record(to, world.tracer());
    });
  }

  const Stage stage{"two-rooms"};
  const World there;
  UpdateOnCpu update;
  CellVisibility cell_visibility;
  FieldResources field;
  VisibilityRays by;
  std::uint64_t cell_rays = 0;
};

class FieldSights : public test::OnDevice, public testing::WithParamInterface<SightCase> {};

TEST_P(FieldSights, WeighSurfelsAsOnTheProcessor) {
  Sighted twins(GetParam(), shared_device());
  UpdateOnCpu& update = twins.update;
  find_surfel_lookups(update.store, {}, update.all, update.traces);
  const std::vector<ProbeTrace> by_distances = update.traces;
  const std::uint64_t rays = find_surfel_lookups(update.store, twins.by, update.all, update.traces);
  const DeviceProbes list = twins.field.list(update.all);
  const vulkan::Buffer count(device(), sizeof(uint), vulkan::Memory::readback, "rays");
  twins.run([&](vulkan::Recorder& to, const DeviceTracer& tracer) {
    twins.field.record_lookups(to, list, &tracer);
    twins.field.take_ray_count(to, count);
  });
  ASSERT_GT(rays, 0u);
  EXPECT_NEAR(static_cast<double>(count.as<uint>().front()), static_cast<double>(rays),
              kTolerance * static_cast<double>(rays));

  double difference = 0.0, changed = 0.0, whole = 0.0;
  const auto slots = static_cast<std::size_t>(twins.field.lookups_per_surfel());
  for (const int probe : update.all) {
    const ProbeTrace& trace = update.traces[probe];
    const std::vector<SurfelLookup> found = twins.field.read_lookups(probe);
    for (std::size_t i = 0; i < trace.surfels.size(); ++i) {
      if (!trace.surfels[i].reflects() || trace.surfels[i].gi_share <= 0.0f) continue;
      for (int k = 0; k < kCellCorners; ++k) {
        const float expected = trace.lookups[i].corners.weight[k];
        difference += std::abs(found[i * slots].corners.weight[k] - expected);
        changed += std::abs(by_distances[probe].lookups[i].corners.weight[k] - expected);
        whole += expected;
      }
    }
  }
  EXPECT_LE(difference, kTolerance * whole);
  EXPECT_GT(changed, kChanged * whole);
}

TEST_P(FieldSights, AnswerQueriesAsOnTheProcessor) {
  Sighted twins(GetParam(), shared_device());
  RandomStream random = make_random_stream(1, 2, 3);
  const Bounds bounds = twins.stage.bounds();
  std::vector<FieldQuery> queries(3000);
  for (FieldQuery& query : queries) {
    const vec3 place(next_uniform2(random), next_uniform(random));
    query.position_ws = bounds.min + place * (bounds.max - bounds.min);
    query.normal_ws = test::random_unit(random);
    query.to_viewer_ws = test::random_unit(random);
  }
  std::vector<vec3> expected(queries.size());
  lookup_irradiance(twins.update.store, twins.by, queries, expected);
  const vulkan::Buffer in = vulkan::upload(device(), queries, "queries");
  const vulkan::Buffer out(device(), queries.size() * sizeof(vec3), vulkan::Memory::device, "E");
  twins.run([&](vulkan::Recorder& to, const DeviceTracer& tracer) {
    twins.field.record_lookup(to, {in.address()}, static_cast<std::uint32_t>(queries.size()),
                              {out.address()}, &tracer);
  });
  const auto found = vulkan::download<vec3>(device(), out);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    // Where hardly any probe is seen, Chebyshev's bound magnifies rounding
    if (length(found[i] - expected[i]) > 2e-3f * length(expected[i])) ++differ;
  }
  EXPECT_LE(static_cast<double>(differ), kTolerance * static_cast<double>(queries.size()));
}

class CellsAround : public test::OnDevice, public testing::WithParamInterface<SightCase> {};

TEST_P(CellsAround, AreThoseThatTheHostWouldList) {
  const Sighted twins(GetParam(), shared_device());
  const ProbeStore& store = twins.update.store;
  std::vector<int> some;
  for (int probe = 3; probe < store.probes(); probe += 17) some.push_back(probe);
  CellVisibility expected(store.probes());
  const std::vector<int> cells = cells_around(store, some);
  expected.update(tracer_of(twins.stage.world), store, cells);

  FieldResources field(device(), twins.update.settings, store);
  field.write_store(store);
  field.write_surfels(twins.update.all, twins.update.traces);
  field.reserve_visibility_around();
  const DeviceProbes list = field.list(some);
  const auto words = static_cast<std::uint32_t>(2 * store.probes());
  const vulkan::Buffer found(device(), words * sizeof(uint), vulkan::Memory::device, "found");
  const vulkan::Kernel copy(device(), shaders::copy_words_comp(), "copy words");
  twins.run([&](vulkan::Recorder& to, const DeviceTracer& tracer) {
    field.record_visibility_around(to, tracer, list);
    to.run(copy, CopyWordsArguments{field.cell_visibility(), {found.address()}, words, 0u}, words);
  });
  const auto bits = vulkan::download<uint>(device(), found);
  std::size_t differ = 0, hidden = 0;
  for (int probe = 0; probe < store.probes(); ++probe) {
    const uvec2 of_cell = expected.of_cell(probe);
    differ += uvec2(bits[2 * probe], bits[2 * probe + 1]) != of_cell ? 1 : 0;
    hidden += of_cell != all_visible() ? 1 : 0;
  }
  EXPECT_LE(static_cast<double>(differ), kTolerance * static_cast<double>(cells.size()));
  EXPECT_GT(hidden, some.size());
}

INSTANTIATE_TEST_SUITE_P(Modes, CellsAround,
                         testing::Values(SightCase{Visibility::hybrid, 0},
                                         SightCase{Visibility::hybrid, 3}));

INSTANTIATE_TEST_SUITE_P(Modes, FieldSights,
                         testing::Values(SightCase{Visibility::hybrid, 0},
                                         SightCase{Visibility::exact, 0},
                                         SightCase{Visibility::hybrid, 3},
                                         SightCase{Visibility::exact, 3}));

class SealedRoom : public test::OnDevice, public testing::WithParamInterface<Visibility> {
 protected:
  static FieldSettings settings() {
    FieldSettings settings;
    settings.probe_spacing = 1.0f;
    settings.rays_per_probe = 64;
    settings.visibility = GetParam();
    return settings;
  }
  /// Of what the camera, in the dark room, sees.
  static float brightest(const IrradianceField& field, const Stage& stage, const World& world) {
    const std::vector<FieldQuery> queries = test::seen_points(stage);
    std::vector<vec3> irradiance(queries.size());
    field.irradiance(queries, irradiance, &world);
    float largest = 0.0f;
    for (const vec3& e : irradiance) largest = max(largest, max(e.x, max(e.y, e.z)));
    return largest;
  }
};

TEST_P(SealedRoom, StaysDark) {
  const Stage stage("two-rooms-sealed");
  const World there(stage.scene, shared_device());
  IrradianceField field = IrradianceField::make(settings(), stage.bounds()).value();
  for (int i = 0; i < 2; ++i) field.update(there);
  EXPECT_EQ(brightest(field, stage, there), 0.0f);
}

TEST_P(SealedRoom, StaysDarkWhereverTheFieldGoes) {
  const Stage stage("two-rooms-sealed");
  const World there(stage.scene, shared_device());
  IrradianceField field = test::make_field(stage, settings(), 2);
  // Hardly a probe is traced, but all have moved
  UpdateRequest request;
  request.ray_budget = 100;
  field.update(there, request);
  ASSERT_NE(device_lookups_of(field), nullptr);
  EXPECT_EQ(brightest(field, stage, there), 0.0f);
  field.update(stage.world, request);
  ASSERT_EQ(device_lookups_of(field), nullptr);
  EXPECT_EQ(brightest(field, stage, stage.world), 0.0f);
}

INSTANTIATE_TEST_SUITE_P(ByRays, SealedRoom,
                         testing::Values(Visibility::hybrid, Visibility::exact));

}  // namespace
}  // namespace lambent::visibility_test
