// SPDX-License-Identifier: Apache-2.0
// The choice of the most urgent probes, without visiting those that are not urgent.
#include <algorithm>

#include "core/parallel.h"
#include "field/schedule/schedule.h"

namespace lambent {
namespace {

// The number of probes of a block. With this number, visiting all blocks and visiting the probes of
// the urgent ones take about the same time in a field of some 100,000 probes.
constexpr std::size_t kBlock = 64;
constexpr std::size_t kBlocksPerTask = 64;

// The error reduction that a sleeping probe is scheduled with for its first update. Other probes
// have priority until their error is hardly visible.
constexpr float kSleepingReduction = 0.02f;

// The weight of sleeping probes in further updates. A probe's error reduction is in inverse
// proportion to its samples, so that one of this weight gets about this share of the samples that
// others get.
constexpr float kSleepingWeight = 1.0f / static_cast<float>(kSleepingPeriod);

// Sleeping probes become urgent by age this many updates later than others do.
constexpr std::uint32_t kSleepingAge = (kSleepingPeriod - 1) * kMaxProbeAge;

// The distance from the camera at which a probe's weight is one half [cells].
constexpr float kHalfWeightCells = 16.0f;

// The least weight of probes that are not important to the visible points, because the camera will
// turn.
constexpr float kUnseenWeight = 0.02f;

/// Calls body(neighbour) for the probes next to one in its grid.
template <class Body>
void for_each_neighbour(const ProbeStore& store, int probe, Body body) {
  const ProbeGrid& grid = store.grid_of(probe);
  const ivec3 coords = probe_coords(grid, probe);
  for (int i = 0; i < kNeighbours; ++i) {
    const int neighbour = neighbour_of(grid, coords, i);
    if (neighbour >= 0) body(neighbour);
  }
}

struct Candidate {
  float urgency;
  int probe;
};

/// Orders candidates by urgency, and equally urgent ones by index.
bool comes_before(const Candidate& a, const Candidate& b) {
  return a.urgency != b.urgency ? a.urgency > b.urgency : a.probe < b.probe;
}

/// Selects the most urgent of many candidates.
class Best {
 public:
  explicit Best(std::size_t most) : most_(most) {}

  void add(const Candidate& candidate) {
    if (heap_.size() == most_) {
      if (!comes_before(candidate, heap_.front())) return;
      std::pop_heap(heap_.begin(), heap_.end(), comes_before);
      heap_.back() = candidate;
    } else {
      heap_.push_back(candidate);
    }
    std::push_heap(heap_.begin(), heap_.end(), comes_before);
  }

  /// Whether a candidate of this urgency can no longer be among the most urgent ones.
  bool beyond(float urgency) const {
    return heap_.size() == most_ && heap_.front().urgency > urgency;
  }

  std::vector<Candidate> take() {
    std::sort_heap(heap_.begin(), heap_.end(), comes_before);
    return std::move(heap_);
  }

 private:
  std::size_t most_;
  std::vector<Candidate> heap_;  // the least urgent one in front
};

/// The weight of a probe this many cells away from the viewer.
float distance_weight(float cells) {
  return kHalfWeightCells / (kHalfWeightCells + cells);
}

float largest_spacing(const ProbeGrid& grid) {
  return max(grid.spacing.x, max(grid.spacing.y, grid.spacing.z));
}

/// A lower bound on the distance of the probes from `first` to `last` from the viewer [cells].
float least_cells_away(const ProbeStore& store, int first, int last, const vec3& viewer_ws) {
  const ProbeGrid& grid = store.grid_of(first);
  // There is no bound for probes of two volumes, or of a scrolled volume, whose order wraps around
  if (last >= grid.first + probe_count(grid) || grid.scroll != ivec3(0)) return 0.0f;
  vec3 low = vec3(probe_coords(grid, first)), high = vec3(probe_coords(grid, last));
  const bool layers = low.z != high.z, rows = layers || low.y != high.y;
  if (rows) low.x = 0.0f, high.x = static_cast<float>(grid.count.x - 1);
  if (layers) low.y = 0.0f, high.y = static_cast<float>(grid.count.y - 1);
  const vec3 viewer = grid_coords(grid, viewer_ws);
  const vec3 beyond = max(max(low - viewer, viewer - high) - kMaxProbeOffset, vec3(0.0f));
  return length(beyond * grid.spacing) / largest_spacing(grid);
}

int& count_of(ProbeCounts& counts, ProbeState state) {
  int* const by_state[] = {&counts.off,   &counts.sleeping,       &counts.newly_awake,
                           &counts.awake, &counts.newly_vigilant, &counts.vigilant};
  return *by_state[static_cast<int>(state)];
}

}  // namespace

ProbeScheduler::ProbeScheduler(int probes, std::span<const VolumeRole> roles,
                               const FieldSettings& settings)
    : roles_(roles.begin(), roles.end()),
      rays_per_probe_(settings.rays_per_probe),
      longest_(longest_average(settings)),
      entries_(probes),
      blocks_((entries_.size() + kBlock - 1) / kBlock) {
  states_.off = static_cast<int>(entries_.size());
  never_traced_ = states_.off;
}

void ProbeScheduler::mark_changed(int probe) {
  if (!all_changed_) changed_.push_back(probe);
}

void ProbeScheduler::refresh_status(std::span<const ProbeStatus> statuses, int probe) {
  Entry& entry = entries_[probe];
  const ProbeStatus& status = statuses[probe];
  --count_of(states_, entry.state);
  entry.state = status.state;
  ++count_of(states_, entry.state);
  if (entry.last_traced == 0) --never_traced_;
  entry.last_traced = is_scheduled(status) ? status.last_traced : kNotScheduled;
  entry.takes_turns = lambent::takes_turns(status);
  if (entry.takes_turns) entry.last_traced += kSleepingAge;
  // Only lookups in open air read sleeping probes: they count as traced once, so that they come
  // after all other probes that have never been traced
  if (status.state == ProbeState::sleeping) entry.last_traced = std::max(entry.last_traced, 1u);
  if (entry.last_traced == 0) ++never_traced_;
}

/// Updates the numbers that depend on the variance of a probe and its neighbours; see
/// probe_deviation().
void ProbeScheduler::refresh_deviation(const ProbeStore& store,
                                       std::span<const ProbeStatus> statuses, int probe) {
  Entry& entry = entries_[probe];
  const ProbeStatus& own = statuses[probe];
  entry.deviation = entry.reduction = entry.reduction_per_deviation = 0.0f;
  if (entry.last_traced == kNotScheduled) return;
  const bool sleeps = own.state == ProbeState::sleeping;
  // Sleeping probes are traced so rarely that their variance, which is not known at first, must not
  // decide about surfaces
  struct Neighbourhood {
    std::span<const Entry> entries;
    std::span<const ProbeStatus> statuses;
    bool sleeps;
    bool fetch_scheduled(int at) const {
      return entries[at].last_traced != kNotScheduled &&
             (entries[at].state == ProbeState::sleeping) == sleeps;
    }
    float fetch_variance(int at) const { return statuses[at].variance; }
#include "field/schedule/neighbourhood_variance.inl.h"
  } near = {entries_, statuses, sleeps};
  entry.deviation =
      probe_deviation(own.variance, near.neighbourhood_variance(store.grid_of(probe), probe));
  if (sleeps && !entry.takes_turns) {
    entry.reduction = kSleepingReduction;
    return;
  }
  const float weight = sleeps ? kSleepingWeight : 1.0f;
  entry.reduction = weight * error_reduction(entry.deviation, own.samples, longest_);
  if (entry.reduction == 0.0f) return;
  entry.reduction_per_deviation = weight * error_reduction_per_deviation(own.samples);
}

void ProbeScheduler::refresh_block(std::size_t block) {
  Block sum;
  sum.last_traced = kNotScheduled;
  const std::size_t end = std::min((block + 1) * kBlock, entries_.size());
  for (std::size_t i = block * kBlock; i < end; ++i) {
    const Entry& entry = entries_[i];
    sum.reduction = std::max(sum.reduction, entry.reduction);
    sum.reduction_per_deviation =
        std::max(sum.reduction_per_deviation, entry.reduction_per_deviation);
    sum.last_traced = std::min(sum.last_traced, entry.last_traced);
    if (entry.reduction == 0.0f || entry.state == ProbeState::sleeping) continue;
    sum.deviation_sum += entry.deviation;
    ++sum.unsettled;
  }
  blocks_[block] = sum;
}

void ProbeScheduler::refresh(const ProbeStore& store, std::span<const ProbeStatus> statuses) {
  if (all_changed_) {
    for (std::size_t i = 0; i < entries_.size(); ++i) refresh_status(statuses, static_cast<int>(i));
    parallel_chunks(blocks_.size(), kBlocksPerTask, [&](std::size_t begin, std::size_t end) {
      const std::size_t last = std::min(end * kBlock, entries_.size());
      for (std::size_t i = begin * kBlock; i < last; ++i)
        refresh_deviation(store, statuses, static_cast<int>(i));
      for (std::size_t block = begin; block < end; ++block) refresh_block(block);
    });
  } else {
    std::vector<int> affected = changed_;
    for (const int probe : changed_) {
      refresh_status(statuses, probe);
      for_each_neighbour(store, probe, [&](int neighbour) { affected.push_back(neighbour); });
    }
    std::sort(affected.begin(), affected.end());
    affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
    for (std::size_t i = 0; i < affected.size(); ++i) {
      refresh_deviation(store, statuses, affected[i]);
      const std::size_t block = affected[i] / kBlock;
      if (i + 1 == affected.size() || affected[i + 1] / kBlock != block) refresh_block(block);
    }
  }
  changed_.clear();
  all_changed_ = false;
}

/// The number of rays of a probe: in proportion to its deviation. A probe that was never traced
/// gets few, so that all probes hold some light soon.
int ProbeScheduler::rays_of(const Entry& entry, float mean_deviation) const {
  if (entry.last_traced == 0) return kRayClasses.front();
  const bool unknown = entry.state == ProbeState::sleeping || mean_deviation <= 0.0f;
  const float share = unknown ? 1.0f : entry.deviation / mean_deviation;
  return ray_class_for(static_cast<float>(rays_per_probe_) * share);
}

/// The mean deviation of the probes near surfaces that have not converged.
float ProbeScheduler::mean_deviation() const {
  double deviation_sum = 0.0;
  std::int64_t unsettled = 0;
  for (const Block& block : blocks_) {
    deviation_sum += block.deviation_sum;
    unsettled += block.unsettled;
  }
  return unsettled > 0 ? static_cast<float>(deviation_sum / static_cast<double>(unsettled)) : 0.0f;
}

/// The weight of a probe, 0 to 1, from its volume's level and its importance or distance.
float ProbeScheduler::view_weight(const ProbeStore& store, int probe,
                                  const std::optional<glm::vec3>& viewer_ws,
                                  std::span<const float> importance) const {
  const int volume = store.volume_of(probe);
  const float weight = level_weight(roles_[volume].level);
  if (!importance.empty()) return weight * std::max(importance[probe], kUnseenWeight);
  if (!viewer_ws) return weight;
  const float away = length(store.probe_position_ws(probe) - *viewer_ws);
  return weight * distance_weight(away / largest_spacing(store.grid(volume)));
}

Schedule ProbeScheduler::choose(const ProbeStore& store, std::uint64_t ray_budget,
                                std::uint32_t update, const std::optional<glm::vec3>& viewer_ws,
                                std::span<const float> importance,
                                std::span<const int> stale) const {
  // Order the blocks by an upper bound on the urgency of their probes
  std::vector<Candidate> blocks;
  const float deviation = mean_deviation();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    // Use the age of the block's oldest probe: if it does not wait too long, no other probe does
    const std::uint32_t last_traced =
        waits_too_long(block.last_traced, update) ? block.last_traced : kNotScheduled;
    float weight = 1.0f;
    if (viewer_ws && importance.empty()) {
      const int first = static_cast<int>(b * kBlock);
      const int last = static_cast<int>(std::min((b + 1) * kBlock, entries_.size())) - 1;
      weight = distance_weight(least_cells_away(store, first, last, *viewer_ws));
    }
    const float urgency = probe_urgency(
        scheduled_reduction(block.reduction, block.reduction_per_deviation, deviation), last_traced,
        update, weight);
    if (urgency > 0.0f) blocks.push_back({urgency, static_cast<int>(b)});
  }
  const auto later = [](const Candidate& a, const Candidate& b) { return comes_before(b, a); };
  std::make_heap(blocks.begin(), blocks.end(), later);

  // Visit blocks until no other can contain a probe within the budget
  Best best(ray_budget / kRayClasses.front() + 1);
  while (!blocks.empty() && !best.beyond(blocks.front().urgency)) {
    const std::size_t first = blocks.front().probe * kBlock;
    std::pop_heap(blocks.begin(), blocks.end(), later);
    blocks.pop_back();
    for (std::size_t i = first; i < std::min(first + kBlock, entries_.size()); ++i) {
      const Entry& entry = entries_[i];
      if (entry.reduction == 0.0f && !waits_too_long(entry.last_traced, update)) continue;
      const int probe = static_cast<int>(i);
      if (entry.takes_turns && std::binary_search(stale.begin(), stale.end(), probe)) continue;
      const float weight = view_weight(store, probe, viewer_ws, importance);
      best.add({probe_urgency(
                    scheduled_reduction(entry.reduction, entry.reduction_per_deviation, deviation),
                    entry.last_traced, update, weight),
                probe});
    }
  }

  // Take the most urgent probes until the rays are spent
  std::vector<std::pair<int, int>> chosen;
  std::uint64_t spent = 0;
  for (const Candidate& candidate : best.take()) {
    const Entry& entry = entries_[candidate.probe];
    const int rays = rays_of(entry, deviation);
    if (spent + rays > ray_budget) break;
    spent += rays;
    chosen.emplace_back(candidate.probe, rays);
  }
  std::sort(chosen.begin(), chosen.end());
  Schedule schedule;
  for (const auto& [probe, rays] : chosen) {
    schedule.probes.push_back(probe);
    schedule.rays.push_back(rays);
  }
  return schedule;
}

}  // namespace lambent
