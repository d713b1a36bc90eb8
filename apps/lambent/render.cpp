// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/atomic_file.h"
#include "core/metrics.h"
#include "core/tone_map.h"
#include "lambent/commands.h"
#include "lambent/field.h"
#include "lambent/parse.h"
#include "lambent/progress_bar.h"
#include "lambent/render_rsm.h"
#include "lambent/renderer.h"
#include "lambent/stage.h"
#include "lambent/threads.h"
#include "lambent/world.h"
#include "reference/path_tracer.h"

namespace lambent::cli {
namespace {

// Light is called settled when an update changes the field by less than this share of it ...
constexpr double kConvergedChange = 0.002;
// ... or after so many updates.
constexpr int kMaxConvergeUpdates = 256;

struct Options {
  StageOptions stage;
  std::string output;
  std::string method = "field";
  std::string backend = "cpu";
  std::string size = "1280x720";
  int samples = 0;  // 0: the method's own default
  int gather_rays = 0;
  int bounces = -1;  // -1: all
  std::uint32_t seed = 1;
  int threads = 0;  // 0: all
  bool layers = false;
  std::string stats;
  std::string exposure = "auto";
  std::string tone_map = "aces";
  int verify_samples = 0;

  FieldSettings field;
  std::string probes, volume;
  int updates = 8;
  bool converge = false;
  std::string irradiance_format = "rgb9e5";
  std::string distance_format = "rg16f";
  RsmOptions rsm;
  std::vector<const CLI::Option*> of_the_field;  // what means nothing to other methods
};

// Side of the blocks whose means --verify compares [pixels]: hides the path tracer's noise, keeps
// structure.
constexpr int kVerifyBlock = 8;

// Defaults of --samples: enough for smooth edges, and for a picture in which noise is fine grain.
constexpr int kFieldSamples = 4;
constexpr int kReferenceSamples = 64;

// Typing errors are caught before they cost days: more samples leave no noise to see, and after so
// many bounces no surface that we accept has light left to send on.
constexpr int kMaxSamples = 1 << 20;
constexpr int kMaxBounces = 1000;
constexpr int kMaxThreads = 1024;

const std::map<std::string, IrradianceFormat> kIrradianceFormats = {
    {"rgb9e5", IrradianceFormat::rgb9e5},
    {"r11g11b10f", IrradianceFormat::r11g11b10f},
    {"float32", IrradianceFormat::float32}};
const std::map<std::string, DistanceFormat> kDistanceFormats = {{"rg16f", DistanceFormat::rg16f},
                                                                {"rg32f", DistanceFormat::rg32f}};

using Json = nlohmann::ordered_json;

bool uses_field(const Options& options) {
  return options.method == "field" || options.method == "rsm+field";
}

/// Fails early on outputs that could not be written after minutes of work.
Expected<void> check_outputs(const Options& options) {
  const bool exr = has_ending(options.output, ".exr");
  if (!exr && !has_ending(options.output, ".png")) {
    return fail(options.output, "", "the output must end in .exr or .png");
  }
  if (options.layers && !exr) return fail("--layers", "", "layers need an .exr output");
  for (const std::string& path : {options.output, options.stats}) {
    if (path.empty()) continue;
    if (const Expected<void> fine = check_writable(path); !fine) return fine;
  }
  return {};
}

/// Stops, or nothing for "auto".
Expected<std::optional<float>> parse_exposure(const std::string& text) {
  float stops = 0.0f;
  if (text == "auto") return std::optional<float>();
  if (!CLI::detail::lexical_cast(text, stops) || !std::isfinite(stops)) {
    return fail("--exposure", "", "'" + text + "' is neither auto nor a number of stops");
  }
  return std::optional<float>(stops);
}

Expected<void> write_output(const Options& options, const LayeredImage& image) {
  const Image& picture = *image.find("");
  if (has_ending(options.output, ".exr")) {
    if (options.layers) return write_exr(options.output, image);
    LayeredImage whole{image.width, image.height, {{"", picture}}};
    return write_exr(options.output, whole);
  }
  const std::optional<float> chosen = *parse_exposure(options.exposure);
  const float stops = chosen ? *chosen : static_cast<float>(std::log2(auto_exposure(picture)));
  return write_png(options.output,
                   display_image(picture, *tone_map_from_name(options.tone_map), stops));
}

Expected<FieldSettings> field_settings(const Options& options) {
  FieldSettings settings = options.field;
  settings.seed = options.seed;
  settings.max_bounces = options.bounces;
  settings.irradiance_format = kIrradianceFormats.at(options.irradiance_format);
  settings.distance_format = kDistanceFormats.at(options.distance_format);
  if (!options.probes.empty()) {
    if (settings.probe_spacing > 0.0f) {
      return fail("--probes", "", "give either --probes or --probe-spacing");
    }
    const auto counts = parse_counts("--probes", options.probes);
    if (!counts) return tl::unexpected(counts.error());
    settings.probe_count = *counts;
  }
  if (!options.volume.empty()) {
    const auto box = parse_box("--volume", options.volume);
    if (!box) return tl::unexpected(box.error());
    settings.volume = *box;
  }
  return settings;
}

/// Updates the field as often as asked, and books what it cost.
void update_field(const Options& options, const World& world, IrradianceField& field,
                  const ProgressFn& progress, Json& stats) {
  UpdateStatistics last, sum;
  const int most = options.converge ? kMaxConvergeUpdates : options.updates;
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
    if (options.converge && last.change < kConvergedChange) break;
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

Expected<LayeredImage> render_by_field(const Options& options, const World& world,
                                       const Camera& camera, const glm::ivec2& size,
                                       const ProgressFn& progress, Json& stats) {
  FrameSettings frame;
  frame.width = size.x;
  frame.height = size.y;
  frame.samples = options.samples > 0 ? options.samples : kFieldSamples;
  frame.gather_rays = options.gather_rays;
  frame.seed = options.seed;

  const auto rsm = rsm_settings(options.rsm, options.method, options.seed);
  if (!rsm) return tl::unexpected(rsm.error());
  IndirectSources sources;
  sources.rsm = uses_rsm(options.method) ? &*rsm : nullptr;
  sources.rsm_stages = options.layers;
  std::optional<IrradianceField> field, first_bounce;
  if (uses_field(options)) {
    const auto settings = field_settings(options);
    if (!settings) return tl::unexpected(settings.error());
    Expected<IrradianceField> made = IrradianceField::make(*settings, open_bounds(world));
    if (!made) return tl::unexpected(made.error());
    field.emplace(std::move(*made));
    if (options.method == "rsm+field") {
      first_bounce = *IrradianceField::make(FirstBounce::settings(*settings), open_bounds(world));
      Json ignored;
      update_field(options, FirstBounce(world.scene()).world(), *first_bounce, progress, ignored);
      sources.taken_out = &*first_bounce;
    }
    update_field(options, world, *field, progress, stats);
    sources.field = &*field;
  }
  RenderedFrame rendered = render_frame(world, sources, camera, frame, progress);
  for (const PassTime& pass : rendered.passes) stats[pass.name + "_ms"] = pass.ms;
  stats["camera_rays"] = rendered.rays;
  return rendered.image;
}

ReferenceSettings reference_settings(const Options& options, const glm::ivec2& size, int samples) {
  ReferenceSettings settings;
  settings.width = size.x;
  settings.height = size.y;
  settings.samples = samples;
  settings.seed = options.seed;
  if (options.bounces >= 0) settings.max_bounces = options.bounces;
  return settings;
}

LayeredImage render_by_reference(const Options& options, const World& world, const Camera& camera,
                                 const glm::ivec2& size, const ProgressFn& progress, Json& stats) {
  const int samples = options.samples > 0 ? options.samples : kReferenceSamples;
  ReferenceResult result =
      render_reference(world, camera, reference_settings(options, size, samples), progress);
  stats["samples"] = samples;
  stats["reference_ms"] = result.ms;
  stats["reference_rays"] = result.rays;
  stats["relative_standard_error"] = result.relative_standard_error;
  std::printf("reference: %d samples a pixel, relative standard error %.4f\n", samples,
              result.relative_standard_error);
  return result.image;
}

/// Path-traces the same view and prints the picture's error beside it.
Expected<void> verify(const Options& options, const World& world, const Camera& camera,
                      const glm::ivec2& size, const LayeredImage& image, const ProgressFn& progress,
                      Json& stats) {
  const ReferenceResult reference = render_reference(
      world, camera, reference_settings(options, size, options.verify_samples), progress);
  std::printf("error against %d path-traced samples a pixel (their own: %.4f)\n",
              options.verify_samples, reference.relative_standard_error);
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

Expected<void> check_numbers(const Options& options) {
  if (const auto exposure = parse_exposure(options.exposure); !exposure) {
    return tl::unexpected(exposure.error());
  }
  for (const CLI::Option* option : options.of_the_field) {
    if (uses_field(options) || option->count() == 0) continue;
    return fail(option->get_name(), "", "goes with --method field and rsm+field alone");
  }
  if (const auto fine = check_rsm_use(options.rsm, options.method, options.bounces,
                                      options.gather_rays, options.converge);
      !fine) {
    return fine;
  }
  if (options.method == "direct" && options.bounces > 0) {
    return fail("--bounces", "", "--method direct has none");
  }
  return {};
}

Expected<void> render(const Options& options) {
  if (const auto fine = check_outputs(options); !fine) return fine;
  if (const auto fine = check_numbers(options); !fine) return fine;
  const auto size = parse_size("--size", options.size);
  if (!size) return tl::unexpected(size.error());
  const ThreadLimit limit(options.threads);

  const Expected<Scene> scene = open_stage(options.stage);
  if (!scene) return tl::unexpected(scene.error());
  const World world(*scene);
  const Expected<Camera> camera = choose_camera(options.stage, world);
  if (!camera) return tl::unexpected(camera.error());

  Json stats;
  stats["method"] = options.method;
  stats["backend"] = options.backend;
  stats["width"] = size->x;
  stats["height"] = size->y;
  stats["triangles"] = triangle_count(*scene);
  stats["build_ms"] = world.build_ms();
  stats["acceleration_structure_bytes"] = world.bytes();

  const ProgressFn progress = terminal_progress();
  Expected<LayeredImage> image =
      options.method == "reference"
          ? render_by_reference(options, world, *camera, *size, progress, stats)
          : render_by_field(options, world, *camera, *size, progress, stats);
  if (!image) return tl::unexpected(image.error());
  if (const auto done = write_output(options, *image); !done) return done;
  if (options.verify_samples > 0) {
    const auto done = verify(options, world, *camera, *size, *image, progress, stats);
    if (!done) return done;
  }
  if (!options.stats.empty()) return write_file_atomically(options.stats, stats.dump(2) + "\n");
  return {};
}

void add_field_options(CLI::App& command, Options& o) {
  const std::size_t others = command.get_options().size();
  command
      .add_option("--gather", o.gather_rays,
                  "Rays a sample gathers indirect light with (0: look the field up)")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command.add_option("--probes", o.probes, "Probes along each axis, XxYxZ");
  command.add_option("--probe-spacing", o.field.probe_spacing, "Distance between probes [m]")
      ->check([](const std::string& text) {
        float spacing = 0.0f;
        const bool fine = CLI::detail::lexical_cast(text, spacing) && spacing > 0.0f;
        return fine ? std::string() : "'" + text + "' is not a number above 0";
      });
  command.add_option("--volume", o.volume, "Box of the probes, x0,y0,z0,x1,y1,z1 [m]");
  command.add_option("--rays", o.field.rays_per_probe, "Rays a probe and update")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  command.add_option("--updates", o.updates, "Updates of the field before the frame")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_flag("--converge", o.converge, "Update until the field has settled")
      ->excludes("--updates");
  command.add_option("--hysteresis", o.field.hysteresis, "Share of the old light an update keeps")
      ->check(CLI::Range(0.0f, 0.999f))
      ->capture_default_str();
  command.add_option("--irradiance-format", o.irradiance_format, "rgb9e5, r11g11b10f or float32")
      ->check(CLI::IsMember(kIrradianceFormats))
      ->capture_default_str();
  command.add_option("--distance-format", o.distance_format, "rg16f or rg32f")
      ->check(CLI::IsMember(kDistanceFormats))
      ->capture_default_str();
  command.add_option("--irradiance-texels", o.field.irradiance_texels, "Of a tile's edge, even")
      ->check(CLI::Range(2, 16))
      ->capture_default_str();
  command.add_option("--distance-texels", o.field.distance_texels, "Of a tile's edge")
      ->check(CLI::Range(4, 32))
      ->capture_default_str();
  const std::vector<CLI::Option*> all = command.get_options();
  o.of_the_field.assign(all.begin() + static_cast<std::ptrdiff_t>(others), all.end());
}

}  // namespace

void add_render(CLI::App& app, Run& run) {
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "Render a picture of a scene");
  add_stage_options(*command, o->stage);
  command->add_option("-o,--output", o->output, "The .exr (linear) or .png file to write")
      ->required();
  command->add_option("--method", o->method, "field, rsm, rsm+field, direct or reference")
      ->check(CLI::IsMember({"field", "rsm", "rsm+field", "direct", "reference"}))
      ->capture_default_str();
  command->add_option("--backend", o->backend, "cpu")
      ->check(CLI::IsMember({"cpu"}))
      ->capture_default_str();
  command->add_option("--size", o->size, "WxH [pixels]")->capture_default_str();
  command
      ->add_option("--samples", o->samples,
                   "Rays or paths a pixel (field and direct: 4, reference: 64)")
      ->check(CLI::Range(1, kMaxSamples));
  command->add_option("--bounces", o->bounces, "Bounces of indirect light (all of them)")
      ->check(CLI::Range(0, kMaxBounces));
  command->add_option("--seed", o->seed, "Of all random numbers")->capture_default_str();
  command->add_option("--threads", o->threads, "Threads to use (all)")
      ->check(CLI::Range(1, kMaxThreads));
  command->add_flag("--layers", o->layers, "Write every layer of the frame, .exr only");
  command->add_option("--stats", o->stats, "Write times and counts to this .json file");
  command->add_option("--exposure", o->exposure, "Of a .png, in stops, or auto")
      ->capture_default_str();
  command->add_option("--tone-map", o->tone_map, "Of a .png: aces, neutral or linear")
      ->check(CLI::IsMember({"aces", "neutral", "linear"}))
      ->capture_default_str();
  command
      ->add_option("--verify", o->verify_samples,
                   "Also path-trace so many samples a pixel and print the error")
      ->check(CLI::Range(2, kMaxSamples));
  add_field_options(*command, *o);
  add_rsm_options(*command, o->rsm);
  command->callback([o, &run] { run = [o] { return render(*o); }; });
}

}  // namespace lambent::cli
