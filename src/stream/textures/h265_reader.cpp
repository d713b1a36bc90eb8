// SPDX-License-Identifier: Apache-2.0
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/frame.h>
#include <libavutil/log.h>
}

#include <algorithm>
#include <cstring>
#include <string>

#include "stream/textures/h265.h"

namespace lambent::stream {
namespace {

class AvReader : public TextureReader {
 public:
  AvReader(const AVCodec& codec, AVFrame& frame, AVPacket& packet)
      : codec_(codec), frame_(&frame), packet_(&packet) {}
  ~AvReader() override {
    avcodec_free_context(&context_);
    av_packet_free(&packet_);
    av_frame_free(&frame_);
  }
  AvReader(const AvReader&) = delete;
  AvReader& operator=(const AvReader&) = delete;

  Expected<void> read(std::span<const std::byte> bytes, bool key,
                      TexturePicture& picture) override {
    // A key restarts the decoder
    if (key || context_ == nullptr) {
      if (const auto opened = open(picture); !opened) return opened;
    }
    padded_.assign(bytes.size() + AV_INPUT_BUFFER_PADDING_SIZE, 0);
    std::memcpy(padded_.data(), bytes.data(), bytes.size());
    packet_->data = padded_.data();
    packet_->size = static_cast<int>(bytes.size());
    if (avcodec_send_packet(context_, packet_) < 0 || avcodec_receive_frame(context_, frame_) < 0) {
      return h265_failed("a picture is broken");
    }
    const bool as_expected = frame_->width == picture.width && frame_->height == picture.height &&
                             frame_->format == AV_PIX_FMT_YUV444P10LE &&
                             frame_->decode_error_flags == 0;
    if (as_expected) copy(picture);
    av_frame_unref(frame_);
    if (!as_expected) return h265_failed("a picture is not of the size and kind of its field");
    return {};
  }

 private:
  Expected<void> open(const TexturePicture& picture) {
    avcodec_free_context(&context_);
    context_ = avcodec_alloc_context3(&codec_);
    if (context_ == nullptr) return h265_failed("the decoder could not be started");
    context_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    context_->err_recognition = AV_EF_EXPLODE;
    context_->thread_count = 1;
    // Larger pictures are refused before memory is allocated; blocks may extend beyond the edge
    constexpr std::int64_t kBlock = 64;
    context_->max_pixels = (picture.width + kBlock) * (picture.height + kBlock);
    if (avcodec_open2(context_, &codec_, nullptr) < 0) {
      return h265_failed("the decoder could not be started");
    }
    return {};
  }

  void copy(TexturePicture& picture) const {
    const auto row = static_cast<std::size_t>(picture.width);
    constexpr std::uint16_t kLargest = 1023;
    for (std::size_t c = 0; c < picture.planes.size(); ++c) {
      std::vector<std::uint16_t>& plane = picture.planes[c];
      plane.resize(row * picture.height);
      const std::uint8_t* line = frame_->data[c];
      for (int y = 0; y < picture.height; ++y, line += frame_->linesize[c]) {
        std::memcpy(&plane[y * row], line, row * sizeof(std::uint16_t));
      }
      for (std::uint16_t& value : plane) value = std::min(value, kLargest);
    }
  }

  const AVCodec& codec_;
  AVCodecContext* context_ = nullptr;
  AVFrame* frame_;
  AVPacket* packet_;
  std::vector<std::uint8_t> padded_;
};

}  // namespace

Expected<std::unique_ptr<TextureReader>> make_h265_reader() {
  av_log_set_level(AV_LOG_QUIET);
  const AVCodec* codec = avcodec_find_decoder(AV_CODEC_ID_HEVC);
  if (codec == nullptr) return h265_failed("libavcodec was built without it");
  AVFrame* frame = av_frame_alloc();
  AVPacket* packet = av_packet_alloc();
  if (frame == nullptr || packet == nullptr) {
    av_frame_free(&frame);
    av_packet_free(&packet);
    return h265_failed("memory runs out");
  }
  return std::make_unique<AvReader>(*codec, *frame, *packet);
}

}  // namespace lambent::stream
