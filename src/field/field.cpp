// SPDX-License-Identifier: Apache-2.0
// Based on: McGuire et al., "Probe-based dynamic global illumination", US 2021/0012562; Majercik et
// al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", JCGT 8(2), 2019.
// One update of the irradiance field.
#include "lambent/field.h"

#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "field/distances.h"
#include "field/probe_store.h"
#include "field/relight.h"
#include "field/surfels.h"
#include "field/tile_fit.h"
#include "lambent/world.h"
#include "shared/random.h"

namespace lambent {
namespace {

constexpr std::size_t kQueriesPerTask = 4096;
constexpr std::size_t kProbesPerTask = 64;

// Keeps the random numbers of the store's dither apart from those of other passes.
constexpr uint kStoreSalt = 0x53544F52u;

int square(int x) {
  return x * x;
}

Expected<void> check(const FieldSettings& s) {
  const auto outside = [](auto value, auto low, auto high) {
    return !(value >= low && value <= high);
  };
  if (outside(s.rays_per_probe, 16, 4096)) return fail("", "rays", "must be 16 to 4096 a probe");
  if (outside(s.hysteresis, 0.0f, 0.999f)) return fail("", "hysteresis", "must be 0 to 0.999");
  // An odd tile reads directions along the axes from one side only
  if (outside(s.irradiance_texels, 2, 16) || s.irradiance_texels % 2 != 0) {
    return fail("", "irradiance texels", "must be even, 2 to 16");
  }
  if (outside(s.distance_texels, 4, 32)) return fail("", "distance texels", "must be 4 to 32");
  if (outside(s.max_albedo, 0.0f, 0.99f)) return fail("", "max albedo", "must be 0 to 0.99");
  if (outside(s.relight_tolerance, 1e-7f, 1.0f)) {
    return fail("", "relight tolerance", "must be 1e-7 to 1");
  }
  if (outside(s.max_relights, 1, 1000)) return fail("", "max relights", "must be 1 to 1000");
  if (s.max_bounces < -1) return fail("", "bounces", "must be 0 or more, or -1 for all");
  if (outside(s.emissive_samples, 1, 64)) return fail("", "emissive samples", "must be 1 to 64");
  if (!std::isfinite(s.texture_lod_bias)) return fail("", "texture LOD bias", "must be finite");
  return {};
}

}  // namespace

struct IrradianceField::State {
  State(const FieldSettings& field_settings, const FieldGrid& field_grid)
      : settings(field_settings),
        grid(field_grid),
        store({field_grid.origin, field_grid.spacing, field_grid.count}, field_settings),
        tile_fit(square(settings.irradiance_texels), square(settings.irradiance_texels),
                 tile_fit_matrix(settings.irradiance_texels)) {}

  FieldSettings settings;
  FieldGrid grid;
  ProbeStore store;
  BlendMatrix tile_fit;
  Surfels surfels;
  std::vector<Hit> hits;
  int updates = 0;

  void load_history(WorkingIrradiance& history) const;
  void store_blended(const WorkingIrradiance& history, const WorkingIrradiance& solution,
                     float share, uint salt);
};

/// Decodes the stored irradiance.
void IrradianceField::State::load_history(WorkingIrradiance& history) const {
  const int edge = settings.irradiance_texels;
  parallel_chunks(store.probes(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t probe = begin; probe < end; ++probe) {
      for (int t = 0; t < edge * edge; ++t) {
        history[probe * edge * edge + t] = vec4(
            store.irradiance_texel(static_cast<int>(probe), ivec2(t % edge, t / edge) + 1), 0.0f);
      }
    }
  });
}

/// Blends the solution into the history, in linear light, and encodes the result.
void IrradianceField::State::store_blended(const WorkingIrradiance& history,
                                           const WorkingIrradiance& solution, float share,
                                           uint salt) {
  const std::size_t texels =
      static_cast<std::size_t>(settings.irradiance_texels) * settings.irradiance_texels;
  parallel_chunks(store.probes(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<vec3> interior(texels);
    for (std::size_t probe = begin; probe < end; ++probe) {
      for (std::size_t t = 0; t < texels; ++t) {
        const std::size_t index = probe * texels + t;
        interior[t] = max(vec3(mix(history[index], solution[index], share)), vec3(0.0f));
      }
      store.store_irradiance(static_cast<int>(probe), interior, salt);
    }
  });
}

IrradianceField::IrradianceField(std::unique_ptr<State> state) : state_(std::move(state)) {}
IrradianceField::~IrradianceField() = default;
IrradianceField::IrradianceField(IrradianceField&&) noexcept = default;
IrradianceField& IrradianceField::operator=(IrradianceField&&) noexcept = default;

Expected<IrradianceField> IrradianceField::make(const FieldSettings& settings,
                                                const Bounds& scene_bounds) {
  if (const Expected<void> fine = check(settings); !fine) return tl::unexpected(fine.error());
  const Expected<FieldGrid> grid = fit_grid(settings, scene_bounds);
  if (!grid) return tl::unexpected(grid.error());
  return IrradianceField(std::make_unique<State>(settings, *grid));
}

UpdateStatistics IrradianceField::update(const World& world) {
  State& s = *state_;
  const FieldSettings& settings = s.settings;
  UpdateStatistics statistics;
  Stopwatch watch;

  // Draw this update's ray directions and with them the blend matrices
  const uint update = static_cast<uint>(s.updates);
  const std::vector<vec3> directions =
      probe_ray_directions(settings.rays_per_probe, update, settings.seed);
  const BlendMatrix irradiance_blend(settings.irradiance_texels, 1.0f, directions);
  const BlendMatrix distance_blend(settings.distance_texels, kDistanceExponent, directions);
  const uint salt = hash_pcg3d(uvec3(update, settings.seed, kStoreSalt)).x;

  // The mean of all updates so far, until it has become an exponential moving average
  const float share = max(1.0f / static_cast<float>(s.updates + 1), 1.0f - settings.hysteresis);
  statistics.blend_ms += watch.lap();

  trace_probe_rays(world.tracer(), s.store.grid(), directions, s.hits);
  statistics.probe_rays = s.hits.size();
  statistics.trace_ms = watch.lap();

  blend_distances(world.scene(), distance_blend, s.hits, share, salt, s.store);
  statistics.blend_ms += watch.lap();

  statistics.shadow_rays =
      shade_surfels(world, s.store.grid(), directions, s.hits, settings, update, s.surfels);
  find_surfel_lookups(s.store, directions, s.surfels);
  statistics.shade_ms = watch.lap();

  // Solve for all bounces, starting from the light that is there
  const std::size_t texels = static_cast<std::size_t>(s.store.probes()) *
                             settings.irradiance_texels * settings.irradiance_texels;
  WorkingIrradiance history(texels);
  s.load_history(history);
  WorkingIrradiance solution = history;
  const TransportOperator transport(s.store.grid(), s.surfels, irradiance_blend, s.tile_fit,
                                    settings.irradiance_texels);
  const RelightResult solved =
      settings.max_bounces >= 0
          ? relight_bounces(transport, history, settings.max_bounces, solution)
          : relight(transport, history,
                    {share, settings.max_albedo, settings.relight_tolerance, settings.max_relights},
                    solution);
  statistics.relights = solved.iterations;
  statistics.residual = solved.error;
  statistics.change = blended_change(history, solution, share);
  statistics.relight_ms = watch.lap();

  s.store_blended(history, solution, share, salt);
  ++s.updates;
  statistics.blend_ms += watch.lap();
  return statistics;
}

void IrradianceField::reset() {
  state_->store.clear();
  state_->updates = 0;
}

void IrradianceField::irradiance(std::span<const FieldQuery> queries,
                                 std::span<glm::vec3> result) const {
  assert(queries.size() == result.size());
  parallel_chunks(queries.size(), kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
    lookup_irradiance(state_->store, queries.subspan(begin, end - begin),
                      result.subspan(begin, end - begin));
  });
}

const FieldGrid& IrradianceField::grid() const {
  return state_->grid;
}
const FieldSettings& IrradianceField::settings() const {
  return state_->settings;
}
int IrradianceField::updates() const {
  return state_->updates;
}
std::size_t IrradianceField::store_bytes() const {
  return state_->store.bytes();
}
std::size_t IrradianceField::surfel_bytes() const {
  return state_->surfels.bytes();
}
const ProbeStore& IrradianceField::store() const {
  return state_->store;
}

}  // namespace lambent
