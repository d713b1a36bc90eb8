// SPDX-License-Identifier: Apache-2.0
// Image files that are written some rows at a time, from the top, so that no whole picture need be
// in memory. The bytes do not depend on how the rows are dealt out. Without finish() there is no
// file (see AtomicFile).
#pragma once

#include <memory>
#include <string>

#include "lambent/image.h"

namespace lambent {

/// 32-bit float EXR, as write_exr makes it.
class ExrWriter {
 public:
  /// Begins a file of that height, with the width, layers and channels of `like`.
  static Expected<ExrWriter> open(const std::string& path, const LayeredImage& like, int height);
  ExrWriter(ExrWriter&&) noexcept;
  ~ExrWriter();

  /// The next rows; of the layers that the file began with, those alone.
  Expected<void> write(const LayeredImage& rows);
  /// After the last row.
  Expected<void> finish();

 private:
  struct State;
  explicit ExrWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// 8-bit PNG, as write_png makes it.
class PngWriter {
 public:
  /// Begins a file of that size; 1, 3 or 4 channels.
  static Expected<PngWriter> open(const std::string& path, int width, int height, int channels);
  PngWriter(PngWriter&&) noexcept;
  ~PngWriter();

  /// The next rows, encoded for display.
  Expected<void> write(const Image& display_encoded);
  /// After the last row.
  Expected<void> finish();

 private:
  struct State;
  explicit PngWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// 8-bit JPEG, as write_jpeg makes it.
class JpegWriter {
 public:
  /// Begins a file of that size.
  static Expected<JpegWriter> open(const std::string& path, int width, int height,
                                   int quality = kJpegQuality);
  JpegWriter(JpegWriter&&) noexcept;
  ~JpegWriter();

  /// The next rows, encoded for display: 1, 3 or 4 channels.
  Expected<void> write(const Image& display_encoded);
  /// After the last row.
  Expected<void> finish();

 private:
  struct State;
  explicit JpegWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lambent
