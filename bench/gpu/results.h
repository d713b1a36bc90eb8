// SPDX-License-Identifier: Apache-2.0
// Results of a backend for a scene, small enough to be copied, so that a machine without the CPU
// backend can check its device.
#pragma once

#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/world.h"

namespace lambent::bench {

struct Result {
  std::string name;
  std::vector<float> values;
};

/// Lookups of the field at points that the camera sees, and pictures by each method, with the
/// scene's first camera.
std::vector<Result> find_results(const World& world);

Expected<void> save_results(const std::vector<Result>& results, const std::string& path);
/// Fails on files that are cut short or broken.
Expected<std::vector<Result>> load_results(const std::string& path);

/// Root mean square of the difference over that of the expected values; infinite if the sizes
/// differ or numbers are not finite.
double relative_rmse(const std::vector<float>& found, const std::vector<float>& expected);

/// Tolerance of relative_rmse: backends round differently, and a ray that grazes an edge may fall
/// to either side.
inline constexpr double kTolerance = 0.01;

}  // namespace lambent::bench
