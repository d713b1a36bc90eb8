// SPDX-License-Identifier: Apache-2.0
// Based on: McGuire et al., "Probe-based dynamic global illumination", US 2021/0012562; Majercik et
// al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", JCGT 8(2), 2019.
// One update of the irradiance field.
#include "lambent/field.h"

#include <cassert>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "field/distances.h"
#include "field/probe_record.h"
#include "field/probe_store.h"
#include "field/relight.h"
#include "field/relocate.h"
#include "field/surfels.h"
#include "field/tile_fit.h"
#include "field/visibility.h"
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
                 tile_fit_matrix(settings.irradiance_texels)),
        traces(store.probes()),
        records(store.probes()),
        sights(store.grid()),
        light(static_cast<std::size_t>(store.probes()) * tile_texels(), vec4(0.0f)) {}

  FieldSettings settings;
  FieldGrid grid;
  ProbeStore store;
  BlendMatrix tile_fit;
  std::vector<ProbeTrace> traces;
  std::vector<ProbeRecord> records;
  ProbeSights sights;
  WorkingIrradiance light;  // that the store holds, before it was encoded
  TraceGroup group;
  int updates = 0;

  int tile_texels() const { return square(settings.irradiance_texels); }
  void store_light(std::span<const int> probes, uint salt);
};

/// Encodes the light of some probes.
void IrradianceField::State::store_light(std::span<const int> probes, uint salt) {
  const auto texels = static_cast<std::size_t>(tile_texels());
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<vec3> interior(texels);
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t t = 0; t < texels; ++t) interior[t] = vec3(light[probes[k] * texels + t]);
      store.store_irradiance(probes[k], interior, salt);
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
  TraceGroup& group = s.group;
  group.rays = std::make_shared<RaySet>(settings, settings.rays_per_probe, update);
  group.probes.resize(s.store.probes());
  std::iota(group.probes.begin(), group.probes.end(), 0);
  const BlendMatrix distance_blend(settings.distance_texels, kDistanceExponent,
                                   group.rays->directions);
  const uint salt = hash_pcg3d(uvec3(update, settings.seed, kStoreSalt)).x;

  // The mean of all updates so far, until it has become an exponential moving average
  std::vector<float> shares(group.probes.size());
  for (std::size_t k = 0; k < shares.size(); ++k) {
    float& samples = s.records[group.probes[k]].samples;
    samples += 1.0f;
    shares[k] = max(1.0f / samples, 1.0f - settings.hysteresis);
  }
  statistics.blend_ms += watch.lap();

  // Before they hold anything, have the probes stand where they are needed
  if (s.updates == 0 && settings.relocation) {
    relocate_probes(world.scene(), world.tracer(), group.probes, {}, s.store);
  }
  trace_probe_rays(world.tracer(), s.store, group);
  statistics.probe_rays = group.hits.size();
  if (settings.visibility == Visibility::hybrid) {
    statistics.shadow_rays += s.sights.look(world.tracer(), s.store, group.probes);
  }
  statistics.trace_ms = watch.lap();

  blend_distances(world.scene(), distance_blend, group, shares, salt, s.store);
  statistics.blend_ms += watch.lap();

  statistics.shadow_rays += shade_surfels(world, s.store, group, settings, s.traces);
  statistics.shadow_rays += find_surfel_lookups(
      s.store, {settings.visibility, &world.tracer(), &s.sights}, group.probes, s.traces);
  statistics.shade_ms = watch.lap();

  // Solve for all bounces, starting from the light that is there
  const TransportOperator transport(s.store.grid(), s.traces, group.probes, s.tile_fit,
                                    settings.irradiance_texels);
  const RelightResult solved =
      settings.max_bounces >= 0
          ? relight_bounces(transport, shares, settings.max_bounces, s.light)
          : relight(transport, shares, {},
                    {settings.max_albedo, settings.relight_tolerance, settings.max_relights},
                    s.light);
  statistics.relights = solved.iterations;
  statistics.residual = solved.error;
  statistics.change = solved.change;
  statistics.relight_ms = watch.lap();

  s.store_light(group.probes, salt);
  ++s.updates;
  statistics.blend_ms += watch.lap();
  return statistics;
}

void IrradianceField::reset() {
  State& s = *state_;
  s.store.clear();
  std::fill(s.light.begin(), s.light.end(), vec4(0.0f));
  std::fill(s.records.begin(), s.records.end(), ProbeRecord{});
  s.updates = 0;
}

void IrradianceField::irradiance(std::span<const FieldQuery> queries, std::span<glm::vec3> result,
                                 const World* world) const {
  assert(queries.size() == result.size());
  const State& s = *state_;
  parallel_chunks(queries.size(), kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
    visible_irradiance(
        s.store, {s.settings.visibility, world != nullptr ? &world->tracer() : nullptr, &s.sights},
        queries.subspan(begin, end - begin), result.subspan(begin, end - begin));
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
  std::size_t bytes = 0;
  for (const ProbeTrace& trace : state_->traces) bytes += trace.bytes();
  return bytes;
}
const ProbeStore& IrradianceField::store() const {
  return state_->store;
}

}  // namespace lambent
