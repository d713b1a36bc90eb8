// SPDX-License-Identifier: Apache-2.0
// Compares each pass of a field's update on a device with the processor's on the same inputs.
#include <algorithm>

#include "field/vulkan/device_solver.h"
#include "support/vulkan_device.h"
#include "twin/field_update_cpu.h"
#include "vulkan/device_memory.h"

namespace lambent::field_passes_test {
namespace {

using test::few_cascades;
using test::few_probes;
using test::relative_distance;
using test::Stage;
using test::UpdateOnCpu;

const Stage& cornell() {
  static const Stage stage("cornell");
  return stage;
}

const UpdateOnCpu& one_volume() {
  static const UpdateOnCpu update(cornell(), few_probes());
  return update;
}

const UpdateOnCpu& cascades() {
  static const UpdateOnCpu update(cornell(), few_cascades());
  return update;
}

class FieldPasses : public test::OnDevice {
 protected:
  /// A field on the device in the state of the processor's after all passes but the solve.
  static FieldResources put(const UpdateOnCpu& update) {
    FieldResources field(device(), update.settings, update.store);
    field.write_surfels(update.all, update.traces);
    return field;
  }
  static WorkingIrradiance download_light(const vulkan::Buffer& buffer, std::size_t texels) {
    WorkingIrradiance light(texels);
    vulkan::read<vec4>(device(), buffer, light);
    return light;
  }
  /// Sorts light from the list's order of probes into the caller's order.
  static WorkingIrradiance in_order(const DeviceProbes& list, const WorkingIrradiance& light,
                                    std::size_t texels) {
    WorkingIrradiance ordered(light.size());
    for (std::size_t k = 0; k < list.position.size(); ++k) {
      std::copy_n(&light[list.position[k] * texels], texels, &ordered[k * texels]);
    }
    return ordered;
  }
  /// Sorts light from the caller's order of probes into the list's order.
  static WorkingIrradiance in_list(const DeviceProbes& list, const WorkingIrradiance& ordered,
                                   std::size_t texels) {
    WorkingIrradiance light(ordered.size());
    for (std::size_t k = 0; k < list.position.size(); ++k) {
      std::copy_n(&ordered[k * texels], texels, &light[list.position[k] * texels]);
    }
    return light;
  }
};

TEST_F(FieldPasses, RaysLeaveProbesWhereTheyStand) {
  const UpdateOnCpu& update = cascades();
  FieldResources field = put(update);
  const TraceGroup& group = update.groups[1];
  const DeviceProbes list = field.list(group.probes);
  const std::size_t rays = group.rays->rays();
  const vulkan::Buffer buffer(device(), list.probes.size() * rays * sizeof(RayRecord),
                              vulkan::Memory::device, "rays");
  device().run([&](vulkan::Recorder& to) {
    field.record_rays(to, list, {0, list.count(), static_cast<int>(rays)}, {buffer.address()});
  });
  const auto records = vulkan::download<RayRecord>(device(), buffer);
  for (std::size_t k = 0; k < list.probes.size(); ++k) {
    const vec3 origin = update.store.probe_position_ws(list.probes[k]);
    for (std::size_t i = 0; i < rays; ++i) {
      const RayRecord& record = records[k * rays + i];
      const Ray ray = probe_ray(origin, group.rays->directions[i]);
      // Devices may fuse or reorder a product's roundings
      ASSERT_LE(length(record.origin_ws - ray.origin), 1e-6f * (1.0f + length(ray.origin)));
      ASSERT_EQ(record.direction_ws, ray.direction);
      ASSERT_EQ(record.t_min, ray.t_min);
      ASSERT_EQ(record.t_max, ray.t_max);
      ASSERT_EQ(record.mask, ray.mask);
    }
  }
}

/// Expects almost equal distances of two stores. Where the dither is close to the border between
/// two codes, rounding may change the code.
void expect_like_distances(const ProbeStore& a, const ProbeStore& b) {
  std::size_t other = 0;
  const bool halves = a.distance_format() == DistanceFormat::rg16f;
  for (std::size_t i = 0; i < a.distance_words().size(); ++i) {
    const uint x = a.distance_words()[i], y = b.distance_words()[i];
    if (x != y) ++other;
    if (halves) {
      const vec2 u = decode_half2(x), v = decode_half2(y);
      ASSERT_LE(abs(u.x - v.x), 1.1e-3f * u.x) << i;
      ASSERT_LE(abs(u.y - v.y), 1.1e-3f * u.y) << i;
    } else {
      // The device computes powers of cosines differently, and sums in another order
      ASSERT_NEAR(uintBitsToFloat(x), uintBitsToFloat(y), 2e-5f * uintBitsToFloat(x)) << i;
    }
  }
  if (halves) {
    EXPECT_LE(other, a.distance_words().size() / 100);
  }
}

TEST_F(FieldPasses, DistancesAreBlendedAsOnTheProcessor) {
  for (const DistanceFormat format : {DistanceFormat::rg16f, DistanceFormat::rg32f}) {
    FieldSettings settings = few_probes();
    settings.distance_format = format;
    const UpdateOnCpu update(cornell(), settings);
    FieldResources field = put(update);
    field.write_store(update.before);
    const DeviceProbes list = field.list(update.all);
    field.reserve_seen(list);
    const std::vector<float> blend_weights(update.all.size(), UpdateOnCpu::kShare);
    const vulkan::Buffer blend_weight_buffer =
        vulkan::upload(device(), blend_weights, "blend_weights");
    std::vector<vulkan::Buffer> hits;
    int first = 0;
    for (const TraceGroup& group : update.groups) {
      std::vector<HitRecord> records;
      for (const Hit& hit : group.hits) {
        records.push_back(
            {hit.distance, hit.instance, hit.triangle, {}, hit.front_face ? 1u : 0u, 1.0f});
      }
      hits.push_back(vulkan::upload(device(), records, "hits"));
      const DeviceGroup part = {first, static_cast<int>(group.probes.size()), group.rays->rays()};
      device().run([&](vulkan::Recorder& to) {
        field.record_seen_distances(to, list, part, {hits.back().address()});
      });
      first += part.count;
    }
    device().run([&](vulkan::Recorder& to) {
      field.record_blend_distances(to, list, {blend_weight_buffer.address()}, UpdateOnCpu::kSalt);
    });
    ProbeStore blended = update.before;
    field.read_store(blended);
    expect_like_distances(update.store, blended);
  }
}

void expect_like_lookups(const UpdateOnCpu& update, const FieldResources& field) {
  std::size_t further = 0;
  for (const int probe : update.all) {
    const ProbeTrace& trace = update.traces[probe];
    const std::vector<SurfelLookup> found = field.read_lookups(probe);
    const auto slots = static_cast<std::size_t>(field.lookups_per_surfel());
    std::vector<std::size_t> next(trace.surfels.size(), 0);
    const auto expect = [&](std::size_t ray, const SurfelLookup& should) {
      // Where no probe has a weight, nothing is read
      if (std::count(should.corners.weight, should.corners.weight + kCellCorners, 0.0f) ==
          kCellCorners) {
        return;
      }
      const SurfelLookup& is = found[ray * slots + next[ray]++];
      // Chebyshev's bound is steep, and the processor and the device round its inputs differently
      for (int k = 0; k < kCellCorners; ++k) {
        ASSERT_NEAR(is.corners.weight[k], should.corners.weight[k], 2e-3f);
      }
      ASSERT_EQ(is.corners.base, should.corners.base);
      ASSERT_EQ(is.corners.table, should.corners.table);
      ASSERT_EQ(is.tile_corner, should.tile_corner);
      ASSERT_NEAR(is.fraction_x, should.fraction_x, 1e-5f);
      ASSERT_NEAR(is.fraction_y, should.fraction_y, 1e-5f);
    };
    for (std::size_t i = 0; i < trace.surfels.size(); ++i) {
      const Surfel& surfel = trace.surfels[i];
      if (surfel.reflects() && surfel.gi_share > 0.0f) expect(i, trace.lookups[i]);
    }
    for (const FurtherLookup& f : trace.further) expect(f.ray, f.lookup);
    further += trace.further.size();
    for (std::size_t i = 0; i < next.size(); ++i) {
      for (std::size_t l = next[i]; l < slots; ++l) {
        ASSERT_EQ(found[i * slots + l].tile_corner, kNoLookup);
      }
    }
  }
  EXPECT_EQ(further > 0, update.store.volumes() > 1);
}

TEST_F(FieldPasses, SurfelsReadTheFieldAsOnTheProcessor) {
  for (const UpdateOnCpu* update : {&one_volume(), &cascades()}) {
    FieldResources field = put(*update);
    const DeviceProbes list = field.list(update->all);
    device().run([&](vulkan::Recorder& to) { field.record_lookups(to, list); });
    expect_like_lookups(*update, field);
  }
}

TEST_F(FieldPasses, LightIsCarriedAsOnTheProcessor) {
  for (const UpdateOnCpu* update : {&one_volume(), &cascades()}) {
    FieldResources field = put(*update);
    const DeviceProbes list = field.list(update->all);
    field.reserve_transport(list);
    const WorkingIrradiance light = update->direct_light();
    WorkingIrradiance expected = update->darkness();
    const vulkan::Buffer in = vulkan::upload<vec4>(device(), light, "light");
    const vulkan::Buffer fallback =
        vulkan::upload<vec4>(device(), in_list(list, light, update->tile_texels()), "fallback");
    const vulkan::Buffer out(device(), light.size() * sizeof(vec4), vulkan::Memory::device, "out");
    for (const uint mode : {kGatherAll, kGatherSky}) {
      device().run([&](vulkan::Recorder& to) {
        field.record_transport(to, list,
                               {{in.address()}, {fallback.address()}, {}, {out.address()}, mode});
      });
      const WorkingIrradiance received =
          in_order(list, download_light(out, light.size()), update->tile_texels());
      if (mode == kGatherAll) update->transport().apply(light, light, expected);
      if (mode == kGatherSky) update->transport().apply_sky(light, expected);
      // The sums of some hundred products are in another order
      const double far =
          norm(expected) > 0.0 ? relative_distance(received, expected) : norm(received);
      EXPECT_LE(far, 1e-5) << mode;
    }
  }
}

TEST_F(FieldPasses, ASolveComesToWhatTheProcessorsDoes) {
  for (const UpdateOnCpu* update : {&one_volume(), &cascades()}) {
    FieldResources field = put(*update);
    DeviceSolver solver(field);
    const DeviceProbes list = field.list(update->all);
    solver.reserve(list);
    const SolveSettings settings{0.95f, 1e-5f, 24};
    for (const float blend_weight : {1.0f, 0.3f}) {
      WorkingIrradiance expected = update->direct_light();
      vulkan::write<vec4>(device(), expected, field.light());
      const std::vector<float> blend_weights(update->all.size(), blend_weight);
      const SolveResult there =
          solve_bounces(update->transport(), blend_weights, {}, settings, expected);
      const vulkan::Buffer blend_weight_buffer =
          vulkan::upload(device(), blend_weights, "blend_weights");
      device().run([&](vulkan::Recorder& to) {
        solver.record(to, list, blend_weight_buffer, blend_weight, {}, settings);
      });
      const DeviceSolve here = solver.result();
      EXPECT_NEAR(here.iterations, there.iterations, 1);
      EXPECT_LE(here.error, settings.tolerance);
      EXPECT_NEAR(here.change, there.change, 1e-4 * there.change);
      // Both solutions are exact up to the tolerance
      const WorkingIrradiance solved = download_light(field.light(), expected.size());
      EXPECT_LE(relative_distance(solved, expected), 2.0 * settings.tolerance);
      const WorkingIrradiance solution =
          in_order(list, download_light(solver.solution(), expected.size()), update->tile_texels());
      EXPECT_LE(relative_distance(solution, there.solution),
                2.0 * settings.tolerance / blend_weight);
    }
  }
}

TEST_F(FieldPasses, ASolveStopsAtTheIterationsItIsGiven) {
  const UpdateOnCpu& update = one_volume();
  FieldResources field = put(update);
  DeviceSolver solver(field);
  const DeviceProbes list = field.list(update.all);
  solver.reserve(list);
  const vulkan::Buffer blend_weights =
      vulkan::upload(device(), std::vector<float>(update.all.size(), 1.0f), "blend_weights");
  WorkingIrradiance plain = update.darkness(), next = plain;
  for (int i = 0; i < 2; ++i) {
    update.transport().apply(plain, update.darkness(), next);
    plain.swap(next);
  }
  device().run([&](vulkan::Recorder& to) {
    solver.record(to, list, blend_weights, 1.0f, {}, {0.95f, 1e-7f, 2});
  });
  EXPECT_EQ(solver.result().iterations, 2);
  // The first two iterations have no earlier steps to extrapolate from
  const WorkingIrradiance solution =
      in_order(list, download_light(solver.solution(), plain.size()), update.tile_texels());
  EXPECT_LE(relative_distance(solution, plain), 1e-5);
}

TEST_F(FieldPasses, BouncesAreCountedAsOnTheProcessor) {
  const UpdateOnCpu& update = one_volume();
  FieldResources field = put(update);
  DeviceSolver solver(field);
  const DeviceProbes list = field.list(update.all);
  solver.reserve(list);
  const std::vector<float> blend_weights(update.all.size(), 0.6f);
  const vulkan::Buffer blend_weight_buffer =
      vulkan::upload(device(), blend_weights, "blend_weights");
  WorkingIrradiance expected = update.direct_light();
  vulkan::write<vec4>(device(), expected, field.light());
  solve_counted_bounces(update.transport(), blend_weights, 3, expected);
  device().run(
      [&](vulkan::Recorder& to) { solver.record_bounces(to, list, blend_weight_buffer, 3); });
  EXPECT_LE(relative_distance(download_light(field.light(), expected.size()), expected), 1e-5);
}

TEST_F(FieldPasses, LightIsStoredAsOnTheProcessor) {
  for (const IrradianceFormat format :
       {IrradianceFormat::rgb9e5, IrradianceFormat::r11g11b10f, IrradianceFormat::float32}) {
    FieldSettings settings = few_probes();
    settings.irradiance_format = format;
    ProbeStore store(test::grids_for(settings, cornell().bounds()), settings);
    FieldResources field(device(), settings, store);
    RandomStream random = make_random_stream(5, 6, 7);
    WorkingIrradiance light(static_cast<std::size_t>(store.probes()) * field.tile_texels());
    for (vec4& texel : light) {
      const float scale = exp2(20.0f * next_uniform(random) - 10.0f);
      texel = vec4(scale * next_uniform(random), scale, scale * next_uniform(random), 0.0f);
    }
    std::vector<int> probes;
    for (int probe = 0; probe < store.probes(); probe += 3) probes.push_back(probe);
    vulkan::write<vec4>(device(), light, field.light());
    DeviceProbes list;
    list.probes = probes;
    list.indices = vulkan::upload(device(), probes, "probes");
    device().run([&](vulkan::Recorder& to) { field.record_store_light(to, list, 9u); });
    ProbeStore stored = store;
    field.read_store(stored);
    std::vector<vec3> interior(field.tile_texels());
    for (const int probe : probes) {
      for (std::size_t t = 0; t < interior.size(); ++t) {
        interior[t] = vec3(light[probe * interior.size() + t]);
      }
      store.store_irradiance(probe, interior, 9u);
    }
    std::size_t other = 0;
    for (std::size_t i = 0; i < store.irradiance_words().size(); ++i) {
      if (store.irradiance_words()[i] != stored.irradiance_words()[i]) ++other;
    }
    // The perceptual encoding computes a power, in whose last bits a device may differ
    const std::size_t allowed =
        format == IrradianceFormat::r11g11b10f ? store.irradiance_words().size() / 100 : 0;
    EXPECT_LE(other, allowed) << static_cast<int>(format);
  }
}

TEST_F(FieldPasses, ChangesOfLightAreMeasuredAsOnTheProcessor) {
  const UpdateOnCpu& update = one_volume();
  FieldResources field = put(update);
  const DeviceProbes list = field.list(update.all);
  const WorkingIrradiance before = update.direct_light();
  WorkingIrradiance now = update.darkness();
  update.transport().apply(before, before, now);
  vulkan::write<vec4>(device(), now, field.light());
  const std::size_t texels = update.tile_texels();
  const vulkan::Buffer held =
      vulkan::upload<vec4>(device(), in_list(list, before, texels), "before");
  const vulkan::Buffer out(device(), update.all.size() * sizeof(vec3), vulkan::Memory::device,
                           "changes");
  device().run([&](vulkan::Recorder& to) {
    field.record_compare_light(to, list, {held.address()}, {out.address()});
  });
  const auto changes = vulkan::download<vec3>(device(), out);
  for (std::size_t k = 0; k < update.all.size(); ++k) {
    const TileLight b(&before[k * texels], texels), n(&now[k * texels], texels);
    const vec3 change = changes[list.position[k]];
    const LightChange expected = light_change(b, n);
    EXPECT_NEAR(change.x, expected.squares, 1e-4f * change.x);
    EXPECT_NEAR(change.y, expected.before, 1e-5f * change.y);
    EXPECT_NEAR(change.z, expected.now, 1e-5f * change.z);
  }
}

}  // namespace
}  // namespace lambent::field_passes_test
