// SPDX-License-Identifier: Apache-2.0
#include "lambent/quality.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <utility>

#include "lambent/field_options.h"
#include "lambent/first_picture.h"
#include "lambent/validators.h"

namespace lambent::cli {
namespace {

const std::map<std::string, Quality> kQualities = {
    {"draft", Quality::draft}, {"interactive", Quality::interactive}, {"high", Quality::high}};

Quality chosen_quality(const RenderOptions& options) {
  if (!options.quality.empty()) return quality_from_name(options.quality);
  return options.frames > 0 ? Quality::interactive : Quality::high;
}

/// Whether the options, or the scene's author, say where probes stand.
bool places_probes(const FieldSettings& settings) {
  return settings.probe_count != glm::ivec3(0) || settings.probe_spacing > 0.0f ||
         settings.volume != Bounds{} || settings.cascades > 0 || !settings.volumes.empty();
}

/// The grid of these settings, if it may have finer volumes around the camera.
std::optional<FieldGrid> grid_to_refine(const RenderOptions& options, const FieldSettings& settings,
                                        const World& world, const Camera& camera) {
  if (!options.field_file.empty() || places_probes(settings)) return std::nullopt;
  const glm::vec3 eye(camera.world_from_view[3]);
  const Expected<FieldGrid> grid = fit_grid(settings, open_bounds(world, eye));
  return grid ? std::optional(*grid) : std::nullopt;
}

}  // namespace

Quality quality_from_name(const std::string& name) {
  return kQualities.at(name);
}

bool leaves_out(const RenderOptions& options, const char* pass) {
  return std::find(options.without.begin(), options.without.end(), pass) != options.without.end();
}

void add_quality_options(CLI::App& command, RenderOptions& o) {
  command
      .add_option("--quality", o.quality,
                  "draft: light between probes as it is looked up; interactive: one ray a pixel; "
                  "high: some 64 (high; with --frames interactive)")
      ->check(one_of({"draft", "interactive", "high"}))
      ->type_name("Q");
  command
      .add_option("--without", o.without,
                  "Passes to leave out: gather, guide, glossy, fog, denoise; of sequences taa")
      ->delimiter(',')
      ->check(one_of({"gather", "guide", "glossy", "fog", "denoise", "taa"}))
      ->type_name("PASS,...");
  command
      .add_option("--froxel", o.froxel_pixels,
                  "Edge of the cells of the view in which fog is lit [pixels], up to 64 (the "
                  "quality's)")
      ->check(whole_number(1, 64))
      ->type_name("N");
  command
      .add_option("--samples", o.samples,
                  "Rays or paths a pixel (the quality's; with --method reference 64)")
      ->check(whole_number(1, kMaxSamples))
      ->type_name("N");
  command
      .add_option("--most-samples", o.most_samples,
                  "Rays of pixels whose samples differ visibly: their number doubles up to this "
                  "(the quality's; with --samples none)")
      ->check(whole_number(1, kMaxSamples))
      ->type_name("N");
}

FrameSettings frame_settings(const RenderOptions& options, const glm::ivec2& size) {
  FrameSettings frame = quality_settings(chosen_quality(options));
  frame.width = size.x;
  frame.height = size.y;
  frame.motion = keeps_motion(options);
  frame.temporal_antialiasing = uses_taa(options);
  frame.seed = options.seed;
  if (options.samples > 0) frame.samples = options.samples;
  // Without a number of its own, an explicit --samples takes no further ones
  if (options.samples > 0 || options.most_samples > 0) frame.most_samples = options.most_samples;
  if (options.frames > 0) frame.most_samples = 0;
  // Gathering adds a bounce to those of the field, so it is off where the number of bounces is
  // limited
  if (options.method != "field" || options.bounces >= 0) frame.gather_rays = 0;
  if (options.gather_rays >= 0) frame.gather_rays = options.gather_rays;
  if (leaves_out(options, "gather")) frame.gather_rays = 0;
  if (options.glossy_rows >= 0) frame.glossy_rows = options.glossy_rows;
  if (options.coat_rays > 0) frame.coat_rays = options.coat_rays;
  frame.guides_gathers = !leaves_out(options, "guide");
  if (leaves_out(options, "glossy")) frame.glossy_rows = 0;
  if (options.froxel_pixels > 0) frame.fog.froxel_pixels = options.froxel_pixels;
  if (leaves_out(options, "denoise")) frame.denoise = false;
  const bool averages = options.frames > 0 && frame.denoise && frame.samples == 1;
  if (averages && options.backend.name == "cpu") frame.averaged_frames = kAveragedFrames;
  return frame;
}

std::optional<FieldGrid> refinable_grid(const RenderOptions& options, const World& world,
                                        const Camera& camera) {
  const auto settings = field_settings(options.field, world.scene(), options.seed, options.bounces);
  return settings ? grid_to_refine(options, *settings, world, camera) : std::nullopt;
}

Expected<FieldSettings> picture_field_settings(const RenderOptions& options, const World& world,
                                               const Camera& camera,
                                               std::span<const Bounds> path_boxes) {
  auto settings = field_settings(options.field, world.scene(), options.seed, options.bounces);
  if (!settings) return settings;
  if (options.field.visibility.empty() && chosen_quality(options) == Quality::high) {
    settings->visibility = Visibility::hybrid;
  }
  const std::optional<FieldGrid> grid = grid_to_refine(options, *settings, world, camera);
  if (!grid) return settings;
  for (ProbeVolume& volume :
       path_boxes.empty() ? near_volumes(world, camera, *grid) : near_volumes(path_boxes, *grid)) {
    settings->volumes.push_back(std::move(volume));
  }
  return settings;
}

bool wants_calm_field(const RenderOptions& options) {
  return options.updates < 0 && options.frames == 0 && chosen_quality(options) == Quality::high;
}

bool uses_taa(const RenderOptions& options) {
  return options.frames > 0 && options.method != "reference" && !leaves_out(options, "taa");
}

bool is_filtered(const RenderOptions& options) {
  return options.method != "reference" && frame_settings(options, glm::ivec2(1)).denoise;
}

Expected<void> check_quality(const RenderOptions& options) {
  if (options.method == "reference" && !options.quality.empty()) {
    return fail("--quality", "", "does not go with --method reference: it traces paths alone");
  }
  if (options.most_samples > 0) {
    if (options.method == "reference") {
      return fail("--most-samples", "",
                  "does not go with --method reference: all pixels have as many paths");
    }
    if (options.frames > 0) {
      return fail("--most-samples", "", "goes with single pictures: frames are averaged over time");
    }
    const int samples = frame_settings(options, glm::ivec2(1)).samples;
    if (samples < 2 || options.most_samples / 2 < samples) {
      return fail("--most-samples", std::to_string(options.most_samples),
                  samples < 2 ? "needs two samples of all pixels, to compare"
                              : "is less than twice the samples of all pixels");
    }
  }
  for (const std::string& pass : options.without) {
    if (options.method == "reference" && pass != "fog") {
      return fail("--without", pass, "is no pass of --method reference: it traces paths alone");
    }
  }
  if (options.gather_rays > 0 && leaves_out(options, "gather")) {
    return fail("--gather", "", "does not go with --without gather");
  }
  if (options.frames == 0 && leaves_out(options, "taa")) {
    return fail("--without", "", "taa goes with --frames: single pictures have none");
  }
  if (!options.scene.fog.empty() && leaves_out(options, "fog")) {
    return fail("--fog", "", "does not go with --without fog");
  }
  if (options.froxel_pixels > 0 && leaves_out(options, "fog")) {
    return fail("--froxel", "", "does not go with --without fog");
  }
  if (options.glossy_rows > 0 && leaves_out(options, "glossy")) {
    return fail("--glossy-rows", "", "does not go with --without glossy");
  }
  if (options.coat_rays > 0 && (options.glossy_rows == 0 || leaves_out(options, "glossy"))) {
    return fail("--coat-rays", "", "needs reflections that are traced");
  }
  return {};
}

}  // namespace lambent::cli
