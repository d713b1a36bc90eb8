// SPDX-License-Identifier: Apache-2.0
// The time that a bake would take on several ranks with a core each: the sum of the slowest rank's
// processor times between exchanges, without the exchanges themselves. Ranks are threads here, so
// that other programs on the machine do not affect the result.
//
// usage: lambent_rank_times SCENE UPDATES PROBES
#include <tbb/global_control.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/ranks.h"
#include "field/field_access.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "support/thread_ranks.h"

namespace lambent {
namespace {

/// Processor time of this thread [ms].
double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Ranks that record this rank's processor time between exchanges.
class TimedRanks final : public Ranks {
 public:
  explicit TimedRanks(Ranks& ranks) : ranks_(ranks) {}

  int count() const override { return ranks_.count(); }
  int own() const override { return ranks_.own(); }
  void gather_bytes(std::span<std::byte> bytes, std::span<const std::size_t> firsts) override {
    lap();
    ranks_.gather_bytes(bytes, firsts);
    since_ = thread_ms();
  }
  /// Ends a stretch of work.
  void lap() {
    stretches_.push_back(thread_ms() - since_);
    since_ = thread_ms();
  }
  const std::vector<double>& stretches() const { return stretches_; }

 private:
  Ranks& ranks_;
  std::vector<double> stretches_;
  double since_ = thread_ms();
};

/// Time of `updates` updates on `count` ranks [ms].
double time_of(const World& world, const FieldSettings& settings, int updates, int count) {
  std::vector<std::vector<double>> stretches(count);
  test::run_as_ranks(count, [&](Ranks& threads) {
    TimedRanks ranks(threads);
    IrradianceField field = IrradianceField::make(settings, open_bounds(world)).value();
    share_work(field, ranks);
    for (int i = 0; i < updates; ++i) field.update(world);
    ranks.lap();
    stretches[ranks.own()] = ranks.stretches();
  });
  double sum = 0.0;
  for (std::size_t k = 0; k < stretches.front().size(); ++k) {
    double slowest = 0.0;
    for (const std::vector<double>& of_rank : stretches) slowest = std::max(slowest, of_rank[k]);
    sum += slowest;
  }
  return sum;
}

int run(int argc, char** argv) {
  const Expected<Scene> scene = argc == 4 ? scenes::make(argv[1]) : Expected<Scene>();
  if (argc != 4 || !scene) {
    std::fprintf(stderr, "usage: lambent_rank_times SCENE UPDATES PROBES (a built-in scene)\n");
    return 2;
  }
  // Each rank is one thread
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const World world(*scene);
  FieldSettings settings;
  settings.probe_budget = std::atoi(argv[3]);
  double alone = 0.0;
  for (const int count : {1, 2, 4, 8}) {
    const double ms = time_of(world, settings, std::atoi(argv[2]), count);
    if (count == 1) alone = ms;
    std::printf("%d ranks: %.0f ms, %.2f times as fast\n", count, ms, alone / ms);
  }
  return 0;
}

}  // namespace
}  // namespace lambent

int main(int argc, char** argv) {
  return lambent::run(argc, argv);
}
