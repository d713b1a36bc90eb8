// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/measure.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bench/median.h"
#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"

namespace lambent::bench {
namespace {

// Frames that are not counted, which create buffers and pipelines.
constexpr int kWarmUp = 3;

// Rays per probe in an update: as in McGuire's talk (GDC 2019), and for twice as many probes
// (Majercik et al., JCGT 8(2), 2019).
constexpr int kRays = 144, kRaysOfMany = 64;

// A field with partial updates traces one in this many of its rays per frame.
constexpr int kFramesAnUpdate = 8;

/// Times of updates of a field, by pass.
struct UpdateTimes {
  Median trace, shade, solve_bounces, blend, place, all, rays;

  void add(const UpdateStatistics& update) {
    trace.add(update.ms("trace"));
    shade.add(update.ms("shade") + update.ms("visibility") + update.ms("corrections") +
              update.ms("lookups"));
    solve_bounces.add(update.ms("solve"));
    blend.add(update.ms("blend_distances") + update.ms("store"));
    place.add(update.ms("placement") + update.ms("edits"));
    double sum = 0.0;
    for (const PassTime& pass : update.passes) sum += pass.ms;
    all.add(sum);
    rays.add(static_cast<double>(update.probe_rays));
  }
};

IrradianceField make_field(const World& world, const FieldSettings& settings) {
  return IrradianceField::make(settings, open_bounds(world)).value();
}

UpdateTimes time_updates(const World& world, IrradianceField& field, int frames,
                         const UpdateRequest& request = {}) {
  UpdateTimes times;
  for (int frame = -kWarmUp; frame < frames; ++frame) {
    const UpdateStatistics update = field.update(world, request);
    if (frame >= 0) times.add(update);
  }
  return times;
}

/// Medians of a frame's passes, by name.
std::map<std::string, Median> time_frames(const World& world, const IndirectSources& sources,
                                          const FrameSettings& settings, int frames) {
  std::map<std::string, Median> passes;
  Renderer renderer(world, sources);
  RenderedFrame rendered;
  for (int frame = -kWarmUp; frame < frames; ++frame) {
    const auto done = renderer.render(world.scene().cameras.at(0), settings, rendered);
    if (!done) throw std::runtime_error(done.error().message());
    if (frame < 0) continue;
    for (const PassTime& pass : rendered.passes) passes[pass.name].add(pass.ms);
  }
  return passes;
}

/// The time of restructuring, gathering and blurring. Rendering maps, choosing their texels and the
/// primary rays are the same for all gathers.
double gathering(const std::map<std::string, Median>& passes) {
  double sum = 0.0;
  for (const char* name : {"rsm.gather", "rsm.sub_blur", "rsm.interleave"}) {
    const auto pass = passes.find(name);
    if (pass != passes.end()) sum += pass->second.value();
  }
  return sum;
}

class Bench {
 public:
  Bench(const World& world, const Options& options) : world_(world), options_(options) {
    frame_.width = options.width;
    frame_.height = options.height;
  }

  void gi() {
    FieldSettings settings;
    settings.probe_budget = options_.probes;
    settings.rays_per_probe = kRays;
    IrradianceField field = make_field(world_, settings);
    const std::string probes = std::to_string(field.probes()) + " probes";
    const UpdateTimes whole = time_updates(world_, field, options_.frames);
    auto passes = time_frames(world_, {.field = &field}, frame_, options_.frames);
    const double lookup = passes["indirect"].value();
    const std::string full = probes + " x " + std::to_string(kRays) + " rays: ";
    add(full + "trace", whole.trace);
    add(full + "shade", whole.shade);
    add(full + "solve", whole.solve_bounces);
    add(full + "blend", whole.blend);
    add(full + "maintain, on the host", whole.place);
    add("lookup of " + size(), lookup);
    for (const char* pass : {"gbuffer", "direct", "glossy", "compose"}) {
      if (passes.contains(pass)) add(std::string(pass) + " of " + size(), passes[pass].value());
    }
    double frame = 0.0;
    for (const auto& [name, ms] : passes) frame += ms.value();
    add("frame of " + size() + ", all passes", frame);
    add(full + "all, and the lookup", whole.all.value() + lookup);

    UpdateRequest request;
    request.ray_budget = static_cast<std::uint64_t>(field.probes()) * kRays / kFramesAnUpdate;
    const UpdateTimes part = time_updates(world_, field, options_.frames, request);
    add(full + "an eighth of the rays a frame, and the lookup", part.all.value() + lookup,
        "<= 1.0");
    const double trace_ms = whole.trace.value();
    const double rays = trace_ms > 0.0 ? whole.rays.value() / trace_ms * 1e-6 : 0.0;
    rows_.push_back({"rays of the probe pass", rays, "Gray/s", ">= 1.5"});
  }

  void many_probes() {
    FieldSettings settings;
    settings.probe_budget = 2 * options_.probes;
    settings.rays_per_probe = kRaysOfMany;
    IrradianceField field = make_field(world_, settings);
    const UpdateTimes times = time_updates(world_, field, options_.frames);
    add(std::to_string(field.probes()) + " probes x 64 rays: all", times.all.value(), "<= 2.6");
  }

  /// Tiles of 8x8 and 16x16 texels, including gutters.
  void large_tiles() {
    FieldSettings settings;
    settings.probe_budget = options_.probes;
    settings.rays_per_probe = kRays;
    settings.irradiance_texels = 6;
    settings.distance_texels = 14;
    IrradianceField field = make_field(world_, settings);
    const UpdateTimes times = time_updates(world_, field, options_.frames);
    add(std::to_string(field.probes()) + " probes x 144 rays, tiles of 8x8 and 16x16: blend",
        times.blend.value(), "<= 54 on two cores");
  }

  void maps() {
    const RsmSettings interleaved, plain = plain_gather();
    const double fast =
        gathering(time_frames(world_, {.rsm = interleaved}, frame_, options_.frames));
    const double slow = gathering(time_frames(world_, {.rsm = plain}, frame_, options_.frames));
    add("RSM, 1,024 texels a pixel: plain", slow);
    add("RSM, interleaved, all stages", fast);
    rows_.push_back(
        {"RSM, interleaved: faster", fast > 0.0 ? slow / fast : 0.0, "times", ">= 12.4"});
  }

  std::vector<Row> take() { return std::move(rows_); }

 private:
  std::string size() const {
    return std::to_string(options_.width) + "x" + std::to_string(options_.height);
  }
  void add(const std::string& what, double ms, const std::string& bar = "") {
    rows_.push_back({what, ms, "ms", bar});
  }
  void add(const std::string& what, const Median& ms) { add(what, ms.value()); }

  const World& world_;
  const Options& options_;
  FrameSettings frame_;
  std::vector<Row> rows_;
};

}  // namespace

std::vector<Row> measure(const World& world, const Options& options) {
  Bench bench(world, options);
  bench.gi();
  bench.many_probes();
  bench.large_tiles();
  if (!world.scene().lights.empty()) bench.maps();
  return bench.take();
}

}  // namespace lambent::bench
