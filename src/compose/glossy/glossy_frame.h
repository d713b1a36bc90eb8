// SPDX-License-Identifier: Apache-2.0
// Light that coats reflect, by rays of their own, on the processor.
//
// A pixel's coat sends out one ray, drawn of its lobe. What the ray meets is lit as a pixel is:
// directly, by the field, and where it shines by further rays. Then each pixel reflects the rays
// around it, each with the weight of its own lobe. docs/math.md, "Reflections".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "compose/glossy/ray_reuse.h"
#include "compose/glossy/seen_through.h"
#include "glossy/way_math.h"
#include "lambent/field.h"

namespace lambent {

/// Rows above and below a band whose rays its pixels take.
inline int glossy_halo(int rows) {
  return kReuse * rows;
}

/// Share of each pixel's coat that rays light, 0 to 1: GBuffer::coat_shares.
void find_coat_shares(GBuffer& pixels);

/// Ways of the rays of pixels, an entry a pixel.
struct Ways {
  std::vector<CoatPath> paths;
  std::vector<Ray> next;  ///< Of paths that have not ended, as are:
  std::vector<RayCone> cones;

  /// Makes room for so many, none of which there is yet.
  void start(std::size_t pixels) {
    paths.assign(pixels, {vec3(1.0f), 0.0f, 0.0f, kStageOther, kForksNowhere});
    next.resize(pixels);
    cones.resize(pixels);
  }
};

class Glossy {
 public:
  /// Light of the coats of `band`'s pixels by rays. `around` lists rows from glossy_halo above the
  /// band to as many below it, as far as the picture reaches, the band among them; all with their
  /// coat_shares. Returns the rays traced.
  std::uint64_t reflect(const GlossySettings& settings, std::span<const GlossyRows> around,
                        const GlossyRows& band, CoatLight& light);

  /// Light that comes through the surfaces of `band`'s pixels. Returns the rays traced.
  std::uint64_t look_through(const GlossySettings& settings, const GlossyRows& band,
                             const KeptBehind& kept, TransmittedLight& light);

 private:
  void start(const GlossySettings& settings, int first_row, std::size_t pixels, uint salt);
  std::uint64_t send_through(const GlossySettings& settings, const GBuffer& seen);
  std::uint64_t follow_all(const GlossySettings& settings, std::uint64_t going,
                           std::uint32_t first_bounce, const KeptBehind& kept);
  void fork_ways(const GlossySettings& settings, std::uint32_t bounce);
  void keep_behind(const GlossySettings& settings, const KeptBehind& kept);
  std::uint64_t send_rays(const GlossySettings& settings, std::span<const GlossyRows> around);
  std::uint64_t follow_rays(const GlossySettings& settings, std::uint32_t bounce);
  std::uint64_t light_hits(const GlossySettings& settings, std::uint32_t bounce);

  uint salt_ = 0;  // of the random numbers
  // Of the rows around the band, an entry a pixel
  int first_row_ = 0;
  std::vector<CoatRay> rays_;
  Ways ways_, forks_;  // what is followed, and branches to be followed later, if any
  std::vector<float> coat_distances_;  // TransmittedLight::coat_distances
  GBuffer met_;                        // by these
  ReflectedLight direct_;
  std::vector<FieldQuery> queries_;
  std::vector<std::size_t> asked_;  // pixels of the queries, and what is asked for there
  std::vector<glm::vec3> answers_;
  RayReuse reuse_;
};

/// A band's pixels as show_clearcoats leaves them, and their light of rays.
struct ClearcoatsShown {
  GBuffer surfaces;
  CoatLight rays;
};

/// Memory of the pass, kept from band to band.
struct GlossyMemory {
  Glossy coats;
  GBuffer above, below;                         ///< The band.
  ClearcoatsShown clearcoats;                   ///< Of the band.
  std::vector<glm::vec3> clearcoat_irradiance;  ///< Their light of the field.
  std::vector<FieldQuery> queries;
  std::vector<std::size_t> asked;  ///< Pixels of the queries, and what is answered.
  std::vector<glm::vec3> answers;
};

/// Which of a surface's coats.
enum class CoatKind : std::uint8_t { coat, clearcoat };

/// Makes the clearcoats of surfaces their coats, with nothing under them.
void show_clearcoats(GBuffer& pixels);

/// Has the coats of a band's pixels reflect rays; where these are clearcoats, they are shown so;
/// `light` as of Glossy::reflect, empty where no pixel does. Rows above and below the band are seen
/// for that once more. Returns the rays traced.
std::uint64_t reflect_band(const FrameRequest& request, const Band& band, int sample, CoatKind kind,
                           const GBuffer& pixels, GlossyMemory& memory, CoatLight& light);

/// Whether light of clearcoats by rays is filtered where is_filtered_clearcoat().
bool filters_clearcoats(const FrameRequest& request);

/// Light that the clearcoats of a band's pixels reflect but for what lights sent them straight and
/// for what is to be filtered: by rays and by the field. Empty where no pixel has one; else
/// `memory.clearcoats` are theirs. Returns the rays traced.
std::uint64_t reflect_clearcoats(const FrameRequest& request, const Band& band, int sample,
                                 const GBuffer& pixels, GlossyMemory& memory,
                                 std::vector<glm::vec3>& light);

/// Light that comes through the surfaces of a band's pixels. Returns the rays traced.
std::uint64_t look_through_band(const FrameRequest& request, const Band& band, int sample,
                                const GBuffer& pixels, const KeptBehind& kept, GlossyMemory& memory,
                                TransmittedLight& light);

/// The field's irradiance where coats have light from no ray, on surfaces that face
/// coat_direction(); 0 at other pixels.
void look_up_coats(const FrameRequest& request, const GBuffer& pixels, const CoatLight& by_rays,
                   GlossyMemory& memory, std::vector<glm::vec3>& irradiance);

}  // namespace lambent
