// SPDX-License-Identifier: Apache-2.0
// The share of shadow rays to the top clusters of a light tree that arrive, over the surfaces of a
// scene: lights that stand behind a wall are picked less often.
// After: Vévoda, Kondapaneni and Křivánek, "Bayesian online regression for adaptive direct
// illumination sampling", ACM TOG 37(4), 2018, of which this keeps the idea: clusters of lights
// times regions of surfaces, with a prior that never rules a light out.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lambent/scene.h"
#include "scene/light_tree/light_groups.h"
#include "scene/light_tree/light_visibility_math.h"

namespace lambent {

/// A test of a cluster's visibility from a surface.
struct VisibilityTest {
  std::uint32_t index;  ///< Of a side of a cell: visibility_index().
  std::uint16_t entry;  ///< Of the row: group * kLightGroupSize + child.
  bool visible;
};

/// Rows of weights over a grid. A weight is the square root of the share of rays that arrived:
/// where a share v of a cell's points sees a light, the variance of picked light is least with
/// picks in proportion to the root of v.
class LightVisibility {
 public:
  LightVisibility() = default;  ///< Without a grid: there are no rows.
  /// A grid of cubic cells over a box whose longest side is above 0, for the first groups of a
  /// tree, which must stay as they are.
  LightVisibility(const Bounds& box, const LightGroups& groups);

  const LightVisibilityGrid& grid() const { return grid_; }
  /// The row of each side of each cell; kNoVisibilityRow where none was tested.
  const std::vector<std::uint32_t>& rows() const { return rows_; }
  /// Weights over kWholeVisibility, grid().row_length for each row.
  const std::vector<std::uint8_t>& weights() const { return weights_; }
  bool empty() const { return weights_.empty(); }

  /// Adds tests. They count once there was a call of weigh().
  void add(std::span<const VisibilityTest> tests);
  /// Lets all earlier tests count half as much as those that follow.
  void fade();
  /// Computes the weights from the tests so far. A node that was not tested has that of the node
  /// of the root's group that it is below.
  void weigh();
  /// Numbers the renewals of a table's tests: 0 at the first call, then 1, and so on.
  std::uint32_t next_renewal() { return renewals_++; }

  /// The weights of the surfaces around a point that face as its normal does; null: none are known.
  const std::uint8_t* at(const glm::vec3& position_ws, const glm::vec3& normal_ws) const;

 private:
  /// Numbers of tests, which fade.
  struct Count {
    float tested = 0.0f, visible = 0.0f;
  };

  LightVisibilityGrid grid_{};
  std::array<std::uint32_t, kGroupsWithVisibility> nodes_above_{};  // of the groups
  std::uint32_t renewals_ = 0;
  std::vector<std::uint32_t> rows_;
  std::vector<Count> counts_;
  std::vector<std::uint8_t> weights_;
};

}  // namespace lambent
