// SPDX-License-Identifier: Apache-2.0
// H.264 without delay: each picture that goes in comes out at once, and none is left out. Encoded
// by OpenH264, or what LAMBENT_STREAM_FFMPEG has besides, and decoded by OpenH264. The codecs
// themselves are seen by this folder alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/error.h"
#include "stream/picture/yuv.h"

namespace lambent::stream {

// What OpenH264 encodes: level 5.2, in either orientation.
inline constexpr int kMaxEncodedLongSide = 3840, kMaxEncodedShortSide = 2160;  // [pixels]

inline constexpr std::string_view kDefaultEncoder = "openh264";

struct EncoderSettings {
  int width = 640, height = 360;      ///< Even, 16 to the limits above [pixels].
  float rate = 30.0f;                 ///< Pictures a second that are expected, > 0.
  std::uint32_t bitrate = 4'000'000;  ///< To aim at [bit/s], > 0.
  /// One of picture_encoders().
  std::string encoder = std::string(kDefaultEncoder);
};

/// The names of encoders that this build knows; whether this machine has them check_encoder tells.
std::vector<std::string> picture_encoders();
/// Fails, saying why, where an encoder cannot encode here.
Expected<void> check_encoder(const std::string& name);

/// An access unit of the constrained baseline profile, Annex B, with parameter sets in front of key
/// pictures.
struct EncodedPicture {
  std::vector<std::byte> bytes;
  bool key = false;  ///< Decoding can begin here.
};

class PictureCodec;

/// Encodes pictures of one size, each but the key pictures by the one before. Not thread-safe.
class PictureEncoder {
 public:
  /// Fails where the encoder is not here, or refuses the settings.
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
  PictureEncoder(const EncoderSettings& settings, std::unique_ptr<PictureCodec> codec);
  EncoderSettings settings_;
  std::unique_ptr<PictureCodec> codec_;
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
