// SPDX-License-Identifier: Apache-2.0
// The public interface where the library is built without Vulkan: every call fails with this cause.
#include "lambent/vulkan.h"

namespace lambent::vulkan {
namespace {

tl::unexpected<Error> absent() {
  return fail("", "Vulkan", "this build of Lambent is without Vulkan", Error::Kind::failed);
}

}  // namespace

class Device {};

Expected<std::vector<DeviceDescription>> devices() {
  return absent();
}

Expected<std::shared_ptr<Device>> open_device(const DeviceRequest&) {
  return absent();
}

const DeviceDescription& description(const Device&) {
  static const DeviceDescription none;
  return none;
}

std::vector<std::string> validation_messages(const Device&) {
  return {};
}

}  // namespace lambent::vulkan
