// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/stopwatch.h"
#include "lambent/pass_time.h"

namespace lambent {

/// Adds to a pass's time. Passes are in the order in which they ran first.
inline void add_pass_time(std::vector<PassTime>& passes, std::string_view name, double ms) {
  const auto known = std::find_if(passes.begin(), passes.end(),
                                  [&](const PassTime& pass) { return pass.name == name; });
  if (known == passes.end()) {
    passes.push_back({std::string(name), ms});
  } else {
    known->ms += ms;
  }
}

/// Measures passes that run one after the other.
class PassTimer {
 public:
  /// The list of passes must outlive it.
  explicit PassTimer(std::vector<PassTime>& passes) : passes_(passes) {}

  /// Adds the time since the last call, or since construction, to a pass, less `counted` [ms],
  /// which was already added to others.
  void finish(std::string_view name, double counted = 0.0) {
    add_pass_time(passes_, name, std::max(watch_.lap() - counted, 0.0));
  }
  /// Discards the time since the last call.
  void skip() { watch_.lap(); }

 private:
  std::vector<PassTime>& passes_;
  Stopwatch watch_;
};

}  // namespace lambent
