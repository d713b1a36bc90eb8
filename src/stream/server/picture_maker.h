// SPDX-License-Identifier: Apache-2.0
// One client's pictures: its camera, rendered and encoded at its pace.
#pragma once

#include <optional>
#include <string>

#include "core/image/tone_map.h"
#include "lambent/renderer.h"
#include "stream/edits/edits.h"
#include "stream/pace/pace.h"
#include "stream/picture/h264.h"
#include "stream/server/client_link.h"

namespace lambent::stream {

struct PictureSettings {
  FrameSettings frame;  ///< But for the size.
  PaceLimits limits;
  ToneMap tone_map = ToneMap::aces;
  std::optional<float> exposure_stops;  ///< None: as suits the pictures, followed smoothly.
  std::string encoder = std::string(kDefaultEncoder);  ///< One of picture_encoders().
};

/// Where the world is, as pictures tell it.
struct WorldState {
  std::uint64_t updates = 0;      ///< So far.
  std::uint64_t last_change = 0;  ///< The update that last changed what pictures show.
};

class PictureMaker {
 public:
  /// Refers to the world and the field, which must outlive it.
  PictureMaker(const World& world, const IrradianceField& field, const PictureSettings& settings,
               const Camera& camera, const Hello& hello);

  /// Follows what the client sent.
  void follow(const ClientInputs& inputs);
  /// When the next picture is due; none: nothing has changed since the last ones, which have
  /// settled.
  std::optional<Clock::time_point> due(const WorldState& state) const;
  /// Renders and encodes what the camera sees now.
  Expected<Picture> make(const WorldState& state, Clock::time_point now);

  const Pace& pace() const { return pace_; }

 private:
  Expected<void> render();
  Expected<void> expose_unlit(FrameSettings& frame);
  Image shown();

  PictureSettings settings_;
  const World& world_;
  Renderer renderer_;
  Pace pace_;
  Camera camera_;
  std::optional<PictureEncoder> encoder_;
  RenderedFrame frame_;
  YuvPicture yuv_;
  std::optional<float> stops_;           // of the last picture
  std::optional<float> unlit_radiance_;  // after the first one
  std::uint32_t number_ = 0, last_input_ = 0;
  int still_pictures_ = 0;  // since something changed
  std::uint64_t shown_change_ = 0;
  Clock::time_point last_;
};

}  // namespace lambent::stream
