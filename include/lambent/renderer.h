// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lambent/error.h"
#include "lambent/image.h"
#include "lambent/pass_time.h"
#include "lambent/progress.h"
#include "lambent/rsm.h"
#include "lambent/scene.h"

namespace lambent {

class World;
class IrradianceField;
struct FieldQuery;

/// Settings of a frame.
struct FrameSettings {
  int width = 1280;  ///< Pixels, 1 to 16384.
  int height = 720;  ///< Pixels, 1 to 16384.
  /// Which of the picture's rows are rendered: so many from this one on; 0 rows: all from there on.
  /// Their pixels have the same bits as in the whole picture, so that one too large for memory can
  /// be made some rows at a time. Rows below the first use the reflective shadow maps of the
  /// picture before, where that is of the same camera, size and world. The maps' stages
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

/// Fails with the first setting that is out of range.
Expected<void> check(const FrameSettings& settings);

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
  /// The part of `field`'s light that the maps bring, too, as a field of its own: it is taken out
  /// of what pixels receive. Null: nothing is. Needs both `field` and `rsm`.
  const IrradianceField* subtracted_field = nullptr;
  /// One bounce of directional, point and spot lights from reflective shadow maps; empty: none.
  /// Not together with FrameSettings::gather_rays.
  std::optional<RsmSettings> rsm = std::nullopt;
  bool rsm_stages = false;  ///< Also keep the layers "rsm.flux", "rsm.mosaic", ... (docs/rsm.md).
};

/// Renders pictures of a world, one after the other: direct light with shadow rays, and indirect
/// light from the sources. What shines by its coat alone reflects the field, or without one, the
/// maps' light. Keeps the memory of its passes from picture to picture and makes it anew only where
/// one needs more: about 50 MB, of maps what RsmSettings say, and on a device 112 bytes for each
/// pixel of a picture. Not thread-safe.
class Renderer {
 public:
  /// Refers to the world and to the sources' fields, which must outlive it and stay where they are;
  /// between pictures they may be updated. Without sources there is direct light and emission
  /// alone.
  explicit Renderer(const World& world, const IndirectSources& sources = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Renders what the camera sees. Runs on all cores; the same bits on any number of threads, and
  /// whatever was rendered before. Fails on settings and sources that are out of range or do not go
  /// together, and on a camera that validate refuses in a scene. Throws std::runtime_error where
  /// the device's memory runs out, and std::bad_alloc where the processor's does.
  Expected<RenderedFrame> render(const Camera& camera, const FrameSettings& settings = {},
                                 const ProgressFn& progress = {});
  /// Renders into a frame whose memory is used again. What it held is lost, unless this fails.
  Expected<void> render(const Camera& camera, const FrameSettings& settings, RenderedFrame& frame,
                        const ProgressFn& progress = {});

  /// Number of pictures, or parts of pictures, that were rendered.
  std::uint64_t frames() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Points that the camera sees, one a pixel of a picture of this size (1 to 16384 each), row after
/// row; none where it sees the sky. For UpdateRequest::seen a small picture is enough. Fails on
/// other sizes, and on a camera that validate refuses in a scene.
Expected<std::vector<FieldQuery>> visible_points(const World& world, const Camera& camera,
                                                 int width, int height);

}  // namespace lambent
