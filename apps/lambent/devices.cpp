// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "lambent/commands.h"
#include "lambent/help.h"
#include "lambent/vulkan.h"

namespace lambent::cli {
namespace {

std::string api_version(const vulkan::DeviceDescription& device) {
  return std::to_string(device.api_major) + "." + std::to_string(device.api_minor);
}

void print_table(const std::vector<vulkan::DeviceDescription>& devices) {
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const vulkan::DeviceDescription& device = devices[i];
    std::string missing;
    for (const std::string& name : device.missing) missing += (missing.empty() ? "" : ", ") + name;
    std::printf("%zu  %s\n   Vulkan %s%s%s%s\n   %s\n", i, device.name.c_str(),
                api_version(device).c_str(), device.driver.empty() ? "" : ", ",
                device.driver.c_str(), device.software ? ", runs on the processor" : "",
                missing.empty() ? "can be used" : ("cannot be used, lacks " + missing).c_str());
  }
  if (devices.empty()) std::printf("no Vulkan devices\n");
}

void print_json(const std::vector<vulkan::DeviceDescription>& devices) {
  nlohmann::ordered_json json;
  json["devices"] = devices.size();
  for (const char* list : {"names", "drivers", "api_versions", "software", "usable", "missing"}) {
    json[list] = nlohmann::ordered_json::array();
  }
  for (const vulkan::DeviceDescription& device : devices) {
    json["names"].push_back(device.name);
    json["drivers"].push_back(device.driver);
    json["api_versions"].push_back(api_version(device));
    json["software"].push_back(device.software);
    json["usable"].push_back(device.missing.empty());
    json["missing"].push_back(device.missing);
  }
  std::printf("%s\n", json.dump(2).c_str());
}

Expected<void> list_devices(bool as_json) {
  const auto devices = vulkan::devices();
  if (!devices) return tl::unexpected(devices.error());
  if (as_json) {
    print_json(*devices);
  } else {
    print_table(*devices);
  }
  return {};
}

}  // namespace

void add_devices(CLI::App& app, Run& run) {
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("devices", "List Vulkan devices, and what those lack that cannot be used");
  command->group(kMachineGroup);
  command->add_flag("--json", *as_json, "As one flat object");
  command->callback([as_json, &run] { run = [as_json] { return list_devices(*as_json); }; });
}

}  // namespace lambent::cli
