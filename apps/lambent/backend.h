// SPDX-License-Identifier: Apache-2.0
// The backend of a subcommand: the processor, or a Vulkan device.
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
  int device = -1;  // -1: the first that can be used
  bool validation = false;
  std::vector<const CLI::Option*> of_vulkan;  // options without meaning on the processor
};

void add_backend_options(CLI::App& command, BackendOptions& options);

/// Fails on options that do not go together.
Expected<void> check_backend(const BackendOptions& options);

/// Opens the device that the options select; null: the processor. Fails where there is none, with
/// what each device lacks.
Expected<std::shared_ptr<vulkan::Device>> open_backend(const BackendOptions& options);

/// Prints the messages of the validation layer on stderr, and fails if there are any.
Expected<void> check_validation(const vulkan::Device* device);

}  // namespace lambent::cli
