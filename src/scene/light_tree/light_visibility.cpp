// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree/light_visibility.h"

#include <algorithm>
#include <cmath>

namespace lambent {
namespace {

// Number of cells along the longest axis. With 12 to 48, noise in two rooms with a lamp each is the
// same within a tenth.
constexpr float kCellsAlong = 32.0f;
// Each entry begins as if this many rays had been tested and half of them had arrived: no light is
// ever ruled out. With twice as many, noise there is 5 % higher.
constexpr float kPriorTests = 0.25f;

// What light_visibility.inl.h requires of its includer.
using VisibilityRef = const LightVisibility&;
const LightVisibilityGrid& fetch_visibility_grid(const LightVisibility& visibility) {
  return visibility.grid();
}
uint fetch_visibility_row(const LightVisibility& visibility, uint index) {
  return visibility.rows()[index];
}
#include "scene/light_tree/light_visibility.inl.h"

}  // namespace

LightVisibility::LightVisibility(const Bounds& box, const LightGroups& groups) {
  const glm::vec3 size = box.max - box.min;
  const float longest = std::max({size.x, size.y, size.z});
  grid_.min_ws = box.min;
  grid_.cells_per_metre = kCellsAlong / longest;
  grid_.size = uvec3(size * grid_.cells_per_metre) + 1u;
  const auto count = static_cast<std::uint32_t>(groups.nodes().size() / kLightGroupSize);
  grid_.row_length = std::min(count, kGroupsWithVisibility) * kLightGroupSize;
  for (std::uint32_t child = 0; child < kLightGroupSize; ++child) {
    const std::uint32_t link = groups.nodes()[child].link;
    if (link > 0 && link < kGroupsWithVisibility) nodes_above_[link] = child;
  }
  rows_.assign(std::size_t{grid_.size.x} * grid_.size.y * grid_.size.z * kFacingSides,
               kNoVisibilityRow);
}

void LightVisibility::add(std::span<const VisibilityTest> tests) {
  for (const VisibilityTest& test : tests) {
    std::uint32_t& row = rows_[test.index];
    if (row == kNoVisibilityRow) {
      row = static_cast<std::uint32_t>(counts_.size() / grid_.row_length);
      counts_.resize(counts_.size() + grid_.row_length);
    }
    Count& count = counts_[std::size_t{row} * grid_.row_length + test.entry];
    count.tested += 1.0f;
    if (test.visible) count.visible += 1.0f;
  }
}

void LightVisibility::fade() {
  for (Count& count : counts_) {
    count.tested *= 0.5f;
    count.visible *= 0.5f;
  }
}

void LightVisibility::weigh() {
  weights_.assign(counts_.size(), static_cast<std::uint8_t>(kWholeVisibility));
  for (std::size_t first = 0; first < counts_.size(); first += grid_.row_length) {
    const std::span<const Count> counts = std::span(counts_).subspan(first, grid_.row_length);
    const std::span<std::uint8_t> weights = std::span(weights_).subspan(first, grid_.row_length);
    float largest = 0.0f;
    for (const Count& count : counts) largest = std::max(largest, share_of(count));
    for (std::size_t entry = 0; entry < counts.size(); ++entry) {
      if (counts[entry].tested > 0.0f) {
        weights[entry] = weight_of(share_of(counts[entry]) / largest);
      } else if (entry >= kLightGroupSize) {
        weights[entry] = weights[nodes_above_[entry / kLightGroupSize]];
      }
    }
  }
}

float LightVisibility::share_of(const Count& count) {
  if (count.tested == 0.0f) return 0.0f;
  return (count.visible + 0.5f * kPriorTests) / (count.tested + kPriorTests);
}

std::uint8_t LightVisibility::weight_of(float relative) {
  // From a half on, shares count as the largest; below a quarter, as they are
  const float share = std::min(relative + 2.0f * std::max(relative - 0.25f, 0.0f), 1.0f);
  return static_cast<std::uint8_t>(std::max(std::round(std::sqrt(share) * kWholeVisibility), 1.0f));
}

const std::uint8_t* LightVisibility::at(const glm::vec3& position_ws,
                                        const glm::vec3& normal_ws) const {
  if (weights_.empty()) return nullptr;
  const uint row = visibility_row(*this, position_ws, normal_ws);
  return row == kNoVisibilityRow ? nullptr : weights_.data() + std::size_t{row} * grid_.row_length;
}

}  // namespace lambent
