// SPDX-License-Identifier: Apache-2.0
// What a client has of each region, and follows of it.
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
  /// Follows probes that came into or out of solid matter.
  void follow(const LightLayout& layout);
  /// Takes the steps of an update, of which all that are deltas must follow on what is here.
  /// `coefficients`, of all probes, become those of the regions that changed, and `changed` the
  /// probes whose light did, ascending. Where it fails, nothing of it may be followed any more, and
  /// both are as they were.
  Expected<void> take(const RegionBody& body, std::uint64_t update,
                      std::vector<std::int32_t>& coefficients, std::vector<int>& changed);
  /// Of all regions, after `take` took whole ones.
  float unit() const { return states_.front().light.unit; }

 private:
  struct Followed {
    RegionRate rate = RegionRate::near;
    LightState light;  ///< Its update is that of the light here.
  };
  Expected<void> take_step(const RegionStep& step, std::uint64_t update);

  RegionCut cut_;
  std::vector<Followed> states_;
  std::vector<std::int32_t> levels_;
};

}  // namespace lambent::stream
