// SPDX-License-Identifier: Apache-2.0
#include "lambent/command_files.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "lambent/render_output.h"
#include "lambent/words.h"
#include "scene/gltf/files.h"
#include "scenes/builtin.h"

namespace lambent::cli {
namespace {

namespace fs = std::filesystem;

/// The position of the number in a sequence's paths: the directory, and the text before and after
/// it.
struct NumberedName {
  fs::path directory;
  std::string before, after;

  explicit NumberedName(const std::string& pattern) {
    // The paths of frames 0 and 1 differ only in the last digit of the number
    const std::string zero = frame_path(pattern, 0), one = frame_path(pattern, 1);
    const auto last_digit = std::mismatch(zero.begin(), zero.end(), one.begin()).first;
    const auto end = static_cast<std::size_t>(last_digit - zero.begin()) + 1;
    const std::size_t begin = end - kFrameDigits;
    const std::size_t slash = zero.rfind('/', begin);
    const std::size_t name = slash == std::string::npos ? 0 : slash + 1;
    directory = name == 0 ? fs::path(".") : fs::path(zero.substr(0, name));
    before = zero.substr(name, begin - name);
    after = zero.substr(end, zero.find('/', end) - end);
  }

  /// The number of the frame with this name, or none.
  std::optional<int> frame_of(const std::string& name) const {
    if (name.size() < before.size() + kFrameDigits + after.size()) return std::nullopt;
    const std::string_view text = name;
    const std::string_view digits =
        text.substr(before.size(), text.size() - before.size() - after.size());
    if (!same_but_for_case(text.substr(0, before.size()), before) ||
        !same_but_for_case(text.substr(text.size() - after.size()), after)) {
      return std::nullopt;
    }
    int frame = 0;
    const char* last = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), last, frame);
    const bool padded = digits.size() == kFrameDigits || digits.front() != '0';
    if (error != std::errc() || stop != last || frame < 0 || !padded) return std::nullopt;
    return frame;
  }
};

}  // namespace

void CommandFiles::reads(const std::string& path, const std::string& role) {
  files_.push_back({path, role, false});
}

void CommandFiles::reads_scene(const std::string& scene) {
  if (scenes::is_name(scene)) return;
  reads(scene, "the scene");
  for (const std::string& file : files_of_gltf(scene)) reads(file, "a file of the scene");
}

void CommandFiles::writes(const std::string& path, const std::string& role) {
  files_.push_back({path, role, true});
}

void CommandFiles::writes_frames(const std::string& pattern, int count, const std::string& role) {
  frames_.push_back({pattern, count, role});
}

Expected<void> CommandFiles::check() const {
  std::vector<NamedFile> all = files_;
  for (const Frames& frames : frames_) {
    // There may be millions of frames: test only those that exist, and those to which another path
    // leads
    const NumberedName name(frames.pattern);
    std::set<int> numbers;
    const auto look_at = [&](const fs::path& part) {
      const std::optional<int> frame = name.frame_of(part.string());
      if (frame && *frame < frames.count) numbers.insert(*frame);
    };
    std::error_code error;
    for (fs::directory_iterator entry(name.directory, error), end; !error && entry != end;
         entry.increment(error)) {
      look_at(entry->path().filename());
    }
    for (const NamedFile& file : files_) {
      if (file.path.empty()) continue;
      for (const fs::path& part : fs::path(end_of_path(file.path).path)) look_at(part);
    }
    for (const int frame : numbers) {
      all.push_back({frame_path(frames.pattern, frame), frames.role, true});
    }
  }
  return check_distinct_files(all);
}

}  // namespace lambent::cli
