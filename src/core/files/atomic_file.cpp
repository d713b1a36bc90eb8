// SPDX-License-Identifier: Apache-2.0
#include "core/files/atomic_file.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include "core/files/file_names.h"

namespace lambent {
namespace {

namespace fs = std::filesystem;

/// Maximum number of temporary names to try, where others are taken.
constexpr int kMaxNameAttempts = 100;
/// Size of a file's buffer, and of a step of copying [bytes]; large, for few system calls.
constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
/// Permissions of new files, less the user's umask.
constexpr mode_t kNewFileMode = 0666;

std::string system_cause(int error_number) {
  return "cannot write: " + std::generic_category().message(error_number);
}

int errno_or(int otherwise) {
  return errno != 0 ? errno : otherwise;
}

std::atomic_flag names_in_use = ATOMIC_FLAG_INIT;

/// While it exists, only this thread creates and removes temporary names: it blocks signals in this
/// thread, and handlers in other threads wait for it, so that none sees a partial list.
class NameLock {
 public:
  NameLock() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
    while (names_in_use.test_and_set(std::memory_order_acquire)) ::usleep(10);
  }
  ~NameLock() {
    names_in_use.clear(std::memory_order_release);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NameLock(const NameLock&) = delete;
  NameLock& operator=(const NameLock&) = delete;

 private:
  sigset_t before_{};
};

/// Existing temporary names; guarded by NameLock. A signal may arrive at any moment: they are there
/// from the start, as the handler must not allocate them, and are never destroyed.
union TemporaryNames {
  std::vector<std::string> list;
  constexpr TemporaryNames() : list() {}
  ~TemporaryNames() {}
};
constinit TemporaryNames temporary_names;

void forget_temporary(const std::string& name) {
  std::erase(temporary_names.list, name);
}

std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> count{std::random_device{}()};
  return target + ".tmp-" + std::to_string(count.fetch_add(1));
}

/// Opens a new file without a name in the directory. Returns a descriptor, or -1.
int open_nameless(const std::string& directory) {
#ifdef O_TMPFILE
  // The file will be named through its entry in /proc
  if (::access("/proc/self/fd", X_OK) != 0) return -1;
  return ::open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kNewFileMode);
#else
  (void)directory;
  return -1;
#endif
}

/// Opens a new file beside the target. Returns a descriptor, or -1 with errno set. Sets `name`.
int open_named(const std::string& target, std::string& name) {
  const NameLock lock;
  for (int attempt = 0; attempt < kMaxNameAttempts; ++attempt) {
    name = temporary_name(target);
    const int made = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
    if (made >= 0) temporary_names.list.push_back(name);
    if (made >= 0 || errno != EEXIST) return made;
  }
  return -1;
}

/// Writes all of it. Returns 0 or errno.
int write_all(int descriptor, const std::byte* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t done = ::write(descriptor, bytes, count);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return errno_or(EIO);
    bytes += done;
    count -= static_cast<std::size_t>(done);
  }
  return 0;
}

}  // namespace

void discard_unfinished_files() noexcept {
  // The lock is not released: the process ends
  while (names_in_use.test_and_set(std::memory_order_acquire)) ::usleep(10);
  for (const std::string& name : temporary_names.list) ::unlink(name.c_str());
}

tl::unexpected<Error> AtomicFile::failure(int error_number) const {
  return fail(path_, "", system_cause(error_number), Error::Kind::failed);
}

Expected<AtomicFile> AtomicFile::open(const std::string& path, Unfinished how) {
  if (path.empty()) return fail("", "", "the name of the file to write is empty");
  AtomicFile made;
  made.path_ = path;
  const PathEnd end = end_of_path(path);
  made.target_ = end.path;
  made.descriptor_ = end.descriptor;
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return fail(path, "", "cannot write: is a directory");
  made.replaces_ = end.descriptor < 0 && (!exists || S_ISREG(status.st_mode));

  int descriptor = -1;
  if (!made.replaces_) {
    made.file_ = std::tmpfile();
    if (made.file_ == nullptr) return made.failure(errno_or(EIO));
    return made;
  }
  const std::string directory = fs::path(made.target_).parent_path().string();
  if (how == Unfinished::nameless_if_possible) descriptor = open_nameless(directory);
  if (descriptor < 0) descriptor = open_named(made.target_, made.temporary_);
  if (descriptor < 0) {
    made.temporary_.clear();
    return made.failure(errno_or(EIO));
  }
  // Keep the permissions of a file that is replaced
  if (exists) (void)!::fchmod(descriptor, status.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO));
  made.file_ = ::fdopen(descriptor, "wb+");
  if (made.file_ == nullptr) {
    const int error_number = errno_or(EIO);
    ::close(descriptor);
    return made.failure(error_number);
  }
  std::setvbuf(made.file_, nullptr, _IOFBF, kBufferBytes);
  return made;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      replaces_(other.replaces_),
      descriptor_(other.descriptor_),
      file_(std::exchange(other.file_, nullptr)) {}

AtomicFile::~AtomicFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (temporary_.empty()) return;
  const NameLock lock;
  ::unlink(temporary_.c_str());
  forget_temporary(temporary_);
}

Expected<void> AtomicFile::write(std::span<const std::byte> bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size()) return {};
  return failure(errno_or(EIO));
}

Expected<void> AtomicFile::seek(std::uint64_t position) {
  errno = 0;
  if (::fseeko(file_, static_cast<off_t>(position), SEEK_SET) == 0) return {};
  return failure(errno_or(EIO));
}

/// Copies the content to a target that cannot be replaced.
Expected<void> AtomicFile::send() {
  const int to = descriptor_ >= 0 ? ::dup(descriptor_)
                                  : ::open(target_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (to < 0) return failure(errno_or(EIO));
  std::rewind(file_);
  std::vector<std::byte> buffer(kBufferBytes);
  int error_number = 0;
  while (error_number == 0) {
    const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file_);
    if (count == 0) break;
    error_number = write_all(to, buffer.data(), count);
  }
  if (error_number == 0 && std::ferror(file_) != 0) error_number = EIO;
  if (::close(to) != 0 && error_number == 0) error_number = errno_or(EIO);
  if (error_number != 0) return failure(error_number);
  return {};
}

/// Replaces the target by the complete file. Returns 0 or errno.
int AtomicFile::give_name(int descriptor) {
  const NameLock lock;
  if (!temporary_.empty()) {
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) return errno_or(EIO);
    forget_temporary(temporary_);
    temporary_.clear();
    return 0;
  }
  const std::string nameless = "/proc/self/fd/" + std::to_string(descriptor);
  const auto link_to = [&](const std::string& name) {
    const int done =
        ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
    return done == 0 ? 0 : errno_or(EIO);
  };
  int error_number = link_to(target_);
  // linkat never replaces a file, but rename does
  for (int attempt = 0; error_number == EEXIST && attempt < kMaxNameAttempts; ++attempt) {
    const std::string name = temporary_name(target_);
    error_number = link_to(name);
    if (error_number != 0) continue;
    if (::rename(name.c_str(), target_.c_str()) == 0) return 0;
    error_number = errno_or(EIO);
    ::unlink(name.c_str());
    break;
  }
  return error_number;
}

Expected<void> AtomicFile::commit() {
  errno = 0;
  if (std::fflush(file_) != 0) return failure(errno_or(EIO));
  if (!replaces_) return send();
  // Some file systems report a full disk only on close: close a second descriptor
  const int descriptor = ::fileno(file_);
  const int second = ::dup(descriptor);
  if (second < 0 || ::close(second) != 0) return failure(errno_or(EIO));
  if (const int error_number = give_name(descriptor); error_number != 0) {
    return failure(error_number);
  }
  return {};
}

Expected<void> write_file_atomically(const std::string& path, std::span<const std::byte> bytes) {
  Expected<AtomicFile> file = AtomicFile::open(path);
  if (!file) return tl::unexpected(file.error());
  if (const Expected<void> written = file->write(bytes); !written) return written;
  return file->commit();
}

Expected<void> write_file_atomically(const std::string& path, std::string_view text) {
  return write_file_atomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

Expected<void> check_writable(const std::string& path) {
  if (path.empty()) return fail("", "", "the name of the file to write is empty");
  const PathEnd end = end_of_path(path);
  if (end.descriptor >= 0) return {};
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return fail(path, "", "cannot write: is a directory");
  // Targets that are written in place need no permission for their directory
  if (exists && !S_ISREG(status.st_mode)) {
    if (::access(end.path.c_str(), W_OK) == 0) return {};
    return fail(path, "", system_cause(errno_or(EIO)), Error::Kind::failed);
  }
  // Permissions do not show read-only file systems and quotas; only an attempt does
  const Expected<AtomicFile> attempt = AtomicFile::open(path);
  if (!attempt) return tl::unexpected(attempt.error());
  return {};
}

}  // namespace lambent
