// SPDX-License-Identifier: Apache-2.0
#include "lambent/painter.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/metrics.h"
#include "lambent/progress_bar.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"

namespace lambent::cli {
namespace {

using Json = nlohmann::ordered_json;

// Light is called settled when an update changes the field by less than this share of it ...
constexpr double kConvergedChange = 0.002;
// ... or after so many updates.
constexpr int kMaxConvergeUpdates = 256;

// Side of the blocks whose means --verify compares [pixels]: hides the path tracer's noise, keeps
// structure.
constexpr int kVerifyBlock = 8;

// Defaults of --samples: enough for smooth edges, and for a picture in which noise is fine grain.
constexpr int kFieldSamples = 4;
constexpr int kReferenceSamples = 64;

/// Updates the field as often as asked, and books what it cost.
void update_field(const World& world, int most, bool converge, IrradianceField& field,
                  const ProgressFn& progress, Json& stats) {
  UpdateStatistics last, sum;
  int updates = 0;
  while (updates < most) {
    last = field.update(world);
    ++updates;
    sum.trace_ms += last.trace_ms;
    sum.shade_ms += last.shade_ms;
    sum.relight_ms += last.relight_ms;
    sum.blend_ms += last.blend_ms;
    sum.probe_rays += last.probe_rays;
    sum.shadow_rays += last.shadow_rays;
    if (progress) progress("field", static_cast<double>(updates) / most);
    if (converge && last.change < kConvergedChange) break;
  }
  const FieldGrid& grid = field.grid();
  stats["updates"] = updates;
  stats["probes"] = grid.probes();
  stats["probe_spacing_x_m"] = grid.spacing.x;
  stats["probe_spacing_y_m"] = grid.spacing.y;
  stats["probe_spacing_z_m"] = grid.spacing.z;
  stats["rays_per_probe"] = field.settings().rays_per_probe;
  stats["field_bytes"] = field.store_bytes();
  stats["bytes_per_probe"] = static_cast<double>(field.store_bytes()) / grid.probes();
  stats["surfel_bytes"] = field.surfel_bytes();
  stats["probe_rays"] = sum.probe_rays;
  stats["surfel_shadow_rays"] = sum.shadow_rays;
  stats["relights_last_update"] = last.relights;
  stats["relight_residual"] = last.residual;
  stats["field_change_last_update"] = last.change;
  stats["trace_ms"] = sum.trace_ms;
  stats["shade_ms"] = sum.shade_ms;
  stats["relight_ms"] = sum.relight_ms;
  stats["blend_ms"] = sum.blend_ms;
}

ReferenceSettings reference_settings(const RenderOptions& options, const glm::ivec2& size,
                                     int samples) {
  ReferenceSettings settings;
  settings.width = size.x;
  settings.height = size.y;
  settings.samples = samples;
  settings.seed = options.seed;
  if (options.bounces >= 0) settings.max_bounces = options.bounces;
  return settings;
}

}  // namespace

Painter::Painter(const RenderOptions& options, const glm::ivec2& size)
    : options_(options), size_(size), progress_(terminal_progress()) {}

/// Brings the field up to date with the world: the first time from nothing.
Expected<void> Painter::follow(const World& world, Json& stats) {
  if (field_) {
    update_field(world, options_.frame_updates, false, *field_, progress_, stats);
    return {};
  }
  const auto settings = field_settings(options_);
  if (!settings) return tl::unexpected(settings.error());
  Expected<IrradianceField> made = IrradianceField::make(*settings, open_bounds(world));
  if (!made) return tl::unexpected(made.error());
  field_.emplace(std::move(*made));
  const int updates = options_.converge ? kMaxConvergeUpdates : options_.updates;
  update_field(world, updates, options_.converge, *field_, progress_, stats);
  return {};
}

Expected<LayeredImage> Painter::paint(const World& world, const Camera& camera, Json& stats) {
  if (options_.method == "reference") return paint_by_reference(world, camera, stats);
  if (options_.method == "field") {
    if (const auto done = follow(world, stats); !done) return tl::unexpected(done.error());
  }
  FrameSettings frame;
  frame.width = size_.x;
  frame.height = size_.y;
  frame.samples = options_.samples > 0 ? options_.samples : kFieldSamples;
  frame.gather_rays = options_.gather_rays;
  frame.seed = options_.seed;
  RenderedFrame rendered =
      render_frame(world, field_ ? &*field_ : nullptr, camera, frame, progress_);
  for (const PassTime& pass : rendered.passes) stats[pass.name + "_ms"] = pass.ms;
  stats["camera_rays"] = rendered.rays;
  return std::move(rendered.image);
}

LayeredImage Painter::paint_by_reference(const World& world, const Camera& camera,
                                         Json& stats) const {
  const int samples = options_.samples > 0 ? options_.samples : kReferenceSamples;
  ReferenceResult result =
      render_reference(world, camera, reference_settings(options_, size_, samples), progress_);
  stats["samples"] = samples;
  stats["reference_ms"] = result.ms;
  stats["reference_rays"] = result.rays;
  stats["relative_standard_error"] = result.relative_standard_error;
  std::printf("reference: %d samples a pixel, relative standard error %.4f\n", samples,
              result.relative_standard_error);
  return std::move(result.image);
}

Expected<void> Painter::verify(const World& world, const Camera& camera, const LayeredImage& image,
                               Json& stats) const {
  const ReferenceResult reference = render_reference(
      world, camera, reference_settings(options_, size_, options_.verify_samples), progress_);
  std::printf("error against %d path-traced samples a pixel (their own: %.4f)\n",
              options_.verify_samples, reference.relative_standard_error);
  for (const char* name : {"", "direct", "indirect", "irradiance"}) {
    const Image* ours = image.find(name);
    const Image* truth = reference.image.find(name);
    if (ours == nullptr || truth == nullptr) continue;
    const Expected<Metrics> metrics =
        compare_images(*ours, *truth, {.block = kVerifyBlock, .perceptual = false});
    if (!metrics) return tl::unexpected(metrics.error());
    const std::string label = *name == '\0' ? "all" : name;
    if (metrics->mean_b == 0.0) {
      std::printf("  %-11s black in truth, mean %g here\n", label.c_str(), metrics->mean_a);
      continue;
    }
    std::printf("  %-11s mean ratio %.4f, relative RMSE of 8x8 blocks %.4f\n", label.c_str(),
                metrics->mean_ratio, metrics->relative_rmse);
    stats["verify_" + label + "_mean_ratio"] = metrics->mean_ratio;
    stats["verify_" + label + "_relative_rmse"] = metrics->relative_rmse;
  }
  return {};
}

}  // namespace lambent::cli
