// SPDX-License-Identifier: Apache-2.0
#include "stream/server/picture_maker.h"

#include <algorithm>

#include "compose/unlit.h"
#include "core/image/exposure.h"
#include "core/stopwatch.h"

namespace lambent::stream {
namespace {

// Number of pictures over which noise is averaged once nothing changes.
constexpr int kPicturesToSettle = 16;
// Share of the difference to a picture's own exposure by which each picture changes the exposure.
constexpr float kExposureStep = 0.2f;

}  // namespace

PictureMaker::PictureMaker(const World& world, const IrradianceField& field,
                           const PictureSettings& settings, const Camera& camera,
                           const Hello& hello)
    : settings_(settings),
      world_(world),
      renderer_(world, IndirectSources{&field}),
      pace_(settings.limits, hello.size, hello.rate),
      camera_(camera) {}

void PictureMaker::follow(const ClientInputs& inputs) {
  for (const Arrival& one : inputs.arrivals) pace_.delivered(one.round_trip_ms, one.path_ms);
  if (inputs.request) pace_.ask(inputs.request->size, inputs.request->rate);
  if (inputs.camera) camera_ = camera_of(*inputs.camera);
  if (inputs.any()) still_pictures_ = 0;
  last_input_ = inputs.last_input;
}

std::optional<Clock::time_point> PictureMaker::due(const WorldState& state) const {
  if (state.last_change == shown_change_ && still_pictures_ >= kPicturesToSettle) {
    return std::nullopt;
  }
  return last_ + std::chrono::duration_cast<Clock::duration>(
                     std::chrono::duration<double>(1.0 / static_cast<double>(pace_.rate())));
}

// Finds the radiance at which unlit surfaces show their colours. It is then constant: the exposure
// depends on the pictures, and would not converge if these depended on it.
Expected<void> PictureMaker::expose_unlit(FrameSettings& frame) {
  if (!unlit_radiance_ && !shows_unlit(world_.scene())) unlit_radiance_ = frame.unlit_radiance;
  if (!unlit_radiance_) {
    std::optional<float> stops = settings_.exposure_stops;
    if (!stops) {
      frame.unlit_radiance = 0.0f;
      if (const auto done = renderer_.render(camera_, frame, frame_); !done) return done;
      stops = display_stops(frame_.image);
    }
    unlit_radiance_ = radiance_of_colors(settings_.tone_map, *stops);
  }
  frame.unlit_radiance = *unlit_radiance_;
  return {};
}

Expected<void> PictureMaker::render() {
  FrameSettings frame = settings_.frame;
  frame.width = static_cast<int>(pace_.size().x);
  frame.height = static_cast<int>(pace_.size().y);
  // with averaging, the renderer varies the seed
  if (frame.averaged_frames == 1) frame.seed += number_;
  if (const auto exposed = expose_unlit(frame); !exposed) return exposed;
  return renderer_.render(camera_, frame, frame_);
}

Image PictureMaker::shown() {
  const Image& linear = *frame_.image.find("");
  if (settings_.exposure_stops) {
    stops_ = settings_.exposure_stops;
  } else {
    const auto suits = display_stops(frame_.image);
    stops_ = stops_ ? *stops_ + kExposureStep * (suits - *stops_) : suits;
  }
  return display_image(linear, settings_.tone_map, *stops_);
}

Expected<Picture> PictureMaker::make(const WorldState& state, Clock::time_point now) {
  Picture picture;
  Stopwatch rendering;
  if (const auto done = render(); !done) return tl::unexpected(done.error());
  to_yuv(shown(), yuv_);
  picture.render_ms = static_cast<float>(rendering.lap());

  Stopwatch encoding;
  EncoderSettings wanted{yuv_.width, yuv_.height, pace_.likely_rate(), pace_.bitrate(),
                         settings_.encoder};
  if (!encoder_ || encoder_->settings().width != wanted.width ||
      encoder_->settings().height != wanted.height) {
    Expected<PictureEncoder> encoder = PictureEncoder::make(wanted);
    if (!encoder) return tl::unexpected(encoder.error());
    encoder_.emplace(std::move(*encoder));
  } else {
    encoder_->aim(wanted.rate, wanted.bitrate);
  }
  Expected<EncodedPicture> encoded = encoder_->encode(yuv_);
  if (!encoded) return tl::unexpected(encoded.error());
  picture.encode_ms = static_cast<float>(encoding.lap());

  picture.number = ++number_;
  picture.key = encoded->key ? 1 : 0;
  picture.size = {static_cast<std::uint32_t>(yuv_.width), static_cast<std::uint32_t>(yuv_.height)};
  picture.state = state.updates;
  picture.input = last_input_;
  picture.bytes = std::move(encoded->bytes);
  pace_.made(static_cast<double>(picture.render_ms) + static_cast<double>(picture.encode_ms));
  still_pictures_ = shown_change_ == state.last_change ? still_pictures_ + 1 : 0;
  shown_change_ = state.last_change;
  last_ = now;
  return picture;
}

}  // namespace lambent::stream
