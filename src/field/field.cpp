// SPDX-License-Identifier: Apache-2.0
#include "lambent/field.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "field/field_state.h"
#include "field/lookup/lookup_volumes.h"
#include "field/probes/tile_fit.h"

namespace lambent {
namespace {

constexpr std::size_t kQueriesPerTask = 4096;

std::vector<VolumeRole> roles_of(std::span<const Volume> volumes) {
  std::vector<VolumeRole> roles;
  for (const Volume& volume : volumes) roles.push_back(volume.role);
  return roles;
}

std::vector<ProbeGrid> grids_of(std::span<const Volume> volumes) {
  std::vector<ProbeGrid> grids;
  for (const Volume& volume : volumes) grids.push_back(volume.grid);
  return grids;
}

}  // namespace

Expected<void> check_settings(const FieldSettings& s) {
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
  if (outside(s.solve_tolerance, 1e-7f, 1.0f)) {
    return fail("", "solve tolerance", "must be 1e-7 to 1");
  }
  if (outside(s.max_solve_iterations, 1, 1000))
    return fail("", "max solve iterations", "must be 1 to 1000");
  if (s.max_bounces < -1) return fail("", "bounces", "must be 0 or more, or -1 for all");
  if (outside(s.emissive_samples, 1, 64)) return fail("", "emissive samples", "must be 1 to 64");
  if (!std::isfinite(s.texture_lod_bias)) return fail("", "texture LOD bias", "must be finite");
  return {};
}

IrradianceField::State::State(const FieldSettings& field_settings, std::span<const Volume> volumes)
    : settings(field_settings),
      roles(roles_of(volumes)),
      store(grids_of(volumes), field_settings),
      tile_fit(tile_texels(), tile_texels(), tile_fit_matrix(settings.irradiance_texels)),
      traces(store.probes()),
      statuses(store.probes()),
      cell_visibility(store.probes()),
      classification_inputs(store.probes()),
      light(static_cast<std::size_t>(store.probes()) * tile_texels(), vec4(0.0f)),
      last_irradiance_estimate(light.size(), vec4(0.0f)),
      last_estimate_is_coarse(store.probes()),
      scheduler(store.probes(), roles, settings) {
  for (const ProbeGrid& grid : store.grids()) grids.push_back(field_grid(grid));
}

IrradianceField::IrradianceField(std::unique_ptr<State> state) : state_(std::move(state)) {}
IrradianceField::~IrradianceField() = default;
IrradianceField::IrradianceField(IrradianceField&&) noexcept = default;
IrradianceField& IrradianceField::operator=(IrradianceField&&) noexcept = default;

Expected<IrradianceField> IrradianceField::make(const FieldSettings& settings,
                                                const Bounds& scene_bounds) {
  if (const Expected<void> fine = check_settings(settings); !fine)
    return tl::unexpected(fine.error());
  const Expected<std::vector<Volume>> volumes = plan_volumes(settings, scene_bounds);
  if (!volumes) return tl::unexpected(volumes.error());
  return IrradianceField(std::make_unique<State>(settings, *volumes));
}

void IrradianceField::reset() {
  State& s = *state_;
  s.device.reset();
  s.host_light_is_stale = s.host_store_is_stale = false;
  s.store.clear();
  std::fill(s.light.begin(), s.light.end(), vec4(0.0f));
  std::fill(s.statuses.begin(), s.statuses.end(), ProbeStatus{});
  std::fill(s.traces.begin(), s.traces.end(), ProbeTrace{});
  std::fill(s.classification_inputs.begin(), s.classification_inputs.end(), ClassificationInput{});
  s.cell_visibility = CellVisibility(s.store.probes());
  std::fill(s.last_irradiance_estimate.begin(), s.last_irradiance_estimate.end(), vec4(0.0f));
  s.pending_edits = {};
  s.edited_places.clear();
  s.stale_sleeping.clear();
  s.applied_revision = 0;
  s.classified = false;
  s.scheduler.mark_all_changed();
  s.warming_up = true;
  s.mean_light = 0.0f;
  s.applied_edits_last = false;
  s.updates = 0;
}

void IrradianceField::irradiance(std::span<const FieldQuery> queries, std::span<glm::vec3> result,
                                 const World* world) const {
  assert(queries.size() == result.size());
  const State& s = *state_;
  if (s.device) return s.device->irradiance(queries, world, result);
  const RayTracer* tracer = world != nullptr ? &world->tracer() : nullptr;
  parallel_chunks(queries.size(), kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
    lookup_irradiance(s.store, {s.settings.visibility, tracer, &s.cell_visibility},
                      queries.subspan(begin, end - begin), result.subspan(begin, end - begin));
  });
}

std::span<const FieldGrid> IrradianceField::grids() const {
  return state_->grids;
}
int IrradianceField::probes() const {
  return state_->store.probes();
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
  if (state_->device) return state_->device->surfel_bytes();
  std::size_t bytes = 0;
  for (const ProbeTrace& trace : state_->traces) bytes += trace.bytes();
  return bytes;
}
const ProbeStore& IrradianceField::store() const {
  state_->fetch_store();
  return state_->store;
}
const FieldBackend* IrradianceField::on_device() const {
  return state_->device.get();
}
std::span<const ProbeStatus> IrradianceField::probe_statuses() const {
  return state_->statuses;
}

}  // namespace lambent
