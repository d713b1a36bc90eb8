// SPDX-License-Identifier: Apache-2.0
// The option --fog.
#pragma once

#include <string>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace CLI {
class App;
}

namespace lambent::cli {

void add_fog_option(CLI::App& command, std::string& fog);

/// "density[,albedo,g,height]": a box of fog as large as the scene, at least a tenth as wide and
/// high as it is long.
Expected<FogVolume> parse_fog(const std::string& text, const Bounds& scene);

}  // namespace lambent::cli
