// SPDX-License-Identifier: Apache-2.0
// The edits of the world that have been applied to some probes, and not yet to others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "field/edits/edited_light_math.h"
#include "field/transport/anderson.h"
#include "lambent/field.h"

namespace lambent {

/// What edits changed at some probes, one entry for each of them.
struct EditedProbes {
  std::vector<float> history_shares;  ///< The share of its history that holds (history_share()).
  std::vector<EditedLight> light;     ///< Direct light along its rays before and after.
};

/// Edits of the world that have been applied to some probes and not yet to others.
struct PendingEdits {
  std::uint64_t revision = 0;  ///< The world's revision that the edits led to.
  /// The light of all probes before the edits. Empty where no edits are pending.
  WorkingIrradiance before;
  /// For each texel of the updated probes, the ratio of the averaged light to what the last rays
  /// alone estimated (history_ratio.cpp).
  WorkingIrradiance history_ratio;
  EditedProbes probes;        ///< Of all of the field's probes; only those of `updated` count.
  std::vector<int> updated;   ///< Probes to which the edits have been applied, in ascending order.
  double direct_light = 0.0;  ///< Sum over `updated` of the mean direct light along their rays.
};

/// How far an update got with the edits of the world: no probe was stale, some stale probes are
/// left, or all stale probes have been brought up to date.
enum class EditProgress { none, partial, complete };

// Testing a probe's surfels against edits costs about as much as tracing this many rays, even if no
// ray has to be traced again.
inline constexpr std::uint64_t kRaysPerInvalidation = 8;

/// The cost of applying edits in an update so far [rays].
inline std::uint64_t edit_work(const UpdateStatistics& statistics) {
  return statistics.probe_rays + statistics.shadow_rays +
         kRaysPerInvalidation * static_cast<std::uint64_t>(statistics.probes_invalidated);
}

/// What an update may spend on applying edits.
struct EditBudget {
  std::uint64_t rays;  ///< edit_work(); the largest number: no bound.
  double ms;           ///< Infinite: no bound.
};
inline constexpr EditBudget kUnboundedEdits = {std::numeric_limits<std::uint64_t>::max(),
                                               std::numeric_limits<double>::infinity()};

inline bool is_bounded(const EditBudget& budget) {
  return budget.rays < kUnboundedEdits.rays || budget.ms < kUnboundedEdits.ms;
}

/// The probes that have been traced at all, and those whose surfels belong to an older revision of
/// the world.
struct StaleProbes {
  std::vector<int> traced;    ///< All probes that have surfels.
  std::vector<int> waiting;   ///< The stale probes among them, without the sleeping ones.
  std::vector<int> sleeping;  ///< The stale probes among them that sleep.
};

/// The state of the edits of a field's world.
struct FieldEdits {
  PendingEdits pending;
  std::uint64_t applied_revision = 0;  ///< Revision with which all but sleeping probes are current.
  std::vector<int> stale_sleeping;     ///< Stale sleeping probes, the oldest first.
  std::size_t sleeping_per_slice = 0;  ///< The most stale sleeping probes that an update updates.
  /// For each probe, the factor by which samples of corrections around it will count less, 0 to 1,
  /// since corrections last forgot anything. Empty: all samples count fully.
  std::vector<float> to_forget;
  int forgot_at = 0;          ///< Number of the update in which corrections last forgot; 0: none.
  bool applied_last = false;  ///< The last update applied edits and traced nothing else.
};

}  // namespace lambent
