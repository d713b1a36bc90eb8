// SPDX-License-Identifier: Apache-2.0
#include "lambent/backend.h"

#include <CLI/CLI.hpp>

#include "lambent/console.h"
#include "lambent/validators.h"

namespace lambent::cli {
namespace {

constexpr int kMaxDevice = 1023;

}  // namespace

void add_backend_options(CLI::App& command, BackendOptions& o) {
  command.add_option("--backend", o.name, "cpu, or vulkan: a device with ray tracing pipelines")
      ->check(one_of({"cpu", "vulkan"}))
      ->capture_default_str()
      ->type_name("B");
  o.of_vulkan.push_back(
      command
          .add_option("--device", o.device,
                      "Which Vulkan device, by its index in lambent devices (the first that can be "
                      "used)")
          ->check(whole_number(0, kMaxDevice))
          ->type_name("N"));
  o.of_vulkan.push_back(command.add_flag("--vulkan-validation", o.validation,
                                         "Have Vulkan's validation layer watch"));
}

Expected<void> check_backend(const BackendOptions& options) {
  for (const CLI::Option* option : options.of_vulkan) {
    if (options.name == "vulkan" || option->count() == 0) continue;
    return fail(option->get_name(), "", "goes with --backend vulkan");
  }
  return {};
}

Expected<std::shared_ptr<vulkan::Device>> open_backend(const BackendOptions& options) {
  if (options.name != "vulkan") return nullptr;
  auto device = vulkan::open_device({options.device, options.validation});
  if (!device) device.error().file = "--backend vulkan";
  return device;
}

Expected<void> check_validation(const vulkan::Device* device) {
  if (device == nullptr) return {};
  const std::vector<std::string> messages = vulkan::validation_messages(*device);
  for (const std::string& message : messages) {
    tell_error("validation: " + message);
  }
  if (messages.empty()) return {};
  return fail("--vulkan-validation", "",
              "the validation layer found " + std::to_string(messages.size()) + " faults",
              Error::Kind::failed);
}

}  // namespace lambent::cli
