// SPDX-License-Identifier: Apache-2.0
// PNG, written by rows.
#include <png.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "core/files/atomic_file.h"
#include "core/image/codecs/formats.h"
#include "core/image/codecs/row_writers.h"

namespace lambent {
namespace {

constexpr int kBitsPerChannel = 8;

}  // namespace

/// libpng reports errors by longjmp, which runs no destructors: functions that call it must own
/// nothing.
struct PngWriter::State {
  State(AtomicFile to, int image_width, int image_height, int image_channels)
      : file(std::move(to)), width(image_width), height(image_height), channels(image_channels) {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
      png_destroy_write_struct(&png, nullptr);
      throw std::bad_alloc();
    }
    png_set_write_fn(png, this, write_bytes, flush);
  }
  ~State() { png_destroy_write_struct(&png, &info); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  static void write_bytes(png_structp png, png_bytep data, std::size_t count) {
    auto& state = *static_cast<State*>(png_get_io_ptr(png));
    if (!state.take(std::as_bytes(std::span(data, count)))) png_error(png, "");
  }
  bool take(std::span<const std::byte> bytes) {
    const Expected<void> done = file.write(bytes);
    if (!done) failure = done.error();
    return done.has_value();
  }
  static void flush(png_structp) {}
  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    auto& state = *static_cast<State*>(png_get_error_ptr(png));
    state.note(message);
    std::longjmp(state.jump, 1);
  }
  void note(const char* message) {
    if (failure) return;
    failure = Error{file.path(), "", std::string("cannot encode the PNG: ") + message,
                    Error::Kind::failed};
  }
  static void on_warning(png_structp, png_const_charp) {}

  bool begin() {
    if (setjmp(jump) != 0) return false;
    png_set_user_limits(png, kMaxImageSide, kMaxImageSide);
    const int color = channels == 1   ? PNG_COLOR_TYPE_GRAY
                      : channels == 3 ? PNG_COLOR_TYPE_RGB
                                      : PNG_COLOR_TYPE_RGB_ALPHA;
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
                 kBitsPerChannel, color, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    return true;
  }
  bool add_row(const std::uint8_t* bytes) {
    if (setjmp(jump) != 0) return false;
    png_write_row(png, bytes);
    return true;
  }
  bool end() {
    if (setjmp(jump) != 0) return false;
    png_write_end(png, info);
    return true;
  }

  AtomicFile file;
  int width, height, channels;
  int next_row = 0;
  std::vector<std::uint8_t> row;
  std::optional<Error> failure;
  std::jmp_buf jump{};
  png_structp png = nullptr;
  png_infop info = nullptr;
};

PngWriter::PngWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
PngWriter::PngWriter(PngWriter&&) noexcept = default;
PngWriter::~PngWriter() = default;

Expected<PngWriter> PngWriter::open(const std::string& path, int width, int height, int channels) {
  if (const auto ok = check_image_sides(path, width, height, channels); !ok) {
    return tl::unexpected(ok.error());
  }
  if (channels != 1 && channels != 3 && channels != 4) {
    return fail(path, "", "a PNG has 1, 3 or 4 channels, not " + std::to_string(channels));
  }
  Expected<AtomicFile> file = AtomicFile::open(path);
  if (!file) return tl::unexpected(file.error());
  auto state = std::make_unique<State>(std::move(*file), width, height, channels);
  if (!state->begin()) return tl::unexpected(*state->failure);
  return PngWriter(std::move(state));
}

Expected<void> PngWriter::write(const Image& image) {
  State& s = *state_;
  assert(image.width == s.width && image.channels == s.channels);
  assert(s.next_row + image.height <= s.height);
  s.row.resize(static_cast<std::size_t>(image.width) * image.channels);
  for (int y = 0; y < image.height; ++y) {
    const float* in = image.at(0, y);
    std::transform(in, in + s.row.size(), s.row.begin(), quantise);
    if (!s.add_row(s.row.data())) return tl::unexpected(*s.failure);
  }
  s.next_row += image.height;
  return {};
}

Expected<void> PngWriter::finish() {
  State& s = *state_;
  assert(s.next_row == s.height);
  if (!s.end()) return tl::unexpected(*s.failure);
  return s.file.commit();
}

Expected<void> write_png(const std::string& path, const Image& display_encoded) {
  if (const auto fine = check_pixels_fill_size(path, display_encoded); !fine) return fine;
  Expected<PngWriter> file = PngWriter::open(path, display_encoded.width, display_encoded.height,
                                             display_encoded.channels);
  if (!file) return tl::unexpected(file.error());
  if (const auto written = file->write(display_encoded); !written) return written;
  return file->finish();
}

}  // namespace lambent
