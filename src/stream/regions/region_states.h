// SPDX-License-Identifier: Apache-2.0
// A client's state of each region, and the stream that it follows.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "stream/light/light_state.h"
#include "stream/regions/region_coding.h"
#include "stream/regions/region_cut.h"

namespace lambent::stream {

class RegionStates {
 public:
  RegionStates(const FieldGeometry& geometry, const LightLayout& layout)
      : cut_(geometry, layout), states_(cut_.size()) {}

  std::size_t size() const { return cut_.size(); }
  /// Updates the layouts after probes came into or out of solid matter.
  void follow(const LightLayout& layout);
  /// Applies the steps of an update, whose deltas must follow the current states. Updates
  /// `coefficients`, of all probes, for the regions that changed, and sets `changed` to the probes
  /// whose light changed, ascending. If it fails, both are unchanged, and this object must not be
  /// used for further deltas.
  Expected<void> take(const RegionBody& body, std::uint64_t update,
                      std::vector<std::int32_t>& coefficients, std::vector<int>& changed);
  /// The unit of all regions, after `take` with keys of all.
  float unit() const { return states_.front().light.unit; }

 private:
  struct Followed {
    RegionRate rate = RegionRate::near;
    LightState light;  ///< Its `update` is that of its light.
  };
  Expected<void> take_step(const RegionStep& step, std::uint64_t update);

  RegionCut cut_;
  std::vector<Followed> states_;
  std::vector<std::int32_t> levels_;
};

}  // namespace lambent::stream
