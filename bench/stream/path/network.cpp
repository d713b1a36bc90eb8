// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "bench/stream/path/impaired_path.h"

namespace lambent::stream_path {
namespace {

/// Throws if a system call failed.
int checked(int result, const char* what) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), what);
  return result;
}

/// Runs `work` on a thread of its own, so that the caller remains in its network.
template <class Work>
void run_apart(const Work& work) {
  std::exception_ptr failure;
  std::thread([&] {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
  }).join();
  if (failure) std::rethrow_exception(failure);
}

struct Socket {
  int file = checked(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), "socket");
  ~Socket() { ::close(file); }
};

void set_address(ifreq& request, const char* address) {
  sockaddr_in in{};
  in.sin_family = AF_INET;
  inet_pton(AF_INET, address, &in.sin_addr);
  std::memcpy(&request.ifr_addr, &in, sizeof(in));
}

void bring_up(const Socket& socket, ifreq& request) {
  checked(::ioctl(socket.file, SIOCGIFFLAGS, &request), "reading the flags of a network device");
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP | IFF_RUNNING);
  checked(::ioctl(socket.file, SIOCSIFFLAGS, &request), "bringing a network device up");
}

}  // namespace

Network::Network() {
  run_apart([this] {
    checked(::unshare(CLONE_NEWNET), "making a network namespace (only root may)");
    file_ = checked(::open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC), "its file");
    const Socket socket;
    ifreq loopback{};
    std::strcpy(loopback.ifr_name, "lo");
    bring_up(socket, loopback);
  });
}

Network::~Network() {
  if (file_ >= 0) ::close(file_);
}

void Network::enter() const {
  checked(::setns(file_, CLONE_NEWNET), "entering a network namespace");
}

int Network::open_device(const std::string& address) const {
  int device = -1;
  run_apart([&] {
    enter();
    device = checked(::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC), "/dev/net/tun");
    ifreq request{};
    request.ifr_flags = IFF_TUN | IFF_NO_PI;
    std::strcpy(request.ifr_name, "path");
    checked(::ioctl(device, TUNSETIFF, &request), "making a TUN device");
    const Socket socket;
    set_address(request, address.c_str());
    checked(::ioctl(socket.file, SIOCSIFADDR, &request), "an address of a TUN device");
    set_address(request, "255.255.255.252");
    checked(::ioctl(socket.file, SIOCSIFNETMASK, &request), "a netmask of a TUN device");
    bring_up(socket, request);
  });
  return device;
}

}  // namespace lambent::stream_path
