// SPDX-License-Identifier: Apache-2.0
// Which probes an update with a budget traces.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "field/schedule/schedule.h"
#include "shared/random.h"

namespace lambent::scheduler_test {
namespace {

/// The probes of a box, and their statuses.
struct Crowd {
  Crowd()
      : store(still_grid({vec3(0.0f), vec3(1.0f), ivec3(20, 7, 5)}), settings),
        records(store.probes()) {
    for (ProbeStatus& record : records) record.state = ProbeState::vigilant;
  }

  /// Marks all probes as traced, each with a variance of its own.
  void serve(std::uint32_t update) {
    RandomStream random = make_random_stream(1, 2, 3);
    for (ProbeStatus& record : records) {
      record.last_traced = update;
      record.samples = 1.0f + 9.0f * next_uniform(random);
      record.variance = 2.0f * next_uniform(random);
    }
  }

  Schedule within(std::uint64_t rays, std::uint32_t update) {
    ProbeScheduler scheduler(store.probes(), roles, settings);
    scheduler.refresh(store, records);
    return scheduler.choose(store, rays, update, viewer);
  }

  FieldSettings settings;
  ProbeStore store;
  std::vector<VolumeRole> roles{VolumeRole{}};
  std::vector<ProbeStatus> records;
  std::optional<glm::vec3> viewer;
};

std::uint64_t sum(const std::vector<int>& rays) {
  std::uint64_t total = 0;
  for (const int count : rays) total += static_cast<std::uint64_t>(count);
  return total;
}

TEST(ProbeScheduler, SpreadsAFewRaysOverTheProbesNearTheCameraFirst) {
  Crowd crowd;
  crowd.viewer = glm::vec3(19.0f, 0.0f, 0.0f);
  const Schedule schedule = crowd.within(32 * 70, 1);
  ASSERT_EQ(schedule.probes.size(), 70u);
  for (const int rays : schedule.rays) EXPECT_EQ(rays, kRayClasses.front());
  float farthest = 0.0f, nearest_left = 100.0f;
  for (int probe = 0; probe < crowd.store.probes(); ++probe) {
    const float away = length(crowd.store.probe_position_ws(probe) - *crowd.viewer);
    const bool served = std::binary_search(schedule.probes.begin(), schedule.probes.end(), probe);
    (served ? farthest : nearest_left) =
        served ? std::max(farthest, away) : std::min(nearest_left, away);
  }
  EXPECT_LE(farthest, nearest_left);
}

TEST(ProbeScheduler, KeepsTheBudget) {
  Crowd crowd;
  crowd.serve(5);
  for (const std::uint64_t budget : {0u, 31u, 1000u, 20000u}) {
    EXPECT_LE(sum(crowd.within(budget, 6).rays), budget);
  }
  EXPECT_GT(sum(crowd.within(20000, 6).rays), 20000u - kRayClasses.back());
}

TEST(ProbeScheduler, LetsProbesRestUntilTheyAreOld) {
  Crowd crowd;
  crowd.serve(5);
  for (ProbeStatus& record : crowd.records) {
    record.variance = 1e-4f;
    record.samples = 50.0f;
  }
  EXPECT_TRUE(crowd.within(1u << 20, 5 + kMaxProbeAge - 1).probes.empty());
  crowd.records[33].last_traced = 4;
  EXPECT_EQ(crowd.within(1u << 20, 4 + kMaxProbeAge).probes, std::vector<int>{33});
  EXPECT_EQ(crowd.within(1u << 20, 5 + kMaxProbeAge).probes.size(), crowd.records.size());
}

TEST(ProbeScheduler, ServesTheOldestFirst) {
  Crowd crowd;
  crowd.serve(1000);
  for (std::size_t i = 0; i < crowd.records.size(); ++i) {
    crowd.records[i].last_traced = static_cast<std::uint32_t>(1000 - i);
  }
  const Schedule schedule = crowd.within(512, 3000);
  ASSERT_FALSE(schedule.probes.empty());
  EXPECT_EQ(schedule.probes.back(), static_cast<int>(crowd.records.size()) - 1);
  for (std::size_t k = 1; k < schedule.probes.size(); ++k) {
    EXPECT_EQ(schedule.probes[k], schedule.probes[k - 1] + 1);
  }
}

TEST(ProbeScheduler, GivesTheProbeThatGainsMost) {
  Crowd crowd;
  crowd.serve(5);
  for (ProbeStatus& record : crowd.records) record.variance = record.samples = 1.0f;
  crowd.records[300].samples = 0.25f;
  EXPECT_EQ(crowd.within(crowd.settings.rays_per_probe, 6).probes, std::vector<int>{300});
}

TEST(ProbeScheduler, PrefersWhatMattersToWhatIsSeenButStarvesNobody) {
  Crowd crowd;
  crowd.serve(5);
  for (ProbeStatus& record : crowd.records) record.variance = record.samples = 1.0f;
  std::vector<float> importance(crowd.records.size(), 0.0f);
  importance[400] = 1.0f;
  ProbeScheduler scheduler(crowd.store.probes(), crowd.roles, crowd.settings);
  scheduler.refresh(crowd.store, crowd.records);
  const auto served = [&](std::uint64_t budget) {
    return scheduler.choose(crowd.store, budget, 6, std::nullopt, importance).probes;
  };
  EXPECT_EQ(served(crowd.settings.rays_per_probe), std::vector<int>{400});
  EXPECT_EQ(served(1u << 20).size(), crowd.records.size());
}

TEST(ProbeScheduler, WhatItKeepsInMindIsWhatItWouldFindAnew) {
  Crowd crowd;
  crowd.serve(5);
  ProbeScheduler scheduler(crowd.store.probes(), crowd.roles, crowd.settings);
  scheduler.refresh(crowd.store, crowd.records);
  RandomStream random = make_random_stream(4, 5, 6);
  for (std::uint32_t update = 6; update < 40; ++update) {
    for (int i = 0; i < 9; ++i) {
      const int probe =
          static_cast<int>(next_uniform(random) * static_cast<float>(crowd.records.size()));
      ProbeStatus& record = crowd.records[probe];
      record.variance = next_uniform(random);
      record.samples += next_uniform(random);
      record.last_traced = update;
      record.state = static_cast<ProbeState>(static_cast<int>(next_uniform(random) * 6.0f));
      scheduler.mark_changed(probe);
    }
    scheduler.refresh(crowd.store, crowd.records);
    ProbeScheduler anew(crowd.store.probes(), crowd.roles, crowd.settings);
    anew.refresh(crowd.store, crowd.records);
    const Schedule kept = scheduler.choose(crowd.store, 3000, update + 1, crowd.viewer);
    const Schedule found = anew.choose(crowd.store, 3000, update + 1, crowd.viewer);
    EXPECT_EQ(kept.probes, found.probes);
    EXPECT_EQ(kept.rays, found.rays);
    EXPECT_EQ(scheduler.states().vigilant, anew.states().vigilant);
    EXPECT_EQ(scheduler.states().sleeping, anew.states().sleeping);
    EXPECT_EQ(scheduler.never_traced(), anew.never_traced());
  }
}

}  // namespace
}  // namespace lambent::scheduler_test
