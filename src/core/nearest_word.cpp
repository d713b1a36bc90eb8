// SPDX-License-Identifier: Apache-2.0
#include "core/nearest_word.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace lambent {
namespace {

// A mistyped word has at most about one wrong character in three; otherwise it is another word.
constexpr std::size_t kCharactersPerEdit = 3;
// Shorter beginnings fit too many words.
constexpr std::size_t kMinBeginning = 3;
// Longer texts [characters] are not mistyped words, and would take long to compare.
constexpr std::size_t kMaxWord = 256;

std::string in_small_letters(std::string_view word) {
  std::string small(word);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

}  // namespace

std::size_t edit_distance(std::string_view first, std::string_view second) {
  const std::string a = in_small_letters(first), b = in_small_letters(second);
  // Rows of the table of distances between the first i characters of a and the first j of b
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> known) {
  if (word.empty() || word.size() > kMaxWord) return std::nullopt;
  const std::size_t most = std::max<std::size_t>(word.size() / kCharactersPerEdit, 1);
  std::size_t least = std::min(most, word.size() - 1) + 1;
  const std::string* nearest = nullptr;
  for (const std::string& candidate : known) {
    if (candidate.size() > word.size() + most) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance >= least) continue;
    least = distance;
    nearest = &candidate;
  }
  if (nearest == nullptr && word.size() >= kMinBeginning) {
    const std::string beginning = in_small_letters(word);
    for (const std::string& candidate : known) {
      if (!in_small_letters(candidate).starts_with(beginning)) continue;
      if (nearest == nullptr || candidate.size() < nearest->size()) nearest = &candidate;
    }
  }
  if (nearest == nullptr) return std::nullopt;
  return *nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const std::optional<std::string> nearest = nearest_word(word, known);
  return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

}  // namespace lambent
