// SPDX-License-Identifier: Apache-2.0
#include "lambent/memory_check.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/memory.h"
#include "lambent/denoise.h"
#include "lambent/quality.h"
#include "lambent/render_output.h"
#include "temporal/taa_records.h"

namespace lambent::cli {
namespace {

// Bytes per pixel of a layer of three floats, and of all layers of a frame.
constexpr std::uint64_t kLayerBytes = 3 * sizeof(float);
constexpr std::uint64_t kFrameBytes = 10 * kLayerBytes + sizeof(float);
// Motion: a record of five words per pixel, and a layer of two.
constexpr std::uint64_t kMotionBytes = (5 + 2) * sizeof(float);
// Temporal anti-aliasing: another record of motion, and a record of this frame and of the one
// before.
constexpr std::uint64_t kTaaBytes = sizeof(PixelMotion) + 2 * sizeof(TaaPixel);
static_assert(kTaaBytes == 108, "FrameSettings::temporal_antialiasing says how much it is");
// By which further samples of a pixel are chosen: sums of its samples, flags, and scratch memory.
constexpr std::uint64_t kNoiseBytes = 21;
// A picture that is written or compared, in addition to the frame: its display-encoded form, and a
// copy.
constexpr std::uint64_t kWritingBytes = 2 * kLayerBytes;
// The path tracer's sums of its eight layers and their squares in doubles, and its own layers.
constexpr std::uint64_t kReferenceBytes = 18 * 3 * sizeof(double) + 11 * kLayerBytes + 4;
// Data of a pixel's samples for filters, and memory of the filters themselves. Glass and clearcoats
// need more; whether a scene has them is not known here.
constexpr std::uint64_t kGlassBytes = 14 * kLayerBytes + 9 * sizeof(float);
constexpr std::uint64_t kClearcoatBytes = 5 * kLayerBytes + 2 * sizeof(float);
constexpr std::uint64_t kFilterBytes =
    20 * kLayerBytes + 9 * sizeof(float) + 128 + kGlassBytes + kClearcoatBytes;
// Light that is averaged over frames, of the frame before and of this one: of surfaces, coats,
// clearcoats, and highlights, which have no excess; and two variances of this frame.
constexpr std::uint64_t kHistoryBytes = (2 * (23 + 15 + 15 + 12) + 2) * sizeof(float);
// A pixel that is lit by reflective shadow maps: position, normal and depth, planes of the guide
// and of two lights, the interleaved picture, and the gathered light.
constexpr std::uint64_t kRsmBytes = (7 + 7 + 2 * 3 + 3 + 3) * sizeof(float);
// With RsmSettings::direct, its direct light; with fewer direct_lights than all, the brightest
// light's, and of the others the arriving and the unoccluded light, before and after a blur.
constexpr std::uint64_t kRsmDirectBytes = 2 * kLayerBytes;
constexpr std::uint64_t kRsmShareBytes = 6 * kLayerBytes;
// With layers, each of five stages is a layer of the frame.
constexpr std::uint64_t kRsmStageBytes = 5 * kLayerBytes;
// Two images of three channels being compared: matched, clipped, filtered for SSIM and FLIP
// (measured).
constexpr std::uint64_t kComparisonBytes = 180;
// A froxel of fog: lit, smoothed, and averaged over frames.
constexpr std::uint64_t kFroxelBytes = 3 * 4 * sizeof(float);
// Memory that does not depend on the size [bytes]: bands, maps, the guide of gathering rays (60
// MB), buffers of files, and heaps of threads.
constexpr std::uint64_t kFixedBytes = std::uint64_t{160} << 20;
// Least number of rays per probe.
constexpr std::uint64_t kMinRays = 16;

std::uint64_t bytes_a_pixel(const RenderOptions& options) {
  std::uint64_t bytes = kWritingBytes;
  if (options.method == "reference" || options.verify_samples > 0) bytes += kReferenceBytes;
  if (options.method != "reference") bytes += kFrameBytes;
  if (is_filtered(options)) bytes += kFilterBytes;
  if (options.frames > 0 && is_filtered(options)) bytes += kHistoryBytes;
  if (keeps_motion(options)) bytes += kMotionBytes;
  if (uses_taa(options)) bytes += kTaaBytes;
  if (!options.scene.fog.empty() && options.method != "reference") {
    const FogSettings fog = frame_settings(options, glm::ivec2(1)).fog;
    bytes += kFroxelBytes * static_cast<std::uint64_t>(fog.slices) /
             static_cast<std::uint64_t>(fog.froxel_pixels * fog.froxel_pixels);
  }
  if (uses_rsm(options.method)) {
    const RsmSettings& rsm = options.rsm.settings;
    const auto scale = static_cast<std::uint64_t>(rsm.downscale);
    const std::uint64_t of_view = kRsmBytes + (rsm.direct ? kRsmDirectBytes : 0) +
                                  (rsm.direct_lights > 0 ? kRsmShareBytes : 0);
    bytes += of_view / (scale * scale) + (options.layers ? kRsmStageBytes : 0);
  }
  return bytes;
}

/// Of a pixel of a picture that is rendered whole, for further samples.
std::uint64_t noise_bytes(const RenderOptions& options) {
  if (options.method == "reference") return 0;
  const FrameSettings frame = frame_settings(options, glm::ivec2(1));
  if (frame.most_samples == 0) return 0;
  return kNoiseBytes + static_cast<std::uint64_t>(frame.samples) * sizeof(float);
}

std::string need(std::uint64_t bytes, std::uint64_t available) {
  return "needs about " + bytes_text(bytes) + " of memory, and " + bytes_text(available) +
         " are available";
}

}  // namespace

std::uint64_t picture_bytes(const RenderOptions& options, const glm::ivec2& size) {
  if (!made_in_bands(options, size)) {
    return kFixedBytes + pixels_of(size) * (bytes_a_pixel(options) + noise_bytes(options));
  }
  const auto width = static_cast<std::uint64_t>(size.x);
  const auto rows = static_cast<std::uint64_t>(rows_of_a_band(options, size));
  std::uint64_t band = rows * width * bytes_a_pixel(options);
  if (is_filtered(options)) {
    // Rows above and below the band; twice as many for rough glass, whose light is filtered after
    // the surfaces behind it
    band += 2 * 2 * static_cast<std::uint64_t>(denoise_reach({})) * width * kFilterBytes;
  }
  return kFixedBytes + band + (keeps_all_rows(options, size) ? pixels_of(size) * kLayerBytes : 0);
}

glm::ivec2 size_that_fits(const RenderOptions& options, const glm::ivec2& size,
                          std::uint64_t bytes) {
  constexpr double kStep = 0.98;  // reaches a picture of one pixel in under 500 steps
  glm::dvec2 fitting(size);
  glm::ivec2 rounded = size;
  while (picture_bytes(options, rounded) > bytes && (rounded.x > 1 || rounded.y > 1)) {
    fitting *= kStep;
    rounded = glm::max(glm::ivec2(fitting), glm::ivec2(1));
  }
  return rounded;
}

Expected<void> check_picture_memory(const RenderOptions& options, const glm::ivec2& size,
                                    std::uint64_t available) {
  const std::uint64_t bytes = picture_bytes(options, size);
  if (bytes <= available) return {};
  const glm::ivec2 fits = size_that_fits(options, size, available);
  const std::string text = std::to_string(size.x) + "x" + std::to_string(size.y);
  std::string cause = text + " with --method " + options.method + " " + need(bytes, available);
  if (picture_bytes(options, fits) <= available) {
    cause += "; " + std::to_string(fits.x) + "x" + std::to_string(fits.y) + " would fit";
  }
  return fail("--size", "", cause, Error::Kind::failed);
}

Expected<void> check_field_memory(const FieldMemory& field, int rays_per_probe, int fields,
                                  std::uint64_t available) {
  const auto count = static_cast<std::uint64_t>(fields);
  const std::uint64_t bytes = kFixedBytes + count * field.bytes(rays_per_probe);
  if (bytes <= available) return {};
  const std::uint64_t each = (available - std::min(available, kFixedBytes)) / count;
  const std::uint64_t fitting_probes =
      each /
      (field.bytes_per_probe + field.bytes_per_ray * static_cast<std::uint64_t>(rays_per_probe));
  const std::uint64_t of_probe = each / field.probes;
  const std::uint64_t fitting_rays = of_probe > field.bytes_per_probe
                                         ? (of_probe - field.bytes_per_probe) / field.bytes_per_ray
                                         : 0;
  std::string cause = std::to_string(field.probes) + " probes of " +
                      std::to_string(rays_per_probe) + " rays: " + need(bytes, available) + "; ";
  if (fitting_rays >= kMinRays) cause += "--rays " + std::to_string(fitting_rays) + ", or ";
  cause += std::to_string(fitting_probes) + " probes would fit";
  return fail("the field", "", cause, Error::Kind::failed);
}

Expected<void> check_shared_field_memory(const FieldMemory& field, int rays_per_probe,
                                         const FieldRanks& ranks, std::uint64_t available) {
  const std::uint64_t bytes = static_cast<std::uint64_t>(ranks.on_this_machine) *
                              (kFixedBytes + field.bytes_of_rank(rays_per_probe, ranks.all));
  if (bytes <= available) return {};
  return fail("the field", "",
              std::to_string(field.probes) + " probes of " + std::to_string(rays_per_probe) +
                  " rays, " + std::to_string(ranks.on_this_machine) + " of " +
                  std::to_string(ranks.all) + " ranks on this machine: " + need(bytes, available) +
                  "; more machines, fewer probes or --rays would help",
              Error::Kind::failed);
}

Expected<void> check_comparison_memory(const glm::ivec2& size, std::uint64_t available) {
  const std::uint64_t bytes = pixels_of(size) * kComparisonBytes;
  if (bytes <= available) return {};
  return fail("compare", "",
              std::to_string(size.x) + "x" + std::to_string(size.y) +
                  " pixels: " + need(bytes, available) + "; " +
                  std::to_string(available / kComparisonBytes) + " pixels would fit",
              Error::Kind::failed);
}

int host_rays(const FieldSettings& settings, const World& world) {
  return world.device() == nullptr ? settings.rays_per_probe : 0;
}

Expected<IrradianceField> make_field(const FieldSettings& settings, const FieldOptions& options,
                                     const World& world, const Camera& camera, int fields,
                                     const FieldRanks& ranks) {
  const Bounds bounds = open_bounds(world, glm::vec3(camera.world_from_view[3]));
  const Expected<FieldMemory> memory = planned_memory(settings, bounds);
  if (!memory) return tl::unexpected(in_options(memory.error(), options));
  const int rays = host_rays(settings, world);
  const auto fits = ranks.all == 1
                        ? check_field_memory(*memory, rays, fields, available_memory())
                        : check_shared_field_memory(*memory, rays, ranks, available_memory());
  if (!fits) return tl::unexpected(fits.error());
  Expected<IrradianceField> field = IrradianceField::make(settings, bounds);
  if (!field) return tl::unexpected(in_options(std::move(field.error()), options));
  return field;
}

}  // namespace lambent::cli
