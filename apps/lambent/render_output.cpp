// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_output.h"

#include <algorithm>
#include <utility>

#include "core/image/tone_map.h"
#include "lambent/command_files.h"
#include "lambent/console.h"
#include "lambent/output.h"
#include "lambent/parse.h"
#include "lambent/quality.h"

namespace lambent::cli {
namespace {

constexpr const char* kFramePlace = "####";

/// Pixels that are rendered and written at a time: about 120 MB with all layers, and enough work
/// for all cores.
constexpr std::size_t kBandPixels = std::size_t{1} << 20;
/// Pixels at a time for filtered pictures, where each band also needs rows of its neighbours: about
/// 1 GB.
constexpr std::size_t kFilteredBandPixels = std::size_t{1} << 21;
/// Pictures with at most this many pixels are stored until their exposure is known (400 MB, an 8K
/// frame); for larger ones, it is found from a small picture of the same view.
constexpr std::size_t kKeptPixels = std::size_t{1} << 25;

std::size_t band_pixels(const RenderOptions& options) {
  return is_filtered(options) ? kFilteredBandPixels : kBandPixels;
}

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
  const auto fine = check_output(options.output, kFrameEndings);
  if (!fine) return fine;
  if (const auto can = check_layers(options.layers, options.output); !can) return can;
  const std::string first = options.frames > 0 ? frame_path(options.output, 0) : options.output;
  for (const std::string& path : {first, options.stats}) {
    if (path.empty()) continue;
    if (const Expected<void> place = check_place(path); !place) return place;
  }
  CommandFiles files;
  files.reads_scene(options.scene.file);
  files.reads(options.scene.light.environment, "--environment");
  files.reads(options.field_file, "--field");
  if (options.frames > 0) {
    files.writes_frames(options.output, options.frames, "-o");
  } else {
    files.writes(options.output, "-o");
  }
  files.writes(options.stats, "--stats");
  return files.check();
}

bool made_in_bands(const RenderOptions& options, const glm::ivec2& size) {
  const bool can = (options.method == "field" || options.method == "direct") &&
                   options.show_probes.empty() && options.verify_samples == 0 && !uses_taa(options);
  return can && pixels_of(size) > band_pixels(options);
}

int rows_of_a_band(const RenderOptions& options, const glm::ivec2& size) {
  return std::max(1, static_cast<int>(band_pixels(options) / static_cast<std::size_t>(size.x)));
}

bool keeps_all_rows(const RenderOptions& options, const glm::ivec2& size) {
  return !has_ending(options.output, ".exr") && pixels_of(size) <= kKeptPixels &&
         !*parse_exposure(options.exposure);
}

PictureFile::PictureFile(const RenderOptions& options, std::string path, const glm::ivec2& size,
                         std::optional<float>& stops)
    : options_(options), path_(std::move(path)), size_(size), stops_(stops) {
  if (!stops_) stops_ = *parse_exposure(options.exposure);
}

bool PictureFile::needs_stops() const {
  return !stops_ && !has_ending(path_, ".exr") && pixels_of(size_) > kKeptPixels;
}

Expected<void> PictureFile::write(const LayeredImage& rows) {
  black_ = black_ && std::ranges::all_of(rows.find("")->pixels, [](float v) { return v == 0.0f; });
  if (!has_ending(path_, ".exr")) {
    const Image& picture = *rows.find("");
    if (stops_) return show(picture);
    if (kept_.empty()) {
      kept_ = Image(size_.x, 0, picture.channels);
      kept_.pixels.reserve(pixels_of(size_) * static_cast<std::size_t>(picture.channels));
    }
    luminances_.add(rows);
    kept_.height += picture.height;
    kept_.pixels.insert(kept_.pixels.end(), picture.pixels.begin(), picture.pixels.end());
    return {};
  }
  if (options_.layers) return write_exr_rows(rows);
  return write_exr_rows({rows.width, rows.height, {{"", *rows.find("")}}});
}

Expected<void> PictureFile::write_exr_rows(const LayeredImage& rows) {
  if (!exr_) {
    Expected<ExrWriter> opened = ExrWriter::open(path_, rows, size_.y);
    if (!opened) return tl::unexpected(opened.error());
    exr_.emplace(std::move(*opened));
  }
  return exr_->write(rows);
}

/// Adds rows to the .png or .jpg, and opens the file with the first rows.
Expected<void> PictureFile::add(const Image& shown) {
  if (has_ending(path_, ".png")) {
    if (!png_) {
      Expected<PngWriter> opened = PngWriter::open(path_, size_.x, size_.y, shown.channels);
      if (!opened) return tl::unexpected(opened.error());
      png_.emplace(std::move(*opened));
    }
    return png_->write(shown);
  }
  if (!jpeg_) {
    Expected<JpegWriter> opened = JpegWriter::open(path_, size_.x, size_.y);
    if (!opened) return tl::unexpected(opened.error());
    jpeg_.emplace(std::move(*opened));
  }
  return jpeg_->write(shown);
}

/// Writes the rows from `first` on, up to `end`, encoded for display.
Expected<void> PictureFile::show_rows(const Image& rows, int first, int end) {
  const ToneMap tone_map = *tone_map_from_name(options_.tone_map);
  const int at_once = rows_of_a_band(options_, size_);
  for (; first < end; first += at_once) {
    const int count = std::min(at_once, end - first);
    if (const auto written = add(display_rows(rows, first, count, tone_map, *stops_)); !written) {
      return written;
    }
  }
  return {};
}

/// Writes rows but for the last one, which is shown once the row below it is there.
Expected<void> PictureFile::show(const Image& rows) {
  const int before = waiting_.height;  // the last row, and the one above it, that was shown
  waiting_.width = rows.width;
  waiting_.height += rows.height;
  waiting_.channels = rows.channels;
  waiting_.pixels.insert(waiting_.pixels.end(), rows.pixels.begin(), rows.pixels.end());
  const int last = waiting_.height - 1;
  if (const auto shown = show_rows(waiting_, std::max(before - 1, 0), last); !shown) return shown;
  const int kept = std::min(waiting_.height, 2);
  Image next(rows.width, kept, rows.channels);
  std::copy_n(waiting_.at(0, waiting_.height - kept), next.pixels.size(), next.pixels.begin());
  waiting_ = std::move(next);
  return {};
}

Expected<void> PictureFile::finish() {
  // A frame of a sequence may be black on purpose
  if (black_ && options_.frames == 0) {
    warn("the picture is black: no light reaches what the camera sees");
  }
  if (exr_) return exr_->finish();
  if (!kept_.empty()) {
    stops_ = luminances_.stops();
    if (const auto shown = show_rows(kept_, 0, kept_.height); !shown) return shown;
  } else if (!waiting_.empty()) {
    const int last = waiting_.height - 1;
    if (const auto shown = show_rows(waiting_, last, last + 1); !shown) return shown;
  }
  return png_ ? png_->finish() : jpeg_->finish();
}

}  // namespace lambent::cli
