// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_output.h"

#include <cmath>

#include "core/image/exposure.h"
#include "core/image/tone_map.h"
#include "lambent/output.h"
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
  const auto fine = check_output(options.output, {".png", ".jpg", ".jpeg", ".exr"});
  if (!fine) return fine;
  const bool exr = has_ending(options.output, ".exr");
  if (options.layers && !exr) {
    return fail("--layers", "", "go into an .exr alone: add -o FILE.exr");
  }
  const std::string first = options.frames > 0 ? frame_path(options.output, 0) : options.output;
  for (const std::string& path : {first, options.stats}) {
    if (path.empty()) continue;
    if (const Expected<void> place = check_place(path); !place) return place;
  }
  return {};
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
  const Image shown = display_image(picture, *tone_map_from_name(options.tone_map), *stops);
  return has_ending(path, ".png") ? write_png(path, shown) : write_jpeg(path, shown);
}

}  // namespace lambent::cli
