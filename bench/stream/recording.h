// SPDX-License-Identifier: Apache-2.0
// A stream of light in a file, with checksums of the decoded light, for tests of decoders built by
// other compilers. Each message is preceded by its size and followed by the checksum of
// LightTextures; all numbers are little-endian words of 32 bits.
#pragma once

#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/little_endian.h"
#include "lambent/stream.h"
#include "stream/light/light_textures.h"

namespace lambent::light_stream {

class Recording {
 public:
  /// Throws std::runtime_error on messages that the decoder refuses.
  void add(std::span<const stream::LightMessage> messages) {
    for (const stream::LightMessage& message : messages) {
      const auto taken = decoder_.receive(message.bytes);
      if (!taken) throw std::runtime_error(taken.error().message());
      textures_.follow();
      bytes_.u32(static_cast<std::uint32_t>(message.bytes.size()));
      bytes_.raw(message.bytes);
      bytes_.u32(textures_.checksum());
    }
  }

  /// Throws std::runtime_error where the file cannot be written.
  void write(const std::string& path) const {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes_.bytes().data()),
               static_cast<std::streamsize>(bytes_.size()));
    file.close();
    if (!file) throw std::runtime_error(path + ": cannot be written");
  }

 private:
  stream::LightDecoder decoder_;
  stream::LightTextures textures_{decoder_};
  ByteWriter bytes_;
};

}  // namespace lambent::light_stream
