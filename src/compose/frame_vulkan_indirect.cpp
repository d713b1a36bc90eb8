// SPDX-License-Identifier: Apache-2.0
// Indirect light of a frame on a device: looked up, and from reflective shadow maps.
#include "compose/frame_vulkan.h"
#include "compose/rsm/rsm_frame.h"
#include "field/field_access.h"
#include "field/field_backend.h"
#include "lambent/field.h"
#include "raytracing/camera_rays.h"

namespace lambent {

/// Looks up the field, on the device where the field is stored there.
void FramePassesVulkan::look_up(const char* name, const IrradianceField& field,
                                const Buffer& queries, std::uint32_t count, CorrectionUse use,
                                const Buffer& irradiance) {
  const DeviceLookups* there = device_lookups_of(field);
  if (there != nullptr && there->is_on(request_->world)) {
    add(name, [this, there, &queries, &irradiance, count, use](Recorder& to) {
      there->record_lookups(to, &request_->world, queries.address(), count, use,
                            irradiance.address());
    });
    return;
  }
  run_steps();
  std::vector<FieldQuery> asked(count);
  std::vector<vec3> answers(count);
  vulkan::read(device_, queries, std::span(asked));
  look_up_irradiance(field, asked, use, answers, request_->world);
  vulkan::write(device_, std::span<const vec3>(answers), irradiance);
}

void FramePassesVulkan::indirect() {
  const IndirectSources& sources = request_->sources;
  reserve<vec3>(pixels_, "irradiance", memory_.irradiance);
  reserve<QueryRecord>(pixels_, "queries", memory_.queries);
  const auto ask = [this](uint mirrored) {
    return [this, mirrored](Recorder& to) {
      const PixelQueriesArguments arguments = {{memory_.points.address()},
                                               {memory_.surfaces.address()},
                                               {memory_.queries.address()},
                                               pixels_,
                                               mirrored};
      to.run(kernels_.pixel_queries, arguments, pixels_);
    };
  };
  const CorrectionUse use = pixel_correction(*request_);
  add("indirect", ask(0u));
  look_up("indirect", *sources.field, memory_.queries, pixels_, use, memory_.irradiance);
  if (sources.subtracted_field == nullptr) return;
  reserve<vec3>(pixels_, "taken out", memory_.subtracted_field);
  add("indirect", ask(0u));
  look_up("indirect", *sources.subtracted_field, memory_.queries, pixels_, use,
          memory_.subtracted_field);
}

RsmViewOnDevice FramePassesVulkan::reserve_geometry(int width, int height, Buffer (&geometry)[3]) {
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  reserve<vec3>(pixels, "view positions", geometry[0]);
  reserve<vec3>(pixels, "view normals", geometry[1]);
  reserve<float>(pixels, "view depths", geometry[2]);
  return {
      width, height, {{geometry[0].address()}, {geometry[1].address()}, {geometry[2].address()}}};
}

void FramePassesVulkan::add_geometry(const char* name, const RsmViewOnDevice& view,
                                     std::uint32_t first, std::uint32_t count) {
  add(name, [this, view, first, count](Recorder& to) {
    const CameraRecord camera = camera_record(request_->camera, 1, 1);
    const ViewGeometryArguments arguments = {
        {memory_.points.address()},
        {memory_.surfaces.address()},
        {view.arrays.positions_ws.address + first * sizeof(vec3)},
        {view.arrays.normals_ws.address + first * sizeof(vec3)},
        {view.arrays.depths.address + first * sizeof(float)},
        camera.position_ws,
        normalize(camera.axes[2]),
        count,
        0u};
    to.run(kernels_.view_geometry, arguments, count);
  });
}

}  // namespace lambent
