// SPDX-License-Identifier: Apache-2.0
// Reflections of clearcoats on a device, in the order of clearcoat_frame.cpp.
#include <algorithm>

#include "compose/frame_vulkan.h"
#include "glossy/glossy_records.h"
#include "scene/transmission.h"

namespace lambent {
namespace {

bool has_clearcoats(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
    return has_layers(material) && material.clearcoat > 0.0f;
  });
}

}  // namespace

void FramePassesVulkan::light_clearcoats() {
  if (!has_clearcoats(request_->world.scene())) return;
  const bool traces = traces_coats(*request_);
  const Band around = traces ? rows_around_band() : band_;
  see_around_band(around);
  const auto width = static_cast<std::uint32_t>(request_->settings.width);
  const std::uint32_t all = static_cast<std::uint32_t>(around.rows) * width;
  const std::uint32_t before =
      static_cast<std::uint32_t>(band_.first_row - around.first_row) * width;
  add("glossy", [=, this](Recorder& to) {
    const ShowClearcoatsArguments shown = {
        {memory_.coat_points.address()}, {memory_.coat_surfaces.address()}, all, 0u};
    to.run(kernels_.show_clearcoats, shown, all);
  });
  const bool has_rays =
      traces && trace_coats(around, CoatKind::clearcoat, memory_.sky_in_clearcoats);
  const std::uint64_t points = memory_.coat_points.address() + before * sizeof(LitPointRecord);
  const std::uint64_t surfaces =
      memory_.coat_surfaces.address() + before * sizeof(PixelSurfaceRecord);
  look_up_coats(points, surfaces);
  // The buffers of coats, which have held the clearcoats so far, are reused
  reserve<vec4>(1, "coats", memory_.coats);
  add("glossy", [=, this](Recorder& to) {
    if (filters_clearcoats(*request_)) {
      const KeepClearcoatsArguments kept = {{points},
                                            {surfaces},
                                            {memory_.coats.address()},
                                            {memory_.coat_guides.address()},
                                            {memory_.filtered.addresses.address()},
                                            first_traced_pixel(),
                                            pixels_,
                                            has_rays ? 1u : 0u,
                                            0u};
      to.run(kernels_.keep_clearcoats, kept, pixels_);
      to.barrier();
    }
    const ClearcoatLightArguments lit = {{points},
                                         {surfaces},
                                         {memory_.coats.address()},
                                         {memory_.mirror_irradiance.address()},
                                         {memory_.specular.address()},
                                         pixels_,
                                         has_rays ? 1u : 0u};
    to.run(kernels_.clearcoat_light, lit, pixels_);
  });
  ray_light_flags_ |= kHasClearcoats;
}

}  // namespace lambent
