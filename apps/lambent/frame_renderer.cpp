// SPDX-License-Identifier: Apache-2.0
#include "lambent/frame_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "compose/probe_view.h"
#include "compose/unlit.h"
#include "core/image/exposure.h"
#include "core/image/metrics.h"
#include "core/image/tone_map.h"
#include "core/memory.h"
#include "lambent/console.h"
#include "lambent/field_updates.h"
#include "lambent/memory_check.h"
#include "lambent/parse.h"
#include "lambent/progress_bar.h"
#include "lambent/quality.h"
#include "lambent/render_output.h"
#include "lambent/renderer.h"
#include "lambent/step.h"
#include "reference/path_tracer.h"

namespace lambent::cli {
namespace {

using Json = nlohmann::ordered_json;

// Side of the blocks whose means --verify compares [pixels]: hides the path tracer's noise, but
// preserves structure.
constexpr int kVerifyBlock = 8;

// Default of --samples for the reference: the noise is then fine grain.
constexpr int kReferenceSamples = 64;

// Size of the picture from which the field's UpdateRequest::seen is taken [pixels].
constexpr int kSeenWidth = 48, kMaxSeenHeight = 96;

// Longer side of the preview from which the exposure is found [pixels]: for pictures with millions
// of pixels, and for others.
constexpr int kLargePreviewSide = 512, kPreviewSide = 192;
// Paths per pixel of such a preview.
constexpr int kPreviewSamples = 16;
// Times that the first frame of a sequence is rendered, so that it is as smooth as the later ones,
// which average frames before them: about as many as these remember.
constexpr int kFirstRenders = 8;

const std::map<std::string, ProbeAspect> kProbeAspects = {{"irradiance", ProbeAspect::irradiance},
                                                          {"distance", ProbeAspect::distance},
                                                          {"state", ProbeAspect::state},
                                                          {"age", ProbeAspect::age}};

/// The field that the options describe, before any updates.
Expected<IrradianceField> open_field(const RenderOptions& options, const World& world,
                                     const Camera& camera, std::span<const Bounds> path_boxes) {
  const auto settings = picture_field_settings(options, world, camera, path_boxes);
  if (!settings) return tl::unexpected(settings.error());
  const std::size_t asked = world.scene().volumes.size() + options.field.volumes.size();
  if (settings->volumes.size() > asked) {
    tell("probes: finer ones " + settings->volumes[asked].name +
         ", as the scene is large (--bounds places them)");
  }
  if (options.field_file.empty()) return make_field(*settings, options.field, world, camera, 1);
  Expected<LoadedField> loaded = load_field(options.field_file, *settings, world);
  if (!loaded) return tl::unexpected(loaded.error());
  const auto probes = static_cast<std::uint64_t>(loaded->field.probes());
  const auto fits =
      check_field_memory(field_memory(loaded->field.settings(), probes),
                         host_rays(loaded->field.settings(), world), 1, available_memory());
  if (!fits) return tl::unexpected(fits.error());
  if (!loaded->same_light) {
    warn(options.field_file + " was made under other light than the scene's");
  }
  return std::move(loaded->field);
}

ReferenceSettings reference_settings(const RenderOptions& options, const glm::ivec2& size,
                                     int samples, float unlit_radiance) {
  ReferenceSettings settings;
  settings.unlit_radiance = unlit_radiance;
  settings.width = size.x;
  settings.height = size.y;
  settings.samples = samples;
  settings.seed = options.seed;
  if (options.bounces >= 0) settings.max_bounces = options.bounces;
  return settings;
}

/// Adds the costs of a frame, or of some of its rows.
void book(const RenderedFrame& frame, Json& stats) {
  for (const PassTime& pass : frame.passes) {
    const std::string key = pass.name + "_ms";
    stats[key] = stats.value(key, 0.0) + pass.ms;
  }
  stats["camera_rays"] = stats.value("camera_rays", std::uint64_t{0}) + frame.rays;
}

// Number of updates after which all bounces have reached all probes; noise remains.
constexpr int kFewUpdates = 8;

/// Tells how much noise is left in a field that is not calm after so many updates.
void tell_noise(const FieldProgress& reached, double standard_error) {
  if (!(standard_error > kNoisyField)) return;
  std::ostringstream text;
  text << "the light of probes still has " << std::lround(100.0 * standard_error)
       << " % of noise after " << reached.updates
       << " updates: it may show on plain walls (--updates N makes more)";
  tell(text.str());
}

int first_updates(const RenderOptions& options) {
  return options.updates < 0 ? kFewUpdates : options.updates;
}

}  // namespace

glm::ivec2 preview_of(const glm::ivec2& size, int side) {
  const double scale = std::min(1.0, static_cast<double>(side) / std::max(size.x, size.y));
  return {std::max(1, static_cast<int>(std::lround(size.x * scale))),
          std::max(1, static_cast<int>(std::lround(size.y * scale)))};
}

FrameRenderer::FrameRenderer(const RenderOptions& options, const World& world,
                             const glm::ivec2& size)
    : options_(options), world_(world), size_(size), progress_(stderr_progress()) {}

/// Brings the field up to date with the world. The first time, creates it or reads it from a file.
Expected<void> FrameRenderer::follow(const Camera& camera, Json& stats) {
  const glm::vec3 viewer(camera.world_from_view[3]);
  if (field_) {
    const int height = std::clamp(kSeenWidth * size_.y / size_.x, 1, kMaxSeenHeight);
    const auto seen = visible_points(world_, camera, kSeenWidth, height);
    if (!seen) return tl::unexpected(seen.error());
    const UpdateRequest request{options_.ray_budget, options_.time_budget_ms, viewer, *seen};
    update_field(world_, options_.frame_updates, request, *field_, progress_, stats);
    return {};
  }
  Expected<IrradianceField> opened = open_field(options_, world_, camera, path_boxes_);
  if (!opened) return tl::unexpected(opened.error());
  field_.emplace(std::move(*opened));
  if (options_.converge) {
    settle_field(world_, {0, 0.0, viewer}, *field_, progress_, stats);
  } else {
    const UpdateRequest request{0, 0.0, viewer};
    if (wants_calm_field(options_)) {
      const bool gathers = frame_settings(options_, size_).gather_rays > 0;
      const FieldProgress reached =
          calm_field(world_, kFewUpdates, gathers, request, *field_, progress_, stats);
      // Where pixels gather light, that of the field arrives by a further bounce, which averages it
      if (!gathers) tell_noise(reached, field_->standard_error());
    } else {
      update_field(world_, first_updates(options_), request, *field_, progress_, stats);
    }
  }
  return {};
}

/// Makes both fields of one frame anew: one with all light, and one with the first bounce of the
/// lights that the maps include, which is subtracted. Both trace the same rays, so that their noise
/// cancels.
Expected<void> FrameRenderer::split_bounces(const Camera& camera, Json& stats) {
  const auto settings = picture_field_settings(options_, world_, camera, {});
  if (!settings) return tl::unexpected(settings.error());
  const glm::vec3 viewer(camera.world_from_view[3]);
  Expected<IrradianceField> all = make_field(*settings, options_.field, world_, camera, 2);
  if (!all) return tl::unexpected(all.error());
  field_.emplace(std::move(*all));
  first_bounce_.emplace(
      *IrradianceField::make(FirstBounce::settings(*settings), open_bounds(world_, viewer)));
  const FirstBounce lights_alone(world_.scene());
  Json ignored;
  const UpdateRequest request{0, 0.0, viewer};
  const int updates = first_updates(options_);
  update_field(lights_alone.world(), updates, request, *first_bounce_, progress_, ignored);
  update_field(world_, updates, request, *field_, progress_, stats);
  return {};
}

/// Updates the fields of the method to the current world.
Expected<void> FrameRenderer::light(const Camera& camera, Json& stats) {
  if (!uses_field(options_)) return {};
  begin_step("updating the field");
  return options_.method == "rsm+field" ? split_bounces(camera, stats) : follow(camera, stats);
}

Expected<IndirectSources> FrameRenderer::sources() const {
  const auto rsm = rsm_settings(options_.rsm, options_.method, options_.seed);
  if (!rsm) return tl::unexpected(rsm.error());
  IndirectSources sources;
  if (uses_rsm(options_.method)) sources.rsm = *rsm;
  sources.rsm_stages = options_.layers && sources.rsm;
  sources.field = field_ ? &*field_ : nullptr;
  sources.subtracted_field = first_bounce_ ? &*first_bounce_ : nullptr;
  return sources;
}

Expected<void> FrameRenderer::render(const Camera& camera, const FrameSettings& settings,
                                     const ProgressFn& progress) {
  begin_step("rendering the picture");
  if (!renderer_) {
    const Expected<IndirectSources> lit_by = sources();
    if (!lit_by) return tl::unexpected(lit_by.error());
    const std::size_t lights = world_.scene().lights.size();
    const std::string slow = lit_by->rsm ? slow_gather(*lit_by->rsm, lights) : "";
    if (!slow.empty()) warn(slow);
    renderer_.emplace(world_, *lit_by);
  }
  return renderer_->render(camera, settings, frame_, progress);
}

Expected<void> FrameRenderer::paint(const Camera& camera, Json& stats) {
  if (options_.method == "reference") {
    paint_by_reference(camera, stats);
    return {};
  }
  FrameSettings settings = frame_settings(options_, size_);
  settings.unlit_radiance = unlit_radiance_;
  // Frames that are averaged must have different noise. With averaged_frames, the renderer itself
  // varies the seed
  const bool averages = settings.averaged_frames > 1;
  const int renders = settings.temporal_antialiasing && painted_ == 0 ? kFirstRenders : 1;
  for (int i = 0; i < renders; ++i) {
    const std::uint32_t painted = painted_++;
    if (settings.temporal_antialiasing && !averages) settings.seed = options_.seed + painted;
    if (const auto done = render(camera, settings, progress_); !done) return done;
  }
  book(frame_, stats);
  if (!options_.show_probes.empty()) {
    const ProbeViewSettings view{.aspect = kProbeAspects.at(options_.show_probes)};
    draw_probes(world_, *field_, camera, view, frame_.image);
  }
  return {};
}

/// Sets the radiance at which unlit surfaces show their colours. If the options do not set the
/// exposure, it is first found from all other surfaces, in a small picture without the unlit ones.
/// In files of radiance, the radiance of unlit surfaces is their colour.
Expected<void> FrameRenderer::expose_unlit(const Camera& camera, const std::string& path,
                                           std::optional<float>& stops) {
  if (has_ending(path, ".exr") || !shows_unlit(world_.scene())) return {};
  if (!stops) {
    const glm::ivec2 size = preview_of(size_, kPreviewSide);
    if (options_.method == "reference") {
      frame_.image = render_reference(world_, camera,
                                      reference_settings(options_, size, kPreviewSamples, 0.0f))
                         .image;
    } else {
      FrameSettings preview = frame_settings(options_, size);
      preview.unlit_radiance = 0.0f;
      preview.averaged_frames = 1;
      preview.temporal_antialiasing = false;
      if (const auto done = render(camera, preview, {}); !done) return done;
    }
    stops = display_stops(frame_.image);
  }
  unlit_radiance_ = radiance_of_colors(*tone_map_from_name(options_.tone_map), *stops);
  return {};
}

Expected<void> FrameRenderer::paint_to_file(const Camera& camera, const std::string& path,
                                            std::optional<float>& stops, Json& stats) {
  PictureFile file(options_, path, size_, stops);
  if (options_.method != "reference") {
    if (const auto lit = light(camera, stats); !lit) return lit;
  }
  if (const auto exposed = expose_unlit(camera, path, stops); !exposed) return exposed;
  if (!made_in_bands(options_, size_)) {
    if (const auto done = paint(camera, stats); !done) return done;
    if (const auto written = file.write(frame_.image); !written) return written;
    return file.finish();
  }
  FrameSettings settings = frame_settings(options_, size_);
  settings.unlit_radiance = unlit_radiance_;
  settings.averaged_frames = 1;  // supported for whole pictures only
  if (file.needs_stops()) {
    FrameSettings preview = settings;
    const glm::ivec2 size = preview_of(size_, kLargePreviewSide);
    preview.width = size.x;
    preview.height = size.y;
    preview.most_samples = 0;  // as the picture's parts have none
    if (const auto done = render(camera, preview, {}); !done) return done;
    stops = display_stops(frame_.image);
  }
  settings.rows = rows_of_a_band(options_, size_);
  for (; settings.first_row < size_.y; settings.first_row += settings.rows) {
    settings.rows = std::min(settings.rows, size_.y - settings.first_row);
    const auto of_all = [&](std::string_view stage, double share_done) {
      progress_(stage, (settings.first_row + share_done * settings.rows) / size_.y);
    };
    const auto done = render(camera, settings, progress_ ? ProgressFn(of_all) : ProgressFn());
    if (!done) return done;
    book(frame_, stats);
    if (const auto written = file.write(frame_.image); !written) return written;
  }
  return file.finish();
}

void FrameRenderer::paint_by_reference(const Camera& camera, Json& stats) {
  begin_step("tracing paths");
  const int samples = options_.samples > 0 ? options_.samples : kReferenceSamples;
  ReferenceResult result = render_reference(
      world_, camera, reference_settings(options_, size_, samples, unlit_radiance_), progress_);
  stats["samples"] = samples;
  stats["reference_ms"] = result.ms;
  stats["reference_rays"] = result.rays;
  stats["relative_standard_error"] = result.relative_standard_error;
  std::array<char, 96> text;
  std::snprintf(text.data(), text.size(),
                "reference: %d samples a pixel, relative standard error %.4f", samples,
                result.relative_standard_error);
  tell(text.data());
  frame_.image = std::move(result.image);
}

Expected<void> FrameRenderer::verify(const World& world, const Camera& camera, Json& stats) const {
  begin_step("comparing with the reference");
  const ReferenceResult reference = render_reference(
      world, camera, reference_settings(options_, size_, options_.verify_samples, unlit_radiance_),
      progress_);
  std::printf("error against %d path-traced samples a pixel (their own: %.4f)\n",
              options_.verify_samples, reference.relative_standard_error);
  for (const char* name :
       {"", "direct", "indirect", "irradiance", "glossy", "transmission", "fog"}) {
    const Image* ours = frame_.image.find(name);
    const Image* truth = reference.image.find(name);
    if (ours == nullptr || truth == nullptr) continue;
    if (std::string_view(name) == "fog" && world.scene().fog.empty()) continue;
    const Expected<Metrics> metrics =
        compare_images(*ours, *truth, {.block = kVerifyBlock, .perceptual = false});
    if (!metrics) return tl::unexpected(metrics.error());
    const std::string label = *name == '\0' ? "all" : name;
    if (label == "transmission" && metrics->mean_a == 0.0 && metrics->mean_b == 0.0) continue;
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
