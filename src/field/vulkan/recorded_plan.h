// SPDX-License-Identifier: Apache-2.0
// Whose turn it is in a recorded field, and what the host knows of its probes without asking the
// device.
#pragma once

#include <cstdint>

#include "lambent/field.h"
#include "lambent/vulkan.h"
#include "vulkan/api.h"

// After Vulkan's headers without prototypes
#include "lambent/vulkan_field.h"

namespace lambent::vulkan {

// Probes of an update: as many groups as every device can have in a dispatch.
inline constexpr int kMaxBatchProbes = 65535;

/// An update: probes of indices that follow one another.
struct ProbeBatch {
  int first = 0, count = 0;
  std::uint32_t update = 0;           ///< Counted from 0.
  float history = 1.0f;               ///< What was averaged counts for this share of what it did.
  bool discards_history = false;      ///< The list's probes forget what they averaged.
  bool on_device = false;             ///< The device decides which probes: so many at most.
  bool all = true;                    ///< Probes that are off are looked at, too.
  std::uint32_t place = 0;            ///< kPlaceLeave, ...
  float largest_blend_weight = 1.0f;  ///< That any probe's new light counts for, at most.
};

/// Deals turns: every probe has one in each round, and all updates of a round treat theirs alike.
/// Under a budget of rays the device decides once the rounds are over in which probes know no light
/// yet, or are moved.
class BatchPlan {
 public:
  BatchPlan(const FieldSettings& settings, const RecordedFieldSettings& recorded, int probes);

  ProbeBatch next(const UpdatePlan& update);
  std::uint32_t updates() const { return updates_; }
  /// Probes of the largest turn.
  int most_probes() const { return most_; }

 private:
  std::uint32_t place_in_round() const;
  void begin_round();
  ProbeBatch next_of_device(const UpdatePlan& update);
  bool rounds_are_over() const;

  int probes_, most_;
  bool budget_;  // of rays
  int placing_rounds_;
  float longest_;  // updates that an average remembers
  int next_ = 0;
  std::uint32_t updates_ = 0;
  int round_ = 0;             // counted from 0
  int placing_since_ = 0;     // round
  bool place_again_ = false;  // from the next round on
  /// Updates that probes whose turn it is have averaged at least, were all of them to be moved when
  /// they may.
  float least_samples_ = 0.0f;
};

}  // namespace lambent::vulkan
