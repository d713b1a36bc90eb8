// SPDX-License-Identifier: Apache-2.0
// Formatting of quantities for display.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambent::cli {

/// "17 bytes", "2.4 kB", "1.3 MB", "5.0 GB": powers of 1000.
std::string bytes_text(double bytes);

/// "45 s", "3 min 05 s", "2 h 10 min".
std::string whole_seconds_text(double seconds);

/// "0.42 s", "12.3 s", and from a minute on whole seconds.
std::string seconds_text(double seconds);

/// "1 camera", "2 cameras": the number, and the word with an s where it is not one.
std::string count_text(std::size_t count, const std::string& word);

/// "a", "a or b", "a, b or c".
std::string list_text(const std::vector<std::string>& words, const char* last = "or");

/// "1280x720 pixels".
std::string pixels_text(int width, int height);

/// "exposure +0.53 stops".
std::string exposure_text(float stops);

/// The text without control characters: names come from files, and nothing in them may reach the
/// terminal as an escape sequence.
std::string printable(const std::string& text);

/// Whether two texts differ in the case of ASCII letters at most.
bool same_but_for_case(std::string_view a, std::string_view b);

/// The index of the object that a user calls by its name or index: the first of that name, else the
/// one of that index, else the only one whose name differs in the case of ASCII letters alone.
std::optional<std::size_t> index_of(const std::string& wanted,
                                    const std::vector<std::string>& names);

/// The error for a name or index that does not exist in a scene: "no camera 'hal'; the scene has 2
/// cameras: 0 'door', 1 'hall'; did you mean 'hall'?". `kind` is the kind of object.
std::string no_such(const std::string& kind, const std::string& wanted,
                    const std::vector<std::string>& names);

}  // namespace lambent::cli
