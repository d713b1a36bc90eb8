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

/// The path of a frame of a sequence: its number, with at least four digits, replaces the #### in
/// the pattern's file name, or is inserted before the ending if there is none.
std::string frame_path(const std::string& pattern, int frame);

inline std::size_t pixels_of(const glm::ivec2& size) {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

/// Whether a picture is rendered and written some rows at a time, because it has many pixels and
/// the method supports it.
bool made_in_bands(const RenderOptions& options, const glm::ivec2& size);
/// The number of rows at a time.
int rows_of_a_band(const RenderOptions& options, const glm::ivec2& size);
/// Whether all rows of such a picture are stored until its exposure is known.
bool keeps_all_rows(const RenderOptions& options, const glm::ivec2& size);

/// A picture's file, written from the top, some rows at a time or all at once.
class PictureFile {
 public:
  /// The options and `stops` must outlive it. `stops` is the exposure of a .png or .jpg. If it is
  /// none, it is set by the options, so that the pictures of a sequence share one exposure.
  PictureFile(const RenderOptions& options, std::string path, const glm::ivec2& size,
              std::optional<float>& stops);

  /// Whether the stops must be known before the first row, since all rows would take too much
  /// memory.
  bool needs_stops() const;
  /// Writes the next rows.
  Expected<void> write(const LayeredImage& rows);
  /// Completes the file after the last row. Without this call there is no file.
  Expected<void> finish();

 private:
  Expected<void> write_exr_rows(const LayeredImage& rows);
  Expected<void> show(const Image& rows);
  Expected<void> show_rows(const Image& rows, int first, int end);
  Expected<void> add(const Image& shown);

  const RenderOptions& options_;
  std::string path_;
  glm::ivec2 size_;
  std::optional<float>& stops_;
  std::optional<ExrWriter> exr_;
  std::optional<PngWriter> png_;
  std::optional<JpegWriter> jpeg_;
  bool black_ = true;              // all rows so far
  Image kept_;                     // rows stored until the stops are known
  Image waiting_;                  // the last row, which is not shown yet, and the one above it
  LuminanceHistogram luminances_;  // of the stored rows
};

}  // namespace lambent::cli
