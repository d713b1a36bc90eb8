// SPDX-License-Identifier: Apache-2.0
#include <x265.h>

#include <cstring>
#include <string>
#include <utility>

#include "stream/textures/h265.h"

namespace lambent::stream {
namespace {

constexpr int kBits = 10;
// Nominal frame rate, since pictures are not displayed.
constexpr std::uint32_t kRate = 10;

class X265Writer : public TextureWriter {
 public:
  explicit X265Writer(const x265_api& api) : api_(api) {}
  ~X265Writer() override { close(); }
  X265Writer(const X265Writer&) = delete;
  X265Writer& operator=(const X265Writer&) = delete;

  Expected<std::vector<std::byte>> write(const TexturePicture& picture, bool key, int quantiser,
                                         TexturePicture& shown) override {
    if (encoder_ == nullptr || picture.width != width_ || picture.height != height_) {
      close();
      if (const auto opened = open(picture.width, picture.height); !opened) {
        return tl::unexpected(opened.error());
      }
    }
    x265_picture in, out;
    api_.picture_init(param_, &in);
    api_.picture_init(param_, &out);
    in.bitDepth = kBits;
    in.colorSpace = X265_CSP_I444;
    in.sliceType = key ? X265_TYPE_IDR : X265_TYPE_P;
    in.forceqp = quantiser + 1;  // 0 means that the encoder chooses
    in.pts = pictures_;
    for (std::size_t c = 0; c < picture.planes.size(); ++c) {
      // The codec's interface is not const-correct
      in.planes[c] = const_cast<std::uint16_t*>(picture.planes[c].data());
      in.stride[c] = picture.width * static_cast<int>(sizeof(std::uint16_t));
    }
    x265_nal* units = nullptr;
    std::uint32_t count = 0;
    if (api_.encoder_encode(encoder_, &units, &count, &in, &out) != 1) {
      return h265_failed("the encoder gave no picture for one");
    }
    ++pictures_;
    copy(out, picture, shown);
    std::vector<std::byte> bytes;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto* first = reinterpret_cast<const std::byte*>(units[i].payload);
      bytes.insert(bytes.end(), first, first + units[i].sizeBytes);
    }
    return bytes;
  }

 private:
  /// Opens the encoder. Pictures are not viewed, so all perceptual optimisations are off.
  Expected<void> open(int width, int height) {
    param_ = api_.param_alloc();
    if (param_ == nullptr || api_.param_default_preset(param_, "medium", "zerolatency") < 0) {
      return h265_failed("the encoder could not be started");
    }
    param_->logLevel = X265_LOG_NONE;
    param_->sourceWidth = width;
    param_->sourceHeight = height;
    param_->internalCsp = X265_CSP_I444;
    param_->internalBitDepth = kBits;
    param_->fpsNum = kRate;
    param_->fpsDenom = 1;
    param_->totalFrames = 0;
    param_->keyframeMax = -1;  // keys only on request
    param_->bOpenGOP = 0;
    param_->bRepeatHeaders = 1;
    param_->bEmitInfoSEI = 0;
    param_->maxNumReferences = 1;
    param_->rc.rateControlMode = X265_RC_CQP;
    param_->rc.aqMode = X265_AQ_NONE;
    param_->rc.cuTree = 0;
    param_->rc.ipFactor = 1.0;
    param_->scenecutThreshold = 0;
    param_->psyRd = 0.0;
    param_->psyRdoq = 0.0;
    param_->rdoqLevel = 2;
    param_->rdLevel = 4;
    param_->bEnableEarlySkip = 0;
    param_->recursionSkipMode = 0;
    param_->bEnableLoopFilter = 0;
    param_->bEnableSAO = 0;
    param_->bEnableWeightedPred = 0;
    param_->maxCUSize = 16;  // the smallest; tiles are smaller still
    param_->frameNumThreads = 1;
    param_->bEnableWavefront = 0;
    char none[] = "none";
    param_->numaPools = none;  // leave the other cores to the renderer
    encoder_ = api_.encoder_open(param_);
    param_->numaPools = nullptr;
    if (encoder_ == nullptr) return h265_failed("the encoder refuses pictures of this size");
    width_ = width;
    height_ = height;
    return {};
  }

  void close() {
    if (encoder_ != nullptr) api_.encoder_close(encoder_);
    if (param_ != nullptr) api_.param_free(param_);
    encoder_ = nullptr;
    param_ = nullptr;
  }

  static void copy(const x265_picture& from, const TexturePicture& size, TexturePicture& to) {
    to.width = size.width;
    to.height = size.height;
    const auto row = static_cast<std::size_t>(size.width);
    for (std::size_t c = 0; c < to.planes.size(); ++c) {
      to.planes[c].resize(row * size.height);
      const auto* line = static_cast<const std::byte*>(from.planes[c]);
      for (int y = 0; y < size.height; ++y, line += from.stride[c]) {
        std::memcpy(&to.planes[c][y * row], line, row * sizeof(std::uint16_t));
      }
    }
  }

  const x265_api& api_;
  x265_param* param_ = nullptr;
  x265_encoder* encoder_ = nullptr;
  int width_ = 0, height_ = 0;
  std::int64_t pictures_ = 0;
};

}  // namespace

Expected<std::unique_ptr<TextureWriter>> make_h265_writer() {
  const x265_api* api = x265_api_get(kBits);
  if (api == nullptr) return h265_failed("libx265 was built without 10 bits");
  return std::make_unique<X265Writer>(*api);
}

bool has_h265() {
  return true;
}

}  // namespace lambent::stream
