// SPDX-License-Identifier: Apache-2.0
#include "field/schedule/scheduling.h"

#include "field/placement/classify.h"
#include "field/transport/blend_math.h"

namespace lambent {

TracedProbes blend_weights_of(std::span<const TraceGroup> groups, const FieldSettings& settings,
                              std::span<const ProbeStatus> statuses) {
  const float longest = longest_average(settings);
  TracedProbes traced;
  for (const TraceGroup& group : groups) {
    const float weight =
        static_cast<float>(group.rays->rays()) / static_cast<float>(settings.rays_per_probe);
    for (const int probe : group.probes) {
      traced.blend_weights.push_back(
          history_blend_weight(statuses[probe].samples, weight, longest));
    }
    traced.probes.insert(traced.probes.end(), group.probes.begin(), group.probes.end());
    traced.weights.insert(traced.weights.end(), group.probes.size(), weight);
  }
  return traced;
}

void update_variability(const TracedProbes& traced, std::span<const LightChange> changes,
                        const TracedIn& in, const FieldSettings& settings,
                        std::span<ProbeStatus> statuses, Scheduling& scheduling) {
  const float longest = longest_average(settings);
  const int texels = settings.irradiance_texels * settings.irradiance_texels;
  double light_sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < traced.probes.size(); ++k) {
    const int probe = traced.probes[k];
    ProbeStatus& status = statuses[probe];
    const LightChange& change = changes[k];
    if (!takes_turns(status)) {
      light_sum += change.now;
      ++count;
    }
    learn_variance(
        estimate_relative_square(change, texels, traced.blend_weights[k], scheduling.mean_light),
        traced.weights[k], status);
    status.samples = min(status.samples, longest);
    status.last_traced = in.update;
    status.state = state_once_traced(status.state);
    status.revision = in.revision;
    scheduling.scheduler.mark_changed(probe);
  }
  if (count == 0) return;
  const float now = static_cast<float>(light_sum) / static_cast<float>(count);
  const ProbeCounts& states = scheduling.scheduler.states();
  const int live = static_cast<int>(statuses.size()) - states.off - states.sleeping;
  scheduling.mean_light = learned_light(scheduling.mean_light, now, static_cast<float>(count),
                                        static_cast<float>(live));
}

void reset_history(int probe, std::uint64_t revision, std::span<ProbeStatus> statuses,
                   ProbeScheduler& scheduler) {
  statuses[probe].samples = 0.0f;
  statuses[probe].revision = revision;
  scheduler.mark_changed(probe);
}

}  // namespace lambent
