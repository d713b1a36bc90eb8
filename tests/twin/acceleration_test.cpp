// SPDX-License-Identifier: Apache-2.0
// Acceleration structures by themselves; what rays meet in them is compared with Embree elsewhere.
#include "vulkan/acceleration.h"

#include <set>

#include "support/hand_made.h"
#include "support/vulkan_device.h"

namespace lambent::acceleration_test {
namespace {

using vulkan::AccelerationStructure;
using vulkan::TriangleBuilder;
using vulkan::TriangleGeometry;

class AccelerationStructures : public test::OnDevice {
 protected:
  /// Balls of more and more triangles.
  std::vector<TriangleGeometry> balls(bool deforms) {
    std::vector<TriangleGeometry> geometries;
    for (const int rings : {4, 6, 8, 12, 16}) {
      const Mesh ball = test::sphere(1.0f, rings, 0);
      positions_.push_back(
          vulkan::upload(device(), ball.positions, "positions", vulkan::kGeometryUsage));
      triangles_.push_back(
          vulkan::upload(device(), ball.triangles, "triangles", vulkan::kGeometryUsage));
      geometries.push_back({positions_.back().address(), triangles_.back().address(),
                            static_cast<std::uint32_t>(ball.positions.size()),
                            static_cast<std::uint32_t>(ball.triangles.size()), true, deforms});
    }
    return geometries;
  }

 private:
  std::vector<vulkan::Buffer> positions_, triangles_;
};

TEST_F(AccelerationStructures, AreTheSameBuiltTogetherAndApart) {
  const std::vector<TriangleGeometry> geometries = balls(false);
  TriangleBuilder together(device()), apart(device(), 1);
  const std::vector<AccelerationStructure> a = together.build(geometries);
  const std::vector<AccelerationStructure> b = apart.build(geometries);
  ASSERT_EQ(a.size(), geometries.size());
  ASSERT_EQ(b.size(), geometries.size());
  std::set<VkDeviceAddress> addresses;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].bytes(), b[i].bytes());
    addresses.insert({a[i].address(), b[i].address()});
  }
  EXPECT_EQ(addresses.size(), 2 * geometries.size());
}

TEST_F(AccelerationStructures, TakeLessMemoryOnceCompacted) {
  TriangleBuilder builder(device());
  const std::vector<AccelerationStructure> compacted = builder.build(balls(false));
  const std::vector<AccelerationStructure> deforming = builder.build(balls(true));
  for (std::size_t i = 0; i < compacted.size(); ++i) {
    EXPECT_LE(compacted[i].bytes(), deforming[i].bytes());
    EXPECT_GT(compacted[i].bytes(), 0u);
  }
}

TEST_F(AccelerationStructures, OfNothingAreNone) {
  TriangleBuilder builder(device());
  EXPECT_TRUE(builder.build({}).empty());
  EXPECT_EQ(AccelerationStructure().address(), 0u);
}

}  // namespace
}  // namespace lambent::acceleration_test
