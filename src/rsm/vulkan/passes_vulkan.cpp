// SPDX-License-Identifier: Apache-2.0
#include "rsm/vulkan/passes_vulkan.h"

#include <algorithm>
#include <cassert>

#include "raytracing/raytracer.h"
#include "rsm/deinterleave.h"
#include "rsm/passes.h"
#include "shaders/rsm_arrivals_comp.h"
#include "shaders/rsm_blur_comp.h"
#include "shaders/rsm_gather_comp.h"
#include "shaders/rsm_gather_disk_comp.h"
#include "shaders/rsm_gather_mixed_comp.h"
#include "shaders/rsm_visibility_rays_comp.h"

namespace lambent {
namespace {

// Specialisation constant of src/rsm/shaders/.
constexpr std::uint32_t kRelitConstant = 1;

// Size of the gathers' workgroups; see src/rsm/shaders/gather_pixel.glsl.
constexpr int kGatherTileWidth = 32, kGatherTileHeight = 8;

vulkan::Kernel make_kernel(const vulkan::Device& device, vulkan::Spirv spirv, const char* name,
                           int sub_images, bool relit = false) {
  const vulkan::Constant constants[] = {
      {kSubImagesConstant, static_cast<std::uint32_t>(sub_images)},
      {kRelitConstant, relit ? 1u : 0u}};
  return {device, spirv, name, constants};
}

int groups(int size, int group) {
  return (size + group - 1) / group;
}

/// Number of rays of a row of tiles.
std::size_t rays_of_row(int width, const RsmSettings& settings) {
  const int p = mosaic_sub_images(settings);
  const auto tiles =
      static_cast<std::size_t>(groups(sub_image_size(width, 0, p), kGatherTileWidth)) * p * p;
  return tiles * kGatherTileWidth * kGatherTileHeight * settings.visibility_rays;
}

int tile_rows(int height, const RsmSettings& settings) {
  return groups(sub_image_size(height, 0, mosaic_sub_images(settings)), kGatherTileHeight);
}

int tile_rows_at_a_time(int width, int height, const RsmSettings& settings) {
  const auto most = static_cast<int>(kMaxVisibilityRays / rays_of_row(width, settings));
  return std::clamp(most, 1, tile_rows(height, settings));
}

}  // namespace

RsmKernels::RsmKernels(const vulkan::Device& device, int sub_images)
    : gather(make_kernel(device, shaders::rsm_gather_comp(), "rsm.gather", sub_images)),
      gather_mixed(
          make_kernel(device, shaders::rsm_gather_mixed_comp(), "rsm.gather_mixed", sub_images)),
      gather_disk(
          make_kernel(device, shaders::rsm_gather_disk_comp(), "rsm.gather_disk", sub_images)),
      visibility_rays(make_kernel(device, shaders::rsm_visibility_rays_comp(),
                                  "rsm.visibility_rays", sub_images)),
      arrivals(make_kernel(device, shaders::rsm_arrivals_comp(), "rsm.arrivals", sub_images)),
      blur(make_kernel(device, shaders::rsm_blur_comp(), "rsm.blur", sub_images)),
      blur_relit(
          make_kernel(device, shaders::rsm_blur_comp(), "rsm.blur_relit", sub_images, true)) {}

int mosaic_sub_images(const RsmSettings& settings) {
  return settings.layout == RsmLayout::restructured ? settings.sub_images : 1;
}

std::size_t visibility_rays_at_a_time(int width, int height, const RsmSettings& settings) {
  if (settings.visibility_rays == 0) return 0;
  return rays_of_row(width, settings) * tile_rows_at_a_time(width, height, settings);
}

RsmPassesOnDevice::RsmPassesOnDevice(vulkan::Recorder& recorder, const RsmKernels& kernels,
                                     const RsmTexelsOnDevice& texels,
                                     const RsmPictureOnDevice& picture, const RsmViewOnDevice& view,
                                     const RsmSettings& settings, const DeviceTracer* tracer)
    : recorder_(recorder),
      kernels_(kernels),
      texels_(texels),
      picture_(picture),
      view_(view),
      settings_(settings),
      tracer_(tracer),
      light_(&picture.light),
      blurred_(&picture.blurred) {}

RsmPassesOnDevice::Tiles RsmPassesOnDevice::tiles_of(const vulkan::Kernel& kernel,
                                                     int units) const {
  // Tiles of sub-images take turns along x
  const auto tile_width = static_cast<int>(kernel.group_size(0));
  const int across = groups(sub_image_size(view_.width, 0, units), tile_width);
  return {static_cast<std::uint32_t>(across * units * units * tile_width),
          static_cast<std::uint32_t>(sub_image_size(view_.height, 0, units))};
}

GatherTarget RsmPassesOnDevice::target() const {
  return {{{picture_.points.address()}, {picture_.normals.address()}},
          {light_->address()},
          {picture_.picture.address()},
          {picture_.arrived.address()}};
}

std::uint32_t RsmPassesOnDevice::flags() const {
  std::uint32_t flags = 0;
  if (blurs(settings_)) flags |= kGatherBlurred;
  if (settings_.layout == RsmLayout::full) flags |= kGatherRendered;
  if (settings_.visibility_rays > 0 && texels_.count > 0) flags |= kGatherDimmed;
  return flags;
}

void RsmPassesOnDevice::gather() {
  if (settings_.pattern == RsmPattern::disk) {
    gather_disks();
  } else {
    if ((flags() & kGatherDimmed) != 0) ask_visibility();
    gather_whole();
  }
  recorder_.barrier();
}

void RsmPassesOnDevice::gather_whole() {
  const int p = mosaic_sub_images(settings_);
  const bool rendered = settings_.layout == RsmLayout::full;
  // Where the picture is not restructured, neighbouring pixels use different sub-maps
  const bool mixed = p == 1 && settings_.sub_maps > 1;
  const vulkan::Kernel& kernel = mixed ? kernels_.gather_mixed : kernels_.gather;
  const vulkan::Buffer& texels = rendered ? texels_.rendered : texels_.restructured;
  const RsmGatherArguments arguments = {view_.arrays,
                                        target(),
                                        {texels.address()},
                                        {texels_.places.address()},
                                        view_.width,
                                        view_.height,
                                        settings_.sub_maps,
                                        texels_.count,
                                        flags(),
                                        0};
  const Tiles tiles = tiles_of(kernel, p);
  const int taller = mixed ? 1 : kGatherPixels;
  const int rows = groups(static_cast<int>(tiles.height), kGatherTileHeight * taller);
  recorder_.run(kernel, arguments, tiles.width,
                static_cast<std::uint32_t>(rows * kGatherTileHeight));
}

void RsmPassesOnDevice::gather_disks() {
  const DiskArguments arguments = {view_.arrays,
                                   target(),
                                   {texels_.maps.address()},
                                   texels_.map_count,
                                   view_.width,
                                   view_.height,
                                   settings_.sub_maps,
                                   texels_.samples_per_sub_map,
                                   flags(),
                                   settings_.softening,
                                   0};
  const Tiles tiles = tiles_of(kernels_.gather_disk, mosaic_sub_images(settings_));
  recorder_.run(kernels_.gather_disk, arguments, tiles.width, tiles.height);
}

void RsmPassesOnDevice::ask_visibility() {
  assert(tracer_ != nullptr);
  recorder_.fill(picture_.ray_count, 0u);
  recorder_.barrier();
  const Tiles tiles = tiles_of(kernels_.visibility_rays, mosaic_sub_images(settings_));
  const int rows = tile_rows(view_.height, settings_);
  const int at_a_time = tile_rows_at_a_time(view_.width, view_.height, settings_);
  for (int row = 0; row < rows; row += at_a_time) {
    const int count = std::min(at_a_time, rows - row);
    const VisibilityArguments arguments = {view_.arrays,
                                           {texels_.restructured.address()},
                                           {picture_.rays.address()},
                                           {picture_.occluded.address()},
                                           {picture_.arrived.address()},
                                           {picture_.ray_count.address()},
                                           view_.width,
                                           view_.height,
                                           settings_.sub_maps,
                                           texels_.count,
                                           row,
                                           settings_.visibility_rays,
                                           kRayMeetsAll,
                                           settings_.seed};
    const auto height = static_cast<std::uint32_t>(count * kGatherTileHeight);
    recorder_.run(kernels_.visibility_rays, arguments, tiles.width, height);
    recorder_.barrier();
    RayBatch batch;
    batch.rays = {picture_.rays.address()};
    batch.count = static_cast<std::uint32_t>(rays_of_row(view_.width, settings_) * count);
    tracer_->occlusions(recorder_, batch, {picture_.occluded.address()});
    recorder_.barrier();
    recorder_.run(kernels_.arrivals, arguments, tiles.width, height);
    recorder_.barrier();
  }
}

void RsmPassesOnDevice::blur(std::span<const BlurTap> taps, int unit,
                             const vulkan::Buffer* relit_into) {
  assert(taps.size() <= kMaxBlurTaps);
  BlurArguments arguments = {{{picture_.points.address()}, {picture_.normals.address()}},
                             {light_->address()},
                             {blurred_->address()},
                             {relit_into != nullptr ? relit_into->address() : 0},
                             view_.width,
                             view_.height,
                             unit,
                             0,
                             1.0f / settings_.plane_tolerance,
                             static_cast<int>(taps.size()),
                             {},
                             {}};
  for (std::size_t k = 0; k < taps.size(); ++k) {
    assert(taps[k].distance <= kMaxBlurReach);
    arguments.reach = std::max(arguments.reach, taps[k].distance);
    arguments.distances[k] = taps[k].distance;
    arguments.weights[k] = taps[k].weight;
  }
  const vulkan::Kernel& kernel = relit_into != nullptr ? kernels_.blur_relit : kernels_.blur;
  const Tiles tiles = tiles_of(kernel, unit);
  recorder_.run(kernel, arguments, tiles.width, tiles.height);
  recorder_.barrier();
}

void RsmPassesOnDevice::blur_sub_images(std::span<const BlurTap> taps) {
  blur(taps, settings_.sub_images, nullptr);
  std::swap(light_, blurred_);
}

void RsmPassesOnDevice::interleave(std::span<const BlurTap> taps) {
  // Light that is not blurred was gathered into the picture
  if (blurs(settings_)) blur(taps, 1, &picture_.picture);
}

void RsmPassesOnDevice::keep(RsmStage stage) {
  if (stage == RsmStage::blurred) return;
  const vulkan::Buffer& into = picture_.stages[static_cast<int>(stage)];
  if (blurs(settings_)) return blur({}, 1, &into);
  recorder_.copy(picture_.picture, into,
                 sizeof(vec3) * static_cast<std::size_t>(view_.width) * view_.height);
  recorder_.barrier();
}

}  // namespace lambent
