// SPDX-License-Identifier: Apache-2.0
#include "lambent/error.h"

#include <gtest/gtest.h>

TEST(Error, MessageLeavesOutWhatIsEmpty) {
  EXPECT_EQ((lambent::Error{"a.gltf", "", "no buffers", {}}.message()), "a.gltf: no buffers");
  EXPECT_EQ((lambent::Error{"", "", "no buffers", {}}.message()), "no buffers");
}
