// SPDX-License-Identifier: Apache-2.0
// A recorded field whose engine is played by the host: it traces and shades what the field asks
// for.
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "field/lookup/field_record.h"
#include "field/transport/surfels.h"
#include "lambent/shaders/ray_results.h"
#include "lambent/vulkan_field.h"
#include "raytracing/world_access.h"
#include "shaders/engine_lookup_comp.h"
#include "support/field_scenes.h"
#include "support/vulkan_device.h"
#include "twin/engine_lookup.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent::test {

using vulkan::Buffer, vulkan::BufferRange, vulkan::Memory, vulkan::RecordedField,
    vulkan::RecordedFieldSettings;

inline const Stage& cornell() {
  static const Stage stage("cornell");
  return stage;
}

inline FieldSettings recorded_settings() {
  FieldSettings settings;
  settings.probe_count = {5, 4, 4};
  settings.rays_per_probe = 72;
  settings.relocation = false;
  settings.corrections = false;  // engines' fields do not learn them
  return settings;
}

inline RayResult ray_result(const Ray& ray, const Hit& hit, const ShadedHit& shaded) {
  const LitPoint& point = shaded.point;
  if (hit.missed()) return ray_left(shaded.surface.radiance);
  if ((shaded.surface.flags & kSurfaceDiscounted) != 0) {
    return ray_met_back_face(hit.distance, point.geometric_normal_ws);
  }
  return ray_met_surface(length(point.position_ws - ray.origin), point.normal_ws,
                         point.geometric_normal_ws, shaded.surface.albedo_over_pi * kPi,
                         shaded.direct_irradiance, vec3(0.0f));
}

/// What the engine has that the host plays.
struct HostEngine {
  const World& world = cornell().world;  ///< In which the host traces and shades.
  const Scene& scene = cornell().scene;  ///< That world's; says which sides of it are solid.
  VkAccelerationStructureKHR structure = VK_NULL_HANDLE;  ///< For visibility rays.
};

class RecordedFieldTest : public OnDevice {
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
  static void update(RecordedField& field, const vulkan::UpdatePlan& plan = {},
                     const World& world = cornell().world) {
    update(field, plan, HostEngine{world});
  }
  static void update(RecordedField& field, const vulkan::UpdatePlan& plan,
                     const HostEngine& engine) {
    const World& world = engine.world;
    // Rays that are traced again are shaded with the random numbers of the update that drew them
    static std::map<const RecordedField*, std::uint32_t> drawn_in;
    std::uint32_t number = field.updates();
    const vulkan::PlannedUpdate planned = field.plan(plan).value();
    if (planned.retraces) number = drawn_in.at(&field);
    drawn_in[&field] = number;
    device().run([&](vulkan::Recorder& to) { field.record_rays(to.commands()); });
    const auto records = download<RayRecord>(field.rays());
    const RaySet set(field.settings(), static_cast<int>(planned.rays_per_probe), number);
    const SolidSides sides = solid_sides_by_winding(engine.scene);
    const ShadeHitsSettings shading = surfel_shading(field.settings(), set, &sides);
    const Buffer results(device(), planned.rays * sizeof(RayResult), Memory::upload, "results");
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < planned.rays; ++i) {
      const RayRecord& record = records[i];
      // Others hold nothing
      const bool asked = record.mask != 0;
      rays.push_back(probe_ray(asked ? record.origin_ws : vec3(0.0f),
                               asked ? record.direction_ws : vec3(0.0f, 0.0f, 1.0f)));
    }
    std::vector<Hit> hits(rays.size());
    std::vector<ShadedHit> shaded(rays.size());
    tracer_of(world).closest_hits(rays, hits);
    ShadeHitsScratch scratch;
    const std::size_t each = planned.rays_per_probe;
    for (std::size_t k = 0; k < planned.probes; ++k) {
      shade_hits(world, {&rays[k * each], each}, {&hits[k * each], each}, shading,
                 first_ray_index(static_cast<int>(k)), scratch, {&shaded[k * each], each});
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      results.as<RayResult>()[i] = ray_result(rays[i], hits[i], shaded[i]);
    }
    device().run([&](vulkan::Recorder& to) {
      copy(to, range(results), field.results());
      EXPECT_TRUE(field.record_update(to.commands(), engine.structure));
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

}  // namespace lambent::test
