// SPDX-License-Identifier: Apache-2.0
// lambent scenes: lists the built-in scenes.
#include "scenes/builtin.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lambent/commands.h"
#include "lambent/help.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

struct Row {
  std::string name, what;
  std::size_t triangles = 0, cameras = 0, animations = 0;
};

Expected<std::vector<Row>> rows() {
  std::vector<Row> all;
  for (const std::string& name : scenes::names()) {
    const Expected<Scene> scene = scenes::make(name);
    if (!scene) return tl::unexpected(scene.error());
    all.push_back({name, scenes::description(name), triangle_count(*scene), scene->cameras.size(),
                   scene->animations.size()});
  }
  return all;
}

void print_json(const std::vector<Row>& all) {
  nlohmann::ordered_json json;
  json["scenes"] = all.size();
  for (const Row& row : all) {
    json["names"].push_back(row.name);
    json["descriptions"].push_back(row.what);
    json["triangles"].push_back(row.triangles);
    json["cameras"].push_back(row.cameras);
    json["animations"].push_back(row.animations);
  }
  std::printf("%s\n", json.dump(2).c_str());
}

void print_table(const std::vector<Row>& all) {
  for (const Row& row : all) {
    std::printf("%-22s %s; %s, %s%s\n", row.name.c_str(), row.what.c_str(),
                count_text(row.triangles, "triangle").c_str(),
                count_text(row.cameras, "camera").c_str(), row.animations > 0 ? ", animated" : "");
  }
}

Expected<void> list_scenes(bool as_json) {
  const Expected<std::vector<Row>> all = rows();
  if (!all) return tl::unexpected(all.error());
  as_json ? print_json(*all) : print_table(*all);
  return {};
}

}  // namespace

void add_scenes(CLI::App& app, Run& run) {
  const auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("scenes", "List the built-in scenes");
  command->group(kSceneGroup);
  command->add_flag("--json", *as_json, "As one flat JSON object, with a list for each column");
  command->callback([as_json, &run] { run = [as_json] { return list_scenes(*as_json); }; });
}

}  // namespace lambent::cli
