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
  weights_.resize(counts_.size());
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    const std::size_t entry = i % grid_.row_length, group = entry / kLightGroupSize;
    const Count& count = counts_[i];
    if (count.tested == 0.0f) {
      // Nodes above come before
      weights_[i] = group > 0 ? weights_[i - entry + nodes_above_[group]]
                              : static_cast<std::uint8_t>(kWholeVisibility);
      continue;
    }
    const float share = (count.visible + 0.5f * kPriorTests) / (count.tested + kPriorTests);
    weights_[i] =
        static_cast<std::uint8_t>(std::max(std::round(std::sqrt(share) * kWholeVisibility), 1.0f));
  }
}

const std::uint8_t* LightVisibility::at(const glm::vec3& position_ws,
                                        const glm::vec3& normal_ws) const {
  if (weights_.empty()) return nullptr;
  const uint row = visibility_row(*this, position_ws, normal_ws);
  return row == kNoVisibilityRow ? nullptr : weights_.data() + std::size_t{row} * grid_.row_length;
}

}  // namespace lambent
