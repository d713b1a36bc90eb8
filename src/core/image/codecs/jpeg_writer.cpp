// SPDX-License-Identifier: Apache-2.0
// JPEG, written by rows with libjpeg: well maintained for decades (libjpeg-turbo), and it accepts
// single rows, unlike stb_image_write.
#include <algorithm>
#include <array>
#include <cassert>
#include <csetjmp>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include <jpeglib.h>

#include "core/files/atomic_file.h"
#include "core/image/codecs/formats.h"
#include "core/image/codecs/row_writers.h"

namespace lambent {
namespace {

constexpr int kChannels = 3;
// Chroma is sampled at every pixel from this quality on: otherwise fringes of red and blue edges
// would be the first visible artefact.
constexpr int kFullColourQuality = 90;
// Size of libjpeg's output buffer [bytes].
constexpr std::size_t kBufferBytes = 1 << 16;

}  // namespace

/// libjpeg reports errors by longjmp, which runs no destructors: functions that call it must own
/// nothing.
struct JpegWriter::State {
  State(AtomicFile to, int image_width, int image_height)
      : file(std::move(to)), width(image_width), height(image_height) {
    row.resize(static_cast<std::size_t>(width) * kChannels);
    encoder.err = jpeg_std_error(&errors);
    encoder.client_data = this;
    errors.error_exit = on_error;
    errors.output_message = [](j_common_ptr) {};
    destination.init_destination = [](j_compress_ptr) {};
    destination.empty_output_buffer = on_full;
    destination.term_destination = on_end;
    rewind();
  }
  ~State() { jpeg_destroy_compress(&encoder); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  static State& of(j_common_ptr encoder) { return *static_cast<State*>(encoder->client_data); }
  [[noreturn]] static void on_error(j_common_ptr encoder) {
    of(encoder).note();
    std::longjmp(of(encoder).jump, 1);
  }
  static boolean on_full(j_compress_ptr encoder) {
    auto* common = reinterpret_cast<j_common_ptr>(encoder);
    if (!of(common).send(kBufferBytes)) on_error(common);
    return TRUE;
  }
  static void on_end(j_compress_ptr encoder) {
    auto* common = reinterpret_cast<j_common_ptr>(encoder);
    if (!of(common).send(kBufferBytes - of(common).destination.free_in_buffer)) on_error(common);
  }
  void rewind() {
    destination.next_output_byte = buffer.data();
    destination.free_in_buffer = buffer.size();
  }
  bool send(std::size_t count) {
    const Expected<void> done = file.write(std::as_bytes(std::span(buffer.data(), count)));
    if (!done) failure = done.error();
    rewind();
    return done.has_value();
  }
  void note() {
    if (failure) return;
    std::array<char, JMSG_LENGTH_MAX> text{};
    errors.format_message(reinterpret_cast<j_common_ptr>(&encoder), text.data());
    failure = Error{file.path(), "", std::string("cannot encode the JPEG: ") + text.data(),
                    Error::Kind::failed};
  }

  bool begin(int quality) {
    if (setjmp(jump) != 0) return false;
    jpeg_create_compress(&encoder);
    encoder.client_data = this;
    encoder.dest = &destination;
    encoder.image_width = static_cast<JDIMENSION>(width);
    encoder.image_height = static_cast<JDIMENSION>(height);
    encoder.input_components = kChannels;
    encoder.in_color_space = JCS_RGB;
    jpeg_set_defaults(&encoder);
    jpeg_set_quality(&encoder, quality, TRUE);
    if (quality >= kFullColourQuality) {
      encoder.comp_info[0].h_samp_factor = 1;
      encoder.comp_info[0].v_samp_factor = 1;
    }
    jpeg_start_compress(&encoder, TRUE);
    return true;
  }
  bool add_row() {
    if (setjmp(jump) != 0) return false;
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&encoder, rows, 1);
    return true;
  }
  bool end() {
    if (setjmp(jump) != 0) return false;
    jpeg_finish_compress(&encoder);
    return true;
  }

  AtomicFile file;
  int width, height;
  std::vector<JSAMPLE> row;
  std::array<JOCTET, kBufferBytes> buffer;
  std::optional<Error> failure;
  std::jmp_buf jump{};
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  jpeg_destination_mgr destination{};
};

JpegWriter::JpegWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
JpegWriter::JpegWriter(JpegWriter&&) noexcept = default;
JpegWriter::~JpegWriter() = default;

Expected<JpegWriter> JpegWriter::open(const std::string& path, int width, int height, int quality) {
  if (const auto ok = check_image_sides(path, width, height, kChannels); !ok) {
    return tl::unexpected(ok.error());
  }
  if (width > JPEG_MAX_DIMENSION || height > JPEG_MAX_DIMENSION) {
    return fail(path, "",
                "a JPEG has at most " + std::to_string(JPEG_MAX_DIMENSION) + " pixels a side");
  }
  if (quality < 1 || quality > 100) {
    return fail(path, "", "a JPEG's quality is 1 to 100, not " + std::to_string(quality));
  }
  Expected<AtomicFile> file = AtomicFile::open(path);
  if (!file) return tl::unexpected(file.error());
  auto state = std::make_unique<State>(std::move(*file), width, height);
  if (!state->begin(quality)) return tl::unexpected(*state->failure);
  return JpegWriter(std::move(state));
}

Expected<void> JpegWriter::write(const Image& image) {
  State& s = *state_;
  assert(image.width == s.width);
  assert(image.channels == 1 || image.channels == 3 || image.channels == 4);
  for (int y = 0; y < image.height; ++y) {
    const float* pixel = image.at(0, y);
    for (int x = 0; x < image.width; ++x, pixel += image.channels) {
      for (int c = 0; c < kChannels; ++c) {
        s.row[static_cast<std::size_t>(x) * kChannels + c] =
            quantise(pixel[image.channels > 1 ? c : 0]);
      }
    }
    if (!s.add_row()) return tl::unexpected(*s.failure);
  }
  return {};
}

Expected<void> JpegWriter::finish() {
  State& s = *state_;
  if (!s.end()) return tl::unexpected(*s.failure);
  return s.file.commit();
}

Expected<void> write_jpeg(const std::string& path, const Image& display_encoded, int quality) {
  if (const auto fine = check_pixels_fill_size(path, display_encoded); !fine) return fine;
  const int channels = display_encoded.channels;
  if (channels != 1 && channels != 3 && channels != 4) {
    return fail(path, "", "a JPEG is made of 1, 3 or 4 channels, not " + std::to_string(channels));
  }
  Expected<JpegWriter> file =
      JpegWriter::open(path, display_encoded.width, display_encoded.height, quality);
  if (!file) return tl::unexpected(file.error());
  if (const auto written = file->write(display_encoded); !written) return written;
  return file->finish();
}

}  // namespace lambent
