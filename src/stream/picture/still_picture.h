// SPDX-License-Identifier: Apache-2.0
// A large picture of a view at rest. It is rendered in tiles, each of which takes about as long as
// one of the small pictures that a slow machine sends while something moves, unless these are
// smaller than a tile can be.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "lambent/image.h"
#include "lambent/scene.h"

namespace lambent::stream {

/// The camera whose picture of `size` pixels is the part from `first` on of `camera`'s picture of
/// `whole` pixels. The part may reach beyond the picture.
Camera camera_of_part(const Camera& camera, glm::vec2 whole, glm::vec2 first, glm::vec2 size);

class StillPicture {
 public:
  /// Begins a picture of `size` pixels with `small`, a linear picture of the same view, enlarged.
  /// `tile_size` is the size of pictures that take long enough [pixels]; smaller tiles than 128x128
  /// would be margin for the most part, and are not made.
  StillPicture(const Camera& camera, const Image& small, glm::uvec2 size, glm::uvec2 tile_size);

  /// Whether all tiles are complete; then no more of them may be asked for.
  bool done() const { return tile_ == first_pixels_.size(); }
  /// The camera and the size [pixels] of the next picture that is to be rendered.
  Camera tile_camera() const;
  glm::uvec2 tile_size() const { return tile_size_; }
  /// Takes that picture: linear, with the history of those before of the same tile. Returns whether
  /// it has completed its tile, which the picture then shows.
  bool add(const Image& tile);
  /// The picture so far, linear.
  const Image& image() const { return image_; }

 private:
  const Camera camera_;
  const glm::uvec2 tile_size_;
  glm::uvec2 shown_size_;                 // of a tile without its margin
  std::vector<glm::uvec2> first_pixels_;  // of what tiles show
  std::size_t tile_ = 0;                  // the next one's index
  int pictures_ = 0;                      // of that tile
  Image image_;
};

}  // namespace lambent::stream
