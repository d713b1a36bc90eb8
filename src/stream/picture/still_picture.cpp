// SPDX-License-Identifier: Apache-2.0
#include "stream/picture/still_picture.h"

#include <algorithm>
#include <cmath>

namespace lambent::stream {
namespace {

// Pixels around a tile that are rendered and not shown: filters of noise take pixels from there, so
// that no seams are seen. They reach up to 63 pixels, of which the nearest count most.
constexpr std::uint32_t kMargin = 16;
// Least size of a tile with its margin [pixels].
constexpr std::uint32_t kMinTile = 128;
// Pictures over which a tile's noise is averaged and its edges are anti-aliased.
constexpr int kPicturesOfTile = 8;

/// Bilinear interpolation at a point whose coordinates are those of pixels' middles.
void interpolate(const Image& image, glm::vec2 at, float* channels) {
  at = glm::clamp(at, glm::vec2(0.0f), glm::vec2(image.width - 1, image.height - 1));
  const glm::ivec2 low(at);
  const glm::ivec2 high = glm::min(low + 1, glm::ivec2(image.width - 1, image.height - 1));
  const glm::vec2 share = at - glm::vec2(low);
  for (int c = 0; c < image.channels; ++c) {
    const float above = glm::mix(image.at(low.x, low.y)[c], image.at(high.x, low.y)[c], share.x);
    const float below = glm::mix(image.at(low.x, high.y)[c], image.at(high.x, high.y)[c], share.x);
    channels[c] = glm::mix(above, below, share.y);
  }
}

Image enlarged(const Image& small, glm::uvec2 size) {
  Image image(static_cast<int>(size.x), static_cast<int>(size.y), small.channels);
  const glm::vec2 scale = glm::vec2(small.width, small.height) / glm::vec2(size);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      interpolate(small, (glm::vec2(x, y) + 0.5f) * scale - 0.5f, image.at(x, y));
    }
  }
  return image;
}

}  // namespace

Camera camera_of_part(const Camera& camera, glm::vec2 whole, glm::vec2 first, glm::vec2 size) {
  // Find the part's middle and half its height on the image plane of the camera, +Y up
  const float half_whole =
      camera.orthographic ? 0.5f * camera.vertical_extent : std::tan(0.5f * camera.vertical_fov);
  const float of_pixel = 2.0f * half_whole / whole.y;
  const glm::vec2 middle = (first + 0.5f * size - 0.5f * whole) * glm::vec2(of_pixel, -of_pixel);
  const float half_part = 0.5f * size.y * of_pixel;
  Camera part = camera;
  part.aspect = 0.0f;
  glm::mat4& axes = part.world_from_view;
  const glm::vec4 aside = middle.x * axes[0] + middle.y * axes[1];
  if (camera.orthographic) {
    axes[3] += aside;
    part.vertical_extent = 2.0f * half_part;
    return part;
  }
  // The axis of view becomes oblique to the image plane, as of a lens that is shifted. As it stays
  // of unit length, the image plane moves towards the camera
  const glm::vec4 back = axes[2] - aside;
  const float length = glm::length(glm::vec3(back));
  axes[2] = back / length;
  part.vertical_fov = 2.0f * std::atan(half_part / length);
  return part;
}

StillPicture::StillPicture(const Camera& camera, const Image& small, glm::uvec2 size,
                           glm::uvec2 tile_size)
    : camera_(camera),
      tile_size_(glm::min(glm::max(tile_size, glm::uvec2(kMinTile)), size + 2u * kMargin)),
      image_(enlarged(small, size)) {
  const glm::uvec2 most = tile_size_ - 2u * kMargin;
  const glm::uvec2 tiles = (size + most - 1u) / most;
  shown_size_ = (size + tiles - 1u) / tiles;
  for (std::uint32_t y = 0; y < size.y; y += shown_size_.y) {
    for (std::uint32_t x = 0; x < size.x; x += shown_size_.x) first_pixels_.emplace_back(x, y);
  }
  // Most people look at the middle
  std::ranges::stable_sort(first_pixels_, {}, [&](const glm::uvec2& first) {
    return glm::distance(glm::vec2(first) + 0.5f * glm::vec2(shown_size_), 0.5f * glm::vec2(size));
  });
}

Camera StillPicture::tile_camera() const {
  const glm::vec2 first = glm::vec2(first_pixels_[tile_]) - static_cast<float>(kMargin);
  return camera_of_part(camera_, {image_.width, image_.height}, first, tile_size_);
}

bool StillPicture::add(const Image& tile) {
  if (++pictures_ < kPicturesOfTile) return false;
  const glm::ivec2 first(first_pixels_[tile_]);
  const glm::ivec2 end =
      glm::min(first + glm::ivec2(shown_size_), glm::ivec2(image_.width, image_.height));
  constexpr int kBefore = static_cast<int>(kMargin);
  for (int y = first.y; y < end.y; ++y) {
    const float* from = tile.at(kBefore, y - first.y + kBefore);
    std::copy_n(from, (end.x - first.x) * image_.channels, image_.at(first.x, y));
  }
  ++tile_;
  pictures_ = 0;
  return true;
}

}  // namespace lambent::stream
