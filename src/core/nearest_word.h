// SPDX-License-Identifier: Apache-2.0
// Suggestions for mistyped words.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lambent {

/// The fewest insertions, deletions, replacements and swaps of neighbouring characters that turn
/// one word into the other (optimal string alignment, a restricted Damerau-Levenshtein distance).
/// Ignores case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word that is nearest to `word`, within one edit per three characters, at least one,
/// but never so many that no character is left. Otherwise the shortest known word that begins with
/// `word`, if that has three characters or more. The first of several that are equally near. None
/// where no known word is similar.
std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> known);

/// "; did you mean 'field'?", or an empty text where no known word is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace lambent
