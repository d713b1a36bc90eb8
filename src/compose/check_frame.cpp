// SPDX-License-Identifier: Apache-2.0
#include "compose/check_frame.h"

#include <string>

#include "lambent/world.h"
#include "scene/limits.h"
#include "scene/validate.h"

namespace lambent {
namespace {

constexpr int kMaxSide = 16384;    // of a picture [pixels]
constexpr int kMaxGlossyRows = 8;  // between rows with rays; beyond that, reflections are lost
constexpr int kMostAveragedFrames = 1000;
constexpr int kMaxCoatRays = 64;

Expected<void> check_side(const char* name, int pixels) {
  if (pixels >= 1 && pixels <= kMaxSide) return {};
  return fail("", name, std::to_string(pixels) + " is not between 1 and 16384");
}

Expected<void> check_least(const char* name, int value, int least) {
  if (value >= least) return {};
  return fail("", name, std::to_string(value) + " is less than " + std::to_string(least));
}

Expected<void> check_coat_rays(int rays) {
  if (rays >= 1 && rays <= kMaxCoatRays) return {};
  return fail("", "coat rays", std::to_string(rays) + " is not between 1 and 64");
}

Expected<void> check_glossy_rows(int rows) {
  if (rows >= 0 && rows <= kMaxGlossyRows) return {};
  return fail("", "glossy rows", std::to_string(rows) + " is not between 0 and 8");
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

FrameSettings quality_settings(Quality quality) {
  FrameSettings settings;
  switch (quality) {
    case Quality::draft:
      settings.samples = 4;
      settings.fog = {16, 48, 4};
      break;
    case Quality::interactive:
      settings.gather_rays = 1;
      settings.denoise = true;
      break;
    case Quality::high:
      settings.samples = 4;
      settings.most_samples = 16;
      settings.gather_rays = 16;
      settings.glossy_rows = 1;
      settings.coat_rays = 8;
      settings.emissive_samples = 8;
      settings.reflected_emissive_samples = 16;
      settings.fog = {8, 96, 16};
      settings.denoise = true;
      break;
  }
  return settings;
}

Expected<void> check(const FrameSettings& s) {
  const Expected<void> checks[] = {
      check_side("width", s.width),
      check_side("height", s.height),
      check_least("first row", s.first_row, 0),
      check_least("rows", s.rows, 0),
      check_least("samples", s.samples, 1),
      check_least("most samples", s.most_samples, 0),
      check_least("emissive samples", s.emissive_samples, 1),
      check_least("reflected emissive samples", s.reflected_emissive_samples, 1),
      check_least("gather rays", s.gather_rays, 0),
      check_glossy_rows(s.glossy_rows),
      check_coat_rays(s.coat_rays)};
  for (const Expected<void>& fine : checks) {
    if (!fine) return fine;
  }
  if (const Expected<void> fine = check(s.fog); !fine) return fine;
  // Written so that NaN fails
  if (!(s.unlit_radiance >= 0.0f && s.unlit_radiance <= kMaxRadiance)) {
    return fail("", "unlit radiance", "is not within 0 to 1e10 W/(m^2 sr)");
  }
  if (s.averaged_frames < 1 || s.averaged_frames > kMostAveragedFrames) {
    return fail("", "averaged frames",
                std::to_string(s.averaged_frames) + " is not between 1 and 1000");
  }
  if (s.averaged_frames > 1 && (!s.denoise || s.samples != 1)) {
    return fail("", "averaged frames", "go with denoise and one sample a pixel alone");
  }
  // Compared so that no sum overflows
  if (s.first_row >= s.height || s.rows > s.height - s.first_row) {
    return fail("", "rows", "reach below the picture");
  }
  if (s.temporal_antialiasing && rendered_rows(s).rows != s.height) {
    return fail("", "temporal antialiasing", "goes with whole pictures alone");
  }
  if (s.averaged_frames > 1 && rendered_rows(s).rows != s.height) {
    return fail("", "averaged frames", "go with whole pictures alone");
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
  if (settings.averaged_frames > 1 && request.world.device() != nullptr) {
    return fail("", "averaged frames", "are kept on the processor alone, and this world is not");
  }
  if (const Expected<void> fine = validate_fog(request.world.scene()); !fine) return fine;
  if (has_fog(request)) {
    const int rows = traced_rows(request).rows;
    const Expected<void> fine = check_froxels(settings.fog, settings.width, rows);
    if (!fine) return fine;
  }
  return check_view(request.camera, settings.width, settings.height);
}

}  // namespace lambent
