// SPDX-License-Identifier: Apache-2.0
// On what a subcommand computes: the processor, or a Vulkan device.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/vulkan.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lambent::cli {

struct BackendOptions {
  std::string name = "cpu";
  int device = -1;  // the first that can be used
  bool validation = false;
  std::vector<const CLI::Option*> of_vulkan;  // what means nothing on the processor
};

void add_backend_options(CLI::App& command, BackendOptions& options);

/// Fails on options that do not go together.
Expected<void> check_backend(const BackendOptions& options);

/// The device that the options ask for; null: the processor. Fails where there is none, telling
/// what each lacks.
Expected<std::shared_ptr<vulkan::Device>> open_backend(const BackendOptions& options);

/// Tells on stderr what the validation layer had to say of the device, and fails where it did.
Expected<void> check_validation(const vulkan::Device* device);

}  // namespace lambent::cli
