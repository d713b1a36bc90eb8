// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <utility>

#include "stream/picture/picture_codec.h"

namespace lambent::stream {

tl::unexpected<Error> refused_size(const EncoderSettings& settings) {
  return fail("H.264", settings.encoder,
              "refuses pictures of " + std::to_string(settings.width) + "x" +
                  std::to_string(settings.height) + " pixels");
}

std::vector<std::string> picture_encoders() {
  std::vector<std::string> names = ffmpeg_encoders();
  names.insert(names.begin(), std::string(kDefaultEncoder));
  return names;
}

Expected<void> check_encoder(const std::string& name) {
  EncoderSettings settings;
  settings.encoder = name;
  auto encoder = PictureEncoder::make(settings);
  if (!encoder) return tl::unexpected(encoder.error());
  YuvPicture grey{settings.width, settings.height, {}, {}, {}};
  constexpr std::uint8_t kGrey = 128;
  const std::size_t pixels = static_cast<std::size_t>(settings.width) * settings.height;
  grey.y.assign(pixels, kGrey);
  grey.cb.assign(pixels / 4, kGrey);
  grey.cr.assign(pixels / 4, kGrey);
  const auto encoded = encoder->encode(grey);
  if (!encoded) return tl::unexpected(encoded.error());
  return {};
}

PictureEncoder::PictureEncoder(const EncoderSettings& settings, std::unique_ptr<PictureCodec> codec)
    : settings_(settings), codec_(std::move(codec)) {}
PictureEncoder::~PictureEncoder() = default;
PictureEncoder::PictureEncoder(PictureEncoder&&) noexcept = default;
PictureEncoder& PictureEncoder::operator=(PictureEncoder&&) noexcept = default;

Expected<PictureEncoder> PictureEncoder::make(const EncoderSettings& settings) {
  auto codec =
      settings.encoder == kDefaultEncoder ? make_openh264(settings) : make_ffmpeg(settings);
  if (!codec) return tl::unexpected(codec.error());
  return PictureEncoder(settings, std::move(*codec));
}

Expected<EncodedPicture> PictureEncoder::encode(const YuvPicture& picture, bool key) {
  assert(picture.width == settings_.width && picture.height == settings_.height);
  return codec_->encode(picture, key);
}

void PictureEncoder::aim(float rate, std::uint32_t bitrate) {
  if (rate == settings_.rate && bitrate == settings_.bitrate) return;
  settings_.rate = rate;
  settings_.bitrate = bitrate;
  codec_->aim(rate, bitrate);
}

}  // namespace lambent::stream
