// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_output.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "core/atomic_file.h"
#include "core/image/exposure.h"
#include "core/image/tone_map.h"
#include "lambent/parse.h"

namespace lambent::cli {
namespace {

constexpr const char* kFramePlace = "####";
constexpr std::size_t kFrameDigits = 4;

}  // namespace

std::string frame_path(const std::string& pattern, int frame) {
  std::string number = std::to_string(frame);
  if (number.size() < kFrameDigits) number.insert(0, kFrameDigits - number.size(), '0');
  std::string path = pattern;
  if (const std::size_t at = path.rfind(kFramePlace); at != std::string::npos) {
    return path.replace(at, kFrameDigits, number);
  }
  return path.insert(path.rfind('.'), "." + number);
}

Expected<void> check_outputs(const RenderOptions& options) {
  const bool exr = has_ending(options.output, ".exr");
  if (!exr && !has_ending(options.output, ".png")) {
    return fail(options.output, "", "the output must end in .exr or .png");
  }
  if (options.layers && !exr) return fail("--layers", "", "layers need an .exr output");
  const std::string first = options.frames > 0 ? frame_path(options.output, 0) : options.output;
  for (const std::string& path : {first, options.stats}) {
    if (path.empty()) continue;
    if (const Expected<void> fine = check_writable(path); !fine) return fine;
  }
  return {};
}

Expected<std::optional<float>> parse_exposure(const std::string& text) {
  float stops = 0.0f;
  if (text == "auto") return std::optional<float>();
  if (!CLI::detail::lexical_cast(text, stops) || !std::isfinite(stops)) {
    return fail("--exposure", "", "'" + text + "' is neither auto nor a number of stops");
  }
  return std::optional<float>(stops);
}

Expected<void> write_output(const RenderOptions& options, const LayeredImage& image,
                            const std::string& path, std::optional<float>& stops) {
  const Image& picture = *image.find("");
  if (has_ending(path, ".exr")) {
    if (options.layers) return write_exr(path, image);
    LayeredImage whole{image.width, image.height, {{"", picture}}};
    return write_exr(path, whole);
  }
  if (!stops) stops = *parse_exposure(options.exposure);
  if (!stops) stops = static_cast<float>(std::log2(display_exposure(picture)));
  return write_png(path, display_image(picture, *tone_map_from_name(options.tone_map), *stops));
}

}  // namespace lambent::cli
