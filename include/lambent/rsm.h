// SPDX-License-Identifier: Apache-2.0
// One bounce of indirect light from lights without extent: reflective shadow maps that are gathered
// in interleaved sub-images. docs/rsm.md shows each stage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/image.h"
#include "lambent/pass_time.h"
#include "lambent/scene.h"

namespace lambent {

class World;

/// Which texels of its sub-map a pixel gathers.
enum class RsmPattern : std::uint8_t {
  whole,  ///< All of them: no light is lost. The default.
  disk,   ///< Samples around the pixel's projection into the map, sparser outwards, as published.
          ///< Sharper nearby; light from beyond the disk is lost.
};

/// How maps and pixels lie in memory while they are gathered.
enum class RsmLayout : std::uint8_t {
  restructured,  ///< Maps as sub-maps, pixels as sub-images. The default.
  sub_maps,      ///< Maps as sub-maps, pixels as they lie in the picture.
  full,          ///< Both as rendered. With sub_images = 1, this is the plain gather.
};

/// Settings of indirect light from reflective shadow maps (RSMs).
struct RsmSettings {
  /// Texels along an edge of each light's map, 1 to 4096. Each costs two rays a frame at most.
  int resolution = 512;
  /// Number of texels of each map whose light is gathered, drawn in proportion to their
  /// contribution to the picture, 1 to 65536; 0: every texel. With RsmPattern::disk, the number of
  /// samples in the disk. Cost is in proportion.
  int texels = 1024;
  /// Sub-maps along an edge, 1 to 16: a pixel gathers texels / sub_maps^2.
  int sub_maps = 4;
  /// Sub-images along an edge of the picture, 1 to 16, a multiple of sub_maps.
  int sub_images = 4;
  RsmPattern pattern = RsmPattern::whole;      ///< See RsmPattern.
  RsmLayout layout = RsmLayout::restructured;  ///< See RsmLayout; changes no result.
  /// RsmPattern::disk: radius as a share of the map's edge, above 0 to 2.
  float disk_radius = 0.3f;
  /// Draw texels by the light that they send to surfaces in view, not by their power alone.
  bool view_importance = true;
  /// Distribute neighbouring texels to sub-maps in an irregular order: noise in place of structure.
  bool shuffle = true;
  /// Area over which a texel's light is spread, in multiples of the area that it represents, 0.01
  /// to 100. Lower values are sharper in corners, but leave spots there.
  float softening = 1.0f;

  /// Radius of the blur inside each sub-image [its pixels], 0 (none) to 4.
  int sub_blur_radius = 1;
  /// Repeat that blur with taps at irregular distances, which reach farther.
  bool irregular_blur = false;
  /// Blur the interleaved picture over as many pixels as there are sub-images, so that each pixel
  /// receives light of all sub-maps.
  bool final_blur = true;
  /// Distance from a pixel's plane at which another pixel has no weight in a blur, as a share of
  /// the depth, above 0 to 1.
  float plane_tolerance = 0.02f;

  /// Shadow rays per pixel and light that test the visibility of gathered texels, 0 (all count as
  /// visible) to 64. Texels that contribute most are tested most.
  int visibility_rays = 0;
  /// The picture is gathered at 1 / downscale of its width and height, 1 to 16.
  int downscale = 1;
  /// Use one map seen from the camera, lit by all lights, in place of one from each light: this
  /// includes the light of emissive surfaces, but no light from outside the picture.
  bool from_camera = false;
  /// Merge the texels of all lights' maps into `texels` clusters in all, rather than draw `texels`
  /// from each map: a gather of many lights then costs as much as that of one. Needs
  /// RsmPattern::whole and `texels` above 0.
  bool merge_maps = false;

  /// In a frame (FrameSettings): also compute the direct light of directional, point and spot
  /// lights in the sub-images, with shadow rays, once per pixel of the view, and use it for all
  /// samples of the frame. Not with `from_camera`.
  bool direct = false;
  /// With `direct`: lights to which each pixel traces a shadow ray, 0 (all) to 65536. Fewer lights
  /// than all are distributed over the sub-maps, at least so many that each light is in one, and
  /// their light is blurred over as many pixels as there are sub-images. In addition, each pixel
  /// traces a ray to the light that is brightest there.
  int direct_lights = 0;
  std::uint32_t seed = 1;  ///< Of all random numbers.
};

/// The plain gather, the reference for measurements: every pixel gathers all texels, from maps as
/// they were rendered, and nothing is blurred.
inline RsmSettings plain_gather() {
  RsmSettings settings;
  settings.sub_maps = settings.sub_images = 1;
  settings.sub_blur_radius = 0;
  settings.final_blur = false;
  settings.layout = RsmLayout::full;
  return settings;
}

/// Fails with the first setting that is out of range.
Expected<void> check(const RsmSettings& settings);

/// A small area light: the light that a texel of a map reflects, as a Lambert surface does. 48
/// bytes, in this order, in every buffer of texels. The flux begins a group of 16 bytes.
struct RsmTexel {
  glm::vec3 position_ws{0.0f};  ///< [m], a little off the surface.
  float area = 0.0f;            ///< Area that it represents [m^2]; 0: it hit nothing.
  glm::vec3 normal_ws{0.0f};    ///< Unit, on the lit side; 0: it hit nothing.
  float softening = 0.0f;       ///< Added to squared distances [m^2], see src/rsm/geometry_term.h.
  glm::vec3 flux{0.0f};         ///< Reflected [W].
  float unused = 0.0f;          ///< Padding to 16 bytes.
};

/// The projection of a map.
struct RsmProjection {
  enum class Kind : std::uint8_t { orthographic, perspective, octahedral };
  Kind kind = Kind::octahedral;
  glm::vec3 origin_ws{0.0f};         ///< Centre of the near plane, or position of the light [m].
  glm::mat3 world_from_light{1.0f};  ///< Orthonormal; looks along its -Z.
  glm::vec2 half_extent{1.0f};  ///< Orthographic [m]; perspective: tangents of the half angles.
};

/// The scene as a light sees it: position, normal and reflected flux of each texel.
struct ReflectiveShadowMap {
  RsmProjection projection;
  int resolution = 0;            ///< Texels along an edge.
  std::vector<RsmTexel> texels;  ///< resolution^2, rows from the top.
};

/// The map of a light. Directional: orthographic, fitted to the scene; spot: perspective, as wide
/// as the cone, or octahedral where that is wider than 120 degrees; point: octahedral. A light
/// whose rays hit nothing has a map without flux. Fails on settings out of range, and on a light
/// that validate refuses in a scene. Runs on all cores.
Expected<ReflectiveShadowMap> render_rsm(const World& world, const Light& light,
                                         const RsmSettings& settings);

/// The map of what the camera sees, `aspect` its width over height, > 0, lit by all lights and
/// emissive surfaces. Fails on settings and an aspect out of range, and on a camera that validate
/// refuses in a scene.
Expected<ReflectiveShadowMap> render_rsm(const World& world, const Camera& camera, float aspect,
                                         const RsmSettings& settings);

/// The maps that the settings ask for: one per light, or the camera's. Fails as render_rsm does.
Expected<std::vector<ReflectiveShadowMap>> render_rsms(const World& world, const Camera& camera,
                                                       float aspect, const RsmSettings& settings);

/// The surfaces that the camera sees, rows from the top; each span has width * height entries. The
/// caller owns all of them.
struct RsmView {
  int width = 0, height = 0;
  std::span<const glm::vec3> positions_ws;  ///< [m]
  std::span<const glm::vec3> normals_ws;    ///< Unit, towards the camera; 0 where nothing is seen.
  std::span<const float> depths;  ///< Along the axis of view [m], > 0; 0 where nothing is seen.
};

/// One bounce of light at each pixel of a view.
struct RsmIrradiance {
  int width = 0, height = 0;
  std::vector<glm::vec3> irradiance;  ///< [W/m^2], rows from the top; 0 where nothing is seen.
  std::vector<PassTime> passes;       ///< In the order of the frame.
  std::uint64_t rays = 0;             ///< Traced for visibility.
  /// If requested: "rsm.mosaic" (the sub-images side by side, as they were gathered),
  /// "rsm.gathered" (interleaved, before any blur), "rsm.interleaved" (after the blur of
  /// sub-images), "rsm.blurred" (after the last one).
  std::vector<Layer> stages;
};

/// Gathers the light of maps. Reuses its buffers (52 bytes per pixel) from frame to frame.
class RsmGatherer {
 public:
  RsmGatherer();
  ~RsmGatherer();
  RsmGatherer(RsmGatherer&&) noexcept;
  RsmGatherer& operator=(RsmGatherer&&) noexcept;

  /// Gathers the light of all maps at each pixel of the view into `result`, whose memory is reused.
  /// The world is used for visibility only. Fails on settings out of range, and on a view without
  /// pixels or whose spans are of other lengths. Runs on all cores; the same inputs give the same
  /// bits on any number of threads.
  Expected<void> gather(const World& world, std::span<const ReflectiveShadowMap> maps,
                        const RsmView& view, const RsmSettings& settings, RsmIrradiance& result,
                        bool keep_stages = false);

  /// Gathers the light of the maps that render_rsms would return. They are rendered one after the
  /// other, and only one is in memory at a time (with RsmLayout::full, all of them), so that memory
  /// does not grow with the number of lights. Fails as `gather` and render_rsms do.
  Expected<void> gather(const World& world, const Camera& camera, float aspect, const RsmView& view,
                        const RsmSettings& settings, RsmIrradiance& result,
                        bool keep_stages = false);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

/// The map's flux as a picture, divided by the flux of the brightest texel.
Image flux_image(const ReflectiveShadowMap& map);

}  // namespace lambent
