// SPDX-License-Identifier: Apache-2.0
// What PictureEncoder asks of a codec.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stream/picture/h264.h"

namespace lambent::stream {

class PictureCodec {
 public:
  virtual ~PictureCodec() = default;
  /// As of PictureEncoder; the picture has the size that the codec was made for.
  virtual Expected<EncodedPicture> encode(const YuvPicture& picture, bool key) = 0;
  virtual void aim(float rate, std::uint32_t bitrate) = 0;
};

/// What is said of settings that a codec does not take.
tl::unexpected<Error> refused_size(const EncoderSettings& settings);

Expected<std::unique_ptr<PictureCodec>> make_openh264(const EncoderSettings& settings);

/// The encoders of FFmpeg that this build knows: none without LAMBENT_STREAM_FFMPEG.
std::vector<std::string> ffmpeg_encoders();
Expected<std::unique_ptr<PictureCodec>> make_ffmpeg(const EncoderSettings& settings);

}  // namespace lambent::stream
