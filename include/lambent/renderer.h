// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lambent/error.h"
#include "lambent/fog.h"
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
  /// Samples of emissive triangles and of many lights for direct light, >= 1; a shadow ray each.
  int emissive_samples = 4;
  /// The same at each surface that a ray of a reflection or through glass meets, >= 1: no filter
  /// takes the noise from what mirrors and clearcoats show.
  int reflected_emissive_samples = 4;
  /// Rays a sample sends out to gather its indirect light (final gathering), >= 0; 0 looks the
  /// field up instead. Finds light and shade finer than the probes' spacing, at the price of noise
  /// and of two rays for each.
  int gather_rays = 0;
  /// Reflections of coats whose roughness is below 0.95 are traced: a ray at each pixel of one row
  /// in so many, 1 to 8, and at each pixel of roughness up to 0.5. 0: coats reflect the field's
  /// light alone, which shows no image. Two halve the cost of one where most coats are rough.
  /// Needs a field.
  int glossy_rows = 2;
  /// Whether gathered light, what coats reflect by rays, what glass shows and direct light of
  /// emissive surfaces are filtered (lambent/denoise.h). Light of directional, point and spot
  /// lights has no noise and stays as it is. Rows of a picture then need 63 more on each side,
  /// which are traced, too, and each pixel 360 bytes; where there is glass 65 rows, where it is
  /// rough 130, and 560 bytes.
  bool denoise = false;
  /// Pictures of the renderer over which what is filtered is averaged first, 1 to 1000; 1: none.
  /// Reflections and what glass shows are left out: they do not move as their surfaces do.
  /// More leave less noise in sequences, at 100 bytes a pixel. Each picture then has rays of its
  /// own. Surfaces are followed by their motion; what was not seen before starts anew, and so does
  /// all light once the world's revision differs. For whole pictures of one sample a pixel, with
  /// `denoise`, on the processor.
  int averaged_frames = 1;
  /// Find where what each pixel shows was in the renderer's picture before: the layer "motion", two
  /// channels, the position then less the position now [pixels, +x right, +y down]. It follows the
  /// camera, instances, and meshes that animations bend; the sky by the camera's rotation; what is
  /// seen through AlphaMode::blend rather than that itself. NaN where nothing is known: in the
  /// first picture and after a change of size, for what is new, and for a mesh that is edited by
  /// hand for the first time. Of several samples, the nearest one's. Costs about a hundredth of a
  /// frame, and a ray where something is see-through.
  bool motion = false;
  /// Anti-alias the picture (the layer "") over the renderer's pictures so far that were rendered
  /// with it: samples lie at other places in the pixels from one to the next, and what motion finds
  /// again of the last one is kept, held to what is around it. For sequences; not together with
  /// parts of a picture. The first picture, all others after a change of size, and what comes into
  /// sight have no history. Give each frame a seed of its own, so that noise falls as well. Costs
  /// motion, and 76 bytes and about 0.2 us a pixel.
  bool temporal_antialiasing = false;
  /// Radiance at which the camera sees a white surface of Material::unlit [W/(m^2 sr)], 0 to 1e10:
  /// the inverse of the exposure shows such colours as they are. Seen by rays of reflections and
  /// through glass they keep a radiance of 1, and so does the light that they send to others.
  float unlit_radiance = 1.0f;
  FogSettings fog;         ///< Of the scene's fog (Scene::fog), where there is any.
  std::uint32_t seed = 1;  ///< Of all random numbers. Frames of different seeds differ in noise.
};

/// Named sets of what a frame costs and shows; docs/cli.md has their numbers.
enum class Quality : std::uint8_t {
  draft,        ///< The field's light between probes, looked up; grain of emissive surfaces stays.
  interactive,  ///< One ray a pixel gathers its light, and all noise is filtered.
  high,         ///< Some 64 rays a pixel, and all noise is filtered.
};

/// The settings of a named set; the rest as they are by default.
FrameSettings quality_settings(Quality quality);

/// Fails with the first setting that is out of range.
Expected<void> check(const FrameSettings& settings);

struct RenderedFrame {
  /// Linear radiance and its parts, see docs/overview.md: "" (the whole), direct, indirect,
  /// irradiance, glossy, emission, fog, albedo, normal, position, depth, and motion where it was
  /// asked for. As high as the rows that were rendered.
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
/// one needs more: about 50 MB, of maps what RsmSettings say, and on a device 124 bytes for each
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
  /// but for motion, light averaged over pictures and what is anti-aliased over them, whatever was
  /// rendered before. Fails on settings and sources that are out of range or do not go together,
  /// and on a camera that validate refuses in a scene. Throws std::runtime_error where the device's
  /// memory runs out, and std::bad_alloc where the processor's does.
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
