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

struct GBuffer {
  std::vector<Surface> surfaces;        ///< Undefined where `hit` is 0.
  std::vector<std::uint8_t> hit;        ///< 1 where the camera sees a surface.
  std::vector<glm::vec3> to_viewer_ws;  ///< Unit; back along the primary ray.

  std::size_t size() const { return hit.size(); }
};

/// Traces one primary ray a pixel: through its centre where the frame takes one sample, else spread
/// over it.
void trace_gbuffer(const World& world, const Camera& camera, const FrameSettings& settings,
                   const Band& band, int sample, GBuffer& gbuffer);

/// Light by which a pixel's surface is seen, diffuse and specular apart, each including the
/// surface's reflectance.
struct ReflectedLight {
  std::vector<glm::vec3> diffuse;
  std::vector<glm::vec3> specular;
};

/// Light that lights and emissive surfaces send straight to the surfaces. Returns the shadow rays
/// traced.
std::uint64_t shade_direct(const World& world, const GBuffer& gbuffer,
                           const FrameSettings& settings, const Band& band, int sample,
                           ReflectedLight& light);

/// Indirect irradiance on each surface from settings.gather_rays (>= 1) rays of its own into the
/// scene. Returns the rays traced, shadow rays included.
std::uint64_t gather_irradiance(const World& world, const IrradianceField& field,
                                const GBuffer& gbuffer, const FrameSettings& settings,
                                const Band& band, int sample, std::vector<glm::vec3>& irradiance);

}  // namespace lambent
