// SPDX-License-Identifier: Apache-2.0
// lambent picture: a layer of an EXR as a display shows it.
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <string>

#include "core/image/exposure.h"
#include "core/image/tone_map.h"
#include "lambent/commands.h"
#include "lambent/image.h"
#include "lambent/parse.h"

namespace lambent::cli {
namespace {

struct Options {
  std::string input;
  std::string output;
  std::string layer;
  std::string exposure = "auto";
  std::string tone_map = "aces";
};

Expected<void> picture(const Options& options) {
  if (const Expected<void> fine = check_output(options.output, ".png"); !fine) return fine;
  const Expected<LayeredImage> file = read_image(options.input);
  if (!file) return tl::unexpected(file.error());
  const Image* layer = file->find(options.layer);
  if (layer == nullptr) return fail(options.input, "layer " + options.layer, "not in the file");

  float stops = 0.0f;
  if (options.exposure == "auto") {
    stops = static_cast<float>(std::log2(display_exposure(*layer)));
  } else if (!CLI::detail::lexical_cast(options.exposure, stops) || !std::isfinite(stops)) {
    return fail("--exposure", "",
                "'" + options.exposure + "' is neither auto nor a number of stops");
  }
  return write_png(options.output,
                   display_image(*layer, *tone_map_from_name(options.tone_map), stops));
}

}  // namespace

void add_picture(CLI::App& app, Run& run) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("picture", "Show a layer of an image as a .png");
  command->add_option("image", o->input, "Image: .exr, .hdr, .png or .jpg")->required();
  command->add_option("-o,--output", o->output, "The .png file to write")->required();
  command->add_option("--layer", o->layer, "Layer to show (the whole picture)");
  command->add_option("--exposure", o->exposure, "In stops, or auto")->capture_default_str();
  command->add_option("--tone-map", o->tone_map, "aces, neutral or linear")
      ->check(CLI::IsMember({"aces", "neutral", "linear"}))
      ->capture_default_str();
  command->callback([o, &run] { run = [o] { return picture(*o); }; });
}

}  // namespace lambent::cli
