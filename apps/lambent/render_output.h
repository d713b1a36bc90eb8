// SPDX-License-Identifier: Apache-2.0
// The files that `lambent render` writes.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "core/image/codecs/row_writers.h"
#include "core/image/exposure.h"
#include "lambent/error.h"
#include "lambent/image.h"
#include "lambent/render_options.h"

namespace lambent::cli {

/// Fails early on outputs that could not be written after minutes of work.
Expected<void> check_outputs(const RenderOptions& options);

/// Digits of a frame's number in its file's name, at least.
inline constexpr std::size_t kFrameDigits = 4;

/// Where a frame of a sequence goes: its number, of four digits or more, replaces the #### in the
/// pattern's file name; where there is none, it stands before the ending.
std::string frame_path(const std::string& pattern, int frame);

inline std::size_t pixels_of(const glm::ivec2& size) {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

/// Whether a picture is rendered and written some rows at a time, because it has many pixels and
/// the method can.
bool made_in_bands(const RenderOptions& options, const glm::ivec2& size);
/// How many rows at a time.
int rows_of_a_band(const RenderOptions& options, const glm::ivec2& size);
/// Whether all rows of such a picture are kept until its exposure is known.
bool keeps_all_rows(const RenderOptions& options, const glm::ivec2& size);

/// A picture's file, written from the top, some rows at a time or all at once.
class PictureFile {
 public:
  /// The options and `stops` must outlive it. `stops` is the exposure of a .png or .jpg; none: it
  /// is set to what the options ask for, so that the pictures of a sequence share one.
  PictureFile(const RenderOptions& options, std::string path, const glm::ivec2& size,
              std::optional<float>& stops);

  /// Whether the stops must be known before the first row, for want of memory to keep all rows.
  bool needs_stops() const;
  /// The next rows.
  Expected<void> write(const LayeredImage& rows);
  /// After the last row. Without it there is no file.
  Expected<void> finish();

 private:
  Expected<void> write_exr_rows(const LayeredImage& rows);
  Expected<void> show(const Image& rows);
  Expected<void> add(const Image& shown);

  const RenderOptions& options_;
  std::string path_;
  glm::ivec2 size_;
  std::optional<float>& stops_;
  std::optional<ExrWriter> exr_;
  std::optional<PngWriter> png_;
  std::optional<JpegWriter> jpeg_;
  Image kept_;                     // rows that wait for the stops
  LuminanceHistogram luminances_;  // of these
};

}  // namespace lambent::cli
