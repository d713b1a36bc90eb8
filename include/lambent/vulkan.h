// SPDX-License-Identifier: Apache-2.0
// Vulkan devices on which fields and frames can be computed. Needs no Vulkan headers;
// vulkan_device.h has devices that an engine lends.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lambent/error.h"

namespace lambent::vulkan {

/// A Vulkan device on which passes run. Shared pointers keep it alive; each World holds one.
class Device;

/// The description of a device, available before it is opened.
struct DeviceDescription {
  std::string name;             ///< As the driver reports it.
  std::string driver;           ///< Name and version of the driver.
  std::uint32_t api_major = 0;  ///< Of Vulkan.
  std::uint32_t api_minor = 0;
  bool software = false;  ///< Runs on the processor.
  /// Extensions and features that Lambent needs and the device lacks; empty: it can be opened.
  std::vector<std::string> missing;
};

/// All Vulkan devices, in the order of their indices. Fails where there is no Vulkan loader, no
/// driver, or where the library was built without Vulkan.
Expected<std::vector<DeviceDescription>> devices();

struct DeviceRequest {
  /// Index among devices(); -1: the first that can be opened, hardware before software.
  int index = -1;
  /// Turns on the validation layer, which must be installed; validation_messages returns its
  /// findings. Slow.
  bool validation = false;
};

/// Opens a device. Fails where none can be opened, naming for each device what it lacks.
Expected<std::shared_ptr<Device>> open_device(const DeviceRequest& request = {});

/// The description of an open device.
const DeviceDescription& description(const Device& device);

/// Warnings and errors of the validation layer so far; empty where it is not on.
std::vector<std::string> validation_messages(const Device& device);

}  // namespace lambent::vulkan
