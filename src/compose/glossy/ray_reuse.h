// SPDX-License-Identifier: Apache-2.0
// What pixels' coats make of the rays around them, on the processor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compose/gbuffer.h"
#include "glossy/reuse_lanes.h"
#include "lambent/field.h"
#include "raytracing/camera_math.h"

namespace lambent {

/// What a sample's reflections are made of, and how.
struct GlossySettings {
  const World& world;
  const IrradianceField* field;  ///< Null: there is none.
  const FrameSettings& frame;
  CameraRecord camera;
  int sample = 0;
  std::uint32_t jitter = 0;  ///< As of camera_cone().
};

/// Rows of a picture that lie one below the other, as the camera sees them.
struct GlossyRows {
  const GBuffer& pixels;
  int first_row;
};

/// Light that coats reflect by rays, an entry a pixel.
struct CoatLight {
  std::vector<glm::vec4>
      light;  ///< Light (RGB, times A) and the share of the coat's that it is (A).
  std::vector<float> inverse_distances;  ///< One over the distance to what the coat sees [1/m].

  bool empty() const { return light.empty(); }
  void clear() {
    light.clear();
    inverse_distances.clear();
  }
};

/// The lobe of a pixel's coat.
CoatLobe lobe_of(const GBuffer& pixels, std::size_t pixel);

/// Its memory is kept from band to band.
class RayReuse {
 public:
  /// Light of `band`'s pixels, as of Glossy::reflect, from the rays of all pixels `around`.
  void reflect(const GlossySettings& settings, std::span<const GlossyRows> around,
               const GlossyRows& band, std::span<const CoatRay> rays, CoatLight& reflected);

 private:
  void lay_out(const GlossySettings& settings, std::span<const GlossyRows> around,
               std::span<const CoatRay> rays);

  RowPlanes coats_;
};

}  // namespace lambent
