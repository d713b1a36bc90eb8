// SPDX-License-Identifier: Apache-2.0
// Who may look, and who may change: tokens in a file, and pages whose scripts may connect.
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

/// What is kept of a token: its SHA-256.
using TokenDigest = std::array<unsigned char, 32>;
TokenDigest digest_of(std::string_view token);

/// A token that is good at the moment.
struct Admission {
  Role role = Role::view;
  TokenDigest digest{};  ///< Names the token for `still_good`.
};

/// The tokens of a file, one a line: `view` or `change`, the token, and, where it expires, a time
/// as 2026-12-31T23:59:59Z. Empty lines, and those that begin with #, count for nothing. Without a
/// file everybody may change everything. Not thread-safe.
class Access {
 public:
  Access() = default;
  /// Reads the file. Fails on files that are missing or broken, naming the line.
  static Expected<Access> open(const std::string& path);

  bool needs_token() const { return !path_.empty(); }
  /// What a token allows at a time [s since 1970], or nothing. Takes as long whichever token is
  /// compared, and however much of one is right.
  std::optional<Admission> admit(std::string_view token, std::int64_t now_s) const;
  /// Whether what was admitted once still is, in the same role.
  bool still_good(const Admission& admission, std::int64_t now_s) const;
  /// Reads the file again where it has changed: what is no longer in it is revoked. Where it is
  /// missing or broken then, no token is good until it is mended; that is the error.
  Expected<void> refresh();

 private:
  struct Entry {
    Role role = Role::view;
    TokenDigest digest{};
    std::optional<std::int64_t> expiry_s;
  };
  /// What tells that a file has changed.
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

/// Hosts that a browser may believe to be at: the names under which the server is asked for.
class HostCheck {
 public:
  /// On loopback, names of this machine alone; else any, as a token is asked for. Pages of
  /// `origins` (as https://example.org) may connect besides our own.
  HostCheck(bool loopback, std::vector<std::string> origins);

  /// Whether a request may name this host ("localhost:8080"). What another name leads here for is
  /// a page of somebody else's that had its name changed to our address.
  bool may_be_asked_as(std::string_view host) const;
  /// Whether a page of this origin may open a stream at this host. Empty: no browser asks.
  bool may_connect(std::string_view origin, std::string_view host, bool tls) const;

 private:
  bool loopback_;
  std::vector<std::string> origins_;
};

/// Whether an address, or "localhost", is reached from this machine alone.
bool is_loopback(std::string_view host);

}  // namespace lambent::stream
