// SPDX-License-Identifier: Apache-2.0
#include "lambent/frame_renderer.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "compose/probe_view.h"
#include "core/image/metrics.h"
#include "lambent/progress_bar.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"

namespace lambent::cli {
namespace {

using Json = nlohmann::ordered_json;

// Side of the blocks whose means --verify compares [pixels]: hides the path tracer's noise, keeps
// structure.
constexpr int kVerifyBlock = 8;

// Defaults of --samples: enough for smooth edges, and for a picture in which noise is fine grain.
constexpr int kFieldSamples = 4;
constexpr int kReferenceSamples = 64;

// Of the picture that tells the field what is seen [pixels].
constexpr int kSeenWidth = 48, kMaxSeenHeight = 96;

const std::map<std::string, ProbeAspect> kProbeAspects = {{"irradiance", ProbeAspect::irradiance},
                                                          {"distance", ProbeAspect::distance},
                                                          {"state", ProbeAspect::state},
                                                          {"age", ProbeAspect::age}};

/// The field that the options ask for, as yet without updates.
Expected<IrradianceField> open_field(const RenderOptions& options, const World& world) {
  const auto settings = field_settings(options.field, world.scene(), options.seed, options.bounces);
  if (!settings) return tl::unexpected(settings.error());
  if (options.field_file.empty()) return IrradianceField::make(*settings, open_bounds(world));
  Expected<LoadedField> loaded = load_field(options.field_file, *settings, world);
  if (!loaded) return tl::unexpected(loaded.error());
  if (!loaded->same_light) {
    std::fprintf(stderr, "lambent: %s was made under other light than the scene's\n",
                 options.field_file.c_str());
  }
  return std::move(loaded->field);
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

FrameRenderer::FrameRenderer(const RenderOptions& options, const glm::ivec2& size)
    : options_(options), size_(size), progress_(terminal_progress()) {}

/// Brings the field up to date with the world: the first time from nothing, or from a file.
Expected<void> FrameRenderer::follow(const World& world, const Camera& camera, Json& stats) {
  const glm::vec3 viewer(camera.world_from_view[3]);
  if (field_) {
    const int height = std::clamp(kSeenWidth * size_.y / size_.x, 1, kMaxSeenHeight);
    const std::vector<FieldQuery> seen = visible_points(world, camera, kSeenWidth, height);
    const UpdateRequest request{options_.ray_budget, options_.time_budget_ms, viewer, seen};
    update_field(world, options_.frame_updates, request, *field_, progress_, stats);
    return {};
  }
  Expected<IrradianceField> opened = open_field(options_, world);
  if (!opened) return tl::unexpected(opened.error());
  field_.emplace(std::move(*opened));
  if (options_.converge) {
    settle_field(world, {0, 0.0, viewer}, *field_, progress_, stats);
  } else {
    update_field(world, options_.updates, {0, 0.0, viewer}, *field_, progress_, stats);
  }
  return {};
}

/// Makes the fields of one frame anew: all light, and the first bounce of the lights that the maps
/// bring, which is taken out. Both trace the same rays, so that noise goes with it.
Expected<void> FrameRenderer::split_bounces(const World& world, const Camera& camera, Json& stats) {
  const auto settings =
      field_settings(options_.field, world.scene(), options_.seed, options_.bounces);
  if (!settings) return tl::unexpected(settings.error());
  Expected<IrradianceField> all = IrradianceField::make(*settings, open_bounds(world));
  if (!all) return tl::unexpected(all.error());
  field_.emplace(std::move(*all));
  first_bounce_.emplace(
      *IrradianceField::make(FirstBounce::settings(*settings), open_bounds(world)));
  const FirstBounce lights_alone(world.scene());
  Json ignored;
  const UpdateRequest request{0, 0.0, glm::vec3(camera.world_from_view[3])};
  update_field(lights_alone.world(), options_.updates, request, *first_bounce_, progress_, ignored);
  update_field(world, options_.updates, request, *field_, progress_, stats);
  return {};
}

Expected<LayeredImage> FrameRenderer::paint(const World& world, const Camera& camera, Json& stats) {
  if (options_.method == "reference") return paint_by_reference(world, camera, stats);
  if (uses_field(options_)) {
    const auto done = options_.method == "rsm+field" ? split_bounces(world, camera, stats)
                                                     : follow(world, camera, stats);
    if (!done) return tl::unexpected(done.error());
  }
  const auto rsm = rsm_settings(options_.rsm, options_.method, options_.seed);
  if (!rsm) return tl::unexpected(rsm.error());
  IndirectSources sources;
  sources.rsm = uses_rsm(options_.method) ? &*rsm : nullptr;
  sources.rsm_stages = options_.layers;
  sources.field = field_ ? &*field_ : nullptr;
  sources.subtracted_field = first_bounce_ ? &*first_bounce_ : nullptr;
  FrameSettings frame;
  frame.width = size_.x;
  frame.height = size_.y;
  frame.samples = options_.samples > 0 ? options_.samples : kFieldSamples;
  frame.gather_rays = options_.gather_rays;
  frame.seed = options_.seed;
  RenderedFrame rendered = render_frame(world, sources, camera, frame, progress_);
  for (const PassTime& pass : rendered.passes) stats[pass.name + "_ms"] = pass.ms;
  stats["camera_rays"] = rendered.rays;
  if (!options_.show_probes.empty()) {
    const ProbeViewSettings view{.aspect = kProbeAspects.at(options_.show_probes)};
    draw_probes(world, *field_, camera, view, rendered.image);
  }
  return std::move(rendered.image);
}

LayeredImage FrameRenderer::paint_by_reference(const World& world, const Camera& camera,
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

Expected<void> FrameRenderer::verify(const World& world, const Camera& camera,
                                     const LayeredImage& image, Json& stats) const {
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
