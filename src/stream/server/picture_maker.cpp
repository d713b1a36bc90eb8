// SPDX-License-Identifier: Apache-2.0
#include "stream/server/picture_maker.h"

#include <algorithm>

#include "compose/unlit.h"
#include "core/image/exposure.h"
#include "core/stopwatch.h"
#include "scene/validate.h"

namespace lambent::stream {
namespace {

// Number of pictures over which noise is averaged once nothing changes.
constexpr int kPicturesToSettle = 16;
// Number of times that a complete still picture is sent again: with each, the codec's errors become
// fewer.
constexpr int kStillRepeats = 8;
// Share of the difference to a picture's own exposure by which each picture changes the exposure.
constexpr float kExposureStep = 0.2f;

}  // namespace

PictureMaker::PictureMaker(const World& world, const IrradianceField& field,
                           const PictureSettings& settings, const Camera& camera,
                           const Hello& hello, double ms_a_pixel)
    : settings_(settings),
      world_(world),
      renderer_(world, IndirectSources{&field}),
      pace_(settings.limits, hello.size, hello.rate, ms_a_pixel),
      camera_(camera) {}

void PictureMaker::follow(const ClientInputs& inputs) {
  for (const Arrival& one : inputs.arrivals) pace_.delivered(one.round_trip_ms, one.path_ms);
  if (inputs.request) pace_.ask(inputs.request->size, inputs.request->rate);
  if (inputs.camera) camera_ = camera_of(*inputs.camera);
  if (inputs.any()) still_pictures_ = 0;
  last_input_ = inputs.last_input;
}

/// Whether noise has been averaged since the last change.
bool PictureMaker::has_settled(const WorldState& state) const {
  return state.last_change == shown_change_ && still_pictures_ >= kPicturesToSettle;
}

std::optional<Clock::time_point> PictureMaker::due(const WorldState& state) const {
  const bool is_sharp = shown_size_ == pace_.asked_size() || still_repeats_ >= kStillRepeats;
  if (has_settled(state) && is_sharp) return std::nullopt;
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

Expected<void> PictureMaker::render(const Camera& camera, glm::uvec2 size) {
  FrameSettings frame = settings_.frame;
  frame.width = static_cast<int>(size.x);
  frame.height = static_cast<int>(size.y);
  // with averaging, the renderer varies the seed
  if (frame.averaged_frames == 1) frame.seed += rendered_;
  ++rendered_;
  if (const auto exposed = expose_unlit(frame); !exposed) return exposed;
  return renderer_.render(camera, frame, frame_);
}

Image PictureMaker::shown(const Image& linear) {
  if (settings_.exposure_stops) {
    stops_ = settings_.exposure_stops;
  } else if (!still_) {
    const auto suits = display_stops(frame_.image);
    stops_ = stops_ ? *stops_ + kExposureStep * (suits - *stops_) : suits;
  }
  return display_image(linear, settings_.tone_map, *stops_);
}

/// Renders the next tile of the still picture. Returns whether there is more to see.
Expected<bool> PictureMaker::render_tile() {
  if (!still_) {
    still_.emplace(camera_, *frame_.image.find(""), pace_.asked_size(), pace_.size());
  }
  if (still_->done()) {
    ++still_repeats_;
    return true;
  }
  const Camera camera = still_->tile_camera();
  if (flaw_of(camera) != nullptr) {  // its view is too narrow
    still_repeats_ = kStillRepeats;
    return false;
  }
  const auto done = render(camera, still_->tile_size());
  if (!done) return tl::unexpected(done.error());
  if (!still_->add(*frame_.image.find(""))) return false;
  to_yuv(shown(still_->image()), yuv_);
  return true;
}

/// Counts pictures of a state and a size.
void PictureMaker::note_state(const WorldState& state, glm::uvec2 size) {
  const bool continues = shown_change_ == state.last_change && shown_size_ == size;
  still_pictures_ = continues ? still_pictures_ + 1 : 0;
  shown_change_ = state.last_change;
  shown_size_ = size;
}

Expected<std::optional<Picture>> PictureMaker::make(const WorldState& state,
                                                    Clock::time_point now) {
  last_ = now;
  Stopwatch watch;
  if (has_settled(state)) {
    const auto more = render_tile();
    if (!more) return tl::unexpected(more.error());
    if (!*more) return std::nullopt;
  } else {
    still_.reset();
    still_repeats_ = 0;
    if (const auto done = render(camera_, pace_.size()); !done) {
      return tl::unexpected(done.error());
    }
    to_yuv(shown(*frame_.image.find("")), yuv_);
  }
  const double render_ms = watch.lap();
  auto picture = encode(state);
  if (!picture) return tl::unexpected(picture.error());
  const double encode_ms = watch.lap();
  picture->render_ms = static_cast<float>(render_ms);
  picture->encode_ms = static_cast<float>(encode_ms);
  if (!still_) {
    note_state(state, picture->size);
    pace_.made(picture->size, render_ms + encode_ms);
  }
  return std::optional<Picture>(std::move(*picture));
}

Expected<Picture> PictureMaker::encode(const WorldState& state) {
  const EncoderSettings wanted{yuv_.width, yuv_.height, pace_.likely_rate(),
                               still_ ? pace_.asked_bitrate() : pace_.bitrate(), settings_.encoder};
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
  Picture picture;
  picture.number = ++number_;
  picture.key = encoded->key ? 1 : 0;
  picture.size = {static_cast<std::uint32_t>(yuv_.width), static_cast<std::uint32_t>(yuv_.height)};
  picture.state = state.updates;
  picture.input = last_input_;
  picture.bytes = std::move(encoded->bytes);
  return picture;
}

}  // namespace lambent::stream
