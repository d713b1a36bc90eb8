// SPDX-License-Identifier: Apache-2.0
#include "stream/session/session_file.h"

#include <map>
#include <utility>

#include "core/files/file_bytes.h"
#include "core/little_endian.h"

namespace lambent::stream {
namespace {

constexpr std::uint32_t kSessionMagic = 0x53424D4Cu;  // "LMBS"
constexpr std::uint32_t kSessionVersion = 1;

// Sizes of the headers of the file and of each message [bytes].
constexpr std::size_t kFileHeaderBytes = 8, kEntryHeaderBytes = 16;

void write(std::ofstream& file, std::span<const std::byte> bytes) {
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.flush();
}

/// Whether an entry is consistent: a client begins with a Hello, and leaves once.
bool follows(std::map<std::uint32_t, bool>& here, const SessionEntry& entry) {
  const bool is_hello = entry.message && std::holds_alternative<Hello>(*entry.message);
  const auto [client, is_new] = here.try_emplace(entry.client, true);
  if (is_new) return is_hello;
  if (!client->second || is_hello) return false;
  client->second = entry.message.has_value();
  return true;
}

}  // namespace

bool belongs_to_session(const Message& message) {
  return !std::holds_alternative<Received>(message) &&
         !std::holds_alternative<LightReceived>(message) && !std::holds_alternative<Ping>(message);
}

Expected<SessionWriter> SessionWriter::create(const std::string& path) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  ByteWriter header;
  header.u32(kSessionMagic);
  header.u32(kSessionVersion);
  write(file, header.bytes());
  if (!file) return fail(path, "", "cannot be written", Error::Kind::failed);
  return SessionWriter(path, std::move(file));
}

Expected<void> SessionWriter::add(const SessionEntry& entry) {
  std::vector<std::byte> message;
  if (entry.message) {
    const auto* hello = std::get_if<Hello>(&*entry.message);
    Hello without_token = hello != nullptr ? *hello : Hello{};
    without_token.token.clear();
    message = write_message(hello != nullptr ? Message(without_token) : *entry.message);
  }
  ByteWriter out;
  out.u64(static_cast<std::uint64_t>(entry.time.count()));
  out.u32(entry.client);
  out.u32(static_cast<std::uint32_t>(message.size()));
  out.raw(message);
  bytes_ += out.size();
  if (bytes_ > kMaxBytes) return fail(path_, "", "is full: a session has 1 GiB at most");
  write(file_, out.bytes());
  if (!file_) return fail(path_, "", "cannot be written any more", Error::Kind::failed);
  return {};
}

Expected<std::vector<SessionEntry>> read_session(const std::string& path) {
  const auto bytes = read_file(path, SessionWriter::kMaxBytes + kFileHeaderBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  ByteReader in(*bytes);
  if (in.left() < kFileHeaderBytes || in.u32() != kSessionMagic) {
    return fail(path, "", "is no session of lambent serve --record");
  }
  if (const std::uint32_t version = in.u32(); version != kSessionVersion) {
    return fail(path, "", "is of version " + std::to_string(version) + ", which cannot be read");
  }
  std::vector<SessionEntry> entries;
  std::map<std::uint32_t, bool> here;
  while (in.left() >= kEntryHeaderBytes) {
    SessionEntry entry;
    entry.time = std::chrono::microseconds(static_cast<std::int64_t>(in.u64()));
    entry.client = in.u32();
    const std::uint32_t size = in.u32();
    const std::string place = "entry " + std::to_string(entries.size() + 1);
    if (size > kMaxClientMessageBytes) return fail(path, place, "is larger than any message");
    if (in.left() < size) break;
    if (size > 0) {
      std::vector<std::byte> message(size);
      for (std::byte& byte : message) byte = std::byte{in.u8()};
      auto parsed = parse_message(message, Sender::client);
      if (!parsed) return fail(path, place, parsed.error().cause);
      entry.message = std::move(*parsed);
    }
    const bool too_early = !entries.empty() && entry.time < entries.back().time;
    if (entry.time.count() < 0 || too_early || !follows(here, entry) ||
        (entry.message && !belongs_to_session(*entry.message))) {
      return fail(path, place, "is nothing that a server wrote there");
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace lambent::stream
