// SPDX-License-Identifier: Apache-2.0
// Parsing of option values that are more than a word or a number.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace lambent::cli {

/// Whether a path ends in `ending` (".png"), ignoring case.
bool has_ending(const std::string& path, const char* ending);

/// "x,y,z", finite numbers. `option` names the culprit in the error.
Expected<glm::vec3> parse_vec3(const std::string& option, const std::string& text);

/// "a,b,...": `least` to `most` finite numbers. `wanted` describes the expected value in the error.
Expected<std::vector<float>> parse_numbers(const std::string& option, const std::string& text,
                                           std::size_t least, std::size_t most, const char* wanted);

/// Like parse_vec3, for a place [m] with coordinates within kMaxCoordinate (scene/limits.h).
Expected<glm::vec3> parse_place(const std::string& option, const std::string& text);

/// "x0,y0,z0,x1,y1,z1": two corners of a box with min < max, within kMaxCoordinate.
Expected<Bounds> parse_box(const std::string& option, const std::string& text);

/// "WxH", each 1 to 16384, or a name of a usual size: "480p", "720p", "1080p", "1440p", "2160p" or
/// "4k", "4320p" or "8k".
Expected<glm::ivec2> parse_size(const std::string& option, const std::string& text);

/// "XxYxZ", each 2 to 4096.
Expected<glm::ivec3> parse_counts(const std::string& option, const std::string& text);

/// A box as for parse_box, followed in any order by ":spacing=M", ":probes=XxYxZ", ":turn=DEGREES"
/// (about +Y, through its middle), ":priority=N".
Expected<ProbeVolume> parse_volume(const std::string& option, const std::string& text);

/// Stops, or nothing for "auto".
Expected<std::optional<float>> parse_exposure(const std::string& text);

}  // namespace lambent::cli
