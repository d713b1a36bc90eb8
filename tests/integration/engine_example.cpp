// SPDX-License-Identifier: Apache-2.0
// An engine lights a room by a field: docs/integration.md.
#include <lambent/vulkan_field.h>

#include <array>
#include <cstdio>
#include <exception>

#include "engine.h"
#include "room.h"

namespace {

// What the engine's shaders are given; engine_shade.comp.glsl, engine_look.comp.glsl.
struct ShadeArguments {
  VkDeviceAddress rays, hits, results, walls;
  glm::vec3 lamp_ws;
  float lamp_intensity;
  std::uint32_t count;
};
struct LookArguments {
  VkDeviceAddress field, positions, irradiance;
  std::uint32_t count;
};

constexpr int kFrames = 5;

void barrier(VkCommandBuffer commands, VkPipelineStageFlags to, VkAccessFlags access) {
  const VkMemoryBarrier written = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                   VK_ACCESS_SHADER_WRITE_BIT, access};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, to, 0, 1, &written, 0,
                       nullptr, 0, nullptr);
}

int run(const std::string& shader_folder) {
  // The engine makes its device with what Lambent needs, and lends it
  lambent::vulkan::RequiredFeatures features;
  features.request();
  Engine engine(lambent::vulkan::kRequiredExtensions, &features.core);
  lambent::vulkan::LentDevice lent;
  lent.get_instance_proc_addr = vkGetInstanceProcAddr;
  lent.instance = engine.instance;
  lent.physical_device = engine.physical_device;
  lent.device = engine.device;
  lent.queue = engine.queue;
  lent.queue_family = engine.queue_family;
  const auto device = lambent::vulkan::adopt_device(lent);
  if (!device) return std::fprintf(stderr, "%s\n", device.error().message().c_str()), 1;

  // A field of two cascades around the viewer, the finer one a little larger than the room
  Room room = make_room();
  lambent::FieldSettings settings;
  settings.cascades = 2;
  settings.probe_count = glm::ivec3(8);
  settings.probe_spacing = 0.4f;
  settings.visibility = lambent::Visibility::hybrid;
  lambent::vulkan::RecordedFieldSettings recorded;
  recorded.frames_in_flight = Engine::kFramesInFlight;
  auto field = lambent::vulkan::RecordedField::make(*device, settings, room.bounds, recorded);
  if (!field) return std::fprintf(stderr, "%s\n", field.error().message().c_str()), 1;

  // What the engine has anyway: an acceleration structure, materials, shaders
  const VkAccelerationStructureKHR structure = engine.build_structure(room.shapes);
  const EngineBuffer walls = engine.upload<Wall>(room.walls);
  const VkPipeline shade = engine.pipeline(shader_folder + "/engine_shade.spv");
  const VkPipeline look = engine.pipeline(shader_folder + "/engine_look.spv");
  const EngineBuffer points = engine.upload<glm::vec3>(room.points);
  const auto count = static_cast<std::uint32_t>(room.points.size() / 2);
  const EngineBuffer found = engine.buffer(count * sizeof(glm::vec3));

  // A frame: the field's update, and the engine's shaders that look it up
  glm::vec3 viewer_ws(0.0f);
  for (int frame = 0; frame < kFrames; ++frame) {
    const VkCommandBuffer commands = engine.begin_frame();
    lambent::vulkan::UpdatePlan plan;
    viewer_ws.x = 0.1f * static_cast<float>(frame);
    plan.viewer_ws = viewer_ws;
    lambent::WorldChanges dimmed;
    dimmed.lights.resize(1);
    if (frame == kFrames - 1) {
      // The lamp is dimmed: told of it, the field follows in this very frame
      room.lamp_intensity *= 0.25f;
      plan.changes = {&dimmed, 1};
    }
    const lambent::vulkan::PlannedUpdate update = field->plan(plan).value();
    field->record_rays(commands);
    field->record_trace(commands, structure);
    const ShadeArguments shading = {field->rays().address,
                                    field->hits().address,
                                    field->results().address,
                                    walls.address,
                                    room.lamp_ws,
                                    room.lamp_intensity,
                                    update.rays};
    engine.dispatch(commands, shade, shading, update.rays);
    const auto solved = field->record_update(commands, structure);
    if (!solved) return std::fprintf(stderr, "%s\n", solved.error().message().c_str()), 1;
    field->record_maintain(commands);
    const LookArguments looking = {field->lookup_buffers().record.address, points.address,
                                   found.address, count};
    engine.dispatch(commands, look, looking, count);
    barrier(commands, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    engine.submit_frame();
  }
  engine.wait_idle();
  const auto* irradiance = static_cast<const glm::vec3*>(found.mapped);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::printf("irradiance %6.3f %6.3f %6.3f W/m^2\n", irradiance[i].x, irradiance[i].y,
                irradiance[i].z);
  }
  for (const std::string& message : engine.messages) std::fprintf(stderr, "%s\n", message.c_str());
  const bool expected = is_as_expected(room, settings, viewer_ws, {irradiance, count});
  return engine.messages.empty() && expected ? 0 : 1;
}

}  // namespace

int main(int, char** argv) try { return run(argv[1]); } catch (const NoDevice& none) {
  return std::printf("skipped: %s\n", none.what()), 77;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
