// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/error.h"
#include "lambent/pass_time.h"
#include "lambent/scene.h"

namespace lambent {

class World;

/// How a probe's irradiance is stored. All three conserve light: they round without bias.
enum class IrradianceFormat : std::uint8_t {
  rgb9e5,      ///< 4 bytes a texel: 9 bits a channel under a shared exponent, linear. The default.
  r11g11b10f,  ///< 4 bytes a texel: small floats, perceptually encoded (exponent 5), as published.
  float32,     ///< 12 bytes a texel, for verification.
};

/// How a probe's mean distance and mean squared distance are stored.
enum class DistanceFormat : std::uint8_t {
  rg16f,  ///< 4 bytes a texel: half floats. The default.
  rg32f,  ///< 8 bytes a texel, for verification.
};

/// How a lookup finds which of the eight probes around a point it sees.
enum class Visibility : std::uint8_t {
  moments,  ///< From the probes' distances. The default; no rays.
  hybrid,   ///< From distances, and by a ray where these are in doubt and the probe has a weight.
  exact,    ///< By a ray to each probe that could count.
};

/// Settings of an irradiance field. All have a sensible default.
struct FieldSettings {
  /// Probes along each axis, each >= 2, or all 0: as many as `probe_spacing` asks for.
  glm::ivec3 probe_count{0};
  /// Distance between neighbouring probes [m], > 0; 0: chosen so that there are about
  /// `probe_budget` probes. Halving it costs 8 times the rays and memory.
  float probe_spacing = 0.0f;
  /// Probes to aim at where neither count nor spacing is given, >= 8. Costs grow in proportion.
  int probe_budget = 4096;
  /// Where the outermost probes stand [m]; empty: fitted to the scene, just inside its bounding
  /// surfaces.
  Bounds volume{};
  /// Number of nested volumes around the viewer that replace the one fitted to the scene, 0 to 16;
  /// 0: none. Each has `probe_count` probes (0: 32 x 4 x 32). The finest has a spacing of
  /// `probe_spacing` [m] (0: 1), and each further one twice the spacing of the one before. They
  /// scroll with UpdateRequest::viewer_ws; coarse ones are updated less often. `volume` must be
  /// empty.
  int cascades = 0;
  /// Additional volumes, in which light is finer, such as those of Scene::volumes; at most 64 with
  /// the others. Each counts within its box and a cell around it. The cost is in proportion to its
  /// probes.
  std::vector<ProbeVolume> volumes = {};

  /// Rays a probe traces in an update, 16 to 4096. Cost is in proportion; noise falls with the
  /// square root.
  int rays_per_probe = 144;
  /// Share of the old value that an update keeps once enough updates have been averaged, 0 to
  /// 0.999. Higher is smoother. Edits of the world take effect without regard to it, so that it
  /// need not be low.
  float hysteresis = 0.99f;

  /// Texels of a probe's irradiance tile along an edge, without gutter, even, 2 to 16. Bytes
  /// and the cost of blending grow with the square.
  int irradiance_texels = 4;
  /// Texels of a probe's distance tile along an edge, without gutter, 4 to 32. More resolve finer
  /// occluders; bytes and the cost of blending grow with the square.
  int distance_texels = 14;
  /// How irradiance is stored; bytes a texel beside each format.
  IrradianceFormat irradiance_format = IrradianceFormat::rgb9e5;
  /// How distances are stored; bytes a texel beside each format.
  DistanceFormat distance_format = DistanceFormat::rg16f;

  /// Moves probes off the grid by at most 45 % of a cell: out of geometry, and to just in front of
  /// the surfaces near them.
  bool relocation = true;
  /// Learns, on small cells of the surfaces, by which factor lookups are off, and corrects them:
  /// probes stand in the air and see more than a surface in a nook does. Some of an update's
  /// surfels gather light with rays of their own, which costs up to as much as the update at first,
  /// and less later. Takes 4.4 KB a probe, and on a device as much again as it learns of an
  /// update's samples. With all bounces (`max_bounces` -1), and in volumes that do not follow the
  /// viewer. Fields that engines record (vulkan::RecordedField) read corrections of files and learn
  /// none.
  bool corrections = true;
  /// How lookups determine which probes they see: those of surfels and, where a world is given,
  /// those of queries. Of fields that engines record those of surfels and, where a shader traces
  /// rays, the engine's own.
  Visibility visibility = Visibility::moments;

  /// The solve for multi-bounce light stops when its estimated relative error falls below this,
  /// 1e-7 to 1. A tenth of it costs a few more iterations. Below about 1e-6, rounding prevents it.
  float solve_tolerance = 0.002f;
  /// The solve stops after this many iterations in any case, 1 to 1000. Each costs a fraction of
  /// tracing.
  int max_solve_iterations = 32;
  /// Bounces of indirect light to carry, >= 0; -1: all. 0 is the sky's light alone. A limit is
  /// exact but not accelerated: each bounce costs an iteration of the solve.
  int max_bounces = -1;
  /// Upper bound of the mean albedo of surfels over all directions, so that light always dies out,
  /// 0 to 0.99. A bound below the albedo of the surfaces makes rooms too dark. Albedos of
  /// hits that engines hand in are bounded one by one.
  float max_albedo = 0.98f;

  /// Samples of emissive triangles, and of point and spot lights where there are many, for a
  /// surfel's direct light, 1 to 64. Each costs a shadow ray.
  int emissive_samples = 1;
  /// Added to the MIP level that a probe ray's footprint asks for [levels], finite. Lower is
  /// sharper and slower.
  float texture_lod_bias = 0.0f;

  /// Seed of all random numbers. Fields of different seeds have independent noise.
  std::uint32_t seed = 1;
};

/// The grid of a volume: the place of the probe of coordinates c is origin + axes * (c * spacing).
struct FieldGrid {
  glm::vec3 origin{0.0f};   ///< Place of probe (0, 0, 0) [m].
  glm::vec3 spacing{1.0f};  ///< Distance between neighbouring probes along each axis [m].
  glm::ivec3 count{2};      ///< Number of probes along each axis, each >= 2.
  glm::mat3 axes{1.0f};     ///< Columns: the grid's axes in world space, unit and orthogonal.
  /// The number of all probes.
  int probes() const { return count.x * count.y * count.z; }
};

/// The grid that the settings ask for in a scene of these bounds, without cascades and further
/// volumes. Fails on counts, spacings or volumes that make no sense and on more probes than memory
/// could hold.
Expected<FieldGrid> fit_grid(const FieldSettings& settings, const Bounds& scene_bounds);

/// A point to look the field up at. All numbers must be finite.
struct FieldQuery {
  glm::vec3 position_ws{0.0f};  ///< [m]
  glm::vec3 normal_ws{0.0f, 1.0f,
                      0.0f};  ///< Unit; irradiance is that of a surface with this normal.
  glm::vec3 to_viewer_ws{
      0.0f, 1.0f, 0.0f};  ///< Unit; towards the camera, or back along the ray that found the point.
  /// Length of the unoccluded segment towards the viewer [m], >= 0: that of the ray that found the
  /// point. Visibility is tested from a point on this segment, and so never from behind a wall that
  /// the viewer is close to.
  float viewer_distance = std::numeric_limits<float>::infinity();
};

/// What an update may cost, and for whom.
struct UpdateRequest {
  /// Probe rays to trace at most, not counting those of FieldSettings::corrections, which are in
  /// proportion. 0: no bound, and every probe is traced with as many rays as the settings say,
  /// whether its light has settled or not; so it is, too, where FieldSettings::max_bounces is not
  /// -1, since an exact number of bounces needs all probes at once. With a bound, probes whose
  /// light is least settled go first, with 32 to 512 rays each depending on their noise, and
  /// settled ones are not traced.
  std::uint64_t ray_budget = 0;
  /// Wall-clock time to take [ms]; no bound where it is not above 0. The field learns how many rays
  /// that allows; the smaller of both bounds holds. Placing probes, in the first update and after
  /// edits of static geometry, takes the time that it needs. Edits come first, and may take all of
  /// it. Where the rest of the work takes longer than half of this time, half of it goes to edits
  /// or rays all the same, and the update exceeds it.
  double time_budget_ms = 0.0;
  /// Where the camera is [m]: of probes equally unsettled, near ones go first, and cascades follow.
  /// Numbers that are not finite count as none.
  std::optional<glm::vec3> viewer_ws = std::nullopt;
  /// Points that the camera sees (visible_points), some hundred to a few thousand: with a bound,
  /// probes go first by how much they matter to the light at these, near or far. Costs a lookup a
  /// point and about half an iteration of the solve. Empty: by their distance from the viewer.
  std::span<const FieldQuery> seen = {};
};

/// How many probes are in each state. Majercik et al., JCGT 10(2), 2021, sec. 5.
struct ProbeCounts {
  int off = 0;             ///< In solid matter: neither traced nor looked up.
  int sleeping = 0;        ///< Near no surface: traced in turns, for fog and gathering.
  int newly_awake = 0;     ///< Something that moves came near; not traced since.
  int awake = 0;           ///< Light something that moves.
  int newly_vigilant = 0;  ///< Light static surfaces; not traced yet.
  int vigilant = 0;        ///< Light static surfaces.
};

/// What an update did.
struct UpdateStatistics {
  /// The passes that ran, in their order, and their times: wall-clock time on the processor, the
  /// device's own time on a device. A pass that ran several times is there once.
  /// "placement": scrolling, relocation and classification. "edits": bringing stale probes up to
  /// date with edits of the world. "schedule": choosing the probes to trace. "trace": closest hits
  /// of their rays. "shade": surfaces, and direct light with shadow rays. "blend_distances":
  /// distances into the store. "visibility": which probes see each other, with hybrid visibility.
  /// "corrections": gathers that measure the errors of lookups. "lookups": lookup weights of
  /// surfels. "solve": multi-bounce solve, of edits too.
  /// "variability": how much the light changed. "store": irradiance into the store.
  std::vector<PassTime> passes;
  /// Time of a pass [ms]; 0 where it did not run.
  double ms(std::string_view pass) const;
  std::uint64_t probe_rays = 0;  ///< Traced from probes.
  /// Traced for FieldSettings::corrections, shadow rays included.
  std::uint64_t correction_rays = 0;
  std::uint64_t shadow_rays = 0;  ///< Traced from surfels to lights and emissive surfaces.
  int probes_traced = 0;          ///< With new rays.
  int probes_recycled = 0;        ///< Moved to a new place by a scrolling volume.
  int probes_invalidated = 0;     ///< Brought up to date with edits of the world.
  int probes_changed = 0;         ///< Those of them whose light the edits changed.
  int probes_stale = 0;           ///< Not yet up to date with edits after the update.
  ProbeCounts states;             ///< After the update.
  int solve_iterations = 0;       ///< Iterations of the multi-bounce solve.
  /// Estimated relative error this update stopped at; of all probes but those in turns, see
  /// ProbeCounts::sleeping.
  double residual = 0.0;
  double change = 0.0;  ///< Of those probes' stored light, root mean square over root mean square.
};

/// Volumes of irradiance probes with visibility, and the light that bounces between them.
class IrradianceField {
 public:
  /// A field that holds no light yet, for a place of these bounds [m]. Fails on settings out of
  /// range, as fit_grid does, and on volumes outside the bounds.
  static Expected<IrradianceField> make(const FieldSettings& settings, const Bounds& scene_bounds);
  ~IrradianceField();
  IrradianceField(IrradianceField&&) noexcept;
  IrradianceField& operator=(IrradianceField&&) noexcept;

  /// Brings the field up to date. Where the world was edited since the last update (World::update),
  /// it traces the rays and shadow rays again that the edits may have affected, solves for the
  /// light of all bounces, and changes exactly those probes whose light the edits changed.
  /// Otherwise, or with the rest of the budget, it traces probes with new rays, solves, and blends
  /// the result into the store. Where edits come in every update and there is no budget, new rays
  /// are traced in every second update.
  ///
  /// The world may be another object than before, but must then be of the same scene, unedited; it
  /// is not kept. Not to be called while the field is read. The same calls with the same seed give
  /// the same bits on any number of threads, unless time is bounded. Throws std::bad_alloc where
  /// memory runs out.
  UpdateStatistics update(const World& world, const UpdateRequest& request = {});

  /// Discards all light. The next update starts without any.
  void reset();

  /// Indirect irradiance [W/m^2] at each query: light that bounced, and light from the sky; not
  /// what lights and emissive surfaces send straight. Near surfaces it follows edits within the
  /// update that applies them; in open air, within seven. There, farther than a cell from surfaces
  /// that keep still and from the bounds of instances that move, probes are traced in one of 16
  /// updates, so that noise falls more slowly: to half within 60 updates. Where few probes are
  /// near surfaces, it is one of up to 64; in coarse volumes of cascades, a share of that. Of
  /// spans of different lengths the rest of the longer one is left alone. Queries outside all
  /// volumes are answered by the nearest probes of the last. Runs on all cores. `world` is what
  /// FieldSettings::visibility traces rays in. Visibility is by distances where it is null, or not
  /// on the device that holds the field.
  void irradiance(std::span<const FieldQuery> queries, std::span<glm::vec3> result,
                  const World* world = nullptr) const;

  /// The grids of its volumes, in the order in which lookups use them: high priority first, and of
  /// equal priority the finest first. The last one covers everything that is left.
  std::span<const FieldGrid> grids() const;
  /// The number of probes of all volumes.
  int probes() const;
  const FieldSettings& settings() const;
  /// The number of updates since the start or the last reset.
  int updates() const;
  /// Estimated standard error of the light of the probes near surfaces, over that light, root mean
  /// square: the noise that random rays leave. Weighted by its visibility: noise in light darker
  /// than the mean counts less, by the square root. Infinite before the second update, after which
  /// it is first known. Reads the state of every probe.
  double standard_error() const;
  /// Bytes of the store, for all probes.
  std::size_t store_bytes() const;
  /// Bytes of the last update's surfels, kept to solve for the light again.
  std::size_t surfel_bytes() const;

 private:
  friend struct FieldAccess;
  struct State;
  explicit IrradianceField(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes all that a field has learned to a file (docs/field-format.md), whole or not at all. The
/// world is the one that the field was last brought up to date with.
Expected<void> save_field(const std::string& path, const IrradianceField& field,
                          const World& world);

/// A field from a file.
struct LoadedField {
  IrradianceField field;
  /// Whether the world's light is the light that the field was made with. If lights, materials,
  /// dynamic instances or settings of light transport differ, updates start from the field's light,
  /// but do not average it in.
  bool same_light = true;
};

/// Reads a field from which updates continue, with its averages. Grids, tiles and formats are the
/// file's, whatever `settings` say; everything else comes from `settings`. Fails on files that are
/// truncated, broken, of another version, or of another scene, that is, one whose static geometry
/// differs.
Expected<LoadedField> load_field(const std::string& path, const FieldSettings& settings,
                                 const World& world);

}  // namespace lambent
