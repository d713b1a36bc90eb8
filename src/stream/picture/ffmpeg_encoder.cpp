// SPDX-License-Identifier: Apache-2.0
// H.264 by FFmpeg's encoders: x264, and hardware encoders.
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/hwcontext.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "stream/picture/picture_codec.h"

namespace lambent::stream {
namespace {

struct Option {
  const char* name;
  const char* value;
};

/// An encoder, and the options with which it outputs each picture at once, in a profile that all
/// decoders support.
struct Known {
  const char* name;
  bool on_device;  ///< Pictures are uploaded to a VAAPI device first.
  std::vector<Option> options;
};

const std::vector<Known>& known_encoders() {
  static const std::vector<Known> all = {
      {"libx264",
       false,
       {{"preset", "veryfast"},
        {"tune", "zerolatency"},
        {"profile", "baseline"},
        {"forced-idr", "1"}}},
      {"h264_nvenc",
       false,
       {{"preset", "p3"},
        {"tune", "ull"},
        {"profile", "baseline"},
        {"rc", "cbr"},
        {"delay", "0"},
        {"zerolatency", "1"},
        {"forced-idr", "1"}}},
      {"h264_vaapi",
       true,
       {{"profile", "constrained_baseline"}, {"rc_mode", "CBR"}, {"async_depth", "1"}}}};
  return all;
}

struct Free {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVBufferRef* buffer) const { av_buffer_unref(&buffer); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

tl::unexpected<Error> failed(const std::string& encoder, const std::string& why) {
  return fail("H.264", encoder, why, Error::Kind::failed);
}

class FfmpegCodec : public PictureCodec {
 public:
  explicit FfmpegCodec(const Known& known) : known_(known) {}

  Expected<void> open(const EncoderSettings& settings);
  Expected<EncodedPicture> encode(const YuvPicture& picture, bool key) override;
  void aim(float rate, std::uint32_t bitrate) override;

 private:
  Expected<void> open_device();
  Expected<AVFrame*> upload();

  const Known& known_;
  Owned<AVBufferRef> device_, frames_;
  Owned<AVCodecContext> context_;
  Owned<AVFrame> frame_, on_device_;
  Owned<AVPacket> packet_;
  float first_rate_ = 1.0f;
};

/// Opens a VAAPI device, and allocates pictures on it.
Expected<void> FfmpegCodec::open_device() {
  AVBufferRef* device = nullptr;
  if (av_hwdevice_ctx_create(&device, AV_HWDEVICE_TYPE_VAAPI, nullptr, nullptr, 0) < 0) {
    return failed(known_.name, "there is no VAAPI device on this machine");
  }
  device_.reset(device);
  frames_.reset(av_hwframe_ctx_alloc(device));
  on_device_.reset(av_frame_alloc());
  if (!frames_ || !on_device_) return failed(known_.name, "memory runs out");
  auto& frames = *reinterpret_cast<AVHWFramesContext*>(frames_->data);
  constexpr int kPool = 4;
  frames.format = AV_PIX_FMT_VAAPI;
  frames.sw_format = AV_PIX_FMT_YUV420P;
  frames.width = context_->width;
  frames.height = context_->height;
  frames.initial_pool_size = kPool;
  if (av_hwframe_ctx_init(frames_.get()) < 0) {
    return failed(known_.name, "the device has no room for pictures of this size and kind");
  }
  context_->pix_fmt = AV_PIX_FMT_VAAPI;
  context_->hw_frames_ctx = av_buffer_ref(frames_.get());
  return {};
}

Expected<void> FfmpegCodec::open(const EncoderSettings& settings) {
  av_log_set_level(AV_LOG_QUIET);
  const AVCodec* codec = avcodec_find_encoder_by_name(known_.name);
  if (codec == nullptr) return failed(known_.name, "is not in the libavcodec of this machine");
  context_.reset(avcodec_alloc_context3(codec));
  frame_.reset(av_frame_alloc());
  packet_.reset(av_packet_alloc());
  if (!context_ || !frame_ || !packet_) return failed(known_.name, "memory runs out");
  AVCodecContext& to = *context_;
  constexpr int kClock = 1000;  // ticks per picture interval
  first_rate_ = settings.rate;
  to.width = settings.width;
  to.height = settings.height;
  to.pix_fmt = AV_PIX_FMT_YUV420P;
  to.framerate = {static_cast<int>(std::lround(settings.rate * kClock)), kClock};
  to.time_base = {to.framerate.den, to.framerate.num};
  to.gop_size = std::numeric_limits<int>::max();  // key pictures only on request
  to.max_b_frames = 0;
  to.refs = 1;
  to.thread_count = 1;  // leave the other cores to the renderer
  // Colour description for players
  to.color_range = AVCOL_RANGE_MPEG;
  to.color_primaries = AVCOL_PRI_BT709;
  to.color_trc = AVCOL_TRC_IEC61966_2_1;  // sRGB, the output of the tone map
  to.colorspace = AVCOL_SPC_BT709;
  aim(settings.rate, settings.bitrate);
  if (known_.on_device) {
    if (const auto opened = open_device(); !opened) return opened;
  }
  for (const Option& option : known_.options) {
    if (av_opt_set(to.priv_data, option.name, option.value, 0) < 0) {
      return failed(known_.name, std::string("has no option ") + option.name);
    }
  }
  if (avcodec_open2(context_.get(), codec, nullptr) < 0) {
    return failed(known_.name, "cannot encode pictures of " + std::to_string(settings.width) + "x" +
                                   std::to_string(settings.height) + " pixels on this machine");
  }
  return {};
}

/// Uploads the picture to the device.
Expected<AVFrame*> FfmpegCodec::upload() {
  av_frame_unref(on_device_.get());
  if (av_hwframe_get_buffer(frames_.get(), on_device_.get(), 0) < 0 ||
      av_hwframe_transfer_data(on_device_.get(), frame_.get(), 0) < 0) {
    return failed(known_.name, "a picture could not be moved to the device");
  }
  on_device_->pts = frame_->pts;
  on_device_->pict_type = frame_->pict_type;
  return on_device_.get();
}

Expected<EncodedPicture> FfmpegCodec::encode(const YuvPicture& picture, bool key) {
  AVFrame& frame = *frame_;
  const std::int64_t number = frame.pts == AV_NOPTS_VALUE ? 0 : frame.pts + 1;
  av_frame_unref(&frame);
  frame.format = AV_PIX_FMT_YUV420P;
  frame.width = picture.width;
  frame.height = picture.height;
  frame.pts = number;
  frame.pict_type = key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
  if (av_frame_get_buffer(&frame, 0) < 0) return failed(known_.name, "memory runs out");
  const auto copy = [&](int plane, const std::vector<std::uint8_t>& from, int width, int height) {
    for (int y = 0; y < height; ++y) {
      std::copy_n(from.data() + static_cast<std::ptrdiff_t>(y) * width, width,
                  frame.data[plane] + static_cast<std::ptrdiff_t>(y) * frame.linesize[plane]);
    }
  };
  copy(0, picture.y, picture.width, picture.height);
  copy(1, picture.cb, picture.width / 2, picture.height / 2);
  copy(2, picture.cr, picture.width / 2, picture.height / 2);
  AVFrame* sent = &frame;
  if (known_.on_device) {
    const auto uploaded = upload();
    if (!uploaded) return tl::unexpected(uploaded.error());
    sent = *uploaded;
  }
  if (avcodec_send_frame(context_.get(), sent) < 0 ||
      avcodec_receive_packet(context_.get(), packet_.get()) < 0) {
    return failed(known_.name, "the encoder failed at a picture, or holds it back");
  }
  EncodedPicture encoded;
  encoded.key = (packet_->flags & AV_PKT_FLAG_KEY) != 0;
  const auto* first = reinterpret_cast<const std::byte*>(packet_->data);
  encoded.bytes.assign(first, first + packet_->size);
  av_packet_unref(packet_.get());
  return encoded;
}

void FfmpegCodec::aim(float rate, std::uint32_t bitrate) {
  // An encoder's rate is fixed when it is opened, so scale the bit rate for the right bits per
  // picture
  const double a_second = static_cast<double>(bitrate) * static_cast<double>(first_rate_ / rate);
  // Limits the size of a picture, to this many average ones
  constexpr double kBufferedPictures = 4.0;
  context_->bit_rate = std::llround(a_second);
  context_->rc_max_rate = context_->bit_rate;
  context_->rc_buffer_size =
      static_cast<int>(std::min(kBufferedPictures * a_second / static_cast<double>(first_rate_),
                                static_cast<double>(std::numeric_limits<int>::max())));
}

}  // namespace

std::vector<std::string> ffmpeg_encoders() {
  std::vector<std::string> names;
  for (const Known& known : known_encoders()) names.emplace_back(known.name);
  return names;
}

Expected<std::unique_ptr<PictureCodec>> make_ffmpeg(const EncoderSettings& settings) {
  for (const Known& known : known_encoders()) {
    if (settings.encoder != known.name) continue;
    if (settings.width > kMaxEncodedLongSide || settings.height > kMaxEncodedLongSide) {
      return refused_size(settings);
    }
    auto codec = std::make_unique<FfmpegCodec>(known);
    if (const auto opened = codec->open(settings); !opened) return tl::unexpected(opened.error());
    return codec;
  }
  return failed(settings.encoder, "is no encoder that is known");
}

}  // namespace lambent::stream
