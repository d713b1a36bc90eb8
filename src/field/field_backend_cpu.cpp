// SPDX-License-Identifier: Apache-2.0
// A field in the processor's memory, and the passes of an update there.
#include <algorithm>
#include <cassert>

#include "core/parallel.h"
#include "core/pass_times.h"
#include "field/correction/train_corrections.h"
#include "field/edits/history_ratio.h"
#include "field/field_backend.h"
#include "field/lookup/lookup_volumes.h"
#include "field/passes.h"
#include "field/probes/tile_light.h"
#include "field/schedule/importance.h"
#include "field/transport/distances.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 64;
constexpr std::size_t kQueriesPerTask = 4096;

/// The visibility and the corrections with which surfels look the field up.
VisibilityRays visibility_in(const World& world, const ProbeData& data) {
  return {data.settings.visibility, &tracer_of(world), &data.cell_visibility, &data.correction,
          CorrectionUse::picked};
}

void store_irradiance(std::span<const int> probes, uint dither_seed, ProbeData& data) {
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<vec3> interior(texels);
    for (std::size_t k = begin; k < end; ++k) {
      const vec4* tile = &data.light[probes[k] * texels];
      for (std::size_t t = 0; t < texels; ++t) interior[t] = vec3(tile[t]);
      data.store.store_irradiance(probes[k], interior, dither_seed);
    }
  });
}

/// Brings the visibility between probes of some cells up to date on all ranks. Returns the number
/// of rays that this rank traced.
std::uint64_t update_visibility(const World& world, std::span<const int> cells, ProbeData& data) {
  const std::uint64_t traced =
      data.cell_visibility.update(tracer_of(world), data.store, data.share.own(cells));
  data.share.gather(data.cell_visibility.all_cells());
  return traced;
}

/// Divides an update among the ranks, or leaves the division as it is, and removes the probes of
/// other ranks from its groups. Discards the surfels of probes that now belong to another rank.
void take_own_share(ProbeUpdate& update, ProbeData& data) {
  if (data.share.alone()) return;
  assert(update.groups.size() <= 1);  // so that the probes are in ascending order
  if (update.divides) data.share.divide(update.probes);
  for (TraceGroup& group : update.groups) {
    const std::span<const int> own = data.share.own(update.probes);
    group.probes.assign(own.begin(), own.end());
  }
  for (int probe = 0; probe < data.store.probes(); ++probe) {
    if (!data.share.has(probe)) data.traces[probe] = {data.traces[probe].rays, {}, {}, {}};
  }
}

/// The blend weights of this rank's probes.
std::span<const float> own_weights(const ProbeUpdate& update, const ProbeShare& share) {
  if (share.alone()) return update.blend_weights;
  const std::size_t before = share.places_of_parts(update.probes)[share.ranks().own()];
  return std::span(update.blend_weights).subspan(before, share.own(update.probes).size());
}

class FieldPassesCpu final : public FieldPasses {
 public:
  /// The update's groups must have this rank's probes only, see take_own_share().
  FieldPassesCpu(ProbeUpdate& update, ProbeData& data)
      : update_(update),
        data_(data),
        own_(data.share.own(update.probes)),
        blend_weights_(own_weights(update, data.share)),
        timer_(result.passes) {}

  ProbeUpdateResult result;

  const FieldSettings& settings() const override { return data_.settings; }
  int batches() const override { return static_cast<int>(update_.groups.size()); }

  void trace(int batch) override {
    TraceGroup& group = update_.groups[batch];
    trace_probe_rays(tracer_of(update_.world), data_.store, group);
    result.probe_rays += group.hits.size();
  }

  void shade(int batch) override {
    result.shadow_rays += shade_surfels(update_.world, data_.solid_sides, data_.store,
                                        update_.groups[batch], data_.settings, data_.traces);
  }

  void blend_distances() override {
    std::span<const float> blend_weights = blend_weights_;
    for (const TraceGroup& group : update_.groups) {
      const DistanceBlend blend(data_.settings, group.rays->directions);
      lambent::blend_distances(data_.solid_sides, blend, group,
                               blend_weights.first(group.probes.size()), update_.dither_seed,
                               data_.store);
      blend_weights = blend_weights.subspan(group.probes.size());
    }
    data_.share.gather(data_.store.distance_words());
  }

  void visibility() override {
    result.shadow_rays +=
        update_visibility(update_.world, cells_around(data_.store, update_.probes), data_);
  }

  bool learns() const override { return update_.learns; }

  void corrections() override {
    result.correction_rays += train_corrections(
        update_.world, update_.probes, visibility_in(update_.world, data_), update_.number, data_);
  }

  void lookups() override {
    result.shadow_rays +=
        find_surfel_lookups(data_.store, visibility_in(update_.world, data_), own_, data_.traces);
  }

  void solve() override {
    const TransportOperator to_these = data_.transport(own_);
    const int bounces = data_.settings.max_bounces;
    history_ = light_of(data_.light, own_, data_.tile_texels());
    SolveShare share;
    if (!data_.share.alone()) share = {data_.share, update_.probes, data_.tile_texels()};
    const SolveResult solved =
        bounces >= 0
            ? solve_counted_bounces(to_these, blend_weights_, bounces, share, data_.light)
            : solve_bounces(to_these, blend_weights_, {}, update_.solve, share, data_.light);
    result.iterations = solved.iterations;
    result.error = solved.error;
    result.change = solved.change;
    store_last_estimates(own_, solved.solution, data_);
  }

  void variability() override {
    const auto texels = static_cast<std::size_t>(data_.tile_texels());
    std::vector<LightChange> changes;
    for (std::size_t k = 0; k < own_.size(); ++k) {
      const TileLight held(&data_.light[own_[k] * texels], texels),
          before(&history_[k * texels], texels);
      changes.push_back(light_change(before, held));
    }
    result.changes = gather_all(data_.share.ranks(), std::move(changes));
  }

  void store() override {
    store_irradiance(own_, update_.dither_seed, data_);
    data_.share.gather(data_.store.irradiance_words());
  }

  // The host has scheduled and placed the probes before the update.
  void scroll() override {}
  void schedule() override {}
  void placement() override {}
  // After edits the host traces single rays again, not whole probes (edits/invalidation.h).
  void keep_history() override {}
  void move_distances() override {}

  void begin(const char* name) override { name_ = name; }
  void end() override { timer_.finish(name_); }

 private:
  ProbeUpdate& update_;
  ProbeData& data_;
  std::span<const int> own_;              // the update's probes that belong to this rank
  std::span<const float> blend_weights_;  // one per probe of own_
  PassTimer timer_;
  const char* name_ = nullptr;
  WorkingIrradiance history_;  // the light of these probes before the update
};

class FieldBackendCpu final : public FieldBackend {
 public:
  explicit FieldBackendCpu(ProbeData& data) : data_(data) {}

  bool suits(const World& world) const override {
    return !lives_on_device(world, data_.store.probes());
  }
  const DeviceLookups* on_device() const override { return nullptr; }

  void fetch_light() override {}
  void fetch_store() override {}
  void fetch_corrections() override {}
  void push_light() override {}
  void push_solid_sides() override {}
  void push_places(std::span<const int>) override {}

  ProbeUpdateResult update_probes(ProbeUpdate update) override {
    take_own_share(update, data_);
    FieldPassesCpu passes(update, data_);
    lambent::update_probes(passes);
    ProbeUpdateResult& result = passes.result;
    // The time of most passes is in proportion to the number of rays
    if (update.divides) {
      data_.share.learn_work(
          data_.share.own(update.probes).size(),
          static_cast<double>(result.probe_rays + result.shadow_rays + result.correction_rays));
    }
    for (std::uint64_t* rays : {&result.probe_rays, &result.shadow_rays, &result.correction_rays}) {
      *rays = sum_over(data_.share.ranks(), *rays);
    }
    return std::move(result);
  }

  InvalidationResult retrace(const World& world, std::span<const WorldChanges> changes,
                             std::span<const int> probes, std::span<const int> among,
                             uint dither_seed) override {
    assert(data_.share.alone());
    return invalidate_surfels(world, data_.solid_sides, changes, data_.settings, probes, among,
                              visibility_in(world, data_), data_.store, data_.traces, dither_seed);
  }

  std::uint64_t update_cell_visibility(const World& world, std::span<const int> cells) override {
    return sum_over(data_.share.ranks(), update_visibility(world, cells, data_));
  }

  std::uint64_t find_lookups(const World& world, std::span<const int> moved,
                             std::span<const int> among) override {
    assert(data_.share.alone());
    return find_surfel_lookups(data_.store, visibility_in(world, data_),
                               probes_reading(moved, among, data_.store, data_.traces),
                               data_.traces);
  }

  SolveResult solve(std::span<const int> probes, std::span<const float> blend_weights,
                    const WorkingIrradiance& history_ratio,
                    const SolveSettings& settings) override {
    assert(data_.share.alone());
    return solve_bounces(data_.transport(probes), blend_weights, history_ratio, settings,
                         data_.light);
  }

  void receive(std::span<const int> probes, WorkingIrradiance& received) override {
    assert(data_.share.alone());
    data_.transport(probes).apply(data_.light, received, received);
  }

  void store_light(std::span<const int> probes, uint dither_seed) override {
    store_irradiance(probes, dither_seed, data_);
  }

  void forget_corrections(std::span<const float> kept) override {
    if (!data_.correction.empty()) data_.correction.forget(data_.store.grids(), kept);
  }

  std::vector<float> scatter_importance(std::span<const float> received, float least) override {
    assert(data_.share.alone());
    return scatter_from_surfels(data_.store, data_.traces, received, least);
  }

  void irradiance(std::span<const FieldQuery> queries, const World* world, CorrectionUse use,
                  std::span<vec3> result) const override {
    const RayTracer* tracer = world != nullptr ? &tracer_of(*world) : nullptr;
    const VisibilityRays by = {data_.settings.visibility, tracer, &data_.cell_visibility,
                               use != CorrectionUse::none ? &data_.correction : nullptr, use};
    parallel_chunks(queries.size(), kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
      lookup_irradiance(data_.store, by, queries.subspan(begin, end - begin),
                        result.subspan(begin, end - begin));
    });
  }

  std::size_t surfel_bytes() const override {
    std::size_t bytes = 0;
    for (const ProbeTrace& trace : data_.traces) bytes += trace.bytes();
    return bytes;
  }

 private:
  ProbeData& data_;
};

}  // namespace

std::unique_ptr<FieldBackend> make_field_backend_cpu(ProbeData& data) {
  return std::make_unique<FieldBackendCpu>(data);
}

}  // namespace lambent
