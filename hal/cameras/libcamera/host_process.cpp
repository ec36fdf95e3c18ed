#include "hal/cameras/libcamera/host_process.h"

#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/cameras/libcamera/host_channel.h"
#include "hal/cameras/libcamera/host_server.h"
#include "hal/cameras/libcamera/hosted_library.h"
#include "hal/program_part.h"

namespace pleinair::hal::libcamera {
namespace {

constexpr const char* kName = "pleinair-libcamera";
// Descriptors of the host.
constexpr int kCalls = 3;
constexpr int kFrames = 4;

/// The path of the host's program; empty where it is not installed.
std::string hostProgram() {
  const std::filesystem::path path = programPart(kName);
  return ::access(path.c_str(), X_OK) == 0 ? path.string() : std::string();
}

Result<StartedHost> startHost(const std::string& program) {
  auto calls = HostChannel::pair();
  if (!calls) return tl::unexpected(calls.error());
  auto frames = HostChannel::pair();
  if (!frames) return tl::unexpected(frames.error());

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  // Standard error stays: libcamera logs there.
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  // Copies that the child's numbers cannot overwrite first.
  constexpr int kHigh = 64;
  const FileDescriptor callsCopy(::fcntl((*calls)[1].get(), F_DUPFD_CLOEXEC, kHigh));
  const FileDescriptor framesCopy(::fcntl((*frames)[1].get(), F_DUPFD_CLOEXEC, kHigh));
  posix_spawn_file_actions_adddup2(&files, callsCopy.get(), kCalls);
  posix_spawn_file_actions_adddup2(&files, framesCopy.get(), kFrames);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Signals that end the program reach the host through its end, not by themselves.
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  std::string name = kName;
  const std::array<char*, 2> arguments{name.data(), nullptr};
  pid_t process = -1;
  const int error =
      ::posix_spawn(&process, program.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) {
    return tl::unexpected(errnoError("libcamera", "cannot start a process for it", error));
  }
  return StartedHost{
      .calls = std::move((*calls)[0]), .frames = std::move((*frames)[0]), .process = process};
}

}  // namespace

int runHost() {
  int type = 0;
  socklen_t size = sizeof type;
  if (::getsockopt(kCalls, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_SEQPACKET) {
    std::fputs("pleinair-libcamera: pleinair starts this program where it needs it\n", stderr);
    return 2;
  }
  // What libraries of the program have left open, such as a graphics card.
  ::close_range(kFrames + 1, ~0U, 0);
  serveLibrary(systemLibrary(), FileDescriptor(kCalls), FileDescriptor(kFrames),
               {.isDeviceGone = [] { return holdsRemovedNode("/proc/self/fd"); },
                .onHanging = [] { ::_exit(1); }});
  return 0;
}

Library& hostedLibrary() {
  static const std::string program = hostProgram();
  if (program.empty() || !hasSystemLibrary()) return systemLibrary();
  static HostedLibrary library([] { return startHost(program); });
  return library;
}

}  // namespace pleinair::hal::libcamera
