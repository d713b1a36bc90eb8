// SPDX-License-Identifier: Apache-2.0
// What a backend finds of a scene, small enough to be carried along: so that a machine without the
// CPU backend knows whether its device is right.
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

/// The field at what the camera sees, and pictures by each method, of the scene's first camera.
std::vector<Result> find_results(const World& world);

Expected<void> save_results(const std::vector<Result>& results, const std::string& path);
/// Fails on files that are cut short or broken.
Expected<std::vector<Result>> load_results(const std::string& path);

/// Root mean square of the difference over that of what is expected; infinite where the two are not
/// alike in size, or numbers are not finite.
double relative_rmse(const std::vector<float>& found, const std::vector<float>& expected);

/// Backends round differently, and a ray that grazes an edge may fall to either side: so far apart
/// results may be.
inline constexpr double kTolerance = 0.01;

}  // namespace lambent::bench
