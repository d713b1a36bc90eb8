// SPDX-License-Identifier: Apache-2.0
// The order in which an update calls the passes of an executor.
#include "field/passes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/pass_times.h"

namespace lambent::field_passes_test {
namespace {

/// Records the passes that are called.
class Log final : public FieldPasses {
 public:
  explicit Log(Visibility visibility = Visibility::moments, int batches = 1) : batches_(batches) {
    settings_.visibility = visibility;
  }

  std::vector<std::string> named, done;
  bool learning = true;

  const FieldSettings& settings() const override { return settings_; }
  int batches() const override { return batches_; }
  void schedule() override { done.emplace_back("schedule"); }
  void trace(int batch) override { done.push_back("trace" + std::to_string(batch)); }
  void shade(int batch) override { done.push_back("shade" + std::to_string(batch)); }
  void keep_history() override { done.emplace_back("keep_history"); }
  void move_distances() override { done.emplace_back("move_distances"); }
  void blend_distances() override { done.emplace_back("blend_distances"); }
  void visibility() override { done.emplace_back("visibility"); }
  bool learns() const override { return learning; }
  void corrections() override { done.emplace_back("corrections"); }
  void lookups() override { done.emplace_back("lookups"); }
  void solve() override { done.emplace_back("solve"); }
  void variability() override { done.emplace_back("variability"); }
  void store() override { done.emplace_back("store"); }
  void scroll() override { done.emplace_back("scroll"); }
  void placement() override { done.emplace_back("placement"); }
  void begin(const char* name) override {
    EXPECT_EQ(named.size(), done.size()) << "a pass begins within another";
    named.emplace_back(name);
  }
  void end() override { EXPECT_EQ(named.size(), done.size()) << "a pass ends without having run"; }

 private:
  FieldSettings settings_;
  int batches_;
};

using Names = std::vector<std::string>;

TEST(FieldPassOrder, TracesAndShadesBatchAfterBatchAndLightsAllAtOnce) {
  Log log(Visibility::hybrid, 2);
  update_probes(log);
  EXPECT_EQ(log.done,
            (Names{"trace0", "shade0", "trace1", "shade1", "blend_distances", "visibility",
                   "corrections", "lookups", "solve", "variability", "store"}));
  EXPECT_EQ(log.named, (Names{"trace", "shade", "trace", "shade", "blend_distances", "visibility",
                              "corrections", "lookups", "solve", "variability", "store"}));
}

TEST(FieldPassOrder, LooksAcrossCellsForHybridVisibilityAlone) {
  for (const Visibility visibility : {Visibility::moments, Visibility::exact}) {
    Log log(visibility);
    update_probes(log);
    EXPECT_EQ(std::count(log.named.begin(), log.named.end(), "visibility"), 0);
  }
}

TEST(FieldPassOrder, LooksAcrossCellsAfterEditsWhereNoHostHasDoneSo) {
  Log log(Visibility::hybrid);
  follow_retraced_hits(log);
  EXPECT_EQ(log.done, (Names{"keep_history", "shade0", "move_distances", "visibility", "lookups",
                             "solve", "variability", "store"}));
  EXPECT_EQ(log.named, (Names{"edits", "shade", "blend_distances", "visibility", "lookups", "solve",
                              "variability", "store"}));
  Log of_host(Visibility::hybrid);
  retrace_probes(of_host);
  EXPECT_EQ(of_host.done, (Names{"keep_history", "trace0", "shade0", "move_distances", "lookups"}));
}

TEST(FieldPassOrder, LearnsCorrectionsOnlyWhereTheExecutorDoes) {
  Log log;
  log.learning = false;
  update_probes(log);
  EXPECT_EQ(std::count(log.named.begin(), log.named.end(), "corrections"), 0);
}

TEST(FieldPassOrder, PartsThatAnEngineRecordsMakeUpTheWhole) {
  Log whole, parts;
  whole.begin("schedule");
  whole.schedule();
  update_probes(whole);
  whole.begin("placement");
  whole.placement();
  for (const auto part : {choose_rays, find_hits, follow_hits, maintain_probes}) part(parts);
  EXPECT_EQ(parts.named, whole.named);
  EXPECT_EQ(parts.done, whole.done);
}

TEST(PassTimes, AddUpByNameInTheOrderOfTheFirst) {
  std::vector<PassTime> times;
  add_pass_time(times, "b", 1.0);
  add_pass_time(times, "a", 2.0);
  add_pass_time(times, "b", 4.0);
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].name, "b");
  EXPECT_EQ(times[0].ms, 5.0);
  EXPECT_EQ(times[1].name, "a");
}

}  // namespace
}  // namespace lambent::field_passes_test
