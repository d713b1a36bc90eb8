// SPDX-License-Identifier: Apache-2.0
// The interface of codecs for PictureEncoder.
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
  /// See PictureEncoder; the picture has the codec's size.
  virtual Expected<EncodedPicture> encode(const YuvPicture& picture, bool key) = 0;
  virtual void aim(float rate, std::uint32_t bitrate) = 0;
};

/// The error for settings that a codec does not support.
tl::unexpected<Error> refused_size(const EncoderSettings& settings);

Expected<std::unique_ptr<PictureCodec>> make_openh264(const EncoderSettings& settings);

/// The FFmpeg encoders in this build: none without LAMBENT_STREAM_FFMPEG.
std::vector<std::string> ffmpeg_encoders();
Expected<std::unique_ptr<PictureCodec>> make_ffmpeg(const EncoderSettings& settings);

}  // namespace lambent::stream
