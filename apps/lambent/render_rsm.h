// SPDX-License-Identifier: Apache-2.0
// The options of `lambent render` that concern reflective shadow maps.
#pragma once

#include <string>
#include <vector>

#include "lambent/field.h"
#include "lambent/rsm.h"
#include "lambent/world.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lambent::cli {

struct RsmOptions {
  RsmSettings settings;
  std::string pattern = "whole";
  std::string layout = "restructured";
  bool no_final_blur = false, no_shuffle = false, no_view_importance = false;
  std::vector<const CLI::Option*> options;  // options only for methods with maps
  const CLI::Option* radius = nullptr;      // only for RsmPattern::disk
};

void add_rsm_options(CLI::App& command, RsmOptions& options);

/// Whether a method gathers reflective shadow maps ("rsm", "rsm+field").
bool uses_rsm(const std::string& method);

/// The settings that the options ask for. Fails where they contradict each other, and where options
/// were given that the method does not read.
Expected<RsmSettings> rsm_settings(const RsmOptions& options, const std::string& method,
                                   std::uint32_t seed);

/// Fails where rsm_settings does, and where the method contradicts options that are not its own:
/// bounces of indirect light (-1: all), rays of a gather, whether to update until the field
/// settles.
Expected<void> check_rsm_use(const RsmOptions& options, const std::string& method, int bounces,
                             int gather_rays, bool converge);

/// A hint for a gather of so many lights that there are faster settings; empty: none.
std::string slow_gather(const RsmSettings& settings, std::size_t lights);

/// The world of a field with only the first bounce of directional, point and spot lights, which is
/// subtracted from the field of the whole scene: a copy of the scene without other light. If both
/// fields are updated equally often, with the same rays, their noise cancels.
class FirstBounce {
 public:
  explicit FirstBounce(const Scene& scene);
  const World& world() const { return world_; }
  /// The whole scene's field settings, limited to one bounce.
  static FieldSettings settings(FieldSettings settings);

 private:
  Scene scene_;
  World world_;
};

}  // namespace lambent::cli
