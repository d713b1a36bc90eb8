// SPDX-License-Identifier: Apache-2.0
// H.264 without delay: each picture is output at once, and none is skipped. Encoded by OpenH264 or,
// with LAMBENT_STREAM_FFMPEG, by FFmpeg's encoders; decoded by OpenH264. Only this folder includes
// the codecs' headers.
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

// Limits of OpenH264: level 5.2, in either orientation.
inline constexpr int kMaxEncodedLongSide = 3840, kMaxEncodedShortSide = 2160;  // [pixels]

inline constexpr std::string_view kDefaultEncoder = "openh264";

struct EncoderSettings {
  int width = 640, height = 360;      ///< Even, 16 to the limits above [pixels].
  float rate = 30.0f;                 ///< Expected pictures per second, > 0.
  std::uint32_t bitrate = 4'000'000;  ///< Target [bit/s], > 0.
  /// One of picture_encoders().
  std::string encoder = std::string(kDefaultEncoder);
};

/// The names of encoders in this build; check_encoder tests whether they work on this machine.
std::vector<std::string> picture_encoders();
/// Fails, with the reason, where an encoder does not work on this machine.
Expected<void> check_encoder(const std::string& name);

/// An access unit of the constrained baseline profile, Annex B, with parameter sets before key
/// pictures.
struct EncodedPicture {
  std::vector<std::byte> bytes;
  bool key = false;  ///< Decoding can begin here.
};

class PictureCodec;

/// Encodes pictures of one size; all except key pictures are predicted from the one before. Not
/// thread-safe.
class PictureEncoder {
 public:
  /// Fails where the encoder is not available, or refuses the settings.
  static Expected<PictureEncoder> make(const EncoderSettings& settings);
  ~PictureEncoder();
  PictureEncoder(PictureEncoder&&) noexcept;
  PictureEncoder& operator=(PictureEncoder&&) noexcept;

  /// Encodes a picture of the settings' size. `key`: as a key picture; the first one always is.
  Expected<EncodedPicture> encode(const YuvPicture& picture, bool key = false);

  /// Sets the targets from the next picture on.
  void aim(float rate, std::uint32_t bitrate);

  const EncoderSettings& settings() const { return settings_; }

 private:
  PictureEncoder(const EncoderSettings& settings, std::unique_ptr<PictureCodec> codec);
  EncoderSettings settings_;
  std::unique_ptr<PictureCodec> codec_;
};

/// Decodes the output of a PictureEncoder, from a key picture on. Sizes may change at key pictures.
/// Not thread-safe.
class PictureDecoder {
 public:
  /// Fails where the codec cannot start.
  static Expected<PictureDecoder> make();
  ~PictureDecoder();
  PictureDecoder(PictureDecoder&&) noexcept;
  PictureDecoder& operator=(PictureDecoder&&) noexcept;

  /// Decodes an access unit. Fails on bytes that are broken or refer to missing pictures; decoding
  /// continues with the next key picture.
  Expected<YuvPicture> decode(std::span<const std::byte> bytes);

 private:
  struct Codec;
  explicit PictureDecoder(std::unique_ptr<Codec> codec);
  std::unique_ptr<Codec> codec_;
};

}  // namespace lambent::stream
