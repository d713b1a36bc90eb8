// SPDX-License-Identifier: Apache-2.0
// Motion vectors of a frame's pixels on a device, and temporal anti-aliasing, which uses them.
#include <cstddef>
#include <unordered_map>

#include "compose/frame_vulkan.h"
#include "compose/motion/motion.h"

namespace lambent {

/// Writes the previous frame's views and moved vertices to the device.
void FramePassesVulkan::upload_before() {
  const FrameBefore* before = request_->before;
  const FrameSettings& settings = request_->settings;
  SceneBeforeRecord record{};
  record.views = motion_views(request_->camera, settings.width, settings.height, before);
  record.at_rest = before == nullptr || before->at_rest ? 1u : 0u;
  if (record.at_rest == 0u) {
    // Upload each mesh once, however many instances have it
    std::unordered_map<const std::vector<vec3>*, std::size_t> first_of;
    std::vector<vec3> positions;
    for (const InstanceBefore& instance : before->instances) {
      if (instance.positions == nullptr) continue;
      if (!first_of.emplace(instance.positions.get(), positions.size()).second) continue;
      positions.insert(positions.end(), instance.positions->begin(), instance.positions->end());
    }
    reserve<vec3>(positions.size(), "positions before", memory_.positions_before);
    vulkan::write(device_, std::span<const vec3>(positions), memory_.positions_before);

    std::vector<InstanceBeforeRecord> instances;
    instances.reserve(before->instances.size());
    for (const InstanceBefore& was : before->instances) {
      InstanceBeforeRecord& placed = instances.emplace_back();
      placed.world_from_object = was.world_from_object;
      placed.flags = was.known ? kBeforeKnown : 0u;
      if (was.positions == nullptr) continue;
      placed.flags |= kPreviouslyDeformed;
      placed.positions.address =
          memory_.positions_before.address() + first_of.at(was.positions.get()) * sizeof(vec3);
    }
    reserve<InstanceBeforeRecord>(instances.size(), "instances before", memory_.instances_before);
    vulkan::write(device_, std::span<const InstanceBeforeRecord>(instances),
                  memory_.instances_before);
    record.instances.address = memory_.instances_before.address();
  }
  reserve<SceneBeforeRecord>(1, "scene before", memory_.scene_before);
  vulkan::write(device_, std::span<const SceneBeforeRecord>(&record, 1), memory_.scene_before);
}

void FramePassesVulkan::begin_motion(std::size_t pixels) {
  upload_before();
  reserve<PixelMotion>(pixels, "motion of the picture", memory_.picture_motion);
  reserve<uint>(1, "further rays counted", memory_.further_ray_count);
  device_.run([&](Recorder& to) { to.fill(memory_.further_ray_count, 0u); });
}

void FramePassesVulkan::motion() {
  const bool sees_through = has_see_through(request_->world.scene());
  reserve<PixelMotion>(pixels_, "motion", memory_.motion);
  if (sees_through) {
    reserve<RayRecord>(pixels_, "further rays", memory_.further_rays);
    reserve<HitRecord>(pixels_, "further hits", memory_.further_hits);
  }
  add("motion", [this, sees_through](Recorder& to) {
    FrameMemory& m = memory_;
    if (sees_through) {
      const MotionRaysArguments drawn = {world_.scene().address(),
                                         {m.rays.address()},
                                         {m.hits.address()},
                                         {m.further_rays.address()},
                                         {m.further_ray_count.address()},
                                         pixels_,
                                         0u};
      to.run(kernels_.motion_rays, drawn, pixels_);
      to.barrier();
      world_.tracer().closest_hits(to, {{m.further_rays.address()}, pixels_},
                                   {m.further_hits.address()});
      to.barrier();
    }
    const std::uint64_t first = first_traced_pixel();
    const MotionArguments found = {world_.scene().address(),
                                   {m.scene_before.address()},
                                   {m.rays.address()},
                                   {m.hits.address()},
                                   {m.further_rays.address()},
                                   {m.further_hits.address()},
                                   {m.motion.address()},
                                   {m.picture_motion.address() + first * sizeof(PixelMotion)},
                                   pixels_,
                                   sample_ == 0 ? 1u : 0u,
                                   sees_through ? 1u : 0u,
                                   0u};
    to.run(kernels_.motion, found, pixels_);
  });
}

void FramePassesVulkan::antialias() {
  memory_.antialiasing.reserve(request_->sequence->frame());
  add("taa", [this](Recorder& to) {
    constexpr std::uint32_t kStride = sizeof(PixelLayers) / sizeof(float);
    static_assert(sizeof(PixelLayers) % sizeof(float) == 0 && offsetof(PixelLayers, all) == 0);
    memory_.antialiasing.record(to, request_->sequence->frame(), {memory_.layers.address()},
                                kStride, {memory_.picture_motion.address()});
  });
}

/// Counts the rays that went on, and reads the motion back where it was requested.
void FramePassesVulkan::finish_motion(LayeredImage& image) {
  uint further_rays = 0;
  vulkan::read(device_, memory_.further_ray_count, std::span(&further_rays, 1));
  frame_->rays += further_rays;
  if (!request_->settings.motion) return;
  std::vector<PixelMotion> motion(static_cast<std::size_t>(image.width) * image.height);
  const ShownPixels shown = shown_pixels(traced_rows(*request_), request_->settings);
  vulkan::read(device_, memory_.picture_motion, std::span(motion), shown.first);
  image.layers.push_back(motion_layer(image.width, image.height, motion));
}

}  // namespace lambent
