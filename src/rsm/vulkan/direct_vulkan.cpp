// SPDX-License-Identifier: Apache-2.0
#include "rsm/vulkan/direct_vulkan.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "raytracing/camera_rays.h"
#include "rsm/deinterleave.h"
#include "shaders/rsm_direct_blur_comp.h"
#include "shaders/rsm_direct_rays_comp.h"
#include "shaders/rsm_direct_sent_comp.h"
#include "shaders/rsm_direct_sum_comp.h"
#include "shaders/rsm_direct_upsample_comp.h"

namespace lambent {
namespace {

// Most rays in memory at once, unless the rays of a band's pixels to one light are more.
constexpr std::uint32_t kMaxRays = 1u << 20;

vulkan::Kernel make_direct_kernel(const vulkan::Device& device, vulkan::Spirv spirv,
                                  const char* name, int sub_images) {
  const vulkan::Constant constant = {kSubImagesConstant, static_cast<std::uint32_t>(sub_images)};
  return {device, spirv, name, {&constant, 1}};
}

/// Kernels that all views need, owned by the device (Device::kept).
class AllKernels {
 public:
  explicit AllKernels(const vulkan::Device& device)
      : blur(device, shaders::rsm_direct_blur_comp(), "rsm.direct_blur"),
        upsample(device, shaders::rsm_direct_upsample_comp(), "rsm.direct_upsample"),
        device_(device) {}

  /// Compiles the kernels at the first call for a number of sub-images.
  const RsmDirectKernels& of(int sub_images) {
    const std::lock_guard lock(compiling_);
    return compiled_.try_emplace(sub_images, device_, sub_images).first->second;
  }

  vulkan::Kernel blur, upsample;

 private:
  const vulkan::Device& device_;
  std::mutex compiling_;
  std::map<int, RsmDirectKernels> compiled_;
};

}  // namespace

RsmDirectKernels::RsmDirectKernels(const vulkan::Device& device, int sub_images)
    : rays(make_direct_kernel(device, shaders::rsm_direct_rays_comp(), "rsm.direct_rays",
                              sub_images)),
      sent(make_direct_kernel(device, shaders::rsm_direct_sent_comp(), "rsm.direct_sent",
                              sub_images)),
      sum(make_direct_kernel(device, shaders::rsm_direct_sum_comp(), "rsm.direct_sum",
                             sub_images)) {}

RsmDirectVulkan::RsmDirectVulkan(const vulkan::Device& device) : device_(device) {}

const RsmDirectKernels& RsmDirectVulkan::kernels() {
  return device_.kept<AllKernels>().of(settings_.sub_images);
}

void RsmDirectVulkan::start(std::size_t lights, const RsmSettings& settings, int width,
                            int height) {
  settings_ = settings;
  width_ = width;
  height_ = height;
  lights_ = deal_direct_lights(lights, settings);
  dealt_.reserve(device_, lights_.dealt.size() * sizeof(AssignedLight), "rsm.dealt_lights");
  vulkan::write(device_, std::span<const AssignedLight>(lights_.dealt), dealt_);
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  const std::size_t shared = lights_.shared() ? pixels : 0;
  const std::size_t blurred = share_period(lights_, settings) > 1 ? shared : 0;
  direct_.reserve(device_, pixels * sizeof(ReflectedPair), "rsm.direct");
  brightest_.reserve(device_, shared * sizeof(ReflectedPair), "rsm.brightest");
  brightest_light_.reserve(device_, shared * sizeof(std::uint32_t), "rsm.brightest_lights");
  shares_.reserve(device_, shared * sizeof(LightShare), "rsm.light_shares");
  blurred_.reserve(device_, blurred * sizeof(LightShare), "rsm.blurred_shares");
  ray_count_.reserve(device_, sizeof(std::uint32_t), "rsm.direct_ray_count");
  device_.run([&](vulkan::Recorder& to) {
    to.fill(ray_count_, 0u);
    to.fill(direct_, 0u);
  });
}

RsmDirectVulkan::Groups RsmDirectVulkan::groups(int rows) const {
  // Rows of sub-images take turns along x, in groups as wide as the kernels'
  constexpr int kGroup = 64;
  const int p = settings_.sub_images;
  const int across = (sub_image_size(width_, 0, p) + kGroup - 1) / kGroup;
  return {static_cast<std::uint32_t>(across * p * p * kGroup),
          static_cast<std::uint32_t>(sub_image_size(rows, 0, p))};
}

int RsmDirectVulkan::slots_at_once(int rows) const {
  const auto most = static_cast<int>(kMaxRays / groups(rows).invocations());
  return std::clamp(most, 1, std::max(1, static_cast<int>(lights_.per_sub_map)));
}

int RsmDirectVulkan::rows_of_a_band(std::uint32_t pixels) const {
  const int p = settings_.sub_images;
  const int rows = static_cast<int>(pixels) / (width_ * p) * p;
  return std::clamp(rows, p, (height_ + p - 1) / p * p);
}

void RsmDirectVulkan::reserve_band(int rows) {
  const std::size_t rays =
      static_cast<std::size_t>(groups(rows).invocations()) * slots_at_once(rows);
  shadow_rays_.reserve(device_, rays * sizeof(RayRecord), "rsm.direct_rays");
  pairs_.reserve(device_, rays * sizeof(ReflectedPair), "rsm.direct_pairs");
  arrived_.reserve(device_, rays * sizeof(vec3), "rsm.direct_arrived");
}

void RsmDirectVulkan::record_sum(vulkan::Recorder& recorder, const DeviceStage& stage,
                                 int first_row, int rows, int first_slot, int slots,
                                 const vulkan::Buffer& target, bool is_share) {
  const Groups groups = this->groups(rows);
  const bool dims = stage.tracer.dims_shadows();
  recorder.barrier();
  RayBatch batch;
  batch.rays = {shadow_rays_.address()};
  batch.count = groups.invocations() * static_cast<std::uint32_t>(slots);
  if (dims) {
    stage.tracer.transmittances(recorder, batch, {}, {arrived_.address()});
  } else {
    stage.tracer.occlusions(recorder, batch, {arrived_.address()});
  }
  recorder.barrier();
  const DirectSumArguments summed = {{pairs_.address()},
                                     {arrived_.address()},
                                     {arrived_.address()},
                                     {target.address()},
                                     {shares_.address()},
                                     width_,
                                     first_row,
                                     rows,
                                     slots,
                                     first_slot == 0 ? 1u : 0u,
                                     is_share ? 1u : 0u,
                                     dims ? 1u : 0u,
                                     0};
  recorder.run(kernels().sum, summed, groups.width, groups.height);
  recorder.barrier();
}

void RsmDirectVulkan::record_band(vulkan::Recorder& recorder, const DeviceStage& stage,
                                  const DevicePixels& pixels, int first_row, int rows) {
  const Groups groups = this->groups(rows);
  const int per_sub_map = static_cast<int>(lights_.per_sub_map);
  const bool shared = lights_.shared();
  DirectRaysArguments asked = {stage.scene.address(),
                               pixels.points,
                               pixels.surfaces,
                               {shadow_rays_.address()},
                               {pairs_.address()},
                               {ray_count_.address()},
                               stage.media.records,
                               {dealt_.address()},
                               {direct_.address()},
                               {brightest_light_.address()},
                               width_,
                               first_row,
                               rows,
                               settings_.sub_maps,
                               per_sub_map,
                               0,
                               0,
                               static_cast<int>(lights_.lights),
                               stage.media.count,
                               shared ? 1u : 0u};
  if (shared) {
    recorder.run(kernels().sent, asked, groups.width, groups.height);
    record_sum(recorder, stage, first_row, rows, 0, 1, brightest_, false);
  }
  const int at_once = slots_at_once(rows);
  for (int first = 0; first < per_sub_map; first += at_once) {
    asked.first_slot = first;
    asked.slots = std::min(at_once, per_sub_map - first);
    recorder.run(kernels().rays, asked, groups.width, groups.height);
    record_sum(recorder, stage, first_row, rows, first, asked.slots, direct_, shared);
  }
}

void RsmDirectVulkan::record_finish(vulkan::Recorder& recorder, const RsmViewOnDevice& view) {
  if (!lights_.shared()) return;
  const int period = share_period(lights_, settings_);
  const vulkan::Kernel& blur = device_.kept<AllKernels>().blur;
  const auto width = static_cast<std::uint32_t>(width_);
  const auto height = static_cast<std::uint32_t>(height_);
  DirectBlurArguments arguments = {view.arrays,
                                   {shares_.address()},
                                   {blurred_.address()},
                                   {brightest_.address()},
                                   {direct_.address()},
                                   width_,
                                   height_,
                                   period,
                                   1.0f / settings_.plane_tolerance,
                                   0,
                                   0};
  if (period > 1) {
    recorder.run(blur, arguments, width, height);
    recorder.barrier();
    arguments.shares = {blurred_.address()};
  }
  arguments.is_last = 1;
  recorder.run(blur, arguments, width, height);
  recorder.barrier();
}

std::uint64_t RsmDirectVulkan::rays() const {
  std::uint32_t rays = 0;
  vulkan::read(device_, ray_count_, std::span(&rays, 1));
  return rays;
}

void RsmDirectVulkan::record_upsampling(vulkan::Recorder& recorder, const RsmViewOnDevice& view,
                                        const DevicePixels& pixels, const Camera& camera, int width,
                                        int first_row, std::uint32_t count,
                                        const DeviceReflectedLight& light) const {
  const CameraRecord record = camera_record(camera, 1, 1);
  const DirectUpsampleArguments arguments = {view.arrays,
                                             {direct_.address()},
                                             pixels.points,
                                             pixels.surfaces,
                                             light.diffuse,
                                             light.specular,
                                             view.width,
                                             view.height,
                                             width,
                                             first_row,
                                             count,
                                             1.0f / static_cast<float>(settings_.downscale),
                                             settings_.plane_tolerance,
                                             record.position_ws,
                                             normalize(record.axes[2])};
  recorder.run(device_.kept<AllKernels>().upsample, arguments, count);
}

}  // namespace lambent
