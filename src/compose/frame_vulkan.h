// SPDX-License-Identifier: Apache-2.0
// The passes of a frame on a Vulkan device. They are recorded as they are asked for and run
// together, in few command buffers; pixels and layers stay on the device until the frame is done.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/frame_records.h"
#include "compose/pixel_math.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/vulkan/hit_shading.h"
#include "rsm/vulkan/gather_vulkan.h"
#include "shaders/camera_rays_comp.h"
#include "shaders/compose_comp.h"
#include "shaders/gather_rays_comp.h"
#include "shaders/gather_sum_comp.h"
#include "shaders/pixel_queries_comp.h"
#include "shaders/ray_queries_comp.h"
#include "shaders/replace_light_comp.h"
#include "shaders/view_geometry_comp.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// Kernels of frames, kept by the device (Device::kept).
struct FrameKernels {
  explicit FrameKernels(const vulkan::Device& on) : device(on) {}

  const vulkan::Device& device;
  std::mutex in_use;  ///< Frames on a device take turns.
  vulkan::Kernel camera_rays{device, shaders::camera_rays_comp(), "camera rays"};
  vulkan::Kernel pixel_queries{device, shaders::pixel_queries_comp(), "pixel queries"};
  vulkan::Kernel gather_rays{device, shaders::gather_rays_comp(), "gather rays"};
  vulkan::Kernel ray_queries{device, shaders::ray_queries_comp(), "ray queries"};
  vulkan::Kernel gather_sum{device, shaders::gather_sum_comp(), "gather sum"};
  vulkan::Kernel replace_light{device, shaders::replace_light_comp(), "replace light"};
  vulkan::Kernel view_geometry{device, shaders::view_geometry_comp(), "view geometry"};
  vulkan::Kernel compose{device, shaders::compose_comp(), "compose"};
};

/// What a renderer keeps from frame to frame. Buffers grow as frames need them to.
struct FrameMemory {
  explicit FrameMemory(const vulkan::Device& device)
      : pixel_shading(device), gather_shading(device), mapper(device), rsm(device) {}

  HitShading pixel_shading, gather_shading;
  RsmMapperVulkan mapper;
  RsmGathererVulkan rsm;
  RsmMapsOnDevice maps;

  // Of a band's pixels
  vulkan::Buffer rays, hits, points, surfaces, diffuse, specular;
  vulkan::Buffer queries, irradiance, mirror_irradiance, subtracted_field, from_maps;
  // Of the rays that gather some pixels' light
  vulkan::Buffer gathering_rays, gathering_indices, gathered_hits, gathered_points, gathered,
      gathered_direct, gathered_field;
  // Positions, normals and depths of a band's pixels, and of the small picture that maps light
  vulkan::Buffer band_geometry[3], small_geometry[3];
  // Of the whole picture
  vulkan::Buffer layers;
};

class FramePassesVulkan final : public FramePasses {
 public:
  explicit FramePassesVulkan(const DeviceWorld& world);

  void begin(const FrameRequest& request, RenderedFrame& frame) override;
  void rsm() override;
  void gbuffer(const Band& band, int sample) override;
  void direct() override;
  void indirect() override;
  void glossy() override;
  void rsm_upsample() override;
  void compose(float share) override;
  void finish() override;

 private:
  using Buffer = vulkan::Buffer;
  using Recorder = vulkan::Recorder;
  using Record = std::function<void(Recorder&)>;
  struct Step {
    std::string name;
    Record record;
  };

  DeviceStage stage() const { return {world_.scene(), world_.tracer()}; }
  /// Has a pass run after those asked for before; it sees what they wrote.
  void add(const char* name, Record record);
  void run_steps();
  void reserve_pixels(std::size_t pixels);
  void trace_pixels(Recorder& to, const CameraRaysArguments& arguments);
  /// Makes room for the positions, normals and depths of a picture's pixels, ...
  RsmViewOnDevice reserve_geometry(int width, int height, Buffer (&geometry)[3]);
  /// ... and has those of `count` traced ones written from pixel `first` on.
  void add_geometry(const char* name, const RsmViewOnDevice& view, std::uint32_t first,
                    std::uint32_t count);
  /// Makes room for so many elements; memory that grew holds nothing.
  template <class T>
  void reserve(std::size_t count, const char* name, Buffer& buffer) const {
    buffer.reserve(device_, count * sizeof(T), name);
  }
  void look_up(const char* name, const IrradianceField& field, const Buffer& queries,
               std::uint32_t count, const Buffer& irradiance);
  void gather();
  void read_layers(LayeredImage& image);

  const DeviceWorld& world_;
  const vulkan::Device& device_;
  FrameKernels& kernels_;
  FrameMemory memory_;
  vulkan::Timestamps timestamps_;
  Buffer shadow_rays_[2];  // of pixels, and of what gathering rays met
  std::vector<PixelLayers> pixel_layers_;
  RsmViewOnDevice small_;  // the view that maps light

  // Of the frame that is being made
  std::unique_lock<std::mutex> turn_;
  const FrameRequest* request_ = nullptr;
  RenderedFrame* frame_ = nullptr;
  std::vector<Step> steps_;
  std::vector<Layer> stage_layers_;
  Band band_;
  std::uint32_t first_pixel_ = 0, pixels_ = 0;  // of the band
  std::uint32_t first_layer_pixel_ = 0;         // of the rendered rows
  std::uint32_t sample_ = 0;
};

}  // namespace lambent
