// SPDX-License-Identifier: Apache-2.0
// The encoder's side of light through a video codec.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "stream/light/quantise.h"
#include "stream/textures/texture_coding.h"

namespace lambent::stream {

/// Keeps errors below a target by adapting the quantiser, and by further pictures that refine the
/// first one of an update.
class TextureEncoding {
 public:
  explicit TextureEncoding(std::unique_ptr<TextureWriter> writer) : writer_(std::move(writer)) {}

  struct Encoded {
    std::vector<std::byte> body;
    bool is_key = false;
    LightState light;  ///< The decoders' state, without its update.
    LightErrors errors;
  };
  /// Encodes a field's light. `key`: as a key, which also happens the first time, for another
  /// geometry, and where the scale no longer fits.
  Expected<Encoded> encode(const FieldGeometry& geometry, const LightLayout& layout,
                           const TileBasis& basis, const FieldLight& light, float target, bool key);

 private:
  bool fit_scale(const FieldLight& light);

  std::unique_ptr<TextureWriter> writer_;
  TexturePicture picture_, shown_;
  float scale_ = 0.0f;  // 0: there was no key yet
  double quantiser_ = 22.0;
};

}  // namespace lambent::stream
