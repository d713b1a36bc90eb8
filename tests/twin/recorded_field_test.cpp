// SPDX-License-Identifier: Apache-2.0
// Fields that engines record, against the processor's on the same rays. The engine is played by the
// host: it traces and shades what the field asks for.
#include "lambent/vulkan_field.h"

#include <algorithm>
#include <numeric>

#include "field/field_record.h"
#include "field/probe_record.h"
#include "field/ray_results.h"
#include "field/recorded_arguments.h"
#include "field/recorded_plan.h"
#include "field/surfels.h"
#include "shaders/engine_lookup_comp.h"
#include "support/field_scenes.h"
#include "support/vulkan_device.h"
#include "twin/engine_lookup.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

using test::Stage;
using vulkan::Buffer, vulkan::BufferRange, vulkan::Memory, vulkan::RecordedField,
    vulkan::RecordedFieldSettings;

const Stage& cornell() {
  static const Stage stage("cornell");
  return stage;
}

FieldSettings few_probes() {
  FieldSettings settings;
  settings.probe_count = {5, 4, 4};
  settings.rays_per_probe = 72;
  settings.relocation = false;
  return settings;
}

RayResult told_of(const Ray& ray, const Hit& hit, const ShadedHit& shaded) {
  if (hit.missed()) return ray_left(shaded.sky_radiance);
  if (!shaded.counts) return ray_met_back_face(hit.distance, shaded.geometric_normal_ws);
  return ray_met_surface(length(shaded.position_ws - ray.origin), shaded.normal_ws,
                         shaded.geometric_normal_ws, shaded.albedo_over_pi * kPi,
                         shaded.direct_irradiance, vec3(0.0f));
}

class RecordedFieldTest : public test::OnDevice {
 protected:
  static RecordedField make(const FieldSettings& settings, const RecordedFieldSettings& recorded) {
    return RecordedField::make(shared_device(), settings, cornell().bounds(), recorded).value();
  }

  static void copy(vulkan::Recorder& to, const BufferRange& from, const BufferRange& into) {
    const VkBufferCopy region = {from.offset, into.offset, std::min(from.bytes, into.bytes)};
    device().fn().vkCmdCopyBuffer(to.commands(), from.buffer, into.buffer, 1, &region);
  }
  static BufferRange range(const Buffer& buffer) {
    return {buffer.handle(), buffer.offset(), buffer.bytes(), buffer.address()};
  }
  template <class T>
  static std::vector<T> download(const BufferRange& from) {
    const Buffer down(device(), from.bytes, Memory::readback, "down");
    device().run([&](vulkan::Recorder& to) { copy(to, from, range(down)); });
    return {down.as<T>().begin(), down.as<T>().end()};
  }

  /// An update, shaded by the host as the processor's field would.
  static void update(RecordedField& field, const vulkan::UpdatePlan& plan = {}) {
    const std::uint32_t number = field.updates();
    const vulkan::PlannedUpdate planned = field.plan(plan);
    device().run([&](vulkan::Recorder& to) { field.record_rays(to.commands()); });
    const auto records = download<RayRecord>(field.rays());
    const RaySet set(field.settings(), static_cast<int>(planned.rays_per_probe), number);
    const ShadeHitsSettings shading = surfel_shading(field.settings(), set);
    const Buffer results(device(), planned.rays * sizeof(RayResult), Memory::upload, "results");
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < planned.rays; ++i) {
      rays.push_back(probe_ray(records[i].origin_ws, records[i].direction_ws));
    }
    std::vector<Hit> hits(rays.size());
    std::vector<ShadedHit> shaded(rays.size());
    cornell().world.tracer().closest_hits(rays, hits);
    ShadeHitsScratch scratch;
    const std::size_t each = planned.rays_per_probe;
    for (std::size_t k = 0; k < planned.probes; ++k) {
      shade_hits(cornell().world, {&rays[k * each], each}, {&hits[k * each], each}, shading,
                 first_ray_index(static_cast<int>(k)), scratch, {&shaded[k * each], each});
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      results.as<RayResult>()[i] = told_of(rays[i], hits[i], shaded[i]);
    }
    device().run([&](vulkan::Recorder& to) {
      copy(to, range(results), field.results());
      field.record_update(to.commands());
      field.record_maintain(to.commands());
    });
  }

  static std::vector<vec3> look_up(const RecordedField& field,
                                   std::span<const FieldQuery> queries) {
    const Buffer asked = vulkan::upload(device(), queries, "queries");
    const Buffer found(device(), sizeof(vec3) * queries.size(), Memory::device, "found");
    const auto record = download<FieldRecord>(field.lookup_buffers().record).front();
    const auto count = static_cast<std::uint32_t>(queries.size());
    const EngineLookupArguments arguments = {
        record, {asked.address()}, {found.address()}, count, 0u};
    const vulkan::Kernel kernel(device(), shaders::engine_lookup_comp(), "engine");
    device().run([&](vulkan::Recorder& to) { to.run(kernel, arguments, count); });
    return vulkan::download<vec3>(device(), found);
  }

  /// Relative root mean square of what two fields answer.
  static double difference(std::span<const vec3> a, std::span<const vec3> b) {
    double off = 0.0, all = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      off += dot(a[i] - b[i], a[i] - b[i]);
      all += dot(b[i], b[i]);
    }
    return sqrt(off / all);
  }
};

TEST_F(RecordedFieldTest, HoldsWhatTheProcessorsFieldDoes) {
  const FieldSettings settings = few_probes();
  RecordedField field = make(settings, {});
  for (int i = 0; i < 3; ++i) update(field);
  const IrradianceField on_cpu = test::make_field(cornell(), settings, 3);
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  // The same rays and random numbers; sums in another order, and both stop at the same residual
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), 0.005);

  // Probes in solid matter are off, and have no rays while they are not looked at
  const auto states = download<uint>(field.states());
  int off = 0;
  for (std::size_t probe = 0; probe < states.size(); ++probe) {
    EXPECT_EQ(states[probe] == kProbeOff, on_cpu.records()[probe].state == ProbeState::off);
    off += states[probe] == kProbeOff ? 1 : 0;
  }
  EXPECT_GT(off, 0);
  const auto rays = download<RayRecord>(field.rays());
  EXPECT_EQ(std::count_if(rays.begin(), rays.end(), [](const RayRecord& r) { return r.mask == 0; }),
            off * settings.rays_per_probe);
}

TEST_F(RecordedFieldTest, OfPartsOfItsProbesInTurnComesToTheSameLight) {
  const FieldSettings settings = few_probes();
  RecordedFieldSettings recorded;
  recorded.probes_per_update = 24;  // of 80: four updates a round, the last of eight probes
  RecordedField field = make(settings, recorded);
  for (int i = 0; i < 4 * 12; ++i) update(field);
  const IrradianceField on_cpu = test::make_field(cornell(), settings, 12);
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  // Noise of other rays: 12 x 72 a probe on both sides
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), 0.08);
}

TEST_F(RecordedFieldTest, MovesProbesAtTheStartAndThenLeavesThem) {
  FieldSettings settings = few_probes();
  settings.relocation = true;
  RecordedFieldSettings recorded;
  recorded.placing_updates = 6;
  RecordedField field = make(settings, recorded);
  const auto offsets = [&] { return download<uint>(field.lookup_buffers().offsets); };
  for (int i = 0; i < 7; ++i) update(field);
  const std::vector<uint> placed = offsets();
  EXPECT_GT(std::count_if(placed.begin(), placed.end(), [](uint word) { return word != 0; }), 20);
  for (int i = 0; i < 2; ++i) update(field);
  EXPECT_EQ(offsets(), placed);
  const IrradianceField on_cpu = [&] {
    FieldSettings s = settings;
    s.seed = 5;
    return test::make_field(cornell(), s, 16);
  }();
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), 0.1);
}

TEST_F(RecordedFieldTest, ForgetsWhatItIsToldTo) {
  FieldSettings settings = few_probes();
  settings.relight_tolerance = 1e-5f;
  RecordedField field = make(settings, {});
  for (int i = 0; i < 3; ++i) update(field);
  update(field, {.history = 0.0f});
  RecordedField fresh = make(settings, {});
  for (int i = 0; i < 3; ++i) fresh.plan();  // as many random numbers later
  update(fresh);
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  // The same rays; the solve starts from another light
  EXPECT_LE(difference(look_up(field, queries), look_up(fresh, queries)), 0.001);
}

TEST_F(RecordedFieldTest, RefusesWhatItCannotDo) {
  const auto refused = [](const FieldSettings& settings, const RecordedFieldSettings& recorded) {
    return !RecordedField::make(shared_device(), settings, cornell().bounds(), recorded);
  };
  FieldSettings settings = few_probes();
  EXPECT_TRUE(refused(settings, {.frames_in_flight = 0}));
  EXPECT_TRUE(refused(settings, {.placing_updates = 1}));
  EXPECT_TRUE(refused(settings, {.probes_per_update = -1}));
  settings.max_bounces = 2;
  EXPECT_TRUE(refused(settings, {.probes_per_update = 8}));
  settings = few_probes();
  settings.visibility = Visibility::exact;
  EXPECT_TRUE(refused(settings, {}));
  settings = {};
  settings.cascades = 2;
  EXPECT_TRUE(refused(settings, {}));
}

TEST(TurnPlan, ServesEachProbeOnceARound) {
  RecordedFieldSettings recorded;
  recorded.probes_per_update = 30;
  recorded.placing_updates = 3;
  vulkan::TurnPlan plan(FieldSettings{}, recorded, 100);
  for (int round = 0; round < 5; ++round) {
    int next = 0;
    for (int i = 0; i < 4; ++i) {
      const vulkan::Turn turn = plan.next({});
      EXPECT_EQ(turn.first, next);
      next += turn.count;
      const uint place[] = {kPlaceFirstStep, kPlaceStep, kPlaceEnd, kPlaceLeave, kPlaceLeave};
      EXPECT_EQ(turn.place, place[round]);
      EXPECT_EQ(turn.starts_anew, round < 2);
      EXPECT_FLOAT_EQ(turn.largest_share, round < 4 ? 1.0f : 0.5f);
    }
    EXPECT_EQ(next, 100);
  }
}

}  // namespace
}  // namespace lambent
