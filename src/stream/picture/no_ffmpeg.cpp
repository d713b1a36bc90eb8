// SPDX-License-Identifier: Apache-2.0
#include "stream/picture/picture_codec.h"

namespace lambent::stream {

std::vector<std::string> ffmpeg_encoders() {
  return {};
}

Expected<std::unique_ptr<PictureCodec>> make_ffmpeg(const EncoderSettings& settings) {
  return fail("H.264", settings.encoder, "is not in this build (LAMBENT_STREAM_FFMPEG)",
              Error::Kind::failed);
}

}  // namespace lambent::stream
