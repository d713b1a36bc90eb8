// SPDX-License-Identifier: Apache-2.0
// lambent picture: converts a layer of an EXR to a display-encoded picture.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "core/image/exposure.h"
#include "core/image/tone_map.h"
#include "lambent/command_files.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/help.h"
#include "lambent/image.h"
#include "lambent/input.h"
#include "lambent/layers.h"
#include "lambent/output.h"
#include "lambent/parse.h"
#include "lambent/step.h"
#include "lambent/validators.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

struct PictureOptions {
  std::string input;
  std::string output;
  std::string layer;
  std::string exposure = "auto";
  std::string tone_map = "aces";
};

Expected<void> picture(const PictureOptions& options) {
  if (const Expected<void> fine = check_output(options.output, kPictureEndings); !fine) return fine;
  CommandFiles files;
  files.reads(options.input, "the image");
  files.writes(options.output, "-o");
  if (const auto distinct = files.check(); !distinct) return distinct;
  const auto asked_stops = parse_exposure(options.exposure);
  if (!asked_stops) return tl::unexpected(asked_stops.error());
  if (const Expected<void> fine = check_image_input(options.input); !fine) return fine;
  begin_step("reading the image");
  const Expected<LayeredImage> file = read_image(options.input);
  if (!file) return tl::unexpected(file.error());
  const Expected<const Image*> layer = find_layer(options.input, *file, options.layer);
  if (!layer) return tl::unexpected(layer.error());

  begin_step("encoding the picture");
  const auto suits = [&] {
    return *layer == file->find("") ? display_stops(*file) : display_stops(**layer);
  };
  const float stops = *asked_stops ? **asked_stops : suits();
  const Edges edges = is_picture(options.layer) ? Edges::smooth : Edges::as_averaged;
  const Image shown = display_image(**layer, *tone_map_from_name(options.tone_map), stops, edges);
  if (const Expected<void> fine = make_folders(options.output); !fine) return fine;
  const bool png = has_ending(options.output, ".png");
  const auto done = png ? write_png(options.output, shown) : write_jpeg(options.output, shown);
  if (!done) return done;
  tell_written(options.output, pixels_text(shown.width, shown.height), exposure_text(stops));
  return {};
}

}  // namespace

void add_picture(CLI::App& app, Run& run) {
  const auto o = std::make_shared<PictureOptions>();
  CLI::App* command = app.add_subcommand("picture", "Show a layer of an image as a display does");
  command->group(kPictureGroup);
  command->add_option("IMAGE", o->input, "Image: .exr, .hdr, .png or .jpg")->required();
  command->add_option("-o,--output", o->output, "The .png or .jpg file to write")
      ->required()
      ->check(file_name())
      ->type_name("FILE");
  command->add_option("--layer", o->layer, "Layer to show (the whole picture)")->type_name("L");
  command->add_option("--exposure", o->exposure, "In stops, or auto")
      ->capture_default_str()
      ->type_name("E");
  command->add_option("--tone-map", o->tone_map, "aces, neutral or linear")
      ->check(one_of({"aces", "neutral", "linear"}))
      ->capture_default_str()
      ->type_name("T");
  command->callback([o, &run] { run = [o] { return picture(*o); }; });
}

}  // namespace lambent::cli
