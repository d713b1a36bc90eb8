// SPDX-License-Identifier: Apache-2.0
// Image files that are written some rows at a time, from the top, so that the whole picture need
// not be in memory. The bytes do not depend on how the rows are divided into calls. Without
// finish() there is no file (see AtomicFile).
#pragma once

#include <memory>
#include <string>

#include "lambent/image.h"

namespace lambent {

/// Writes 32-bit float EXR; see write_exr.
class ExrWriter {
 public:
  /// Begins a file of that height, with the width, layers and channels of `like`.
  static Expected<ExrWriter> open(const std::string& path, const LayeredImage& like, int height);
  ExrWriter(ExrWriter&&) noexcept;
  ~ExrWriter();

  /// Writes the next rows. Only the layers with which the file was opened are written.
  Expected<void> write(const LayeredImage& rows);
  /// Completes the file; call it after the last row.
  Expected<void> finish();

 private:
  struct State;
  explicit ExrWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes 8-bit PNG; see write_png.
class PngWriter {
 public:
  /// Begins a file of that size; 1, 3 or 4 channels.
  static Expected<PngWriter> open(const std::string& path, int width, int height, int channels);
  PngWriter(PngWriter&&) noexcept;
  ~PngWriter();

  /// Writes the next rows, encoded for display.
  Expected<void> write(const Image& display_encoded);
  /// Completes the file; call it after the last row.
  Expected<void> finish();

 private:
  struct State;
  explicit PngWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes 8-bit JPEG; see write_jpeg.
class JpegWriter {
 public:
  /// Begins a file of that size.
  static Expected<JpegWriter> open(const std::string& path, int width, int height,
                                   int quality = kJpegQuality);
  JpegWriter(JpegWriter&&) noexcept;
  ~JpegWriter();

  /// Writes the next rows, encoded for display: 1, 3 or 4 channels.
  Expected<void> write(const Image& display_encoded);
  /// Completes the file; call it after the last row.
  Expected<void> finish();

 private:
  struct State;
  explicit JpegWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lambent
