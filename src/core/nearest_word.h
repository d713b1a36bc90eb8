// SPDX-License-Identifier: Apache-2.0
// What somebody may have meant who mistyped a word.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lambent {

/// The fewest insertions, deletions, replacements and swaps of neighbouring characters that turn
/// one word into the other (Damerau-Levenshtein distance, each stretch edited once). Capital and
/// small letters count as the same.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word that is nearest to `word`: within one edit for each three of its characters, at
/// least one, but never so many that no character is left. Where there is none, the shortest known
/// word that begins with `word`, if that has three characters or more. Of several that are as near
/// the first. Nothing where no known word is like it.
std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> known);

/// "; did you mean 'field'?", or an empty text where no known word is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace lambent
