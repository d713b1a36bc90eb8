// SPDX-License-Identifier: Apache-2.0
// The passes of a gather, recorded for a device.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>

#include "lambent/rsm.h"
#include "raytracing/vulkan/device_tracer.h"
#include "rsm/order.h"
#include "rsm/vulkan/device_passes.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// Specialisation constant of src/rsm/shaders/sub_image.glsl.
inline constexpr std::uint32_t kSubImagesConstant = 0;

/// What the camera sees, in buffers of a device that the caller owns.
struct RsmViewOnDevice {
  int width = 0, height = 0;
  DeviceView arrays;  ///< Each of width * height entries, rows from the top.
};

/// A view of the host, copied to a device.
struct UploadedRsmView {
  UploadedRsmView(const vulkan::Device& device, const RsmView& view)
      : positions(vulkan::upload(device, view.positions_ws, "rsm.positions")),
        normals(vulkan::upload(device, view.normals_ws, "rsm.view_normals")),
        depths(vulkan::upload(device, view.depths, "rsm.depths")),
        on_device{view.width,
                  view.height,
                  {{positions.address()}, {normals.address()}, {depths.address()}}} {}
  vulkan::Buffer positions, normals, depths;
  RsmViewOnDevice on_device;
};

/// Kernels that are compiled for a number of sub-images along an edge of the mosaic.
struct RsmKernels {
  RsmKernels(const vulkan::Device& device, int sub_images);
  vulkan::Kernel gather, gather_mixed, gather_disk, visibility_rays, arrivals, blur, blur_relit;
};

/// All kernels of gathers, owned by the device (Device::kept).
class RsmGatherKernels {
 public:
  explicit RsmGatherKernels(const vulkan::Device& device);

  /// Compiles the kernels at the first call for a number of sub-images.
  const RsmKernels& of(int sub_images);

  vulkan::Kernel restructure, upsample;

 private:
  const vulkan::Device& device_;
  std::mutex compiling_;
  std::map<int, RsmKernels> compiled_;
};

/// Texels that are gathered. RsmPattern::whole: those of one sub-map after the other, `count` of
/// each. Where maps are read as rendered: all texels of all maps, and the indices of the former in
/// them.
struct RsmTexelsOnDevice {
  vulkan::Buffer restructured, rendered, places;
  int count = 0;
  // RsmPattern::disk: DiskMaps, with their texels and samples
  vulkan::Buffer maps, map_texels, samples;
  int map_count = 0, samples_per_sub_map = 0;
};

/// Buffers of a picture; see GatherTarget.
struct RsmPictureOnDevice {
  vulkan::Buffer points, normals, light, blurred, arrived, picture;
  vulkan::Buffer stages[kRsmStages];  ///< RsmStage::blurred is the picture itself.
  vulkan::Buffer rays, occluded, ray_count;
};

/// Most rays for visibility in memory at a time, unless a row of tiles has more.
inline constexpr std::uint32_t kMaxVisibilityRays = 1u << 22;

/// Sub-images along an edge of the mosaic; 1: the picture is not restructured.
int mosaic_sub_images(const RsmSettings& settings);

/// Number of rays in memory at a time for a picture of this size.
std::size_t visibility_rays_at_a_time(int width, int height, const RsmSettings& settings);

/// Records each pass as it is called, and a barrier after it.
class RsmPassesOnDevice final : public RsmPasses {
 public:
  /// All arguments must outlive this object, and buffers and kernels the execution. `tracer` may be
  /// null where the settings ask for no visibility.
  RsmPassesOnDevice(vulkan::Recorder& recorder, const RsmKernels& kernels,
                    const RsmTexelsOnDevice& texels, const RsmPictureOnDevice& picture,
                    const RsmViewOnDevice& view, const RsmSettings& settings,
                    const DeviceTracer* tracer);

  void begin(const char* name) override { recorder_.begin_pass(name); }
  void end() override { recorder_.end_pass(); }
  void gather() override;
  void blur_sub_images(std::span<const BlurTap> taps) override;
  void interleave(std::span<const BlurTap> taps) override;
  void keep(RsmStage stage) override;

 private:
  struct Tiles {
    std::uint32_t width, height;
  };
  Tiles tiles_of(const vulkan::Kernel& kernel, int units) const;
  GatherTarget target() const;
  std::uint32_t flags() const;
  void gather_whole();
  void gather_disks();
  void ask_visibility();
  void blur(std::span<const BlurTap> taps, int unit, const vulkan::Buffer* relit_into);

  vulkan::Recorder& recorder_;
  const RsmKernels& kernels_;
  const RsmTexelsOnDevice& texels_;
  const RsmPictureOnDevice& picture_;
  const RsmViewOnDevice& view_;
  const RsmSettings& settings_;
  const DeviceTracer* tracer_;
  const vulkan::Buffer *light_, *blurred_;  // what passes read, and what they may write meanwhile
};

}  // namespace lambent
