// SPDX-License-Identifier: Apache-2.0
// The order in which a recorded field updates its probes. The host plans it without reading
// anything back from the device.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/probes/probe_status.h"
#include "lambent/field.h"
#include "lambent/vulkan.h"
#include "vulkan/api.h"

// Include this after Vulkan's headers without prototypes
#include "lambent/vulkan_field.h"

namespace lambent::vulkan {

// The most probes of an update: every device accepts this many groups in a dispatch.
inline constexpr int kMaxBatchProbes = 65535;

/// The probes of one update, and what is done with them.
struct ProbeBatch {
  std::vector<int> probes;        ///< Empty where the device chooses.
  int count = 0;                  ///< Number of probes; an upper bound where the device chooses.
  std::uint32_t update = 0;       ///< Number of the update, counted from 0.
  float history = 1.0f;           ///< Factor of the numbers of samples of all probes, 0 to 1.
  bool discards_history = false;  ///< The batch's probes start their averages again.
  bool retraces = false;          ///< After edits, probes trace their last rays again.
  /// The updates whose ray directions the probes trace, and for each probe an index into them.
  std::vector<std::uint32_t> drawn_in;
  std::vector<int> ray_sets;
  bool on_device = false;             ///< The device chooses the probes.
  bool all = true;                    ///< Probes that are off are traced, too.
  bool places = false;                ///< Some of the probes may still be placed.
  bool place_again = false;           ///< The placement of all probes begins again.
  float largest_blend_weight = 1.0f;  ///< Upper bound of the batch's blend weights.
};

/// Plans batches in rounds. A round updates every probe once, except that probes of coarse cascades
/// take part in fewer rounds. Probes that a scrolling cascade has recycled come first. With a
/// budget of rays, the device chooses the probes after the rounds that warm up the field or
/// relocate probes.
class BatchPlan {
 public:
  /// `levels` has the cascade level of each probe, 0 to 15, the finest (and any other volume) 0.
  BatchPlan(const FieldSettings& settings, const RecordedFieldSettings& recorded,
            std::vector<std::uint8_t> levels);

  /// Continues after this many updates of another field, whose probes had these statuses. The
  /// probes are not relocated, and those without samples come first.
  void start_from(std::uint32_t updates, std::span<const ProbeStatus> statuses);

  /// Plans the next update. The `recycled` probes have been reset before it.
  ProbeBatch next(const UpdatePlan& update, std::span<const int> recycled = {});
  std::uint32_t updates() const { return updates_; }
  /// The most probes and ray sets of a batch.
  int most_probes() const { return most_; }
  int most_ray_sets() const { return most_sets_; }
  /// Whether edits are followed exactly: all probes' last rays can be traced again at once.
  bool follows_edits() const { return follows_edits_; }

 private:
  /// The host's record of a probe.
  struct Known {
    std::uint8_t level = 0;
    /// Number of updates that traced it since its placement began, at most kMaxTracedCount.
    std::uint8_t traced = 0;
    bool chosen = false;         ///< It is in the batch that is being planned.
    bool of_file = false;        ///< It averages rays of another field only.
    std::uint32_t drawn_in = 0;  ///< Number of the update that drew its last rays, from 1; 0: none.
    /// A lower bound on the number of updates that it has averaged, which assumes that the probe
    /// moved in every update in which it may move.
    float least_samples = 0.0f;
  };

  int probes() const { return static_cast<int>(known_.size()); }
  bool warming_up() const;
  bool rounds_are_over() const;
  bool takes_part(int probe) const;
  void begin_placement();
  void begin_anew();
  bool can_retrace() const;
  void note_rebuilt(const UpdatePlan& update);
  ProbeBatch retrace();
  void choose(ProbeBatch& batch);
  void count_samples(ProbeBatch& batch);
  ProbeBatch next_in_round();
  ProbeBatch next_of_device();

  std::vector<Known> known_;
  std::vector<int> recycled_;  // probes that are traced before all others
  int most_, most_sets_;
  bool follows_edits_;
  bool budget_;          // the settings limit the rays of an update
  bool counts_bounces_;  // each update carries light through all probes
  int placing_updates_;
  float longest_;  // the most updates that an average remembers
  int next_ = 0;
  std::uint32_t updates_ = 0;
  int round_ = 0;          // counted from 0
  int placing_since_ = 0;  // the first round that takes part in placement with all probes
  bool recycles_ = false;  // some probes have been recycled
  bool rebuilt_ = false;   // static geometry was rebuilt, and probes have not been placed again yet
  std::uint32_t rebuilt_in_ = 0;  // the last update in which static geometry was rebuilt
};

}  // namespace lambent::vulkan
