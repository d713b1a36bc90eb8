// SPDX-License-Identifier: Apache-2.0
// JPEG by libjpeg: kept well for decades (libjpeg-turbo), fast, and fed row by row, so that a large
// picture needs no copy in bytes. (stb_image_write takes the whole picture at once and writes files
// that are larger at equal quality, for it has fixed Huffman tables.)
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

#include "core/image/formats.h"

namespace lambent {
namespace {

constexpr int kChannels = 3;
// Chroma is sampled at every pixel from this quality on: fringes of red and blue edges would show
// before anything else does.
constexpr int kFullColourQuality = 90;

/// libjpeg's way of reporting errors, and where to go on after one.
struct ErrorManager {
  jpeg_error_mgr base;
  std::jmp_buf escape;
};

void leave(j_common_ptr encoder) {
  std::longjmp(reinterpret_cast<ErrorManager*>(encoder->err)->escape, 1);
}

void say_nothing(j_common_ptr) {}

/// The encoded file in memory of libjpeg's.
struct Encoded {
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  Encoded() = default;
  Encoded(const Encoded&) = delete;
  Encoded& operator=(const Encoded&) = delete;
  ~Encoded() { std::free(bytes); }
};

void quantise_row(const Image& image, int y, std::vector<JSAMPLE>& row) {
  const float* pixel = image.at(0, y);
  for (int x = 0; x < image.width; ++x, pixel += image.channels) {
    for (int c = 0; c < kChannels; ++c) {
      row[static_cast<std::size_t>(x) * kChannels + c] =
          quantise(pixel[image.channels > 1 ? c : 0]);
    }
  }
}

/// False where libjpeg failed. An error jumps out of it and back to here: nothing that is made
/// between both may have a destructor.
bool encode(const Image& image, int quality, std::vector<JSAMPLE>& row, Encoded& encoded) {
  jpeg_compress_struct encoder;
  ErrorManager errors;
  encoder.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = leave;
  errors.base.output_message = say_nothing;
  if (setjmp(errors.escape) != 0) {
    jpeg_destroy_compress(&encoder);
    return false;
  }
  jpeg_create_compress(&encoder);
  jpeg_mem_dest(&encoder, &encoded.bytes, &encoded.size);
  encoder.image_width = static_cast<JDIMENSION>(image.width);
  encoder.image_height = static_cast<JDIMENSION>(image.height);
  encoder.input_components = kChannels;
  encoder.in_color_space = JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, quality, TRUE);
  encoder.optimize_coding = TRUE;
  if (quality >= kFullColourQuality) {
    encoder.comp_info[0].h_samp_factor = 1;
    encoder.comp_info[0].v_samp_factor = 1;
  }
  jpeg_start_compress(&encoder, TRUE);
  JSAMPROW rows[] = {row.data()};
  while (encoder.next_scanline < encoder.image_height) {
    quantise_row(image, static_cast<int>(encoder.next_scanline), row);
    jpeg_write_scanlines(&encoder, rows, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  return true;
}

}  // namespace

Expected<std::vector<std::byte>> encode_jpeg(const std::string& path, const Image& image,
                                             int quality) {
  if (const auto ok = check_image_size(path, image.width, image.height, image.channels); !ok) {
    return tl::unexpected(ok.error());
  }
  if (image.width > JPEG_MAX_DIMENSION || image.height > JPEG_MAX_DIMENSION) {
    return fail(path, "", "a JPEG has at most 65500 pixels a side");
  }
  if (image.channels != 1 && image.channels != 3 && image.channels != 4) {
    return fail(path, "",
                "a JPEG is made of 1, 3 or 4 channels, not " + std::to_string(image.channels));
  }
  if (quality < 1 || quality > 100) {
    return fail(path, "", "a JPEG's quality is 1 to 100, not " + std::to_string(quality));
  }
  std::vector<JSAMPLE> row(static_cast<std::size_t>(image.width) * kChannels);
  Encoded encoded;
  if (!encode(image, quality, row, encoded)) {
    return fail(path, "", "not enough memory to encode the JPEG", Error::Kind::failed);
  }
  const auto* first = reinterpret_cast<const std::byte*>(encoded.bytes);
  return std::vector<std::byte>(first, first + encoded.size);
}

}  // namespace lambent
