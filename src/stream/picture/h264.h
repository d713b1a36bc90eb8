// SPDX-License-Identifier: Apache-2.0
// H.264 by OpenH264, without delay: each picture that goes in comes out at once, and none is left
// out. The codec itself is seen by these files alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "stream/picture/yuv.h"

namespace lambent::stream {

// What OpenH264 encodes: level 5.2, in either orientation.
inline constexpr int kMaxEncodedLongSide = 3840, kMaxEncodedShortSide = 2160;  // [pixels]

struct EncoderSettings {
  int width = 640, height = 360;      ///< Even, 16 to the limits above [pixels].
  float rate = 30.0f;                 ///< Pictures a second that are expected, > 0.
  std::uint32_t bitrate = 4'000'000;  ///< To aim at [bit/s], > 0.
};

/// An access unit of the constrained baseline profile, Annex B, with parameter sets in front of key
/// pictures.
struct EncodedPicture {
  std::vector<std::byte> bytes;
  bool key = false;  ///< Decoding can begin here.
};

/// Encodes pictures of one size, each but the key pictures by the one before. Not thread-safe.
class PictureEncoder {
 public:
  /// Fails where the codec refuses the settings.
  static Expected<PictureEncoder> make(const EncoderSettings& settings);
  ~PictureEncoder();
  PictureEncoder(PictureEncoder&&) noexcept;
  PictureEncoder& operator=(PictureEncoder&&) noexcept;

  /// Encodes a picture of the settings' size. `key`: as a key picture; the first one always is.
  Expected<EncodedPicture> encode(const YuvPicture& picture, bool key = false);

  /// What to aim at from the next picture on.
  void aim(float rate, std::uint32_t bitrate);

  const EncoderSettings& settings() const { return settings_; }

 private:
  struct Codec;
  PictureEncoder(const EncoderSettings& settings, std::unique_ptr<Codec> codec);
  EncoderSettings settings_;
  std::unique_ptr<Codec> codec_;
};

/// Decodes what PictureEncoder made, from a key picture on. Sizes may change at key pictures. Not
/// thread-safe.
class PictureDecoder {
 public:
  /// Fails where the codec cannot start.
  static Expected<PictureDecoder> make();
  ~PictureDecoder();
  PictureDecoder(PictureDecoder&&) noexcept;
  PictureDecoder& operator=(PictureDecoder&&) noexcept;

  /// The picture of an access unit. Fails on bytes that are broken or refer to pictures that are
  /// missing; decoding goes on with the next key picture.
  Expected<YuvPicture> decode(std::span<const std::byte> bytes);

 private:
  struct Codec;
  explicit PictureDecoder(std::unique_ptr<Codec> codec);
  std::unique_ptr<Codec> codec_;
};

}  // namespace lambent::stream
