// SPDX-License-Identifier: Apache-2.0
#include "field/correction/train_corrections.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>

#include "core/parallel.h"
#include "field/correction/train_math.h"
#include "field/lookup/query_at.h"
#include "field/secondary/gathering_rays.h"
#include "shared/color.h"
#include "shared/rays.h"

namespace lambent {
namespace {

constexpr std::size_t kPointsPerTask = 128;

/// A point on a surface at which light is gathered.
struct TrainingPoint {
  FieldQuery at;
  vec3 geometric_normal_ws;
  float gi_share = 0.0f;  ///< 0: there is no point.
  uint index = 0;         ///< Seeds the point's random numbers.
};

/// The data that all gathers of an update share.
struct Training {
  const World& world;
  const ProbeData& data;
  VisibilityRays uncorrected;
  HitLighting lighting;  // of the hits of gathering rays, by corrected lookups
  uint number, seed;
};

/// The points at which this rank learns in an update: those of training_surfels() that belong to
/// this rank and reflect light.
std::vector<TrainingPoint> points_of(const Training& training, std::span<const int> probes) {
  std::vector<TrainingPoint> points;
  uint point = 0;
  for (const TrainingSurfel& at : training_surfels(training.data, probes, training.number)) {
    const uint index = point++;
    if (!training.data.share.alone() && !training.data.share.has(at.probe)) continue;
    const ProbeTrace& trace = training.data.traces[at.probe];
    const Surfel& surfel = trace.surfels[at.ray];
    if (!surfel.reflects() || surfel.gi_share <= 0.0f) continue;
    points.push_back({surfel.query_from(training.data.store.probe_position_ws(at.probe),
                                        trace.rays->directions[at.ray]),
                      decode_unit_vector(surfel.geometric_normal_ws), surfel.gi_share, index});
  }
  return points;
}

using GathersRef = const GatheringRays&;

const vec3& fetch_direction(const GatheringRays& gathers, uint ray) {
  return gathers.rays[ray].direction;
}
const ShadedHitRecord& fetch_hit(const GatheringRays& gathers, uint ray) {
  return gathers.shaded[ray].surface;
}
vec3 fetch_radiance(const GatheringRays& gathers, uint ray) {
  const ShadedHit& hit = gathers.shaded[ray];
  return gathered_radiance(hit.surface, hit.direct_irradiance, gathers.arrives[ray]);
}

#include "field/correction/train.inl.h"

void add_rays(const Training& training, const TrainingPoint& point, GatheringRays& gathers) {
  const Frame frame = make_frame(point.at.normal_ws);
  const vec3 origin = offset_ray_origin(point.at.position_ws, point.geometric_normal_ws);
  for (int ray = 0; ray < kTrainingRays; ++ray) {
    gathers.add(origin, training_direction(frame, point.index, training.number, ray, training.seed),
                std::size_t{point.index} * kTrainingRays + static_cast<std::size_t>(ray));
  }
}

/// The rays of the points' gathers, and what they find. Adds the number of rays traced to `traced`.
GatheringRays gather(const Training& training, std::span<const TrainingPoint> points,
                     std::uint64_t& traced) {
  GatheringRays gathers;
  for (const TrainingPoint& point : points) add_rays(training, point, gathers);
  ShadeHitsScratch scratch;
  traced += gathers.light(training.lighting, scratch);
  return gathers;
}

/// The hit of one of a point's rays as the next point. `first` is the index of the first ray.
TrainingPoint following_point(const Training& training, const GatheringRays& gathers, uint first,
                              uint index) {
  const uint ray = following_ray(gathers, first, index, training.number, training.seed);
  if (ray == kNoTrainingRay) return {};
  const ShadedHit& hit = gathers.shaded[ray];
  return {query_at(hit.point), hit.point.geometric_normal_ws, hit.surface.gi_share,
          index | kFollowingPoint};
}

/// Compares the gathered irradiance of each point with the lookups of the volumes that light it.
/// Returns the number of visibility rays traced.
std::uint64_t compare(const Training& training, std::span<const TrainingPoint> points,
                      const GatheringRays& gathers, std::vector<CorrectionSample>& samples) {
  std::vector<FieldQuery> queries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) queries[i] = points[i].at;
  QueryWeights weights;
  const std::uint64_t traced =
      find_weights(training.data.store, training.uncorrected, queries, weights);
  for (std::size_t w = 0; w < weights.corners.size(); ++w) {
    const std::uint32_t i = weights.query[w];
    const TrainingPoint& point = points[i];
    // Compare each volume's lookup separately, since volumes may be off by different factors
    CornerWeights corners = weights.corners[w];
    normalize_weights(corners);
    vec3 irradiance(0.0f);
    constexpr std::uint32_t kOnlyOne = 0;
    add_irradiance(training.data.store, {&point.at, 1}, {&corners, 1}, {&kOnlyOne, 1},
                   {&irradiance, 1});
    const float looked_up = point.gi_share * luminance(irradiance);
    if (!(looked_up > 0.0f)) continue;
    const GatheredLuminance gathered = gathered_luminance(
        gathers, i * kTrainingRays, point.at.normal_ws, point.geometric_normal_ws, point.gi_share);
    samples.push_back(
        {point.at.position_ws, point.at.normal_ws, static_cast<int>(corners.table) / kCellWraps,
         gathered.luminance, gathered.variance, looked_up,
         training_random(point.index, training.number, kTrainingAxes, training.seed)});
  }
  return traced;
}

/// The number of points of the ranks before this one, which has `own` points.
std::size_t points_before(Ranks& ranks, std::size_t own) {
  const std::vector<std::uint64_t> each = gather_each<std::uint64_t>(ranks, own);
  return std::accumulate(each.begin(), each.begin() + ranks.own(), std::uint64_t{0});
}

/// Samples of a task's points, and of the points at hits of their rays.
using TaskSamples = std::array<std::vector<CorrectionSample>, 2>;

/// Consecutive samples in the list of the samples of all ranks.
struct SampleRun {
  std::uint64_t order;  ///< Twice the task's number, plus 1 for points at hits of other rays.
  std::uint64_t count;
};

/// The samples of all ranks, in the order in which a single rank has them, so that sums over them
/// have the same bits. `tasks` are numbered from `first_task` on; neighbouring ranks may share one.
std::vector<CorrectionSample> joined(Ranks& ranks, std::span<const TaskSamples> tasks,
                                     std::uint64_t first_task) {
  std::vector<CorrectionSample> own;
  std::vector<SampleRun> own_runs;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    for (std::size_t part = 0; part < tasks[t].size(); ++part) {
      const std::vector<CorrectionSample>& samples = tasks[t][part];
      own_runs.push_back({2 * (first_task + t) + part, samples.size()});
      own.insert(own.end(), samples.begin(), samples.end());
    }
  }
  if (ranks.count() == 1) return own;

  const std::vector<SampleRun> runs = gather_all(ranks, std::move(own_runs));
  const std::vector<CorrectionSample> gathered = gather_all(ranks, std::move(own));
  std::vector<std::size_t> begins, places(runs.size());
  std::size_t begin = 0;
  for (const SampleRun& run : runs) {
    begins.push_back(begin);
    begin += run.count;
  }
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_sort(places.begin(), places.end(),
                   [&](std::size_t a, std::size_t b) { return runs[a].order < runs[b].order; });
  std::vector<CorrectionSample> all;
  all.reserve(gathered.size());
  for (const std::size_t place : places) {
    const auto first = gathered.begin() + static_cast<std::ptrdiff_t>(begins[place]);
    all.insert(all.end(), first, first + static_cast<std::ptrdiff_t>(runs[place].count));
  }
  return all;
}

}  // namespace

std::vector<TrainingSurfel> training_surfels(const ProbeData& data, std::span<const int> probes,
                                             uint number) {
  std::size_t all = 0;
  for (const int probe : probes) all += data.traces[probe].rays->directions.size();
  std::vector<TrainingSurfel> surfels(all / training_stride(number));
  std::size_t k = 0, first = 0;  // the place of a surfel's probe, and the probe's first surfel
  for (uint point = 0; point < surfels.size(); ++point) {
    const std::size_t at = training_surfel(point, number, data.settings.seed);
    for (;; ++k) {
      const std::size_t rays = data.traces[probes[k]].rays->directions.size();
      if (at < first + rays) break;
      first += rays;
    }
    surfels[point] = {probes[k], static_cast<int>(at - first)};
  }
  return surfels;
}

ShadeHitsSettings training_shading(const FieldSettings& settings, uint number) {
  return gathering_shading(kTrainingRays, settings.max_albedo, number, ~settings.seed);
}

std::uint64_t train_corrections(const World& world, std::span<const int> probes,
                                const VisibilityRays& by, uint number, ProbeData& data) {
  Training training{world,
                    data,
                    by,
                    {world,
                     data.store.grids(),
                     training_shading(data.settings, number),
                     kMaxTrainingSecondaryRays,
                     {}},
                    number,
                    data.settings.seed};
  training.uncorrected.correction = nullptr;
  training.lighting.look_up = [&](std::span<const FieldQuery> queries, std::span<vec3> result) {
    return lookup_irradiance(data.store, by, queries, result);
  };
  const std::vector<TrainingPoint> points = points_of(training, probes);
  // Tasks are consecutive points of all ranks; this rank's points may begin within a task
  const std::size_t before = points_before(data.share.ranks(), points.size());
  const std::size_t lead = before % kPointsPerTask, last = lead + points.size();
  std::vector<TaskSamples> samples((last + kPointsPerTask - 1) / kPointsPerTask);
  std::atomic<std::uint64_t> traced = 0;
  parallel_chunks(last, kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    auto& [out, out_following] = samples[begin / kPointsPerTask];
    begin = max(begin, lead);
    const std::span<const TrainingPoint> own =
        std::span(points).subspan(begin - lead, end > begin ? end - begin : 0);
    std::uint64_t rays = 0;
    const GatheringRays gathers = gather(training, own, rays);
    rays += compare(training, own, gathers, out);

    std::vector<TrainingPoint> following;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const TrainingPoint next =
          following_point(training, gathers, static_cast<uint>(i * kTrainingRays), own[i].index);
      if (next.gi_share > 0.0f) following.push_back(next);
    }
    const GatheringRays further = gather(training, following, rays);
    traced += rays + compare(training, following, further, out_following);
  });
  data.correction.learn(data.store.grids(),
                        joined(data.share.ranks(), samples, before / kPointsPerTask), number);
  return traced;
}

}  // namespace lambent
