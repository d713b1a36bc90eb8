// SPDX-License-Identifier: Apache-2.0
// The order in which a recorded field updates its probes, and what the host knows about them
// without reading anything back from the device.
#pragma once

#include <cstdint>

#include "lambent/field.h"
#include "lambent/vulkan.h"
#include "vulkan/api.h"

// After Vulkan's headers without prototypes
#include "lambent/vulkan_field.h"

namespace lambent::vulkan {

// The most probes of an update: every device accepts this many groups in a dispatch.
inline constexpr int kMaxBatchProbes = 65535;

/// The probes of one update, whose indices are consecutive, and what is done with them.
struct ProbeBatch {
  int first = 0, count = 0;
  std::uint32_t update = 0;           ///< Number of the update, counted from 0.
  float history = 1.0f;               ///< Factor to the samples of all probes, 0 to 1.
  bool discards_history = false;      ///< The batch's probes start their averages again.
  bool on_device = false;             ///< The device chooses the probes, at most `count`.
  bool all = true;                    ///< Probes that are off are traced, too.
  std::uint32_t place = 0;            ///< kPlaceLeave, kPlaceStep, kPlaceFirstStep or kPlaceEnd.
  float largest_blend_weight = 1.0f;  ///< Upper bound of the batch's blend weights.
};

/// Plans batches in rounds: each round updates every probe once, and treats all probes alike. Under
/// a budget of rays, the device chooses the probes once the rounds are over that warm up the field
/// or relocate probes.
class BatchPlan {
 public:
  BatchPlan(const FieldSettings& settings, const RecordedFieldSettings& recorded, int probes);

  ProbeBatch next(const UpdatePlan& update);
  std::uint32_t updates() const { return updates_; }
  /// The most probes of a batch.
  int most_probes() const { return most_; }

 private:
  std::uint32_t place_in_round() const;
  void begin_round();
  ProbeBatch next_of_device(const UpdatePlan& update);
  bool rounds_are_over() const;

  int probes_, most_;
  bool budget_;  // the settings limit the rays of an update
  int placing_rounds_;
  float longest_;  // the most updates that an average remembers
  int next_ = 0;
  std::uint32_t updates_ = 0;
  int round_ = 0;             // counted from 0
  int placing_since_ = 0;     // the round in which relocation began last
  bool place_again_ = false;  // relocation begins again with the next round
  /// A lower bound on the updates that the next batch's probes have averaged: as if every probe
  /// moved whenever relocation may move it.
  float least_samples_ = 0.0f;
};

}  // namespace lambent::vulkan
