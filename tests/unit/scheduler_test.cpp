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

/// Lets some probes of a crowd sleep that was traced in update 1, by the remainder of their index.
Crowd crowd_with_sleepers(int of_three) {
  Crowd crowd;
  crowd.serve(1);
  for (std::size_t i = 0; i < crowd.records.size(); ++i) {
    if (static_cast<int>(i % 3) < of_three) crowd.records[i].state = ProbeState::sleeping;
  }
  return crowd;
}

/// Schedules updates without a budget from `first` on, every `step`th. Returns how often each probe
/// that sleeps was traced, and adds their number in each update to `per_update`.
std::vector<int> turns_taken(Crowd& crowd, std::uint32_t updates, std::uint32_t step,
                             std::vector<int>& per_update, std::span<const int> stale = {}) {
  std::vector<int> turns(crowd.records.size(), 0);
  for (std::uint32_t update = step; update < step + updates; update += step) {
    per_update.push_back(0);
    const Schedule schedule =
        schedule_all(crowd.store, crowd.roles, crowd.records, crowd.settings, update, stale);
    for (const int probe : schedule.probes) {
      crowd.records[probe].last_traced = update + 1;
      if (crowd.records[probe].state != ProbeState::sleeping) continue;
      ++turns[probe];
      ++per_update.back();
    }
  }
  return turns;
}

TEST(Schedule, TracesSleepingProbesInTurns) {
  Crowd crowd = crowd_with_sleepers(1);
  std::vector<int> per_update;
  const std::vector<int> turns = turns_taken(crowd, 2 * kSleepingPeriod, 1, per_update);
  for (std::size_t i = 0; i < turns.size(); i += 3) EXPECT_EQ(turns[i], 2);
  const double mean = static_cast<double>(turns.size()) / 3.0 / kSleepingPeriod;
  for (const int traced : per_update) EXPECT_NEAR(traced, mean, 0.15 * mean);
}

TEST(Schedule, LetsTurnsWaitForUpdatesThatTrace) {
  Crowd crowd = crowd_with_sleepers(1);
  std::vector<int> per_update;
  const std::vector<int> turns = turns_taken(crowd, 2 * kSleepingPeriod, 2, per_update);
  for (std::size_t i = 0; i < turns.size(); i += 3) EXPECT_EQ(turns[i], 2);
}

TEST(Schedule, LetsTurnsWaitForEditsToArrive) {
  Crowd crowd = crowd_with_sleepers(1);
  const std::vector<int> stale = {3, 30};
  std::vector<int> per_update;
  const std::vector<int> turns = turns_taken(crowd, kSleepingPeriod, 1, per_update, stale);
  for (int i = 0; i < static_cast<int>(turns.size()); i += 3) {
    EXPECT_EQ(turns[i], i == 3 || i == 30 ? 0 : 1);
  }
}

TEST(Schedule, TracesFewSleepingProbesWhereMostSleep) {
  Crowd crowd = crowd_with_sleepers(2);
  for (std::size_t i = 2; i < crowd.records.size(); i += 6) {
    crowd.records[i].state = ProbeState::sleeping;  // five of six
  }
  const auto live = static_cast<double>(crowd.records.size()) / 6.0;
  std::vector<int> per_update;
  turns_taken(crowd, 100, 1, per_update);
  EXPECT_LT(*std::max_element(per_update.begin(), per_update.end()), 0.15 * live);
  EXPECT_GT(*std::min_element(per_update.begin(), per_update.end()), 0.05 * live);
}

// As things move, probes fall asleep and awake, so that the period of turns changes all the time.
TEST(Schedule, TracesFewSleepingProbesWhileTheirNumberChanges) {
  Crowd crowd = crowd_with_sleepers(2);
  std::vector<int> traced(crowd.records.size(), 0);
  for (std::uint32_t update = 1; update < 200; ++update) {
    for (std::size_t i = 2; i < crowd.records.size(); i += 6) {
      crowd.records[i].state = update / 8 % 2 == 0 ? ProbeState::sleeping : ProbeState::vigilant;
    }
    const auto asleep =
        std::ranges::count(crowd.records, ProbeState::sleeping, &ProbeStatus::state);
    int turns = 0;
    for (const int probe :
         schedule_all(crowd.store, crowd.roles, crowd.records, crowd.settings, update, {}).probes) {
      crowd.records[probe].last_traced = update + 1;
      if (crowd.records[probe].state != ProbeState::sleeping) continue;
      ++turns;
      ++traced[probe];
    }
    EXPECT_LT(turns, 0.15 * static_cast<double>(asleep)) << update;
  }
  for (std::size_t i = 0; i < traced.size(); i += 3) EXPECT_GE(traced[i], 2) << i;
}

TEST(ProbeScheduler, GivesSleepingProbesTheirShareOfABudget) {
  Crowd crowd = crowd_with_sleepers(1);
  for (ProbeStatus& record : crowd.records) record.variance = record.samples = 1.0f;
  ProbeScheduler scheduler(crowd.store.probes(), crowd.roles, crowd.settings);
  for (std::uint32_t update = 2; update < 400; ++update) {
    scheduler.refresh(crowd.store, crowd.records);
    const Schedule schedule = scheduler.choose(
        crowd.store, 70u * static_cast<std::uint64_t>(crowd.settings.rays_per_probe), update, {});
    for (std::size_t k = 0; k < schedule.probes.size(); ++k) {
      ProbeStatus& record = crowd.records[schedule.probes[k]];
      record.samples +=
          static_cast<float>(schedule.rays[k]) / static_cast<float>(crowd.settings.rays_per_probe);
      record.last_traced = update;
      scheduler.mark_changed(schedule.probes[k]);
    }
  }
  double asleep = 0.0, live = 0.0;
  for (const ProbeStatus& record : crowd.records) {
    (record.state == ProbeState::sleeping ? asleep : live) += static_cast<double>(record.samples);
  }
  // Half as many sleep as do not
  const double share = 2.0 * asleep / live;
  EXPECT_NEAR(share * kSleepingPeriod, 1.0, 0.4);
}

TEST(ProbeScheduler, LetsSleepingProbesRestLonger) {
  Crowd crowd = crowd_with_sleepers(3);
  for (ProbeStatus& record : crowd.records) {
    record.variance = 1e-4f;
    record.samples = 50.0f;
  }
  constexpr std::uint32_t kAge = kSleepingPeriod * kMaxProbeAge;
  EXPECT_TRUE(crowd.within(1u << 20, 1 + kAge - 1).probes.empty());
  EXPECT_EQ(crowd.within(1u << 20, 1 + kAge).probes.size(), crowd.records.size());
}

}  // namespace
}  // namespace lambent::scheduler_test
