// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/image/heat_map.h"
#include "core/image/metrics.h"
#include "core/memory.h"
#include "lambent/command_files.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/help.h"
#include "lambent/image.h"
#include "lambent/input.h"
#include "lambent/layers.h"
#include "lambent/memory_check.h"
#include "lambent/output.h"
#include "lambent/parse.h"
#include "lambent/step.h"
#include "lambent/validators.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

struct CompareOptions {
  std::string path_a, path_b;
  std::vector<std::string> layers;
  std::string heat_map_path, noise_path;
  int block = 1;
  double scale = 1.0;
  bool json = false;
};

/// One comparison: the names of the layers of A and B, and the result.
struct Comparison {
  std::string name_a, name_b;
  Metrics metrics;
};

constexpr int kMaxBlock = 1 << 12;
/// Products with values of images must be finite.
constexpr double kMaxScale = 1e12;
/// A number that was not measured; printed as "-".
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// 8-bit files are display-encoded, all others have linear radiance.
bool is_display_file(const std::string& path) {
  return has_ending(path, ".png") || has_ending(path, ".jpg") || has_ending(path, ".jpeg");
}

/// The comparison that --layer selects; without it, every layer that both files have.
Expected<std::vector<Comparison>> choose_layers(const CompareOptions& options,
                                                const LayeredImage& a, const LayeredImage& b) {
  std::vector<Comparison> chosen;
  for (const std::string& text : options.layers) {
    const std::size_t equals = text.find('=');
    const bool same = equals == std::string::npos;
    chosen.push_back({text.substr(0, equals), same ? text : text.substr(equals + 1), {}});
  }
  if (!options.layers.empty()) return chosen;
  for (const Layer& layer : a.layers) {
    if (b.find(layer.name) != nullptr) chosen.push_back({layer.name, layer.name, {}});
  }
  if (chosen.empty()) {
    return fail(options.path_b, "",
                "has no layer in common with " + options.path_a + " (use --layer A_NAME=B_NAME)");
  }
  return chosen;
}

/// The standard error for a layer of B: the layer of that name, or the unnamed layer if there is
/// only one comparison.
Expected<const Image*> noise_of(const CompareOptions& options, const LayeredImage& noise,
                                const std::string& layer, std::size_t comparisons) {
  if (const Image* same_name = noise.find(layer)) return same_name;
  if (comparisons == 1 && noise.find("") != nullptr) return noise.find("");
  return find_layer(options.noise_path, noise, layer);
}

// Numbers that are not finite become null.
using Json = nlohmann::ordered_json;

void add_numbers(const Comparison& comparison, const std::string& prefix, Json& numbers) {
  const Metrics& m = comparison.metrics;
  const auto set = [&](const char* key, double value) { numbers[prefix + key] = value; };
  numbers[prefix + "pixels"] = m.pixels;
  numbers[prefix + "excluded_pixels"] = m.excluded;
  set("mean_a", m.mean_a);
  set("mean_b", m.mean_b);
  set("mean_ratio", m.mean_ratio);
  set("rmse", m.rmse);
  set("relative_rmse", m.relative_rmse);
  if (m.noise_corrected_relative_rmse) {
    set("noise_corrected_relative_rmse", *m.noise_corrected_relative_rmse);
  }
  set("block_ratio_first_percentile", m.blocks.first_percentile);
  set("block_ratio_last_percentile", m.blocks.last_percentile);
  set("darkest_spot", m.blocks.darkest_spot);
  set("brightest_spot", m.blocks.brightest_spot);
  set("relmse", m.relmse);
  set("max_error", m.max_error);
  set("peak", m.peak);
  set("psnr_db", m.psnr_db);
  set("ssim", m.ssim);
  set("flip", m.flip);
  if (m.hdr_flip) set("hdr_flip", *m.hdr_flip);
}

void print_json(const std::vector<Comparison>& comparisons) {
  Json numbers;
  for (const Comparison& comparison : comparisons) {
    const bool plain = comparisons.size() == 1 || comparison.name_a.empty();
    add_numbers(comparison, plain ? "" : comparison.name_a + ".", numbers);
  }
  std::printf("%s\n", numbers.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

std::string number_text(double value, const char* format) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void print_table(const std::vector<Comparison>& comparisons, bool noise) {
  struct Column {
    const char* title;
    const char* format;
    double (*value)(const Metrics&);
  };
  const Column columns[] = {
      {"mean A", "%.4g", [](const Metrics& m) { return m.mean_a; }},
      {"mean B", "%.4g", [](const Metrics& m) { return m.mean_b; }},
      {"A/B", "%.4f", [](const Metrics& m) { return m.mean_ratio; }},
      {"RMSE", "%.4g", [](const Metrics& m) { return m.rmse; }},
      {"RMSE/B", "%.4f", [](const Metrics& m) { return m.relative_rmse; }},
      {"less noise", "%.4f",
       [](const Metrics& m) { return m.noise_corrected_relative_rmse.value_or(kNothing); }},
      {"relMSE", "%.4g", [](const Metrics& m) { return m.relmse; }},
      {"max error", "%.4g", [](const Metrics& m) { return m.max_error; }},
      {"PSNR [dB]", "%.2f", [](const Metrics& m) { return m.psnr_db; }},
      {"SSIM", "%.4f", [](const Metrics& m) { return m.ssim; }},
      {"FLIP", "%.4f", [](const Metrics& m) { return m.flip; }},
      {"HDR-FLIP", "%.4f", [](const Metrics& m) { return m.hdr_flip.value_or(kNothing); }},
  };
  const auto shown = [&](const Column& column) {
    return noise || std::string(column.title) != "less noise";
  };
  constexpr int kNameColumns = 14, kNumberColumns = 11;

  std::printf("%-*s", kNameColumns, "layer");
  for (const Column& column : columns) {
    if (shown(column)) std::printf("%*s", kNumberColumns, column.title);
  }
  std::printf("\n");
  for (const Comparison& comparison : comparisons) {
    std::printf("%-*s", kNameColumns, layer_text(comparison.name_a).c_str());
    for (const Column& column : columns) {
      if (!shown(column)) continue;
      const std::string text = number_text(column.value(comparison.metrics), column.format);
      std::printf("%*s", kNumberColumns, text.c_str());
    }
    std::printf("\n");
  }
  for (const Comparison& comparison : comparisons) {
    if (comparison.metrics.excluded == 0) continue;
    std::printf("%s: %zu pixels left out, being NaN or infinite\n",
                layer_text(comparison.name_a).c_str(), comparison.metrics.excluded);
  }
}

/// The file of standard errors, and the number of layers that use it.
struct LayerNoise {
  const LayeredImage& image;
  std::size_t comparisons;
};

/// Compares one pair of layers, and adds its heat map to `pictures` if requested.
Expected<void> compare_layer(const CompareOptions& options, const LayeredImage& a,
                             const LayeredImage& b, const LayerNoise& noise, Comparison& comparison,
                             std::vector<Image>& pictures) {
  const Expected<const Image*> layer_a = find_layer(options.path_a, a, comparison.name_a);
  if (!layer_a) return tl::unexpected(layer_a.error());
  const Expected<const Image*> layer_b = find_layer(options.path_b, b, comparison.name_b);
  if (!layer_b) return tl::unexpected(layer_b.error());

  const bool display = is_display_file(options.path_a) && is_display_file(options.path_b);
  MetricsOptions how{options.block, options.scale, nullptr, display, is_picture(comparison.name_a)};
  if (!options.noise_path.empty()) {
    const Expected<const Image*> error =
        noise_of(options, noise.image, comparison.name_b, noise.comparisons);
    if (!error) return tl::unexpected(error.error());
    how.standard_error = *error;
  }
  const Expected<Metrics> metrics = compare_images(**layer_a, **layer_b, how);
  if (!metrics) {
    return fail(options.path_a, "layer " + layer_text(comparison.name_a),
                metrics.error().message());
  }
  comparison.metrics = *metrics;
  if (!options.heat_map_path.empty()) {
    pictures.push_back(heat_map(*match_images(**layer_a, **layer_b, options.scale), display));
  }
  return {};
}

Expected<void> compare(const CompareOptions& options) {
  if (!options.heat_map_path.empty()) {
    if (const auto fine = check_output(options.heat_map_path, {".png"}); !fine) return fine;
  }
  for (const std::string& path : {options.path_a, options.path_b, options.noise_path}) {
    if (path.empty()) continue;
    if (const auto fine = check_image_input(path); !fine) return fine;
  }
  CommandFiles files;
  files.reads(options.path_a, "image A");
  files.reads(options.path_b, "image B");
  files.reads(options.noise_path, "--noise");
  files.writes(options.heat_map_path, "--heatmap");
  if (const auto distinct = files.check(); !distinct) return distinct;
  begin_step("reading the images");
  const Expected<LayeredImage> a = read_image(options.path_a);
  if (!a) return tl::unexpected(a.error());
  const Expected<LayeredImage> b = read_image(options.path_b);
  if (!b) return tl::unexpected(b.error());
  LayeredImage noise;
  if (!options.noise_path.empty()) {
    Expected<LayeredImage> read = read_image(options.noise_path);
    if (!read) return tl::unexpected(read.error());
    noise = std::move(*read);
  }
  if (a->width != b->width || a->height != b->height) {
    const auto size = [](const LayeredImage& i) {
      return std::to_string(i.width) + "x" + std::to_string(i.height);
    };
    return fail(
        options.path_a, "",
        "the images differ in size: " + size(*a) + ", but " + options.path_b + " is " + size(*b));
  }

  const auto fits = check_comparison_memory({a->width, a->height}, available_memory());
  if (!fits) return fits;
  Expected<std::vector<Comparison>> comparisons = choose_layers(options, *a, *b);
  if (!comparisons) return tl::unexpected(comparisons.error());
  begin_step("comparing the images");
  std::vector<Image> pictures;
  for (Comparison& comparison : *comparisons) {
    const LayerNoise layer_noise{noise, comparisons->size()};
    if (const auto done = compare_layer(options, *a, *b, layer_noise, comparison, pictures);
        !done) {
      return done;
    }
  }

  if (!options.heat_map_path.empty()) {
    const Image picture = stack(pictures);
    if (const auto fine = make_folders(options.heat_map_path); !fine) return fine;
    if (const auto done = write_png(options.heat_map_path, picture); !done) return done;
    tell_written(options.heat_map_path, pixels_text(picture.width, picture.height));
  }
  if (options.json) {
    print_json(*comparisons);
  } else {
    print_table(*comparisons, !options.noise_path.empty());
  }
  return {};
}

}  // namespace

void add_compare(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("compare", "Measure how image A differs from reference B");
  command->group(kPictureGroup);
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->path_a, "Image: .exr, .hdr, .png or .jpg")->required();
  command->add_option("B", options->path_b, "Reference of the same size")->required();
  command
      ->add_option("--layer", options->layers,
                   "Layer to compare, or A_NAME=B_NAME; the whole picture's name is empty. May be "
                   "repeated (all layers that both files have)")
      ->allow_extra_args(false)
      ->type_name("L");
  command->add_flag("--json", options->json, "Print one flat JSON object in place of a table");
  command
      ->add_option("--heatmap", options->heat_map_path,
                   "PNG to write: signed relative error and FLIP, a row for each layer")
      ->check(file_name())
      ->type_name("FILE");
  command
      ->add_option("--block", options->block,
                   "Squared errors of the means of NxN pixels, not of single ones (1)")
      ->check(whole_number(1, kMaxBlock))
      ->type_name("N");
  command
      ->add_option("--noise", options->noise_path,
                   "Standard error of B per pixel (EXR): also print RMSE/B without B's noise")
      ->type_name("FILE");
  command->add_option("--scale", options->scale, "Factor on A before comparing (1)")
      ->check(number(-kMaxScale, kMaxScale))
      ->type_name("F");
  command->callback([options, &run] { run = [options] { return compare(*options); }; });
}

}  // namespace lambent::cli
