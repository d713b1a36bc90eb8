// SPDX-License-Identifier: Apache-2.0
#include "lambent/help.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <sstream>
#include <vector>

namespace lambent::cli {
namespace {

constexpr std::size_t kLineWidth = 96;    // [characters], fits most terminals
constexpr std::size_t kNameColumns = 28;  // width of the column of options' names, on the left

/// Appends `text` to `out`, wrapped, with lines indented by `indent`; the first line is at `column`
/// already.
void append_wrapped(std::ostringstream& out, const std::string& text, std::size_t column,
                    std::size_t indent) {
  std::istringstream words(text);
  std::string word;
  bool first = true;
  while (words >> word) {
    if (!first && column + 1 + word.size() > kLineWidth) {
      out << "\n" << std::string(indent, ' ');
      column = indent;
    } else if (!first) {
      out << ' ';
      ++column;
    }
    out << word;
    column += word.size();
    first = false;
  }
  out << "\n";
}

void append_row(std::ostringstream& out, const std::string& name, const std::string& text) {
  const std::string left = "  " + name;
  out << left;
  if (left.size() + 2 > kNameColumns) {
    out << "\n" << std::string(kNameColumns, ' ');
  } else {
    out << std::string(kNameColumns - left.size(), ' ');
  }
  append_wrapped(out, text, kNameColumns, kNameColumns);
}

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
    std::ostringstream out;
    out << usage(*app, name) << "\n\n";
    append_wrapped(out, app->get_description(), 0, 0);
    out << make_positionals(app);

    std::vector<std::string> groups = app->get_groups();
    const auto take = [&groups](const std::string& group) {
      const auto found = std::find(groups.begin(), groups.end(), group);
      if (found == groups.end()) return false;
      groups.erase(found);
      return true;
    };
    if (take(kMainGroup)) append_group(out, *app, kMainGroup);
    if (!app->get_footer().empty()) out << "\nExamples:\n" << app->get_footer();
    append_subcommands(out, *app);
    take(kProgramGroup);
    for (const std::string& group : groups) append_group(out, *app, group);
    append_group(out, *app, kProgramGroup);
    return out.str();
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::ostringstream out;
    std::string name = option->get_name(is_positional, !is_positional);
    if (const auto comma = name.find(','); comma != std::string::npos) name.insert(comma + 1, " ");
    // Flags that switch something off contain their value: --name{false}
    name = name.substr(0, name.find('{'));
    const bool valued = !is_positional && option->get_type_size() > 0;
    const std::string standard = option->get_default_str();
    append_row(out, valued ? name + " " + option->get_type_name() : name,
               option->get_description() + (standard.empty() ? "" : " (" + standard + ")"));
    return out.str();
  }

 private:
  static std::string usage(const CLI::App& app, const std::string& name) {
    std::string text = "Usage: " + name;
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_positional()) text += " " + option->get_name(true);
    }
    if (!app.get_subcommands({}).empty()) text += " SUBCOMMAND ...";
    for (const CLI::Option* option : app.get_options()) {
      if (option->nonpositional() && option->get_required()) {
        text += " -" + option->get_snames().front() + " " + option->get_type_name();
      }
    }
    return text + (app.get_subcommands({}).empty() ? " [options]" : "");
  }

  void append_group(std::ostringstream& out, const CLI::App& app, const std::string& group) const {
    const auto options = app.get_options([&](const CLI::Option* option) {
      return option->get_group() == group && option->nonpositional();
    });
    if (group.empty() || options.empty()) return;
    out << "\n" << group << ":\n";
    for (const CLI::Option* option : options) out << make_option(option, false);
  }

  static void append_subcommands(std::ostringstream& out, const CLI::App& app) {
    std::string group;
    for (const CLI::App* command : app.get_subcommands({})) {
      if (command->get_group() != group) out << "\n" << command->get_group() << ":\n";
      group = command->get_group();
      append_row(out, command->get_name(), command->get_description());
    }
  }
};

void set_formatter(CLI::App& app, const std::shared_ptr<HelpFormatter>& formatter) {
  app.formatter(formatter);
  for (CLI::App* command : app.get_subcommands({})) set_formatter(*command, formatter);
}

}  // namespace

std::string short_help() {
  return R"(Lambent renders 3D scenes with light that bounces, and measures how right it is.

  lambent scene.glb                       a picture beside the scene, with everything chosen for you
  lambent cornell                         a built-in scene; `lambent scenes` lists them all
  lambent scene.glb --size 1080p -o a.jpg what you want of the picture comes after the scene

`lambent render --help` tells what a picture can be asked, `lambent --help` what else there is.
)";
}

void set_help_style(CLI::App& app) {
  set_formatter(app, std::make_shared<HelpFormatter>());
}

void set_examples(CLI::App& command, const std::string& examples) {
  command.footer(examples);
}

}  // namespace lambent::cli
