// SPDX-License-Identifier: Apache-2.0
#include <wels/codec_api.h>

#include <cmath>
#include <memory>

#include "stream/picture/picture_codec.h"

namespace lambent::stream {
namespace {

SEncParamExt parameters(ISVCEncoder& encoder, const EncoderSettings& settings) {
  SEncParamExt to{};
  encoder.GetDefaultParams(&to);
  to.iUsageType = CAMERA_VIDEO_REAL_TIME;
  to.iPicWidth = settings.width;
  to.iPicHeight = settings.height;
  to.fMaxFrameRate = settings.rate;
  to.iTargetBitrate = static_cast<int>(settings.bitrate);
  to.iMaxBitrate = UNSPECIFIED_BIT_RATE;
  to.iRCMode = RC_BITRATE_MODE;
  to.bEnableFrameSkip = false;  // skip no pictures
  to.uiIntraPeriod = 0;         // key pictures only on request
  to.iNumRefFrame = 1;
  to.iMultipleThreadIdc = 1;  // leave the other cores to the renderer
  to.bEnableSceneChangeDetect = false;
  to.bEnableBackgroundDetection = false;
  to.eSpsPpsIdStrategy = CONSTANT_ID;
  SSpatialLayerConfig& layer = to.sSpatialLayers[0];
  layer.uiProfileIdc = PRO_BASELINE;
  layer.iVideoWidth = settings.width;
  layer.iVideoHeight = settings.height;
  layer.fFrameRate = settings.rate;
  layer.iSpatialBitrate = to.iTargetBitrate;
  layer.iMaxSpatialBitrate = UNSPECIFIED_BIT_RATE;
  // Colour description for players
  layer.bVideoSignalTypePresent = true;
  layer.uiVideoFormat = VF_UNDEF;
  layer.bFullRange = false;
  layer.bColorDescriptionPresent = true;
  layer.uiColorPrimaries = CP_BT709;
  layer.uiTransferCharacteristics = TRC_IEC61966_2_1;  // sRGB, the output of the tone map
  layer.uiColorMatrix = CM_BT709;
  return to;
}

class OpenH264 : public PictureCodec {
 public:
  OpenH264(ISVCEncoder* made, const EncoderSettings& settings)
      : encoder_(made), rate_(settings.rate), bitrate_(settings.bitrate) {}

  Expected<EncodedPicture> encode(const YuvPicture& picture, bool key) override;
  void aim(float rate, std::uint32_t bitrate) override;

 private:
  struct Destroy {
    void operator()(ISVCEncoder* made) const {
      made->Uninitialize();
      WelsDestroySVCEncoder(made);
    }
  };
  std::unique_ptr<ISVCEncoder, Destroy> encoder_;
  std::int64_t pictures_ = 0;
  float rate_;
  std::uint32_t bitrate_;
};

Expected<EncodedPicture> OpenH264::encode(const YuvPicture& picture, bool key) {
  if (key) encoder_->ForceIntraFrame(true);
  SSourcePicture source{};
  source.iColorFormat = videoFormatI420;
  source.iPicWidth = picture.width;
  source.iPicHeight = picture.height;
  source.iStride[0] = picture.width;
  source.iStride[1] = source.iStride[2] = picture.width / 2;
  // The codec's interface is not const-correct
  source.pData[0] = const_cast<unsigned char*>(picture.y.data());
  source.pData[1] = const_cast<unsigned char*>(picture.cb.data());
  source.pData[2] = const_cast<unsigned char*>(picture.cr.data());
  source.uiTimeStamp =
      std::llround(1000.0 * static_cast<double>(pictures_) / static_cast<double>(rate_));
  SFrameBSInfo info{};
  if (encoder_->EncodeFrame(&source, &info) != cmResultSuccess ||
      info.eFrameType == videoFrameTypeSkip || info.eFrameType == videoFrameTypeInvalid) {
    return fail("H.264", "", "the encoder failed at a picture", Error::Kind::failed);
  }
  ++pictures_;

  EncodedPicture encoded;
  encoded.key = info.eFrameType == videoFrameTypeIDR;
  encoded.bytes.reserve(static_cast<std::size_t>(info.iFrameSizeInBytes));
  for (int i = 0; i < info.iLayerNum; ++i) {
    const SLayerBSInfo& layer = info.sLayerInfo[i];
    int size = 0;
    for (int nal = 0; nal < layer.iNalCount; ++nal) size += layer.pNalLengthInByte[nal];
    const auto* first = reinterpret_cast<const std::byte*>(layer.pBsBuf);
    encoded.bytes.insert(encoded.bytes.end(), first, first + size);
  }
  return encoded;
}

void OpenH264::aim(float rate, std::uint32_t bitrate) {
  if (rate != rate_) {
    encoder_->SetOption(ENCODER_OPTION_FRAME_RATE, &rate);
    rate_ = rate;
  }
  if (bitrate == bitrate_) return;
  SBitrateInfo info{SPATIAL_LAYER_ALL, static_cast<int>(bitrate)};
  encoder_->SetOption(ENCODER_OPTION_BITRATE, &info);
  bitrate_ = bitrate;
}

}  // namespace

Expected<std::unique_ptr<PictureCodec>> make_openh264(const EncoderSettings& settings) {
  ISVCEncoder* made = nullptr;
  if (WelsCreateSVCEncoder(&made) != 0 || made == nullptr) {
    return fail("H.264", "", "the encoder could not be started", Error::Kind::failed);
  }
  auto codec = std::make_unique<OpenH264>(made, settings);
  int level = WELS_LOG_QUIET;
  made->SetOption(ENCODER_OPTION_TRACE_LEVEL, &level);
  const SEncParamExt wanted = parameters(*made, settings);
  if (made->InitializeExt(&wanted) != cmResultSuccess) return refused_size(settings);
  int format = videoFormatI420;
  made->SetOption(ENCODER_OPTION_DATAFORMAT, &format);
  return codec;
}

}  // namespace lambent::stream
