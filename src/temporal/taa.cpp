// SPDX-License-Identifier: Apache-2.0
#include "temporal/taa.h"

#include <algorithm>
#include <cassert>

#include "core/parallel.h"

namespace lambent {
namespace {

// What taa_resolve.inl.h requires of its includer.
struct TaaPicture {
  int width;
  const float* radiance;
  const PixelMotion* motion;
};
using TaaPictureRef = const TaaPicture&;
struct TaaHistory {
  int width;
  const TaaPixel* pixels;
};
using TaaHistoryRef = const TaaHistory&;

std::size_t index_of(int width, ivec2 pixel) {
  return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(pixel.x);
}
vec3 fetch_radiance(const TaaPicture& picture, ivec2 pixel) {
  const float* p = picture.radiance + 3 * index_of(picture.width, pixel);
  return {p[0], p[1], p[2]};
}
const PixelMotion& fetch_motion(const TaaPicture& picture, ivec2 pixel) {
  return picture.motion[index_of(picture.width, pixel)];
}
const TaaPixel& fetch_history(const TaaHistory& history, ivec2 pixel) {
  return history.pixels[index_of(history.width, pixel)];
}

#include "temporal/taa_resolve.inl.h"

}  // namespace

void TaaSequence::advance(int width, int height, const FrameChange& change) {
  const bool has_history = begun_ && change.same_size;
  index_ = has_history ? index_ + 1 : 0;
  quiet_frames_ = has_history && !change.edited ? quiet_frames_ + 1 : 0;
  resting_frames_ = has_history && !change.moved ? resting_frames_ + 1 : 0;
  // Things that go on moving are known to move in the previous frame, too; those that begin are
  // not. Worlds may be updated in every second frame alone
  const bool begins = change.moving > most_moving_;
  // What moved before the first frame is not known to move in it
  const std::size_t moving = has_history ? change.moving : 0;
  ++frames_since_most_;
  if (!has_history || moving >= most_moving_ || frames_since_most_ > kFramesUntilStill) {
    most_moving_ = moving;
    frames_since_most_ = 0;
  }
  const uint still_frames = std::min(quiet_frames_, resting_frames_);
  float deviations = kClipDeviations;
  if (quiet_frames_ >= kFramesUntilStill) deviations = kLooseClipDeviations;
  if (still_frames >= kFramesUntilStill) deviations = 0.0f;
  frame_ = {width,
            height,
            has_history ? 1u : 0u,
            deviations,
            change.relit ? 1u : 0u,
            still_frames > 0 ? kStillHistoryFrames : kRestingHistoryFrames,
            resting_frames_ > 0 && !begins ? 1u : 0u};
  begun_ = true;
}

void TemporalAntialiasing::resolve(const TaaFrame& frame, std::span<const PixelMotion> motion,
                                   Image& picture) {
  assert(picture.width == frame.width && picture.height == frame.height && picture.channels == 3);
  const std::size_t pixels = motion.size();
  history_.resize(pixels);
  result_.resize(pixels);
  const TaaPicture rendered{frame.width, picture.pixels.data(), motion.data()};
  const TaaHistory history{frame.width, history_.data()};
  parallel_chunks(frame.height, 1, [&](std::size_t row, std::size_t) {
    for (int x = 0; x < frame.width; ++x) {
      const ivec2 pixel(x, static_cast<int>(row));
      result_[index_of(frame.width, pixel)] = resolve_taa(frame, rendered, history, pixel);
    }
  });
  parallel_chunks(frame.height, 1, [&](std::size_t row, std::size_t) {
    for (int x = 0; x < frame.width; ++x) {
      const vec3 radiance = result_[index_of(frame.width, {x, static_cast<int>(row)})].radiance;
      float* shown = picture.at(x, static_cast<int>(row));
      for (int c = 0; c < 3; ++c) shown[c] = radiance[c];
    }
  });
  std::swap(history_, result_);
}

}  // namespace lambent
