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
  /// The picture's rows that are rendered: `rows` of them from `first_row` on; 0 `rows`: all from
  /// `first_row` on. Their pixels have the same bits as in the whole picture without
  /// `most_samples`, so that one too large for memory can be rendered some rows at a time. Calls
  /// with a `first_row` above 0 reuse the reflective shadow maps of the picture before, where that
  /// had the same camera, size and world. The maps' stages (IndirectSources::rsm_stages) are stored
  /// for whole pictures only.
  int first_row = 0;
  int rows = 0;
  /// Primary rays per pixel, >= 1: a single ray passes through its centre, several are spread over
  /// it. Cost is in proportion.
  int samples = 1;
  /// Most primary rays per pixel, >= 0: pixels whose samples differ visibly, at edges, on thin
  /// things and where see-through surfaces overlap, double their number of samples, once or more,
  /// up to this. 0: none does. Further samples have half of the rays that gather light, and a
  /// quarter of those that reflect it; a pixel takes 21 bytes more, and 4 for each of `samples`.
  /// Parts of a picture, and pictures with averaged_frames or temporal_antialiasing, take none.
  /// Has no effect below twice `samples`, nor with one sample, which has none to differ from.
  int most_samples = 0;
  /// Samples of emissive triangles and of many lights for direct light, >= 1; a shadow ray each.
  int emissive_samples = 4;
  /// The same number at each surface hit by a reflected ray or by one through glass, >= 1. No
  /// filter removes the noise of direct light in mirrors of roughness above 0.05 and in clearcoats.
  int reflected_emissive_samples = 4;
  /// Rays per sample that gather its indirect light (final gathering), >= 0; 0: the field is looked
  /// up instead. Gathering resolves light and shade finer than the probes' spacing, but is noisy,
  /// and costs a ray and its shadow rays for each. Where it ends within a spacing of the probes
  /// from its origin or from a light, up to four more follow. With `denoise`, half of them
  /// gather the light of what a pixel shows in a mirror, of roughness up to 0.05, and as many that
  /// of what it shows behind glass; with 1, that light is looked up.
  int gather_rays = 0;
  /// Whether up to half of a sample's gathering rays, where there are several, go where a pilot
  /// found most of the light: a picture an eighth as large, 64 to 256 pixels along its longer side
  /// unless the picture has less, with 16 rays a pixel. Less noise where light comes from small
  /// bright places; takes up to 60 MB. Has no effect with one gathering ray.
  bool guides_gathers = true;
  /// Specular reflections of roughness below 0.95 are traced with a ray at each pixel of every
  /// `glossy_rows`-th row, 1 to 8, and at each pixel of roughness up to 0.5. 0: specular lobes
  /// reflect the field's light alone, without images. 2 halves the cost of 1 where most surfaces
  /// are rough. Needs a field.
  int glossy_rows = 2;
  /// Specular rays of a pixel, 1 to 64, where rays of neighbouring pixels fit its lobe too little
  /// to help: on thin and curved metal. Noise there falls with the square root; each costs as much
  /// as the first one. Needs `glossy_rows`.
  int coat_rays = 1;
  /// Whether gathered light, traced reflections, the light through glass and direct light of
  /// emissive surfaces are filtered (lambent/denoise.h). Light of directional, point and spot
  /// lights has no noise and is not filtered. Parts of a picture then need 63 more rows on each
  /// side, which are traced, too, and each pixel takes 360 bytes, and 232 more where surfaces are
  /// smooth enough to be mirrors. With glass these are 65 rows, with rough glass 130, and 664
  /// bytes.
  bool denoise = false;
  /// Number of the renderer's pictures over which light is averaged before it is filtered, 1 to
  /// 1000; 1: no averaging. Light through glass is not averaged. More pictures leave less noise in
  /// sequences, at up to 560 bytes per pixel. Each picture then draws other rays. Surfaces are
  /// followed as the camera moves, reflections by what they show. Averages start anew for surfaces
  /// that were not seen before; where things move, on them, around them, in the shadows of lamps
  /// that they may move, and where mirrors may show them. Elsewhere, a frame counts for an eighth
  /// of indirect light at least while things move, or lights, materials or the sky change, the
  /// field having been updated; lookups of the field are then averaged, too, and follow the level
  /// of large parts of the picture. When lights, materials or the sky change, reflections and light
  /// that is sampled start anew. What single gathering rays bring far beyond the field's light
  /// fades in over some 32 pictures, whatever this number, instead of flashing. For whole pictures
  /// of one sample per pixel, with `denoise`, on the processor.
  int averaged_frames = 1;
  /// Write the layer "motion" (motion vectors) with two channels: the position at which the
  /// renderer's picture before showed the surface of a pixel, less its position now [pixels, +x
  /// right, +y down]. It follows the camera, instances, and meshes that animations deform; the sky
  /// follows the camera's rotation. Where a surface of AlphaMode::blend is in front, it is the
  /// motion of the surface behind it. NaN where the motion is unknown: in the first picture and
  /// after a change of size, for new objects, and for a mesh that is edited by hand for the first
  /// time. Of the first `samples`, the nearest one's motion. Costs about a hundredth of a frame,
  /// and a ray where something is see-through.
  bool motion = false;
  /// Anti-alias the picture (the layer "") over the renderer's pictures so far that were rendered
  /// with this setting (temporal anti-aliasing): samples are jittered within the pixels from one
  /// picture to the next, and the last picture is reprojected by its motion and clamped to the
  /// colours around each pixel. For sequences; not together with parts of a picture. The first
  /// picture, the first one after a change of size, and surfaces that come into sight have no
  /// history. Give each frame another seed, so that noise falls as well. Costs motion, and 108
  /// bytes and about 0.2 us per pixel.
  bool temporal_antialiasing = false;
  /// Radiance at which the camera sees a white surface of Material::unlit [W/(m^2 sr)], 0 to 1e10:
  /// the inverse of the exposure displays such colours unchanged. In reflections, through glass and
  /// as light on other surfaces, they have a radiance of 1.
  float unlit_radiance = 1.0f;
  FogSettings fog = {};    ///< How light in the scene's fog (Scene::fog) is computed.
  std::uint32_t seed = 1;  ///< Of all random numbers; frames of other seeds differ in noise.
};

/// Named sets of settings that trade a frame's cost for its quality; docs/cli.md has their numbers.
enum class Quality : std::uint8_t {
  draft,        ///< The field is looked up; direct light of emissive surfaces stays noisy.
  interactive,  ///< One ray a pixel gathers its light, and all noise is filtered.
  high,         ///< Some 64 rays a pixel, and all noise is filtered.
};

/// The settings of a named set; all others have their defaults.
FrameSettings quality_settings(Quality quality);

/// Fails with the first setting that is out of range.
Expected<void> check(const FrameSettings& settings);

struct RenderedFrame {
  /// Linear radiance and its parts, see docs/cli.md, "Layers": "" (the whole), direct, indirect,
  /// irradiance, glossy, transmission, emission, fog, albedo, normal, position, depth, and motion
  /// where it was asked for. As high as the rows that were rendered.
  LayeredImage image;
  std::vector<PassTime> passes;  ///< In the order of the frame.
  std::uint64_t rays = 0;        ///< Traced primary, gather and shadow rays.
};

/// The sources of a frame's indirect light, which add up.
struct IndirectSources {
  const IrradianceField* field = nullptr;  ///< Null: none.
  /// A field with the part of `field`'s light that `rsm` contains, too: it is subtracted from the
  /// light that pixels receive. Null: nothing is subtracted. Needs both `field` and `rsm`.
  const IrradianceField* subtracted_field = nullptr;
  /// One bounce of directional, point and spot lights from reflective shadow maps; empty: none.
  /// Not together with FrameSettings::gather_rays.
  std::optional<RsmSettings> rsm = std::nullopt;
  bool rsm_stages = false;  ///< Also output the layers "rsm.flux", "rsm.mosaic", ... (docs/rsm.md).
};

/// Renders pictures of a world, one after the other: direct light with shadow rays, and indirect
/// light from the sources. Surfaces without a diffuse base reflect the light of the field, or
/// without a field, that of the maps. The memory of its passes is reused from picture to picture,
/// and grows only where one needs more: about 50 MB, for maps as RsmSettings say, and on a device
/// 144 bytes for each pixel of a picture. Not thread-safe.
class Renderer {
 public:
  /// Refers to the world and to the sources' fields, which must outlive it and must not be moved;
  /// they may be updated between pictures. Without sources, pictures have direct light and emission
  /// alone.
  explicit Renderer(const World& world, const IndirectSources& sources = {});
  /// A temporary world would not outlive the renderer.
  explicit Renderer(const World&& world, const IndirectSources& sources = {}) = delete;
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Renders what the camera sees. Runs on all cores. The result has the same bits on any number of
  /// threads, and whatever was rendered before, except for motion, light averaged over pictures and
  /// temporal anti-aliasing. Fails on settings and sources that are out of range or do not go
  /// together, and on a camera that validate refuses in a scene. Throws std::runtime_error where
  /// the device's memory runs out, and std::bad_alloc where the processor's does.
  Expected<RenderedFrame> render(const Camera& camera, const FrameSettings& settings = {},
                                 const ProgressFn& progress = {});
  /// Renders into a frame whose memory is reused. Its contents are replaced, unless this fails.
  Expected<void> render(const Camera& camera, const FrameSettings& settings, RenderedFrame& frame,
                        const ProgressFn& progress = {});

  /// Number of pictures, or parts of pictures, that were rendered.
  std::uint64_t frames() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Points that the camera sees, one per pixel of a picture of this size (1 to 16384 each), row
/// after row; pixels that show the sky have none. For UpdateRequest::seen a small picture is
/// enough. Fails on other sizes, and on a camera that validate refuses in a scene.
Expected<std::vector<FieldQuery>> visible_points(const World& world, const Camera& camera,
                                                 int width, int height);

}  // namespace lambent
