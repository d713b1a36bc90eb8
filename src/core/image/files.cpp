// SPDX-License-Identifier: Apache-2.0
// Images from and to files of any format.
#include <new>

#include "core/atomic_file.h"
#include "core/file_bytes.h"
#include "core/image/formats.h"

namespace lambent {

Expected<void> check_image_size(const std::string& path, std::int64_t width, std::int64_t height,
                                std::int64_t channels) {
  const std::string shape = std::to_string(width) + "x" + std::to_string(height) + " pixels, " +
                            std::to_string(channels) + " channels";
  if (width <= 0 || height <= 0 || channels <= 0) return fail(path, "", "empty image: " + shape);
  if (width > kMaxImageSide || height > kMaxImageSide) {
    return fail(path, "",
                "image too large: " + shape + ", the limit is " + std::to_string(kMaxImageSide) +
                    " pixels a side");
  }
  const std::uint64_t texels =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (static_cast<std::uint64_t>(channels) > kMaxImageFloats / texels) {
    return fail(path, "",
                "image too large: " + shape + ", the limit is " + std::to_string(kMaxImageFloats) +
                    " numbers");
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

Expected<void> write_exr(const std::string& path, const LayeredImage& image) {
  const Expected<std::vector<std::byte>> bytes = encode_exr(path, image);
  if (!bytes) return tl::unexpected(bytes.error());
  return write_file_atomically(path, *bytes);
}

Expected<void> write_png(const std::string& path, const Image& display_encoded) {
  const Expected<std::vector<std::byte>> bytes = encode_png(path, display_encoded);
  if (!bytes) return tl::unexpected(bytes.error());
  return write_file_atomically(path, *bytes);
}

}  // namespace lambent
