// SPDX-License-Identifier: Apache-2.0
#include <wels/codec_api.h>

#include <array>
#include <utility>

#include "stream/picture/h264.h"

namespace lambent::stream {
namespace {

/// The rows of a plane without the padding between them.
std::vector<std::uint8_t> plane(const unsigned char* rows, int stride, int width, int height) {
  std::vector<std::uint8_t> to;
  to.reserve(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y) {
    const unsigned char* row = rows + static_cast<std::ptrdiff_t>(y) * stride;
    to.insert(to.end(), row, row + width);
  }
  return to;
}

}  // namespace

struct PictureDecoder::Codec {
  struct Destroy {
    void operator()(ISVCDecoder* made) const {
      made->Uninitialize();
      WelsDestroyDecoder(made);
    }
  };
  std::unique_ptr<ISVCDecoder, Destroy> decoder;
};

PictureDecoder::PictureDecoder(std::unique_ptr<Codec> codec) : codec_(std::move(codec)) {}
PictureDecoder::~PictureDecoder() = default;
PictureDecoder::PictureDecoder(PictureDecoder&&) noexcept = default;
PictureDecoder& PictureDecoder::operator=(PictureDecoder&&) noexcept = default;

Expected<PictureDecoder> PictureDecoder::make() {
  ISVCDecoder* made = nullptr;
  if (WelsCreateDecoder(&made) != 0 || made == nullptr) {
    return fail("H.264", "", "the decoder could not be started", Error::Kind::failed);
  }
  auto codec = std::make_unique<Codec>();
  codec->decoder.reset(made);
  int level = WELS_LOG_QUIET;
  made->SetOption(DECODER_OPTION_TRACE_LEVEL, &level);
  SDecodingParam wanted{};
  wanted.sVideoProperty.eVideoBsType = VIDEO_BITSTREAM_AVC;
  wanted.eEcActiveIdc = ERROR_CON_DISABLE;  // a wrong picture is worse than none
  if (made->Initialize(&wanted) != cmResultSuccess) {
    return fail("H.264", "", "the decoder could not be started", Error::Kind::failed);
  }
  return PictureDecoder(std::move(codec));
}

Expected<YuvPicture> PictureDecoder::decode(std::span<const std::byte> bytes) {
  std::array<unsigned char*, 3> planes{};
  SBufferInfo info{};
  const DECODING_STATE state =
      codec_->decoder->DecodeFrameNoDelay(reinterpret_cast<const unsigned char*>(bytes.data()),
                                          static_cast<int>(bytes.size()), planes.data(), &info);
  if (state != dsErrorFree || info.iBufferStatus != 1 || planes[0] == nullptr) {
    return fail("H.264", "", "the picture is broken, or refers to one that is missing");
  }
  const SSysMEMBuffer& found = info.UsrData.sSystemBuffer;
  YuvPicture picture;
  picture.width = found.iWidth;
  picture.height = found.iHeight;
  picture.y = plane(planes[0], found.iStride[0], found.iWidth, found.iHeight);
  picture.cb = plane(planes[1], found.iStride[1], found.iWidth / 2, found.iHeight / 2);
  picture.cr = plane(planes[2], found.iStride[1], found.iWidth / 2, found.iHeight / 2);
  return picture;
}

}  // namespace lambent::stream
