// SPDX-License-Identifier: Apache-2.0
#include "stream/server/access.h"

#include <openssl/crypto.h>
#include <openssl/sha.h>
#include <sys/stat.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

namespace lambent::stream {
namespace {

// Largest size of a file, far above any written by hand.
constexpr std::size_t kMaxTokenFileBytes = 1u << 20u;

std::optional<std::int64_t> parse_time(const std::string& text) {
  std::tm parts{};
  const char* end = strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  if (end == nullptr || *end != '\0') return std::nullopt;
  return static_cast<std::int64_t>(timegm(&parts));
}

/// The name in "name:8080" or "[::1]:8080".
std::string_view name_in(std::string_view host) {
  if (host.starts_with("[")) return host.substr(1, host.find(']') - 1);
  return host.substr(0, host.find(':'));
}

}  // namespace

TokenDigest digest_of(std::string_view token) {
  TokenDigest digest;
  SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(), digest.data());
  return digest;
}

Expected<Access> Access::open(const std::string& path) {
  Access access;
  access.path_ = path;
  if (const auto done = access.read(); !done) return tl::unexpected(done.error());
  return access;
}

Access::Stamp Access::stamp_of(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {};
  constexpr std::int64_t kNsOfSecond = 1'000'000'000;
  return {status.st_mtim.tv_sec * kNsOfSecond + status.st_mtim.tv_nsec,
          static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(status.st_ino)};
}

Expected<Access::Entry> Access::parse_line(std::string_view line) {
  std::istringstream words{std::string(line)};
  std::string role, token, expiry, more;
  words >> role >> token >> expiry >> more;
  Entry entry;
  if (role == "change") {
    entry.role = Role::change;
  } else if (role != "view") {
    return fail("", "", "must begin with view or change");
  }
  if (token.size() < kMinTokenBytes || token.size() > kMaxTokenBytes) {
    return fail("", "", "a token has 16 to 256 characters");
  }
  entry.digest = digest_of(token);
  if (!more.empty()) return fail("", "", "has more than a role, a token and a time");
  if (expiry.empty()) return entry;
  entry.expiry_s = parse_time(expiry);
  if (!entry.expiry_s) return fail("", "", "a time is written as 2026-12-31T23:59:59Z");
  return entry;
}

Expected<void> Access::read() {
  entries_.clear();
  stamp_ = stamp_of(path_);
  std::ifstream file(path_);
  if (!file) return fail(path_, "", "cannot be read");
  if (stamp_.size > kMaxTokenFileBytes) return fail(path_, "", "is too large for a list of tokens");
  std::vector<Entry> entries;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const Expected<Entry> entry = parse_line(line);
    if (!entry) return fail(path_, "line " + std::to_string(number), entry.error().cause);
    entries.push_back(*entry);
  }
  if (entries.empty()) return fail(path_, "", "has no token");
  entries_ = std::move(entries);
  return {};
}

Expected<void> Access::refresh() {
  if (path_.empty() || stamp_of(path_) == stamp_) return {};
  return read();
}

std::optional<Admission> Access::admit(std::string_view token, std::int64_t now_s) const {
  if (path_.empty()) return Admission{Role::change, {}};
  const Admission asked{Role::view, digest_of(token)};
  std::optional<Admission> admitted;
  for (const Entry& entry : entries_) {
    const bool same =
        CRYPTO_memcmp(entry.digest.data(), asked.digest.data(), asked.digest.size()) == 0;
    const bool in_time = !entry.expiry_s || now_s < *entry.expiry_s;
    if (same && in_time) admitted = Admission{entry.role, asked.digest};
  }
  return admitted;
}

bool Access::still_good(const Admission& admission, std::int64_t now_s) const {
  if (path_.empty()) return true;
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.digest == admission.digest && entry.role == admission.role &&
           (!entry.expiry_s || now_s < *entry.expiry_s);
  });
}

bool is_loopback(std::string_view host) {
  // Names such as 127.example.org are not addresses
  const bool numbers = host.find_first_not_of("0123456789.") == std::string_view::npos;
  return host == "localhost" || host == "::1" || (numbers && host.starts_with("127."));
}

HostCheck::HostCheck(bool loopback, std::vector<std::string> origins)
    : loopback_(loopback), origins_(std::move(origins)) {}

bool HostCheck::may_be_asked_as(std::string_view host) const {
  return !host.empty() && (!loopback_ || is_loopback(name_in(host)));
}

bool HostCheck::may_connect(std::string_view origin, std::string_view host, bool tls) const {
  if (origin.empty()) return true;
  if (std::find(origins_.begin(), origins_.end(), origin) != origins_.end()) return true;
  return origin == std::string(tls ? "https://" : "http://").append(host);
}

}  // namespace lambent::stream
