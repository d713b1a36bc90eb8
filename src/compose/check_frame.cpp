// SPDX-License-Identifier: Apache-2.0
#include "compose/check_frame.h"

#include <string>

#include "scene/validate.h"

namespace lambent {
namespace {

constexpr int kMaxSide = 16384;  // of a picture [pixels]

Expected<void> check_side(const char* name, int pixels) {
  if (pixels >= 1 && pixels <= kMaxSide) return {};
  return fail("", name, std::to_string(pixels) + " is not between 1 and 16384");
}

Expected<void> check_least(const char* name, int value, int least) {
  if (value >= least) return {};
  return fail("", name, std::to_string(value) + " is less than " + std::to_string(least));
}

Expected<void> check(const IndirectSources& sources, const FrameSettings& settings) {
  if (sources.subtracted_field != nullptr && (sources.field == nullptr || !sources.rsm)) {
    return fail("", "subtracted field", "goes with a field and reflective shadow maps alone");
  }
  if (!sources.rsm) {
    if (!sources.rsm_stages) return {};
    return fail("", "rsm stages", "go with reflective shadow maps alone");
  }
  if (settings.gather_rays > 0) {
    return fail("", "gather rays", "do not go with reflective shadow maps");
  }
  if (sources.rsm_stages && rendered_rows(settings).rows != settings.height) {
    return fail("", "rsm stages", "are kept of whole pictures alone");
  }
  return check(*sources.rsm);
}

}  // namespace

Expected<void> check(const FrameSettings& s) {
  const Expected<void> checks[] = {check_side("width", s.width),
                                   check_side("height", s.height),
                                   check_least("first row", s.first_row, 0),
                                   check_least("rows", s.rows, 0),
                                   check_least("samples", s.samples, 1),
                                   check_least("emissive samples", s.emissive_samples, 1),
                                   check_least("gather rays", s.gather_rays, 0)};
  for (const Expected<void>& fine : checks) {
    if (!fine) return fine;
  }
  // Compared so that no sum overflows
  if (s.first_row >= s.height || s.rows > s.height - s.first_row) {
    return fail("", "rows", "reach below the picture");
  }
  return {};
}

Expected<void> check_view(const Camera& camera, int width, int height) {
  if (const Expected<void> fine = check_side("width", width); !fine) return fine;
  if (const Expected<void> fine = check_side("height", height); !fine) return fine;
  if (const char* flaw = flaw_of(camera)) return fail("", "camera", flaw);
  return {};
}

Expected<void> check(const FrameRequest& request) {
  const FrameSettings& settings = request.settings;
  if (const Expected<void> fine = check(settings); !fine) return fine;
  if (const Expected<void> fine = check(request.sources, settings); !fine) return fine;
  return check_view(request.camera, settings.width, settings.height);
}

}  // namespace lambent
