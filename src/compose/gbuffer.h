// SPDX-License-Identifier: Apache-2.0
// The surfaces that the camera sees, one entry a pixel of a band of rows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "lambent/renderer.h"
#include "lambent/world.h"
#include "raytracing/coat_share.h"
#include "raytracing/surface.h"

namespace lambent {

/// Rows of the image that are rendered together, so that memory does not grow with the image.
struct Band {
  int first_row = 0;
  int rows = 0;
};

/// Rows of a picture of this width that are rendered together: enough pixels to keep all cores
/// busy, few enough to stay small (about 50 MB).
inline int rows_of_a_band(int width) {
  constexpr int kBandPixels = 1 << 18;
  return std::max(1, kBandPixels / width);
}

/// The rows that the settings ask for.
inline Band rendered_rows(const FrameSettings& settings) {
  const int rows = settings.rows > 0 ? settings.rows : settings.height - settings.first_row;
  return {settings.first_row, rows};
}

/// The pixels of a band that are shown, and their place in the layers.
struct ShownPixels {
  std::size_t first = 0;  ///< First of them in the band.
  std::size_t count = 0;
  std::size_t first_in_layers = 0;
};
ShownPixels shown_pixels(const Band& band, const FrameSettings& settings);

/// The samples that are taken together, of all pixels or of some: from `first` on to
/// FrameSettings::samples. They are stratified apart from those before.
struct SampleRound {
  int first = 0;
  /// 1 for each pixel of the picture that takes none; empty: all take them.
  std::span<const std::uint8_t> skipped = {};
};

struct GBuffer {
  std::vector<Hit> hits;
  std::vector<Surface> surfaces;        ///< Undefined where `hit` is 0.
  std::vector<std::uint8_t> hit;        ///< 1 where the camera sees a surface.
  std::vector<glm::vec3> to_viewer_ws;  ///< Unit; back along the primary ray.
  std::vector<CoatShares> coat_shares;  ///< Empty: coats have no rays of their own.
  /// 1 where the pixel has no sample: it then shows nothing, with a weight of 0. Empty: all have
  /// one. Valid until the end of the frame.
  std::span<const std::uint8_t> skipped;

  std::size_t size() const { return hit.size(); }
  bool skips(std::size_t pixel) const { return !skipped.empty() && skipped[pixel] != 0; }
};

/// Weight of a pixel's sample times the transmittance of the fog before it; `fog` is that of the
/// pixels, see fog_along(), or empty.
inline float shown_weight(const GBuffer& gbuffer, std::span<const glm::vec4> fog,
                          std::size_t pixel) {
  return gbuffer.hits[pixel].sample_weight * (fog.empty() ? 1.0f : fog[pixel].w);
}

/// The point of the picture at which a pixel's sample is taken [pixels]. `jitter`: see
/// subpixel_position().
glm::vec2 sample_position(const FrameSettings& settings, int x, int y, int sample, uint jitter);

/// Traces one primary ray a pixel: through its centre where the frame takes one sample, otherwise
/// at a different point of the pixel for each sample. Pixels that `round` skips show nothing.
/// Returns the number of rays traced.
std::uint64_t trace_gbuffer(const World& world, const Camera& camera, const FrameSettings& settings,
                            const Band& band, int sample, GBuffer& gbuffer, uint jitter = 0,
                            const SampleRound& round = {});

/// Direct light that the pixels' surfaces reflect to the camera, diffuse and specular apart
/// [W/(m^2 sr)].
struct ReflectedLight {
  std::vector<glm::vec3> diffuse;
  std::vector<glm::vec3> specular;
  /// Light of emissive surfaces, which is sampled at random, diffuse and specular apart; empty
  /// where it is part of `diffuse` and `specular`.
  std::vector<glm::vec3> emitters;
  std::vector<glm::vec3> emitter_specular;
  /// Variance of the luminance of `emitters` over filtered_albedo(); empty where a pixel has one
  /// sample, which has no variance to measure.
  std::vector<float> emitter_variance;
  /// See unoccluded_light() [W/(m^2 sr)]; empty where `emitters` is.
  std::vector<glm::vec3> unoccluded;
  /// What coats and clearcoats whose light comes from rays reflect of the bright part of the sky;
  /// empty where the sky has none.
  std::vector<glm::vec3> sky, sky_in_clearcoats;
};

/// Computes the surfaces' direct light. Light of emissive surfaces is stored apart where the
/// settings filter it. `emitters_alone`: leaves out all other lights. Returns the number of shadow
/// rays traced.
std::uint64_t shade_direct(const World& world, const GBuffer& gbuffer,
                           const FrameSettings& settings, const Band& band, int sample,
                           bool emitters_alone, ReflectedLight& light);

}  // namespace lambent
