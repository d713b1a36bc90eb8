// SPDX-License-Identifier: Apache-2.0
#include "lambent/error.h"

#include <gtest/gtest.h>

namespace lambent::error_test {
namespace {

TEST(Error, MessageLeavesOutWhatIsEmpty) {
  EXPECT_EQ((Error{"a.gltf", "", "no buffers", {}}.message()), "a.gltf: no buffers");
  EXPECT_EQ((Error{"", "", "no buffers", {}}.message()), "no buffers");
}

}  // namespace
}  // namespace lambent::error_test
