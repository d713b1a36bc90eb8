// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lambent/image.h"
#include "lambent/pass_time.h"
#include "lambent/progress.h"
#include "lambent/scene.h"

namespace lambent {

class World;
class IrradianceField;
struct FieldQuery;
struct RsmSettings;

/// Settings of a frame.
struct FrameSettings {
  int width = 1280;  ///< Pixels, 1 to 16384.
  int height = 720;  ///< Pixels, 1 to 16384.
  /// Which of the picture's rows are rendered: so many from this one on; 0 rows: all from there on.
  /// Their pixels have the same bits as in the whole picture, so that one too large for memory can
  /// be made some rows at a time. Reflective shadow maps are made anew each time, and their stages
  /// (IndirectSources::rsm_stages) are kept of whole pictures alone.
  int first_row = 0;
  int rows = 0;
  /// Primary rays a pixel, >= 1: 1 through its centre, more spread over it. Cost is in proportion.
  int samples = 1;
  /// Points drawn on emissive triangles for a sample's direct light, >= 1. Each costs a shadow ray.
  int emissive_samples = 4;
  /// Rays a sample sends out to gather its indirect light (final gathering), >= 0; 0 looks the
  /// field up instead. Finds light and shade finer than the probes' spacing, at the price of noise
  /// and of two rays for each.
  int gather_rays = 0;
  std::uint32_t seed = 1;  ///< Of all random numbers. Frames of different seeds differ in noise.
};

struct RenderedFrame {
  /// Linear radiance and its parts, see docs/overview.md: "" (the whole), direct, indirect,
  /// irradiance, glossy, emission, albedo, normal, position, depth. As high as the rows that were
  /// rendered.
  LayeredImage image;
  std::vector<PassTime> passes;  ///< In the order of the frame.
  std::uint64_t rays = 0;        ///< Traced: primary, gathered and shadow rays.
};

/// Where a frame's indirect light comes from, all of it added up.
struct IndirectSources {
  const IrradianceField* field = nullptr;  ///< Null: none.
  /// The part of `field`'s light that another source brings, as a field of its own: it is taken out
  /// of what pixels receive. Null: nothing is.
  const IrradianceField* subtracted_field = nullptr;
  /// One bounce of directional, point and spot lights from reflective shadow maps, in range; null:
  /// none. Not together with FrameSettings::gather_rays.
  const RsmSettings* rsm = nullptr;
  bool rsm_stages = false;  ///< Also keep the layers "rsm.flux", "rsm.mosaic", ... (docs/rsm.md).
};

/// Renders what the camera sees: direct light with shadow rays, and indirect light from the
/// sources. What shines by its coat alone reflects the field, or without one, the maps' light.
/// Settings must be in range, and the camera one that validate accepts in a scene. Runs on all
/// cores; the same bits on any number of threads.
RenderedFrame render_frame(const World& world, const IndirectSources& sources, const Camera& camera,
                           const FrameSettings& settings, const ProgressFn& progress = {});

/// Renders what the camera sees: direct light with shadow rays, and indirect light from the field.
/// A null field gives direct light and emission alone. Settings must be in range, and the camera
/// one that validate accepts in a scene. Runs on all cores; the same bits on any number of threads.
RenderedFrame render_frame(const World& world, const IrradianceField* field, const Camera& camera,
                           const FrameSettings& settings, const ProgressFn& progress = {});

/// Points that the camera sees, one a pixel of a picture of this size (1 to 16384 each), row after
/// row; none where it sees the sky. For UpdateRequest::seen a small picture is enough.
std::vector<FieldQuery> visible_points(const World& world, const Camera& camera, int width,
                                       int height);

}  // namespace lambent
