// SPDX-License-Identifier: Apache-2.0
// The Vulkan device of a test program, with its validation layer listening.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "lambent/vulkan.h"
#include "vulkan/device.h"

namespace lambent::test {

/// Opened once a process; null where no device can be.
inline const Expected<std::shared_ptr<vulkan::Device>>& opened_device() {
  static const Expected<std::shared_ptr<vulkan::Device>> device =
      vulkan::open_device({.index = -1, .validation = true});
  return device;
}

/// A test that runs on the device. It is skipped where there is none, and fails where the
/// validation layer has something to say.
class OnDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!opened_device()) {
      // Where a driver was installed for the tests, its absence is no excuse
      if (std::getenv("LAMBENT_REQUIRE_DEVICE") != nullptr) {
        FAIL() << opened_device().error().message();
      }
      GTEST_SKIP() << opened_device().error().message();
    }
    messages_before_ = validation_messages(*opened_device().value()).size();
  }

  void TearDown() override {
    if (!opened_device()) return;
    const std::vector<std::string> messages = validation_messages(*opened_device().value());
    for (std::size_t i = messages_before_; i < messages.size(); ++i) {
      ADD_FAILURE() << "validation: " << messages[i];
    }
  }

  static const vulkan::Device& device() { return *opened_device().value(); }
  static std::shared_ptr<vulkan::Device> shared_device() { return opened_device().value(); }

 private:
  std::size_t messages_before_ = 0;
};

}  // namespace lambent::test
