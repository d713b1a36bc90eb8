// SPDX-License-Identifier: Apache-2.0
// Reads and writes image files of any format.
#include <new>

#include "core/files/file_bytes.h"
#include "core/image/codecs/formats.h"
#include "core/memory.h"

namespace lambent {

namespace {

/// For smaller images [bytes], the available memory is not checked.
constexpr std::uint64_t kLargeBytes = std::uint64_t{1} << 28;

std::string shape_of(std::int64_t width, std::int64_t height, std::int64_t channels) {
  return std::to_string(width) + "x" + std::to_string(height) + " pixels, " +
         std::to_string(channels) + " channels";
}

}  // namespace

Expected<void> check_image_sides(const std::string& path, std::int64_t width, std::int64_t height,
                                 std::int64_t channels) {
  const std::string shape = shape_of(width, height, channels);
  if (width <= 0 || height <= 0 || channels <= 0) return fail(path, "", "empty image: " + shape);
  if (width <= kMaxImageSide && height <= kMaxImageSide) return {};
  return fail(path, "",
              "image too large: " + shape + ", the limit is " + std::to_string(kMaxImageSide) +
                  " pixels a side");
}

Expected<void> check_pixels_fill_size(const std::string& path, const Image& image) {
  const std::size_t needed = static_cast<std::size_t>(image.width) *
                             static_cast<std::size_t>(image.height) *
                             static_cast<std::size_t>(image.channels);
  if (image.pixels.size() == needed) return {};
  return fail(path, "",
              "the image has " + std::to_string(image.pixels.size()) + " numbers, not those of " +
                  shape_of(image.width, image.height, image.channels));
}

Expected<void> check_image_size(const std::string& path, std::int64_t width, std::int64_t height,
                                std::int64_t channels, std::uint64_t max_floats) {
  if (const auto fine = check_image_sides(path, width, height, channels); !fine) return fine;
  const std::uint64_t texels =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (static_cast<std::uint64_t>(channels) > max_floats / texels) {
    return fail(path, "",
                "image too large: " + shape_of(width, height, channels) + ", the limit is " +
                    std::to_string(max_floats) + " numbers");
  }
  const std::uint64_t bytes = texels * static_cast<std::uint64_t>(channels) * sizeof(float);
  if (bytes > kLargeBytes && bytes > available_memory()) {
    return fail(path, "",
                shape_of(width, height, channels) + " need " + bytes_text(bytes) +
                    " of memory, and " + bytes_text(available_memory()) + " are available",
                Error::Kind::failed);
  }
  return {};
}

Expected<LayeredImage> read_image(const std::string& path) {
  const Expected<std::vector<std::byte>> bytes = read_file(path);
  if (!bytes) return tl::unexpected(bytes.error());
  try {
    if (is_exr(*bytes)) return decode_exr(path, *bytes);
    if (is_hdr(*bytes)) return decode_hdr(path, *bytes);
    if (is_png_or_jpeg(*bytes)) return decode_png_or_jpeg(path, *bytes);
  } catch (const std::bad_alloc&) {
    return fail(path, "", "not enough memory for the image", Error::Kind::failed);
  }
  return fail(path, "", bytes->empty() ? "the file is empty" : "not an EXR, HDR, PNG or JPEG file");
}

}  // namespace lambent
