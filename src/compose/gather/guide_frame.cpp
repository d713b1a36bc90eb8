// SPDX-License-Identifier: Apache-2.0
#include "compose/gather/guide_frame.h"

#include <algorithm>
#include <cmath>

#include "compose/gbuffer.h"

namespace lambent {
namespace {

// Pixels of the picture along the side of one of the pilot's: at 320x180, the pilot then traces a
// hundredth of the rays that gather light with Quality::high.
constexpr int kPilotStep = 8;
// Bounds of the pilot's longer side [pixels], which is never longer than the picture's. With less,
// points see too little of what is around them; with more, memory grows (60 MB at most).
constexpr int kLeastPilotSide = 64, kMaxPilotSide = 256;

/// Settings of the pilot's picture, one sample of each pixel.
FrameSettings pilot_settings(const FrameSettings& picture) {
  const int side = std::max(picture.width, picture.height);
  const int pilot_side =
      std::min(side, std::clamp(side / kPilotStep, kLeastPilotSide, kMaxPilotSide));
  const double scale = static_cast<double>(pilot_side) / side;
  FrameSettings pilot;
  pilot.height = std::max(1, static_cast<int>(std::lround(picture.height * scale)));
  // The height decides on the field of view, and the width follows from it: of very wide pictures
  // the pilot is wider than elsewhere
  const double wanted = static_cast<double>(pilot.height) * picture.width / picture.height;
  pilot.width = std::max(1, static_cast<int>(std::lround(wanted)));
  pilot.seed = picture.seed;
  return pilot;
}

}  // namespace

std::uint64_t guide_frame(const FrameRequest& request, GatherGuide& guide) {
  const FrameSettings pilot = pilot_settings(request.settings);
  GBuffer gbuffer;
  const std::uint64_t seen =
      trace_gbuffer(request.world, request.camera, pilot, {0, pilot.height}, 0, gbuffer);
  guide.size = {request.settings.width, request.settings.height, pilot.width, pilot.height};
  const PilotView view{gbuffer.surfaces, gbuffer.hit};
  return seen + make_guide(request.world, *request.sources.field, view, pilot.seed, guide);
}

}  // namespace lambent
