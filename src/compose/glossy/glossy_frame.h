// SPDX-License-Identifier: Apache-2.0
// Light that coats reflect from rays of their own, on the processor.
//
// A pixel's coat sends out one ray, drawn from its lobe. The ray's hit is lit like a pixel: by
// direct light, by the field and, where its own coat is sharp, by further rays. Then each pixel
// reflects the rays around it, weighted by its own lobe. docs/math.md, "Reflections".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "compose/glossy/ray_reuse.h"
#include "compose/glossy/seen_through.h"
#include "glossy/path_math.h"
#include "lambent/field.h"

namespace lambent {

/// Rows above and below a band whose rays its pixels use.
inline int glossy_halo(int rows) {
  return kReuse * rows;
}

/// Fills in GBuffer::coat_shares.
void find_coat_shares(GBuffer& pixels);

/// The paths of the rays of pixels, one entry a pixel.
struct Paths {
  std::vector<CoatPath> paths;
  std::vector<Ray> next;       ///< Valid where the path has not ended.
  std::vector<RayCone> cones;  ///< Valid where the path has not ended.

  /// Makes room for this many pixels, none of which has a path yet.
  void start(std::size_t pixels) {
    paths.assign(pixels, begin_path(0.0f, 0.0f, kStageOther, 0.0f));
    next.resize(pixels);
    cones.resize(pixels);
  }
};

class Glossy {
 public:
  /// Computes the light of the coats of `band`'s pixels from rays. `around` lists the rows from
  /// glossy_halo() above the band to as many below it, within the picture and including the band,
  /// all with their coat_shares. `keeps_mirrored`: what mirrors show is stored apart in CoatLight.
  /// Returns the number of rays traced.
  std::uint64_t reflect(const GlossySettings& settings, std::span<const GlossyRows> around,
                        const GlossyRows& band, bool keeps_mirrored, CoatLight& light);

  /// Computes the light transmitted through the surfaces of `band`'s pixels. Returns the number of
  /// rays traced.
  std::uint64_t look_through(const GlossySettings& settings, const GlossyRows& band,
                             const KeptBehind& kept, TransmittedLight& light);

 private:
  void start(const GlossySettings& settings, int first_row, std::size_t pixels, uint salt);
  std::uint64_t send_through(const GlossySettings& settings, const GBuffer& seen);
  std::uint64_t follow_all(const GlossySettings& settings, std::uint64_t going,
                           std::uint32_t first_bounce, const KeptBehind& kept);
  void split_paths(const GlossySettings& settings, std::uint32_t bounce);
  void keep_behind(const GlossySettings& settings, const KeptBehind& kept);
  void keep_mirrored_bases();
  std::uint64_t send_rays(const GlossySettings& settings, std::span<const GlossyRows> around,
                          bool keeps_mirrored);
  bool draw_ray(const GlossySettings& settings, const GBuffer& seen, std::size_t i, vec2 u,
                std::size_t place);
  std::uint64_t send_further_rays(const GlossySettings& settings, const GlossyRows& band,
                                  const CoatLight& light, uint ray);
  std::uint64_t add_further_rays(const GlossySettings& settings, const GlossyRows& band,
                                 CoatLight& light);
  /// Adds the light of sources behind rough surfaces, which pixels (bounce 0) or paths hit. Returns
  /// the number of rays traced.
  std::uint64_t sample_lights_behind(const GlossySettings& settings, const GBuffer& seen,
                                     std::uint32_t bounce);
  std::uint64_t follow_rays(const GlossySettings& settings, std::uint32_t bounce);
  void add_field_light(const GlossySettings& settings);
  std::uint64_t light_hits(const GlossySettings& settings, std::uint32_t bounce);

  uint salt_ = 0;                    // of the random numbers
  bool samples_behind_ = false;      // there may be lights behind rough surfaces to sample
  bool gathers_in_mirrors_ = false;  // see gathers_in_mirrors()
  bool gathers_behind_ = false;      // see gathers_behind_glass()
  // One entry for each pixel of the rows around the band
  int first_row_ = 0;
  std::vector<CoatRay> rays_;
  Paths paths_, forks_;  // the paths being traced, and the branches to be traced later
  std::vector<MirroredCoat> mirrored_;     // empty where these are not kept
  std::vector<ShownBase> mirrored_bases_;  // empty where these are not kept
  std::vector<ShownBase> bases_behind_;    // TransmittedLight::bases
  std::vector<float> coat_distances_;      // TransmittedLight::coat_distances
  GBuffer met_;                            // the paths' hits
  ReflectedLight direct_;
  std::vector<FieldQuery> queries_;
  std::vector<std::size_t> asked_;  // the queries' pixels
  std::vector<glm::vec3> answers_;
  RayReuse reuse_;
};

/// A band's pixels after show_clearcoats(), and the light of their rays.
struct ClearcoatsShown {
  GBuffer surfaces;
  CoatLight rays;
};

/// Memory of the pass, reused from band to band.
struct GlossyMemory {
  Glossy coats;
  GBuffer above, below;                         ///< The rows around the band.
  ClearcoatsShown clearcoats;                   ///< Those of the band.
  std::vector<glm::vec3> clearcoat_irradiance;  ///< The field's irradiance for clearcoats.
  std::vector<FieldQuery> queries;
  std::vector<std::size_t> asked;  ///< The queries' pixels.
  std::vector<glm::vec3> answers;
};

/// The two specular layers of a surface.
enum class CoatKind : std::uint8_t { coat, clearcoat };

/// Replaces each surface's reflectance by that of its clearcoat alone.
void show_clearcoats(GBuffer& pixels);

/// Inputs of a sample's reflections; `frame`: the frame's settings, with the seed to draw with.
GlossySettings glossy_settings(const FrameRequest& request, const FrameSettings& frame, int sample);

/// Computes the light that the coats of a band's pixels, or their clearcoats, reflect from rays.
/// For clearcoats, `pixels` must come from show_clearcoats(). `sky`: what they reflect of samples
/// of the sky, see ReflectedLight, which is added; empty where there is none. `light`: see
/// Glossy::reflect; empty where no pixel reflects rays. Traces the primary rays of the rows above
/// and below the band once more. Returns the number of rays traced.
std::uint64_t reflect_band(const FrameRequest& request, const Band& band, int sample, CoatKind kind,
                           const GBuffer& pixels, std::span<const glm::vec3> sky,
                           GlossyMemory& memory, CoatLight& light);

/// Whether what coats that mirrors show reflect is filtered, and light on the bases there; see
/// MirroredCoat and ShownBase.
bool filters_mirrored_light(const FrameRequest& request);

/// Whether the surfaces that mirrors show gather their indirect light by rays of their own.
bool gathers_in_mirrors(const FrameRequest& request);

/// Whether the light of clearcoats from rays is filtered, at pixels with is_filtered_clearcoat().
bool filters_clearcoats(const FrameRequest& request);

/// Computes the light that the clearcoats of a band's pixels reflect, from rays and from the field,
/// without the lights' direct light and without what is to be filtered. `sky`: see reflect_band().
/// `light` is empty where no pixel has a clearcoat; otherwise `memory.clearcoats` is filled in.
/// Returns the number of rays traced.
std::uint64_t reflect_clearcoats(const FrameRequest& request, const Band& band, int sample,
                                 const GBuffer& pixels, std::span<const glm::vec3> sky,
                                 GlossyMemory& memory, std::vector<glm::vec3>& light);

/// Computes the light transmitted through the surfaces of a band's pixels. Returns the number of
/// rays traced.
std::uint64_t look_through_band(const FrameRequest& request, const Band& band, int sample,
                                const GBuffer& pixels, const KeptBehind& kept, GlossyMemory& memory,
                                TransmittedLight& light);

/// Looks up the field's irradiance on surfaces that face coat_direction(), where coats have light
/// that does not come from rays; 0 at other pixels.
void look_up_coats(const FrameRequest& request, const GBuffer& pixels, const CoatLight& by_rays,
                   GlossyMemory& memory, std::vector<glm::vec3>& irradiance);

}  // namespace lambent
