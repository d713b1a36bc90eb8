// SPDX-License-Identifier: Apache-2.0
// Reuse of the rays of neighbouring pixels, on the processor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compose/gbuffer.h"
#include "glossy/reuse_lanes.h"
#include "lambent/field.h"
#include "raytracing/camera_math.h"

namespace lambent {

/// Inputs of a sample's reflections.
struct GlossySettings {
  const World& world;
  const IrradianceField* field;  ///< Null: there is none.
  const FrameSettings& frame;
  CameraRecord camera;
  int sample = 0;              ///< Index among the samples of all frames.
  std::uint32_t jitter = 0;    ///< See camera_cone().
  int first_of_round = 0;      ///< See SampleRound.
  bool gathers_shown = false;  ///< See gathers_shown().
};

/// Successive rows of a picture, with the surfaces that the camera sees.
struct GlossyRows {
  const GBuffer& pixels;
  int first_row;
};

/// Light that coats reflect from rays, one entry a pixel.
struct CoatLight {
  /// RGB: the light, times A [W/(m^2 sr)]. A: the share of the coat's light that comes from rays.
  std::vector<glm::vec4> light;
  std::vector<CoatGuide> guides;  ///< Empty where light is not filtered.
  /// The coats that mirrors show. `light` does not include theirs. Empty where that is not kept
  /// separately.
  std::vector<MirroredCoat> mirrored;
  /// The surfaces that mirrors show. `light` does not include that of emitters there, nor what they
  /// gather. Empty where `mirrored` is.
  std::vector<ShownBase> mirrored_bases;
  std::vector<OwnRayLight> own;  ///< Empty where pixels have one ray.

  bool empty() const { return light.empty(); }
  void clear() {
    light.clear();
    guides.clear();
    mirrored.clear();
    mirrored_bases.clear();
    own.clear();
  }
};

/// What the mirrors of some pixels show; empty where that is not kept separately.
struct MirroredLight {
  std::span<const MirroredCoat> coats;
  std::span<const ShownBase> bases;
};

/// The specular lobe of a pixel.
CoatLobe lobe_of(const GBuffer& pixels, std::size_t pixel);

/// A pixel whose coat reflects rays, among them its own.
CoatReceiver receiver_of(const GlossySettings& settings, const GBuffer& pixels, std::size_t pixel,
                         const CoatRay& own);

/// Has the pixels of a band reflect the rays around them. Memory is reused from band to band.
class RayReuse {
 public:
  /// Computes the light of `band`'s pixels, see Glossy::reflect, from the rays of all pixels
  /// `around`. `in_mirrors`: what the mirrors of these pixels show.
  void reflect(const GlossySettings& settings, std::span<const GlossyRows> around,
               const GlossyRows& band, std::span<const CoatRay> rays,
               const MirroredLight& in_mirrors, CoatLight& reflected);

 private:
  void lay_out(const GlossySettings& settings, std::span<const GlossyRows> around,
               std::span<const CoatRay> rays);

  RowPlanes coats_;
};

}  // namespace lambent
