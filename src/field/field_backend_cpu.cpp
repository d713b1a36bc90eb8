// SPDX-License-Identifier: Apache-2.0
// A field in the processor's memory, and the passes of an update there.
#include <algorithm>

#include "core/parallel.h"
#include "core/pass_times.h"
#include "field/field_backend.h"
#include "field/lookup/lookup_volumes.h"
#include "field/passes.h"
#include "field/probes/tile_light.h"
#include "field/schedule/importance.h"
#include "field/transport/distances.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 64;
constexpr std::size_t kQueriesPerTask = 4096;

VisibilityRays visibility_in(const World& world, const ProbeMemory& memory) {
  return {memory.settings.visibility, &world.tracer(), &memory.sights};
}

void store_irradiance(std::span<const int> probes, uint salt, ProbeMemory& memory) {
  const auto texels = static_cast<std::size_t>(memory.tile_texels());
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<vec3> interior(texels);
    for (std::size_t k = begin; k < end; ++k) {
      const vec4* tile = &memory.light[probes[k] * texels];
      for (std::size_t t = 0; t < texels; ++t) interior[t] = vec3(tile[t]);
      memory.store.store_irradiance(probes[k], interior, salt);
    }
  });
}

class FieldPassesCpu final : public FieldPasses {
 public:
  FieldPassesCpu(ProbeUpdate& update, ProbeMemory& memory)
      : update_(update), memory_(memory), timer_(result.passes) {}

  ProbeUpdateResult result;

  const FieldSettings& settings() const override { return memory_.settings; }
  int batches() const override { return static_cast<int>(update_.groups.size()); }

  void trace(int batch) override {
    TraceGroup& group = update_.groups[batch];
    trace_probe_rays(update_.world.tracer(), memory_.store, group);
    result.probe_rays += group.hits.size();
  }

  void shade(int batch) override {
    result.shadow_rays += shade_surfels(update_.world, memory_.store, update_.groups[batch],
                                        memory_.settings, memory_.traces);
  }

  void blend_distances() override {
    std::span<const float> shares = update_.shares;
    for (const TraceGroup& group : update_.groups) {
      const DistanceBlend blend(memory_.settings, group.rays->directions);
      lambent::blend_distances(update_.world.scene(), blend, group,
                               shares.first(group.probes.size()), update_.salt, memory_.store);
      shares = shares.subspan(group.probes.size());
    }
  }

  void visibility() override {
    result.shadow_rays += memory_.sights.look(update_.world.tracer(), memory_.store,
                                              cells_around(memory_.store, update_.probes));
  }

  void lookups() override {
    result.shadow_rays += find_surfel_lookups(memory_.store, visibility_in(update_.world, memory_),
                                              update_.probes, memory_.traces);
  }

  void solve() override {
    const TransportOperator to_these = memory_.transport(update_.probes);
    const int bounces = memory_.settings.max_bounces;
    history_ = light_of(memory_.light, update_.probes, memory_.tile_texels());
    const RelightResult solved =
        bounces >= 0 ? relight_bounces(to_these, update_.shares, bounces, memory_.light)
                     : relight(to_these, update_.shares, {}, update_.relight, memory_.light);
    result.iterations = solved.iterations;
    result.error = solved.error;
    result.change = solved.change;
    const auto texels = static_cast<std::size_t>(memory_.tile_texels());
    for (std::size_t k = 0; k < update_.probes.size(); ++k) {
      std::copy_n(&solved.solution[k * texels], texels, &memory_.told[update_.probes[k] * texels]);
    }
  }

  void variability() override {
    const auto texels = static_cast<std::size_t>(memory_.tile_texels());
    for (std::size_t k = 0; k < update_.probes.size(); ++k) {
      const TileLight held(&memory_.light[update_.probes[k] * texels], texels),
          before(&history_[k * texels], texels);
      result.changes.push_back({relative_square(held, before, update_.darkest),
                                mean_luminance(before), mean_luminance(held)});
    }
  }

  void store() override { store_irradiance(update_.probes, update_.salt, memory_); }

  // The host has chosen and placed the probes.
  void schedule() override {}
  void placement() override {}

  void begin(const char* name) override { name_ = name; }
  void end() override { timer_.finish(name_); }

 private:
  ProbeUpdate& update_;
  ProbeMemory& memory_;
  PassTimer timer_;
  const char* name_ = nullptr;
  WorkingIrradiance history_;  // what the update's probes held
};

class FieldBackendCpu final : public FieldBackend {
 public:
  explicit FieldBackendCpu(ProbeMemory& memory) : memory_(memory) {}

  bool suits(const World& world) const override {
    return !lives_on_device(world, memory_.store.probes());
  }
  const DeviceLookups* on_device() const override { return nullptr; }

  void fetch_light() override {}
  void fetch_store() override {}
  void push_light() override {}
  void push_places(std::span<const int>) override {}

  ProbeUpdateResult update_probes(ProbeUpdate update) override {
    FieldPassesCpu passes(update, memory_);
    lambent::update_probes(passes);
    return std::move(passes.result);
  }

  FollowedEdits retrace(const World& world, std::span<const WorldChanges> changes,
                        std::span<const int> probes, std::span<const int> among,
                        uint salt) override {
    return follow_edits(world, changes, memory_.settings, probes, among,
                        visibility_in(world, memory_), memory_.store, memory_.traces, salt);
  }

  std::uint64_t look(const World& world, std::span<const int> cells) override {
    return memory_.sights.look(world.tracer(), memory_.store, cells);
  }

  std::uint64_t find_lookups(const World& world, std::span<const int> moved,
                             std::span<const int> among) override {
    return find_surfel_lookups(memory_.store, visibility_in(world, memory_),
                               probes_reading(moved, among, memory_.store, memory_.traces),
                               memory_.traces);
  }

  RelightResult solve(std::span<const int> probes, std::span<const float> shares,
                      const WorkingIrradiance& gain, const RelightSettings& settings) override {
    return relight(memory_.transport(probes), shares, gain, settings, memory_.light);
  }

  void receive(std::span<const int> probes, WorkingIrradiance& received) override {
    memory_.transport(probes).apply(memory_.light, received, received);
  }

  std::vector<double> direct_light(std::span<const int> probes) override {
    return direct_light_of(memory_.traces, probes);
  }

  void store_light(std::span<const int> probes, uint salt) override {
    store_irradiance(probes, salt, memory_);
  }

  std::vector<float> send_back(std::span<const float> received, float least) override {
    return send_importance_back(memory_.store, memory_.traces, received, least);
  }

  void irradiance(std::span<const FieldQuery> queries, const World* world,
                  std::span<vec3> result) const override {
    const RayTracer* tracer = world != nullptr ? &world->tracer() : nullptr;
    const VisibilityRays by = {memory_.settings.visibility, tracer, &memory_.sights};
    parallel_chunks(queries.size(), kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
      lookup_irradiance(memory_.store, by, queries.subspan(begin, end - begin),
                        result.subspan(begin, end - begin));
    });
  }

  std::size_t surfel_bytes() const override {
    std::size_t bytes = 0;
    for (const ProbeTrace& trace : memory_.traces) bytes += trace.bytes();
    return bytes;
  }

 private:
  ProbeMemory& memory_;
};

}  // namespace

std::unique_ptr<FieldBackend> make_field_backend_cpu(ProbeMemory& memory) {
  return std::make_unique<FieldBackendCpu>(memory);
}

}  // namespace lambent
