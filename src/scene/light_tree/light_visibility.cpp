// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree/light_visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambent {
namespace {

// Number of cells along the longest axis. With 12 to 48, noise in two rooms with a lamp each is the
// same within a tenth.
constexpr float kCellsAlong = 32.0f;
// Each entry begins as if this many rays had been tested and half of them had arrived: no light is
// ever ruled out. With twice as many, noise there is 5 % higher.
constexpr float kPriorTests = 0.25f;
// An entry's counts are halved when they reach this.
constexpr std::uint16_t kMaxTests = 1 << 14;

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

LightVisibility::LightVisibility(const Bounds& box, std::uint32_t groups) {
  const glm::vec3 size = box.max - box.min;
  const float longest = std::max({size.x, size.y, size.z, std::numeric_limits<float>::min()});
  grid_.min_ws = box.min;
  grid_.cells_per_metre = kCellsAlong / longest;
  grid_.size = uvec3(size * grid_.cells_per_metre) + 1u;
  grid_.row_length = std::min(groups, kGroupsWithVisibility) * kLightGroupSize;
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
    if (count.tested == kMaxTests) {
      count.tested /= 2;
      count.visible /= 2;
    }
    ++count.tested;
    if (test.visible) ++count.visible;
  }
}

void LightVisibility::fade() {
  for (Count& count : counts_) {
    // A light that was seen once stays one that may be seen
    count.tested = static_cast<std::uint16_t>((count.tested + 1) / 2);
    count.visible = static_cast<std::uint16_t>((count.visible + 1) / 2);
  }
}

void LightVisibility::weigh() {
  weights_.resize(counts_.size());
  std::transform(counts_.begin(), counts_.end(), weights_.begin(), [](const Count& count) {
    if (count.tested == 0) return static_cast<std::uint8_t>(kWholeVisibility);
    const float share = (static_cast<float>(count.visible) + 0.5f * kPriorTests) /
                        (static_cast<float>(count.tested) + kPriorTests);
    const float weight = std::sqrt(share) * kWholeVisibility;
    return static_cast<std::uint8_t>(std::max(std::round(weight), 1.0f));
  });
}

const std::uint8_t* LightVisibility::at(const glm::vec3& position_ws,
                                        const glm::vec3& normal_ws) const {
  if (weights_.empty()) return nullptr;
  const uint row = visibility_row(*this, position_ws, normal_ws);
  return row == kNoVisibilityRow ? nullptr : weights_.data() + std::size_t{row} * grid_.row_length;
}

}  // namespace lambent
