// SPDX-License-Identifier: Apache-2.0
#include "lambent/field.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "field/field_access.h"
#include "field/field_state.h"
#include "field/schedule/schedule.h"

namespace lambent {
Expected<void> check_settings(const FieldSettings& s) {
  const auto outside = [](auto value, auto low, auto high) {
    return !(value >= low && value <= high);
  };
  if (outside(s.rays_per_probe, 16, 4096)) return fail("", "rays", "must be 16 to 4096 a probe");
  if (outside(s.hysteresis, 0.0f, 0.999f)) return fail("", "hysteresis", "must be 0 to 0.999");
  if (s.irradiance_format > IrradianceFormat::float32) {
    return fail("", "irradiance format", "is unknown");
  }
  if (s.distance_format > DistanceFormat::rg32f) return fail("", "distance format", "is unknown");
  if (s.visibility > Visibility::exact) return fail("", "visibility", "is unknown");
  // In an odd tile, a fetch along the x or y axis reads texels on one side of the axis only
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

IrradianceField::State::State(const FieldSettings& field_settings,
                              std::span<const Volume> asked_volumes)
    : settings(field_settings),
      volumes{roles_of(asked_volumes), {}},
      data(grids_of(asked_volumes), settings),
      statuses(data.store.probes()),
      placement{.classification_inputs = std::vector<ClassificationInput>(data.store.probes())},
      scheduling{ProbeScheduler(data.store.probes(), volumes.roles, settings)},
      backend(make_field_backend_cpu(data)) {
  for (const ProbeGrid& grid : data.store.grids()) volumes.grids.push_back(field_grid(grid));
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
  assert(s.data.share.alone());
  s.backend = make_field_backend_cpu(s.data);
  s.data.clear();
  std::fill(s.statuses.begin(), s.statuses.end(), ProbeStatus{});
  std::fill(s.placement.classification_inputs.begin(), s.placement.classification_inputs.end(),
            ClassificationInput{});
  s.edits.pending = {};
  s.placement.edited_places.clear();
  s.placement.open_before.reset();
  s.placement.solid = {};
  s.data.solid_sides = {};
  s.edits.stale_sleeping.clear();
  s.edits.applied_revision = 0;
  s.placement.classified = false;
  s.scheduling.scheduler.mark_all_changed();
  s.scheduling.warming_up = true;
  s.scheduling.mean_light = 0.0f;
  s.edits.applied_last = false;
  s.updates = 0;
}

void IrradianceField::irradiance(std::span<const FieldQuery> queries, std::span<glm::vec3> result,
                                 const World* world) const {
  const std::size_t count = std::min(queries.size(), result.size());
  state_->backend->irradiance(queries.first(count), world, CorrectionUse::smooth,
                              result.first(count));
}

std::span<const FieldGrid> IrradianceField::grids() const {
  return state_->volumes.grids;
}
int IrradianceField::probes() const {
  return state_->data.store.probes();
}
const FieldSettings& IrradianceField::settings() const {
  return state_->settings;
}
int IrradianceField::updates() const {
  return state_->updates;
}
double IrradianceField::standard_error() const {
  double squares = 0.0;
  std::size_t known = 0;
  for (const ProbeStatus& status : state_->statuses) {
    if (status.variance_samples == 0 || status.samples <= 0.0f) continue;
    if (!is_scheduled(status) || takes_turns(status)) continue;
    squares += static_cast<double>(status.variance) / static_cast<double>(status.samples);
    ++known;
  }
  if (known == 0) return std::numeric_limits<double>::infinity();
  return std::sqrt(squares / static_cast<double>(known));
}
std::size_t IrradianceField::store_bytes() const {
  return state_->data.store.bytes();
}
std::size_t IrradianceField::surfel_bytes() const {
  return state_->backend->surfel_bytes();
}

IrradianceField FieldAccess::make(std::unique_ptr<State> state) {
  return IrradianceField(std::move(state));
}

const ProbeStore& store_of(const IrradianceField& field) {
  const FieldAccess::State& state = FieldAccess::state_of(field);
  state.backend->fetch_store();
  return state.data.store;
}

void look_up_irradiance(const IrradianceField& field, std::span<const FieldQuery> queries,
                        CorrectionUse use, std::span<glm::vec3> result, const World& world) {
  assert(queries.size() == result.size());
  FieldAccess::state_of(field).backend->irradiance(queries, &world, use, result);
}

void share_work(IrradianceField& field, Ranks& ranks) {
  FieldAccess::State& state = FieldAccess::state_of(field);
  assert(state.updates == 0);
  state.data.share.part_among(ranks);
  state.data.correction.part_among(ranks);
}

std::span<const ProbeStatus> statuses_of(const IrradianceField& field) {
  return FieldAccess::state_of(field).statuses;
}

const DeviceLookups* device_lookups_of(const IrradianceField& field) {
  return FieldAccess::state_of(field).backend->on_device();
}

}  // namespace lambent
