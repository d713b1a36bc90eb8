// SPDX-License-Identifier: Apache-2.0
// What the camera sees, one entry a pixel of a band of rows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lambent/renderer.h"
#include "lambent/world.h"
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

/// Rows that the settings ask for.
inline Band rendered_rows(const FrameSettings& settings) {
  const int rows = settings.rows > 0 ? settings.rows : settings.height - settings.first_row;
  return {settings.first_row, rows};
}

/// Pixels of a band that are shown, and where they lie among the layers' pixels.
struct ShownPixels {
  std::size_t first = 0;  ///< Of the band's pixels.
  std::size_t count = 0;
  std::size_t first_in_layers = 0;
};
ShownPixels shown_pixels(const Band& band, const FrameSettings& settings);

struct GBuffer {
  std::vector<Hit> hits;
  std::vector<Surface> surfaces;        ///< Undefined where `hit` is 0.
  std::vector<std::uint8_t> hit;        ///< 1 where the camera sees a surface.
  std::vector<glm::vec3> to_viewer_ws;  ///< Unit; back along the primary ray.
  /// Share of the coats' light that rays of their own bring, 0 to 1; see raytracing/coat_share.h.
  /// Empty: there are no such rays.
  std::vector<float> coat_shares;
  std::vector<float> clearcoat_shares;  ///< The clearcoats'. Empty where no surface has one.

  std::size_t size() const { return hit.size(); }
};

/// The point of the picture that a pixel's sample is taken at [pixels]. `jitter` as of
/// subpixel_position.
glm::vec2 sample_position(const FrameSettings& settings, int x, int y, int sample, uint jitter);

/// Traces one primary ray a pixel: through its centre where the frame takes one sample, else spread
/// over it.
void trace_gbuffer(const World& world, const Camera& camera, const FrameSettings& settings,
                   const Band& band, int sample, GBuffer& gbuffer, uint jitter = 0);

/// Light by which a pixel's surface is seen, diffuse and specular apart, each including the
/// surface's reflectance.
struct ReflectedLight {
  std::vector<glm::vec3> diffuse;
  std::vector<glm::vec3> specular;
  /// What emissive surfaces send, which is drawn at random, diffuse and specular apart; empty where
  /// it is part of `diffuse` and `specular`.
  std::vector<glm::vec3> emitters;
  std::vector<glm::vec3> emitter_specular;
  /// Variance of luminance of `emitters` over filtered_albedo(); empty where pixels have one draw,
  /// which tells nothing of it.
  std::vector<float> emitter_variance;
  /// Luminance of what emitters would send to white Lambert surfaces if nothing were in the way,
  /// without noise; empty where `emitters` are.
  std::vector<float> unoccluded;
};

/// Light that lights and emissive surfaces send straight to the surfaces. What emissive ones send
/// is kept apart where the settings filter it. `emitters_alone`: that of other lights is left out.
/// Returns the shadow rays traced.
std::uint64_t shade_direct(const World& world, const GBuffer& gbuffer,
                           const FrameSettings& settings, const Band& band, int sample,
                           bool emitters_alone, ReflectedLight& light);

}  // namespace lambent
