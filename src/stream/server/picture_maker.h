// SPDX-License-Identifier: Apache-2.0
// Renders and encodes one client's pictures, with its camera and at its pace.
#pragma once

#include <optional>
#include <string>

#include "core/image/tone_map.h"
#include "lambent/renderer.h"
#include "stream/edits/edits.h"
#include "stream/pace/pace.h"
#include "stream/picture/h264.h"
#include "stream/picture/still_picture.h"
#include "stream/server/client_link.h"

namespace lambent::stream {

struct PictureSettings {
  FrameSettings frame;  ///< Except the size.
  PaceLimits limits;
  ToneMap tone_map = ToneMap::aces;
  std::optional<float> exposure_stops;                 ///< None: automatic, with smooth changes.
  std::string encoder = std::string(kDefaultEncoder);  ///< One of picture_encoders().
};

/// The state of the world, for pictures.
struct WorldState {
  std::uint64_t updates = 0;      ///< Number so far.
  std::uint64_t last_change = 0;  ///< The last update that changed pictures.
};

class PictureMaker {
 public:
  /// Refers to the world and the field, which must outlive it. `ms_a_pixel`: see Pace.
  PictureMaker(const World& world, const IrradianceField& field, const PictureSettings& settings,
               const Camera& camera, const Hello& hello,
               double ms_a_pixel = Pace::kUnmeasuredMsAPixel);

  /// Applies a client's inputs.
  void follow(const ClientInputs& inputs);
  /// Time at which the next picture is due; none: nothing has changed, and pictures have converged.
  std::optional<Clock::time_point> due(const WorldState& state) const;
  /// Renders and encodes the current view. Once it is at rest, and if pictures are smaller than was
  /// asked for, renders a tile of a larger one, and returns no picture unless there is more to see.
  Expected<std::optional<Picture>> make(const WorldState& state, Clock::time_point now);

  const Pace& pace() const { return pace_; }

 private:
  bool has_settled(const WorldState& state) const;
  void note_state(const WorldState& state, glm::uvec2 size);
  Expected<void> render(const Camera& camera, glm::uvec2 size);
  Expected<bool> render_tile();
  Expected<Picture> encode(const WorldState& state);
  Expected<void> expose_unlit(FrameSettings& frame);
  Image shown(const Image& linear);

  PictureSettings settings_;
  const World& world_;
  Renderer renderer_;
  Pace pace_;
  Camera camera_;
  std::optional<PictureEncoder> encoder_;
  RenderedFrame frame_;
  YuvPicture yuv_;
  std::optional<float> stops_;           // exposure of the last picture
  std::optional<float> unlit_radiance_;  // set by the first picture
  std::uint32_t number_ = 0, last_input_ = 0;
  std::uint32_t rendered_ = 0;
  int still_pictures_ = 0;             // number of this size since the last change
  std::optional<StillPicture> still_;  // of what has settled, if pictures are too small
  int still_repeats_ = 0;              // number of times that it was sent once it was complete
  std::uint64_t shown_change_ = 0;
  glm::uvec2 shown_size_{0};  // of the last picture, tiles apart
  Clock::time_point last_;
};

}  // namespace lambent::stream
