// SPDX-License-Identifier: Apache-2.0
// The gather on a Vulkan device: compute kernels over buffers.
#pragma once

#include <cstddef>
#include <span>

#include "lambent/rsm.h"
#include "rsm/maps/lights.h"
#include "rsm/vulkan/maps_vulkan.h"
#include "rsm/vulkan/passes_vulkan.h"
#include "vulkan/device.h"

namespace lambent {

/// Gathers the light of maps on a device. Keeps its buffers from frame to frame: 44 bytes a pixel
/// (12 without blurs), and 40 for each ray for visibility.
class RsmGathererVulkan {
 public:
  /// The device must outlive it.
  explicit RsmGathererVulkan(const vulkan::Device& device);

  /// Uploads the texels that RsmPattern::whole gathers. Waits for the copy.
  void set_lights(const RsmLights& lights, const RsmSettings& settings);
  /// Uploads maps for RsmPattern::disk. Waits for the copy.
  void set_maps(std::span<const ReflectiveShadowMap> maps, const RsmSettings& settings);
  /// The same for maps that are on the device already; they must stay there.
  void set_maps(const RsmMapsOnDevice& maps, const RsmSettings& settings);

  /// Records all passes, with a barrier after each. set_lights() or set_maps() must have been
  /// called with the same settings, which must be in range. `tracer` is used for visibility alone,
  /// and may be null without it. The view and this object must outlive the execution, which must
  /// have ended before the next call.
  void record(vulkan::Recorder& recorder, const RsmViewOnDevice& view, const RsmSettings& settings,
              const DeviceTracer* tracer = nullptr, bool keep_stages = false);

  /// Records the upsampling of the last view's light, which must have had these settings, to
  /// surfaces of a larger frame, or of its rows from `first_row` on, and a barrier. Where the depth
  /// of a surface is 0, `irradiance` becomes 0.
  void record_upsampling(vulkan::Recorder& recorder, const RsmViewOnDevice& small,
                         const RsmSettings& settings, const RsmViewOnDevice& frame, int first_row,
                         Vec3Array irradiance) const;

  /// Irradiance of the last view recorded: width * height vec3, rows from the top [W/m^2]. The
  /// buffer may be larger.
  const vulkan::Buffer& irradiance() const { return picture_.picture; }

  /// Gathers the light of maps that `mapper` rendered or prepared, and leaves it on the device;
  /// fills in the result's times, rays and stages. Waits for the device.
  void light(RsmMapperVulkan& mapper, const RsmMapsOnDevice& maps, const RsmViewOnDevice& view,
             const RsmSettings& settings, const DeviceWorld& world, RsmIrradiance& result,
             bool keep_stages = false);

  /// Does all steps, as RsmGatherer does: uploads everything, and reads the light back. `textures`:
  /// those that the tracer needs.
  void gather(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
              const RsmSettings& settings, RsmIrradiance& result,
              const DeviceTracer* tracer = nullptr, VkDescriptorSet textures = VK_NULL_HANDLE,
              bool keep_stages = false);

 private:
  struct DiskSource;
  void set_disks(std::span<const DiskSource> sources, const RsmSettings& settings);
  void run(const RsmViewOnDevice& view, const RsmSettings& settings, const DeviceTracer* tracer,
           VkDescriptorSet textures, bool keep_stages, RsmIrradiance& result);
  void reserve_picture(int width, int height, const RsmSettings& settings, bool keep_stages);

  const vulkan::Device& device_;
  RsmGatherKernels& kernels_;
  RsmTexelsOnDevice texels_;
  vulkan::Buffer uploaded_maps_;
  RsmPictureOnDevice picture_;
};

}  // namespace lambent
