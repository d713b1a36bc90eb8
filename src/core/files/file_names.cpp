// SPDX-License-Identifier: Apache-2.0
#include "core/files/file_names.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>
#include <tuple>

namespace lambent {
namespace {

namespace fs = std::filesystem;

/// Maximum length of a chain of symbolic links, as in Linux; a longer one counts as a loop.
constexpr int kMaxLinks = 40;

/// The descriptor that an entry of /proc/self/fd (or /dev/fd) represents, or -1.
int descriptor_of(const fs::path& path) {
  const std::string name = path.filename().string();
  int descriptor = -1;
  const char* last = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), last, descriptor);
  if (error != std::errc() || stop != last || descriptor < 0) return -1;
  const fs::path parent = path.parent_path();
  const bool ours = parent == "/dev/fd" || parent == "/proc/self/fd" ||
                    parent == "/proc/" + std::to_string(::getpid()) + "/fd";
  return ours ? descriptor : -1;
}

/// Identifies a file. For one that does not exist: the directory that will contain it, and its path
/// from there.
struct Identity {
  dev_t device = 0;
  ino_t inode = 0;
  std::string name;

  auto key() const { return std::tie(device, inode, name); }
  bool operator<(const Identity& other) const { return key() < other.key(); }
  bool operator==(const Identity& other) const { return key() == other.key(); }
};

/// The identity of a file; none for devices, pipes and paths without a target.
std::optional<Identity> identity_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino, ""};
  }
  fs::path directory = end_of_path(path).path, name;
  while (directory.has_relative_path()) {
    name = name.empty() ? directory.filename() : directory.filename() / name;
    directory = directory.parent_path();
    if (::stat(directory.c_str(), &status) == 0) {
      return Identity{status.st_dev, status.st_ino, name.string()};
    }
  }
  return std::nullopt;
}

/// Whether a file system could treat the names as the same: it may ignore case, and normalise
/// letters outside ASCII.
bool could_be_folded(const std::string& a, const std::string& b) {
  const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  const bool plain =
      std::all_of(a.begin(), a.end(), is_ascii) && std::all_of(b.begin(), b.end(), is_ascii);
  const auto lower = [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  };
  return !plain || std::equal(a.begin(), a.end(), b.begin(), b.end(),
                              [&](char x, char y) { return lower(x) == lower(y); });
}

/// Tests the file system itself: creates one file for a moment, and looks for the other.
bool folded_together(const std::string& a, const std::string& b) {
  const int made = ::open(a.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (made < 0) return false;
  ::close(made);
  struct stat status_a {
  }, status_b{};
  const bool same = ::stat(a.c_str(), &status_a) == 0 && ::stat(b.c_str(), &status_b) == 0 &&
                    status_a.st_dev == status_b.st_dev && status_a.st_ino == status_b.st_ino;
  ::unlink(a.c_str());
  return same;
}

/// Whether two files that do not exist yet would be the same.
bool will_be_one(const Identity& a, const Identity& b, const std::string& path_a,
                 const std::string& path_b) {
  if (a.name.empty() || b.name.empty() || a.device != b.device || a.inode != b.inode) return false;
  return could_be_folded(a.name, b.name) &&
         folded_together(end_of_path(path_a).path, end_of_path(path_b).path);
}

tl::unexpected<Error> clash(const NamedFile& file, const NamedFile& other) {
  const std::string spelled = other.path == file.path ? "" : " (" + other.path + ")";
  if (file.written && other.written) {
    return fail(file.path, "",
                "both " + other.role + spelled + " and " + file.role + " would write this file");
  }
  const NamedFile& read = file.written ? other : file;
  const NamedFile& written = file.written ? file : other;
  return fail(written.path, "",
              written.role + " would write over " + read.role +
                  (read.path == written.path ? "" : " (" + read.path + ")"));
}

}  // namespace

PathEnd end_of_path(const std::string& path) {
  fs::path end = path;
  std::error_code error;
  for (int links = 0; links < kMaxLinks; ++links) {
    // Resolve directories first, since ".." in a link is relative to the link's real directory
    fs::path parent = end.has_parent_path() ? end.parent_path() : fs::path(".");
    const fs::path real = fs::weakly_canonical(fs::absolute(parent), error);
    if (!error) parent = real;
    const fs::path name = end.filename();
    if (name == "." || name == "..") {
      end = fs::weakly_canonical(parent / name, error);
      break;
    }
    end = parent / name;
    if (const int descriptor = descriptor_of(end); descriptor >= 0) {
      return {end.string(), descriptor};
    }
    const fs::path next = fs::read_symlink(end, error);
    if (error) break;
    end = next.is_absolute() ? next : parent / next;
  }
  return {end.string(), -1};
}

bool same_file(const std::string& a, const std::string& b) {
  const std::optional<Identity> identity_a = identity_of(a), identity_b = identity_of(b);
  if (!identity_a || !identity_b) return false;
  return *identity_a == *identity_b || will_be_one(*identity_a, *identity_b, a, b);
}

Expected<void> check_distinct_files(std::span<const NamedFile> files) {
  std::map<Identity, const NamedFile*> known;
  // Files that are read come first, so that reading a file twice hides no conflict
  std::vector<const NamedFile*> sorted;
  for (const NamedFile& file : files) sorted.push_back(&file);
  std::stable_partition(sorted.begin(), sorted.end(), [](const auto* f) { return !f->written; });
  for (const NamedFile* file : sorted) {
    const std::optional<Identity> identity =
        file->path.empty() ? std::nullopt : identity_of(file->path);
    if (!identity) continue;
    const auto [entry, is_new] = known.emplace(*identity, file);
    if (!is_new && file->written) return clash(*file, *entry->second);
    // The file system may treat different names as the same
    if (!is_new || identity->name.empty()) continue;
    for (const auto& [other, other_file] : known) {
      if (other_file == file) continue;
      if (will_be_one(*identity, other, file->path, other_file->path)) {
        return clash(*file, *other_file);
      }
    }
  }
  return {};
}

}  // namespace lambent
