// SPDX-License-Identifier: Apache-2.0
// Access control: tokens in a file with their roles, and pages whose scripts may connect.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/error.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

/// Shorter tokens could be guessed [characters].
inline constexpr std::size_t kMinTokenBytes = 16;

/// The SHA-256 of a token, which is stored in its place.
using TokenDigest = std::array<unsigned char, 32>;
TokenDigest digest_of(std::string_view token);

/// The result of checking a valid token.
struct Admission {
  Role role = Role::view;
  TokenDigest digest{};  ///< Identifies the token for `still_good`.
};

/// The tokens of a file, one per line: `view` or `change`, the token, and optionally the time at
/// which it expires, such as 2026-12-31T23:59:59Z. Empty lines, and those that begin with #, are
/// ignored. Without a file everybody may change everything. Not thread-safe.
class Access {
 public:
  Access() = default;
  /// Reads the file. Fails on files that are missing or broken, naming the line.
  static Expected<Access> open(const std::string& path);

  bool needs_token() const { return !path_.empty(); }
  /// Whether the file, as it was last read, has tokens.
  bool has_tokens() const { return !entries_.empty(); }
  /// The role of a token at a time [s since 1970], or nothing. Takes the same time whichever token
  /// is compared, and however much of it is right.
  std::optional<Admission> admit(std::string_view token, std::int64_t now_s) const;
  /// Whether an admitted token is still valid, in the same role.
  bool still_good(const Admission& admission, std::int64_t now_s) const;
  /// Reads the file again if it has changed: tokens that are no longer in it are revoked. If the
  /// file is then missing or broken, this fails, and no token is valid until it is repaired.
  Expected<void> refresh();

 private:
  struct Entry {
    Role role = Role::view;
    TokenDigest digest{};
    std::optional<std::int64_t> expiry_s;
  };
  /// Identifies a version of a file.
  struct Stamp {
    std::int64_t modified_ns = 0;
    std::uint64_t size = 0, file = 0;
    bool operator==(const Stamp&) const = default;
  };
  Expected<void> read();
  static Expected<Entry> parse_line(std::string_view line);
  static Stamp stamp_of(const std::string& path);

  std::string path_;  // empty: none
  Stamp stamp_;
  std::vector<Entry> entries_;
};

/// Checks of the headers Host and Origin, against DNS rebinding and foreign pages.
class HostCheck {
 public:
  /// On loopback, only names of this machine are accepted as hosts; otherwise any, since a token is
  /// required. Pages of `origins` (such as https://example.org) may connect in addition to the
  /// server's own.
  HostCheck(bool loopback, std::vector<std::string> origins);

  /// Whether a request may name this host ("localhost:8080"). Another name means a foreign page
  /// whose name was redirected to this address (DNS rebinding).
  bool may_be_asked_as(std::string_view host) const;
  /// Whether a page of this origin may open a stream at this host. An empty origin is not from a
  /// browser.
  bool may_connect(std::string_view origin, std::string_view host, bool tls) const;

 private:
  bool loopback_;
  std::vector<std::string> origins_;
};

/// Whether an address, or "localhost", can be reached only from this machine.
bool is_loopback(std::string_view host);

}  // namespace lambent::stream
